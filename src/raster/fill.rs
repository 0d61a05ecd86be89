//! Labels for all pixels: seeds grow over edges and ink.

use super::Seen;
use super::canvas::{Canvas, Color, apart, mixture, mixture_of_three};
use super::components::{Component, components};
use super::detail::add_details;
use super::ink::{Ink, Part, is_line};
use super::seeds::{FRINGE_DISTANCE, FRINGE_SIDE, Kind, MAX_REGIONS, is_large, min_area};
use super::spread::{FREE, Spread, WALL, spread};

/// How often the pixels of soft edges choose the neighbour whose colour is nearest.
const PASSES: usize = 3;

/// The share of a sliver's pixels that lie beside a line.
const SLIVER_PIXELS: f64 = 0.8;

/// The regions as labels.
#[derive(Debug)]
pub(super) struct Areas {
    /// By pixel, 0 in the background.
    pub(super) labels: Vec<u16>,
    /// By label, the mean colour, premultiplied.
    pub(super) colors: Vec<Color>,
    /// By pixel of a line, the distance to the nearest region's own pixels.
    pub(super) reach: Spread,
}

/// Seeds on their way to areas.
pub(super) struct Seeds {
    pub(super) labels: Vec<u16>,
    /// Whether a pixel had its label before the others took theirs from neighbours.
    pub(super) is_fixed: Vec<bool>,
    /// By label, premultiplied.
    pub(super) colors: Vec<Color>,
    /// By label, whether it is too thin to mix with pixels 2 pixels away.
    pub(super) is_thin: Vec<bool>,
}

/// Labels each pixel of a picture.
pub(super) fn fill(seen: &Seen<'_>, kinds: &[Kind], ink: Option<&Ink>) -> Areas {
    let canvas = seen.canvas;
    let mut seeds = seeds(seen, kinds, ink);
    // Lines are divided between the regions that they separate, not taken by dark regions at their ends.
    let mut dark: Vec<(usize, u16)> = Vec::new();
    for (at, label) in seeds.labels.iter_mut().enumerate() {
        if *label != FREE && ink.is_some_and(|ink| ink.is_thick(at)) {
            dark.push((at, std::mem::replace(label, WALL)));
        }
    }
    let reach = spread(canvas, &mut seeds.labels);
    for (at, label) in dark {
        seeds.labels[at] = label;
    }
    // What only dark regions surround was not reached.
    spread(canvas, &mut seeds.labels);
    add_details(canvas, &mut seeds, ink);
    sharpen(canvas, &mut seeds, ink);
    connect(canvas, &mut seeds);
    let colors = mean_colors(canvas, &seeds);
    Areas {
        labels: seeds.labels,
        colors,
        reach,
    }
}

fn seeds(seen: &Seen<'_>, kinds: &[Kind], ink: Option<&Ink>) -> Seeds {
    let (canvas, palette) = (seen.canvas, seen.palette);
    let (found, ids) = (seen.components, seen.ids);
    let is_sliver = slivers(seen, ink);
    let mut colors = vec![canvas.background.map(f32::from)];
    let mut is_thin = vec![false];
    let mut by_component = vec![FREE; found.len()];
    for (index, component) in found.iter().enumerate() {
        let is_ink = ink.is_some_and(|ink| ink.class == component.class);
        match kinds[index] {
            Kind::Background => by_component[index] = 0,
            Kind::Region if !is_ink && !is_sliver[index] => {
                by_component[index] = colors.len() as u16;
                colors.push(palette.colors[usize::from(component.class)].map(f32::from));
                is_thin.push(component.square < FRINGE_SIDE);
            }
            Kind::Region | Kind::Rest => {}
        }
    }
    let mut labels: Vec<u16> = ids.iter().map(|id| by_component[*id as usize]).collect();
    if let Some(ink) = ink {
        let thick: Vec<u16> = ink
            .parts
            .iter()
            .map(|part| u16::from(*part == Part::Thick))
            .collect();
        let (blobs, blob_ids) = components(&thick, canvas.width);
        let min_area = min_area(canvas);
        let mut by_blob = vec![FREE; blobs.len()];
        for (index, blob) in blobs.iter().enumerate() {
            if blob.class == 1 && is_large(blob, min_area) && colors.len() <= MAX_REGIONS {
                by_blob[index] = colors.len() as u16;
                colors.push(ink.color.map(f32::from));
            }
        }
        for (at, part) in ink.parts.iter().enumerate() {
            match part {
                Part::None => {}
                Part::Line => labels[at] = FREE,
                Part::Thick => labels[at] = by_blob[blob_ids[at] as usize],
            }
        }
    }
    // The soft rim of dark regions chooses its side like other soft edges.
    let is_soft = |at: usize| ink.is_some_and(|ink| ink.is_thick(at) && ink.cover[at] < u8::MAX);
    let is_fixed = (0..labels.len())
        .map(|at| labels[at] != FREE && !is_soft(at))
        .collect();
    Seeds {
        labels,
        is_fixed,
        colors,
        is_thin,
    }
}

/// By component, whether it is what shows between two lines: thin, along lines, its colour mixed of ink and a larger region's.
fn slivers(seen: &Seen<'_>, ink: Option<&Ink>) -> Vec<bool> {
    let (canvas, palette) = (seen.canvas, seen.palette);
    let (found, ids) = (seen.components, seen.ids);
    let mut lined = vec![0_usize; found.len()];
    let Some(ink) = ink else {
        return vec![false; found.len()];
    };
    let beside = canvas.beside();
    for at in canvas.rows().flatten() {
        let component = &found[ids[at] as usize];
        let is_beside = |offset: &isize| ink.is_line(at.wrapping_add_signed(*offset));
        if component.square < FRINGE_SIDE && beside.iter().any(is_beside) {
            lined[ids[at] as usize] += 1;
        }
    }
    let dark = ink.color.map(f32::from);
    let is_sliver = |(component, lined): (&Component, &usize)| {
        let along = *lined as f64 >= SLIVER_PIXELS * component.area as f64;
        let color = |class: u16| palette.colors.get(usize::from(class)).copied();
        let Some(own) = color(component.class).filter(|_| along) else {
            return false;
        };
        let own = own.map(f32::from);
        let background = canvas.background.map(f32::from);
        let is_mixed = |other: &[u8; 4]| {
            let other = other.map(f32::from);
            let (share, distance) = mixture(own, other, dark);
            let with_background = mixture_of_three(own, [other, dark, background]);
            let is_other = apart(own, other) > FRINGE_DISTANCE;
            is_other
                && ((0.1..0.9).contains(&share) && distance <= FRINGE_DISTANCE
                    || with_background <= FRINGE_DISTANCE)
        };
        palette.colors.iter().any(is_mixed)
    };
    found.iter().zip(&lined).map(is_sliver).collect()
}

/// Pixels of soft edges join the neighbour whose colour is nearest.
fn sharpen(canvas: &Canvas, seeds: &mut Seeds, ink: Option<&Ink>) {
    let beside = canvas.beside();
    let soft: Vec<usize> = canvas
        .rows()
        .flatten()
        .filter(|at| !seeds.is_fixed[*at] && !is_line(ink, *at))
        .collect();
    for _ in 0..PASSES {
        let mut changed = false;
        for &at in &soft {
            let own = seeds.labels[at];
            let neighbors = beside.map(|offset| seeds.labels[at.wrapping_add_signed(offset)]);
            if neighbors == [own; 4] {
                continue;
            }
            let color = canvas.color(at);
            let distance = |label: u16| apart(color, seeds.colors[usize::from(label)]);
            let mut best = (distance(own), own);
            for label in neighbors {
                if distance(label) < best.0 {
                    best = (distance(label), label);
                }
            }
            changed |= best.1 != own;
            seeds.labels[at] = best.1;
        }
        if !changed {
            break;
        }
    }
}

/// Each region is one component: its smaller ones, and specks of background, go to what is around them.
fn connect(canvas: &Canvas, seeds: &mut Seeds) {
    let (found, ids) = components(&seeds.labels, canvas.width);
    let mut is_seeded = vec![false; found.len()];
    for (id, is_fixed) in ids.iter().zip(&seeds.is_fixed) {
        is_seeded[*id as usize] |= is_fixed;
    }
    let mut largest: Vec<Option<usize>> = vec![None; seeds.colors.len()];
    for (id, component) in found.iter().enumerate() {
        let largest = &mut largest[usize::from(component.class)];
        if largest.is_none_or(|other| found[other].area < component.area) {
            *largest = Some(id);
        }
    }
    let is_kept: Vec<bool> = found
        .iter()
        .enumerate()
        .map(|(id, component)| match component.class {
            0 => is_seeded[id],
            label => largest[usize::from(label)] == Some(id),
        })
        .collect();
    if is_kept.iter().all(|is_kept| *is_kept) {
        return;
    }
    for (at, id) in ids.iter().enumerate() {
        if !is_kept[*id as usize] {
            seeds.labels[at] = FREE;
        }
    }
    spread(canvas, &mut seeds.labels);
}

/// The mean colour of each label's own pixels.
fn mean_colors(canvas: &Canvas, seeds: &Seeds) -> Vec<Color> {
    let mut sums = vec![([0_u64; 4], 0_u64); seeds.colors.len()];
    for (at, label) in seeds.labels.iter().enumerate() {
        if seeds.is_fixed[at] {
            let (sum, count) = &mut sums[usize::from(*label)];
            for (sum, channel) in sum.iter_mut().zip(canvas.pixels[at]) {
                *sum += u64::from(channel);
            }
            *count += 1;
        }
    }
    let mean = |((sum, count), color): (([u64; 4], u64), &Color)| match count {
        0 => *color,
        _ => sum.map(|sum| (sum as f64 / count as f64) as f32),
    };
    let mut colors: Vec<Color> = sums.into_iter().zip(&seeds.colors).map(mean).collect();
    if let Some(background) = colors.first_mut() {
        *background = canvas.background.map(f32::from);
    }
    colors
}
