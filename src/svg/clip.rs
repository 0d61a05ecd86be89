//! `clip-path`: cuts shapes to their visible part.

use std::borrow::Cow;

use glam::{DAffine2, DVec2};

use super::paths::{affine, bez_path};
use crate::geometry::{
    FillRule, Outline, bounds, bounds_of, flatten, intersect, resolve_overlaps, union,
};

/// Of clips with fewer points, all polygons are looked at for each shape.
const MANY: usize = 1000;

/// A clip path in user units.
#[derive(Debug, Clone)]
pub(super) struct Clip {
    outline: Outline,
    /// The boxes around its polygons.
    boxes: Vec<(DVec2, DVec2)>,
    points: usize,
    /// The minimum and maximum corner, if the clip is an axis-aligned rectangle.
    pub(super) rectangle: Option<(DVec2, DVec2)>,
}

impl Clip {
    /// Reads a clip path and the ones that clip it; `transform` maps the clipped group to the page.
    pub(super) fn read(clip: &usvg::ClipPath, transform: DAffine2, tolerance: f64) -> Vec<Self> {
        let transform = transform * affine(clip.transform());
        let mut areas = Vec::new();
        collect(clip.root(), transform, tolerance, &mut areas);
        let outline = match areas.len() {
            1 => areas.swap_remove(0),
            _ => union(&areas),
        };
        let rectangle = rectangle(&outline);
        let boxes = outline.polygons.iter().map(|polygon| {
            let border = polygon.rings.first().into_iter().flatten();
            bounds_of(border.copied()).unwrap_or_default()
        });
        let boxes = boxes.collect();
        let points = outline.point_count();
        let mut out = vec![Self {
            outline,
            boxes,
            points,
            rectangle,
        }];
        if let Some(outer) = clip.clip_path() {
            out.extend(Self::read(outer, transform, tolerance));
        }
        out
    }

    /// The part of `outline` inside the clip.
    pub(super) fn cut(&self, outline: Outline) -> Outline {
        let Some((low, high)) = bounds(&outline) else {
            return outline;
        };
        match self.rectangle {
            // Figma and nested drawings clip everything to a frame, which seldom cuts anything.
            Some((least, most)) if low.cmpge(least).all() && high.cmple(most).all() => outline,
            _ => intersect(&outline, &self.near(low, high)),
        }
    }

    /// Its polygons that may reach into a box.
    fn near(&self, low: DVec2, high: DVec2) -> Cow<'_, Outline> {
        let is_near = |(from, to): &(DVec2, DVec2)| from.cmple(high).all() && to.cmpge(low).all();
        if self.points() < MANY || self.boxes.iter().all(is_near) {
            return Cow::Borrowed(&self.outline);
        }
        let polygons = self.outline.polygons.iter().zip(&self.boxes);
        let near = polygons.filter(|(_, bounds)| is_near(bounds));
        Cow::Owned(Outline {
            polygons: near.map(|(polygon, _)| polygon.clone()).collect(),
        })
    }

    /// How many points the clip has that are looked at for each shape that it cuts.
    pub(super) fn points(&self) -> usize {
        if self.rectangle.is_some() {
            0
        } else {
            self.points
        }
    }
}

fn collect(group: &usvg::Group, transform: DAffine2, tolerance: f64, out: &mut Vec<Outline>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(inner) => {
                let first = out.len();
                collect(inner, transform, tolerance, out);
                if let Some(clip) = inner.clip_path() {
                    let clips =
                        Clip::read(clip, transform * affine(inner.abs_transform()), tolerance);
                    for outline in &mut out[first..] {
                        *outline = clips
                            .iter()
                            .fold(std::mem::take(outline), |outline, clip| clip.cut(outline));
                    }
                }
            }
            usvg::Node::Path(path) => {
                let rule = match path.fill().map(usvg::Fill::rule) {
                    Some(usvg::FillRule::EvenOdd) => FillRule::EvenOdd,
                    _ => FillRule::NonZero,
                };
                let bez = bez_path(path.data(), transform * affine(path.abs_transform()));
                out.push(resolve_overlaps(flatten(&bez, tolerance), rule));
            }
            _ => {}
        }
    }
}

fn rectangle(outline: &Outline) -> Option<(DVec2, DVec2)> {
    let [polygon] = outline.polygons.as_slice() else {
        return None;
    };
    let [ring] = polygon.rings.as_slice() else {
        return None;
    };
    let (low, high) = bounds(outline)?;
    let corner = |p: &DVec2| (p.x == low.x || p.x == high.x) && (p.y == low.y || p.y == high.y);
    (ring.len() == 4 && ring.iter().all(corner)).then_some((low, high))
}
