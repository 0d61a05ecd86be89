//! The lines along the borders of regions, and those inside of them.

use super::borders::{Borders, Map};
use super::canvas::{Canvas, PAD};
use super::fill::Areas;
use super::ink::{Ink, Part};
use super::seeds::min_area;
use super::spread::{FREE, spread};
use super::{InnerLine, Line, straight};
use crate::geometry::{FillRule, resolve_overlaps};
use crate::regions::groups;

/// The share of a region's border that a line follows if the region has one.
const LINED: f64 = 0.9;
/// The longest part of a border without a line that may be drawn with one: pixels, and as a share of the border. It may also be as
/// long as the line is wide.
const MAX_GAP: (f32, f32) = (3.0, 0.02);
/// How many crossings away the points lie that give a border's direction.
const NEAR: usize = 3;
/// The least sine of the angle between a border and the row or column on which the line's width is measured.
const UPRIGHT: f64 = 0.65;
/// Pixels this much beyond a line are still its own.
const SOFT: f64 = 1.2;
/// What remains of the ink beside lines is part of them if it is thinner than this, relative to the ink.
const SLIVER: f32 = 0.6;
/// The length of the shortest inner line, relative to its width: shorter ones are the tips of corners.
const SHORTEST: f32 = 3.0;
/// How far inner lines reach into the lines that they join, pixels.
const JOINT: usize = 3;

/// The line along the borders of a region, if nearly all of them have one.
pub(super) fn line(ink: &Ink, borders: &Borders) -> Option<Line> {
    let depth = |at: usize| match ink.parts[at] {
        Part::Line => ink.depth.distance(at),
        Part::None | Part::Thick => 0.0,
    };
    let (mut lined, mut bare, mut longest) = (0, 0, 0);
    let mut widths: Vec<f32> = Vec::new();
    let count = borders.crossings.len();
    for (index, &[inner, outer]) in borders.crossings.iter().enumerate() {
        if depth(inner) + depth(outer) <= 0.0 {
            bare += 1;
            longest = longest.max(bare);
            continue;
        }
        bare = 0;
        lined += 1;
        // The border's direction here tells how obliquely the row or column cuts the line.
        let before = borders.dense[(index + count - NEAR.min(count)) % count];
        let along = (borders.dense[(index + NEAR) % count] - before).normalize_or_zero();
        let upright = match inner.abs_diff(outer) {
            1 => along.y.abs(),
            _ => along.x.abs(),
        };
        if let Some(sides) = ink.sides(inner, outer).filter(|_| upright >= UPRIGHT) {
            widths.push((sides[0] + sides[1]) * upright as f32);
        }
    }
    widths.sort_by(f32::total_cmp);
    let usual = *widths.get(widths.len() / 2)?;
    let is_lined = f64::from(lined) >= LINED * count as f64;
    if !is_lined || longest as f32 > MAX_GAP.0.max(MAX_GAP.1 * count as f32).max(usual) {
        return None;
    }
    // Corners and junctions are wider and bare places narrower.
    let middle = &widths[widths.len() / 4..(3 * widths.len()).div_ceil(4)];
    let sum: f64 = middle.iter().map(|width| f64::from(*width)).sum();
    Some(Line {
        width: sum / middle.len() as f64,
        color: straight(ink.color.map(f32::from)),
    })
}

/// The ink that the regions' own lines do not draw. `order` is the labels back to front, `lines` and `borders` are by place in it.
pub(super) fn inner_lines(
    canvas: &Canvas,
    ink: &Ink,
    areas: &Areas,
    order: &[u16],
    borders: &[Borders],
    lines: &[Option<Line>],
) -> Vec<InnerLine> {
    let mut rank = vec![0; areas.colors.len()];
    for (place, label) in order.iter().enumerate() {
        rank[usize::from(*label)] = place as u32 + 1;
    }
    let drawn = drawn(canvas, borders, lines);
    let is_inked = |label: u16| {
        let color = areas.colors[usize::from(label)];
        label > 0 && super::canvas::apart(color, ink.color.map(f32::from)) <= INK_COLORED
    };
    let mut rest = vec![0_u16; areas.labels.len()];
    for at in canvas.rows().flatten() {
        let label = areas.labels[at];
        let is_drawn = drawn[at] > 0 && drawn[at] >= rank[usize::from(label)];
        if ink.parts[at] == Part::Line && !is_drawn && !is_inked(label) {
            rest[at] = FREE;
        }
    }
    let groups = kept_groups(canvas, ink, rest);
    let mut labels = vec![0; areas.labels.len()];
    for (index, group) in groups.iter().enumerate() {
        for &at in group {
            labels[at] = index as u16 + 1;
        }
    }
    let crossing = |a: usize, b: usize| {
        let covered = |at: usize| f64::from(ink.cover[at]) / 255.0;
        let inside = (covered(a) + covered(b) - 0.5).clamp(0.001, 0.999);
        if labels[a] > 0 { inside } else { 1.0 - inside }
    };
    let mut map = Map::new(&labels, canvas.width, groups.len() + 1);
    let mut result = Vec::new();
    for (index, group) in groups.iter().enumerate() {
        let rings = map.borders(&[index as u16 + 1], &crossing).rings;
        let outline = resolve_overlaps(rings, FillRule::NonZero);
        if outline.polygons.is_empty() {
            continue;
        }
        let mut counts = vec![0_usize; order.len() + 1];
        for &at in group {
            counts[rank[usize::from(areas.labels[at])] as usize] += 1;
        }
        let most = (1..counts.len()).max_by_key(|place| counts[*place]);
        result.push(InnerLine {
            outline,
            color: straight(ink.color.map(f32::from)),
            region: most
                .filter(|place| counts[*place] > 0)
                .map(|place| place - 1),
        });
    }
    result
}

/// The square of the distance from the ink's colour within which a region is dark anyway, in steps of 1/255.
const INK_COLORED: f32 = 416.0;

/// By pixel, the last of the regions whose line covers it, from 1.
fn drawn(canvas: &Canvas, borders: &[Borders], lines: &[Option<Line>]) -> Vec<u32> {
    let mut drawn = vec![0_u32; canvas.pixels.len()];
    for (place, (borders, line)) in borders.iter().zip(lines).enumerate() {
        let Some(line) = line else {
            continue;
        };
        let radius = line.width / 2.0 + SOFT;
        let reach = radius.ceil() as isize;
        for point in &borders.dense {
            let (x, y) = (point.x + PAD as f64 - 0.5, point.y + PAD as f64 - 0.5);
            let (column, row) = (x.round() as isize, y.round() as isize);
            for row in (row - reach).max(0)..(row + reach + 1).min(canvas.height as isize) {
                for column in
                    (column - reach).max(0)..(column + reach + 1).min(canvas.width as isize)
                {
                    let (dx, dy) = (column as f64 - x, row as f64 - y);
                    if dx * dx + dy * dy <= radius * radius {
                        drawn[row as usize * canvas.width + column as usize] = place as u32 + 1;
                    }
                }
            }
        }
    }
    drawn
}

/// The pixels of each inner line.
fn kept_groups(canvas: &Canvas, ink: &Ink, mut rest: Vec<u16>) -> Vec<Vec<usize>> {
    let marked: Vec<usize> = (0..rest.len()).filter(|at| rest[*at] == FREE).collect();
    let depth = spread(canvas, &mut rest);
    let is_marked = |at: usize| depth.squared[at] > 0;
    let mut groups = groups(depth.squared.len(), &marked, &canvas.around(), is_marked);
    groups.retain(|group| {
        let deepest = |depth: &super::spread::Spread| {
            let depths = group.iter().map(|at| depth.squared[*at]);
            (depths.max().unwrap_or(0) as f32).sqrt()
        };
        let width = 2.0 * deepest(&ink.depth) - 1.0;
        let is_long = group.len() as f32 >= SHORTEST * width * width;
        is_long
            && group.len() >= min_area(canvas)
            && deepest(&depth) >= SLIVER * deepest(&ink.depth)
    });
    groups.truncate(usize::from(u16::MAX / 2));
    let mut is_taken = vec![false; depth.squared.len()];
    for &at in groups.iter().flatten() {
        is_taken[at] = true;
    }
    for group in &mut groups {
        let mut from = 0;
        for _ in 0..JOINT {
            let to = group.len();
            for index in from..to {
                for offset in canvas.around() {
                    let at = group[index].wrapping_add_signed(offset);
                    let is_line = ink.parts[at] == Part::Line;
                    if is_line && !std::mem::replace(&mut is_taken[at], true) {
                        group.push(at);
                    }
                }
            }
            from = to;
        }
    }
    groups
}
