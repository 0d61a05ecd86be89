//! The ink: thin dark outlines.

use super::Seen;
use super::canvas::{Canvas, Color, mixture};
use super::components::{Component, components};
use super::palette::{Palette, SAME};
use super::seeds::{Kind, is_large, min_area};
use super::spread::{FREE, Spread, WALL, spread};

/// The luminance of sRGB values, from 0 to 1, below which a colour is dark.
const DARK: f32 = 0.2;
/// The least alpha of an opaque colour (0.98), in steps of 1/255.
const OPAQUE: u8 = 250;
/// The least number of pixels of the ink's pure colour.
const MIN_PURE: usize = 12;
/// The greatest half-width of a line as a share of the longer side of the figure, and in pixels in addition.
const LIMIT: (f32, f32) = (0.025, 1.0);
/// The half-width of the thickest line, relative to the usual one, and in pixels in addition.
const SPREAD_OF_WIDTHS: (f32, f32) = (1.5, 1.0);
/// The rank of the usual half-width among those along the lines' middles.
const USUAL: f32 = 0.8;
/// A component with a smaller share of lines is a dark region as a whole, for example a cat with its tail.
const MIN_LINES: f64 = 0.4;
/// A component whose area is smaller than this many squares of its half-width is a dot.
const DOT: f32 = 8.0;
/// The corners that a disc leaves in a thick region, as a share of the square of its radius.
const CORNER: f32 = 0.6;

/// A line crosses a row or column on less than this many times its depth on each side of its middle: one and a half at 45 degrees.
const MAX_CHORD: f32 = 2.0;

/// What a pixel has to do with ink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u16)]
pub(super) enum Part {
    /// Other colours.
    None,
    /// A line.
    Line,
    /// A dark region.
    Thick,
}

/// The ink of a picture.
#[derive(Debug)]
pub(super) struct Ink {
    /// The index of the colour in the palette.
    pub(super) class: u16,
    pub(super) color: [u8; 4],
    /// By pixel, how much of it ink covers, 255 all.
    pub(super) cover: Vec<u8>,
    pub(super) parts: Vec<Part>,
    /// By inked pixel, the distance to the nearest pixel without ink.
    pub(super) depth: Spread,
}

impl Ink {
    pub(super) fn is_line(&self, at: usize) -> bool {
        self.parts[at] == Part::Line
    }

    pub(super) fn is_thick(&self, at: usize) -> bool {
        self.parts[at] == Part::Thick
    }

    /// How far a line that crosses the row or column of two neighbouring pixels reaches from the edge between them to the side of
    /// each; `None` if it runs along it.
    pub(super) fn sides(&self, a: usize, b: usize) -> Option<[f32; 2]> {
        let step = b as isize - a as isize;
        let depth = self.depth.distance(a).max(self.depth.distance(b));
        let longest = (MAX_CHORD * depth) as usize + 2;
        let side = |from: usize, step: isize| {
            let mut at = from;
            let mut sum = 0.0;
            for _ in 0..longest {
                match self.cover.get(at) {
                    Some(0) | None => return Some(sum),
                    Some(cover) => sum += f32::from(*cover) / 255.0,
                }
                at = at.wrapping_add_signed(step);
            }
            None
        };
        Some([side(a, -step)?, side(b, step)?])
    }
}

/// Whether a pixel is of a line.
pub(super) fn is_line(ink: Option<&Ink>, at: usize) -> bool {
    ink.is_some_and(|ink| ink.is_line(at))
}

/// Finds the ink and parts it into lines and dark regions; `None` if there are no dark lines.
pub(super) fn ink(seen: &Seen<'_>, kinds: &[Kind]) -> Option<Ink> {
    let (canvas, palette) = (seen.canvas, seen.palette);
    let class = darkest(palette, seen.components)?;
    let color = palette.colors[usize::from(class)];
    let cover = cover(seen, kinds, class);
    let mut labels: Vec<u16> = cover
        .iter()
        .map(|cover| if *cover >= 128 { FREE } else { 0 })
        .collect();
    let depth = spread(canvas, &mut labels);
    let classes: Vec<u16> = cover.iter().map(|c| u16::from(*c >= 128)).collect();
    let mut parts = thin_and_thick(canvas, &classes, &depth)?;
    for (at, part) in parts.iter_mut().enumerate() {
        if canvas.is_rim(at) {
            *part = Part::None;
        }
    }
    Some(Ink {
        class,
        color,
        cover,
        parts,
        depth,
    })
}

/// The darkest opaque colour of the palette, if it is dark.
fn darkest(palette: &Palette, seeds: &[Component]) -> Option<u16> {
    let mut areas = vec![0; palette.colors.len()];
    for seed in seeds {
        if let Some(area) = areas.get_mut(usize::from(seed.class)) {
            *area += seed.area;
        }
    }
    let luminance = |color: &[u8; 4]| {
        let [r, g, b, _] = color.map(|c| f32::from(c) / 255.0);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let dark = palette.colors.iter().enumerate().skip(1);
    let dark = dark.filter(|(class, color)| color[3] >= OPAQUE && areas[*class] >= MIN_PURE);
    let (class, color) = dark.min_by(|a, b| luminance(a.1).total_cmp(&luminance(b.1)))?;
    (luminance(color) < DARK).then_some(class as u16)
}

/// How much of each pixel ink covers: all of those in its colour, and a share of those that mix it with a colour nearby.
fn cover(seen: &Seen<'_>, kinds: &[Kind], class: u16) -> Vec<u8> {
    let (canvas, palette) = (seen.canvas, seen.palette);
    let (seeds, ids) = (seen.components, seen.ids);
    let ink = palette.colors[usize::from(class)].map(f32::from);
    let mut cover = vec![0; canvas.pixels.len()];
    for at in canvas.rows().flatten() {
        if palette.classes[at] == class {
            cover[at] = 255;
            continue;
        }
        if kinds[ids[at] as usize] != Kind::Rest {
            continue;
        }
        let mut near: Vec<Color> = Vec::new();
        for id in canvas.window(at).map(|other| ids[other] as usize) {
            if kinds[id] == Kind::Rest || seeds[id].class == class {
                continue;
            }
            let color = palette.colors[usize::from(seeds[id].class)].map(f32::from);
            if near.len() < 6 && !near.contains(&color) {
                near.push(color);
            }
        }
        let touches = canvas
            .around()
            .iter()
            .any(|offset| palette.classes[at.wrapping_add_signed(*offset)] == class);
        cover[at] = (255.0 * share_of_ink(canvas.color(at), &near, ink, touches)).round() as u8;
    }
    cover
}

/// The share of ink in a pixel's colour. Where it touches pure ink, a mixture with ink is likelier than one without.
fn share_of_ink(color: Color, near: &[Color], ink: Color, touches: bool) -> f32 {
    let mut with_ink = (0.0, f32::INFINITY);
    let mut without = f32::INFINITY;
    for (index, first) in near.iter().enumerate() {
        let (share, distance) = mixture(color, *first, ink);
        if distance < with_ink.1 {
            with_ink = (share, distance);
        }
        for second in &near[index..] {
            without = without.min(mixture(color, *first, *second).1);
        }
    }
    let same = SAME as f32;
    let is_ink = if touches {
        with_ink.1 <= without + same
    } else {
        with_ink.1 + same < without
    };
    if is_ink { with_ink.0 } else { 0.0 }
}

/// What each inked pixel is part of; `None` if there are no lines.
fn thin_and_thick(canvas: &Canvas, classes: &[u16], depth: &Spread) -> Option<Vec<Part>> {
    let half = |at: usize| depth.distance(at) - 0.5;
    let inked: Vec<usize> = canvas
        .rows()
        .flatten()
        .filter(|at| classes[*at] == 1)
        .collect();
    let thickest = thickest_line(canvas, &inked, depth)?;
    // The thick parts: what discs larger than the thickest line reach.
    let mut opened = vec![WALL; classes.len()];
    for &at in &inked {
        opened[at] = if half(at) > thickest { 1 } else { FREE };
    }
    let reach = spread(canvas, &mut opened);
    let is_thick = |at: usize| {
        opened[at] == 1 && (half(at) > thickest || reach.distance(at) <= thickest + 0.5)
    };
    let mut parts = vec![0_u16; classes.len()];
    for &at in &inked {
        parts[at] = if is_thick(at) { 2 } else { 1 };
    }
    let (pieces, piece_ids) = components(&parts, canvas.width);
    let (wholes, whole_ids) = components(classes, canvas.width);
    // Of each whole: the pixels of its lines and its greatest half-width.
    let mut lines = vec![(0_usize, 0.0_f32); wholes.len()];
    for &at in &inked {
        let line = &mut lines[whole_ids[at] as usize];
        line.0 += usize::from(parts[at] == 1);
        line.1 = line.1.max(half(at));
    }
    let min_area = min_area(canvas);
    let mut result = vec![Part::None; classes.len()];
    let mut any = false;
    for &at in &inked {
        let (whole, piece) = (whole_ids[at] as usize, piece_ids[at] as usize);
        let area = wholes[whole].area;
        let (pixels, widest) = lines[whole];
        let is_dot = (area as f32) < DOT * widest * widest && is_large(&wholes[whole], min_area);
        let is_corner = (pieces[piece].area as f32) < CORNER * thickest * thickest && pixels < area;
        let is_region = (pixels as f64) < MIN_LINES * area as f64;
        let is_line = parts[at] == 1 && !is_dot && !is_corner && !is_region;
        result[at] = if is_line { Part::Line } else { Part::Thick };
        any |= is_line;
    }
    any.then_some(result)
}

/// The half-width of the thickest line, pixels; `None` if there is none.
fn thickest_line(canvas: &Canvas, inked: &[usize], depth: &Spread) -> Option<f32> {
    let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
    for at in canvas.rows().flatten() {
        if canvas.pixels[at] != canvas.background {
            let (x, y) = (at % canvas.width, at / canvas.width);
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x), high.1.max(y));
        }
    }
    let side = high
        .0
        .saturating_sub(low.0)
        .max(high.1.saturating_sub(low.1)) as f32;
    let limit = LIMIT.0 * side + LIMIT.1;
    let around = canvas.around();
    let is_middle = |at: usize| {
        let is_lower =
            |offset: &isize| depth.squared[at.wrapping_add_signed(*offset)] <= depth.squared[at];
        around.iter().all(is_lower)
    };
    let mut halves: Vec<f32> = inked
        .iter()
        .filter(|at| is_middle(**at))
        .map(|at| depth.distance(*at) - 0.5)
        .filter(|half| *half <= limit)
        .collect();
    halves.sort_by(f32::total_cmp);
    let usual = halves.get((halves.len() as f32 * USUAL) as usize)?;
    Some(limit.min(SPREAD_OF_WIDTHS.0 * usual + SPREAD_OF_WIDTHS.1))
}
