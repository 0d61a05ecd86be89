//! The views of a character in a drawing: which shapes, or which areas of a picture, are its regions.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine2, DVec2};
use image::DynamicImage;
use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::diagnostics::{shaded, too_many};
use super::features::{self, FeaturePoint};
use super::keys;
use super::matching::RegionInView;
use super::names;
use super::region::{Direction, Region, RegionId, View};
use crate::bind::{Bindings, LayerId, PartId, PartKind, StringId};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{Outline, area, bounds, intersect};
use crate::lang::keyword::Keyword;
use crate::lang::value::{Setting, Value};
use crate::memo::Memo;
use crate::raster::{self, RasterView, Shades};
use crate::scene::ViewId;
use crate::svg::{Drawing, LARGE, ShapeId};

/// Pixels along the longer side of an SVG picture in a view.
pub(super) const SVG_SIDE: u32 = 1024;
/// How far the middle of a line may deviate, in its width.
const LINE_TOLERANCE: f64 = 0.02;
/// The largest number of regions of a view: any two of two views are compared.
pub(super) const MOST_REGIONS: usize = 1000;
/// The share of a region that another one covers if it contains it.
const CONTAINED: f64 = 0.9;

/// A view as it is drawn.
#[derive(Debug, Clone)]
pub(super) struct DrawnView {
    /// Index of its layer.
    pub(super) layer: LayerId,
    pub(super) view: View,
    /// What else the drawing says of each region.
    pub(super) drawn: TiVec<RegionId, Drawn>,
    /// Its feature points.
    pub(super) features: Vec<FeaturePoint>,
    /// Whether most of the regions of a picture in it are only steps of soft shades.
    pub(super) is_shaded: bool,
    /// The upright line about which it is the mirror image of what is drawn, by its x; `None` if it is as drawn.
    pub(super) mirror: Option<f64>,
}

/// What the drawing says of a region, besides its outline.
#[derive(Debug, Clone)]
pub(super) struct Drawn {
    /// The shape that it is, or the picture that shows it.
    pub(super) shape: ShapeId,
    /// Its part, if it has one: regions of pictures have none.
    pub(super) part: Option<PartId>,
    /// The string that names it in a picture.
    pub(super) string: Option<StringId>,
    /// The line along its border.
    pub(super) line: Option<DrawnLine>,
    /// Its middle, if it is an open line with round ends.
    pub(super) open_line: Option<OpenLine>,
    /// `Depth`, drawing units.
    pub(super) depth: Option<f64>,
    /// The label of its element, a name if another view has the same.
    pub(super) label: Option<String>,
    /// Whether the view does not show it (`Hidden`).
    pub(super) is_hidden: bool,
}

/// A line along a border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DrawnLine {
    /// Drawing units.
    pub(super) width: f64,
    /// sRGB with straight alpha, each 0 to 1.
    pub(super) color: [f64; 4],
}

/// An open line with round ends.
#[derive(Debug, Clone)]
pub(super) struct OpenLine {
    /// Drawing units.
    pub(super) width: f64,
    /// Its middle from end to end, drawing units, y down.
    pub(super) points: Vec<DVec2>,
}

/// A setting of a view's string.
pub(super) fn setting(bindings: &Bindings, layer: LayerId, keyword: Keyword) -> Option<&Value> {
    let settings = &bindings.strings[bindings.layers[layer].string].settings;
    let mut settings = settings.iter();
    let found = settings.find(|setting| setting.keyword == keyword);
    found.map(|setting| &setting.value)
}

/// The direction of a view's layer.
fn direction(bindings: &Bindings, layer: LayerId) -> Option<Direction> {
    match *setting(bindings, layer, Keyword::View)? {
        Value::Pair([theta, phi]) => Some(Direction { theta, phi }),
        _ => None,
    }
}

/// Reads the view that a layer is. `None` if its string has no direction, or if it has too many regions, which is reported.
pub(super) fn read(
    drawing: &Drawing,
    bindings: &Bindings,
    layer: LayerId,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<DrawnView> {
    let direction = direction(bindings, layer)?;
    let mut parts: TiVec<ShapeId, _> = ti_vec![None; drawing.shapes.len()];
    for (index, part) in bindings.parts.iter_enumerated() {
        if part.kind == PartKind::Region {
            parts[part.shape] = Some(index);
        }
    }
    let mut regions = Vec::new();
    let mut is_shaded = false;
    for (index, shape) in drawing.shapes.iter_enumerated() {
        if bindings.view_of_group(shape.group) != Some(layer) || bindings.is_leader(index) {
            continue;
        }
        if shape.picture.is_some() {
            match of_picture(drawing, index, regions.len(), memo) {
                Ok(found) => {
                    let count = found.regions.len();
                    diagnostics.extend(shaded(drawing, index, found.shades, count));
                    is_shaded |= found.shades == Shades::Steps;
                    regions.extend(found.regions);
                }
                Err((code, message)) => {
                    let finding = Diagnostic::new(code, shape.element.span, message);
                    diagnostics.push(finding.help(LARGE));
                }
            }
        } else {
            regions.extend(of_shape(drawing, bindings, index, parts[index]));
        }
    }
    names::assign(drawing, bindings, layer, &mut regions, diagnostics);
    let regions = hidden_first(regions);
    let (mut all, drawn): (TiVec<RegionId, Region>, TiVec<RegionId, Drawn>) =
        regions.into_iter().unzip();
    if all.len() > MOST_REGIONS {
        diagnostics.push(too_many(bindings, layer, all.len()));
        return None;
    }
    let containers = keys::contained(&all, memo);
    for (region, container) in all.iter_mut().zip(containers) {
        region.container = container;
    }
    Some(DrawnView {
        layer,
        view: View {
            direction,
            regions: all,
        },
        drawn,
        features: features::of_view(drawing, bindings, layer, diagnostics),
        is_shaded,
        mirror: None,
    })
}

/// Moves what the view does not show behind all that it shows, so that it lies on nothing of that.
fn hidden_first(mut regions: Vec<(Region, Drawn)>) -> Vec<(Region, Drawn)> {
    let is_hidden: Vec<bool> = regions.iter().map(|(_, drawn)| drawn.is_hidden).collect();
    let hidden = is_hidden.iter().filter(|hidden| **hidden).count();
    if hidden == 0 {
        return regions;
    }
    let mut shown = hidden..;
    let places: Vec<Option<usize>> = is_hidden
        .iter()
        .map(|is_hidden| if *is_hidden { None } else { shown.next() })
        .collect();
    // By region, the place of what it lies on. Containers come before what they contain.
    let mut around: Vec<Option<usize>> = Vec::with_capacity(regions.len());
    for (index, (region, _)) in regions.iter_mut().enumerate() {
        let outer = region
            .container
            .map(usize::from)
            .filter(|outer| *outer < index);
        let container = outer.and_then(|outer| places[outer].or(around[outer]));
        around.push(container);
        let is_shown = places[index].is_some();
        region.container = container.filter(|_| is_shown).map(RegionId::from);
    }
    regions.sort_by_key(|(_, drawn)| !drawn.is_hidden);
    regions
}

/// What strings say of a region besides its name.
pub(super) fn say(settings: &[Setting], drawn: &mut Drawn) {
    let mut found = settings
        .iter()
        .map(|setting| (setting.keyword, &setting.value));
    drawn.depth = found.clone().find_map(|said| match said {
        (Keyword::Depth, Value::Number(depth)) => Some(*depth),
        _ => None,
    });
    drawn.is_hidden = found.any(|(keyword, _)| keyword == Keyword::Hidden);
}

/// The region that a shape is; a stroke without a fill is one, too.
fn of_shape(
    drawing: &Drawing,
    bindings: &Bindings,
    index: ShapeId,
    part: Option<PartId>,
) -> Option<(Region, Drawn)> {
    let shape = &drawing.shapes[index];
    let name = part.map(|part| bindings.parts[part].name.clone());
    let name = name.filter(|name| !name.is_empty());
    let srgb = |[r, g, b]: [u8; 3], alpha: f64| {
        let [r, g, b] = [r, g, b].map(|channel| f64::from(channel) / 255.0);
        [r, g, b, alpha]
    };
    let is_filled = !shape.outline.polygons.is_empty();
    let (outline, line) = match &shape.stroke {
        Some(stroke) if is_filled => {
            let line = DrawnLine {
                width: stroke.width(),
                color: srgb(stroke.paint.color, shape.opacity),
            };
            (Arc::clone(&shape.outline), Some(line))
        }
        Some(stroke) => (Arc::new(stroke.outline()), None),
        None => (Arc::clone(&shape.outline), None),
    };
    if outline.polygons.is_empty() {
        return None;
    }
    let settings = part.and_then(|part| bindings.parts[part].string);
    let settings = settings.map_or(&[][..], |string| &bindings.strings[string].settings);
    let color = part.map(|part| bindings.material_factors(drawing, part).color);
    let region = Region {
        name,
        outline,
        color: color.unwrap_or_else(|| srgb(shape.paint.color, shape.opacity)),
        container: None,
        is_line: !is_filled,
    };
    let mut drawn = Drawn {
        shape: index,
        part,
        string: None,
        line,
        open_line: shape
            .stroke
            .as_ref()
            .filter(|_| !is_filled)
            .and_then(|stroke| {
                Some(OpenLine {
                    width: stroke.width(),
                    points: stroke.open_line(LINE_TOLERANCE * stroke.width())?,
                })
            }),
        depth: None,
        label: shape.element.label.clone(),
        is_hidden: false,
    };
    say(settings, &mut drawn);
    Some((region, drawn))
}

/// The width and height of a picture, pixels, and its regions.
pub(super) type Segmented = Result<(DVec2, RasterView), (Code, String)>;

/// The regions of a picture that has these pixels.
pub(super) fn segmented(pixels: Result<DynamicImage, (Code, String)>) -> Segmented {
    let pixels = pixels?.into_rgba8();
    let size = DVec2::new(pixels.width().into(), pixels.height().into());
    Ok((size, raster::regions(&pixels)))
}

/// What a picture gives its view.
#[derive(Default)]
struct OfPicture {
    regions: Vec<(Region, Drawn)>,
    /// What became of soft shades.
    shades: Shades,
}

/// The regions of a picture. The first one will have this number among those of its view.
fn of_picture(
    drawing: &Drawing,
    index: ShapeId,
    first: usize,
    memo: &Memo,
) -> Result<OfPicture, (Code, String)> {
    let Some(picture) = &drawing.shapes[index].picture else {
        return Ok(OfPicture::default());
    };
    let found = keys::segmented(picture, memo);
    let (size, found) = (*found).as_ref().map_err(Clone::clone)?;
    let place = picture.place() * DAffine2::from_scale(size.recip());
    let scale = place.matrix2.determinant().abs().sqrt();
    let moved = |outline: &Outline| {
        let point = |p: &DVec2| place.transform_point2(*p);
        outline.map_rings(|ring| ring.iter().map(point).collect())
    };
    let region = |outline: &Outline, color, container: Option<usize>| Region {
        name: None,
        outline: Arc::new(moved(outline)),
        color,
        container: container.map(|outer| RegionId::from(first + outer)),
        is_line: false,
    };
    let regions = found.regions.iter().map(|found| {
        let line = found.line.map(|line| DrawnLine {
            width: line.width * scale,
            color: line.color,
        });
        (region(&found.outline, found.color, found.container), line)
    });
    let inner = found.lines.iter();
    let inner = inner.map(|line| (region(&line.outline, line.color, line.region), None));
    let drawn = |line| Drawn {
        shape: index,
        part: None,
        string: None,
        line,
        open_line: None,
        depth: None,
        label: None,
        is_hidden: false,
    };
    let regions = regions.chain(inner);
    let regions = regions.map(|(region, line)| (region, drawn(line)));
    Ok(OfPicture {
        regions: regions.collect(),
        shades: found.shades,
    })
}

/// The container of each region; of those that have none yet, the smallest one drawn before it that covers nearly all of it.
pub(super) fn containers(
    regions: &TiSlice<RegionId, (Arc<Outline>, Option<RegionId>)>,
) -> TiVec<RegionId, Option<RegionId>> {
    let outline = |region: RegionId| &*regions[region].0;
    let areas: TiVec<RegionId, f64> = regions.iter().map(|(outline, _)| area(outline)).collect();
    let boxes: TiVec<RegionId, _> = regions.iter().map(|(outline, _)| bounds(outline)).collect();
    let found: Vec<_> = (0..regions.len())
        .into_par_iter()
        .map(|inner| {
            let inner = RegionId::from(inner);
            if let Some(container) = regions[inner].1 {
                return Some(container);
            }
            let (low, high) = boxes[inner]?;
            let earlier = areas.keys().take_while(|outer| *outer < inner);
            let mut outer: Vec<RegionId> = earlier
                .filter(|outer| areas[*outer] > areas[inner])
                .filter(|outer| {
                    boxes[*outer].is_some_and(|(l, h)| l.cmple(high).all() && h.cmpge(low).all())
                })
                .collect();
            outer.sort_by(|a, b| areas[*a].total_cmp(&areas[*b]));
            outer.into_iter().find(|outer| {
                let common = intersect(outline(*outer), outline(inner));
                area(&common) >= CONTAINED * areas[inner]
            })
        })
        .collect();
    found.into()
}

/// Names regions by their labels, as far as these are unique in a view and occur in several: copies of a layer keep them.
pub(super) fn name_by_labels(views: &mut TiSlice<ViewId, DrawnView>) {
    let mut uses: BTreeMap<String, Vec<RegionInView>> = BTreeMap::new();
    for (view, drawn) in views.iter_enumerated() {
        let named = drawn.view.regions.iter_enumerated().zip(&drawn.drawn);
        for ((id, found), said) in named {
            if let Some(label) = said.label.as_ref().filter(|_| found.name.is_none()) {
                uses.entry(label.clone())
                    .or_default()
                    .push(RegionInView { view, id });
            }
        }
    }
    for (label, regions) in uses {
        let in_order = regions.windows(2).all(|pair| pair[0].view < pair[1].view);
        if !in_order || regions.len() < 2 {
            continue;
        }
        for RegionInView { view, id } in regions {
            views[view].view.regions[id].name = Some(label.clone());
        }
    }
}
