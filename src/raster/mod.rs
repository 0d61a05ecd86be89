//! Regions from the pixels of a flat-coloured drawing.
//!
//! Flat areas are the seeds. Soft edges and dark lines are divided between them, so that neighbours share their borders. A dark line
//! becomes the stroke of the regions beside it, centred on their borders as in a vector drawing; dark lines that end or branch
//! inside of a region are filled areas of their own.

mod borders;
mod canvas;
mod clean;
mod components;
mod detail;
mod fill;
mod gaps;
mod ink;
mod lines;
mod luma;
mod nesting;
mod palette;
mod seeds;
mod simplify;
mod spread;
#[cfg(test)]
mod tests;

use image::RgbaImage;

use crate::geometry::{FillRule, Outline, resolve_overlaps};
use borders::{Borders, Map};
use canvas::{Canvas, Color, apart, mixture};
use components::Component;
use fill::Areas;
use ink::Ink;
use nesting::{Nesting, is_opaque};
use palette::Palette;

/// The longest side of a picture whose pixels are looked at one by one, and of one that was not drawn cleanly: it shows less.
const MAX_SIDE: u32 = 2048;
const MAX_DIRTY_SIDE: u32 = 1024;
/// A picture with soft shades is understood if not more regions come out than this, and than so many times the areas of its clusters.
const MOST_FLATTENED: usize = 60;
const MOST_REGIONS_OF_AREA: f64 = 1.5;

/// A dark line along the border of a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    /// Pixels; the border is its middle.
    pub width: f64,
    /// sRGB with straight alpha, each from 0 to 1.
    pub color: [f64; 4],
}

/// A closed region of a picture.
#[derive(Debug, Clone)]
pub(crate) struct RasterRegion {
    /// Pixels, x right, y down, from the upper left corner of the picture. Holes that opaque regions make are filled. Neighbours
    /// share the points of their border.
    pub outline: Outline,
    /// The mean of its flat pixels, sRGB with straight alpha, each from 0 to 1.
    pub color: [f64; 4],
    /// The index of the smallest region that surrounds it.
    pub container: Option<usize>,
    /// The line that follows its border.
    pub line: Option<Line>,
}

/// A dark line that is not a region's border.
#[derive(Debug, Clone)]
pub(crate) struct InnerLine {
    /// The area of the line, pixels, like that of a region.
    pub outline: Outline,
    /// sRGB with straight alpha, each from 0 to 1.
    pub color: [f64; 4],
    /// The index of the region that most of it lies in; `None` on the background.
    pub region: Option<usize>,
}

/// The regions of a picture. It is painted by filling each region and drawing its line, in their order, then filling the
/// inner lines.
#[derive(Debug, Clone, Default)]
pub(crate) struct RasterView {
    /// Back-most first: containers before what they contain.
    pub regions: Vec<RasterRegion>,
    /// In front of all regions.
    pub lines: Vec<InnerLine>,
    /// What became of soft shades.
    pub shades: Shades,
}

/// What became of the soft shades of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Shades {
    /// It has none.
    #[default]
    None,
    /// Each is one region.
    Flattened,
    /// Most of the picture's regions are only steps of them.
    Steps,
}

/// A picture, and its connected pixels of one class.
struct Seen<'a> {
    canvas: &'a Canvas,
    palette: &'a Palette,
    components: &'a [Component],
    /// By pixel the index of its component.
    ids: &'a [u32],
}

impl<'a> Seen<'a> {
    fn new(
        canvas: &'a Canvas,
        palette: &'a Palette,
        (components, ids): &'a (Vec<Component>, Vec<u32>),
    ) -> Self {
        Self {
            canvas,
            palette,
            components,
            ids,
        }
    }
}

/// Finds the regions of a drawing in flat colours, with or without dark outlines. The background is no region: transparent
/// pixels or, in an opaque picture, what joins the picture's border in its commonest colour.
///
/// A picture with noise, or as a JPEG file has it, is cleaned before. One of more than 2,048 pixels along a side, or of more than 1,024 if it
/// is cleaned, is looked at in squares of several pixels. At most 400 regions are found, so that a photograph ends as quickly as a drawing.
pub(crate) fn regions(picture: &RgbaImage) -> RasterView {
    let longer = picture.width().max(picture.height());
    let mut square = longer.div_ceil(MAX_SIDE).max(1);
    let mut canvas = Canvas::new(picture, square as usize);
    let mut of_shades = None;
    if clean::is_dirty(&canvas) {
        if longer.div_ceil(square) > MAX_DIRTY_SIDE {
            square = longer.div_ceil(MAX_DIRTY_SIDE);
            canvas = Canvas::new(picture, square as usize);
        }
        of_shades = clean::clean(&mut canvas);
    }
    let mut palette = palette::palette(&canvas);
    let mut connected = components::components(&palette.classes, canvas.width);
    let seen = Seen::new(&canvas, &palette, &connected);
    let mut kinds = seeds::kinds(&seen);
    let ink = ink::ink(&seen, &kinds);
    if let Some(classes) = ink.as_ref().and_then(|ink| gaps::closed(&seen, ink)) {
        palette.classes = classes;
        connected = components::components(&palette.classes, canvas.width);
        kinds = seeds::kinds(&Seen::new(&canvas, &palette, &connected));
    }
    let seen = Seen::new(&canvas, &palette, &connected);
    let areas = fill::fill(&seen, &kinds, ink.as_ref());
    let nesting = nesting::nesting(&areas.labels, canvas.width, areas.colors.len());
    let mut view = view(&canvas, &areas, &nesting, ink.as_ref());
    view.shades = match of_shades {
        None => Shades::None,
        Some(areas) => {
            let count = view.regions.len();
            let is_explained = count as f64 <= MOST_REGIONS_OF_AREA * areas as f64;
            if is_explained && count <= MOST_FLATTENED {
                Shades::Flattened
            } else {
                Shades::Steps
            }
        }
    };
    match square {
        1 => view,
        _ => view.scaled(square.into()),
    }
}

impl RasterView {
    fn scaled(mut self, by: f64) -> Self {
        let scaled = |outline: &Outline| {
            outline.map_rings(|ring| ring.iter().map(|point| *point * by).collect())
        };
        for region in &mut self.regions {
            region.outline = scaled(&region.outline);
            if let Some(line) = &mut region.line {
                line.width *= by;
            }
        }
        for line in &mut self.lines {
            line.outline = scaled(&line.outline);
        }
        self
    }
}

fn view(canvas: &Canvas, areas: &Areas, nesting: &Nesting, ink: Option<&Ink>) -> RasterView {
    let mut map = Map::new(&areas.labels, canvas.width, areas.colors.len());
    let mut order: Vec<u16> = (1..areas.colors.len() as u16)
        .filter(|label| map.area(*label) > 0)
        .collect();
    order.sort_by_key(|label| {
        let label = usize::from(*label);
        (
            nesting.depth[label],
            usize::MAX - nesting.extent[label],
            label,
        )
    });
    let crossing = |a: usize, b: usize| crossing(canvas, areas, ink, a, b);
    let borders: Vec<Borders> = order
        .iter()
        .map(|label| {
            let enclosed = nesting.enclosed[usize::from(*label)].iter().copied();
            let mut labels = vec![*label];
            labels.extend(enclosed.filter(|inner| is_opaque(areas.colors[usize::from(*inner)])));
            map.borders(&labels, &crossing)
        })
        .collect();
    let line = |borders: &Borders| ink.and_then(|ink| lines::line(ink, borders));
    let lines: Vec<Option<Line>> = borders.iter().map(line).collect();
    let inner_lines = match ink {
        Some(ink) => lines::inner_lines(canvas, ink, areas, &order, &borders, &lines),
        None => Vec::new(),
    };
    let mut place = vec![None; areas.colors.len()];
    for (index, label) in order.iter().enumerate() {
        place[usize::from(*label)] = Some(index);
    }
    let regions = order.iter().zip(borders).zip(lines);
    let regions = regions.map(|((label, borders), line)| RasterRegion {
        outline: resolve_overlaps(borders.rings, FillRule::NonZero),
        color: straight(areas.colors[usize::from(*label)]),
        container: nesting.container[usize::from(*label)]
            .and_then(|outer| place[usize::from(outer)]),
        line,
    });
    RasterView {
        regions: regions.collect(),
        lines: inner_lines,
        shades: Shades::None,
    }
}

/// How far from one pixel's centre to a neighbour's with another label the border between them runs, from 0 to 1: in a line its
/// middle, else as the pixels' mixtures of both colours say.
fn crossing(canvas: &Canvas, areas: &Areas, ink: Option<&Ink>, a: usize, b: usize) -> f64 {
    let along = match ink.filter(|ink| ink.is_line(a) || ink.is_line(b)) {
        Some(ink) if ink.is_thick(a) || ink.is_thick(b) => 0.5,
        Some(ink) => {
            let reach = |at: usize| {
                if ink.is_line(at) {
                    areas.reach.distance(at)
                } else {
                    0.0
                }
            };
            let by_reach = || (reach(b) - reach(a)) / 2.0;
            let middle = ink
                .sides(a, b)
                .map(|[before, after]| (after - before) / 2.0);
            0.5 + middle.unwrap_or_else(by_reach)
        }
        None => {
            let [first, second] = [a, b].map(|at| areas.colors[usize::from(areas.labels[at])]);
            let share = |at: usize| 1.0 - mixture(canvas.color(at), first, second).0;
            if apart(first, second) > 0.0 {
                share(a) + share(b) - 0.5
            } else {
                0.5
            }
        }
    };
    f64::from(along.clamp(0.001, 0.999))
}

/// A premultiplied colour with straight alpha, each from 0 to 1, in whole steps of 1/255. What is as good as opaque is opaque: other
/// programs sort whatever is not, and get the order of regions wrong.
fn straight(color: Color) -> [f64; 4] {
    let [r, g, b, a] = color;
    let step = |share: f32| f64::from((share * 255.0).round().clamp(0.0, 255.0) / 255.0);
    let by = |c: f32| step(c / a.max(1.0));
    let alpha = if is_opaque(color) {
        1.0
    } else {
        step(a / 255.0)
    };
    [by(r), by(g), by(b), alpha]
}
