//! What regions are painted with in each view.
//!
//! Two paints are the same if nobody can tell them apart, so that a region which is drawn alike in all views stays one mesh. What
//! `Color`, `Alpha` or `Texture` says in the string of one view holds in all others whose strings say nothing of the kind.

use std::fmt::Write as _;

use glam::{DAffine2, DVec2};
use typed_index_collections::{TiVec, ti_vec};

use super::shape::Morph;
use crate::bind::{Bindings, PartId};
use crate::lang::keyword::Keyword;
use crate::scene::ViewId;
use crate::svg::{Drawing, PaintKey};
use crate::texture::PaintServer;

/// Colours that differ by less in each channel are the same. The drawn views are reproduced to within twice as much.
const SAME_COLOR: f64 = 0.01;
/// Gradients and patterns that are moved by less, in their own sizes, are in the same place.
const SAME_PLACE: f64 = 0.01;
/// What a string says of a paint.
const SAID: [Keyword; 3] = [Keyword::Color, Keyword::Alpha, Keyword::Texture];

/// The paints of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Paints {
    /// The different ones, in the order of the first views that have each; at least one.
    pub list: Vec<Paint>,
    /// Per view the index of its paint. A view that does not show the mesh has the first.
    pub of_view: TiVec<ViewId, usize>,
}

/// A colour, gradient, pattern or picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paint {
    /// sRGB with straight alpha, each 0 to 1; the mean colour of a gradient.
    pub color: [f64; 4],
    /// The part whose gradient, pattern or picture it is; `None` for a plain colour.
    pub part: Option<PartId>,
    /// The view in whose drawing its texture lies.
    pub view: ViewId,
    /// The upright line about which that view is the mirror image of what is drawn, by its x; `None` if it is as drawn.
    pub mirror: Option<f64>,
}

impl Paint {
    /// The point of the drawing that a point of its view shows.
    fn drawn(&self, point: DVec2) -> DVec2 {
        self.mirror
            .map_or(point, |axis| DVec2::new(2.0 * axis - point.x, point.y))
    }

    /// A map of the drawing as a map of its view.
    pub(super) fn in_view(&self, map: DAffine2) -> DAffine2 {
        let Some(axis) = self.mirror else { return map };
        let flip = DAffine2::from_scale(DVec2::new(-1.0, 1.0));
        map * DAffine2::from_translation(DVec2::new(2.0 * axis, 0.0)) * flip
    }

    /// For people: `#rrggbb` or, with alpha, `#rrggbbaa`.
    pub(super) fn describe(&self) -> String {
        let [r, g, b, alpha] = self.color.map(|channel| (channel * 255.0).round() as u8);
        let mut text = format!("#{r:02x}{g:02x}{b:02x}");
        if alpha < 255 {
            let _ = write!(text, "{alpha:02x}");
        }
        match self.part {
            Some(_) => format!("a texture, {text} in the mean"),
            None => text,
        }
    }

    /// A plain colour.
    pub(super) fn plain(color: [f64; 4], view: ViewId) -> Self {
        Self {
            color,
            part: None,
            view,
            mirror: None,
        }
    }
}

impl Paints {
    /// The paints of a mesh in a character of `views` views, from those of the views that show it, at least one.
    pub(super) fn collect(
        views: usize,
        shown: impl Iterator<Item = (ViewId, Paint)>,
        is_same: impl Fn(&Paint, &Paint) -> bool,
    ) -> Self {
        let mut paints = Self {
            list: Vec::new(),
            of_view: ti_vec![0; views],
        };
        for (view, paint) in shown {
            let known = paints.list.iter().position(|known| is_same(known, &paint));
            paints.of_view[view] = known.unwrap_or(paints.list.len());
            if known.is_none() {
                paints.list.push(paint);
            }
        }
        paints
    }

    /// Whether a view has another paint than the first one.
    pub(crate) fn differ(&self) -> bool {
        self.list.len() > 1
    }
}

/// Whether two plain colours, sRGB with straight alpha, are the same.
pub(super) fn is_same_color(a: [f64; 4], b: [f64; 4]) -> bool {
    // Nobody sees the colour of what is transparent.
    let seen = |color: [f64; 4]| color.map(|channel| channel * color[3]);
    let apart = seen(a).into_iter().zip(seen(b)).map(|(a, b)| (a - b).abs());
    apart.fold((a[3] - b[3]).abs(), f64::max) <= SAME_COLOR
}

/// What drawing and strings say about the paints of regions.
#[derive(Clone, Copy)]
pub(super) struct Said<'a> {
    pub(super) drawing: &'a Drawing,
    pub(super) bindings: &'a Bindings,
}

/// What is painted with other than a plain colour.
enum Textured<'a> {
    /// The link of `Texture`, and the map from the drawing to the picture, of size 1.
    File(&'a str, DAffine2),
    /// A gradient, pattern or picture of the drawing.
    Server(&'a PaintServer),
}

impl Said<'_> {
    /// The paints of a region from what its views draw, at least one. `area` is its shape.
    pub(super) fn paints(&self, views: usize, drawn: &[Paint], area: &Morph) -> Paints {
        let says = |paint: &&Paint| {
            let said = paint.part.map(|part| self.bindings.attributes(part));
            said.is_some_and(|said| SAID.iter().any(|keyword| said.source(*keyword).is_some()))
        };
        let said = drawn.iter().find(says);
        let shown = drawn.iter().map(|own| {
            let paint = said.filter(|_| !says(&own)).unwrap_or(own);
            let part = paint.part.filter(|_| self.texture(paint).is_some());
            (own.view, Paint { part, ..*paint })
        });
        Paints::collect(views, shown, |a, b| self.is_same(a, b, area))
    }

    fn is_same(&self, a: &Paint, b: &Paint, area: &Morph) -> bool {
        if a == b {
            return true;
        }
        match (self.texture(a), self.texture(b)) {
            (None, None) => is_same_color(a.color, b.color),
            (Some(first), Some(second)) => {
                let is_alike = match (&first, &second) {
                    (Textured::File(a, _), Textured::File(b, _)) => a == b,
                    (Textured::Server(a), Textured::Server(b)) => a.is_like(b),
                    _ => false,
                };
                let own = |paint: &Paint, texture: &Textured<'_>, point: DVec2| {
                    let point = paint.drawn(point);
                    match texture {
                        Textured::File(_, map) => map.transform_point2(point),
                        Textured::Server(server) => server.in_own_plane(point),
                    }
                };
                let mut points = area.points[a.view].iter().zip(&area.points[b.view]);
                is_alike
                    && (a.color[3] - b.color[3]).abs() <= SAME_COLOR
                    && points.all(|(p, q)| {
                        own(a, &first, *p).distance(own(b, &second, *q)) <= SAME_PLACE
                    })
            }
            _ => false,
        }
    }

    /// The texture of a paint, if it has one.
    fn texture(&self, paint: &Paint) -> Option<Textured<'_>> {
        let part = &self.bindings.parts[paint.part?];
        let attributes = self.bindings.attributes(paint.part?);
        if let Some(file) = attributes.texture() {
            let (low, high) = part.measure.bounds;
            let place = DAffine2::from_translation(low) * DAffine2::from_scale(high - low);
            return Some(Textured::File(file.value, place.inverse()));
        }
        let drawn = part.paint(self.drawing);
        let server = drawn.server.as_deref()?;
        let is_picture = matches!(drawn.key, PaintKey::Picture(_));
        (is_picture || attributes.color().is_none()).then_some(Textured::Server(server))
    }
}
