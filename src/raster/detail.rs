//! Details without flat pixels, such as thin mouths.

use super::canvas::{Canvas, Color, mixture, mixture_of_three};
use super::fill::Seeds;
use super::ink::{Ink, is_line};
use super::luma::LumaChroma;
use super::seeds::{MAX_REGIONS, min_area};
use crate::regions::groups;

/// Colours farther than this (0.08) from a mixture, squared, are not mixed of those, in steps of 1/255.
const FAR: f32 = 416.0;
/// The most colours around a pixel that are tried.
const MAX_NEAR: usize = 8;

/// So many regions, the first, are tried as a part of what shows between two lines.
const MAX_MIXED: usize = 64;
/// A group joins a thin region if at least this much of its colour is the region's.
const JOINED: f32 = 0.3;

/// Makes regions of connected pixels that are not a mixture of the colours around them.
pub(super) fn add_details(canvas: &Canvas, seeds: &mut Seeds, ink: Option<&Ink>) {
    // A picture that is mostly not flat is a photograph, where every other pixel would be a detail.
    let flat = seeds.is_fixed.iter().filter(|is_fixed| **is_fixed).count();
    if flat < canvas.pixels.len() / 2 {
        return;
    }
    let mut strangeness = vec![0.0_f32; canvas.pixels.len()];
    let mut strange: Vec<usize> = Vec::new();
    for at in canvas.rows().flatten() {
        if seeds.is_fixed[at] || is_line(ink, at) {
            continue;
        }
        let distance = distance_from_mixtures(canvas, seeds, ink, at);
        if distance > FAR {
            strangeness[at] = distance;
            strange.push(at);
        }
    }
    let is_strange = |at: usize| strangeness[at] > 0.0;
    let mut groups = groups(strangeness.len(), &strange, &canvas.around(), is_strange);
    let is_dirty = canvas.flat_colors.is_some();
    groups.retain(|group| {
        group.len() >= min_area(canvas) && !(is_dirty && is_fringe(canvas, seeds, group))
    });
    groups.sort_by_key(|group| usize::MAX - group.len());
    groups.truncate((MAX_REGIONS + 1).saturating_sub(seeds.colors.len()));
    for group in groups {
        add_group(canvas, seeds, &group, &strangeness);
    }
}

/// Whether a group is what a JPEG file makes of the edge between two of the regions around it.
fn is_fringe(canvas: &Canvas, seeds: &Seeds, group: &[usize]) -> bool {
    let near = labels_around(canvas, seeds, group);
    let color = |label: u16| LumaChroma::of(seeds.colors[usize::from(label)]);
    let own = LumaChroma::of(mean(canvas, group));
    near.iter().enumerate().any(|(index, a)| {
        let mut others = near[index + 1..].iter();
        others.any(|b| own.is_fringe(color(*a), color(*b)))
    })
}

/// The labels of a group's pixels and beside them, in ascending order.
fn labels_around(canvas: &Canvas, seeds: &Seeds, group: &[usize]) -> Vec<u16> {
    let mut near: Vec<u16> = Vec::new();
    for &at in group {
        for offset in canvas.around() {
            let label = seeds.labels[at.wrapping_add_signed(offset)];
            if !near.contains(&label) {
                near.push(label);
            }
        }
    }
    near.sort_unstable();
    near
}

/// The mean colour of some pixels, at least one.
fn mean(canvas: &Canvas, pixels: &[usize]) -> Color {
    let mut color: Color = [0.0; 4];
    for &at in pixels {
        for (sum, channel) in color.iter_mut().zip(canvas.pixels[at]) {
            *sum += f32::from(channel) / pixels.len() as f32;
        }
    }
    color
}

/// The square of the distance of a pixel's colour from the nearest mixture of its region's with another around it.
fn distance_from_mixtures(canvas: &Canvas, seeds: &Seeds, ink: Option<&Ink>, at: usize) -> f32 {
    let mut near: Vec<u16> = vec![seeds.labels[at]];
    let is_thin = |label: u16| seeds.is_thin.get(usize::from(label)) == Some(&true);
    let mut is_inked = false;
    for other in canvas.window(at) {
        let label = seeds.labels[other];
        if near.len() < MAX_NEAR && !near.contains(&label) && !is_thin(label) {
            near.push(label);
        }
        is_inked |= is_line(ink, other);
    }
    let color = canvas.color(at);
    let label_color = |label: &u16| seeds.colors[usize::from(*label)];
    let own = label_color(&seeds.labels[at]);
    let mut colors: Vec<Color> = near.iter().map(label_color).collect();
    if let Some(ink) = ink.filter(|_| is_inked) {
        colors.push(ink.color.map(f32::from));
    }
    let mut least = f32::INFINITY;
    for &other in &colors {
        least = least.min(mixture(color, own, other).1);
    }
    // Where three colours meet, a pixel may have a share of each.
    let far = if least > FAR { &colors[..] } else { &[] };
    for (index, &second) in far.iter().enumerate() {
        for &third in &far[index + 1..] {
            least = least.min(mixture_of_three(color, [own, second, third]));
        }
    }
    match ink.filter(|_| least > FAR && is_inked) {
        Some(ink) if is_sliver(canvas, seeds, ink, at) => 0.0,
        _ => least,
    }
}

/// Whether a pixel beside a line mixes ink and the colour of any region: what shows between two lines is no detail.
fn is_sliver(canvas: &Canvas, seeds: &Seeds, ink: &Ink, at: usize) -> bool {
    let beside = canvas.beside();
    let is_beside = beside
        .iter()
        .any(|offset| ink.is_line(at.wrapping_add_signed(*offset)));
    let dark = ink.color.map(f32::from);
    let colors = seeds.colors.iter().take(MAX_MIXED);
    let mut mixtures = colors.map(|color| mixture(canvas.color(at), *color, dark));
    is_beside && mixtures.any(|(share, distance)| share > 0.1 && distance <= FAR)
}

/// Gives a group its colour and its label. Its colour is that of the stranger half; pixels that are mostly in their region's
/// colour stay there.
fn add_group(canvas: &Canvas, seeds: &mut Seeds, group: &[usize], strangeness: &[f32]) {
    let mut stranger = group.to_vec();
    stranger.sort_by(|a, b| strangeness[*b].total_cmp(&strangeness[*a]).then(a.cmp(b)));
    stranger.truncate(group.len().div_ceil(2));
    let color = mean(canvas, &stranger);
    let joined = thin_neighbor(canvas, seeds, group, color);
    let is_mostly = |at: &usize| match joined {
        Some([own, label]) => {
            let [own, label] = [own, label].map(|label| seeds.colors[usize::from(label)]);
            mixture(canvas.color(*at), own, label).0 >= 0.5
        }
        None => {
            let own = seeds.colors[usize::from(seeds.labels[*at])];
            mixture(canvas.color(*at), own, color).0 >= 0.5
        }
    };
    let mut kept: Vec<usize> = group.iter().copied().filter(is_mostly).collect();
    if kept.len() < min_area(canvas) && joined.is_none() {
        kept = group.to_vec();
    }
    let joined = joined.map(|[_, label]| label);
    let label = joined.unwrap_or(seeds.colors.len() as u16);
    if joined.is_none() {
        seeds.colors.push(color);
    }
    for &at in &kept {
        seeds.labels[at] = label;
        seeds.is_fixed[at] = true;
    }
    bridge(canvas, seeds, &kept, label, strangeness);
}

/// The region around a group, and the thin region beside it that the group continues: one whose colour the group's mixes with
/// that of the region around both.
fn thin_neighbor(
    canvas: &Canvas,
    seeds: &Seeds,
    group: &[usize],
    color: Color,
) -> Option<[u16; 2]> {
    let near = labels_around(canvas, seeds, group);
    let is_thin = |label: &u16| seeds.is_thin.get(usize::from(*label)) == Some(&true);
    let color_of = |label: u16| seeds.colors[usize::from(label)];
    let own = near.iter().copied().find(|label| !is_thin(label))?;
    let fits = |label: &u16| {
        // Either of both may show more of the detail's true colour.
        let pairs = [(color, color_of(*label)), (color_of(*label), color)];
        pairs.into_iter().any(|(mixed, pure)| {
            let (share, distance) = mixture(mixed, color_of(own), pure);
            share >= JOINED && distance <= FAR
        })
    };
    let label = near.iter().copied().filter(is_thin).find(fits)?;
    Some([own, label])
}

/// Pixels that touch only at a corner are joined by the stranger of the two pixels between them.
fn bridge(canvas: &Canvas, seeds: &mut Seeds, kept: &[usize], label: u16, strangeness: &[f32]) {
    let width = canvas.width as isize;
    for &at in kept {
        for [across, down] in [[1, width], [-1, width]] {
            let step = |offset: isize| at.wrapping_add_signed(offset);
            let between = [step(across), step(down)];
            let is_joined = between.iter().any(|at| seeds.labels[*at] == label);
            if seeds.labels[step(across + down)] != label || is_joined {
                continue;
            }
            let [first, second] = between;
            let joint = if strangeness[first] >= strangeness[second] {
                first
            } else {
                second
            };
            if !canvas.is_rim(joint) && !seeds.is_fixed[joint] {
                seeds.labels[joint] = label;
                seeds.is_fixed[joint] = true;
            }
        }
    }
}
