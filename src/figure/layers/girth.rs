//! Hats, skirts and trousers of figures: they are round about what wears them, as deep as that and a little more.
//!
//! Blown up like all else, a hat would be thinner than the head below it, with a brim at its sides only, and a skirt would close
//! at the hem like a sack.

use std::sync::Arc;

use typed_index_collections::TiVec;

use super::super::FigureContext;
use super::nodes::{Nodes, RootedShapes};
use super::overlaps::{Overlap, SAMPLES, Scratch};
use super::shapes::Shape;
use super::{Cover, node_depths::quantile};
use crate::bind::{Garment, Part, PartId, Seen};
use crate::geometry::Outline;
use crate::math;
use crate::solid::{Girth, Profile, Section};

/// The number of sections.
const SECTIONS: usize = 96;
/// How deep a section of a skirt or of trousers is at the hips, and of a leg, in its widths.
const HIPS: f64 = 0.75;
const LEG: f64 = 0.9;
/// The same for a hat whose head does not say.
const HEAD: f64 = 0.9;
/// The limits of these.
const RATIOS: [f64; 2] = [0.5, 1.4];
/// How much deeper a garment is than what it is around.
const ROOM: f64 = 1.06;
/// How far a section reaches to the front at most, as a share of the figure's width, if what is inside reaches no farther.
const DEEPEST: f64 = 0.27;
/// How quickly sections turn from as round as they would be to the deepest.
const TURN: f64 = 4.0;
/// Over how much of the hips' half width trousers change from hips to legs.
const CROTCH: f64 = 0.6;
/// Where the waist of a dress is at least and at most, from its top, in its heights.
const WAIST: [f64; 2] = [0.15, 0.65];
/// How much wider than its waist the hem of a dress is, at least.
const FLARED: f64 = 1.25;
/// Over how much of its skirt a dress changes from the body's form.
const FADE: f64 = 0.3;

/// A garment, and what is inside it: the head with its hair, or what a skirt hangs on.
pub(super) struct Worn {
    shape: usize,
    garment: Garment,
    inside: Vec<usize>,
}

/// The shapes that are garments, in drawings that never say `Shape`. `details` says per shape whether it lies on others.
pub(super) fn find(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    nodes: &Nodes,
    figures: &RootedShapes,
    details: &[bool],
) -> Vec<Worn> {
    let parts = &context.bindings.parts;
    if !context.bindings.is_first_look {
        return Vec::new();
    }
    // Names are read once: many shapes are compared with each garment.
    let garments: TiVec<PartId, Option<Garment>> = parts.iter().map(Part::garment).collect();
    if garments.iter().all(Option::is_none) {
        return Vec::new();
    }
    let of_shape = |index: usize| {
        let shape = &shapes[index];
        let is_free = !shape.is_ink
            && !shape.is_given
            && !details[index]
            && matches!(shape.profile, Profile::Inflate(_));
        if !is_free {
            return None;
        }
        let garment = garments[shape.part].or(garments[shape.main])?;
        let node = nodes.of_shape[index];
        let is_in_another = !shape.is_main && garments[shape.main].is_none();
        let carrier = if is_in_another {
            Some(node)
        } else {
            nodes.parent[node]
        };
        let mut above = std::iter::successors(carrier, |node| nodes.parent[*node]);
        let is_hat = garment == Garment::Hat;
        let wearer = if is_hat {
            Some(above.find(|node| parts[nodes.main[*node]].is_head())?)
        } else {
            above.next()
        };
        let is_turned = !matches!(context.seen[shape.main], Seen::FromFront | Seen::FromBehind);
        if !is_hat && is_turned {
            return None;
        }
        let is_inside = |other: &usize| {
            let volume = &shapes[*other];
            let node = nodes.of_shape[*other];
            let is_of_wearer = wearer
                .is_some_and(|wearer| node == wearer || is_hat && nodes.hangs_on(node, wearer));
            let worn = [volume.part, volume.main].map(|part| garments[part]);
            is_of_wearer
                && volume.is_soft
                && !volume.is_ink
                && !details[*other]
                && worn == [None; 2]
        };
        Some(Worn {
            shape: index,
            garment,
            inside: figures
                .shapes(node)
                .iter()
                .copied()
                .filter(is_inside)
                .collect(),
        })
    };
    (0..shapes.len()).filter_map(of_shape).collect()
}

/// Makes garments round about their wearers, whose heights are known, and lets them close behind these.
pub(super) fn lay(
    shapes: &mut [Shape],
    worn: &[Worn],
    nodes: &Nodes,
    figures: &RootedShapes,
    overlaps: &[Vec<Overlap>],
    covers: &mut [Cover],
) {
    for own in worn {
        let width = figures.width(nodes.of_shape[own.shape]);
        let mut girth = sections(&shapes[own.shape]);
        let inside = &own.inside;
        let ratio = ratio(shapes, own.shape, inside, &girth);
        let is_hat = own.garment == Garment::Hat;
        let ratio = match ratio {
            Some(ratio) if !is_hat => ratio.max(HIPS),
            Some(ratio) => ratio,
            None if is_hat => HEAD,
            None => HIPS,
        };
        let ratio = ratio.clamp(RATIOS[0], RATIOS[1]);
        for section in girth.sections.iter_mut().flatten() {
            section.depth = ratio * section.half;
        }
        match own.garment {
            Garment::Trousers => join_legs(&mut girth),
            Garment::Dress => match waist(&girth) {
                Some(from) => girth.from = Some(from),
                None => continue,
            },
            _ => {}
        }
        let heights = inside.iter().map(|inside| ROOM * shapes[*inside].height());
        limit(&mut girth, heights.fold(DEEPEST * width, f64::max));
        shapes[own.shape].girth = Some(Arc::new(girth));
        let below = overlaps[own.shape].iter().map(|overlap| overlap.below);
        let wrapped = below.filter(|below| inside.contains(below));
        covers[own.shape].wraps.extend(wrapped);
        covers[own.shape].wraps.sort_unstable();
        covers[own.shape].wraps.dedup();
    }
}

/// The sections of a shape, without depths.
fn sections(shape: &Shape) -> Girth {
    let (low, high) = shape.bounds;
    let step = (high.y - low.y) / SECTIONS as f64;
    let first = low.y + step / 2.0;
    let section = |[start, end]: [f64; 2]| Section {
        middle: start.midpoint(end),
        half: (end - start) / 2.0,
        depth: 0.0,
    };
    let line = |crossings: Vec<f64>| {
        let pairs = crossings.chunks_exact(2);
        pairs.map(|pair| section([pair[0], pair[1]])).collect()
    };
    let lines = crossings(&shape.outline, first, step);
    Girth {
        first,
        step,
        sections: lines.into_iter().map(line).collect(),
        from: None,
    }
}

/// Where an outline crosses level lines, from left to right.
fn crossings(outline: &Outline, first: f64, step: f64) -> Vec<Vec<f64>> {
    let mut lines: Vec<Vec<f64>> = vec![Vec::new(); SECTIONS];
    let rings = outline.rings();
    for ring in rings {
        let next = ring.iter().cycle().skip(1);
        for (from, to) in ring.iter().zip(next) {
            let (low, high) = if from.y < to.y {
                (from, to)
            } else {
                (to, from)
            };
            let slope = (high.x - low.x) / (high.y - low.y);
            let start = ((low.y - first) / step).ceil().max(0.0) as usize;
            for (index, line) in lines.iter_mut().enumerate().skip(start) {
                let y = first + step * index as f64;
                if y >= high.y {
                    break;
                }
                if y >= low.y {
                    line.push(low.x + (y - low.y) * slope);
                }
            }
        }
    }
    lines
        .iter_mut()
        .for_each(|line| line.sort_unstable_by(f64::total_cmp));
    lines
}

/// How deep sections have to be to be around what is inside, in their widths.
fn ratio(shapes: &[Shape], own: usize, inside: &[usize], girth: &Girth) -> Option<f64> {
    let round = Girth {
        sections: girth.sections.iter().map(|line| round(line)).collect(),
        ..girth.clone()
    };
    let mut scratch = Scratch::default();
    let mut ratios = Vec::new();
    for inside in inside {
        let points = scratch
            .samples(&shapes[own], &shapes[*inside], SAMPLES)
            .into_iter();
        ratios.extend(points.filter_map(|point| {
            let around = round.around(point);
            let inside = shapes[*inside].front(point);
            (around > 0.0).then(|| ROOM * inside / around)
        }));
    }
    (!ratios.is_empty()).then(|| quantile(ratios))
}

fn round(line: &[Section]) -> Vec<Section> {
    let round = |section: &Section| Section {
        depth: section.half,
        ..*section
    };
    line.iter().map(round).collect()
}

/// Lets the depths of trousers change smoothly from the hips, which are one section, to the legs.
fn join_legs(girth: &mut Girth) {
    let widest = |line: &Vec<Section>| line.iter().map(|section| section.half).fold(0.0, f64::max);
    let hips = girth.sections.iter().map(widest).fold(0.0, f64::max);
    let depth = |line: &Vec<Section>| {
        let ratio = if line.len() > 1 { LEG } else { HIPS };
        ratio * widest(line)
    };
    let depths: Vec<f64> = girth.sections.iter().map(depth).collect();
    let reach = ((CROTCH * hips / girth.step) as usize).min(SECTIONS);
    for (index, line) in girth.sections.iter_mut().enumerate() {
        let near = &depths[index.saturating_sub(reach)..(index + reach + 1).min(depths.len())];
        let depth = near.iter().sum::<f64>() / near.len() as f64;
        let widest = widest(line);
        for section in line.iter_mut().filter(|_| widest > 0.0) {
            section.depth = depth * section.half / widest;
        }
    }
}

/// Between which y a dress turns from the body's form into a skirt; `None` if it is no wider at the hem than at the waist.
fn waist(girth: &Girth) -> Option<[f64; 2]> {
    let width = |line: &Vec<Section>| line.iter().map(|section| 2.0 * section.half).sum::<f64>();
    let [from, to] = WAIST.map(|share| (share * SECTIONS as f64) as usize);
    let waist = (from..to).min_by(|a, b| {
        let [a, b] = [*a, *b].map(|index| width(&girth.sections[index]));
        a.total_cmp(&b)
    })?;
    let hem = girth.sections[waist..]
        .iter()
        .map(width)
        .fold(0.0, f64::max);
    let y = |index: f64| girth.first + index * girth.step;
    let below = FADE * (SECTIONS - waist) as f64;
    (hem >= FLARED * width(&girth.sections[waist]))
        .then(|| [y(waist as f64), y(waist as f64 + below)])
}

/// Makes sections no deeper than this: those that are shallower by far stay as they are.
fn limit(girth: &mut Girth, most: f64) {
    for section in girth.sections.iter_mut().flatten() {
        let share = section.depth / most;
        section.depth /= math::powf(1.0 + math::powf(share, TURN), 1.0 / TURN);
    }
}
