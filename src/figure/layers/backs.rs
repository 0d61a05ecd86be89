//! What the backs of volumes show: hair behind a face, the back of a jacket.
//!
//! A drawing says what is in front. From behind, the model shows at each point what the silhouette has nearest to it: where a
//! shape goes along the border of a volume, on it or behind it, it closes behind the volume. It becomes a skin on the volume's
//! back, in the paint of that shape, and moves with it.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::overlaps::Overlap;
use super::shapes::Shape;
use super::{Cover, FigureContext, Nodes, wraps};
use crate::bind::Side;
use crate::geometry::{Bands, Outline, Polygon, Ring, area, bounds, intersect, offset, shoelace};
use crate::threads::GRAIN;

/// Points along the border of a volume.
const SAMPLES: usize = 240;
/// How far inside the border what lies there is looked at, as a share of the volume's width: dark outlines are narrower.
const INSIDE: f64 = 0.1;
/// How far inside the border what covers the border itself is looked at, in distances inside it.
const RIM: f64 = 0.2;
/// How far outside the border what lies behind is looked at, in distances inside it.
const OUTSIDE: f64 = 0.3;
/// The distance inside at most, as a share of the volume's thickness there.
const INSIDE_THIN: f64 = 0.35;
/// The share of the border from which on what goes along it from above, as hair and hats do, closes behind.
const FROM_ABOVE: f64 = 0.28;
/// The share of the border from which on anything that covers it does: jackets.
const AROUND: f64 = 0.6;
/// Of the samples at the border that something covers, the share that it covers farther inside, unless it is an outline.
const NO_OUTLINE: f64 = 0.5;
/// The share of a dark rim that its fill covers, and the share of the fill that lies on the rim, at least.
const FILL: f64 = 0.78;
const INSIDE_RIM: f64 = 0.93;
/// The share of the topmost border points that what comes from above covers, and how many those are.
const TOP: f64 = 0.6;
const TOPMOST: usize = 24;
/// How far hair comes down on the back of a head whose front shows it at the top, as a share of the head's height.
const NAPE: f64 = 0.85;
/// Gaps between samples up to this share of the border are closed.
const GAP: f64 = 0.05;
/// Coverage of the border from which on the whole back is covered.
const WHOLE: f64 = 0.85;
/// The share of both a volume and an earlier shape that they have in common, if that closes behind the volume.
const BEHIND: f64 = 0.3;
/// How far apart colours are at most that count as the same, in levels of 8 bits.
const ALIKE: f64 = 30.0;
/// Shapes that cover less of a volume do not go along enough of its border.
const LEAST: f64 = 0.03;

/// A skin on the back of a volume.
#[derive(Debug)]
pub(super) struct Back {
    /// The shape that closes behind.
    pub(super) of: usize,
    /// The volume that it closes behind.
    pub(super) on: usize,
    /// The area of the skin, drawing units.
    pub(super) outline: Arc<Outline>,
    /// If the volume is a plate, the plates that overlap it.
    pub(super) plates: Vec<usize>,
}

/// What may close behind a volume: a later shape that lies on it, or an earlier one that it lies on.
#[derive(Clone, Copy)]
struct Garment {
    shape: usize,
    /// The area that it has in common with the volume.
    area: f64,
    is_later: bool,
    /// Whether it reaches around the volume, so that it has a back of its own there.
    wraps: bool,
}

fn is_plate(shape: &Shape) -> bool {
    !shape.is_soft && !shape.is_ink
}

/// Per shape whether it shows on the back as well, mirrored: details with `Side both`, and those of figures in profile and wheels of
/// vehicles that `Side near` does not keep where they are drawn.
pub(super) fn mirrored(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    covers: &[Cover],
    overlaps: &[Vec<Overlap>],
) -> Vec<bool> {
    let mut mirrored = vec![false; shapes.len()];
    for (index, (shape, cover)) in shapes.iter().zip(covers).enumerate() {
        let is_both = !shape.is_given
            && match context.bindings.side(shape.part) {
                Some(side) => side == Side::Both,
                None => context.seen[shape.main].is_in_profile(),
            };
        let is_below_on_both = |overlap: &Overlap| {
            let below = &shapes[overlap.below];
            context.is_opaque(below.part) && (!below.is_wheel() || mirrored[overlap.below])
        };
        mirrored[index] = is_both
            && if cover.is_detail {
                !shape.is_cord && overlaps[index].iter().all(is_below_on_both)
            } else {
                shape.is_wheel()
            };
    }
    mirrored
}

/// The skins on backs, in the order of their volumes.
pub(super) fn backs(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    nodes: &Nodes,
    overlaps: &[Vec<Overlap>],
    covers: &[Cover],
    is_one: bool,
) -> Vec<Back> {
    if overlaps.iter().all(Vec::is_empty) {
        return Vec::new();
    }
    let is_plate = |index: usize| is_plate(&shapes[index]);
    // From behind, a plate that is drawn first hides those that are drawn on it.
    let is_hidden = |index: usize| {
        let most = AROUND * shapes[index].area;
        let mut below = overlaps[index].iter();
        is_plate(index) && below.any(|overlap| is_plate(overlap.below) && overlap.area >= most)
    };
    let is_hidden: Vec<bool> = (0..shapes.len()).map(is_hidden).collect();
    let may_show_back = |index: usize| {
        let shape = &shapes[index];
        let is_solid = !shape.is_ink && !shape.is_given && !shape.profile.is_open();
        is_solid
            // The far side of a vehicle is like its near one.
            && shape.of_vehicle.is_none()
            && !covers[index].is_detail
            && !is_hidden[index]
            && shape.area > 0.0
            && context.is_opaque(shape.part)
    };
    let may_show_back: Vec<bool> = (0..shapes.len()).map(may_show_back).collect();
    let is_kin = |one: usize, other: usize| {
        let [one, other] = [one, other].map(|shape| nodes.of_shape[shape]);
        is_one || nodes.hangs_on(one, other) || nodes.hangs_on(other, one)
    };
    // What hangs on a shape moves by itself: a shirt is no part of an arm below it, nor a head of the hair around it.
    let is_carried = |one: usize, by: usize| {
        let [node, carrier] = [one, by].map(|shape| nodes.of_shape[shape]);
        node != carrier
            && nodes.hangs_on(node, carrier)
            && !context.bindings.parts[shapes[one].main].is_automatic()
    };
    let mut garments: Vec<Vec<Garment>> = vec![Vec::new(); shapes.len()];
    for (above, below) in overlaps.iter().enumerate() {
        let garment = &shapes[above];
        if garment.is_ink || garment.is_given || garment.is_near {
            continue;
        }
        for overlap in below {
            let on = overlap.below;
            let is_large = overlap.area >= LEAST * shapes[on].area;
            if is_large && may_show_back[on] && is_kin(above, on) && !is_carried(on, above) {
                garments[on].push(Garment {
                    shape: above,
                    area: overlap.area,
                    is_later: true,
                    wraps: covers[above].wraps.contains(&on),
                });
            }
            // Long hair behind a head is about as large as that, which a trunk behind an arm is not.
            let [volume, behind] = [garment.area, shapes[on].area];
            let is_alike = overlap.area >= BEHIND * volume && overlap.area >= BEHIND * behind;
            let is_free = !shapes[on].is_ink && !shapes[on].is_given && !shapes[on].is_near;
            if is_alike
                && is_free
                && may_show_back[above]
                && is_kin(above, on)
                && !is_carried(above, on)
            {
                garments[above].push(Garment {
                    shape: on,
                    area: overlap.area,
                    is_later: false,
                    wraps: false,
                });
            }
        }
    }
    let found = garments.par_iter().enumerate().with_min_len(GRAIN);
    let found = found.map(|(on, garments)| of_volume(context, shapes, on, garments));
    let mut found: Vec<Back> = found.collect::<Vec<_>>().into_iter().flatten().collect();
    add_plates(&mut found, shapes, overlaps);
    found
}

/// Gives skins on plates the plates that overlap these.
fn add_plates(backs: &mut [Back], shapes: &[Shape], overlaps: &[Vec<Overlap>]) {
    let is_plate = |index: usize| is_plate(&shapes[index]);
    let mut near: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
    let volumes = backs.iter().map(|back| back.on);
    near.extend(
        volumes
            .filter(|on| is_plate(*on))
            .map(|on| (on, Vec::new())),
    );
    if near.is_empty() {
        return;
    }
    for (above, below) in overlaps
        .iter()
        .enumerate()
        .filter(|(above, _)| is_plate(*above))
    {
        for below in below
            .iter()
            .map(|overlap| overlap.below)
            .filter(|below| is_plate(*below))
        {
            for (one, other) in [(above, below), (below, above)] {
                if let Some(near) = near.get_mut(&one) {
                    near.push(other);
                }
            }
        }
    }
    for back in backs {
        back.plates = near.get(&back.on).cloned().unwrap_or_default();
    }
}

/// A point of a border.
struct Sample {
    /// The border's point that it comes after.
    edge: usize,
    at: DVec2,
    /// Just inside the border.
    on_border: DVec2,
    /// Far enough inside to be beyond a dark outline.
    inside: DVec2,
    outside: DVec2,
}

/// How far inside the border a skin on a plate ends, as a share of the plate's larger extent: beyond the border it would have nothing
/// to lie on.
const SHRINK: f64 = 1e-3;
/// Pieces of a volume's outline that are smaller than this share of the largest have no skin of their own.
const PIECE: f64 = 0.2;
/// Limit of the pieces that are looked at.
const MAX_PIECES: usize = 8;

/// The skins on the back of a volume that these shapes lie on or behind.
fn of_volume(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    on: usize,
    garments: &[Garment],
) -> Vec<Back> {
    // Quick: most volumes carry only what is small.
    let covered: f64 = garments.iter().map(|garment| garment.area).sum();
    if covered < FROM_ABOVE * INSIDE * shapes[on].area {
        return Vec::new();
    }
    let polygons = shapes[on].solid_outline.polygons.iter();
    let mut pieces: Vec<(f64, &Polygon)> = polygons
        .filter_map(|polygon| Some((shoelace(polygon.rings.first()?).abs(), polygon)))
        .collect();
    let largest = pieces.iter().map(|(area, _)| *area).fold(0.0, f64::max);
    pieces.retain(|(area, _)| *area >= PIECE * largest);
    pieces.truncate(MAX_PIECES);
    let bands = garments
        .iter()
        .map(|garment| Bands::of(&shapes[garment.shape].outline));
    let bands: Vec<Bands> = bands.collect();
    let of_piece = |(_, polygon): (f64, &Polygon)| {
        let outline = Arc::new(Outline {
            polygons: vec![polygon.clone()],
        });
        of_piece(context, shapes, on, (garments, &bands), &outline)
    };
    pieces.into_iter().flat_map(of_piece).collect()
}

/// The skins on the back of a piece of a volume's outline.
fn of_piece(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    on: usize,
    (garments, bands): (&[Garment], &[Bands]),
    outline: &Arc<Outline>,
) -> Vec<Back> {
    let ring = &outline.polygons[0].rings[0];
    let bounds = bounds(outline).unwrap_or_default();
    let size = bounds.1 - bounds.0;
    let samples = samples(ring, outline, INSIDE * size.min_element());
    if samples.is_empty() {
        return Vec::new();
    }
    let mut topmost: Vec<usize> = (0..samples.len()).collect();
    topmost.sort_unstable_by(|a, b| samples[*a].at.y.total_cmp(&samples[*b].at.y));
    topmost.truncate(TOPMOST);
    let piece = Piece {
        context,
        shapes,
        on,
        nape: bounds.0.y + NAPE * size.y,
        worn: worn(shapes, (garments, bands), &samples),
        samples,
        topmost,
    };
    // At the border of a soft volume front and back meet, so that a skin has something to lie on there.
    let inset = (!shapes[on].is_soft).then_some(SHRINK * size.max_element());
    let skin = |same: Vec<Garment>| {
        let along = piece.closes(&same)?;
        let count = along.iter().filter(|is_along| **is_along).count();
        let largest = same
            .iter()
            .max_by(|a, b| a.area.total_cmp(&b.area).then(b.shape.cmp(&a.shape)))?;
        let back = Back {
            of: largest.shape,
            on,
            outline: region(outline, ring, &piece.samples, &along, inset)?,
            plates: Vec::new(),
        };
        Some((count, back))
    };
    let wardrobe = piece.wardrobe(garments).into_iter();
    let mut found: Vec<(usize, Back)> = wardrobe.filter_map(skin).collect();
    // What covers least comes last, so that nothing hides it.
    found.sort_by_key(|(count, back)| (std::cmp::Reverse(*count), back.of));
    found.into_iter().map(|(_, back)| back).collect()
}

/// Per sample the largest of the shapes that cover it on the border and inside: not the highlights on hair, but the hair.
fn worn(
    shapes: &[Shape],
    (garments, bands): (&[Garment], &[Bands]),
    samples: &[Sample],
) -> Vec<[Option<usize>; 2]> {
    let worn = |later: DVec2, earlier: DVec2| {
        let covers = garments.iter().zip(bands).filter(|(garment, bands)| {
            let (low, high) = shapes[garment.shape].bounds;
            let point = if garment.is_later { later } else { earlier };
            point.clamp(low, high) == point && bands.contains(point)
        });
        covers
            .map(|(garment, _)| garment)
            .max_by(|a, b| a.area.total_cmp(&b.area).then(b.shape.cmp(&a.shape)))
            .map(|garment| garment.shape)
    };
    samples
        .iter()
        .map(|sample| [sample.on_border, sample.inside].map(|point| worn(point, sample.outside)))
        .collect()
}

/// A piece of a volume's outline, and what is worn along its border.
struct Piece<'a> {
    context: &'a FigureContext<'a>,
    shapes: &'a [Shape],
    on: usize,
    /// How far hair comes down on it, the drawing's y.
    nape: f64,
    samples: Vec<Sample>,
    worn: Vec<[Option<usize>; 2]>,
    /// The samples nearest to the top of the page.
    topmost: Vec<usize>,
}

impl Piece<'_> {
    /// The garments in groups of about the same colour: what differs only as light and shadow on hair do is one garment.
    fn wardrobe(&self, garments: &[Garment]) -> Vec<Vec<Garment>> {
        let color = |shape: usize| {
            let part = &self.context.bindings.parts[self.shapes[shape].part];
            part.paint(self.context.drawing).color
        };
        let skin = color(self.on);
        let mut wardrobe: Vec<([u8; 3], Vec<Garment>)> = Vec::new();
        for garment in garments {
            let own = color(garment.shape);
            if own == skin {
                continue;
            }
            match wardrobe.iter_mut().find(|(color, _)| is_alike(*color, own)) {
                Some((_, same)) => same.push(*garment),
                None => wardrobe.push((own, vec![*garment])),
            }
        }
        wardrobe.into_iter().map(|(_, same)| same).collect()
    }

    /// Per sample whether garments that are one close behind the volume there; `None` if they do not.
    fn closes(&self, same: &[Garment]) -> Option<Vec<bool>> {
        let goes = self.goes(same);
        let share = |is: &dyn Fn(&[bool; 2]) -> bool| {
            goes.iter().filter(|goes| is(goes)).count() as f64 / goes.len() as f64
        };
        let (on_border, inside) = (share(&|goes| goes[0]), share(&|goes| goes[1]));
        // An outline covers all of the border, and nothing else.
        if on_border >= WHOLE && inside < NO_OUTLINE * on_border {
            return None;
        }
        let has_back = same.iter().all(|garment| garment.wraps);
        let is_worn = on_border >= AROUND && same.iter().any(|garment| garment.is_later);
        let is_rim = inside >= WHOLE && same.iter().any(|garment| self.is_fill(garment));
        let mut along: Vec<bool> = goes.iter().map(|goes| goes[0] || goes[1]).collect();
        close_gaps(&mut along);
        if !has_back && (is_worn || is_rim) {
            return Some(along);
        }
        let share_of_top = self.share_of_top(&along);
        keep_runs(&mut along, &self.topmost);
        let count = along.iter().filter(|is_along| **is_along).count() as f64;
        if share_of_top < TOP || count < FROM_ABOVE * along.len() as f64 {
            return None;
        }
        if same.iter().any(|garment| self.is_hair(garment.shape)) {
            let samples = along.iter_mut().zip(&self.samples);
            samples.for_each(|(along, sample)| *along |= sample.at.y <= self.nape);
        }
        Some(along)
    }

    /// Per sample whether one of these garments covers it on the border and inside.
    fn goes(&self, same: &[Garment]) -> Vec<[bool; 2]> {
        let is_same = |worn: Option<usize>| {
            worn.is_some_and(|worn| same.iter().any(|garment| garment.shape == worn))
        };
        let is_outlined = self.shapes[self.on].is_outlined;
        let goes = self.worn.iter().map(|worn| {
            let [on_border, inside] = worn.map(is_same);
            // What is drawn with an outline of its own is no dark rim: a face within hair leaves the hair as it is.
            [on_border, inside && (on_border || !is_outlined)]
        });
        goes.collect()
    }

    /// The share of the topmost samples that something goes along.
    fn share_of_top(&self, along: &[bool]) -> f64 {
        let at_top = self.topmost.iter().filter(|index| along[**index]);
        at_top.count() as f64 / self.topmost.len() as f64
    }

    /// Whether a garment is the fill of a volume that is its dark rim.
    fn is_fill(&self, garment: &Garment) -> bool {
        let own = self.shapes[garment.shape].area;
        garment.is_later
            && garment.area >= FILL * self.shapes[self.on].area
            && garment.area >= INSIDE_RIM * own
    }

    fn is_hair(&self, shape: usize) -> bool {
        let shape = &self.shapes[shape];
        let parts = [shape.part, shape.main].map(|part| &self.context.bindings.parts[part]);
        parts.iter().any(|part| part.is_hair())
    }
}

/// Whether two colours are about the same.
fn is_alike(one: [u8; 3], other: [u8; 3]) -> bool {
    let apart = [0, 1, 2].map(|channel| f64::from(one[channel]) - f64::from(other[channel]));
    let squared: f64 = apart.iter().map(|apart| apart * apart).sum();
    squared <= ALIKE * ALIKE
}

/// Points at equal distances along the border of an outline, each with points beside it, at most this far inside.
fn samples(ring: &Ring, outline: &Outline, most: f64) -> Vec<Sample> {
    let n = ring.len();
    let edge = |i: usize| [ring[i], ring[(i + 1) % n]];
    let around: f64 = (0..n).map(|i| edge(i)[0].distance(edge(i)[1])).sum();
    let apart = around / SAMPLES as f64;
    let filled_side = if shoelace(ring) < 0.0 { -1.0 } else { 1.0 };
    let bands = Bands::of(outline);
    let mut samples = Vec::with_capacity(SAMPLES);
    wraps::along((0..n).map(edge), apart, |edge, at, direction| {
        let inward = direction.perp() * filled_side;
        // Where the volume is thin, not beyond its middle.
        let through = most / INSIDE_THIN;
        let mut steps = [0.25, 0.5, 0.75, 1.0].into_iter();
        let beyond = steps.find(|step| !bands.contains(at + inward * (through * step)));
        let depth = beyond.map_or(most, |step| most * step);
        samples.push(Sample {
            edge,
            at,
            on_border: at + inward * (RIM * depth),
            inside: at + inward * depth,
            outside: at - inward * (OUTSIDE * most),
        });
    });
    samples
}

/// Closes short gaps in a closed sequence.
fn close_gaps(along: &mut [bool]) {
    let n = along.len();
    let most = (GAP * n as f64) as usize;
    let Some(start) = along.iter().position(|is_along| *is_along) else {
        return;
    };
    let mut gap = 0;
    for k in 1..=n {
        let index = (start + k) % n;
        if !along[index] {
            gap += 1;
            continue;
        }
        if gap <= most {
            for back in 1..=gap {
                along[(index + n - back) % n] = true;
            }
        }
        gap = 0;
    }
}

/// Of the runs in a closed sequence, keeps those with one of these places.
fn keep_runs(along: &mut [bool], places: &[usize]) {
    let n = along.len();
    let mut kept = vec![false; n];
    for place in places.iter().filter(|place| along[**place]) {
        for step in [1, n - 1] {
            let mut index = *place;
            while along[index] && !kept[index] {
                kept[index] = true;
                index = (index + step) % n;
            }
            // The other direction begins at the same place.
            kept[*place] = false;
        }
        kept[*place] = true;
    }
    along.copy_from_slice(&kept);
}

/// The part of an outline behind the stretches of its border that something goes along, joined by straight lines.
fn region(
    whole: &Arc<Outline>,
    ring: &Ring,
    samples: &[Sample],
    along: &[bool],
    inset: Option<f64>,
) -> Option<Arc<Outline>> {
    let inside = |outline: &Outline| inset.map(|inset| Arc::new(offset(outline, -inset)));
    let n = samples.len();
    let count = along.iter().filter(|is_along| **is_along).count();
    if count as f64 >= WHOLE * n as f64 {
        return Some(inside(whole).unwrap_or_else(|| Arc::clone(whole)));
    }
    let start = (0..n).find(|index| along[*index] && !along[(index + n - 1) % n])?;
    let mut border = Ring::new();
    for k in 0..n {
        let index = (start + k) % n;
        if !along[index] {
            continue;
        }
        border.push(samples[index].at);
        let next = (index + 1) % n;
        if along[next] && k + 1 < n {
            let mut edge = samples[index].edge;
            while edge != samples[next].edge {
                edge = (edge + 1) % ring.len();
                border.push(ring[edge]);
            }
        }
    }
    border.dedup();
    if border.len() < 3 {
        return None;
    }
    let outline = Outline {
        polygons: vec![Polygon {
            rings: vec![border],
        }],
    };
    // The lines between stretches may leave the outline where that is hollow.
    let outline = intersect(&outline, whole);
    let outline = inside(&outline).unwrap_or_else(|| Arc::new(outline));
    (area(&outline) > LEAST * area(whole)).then_some(outline)
}
