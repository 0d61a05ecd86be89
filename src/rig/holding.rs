//! Whether the parts of a figure that moves stay with what they hang on.

use glam::{DVec2, DVec3};
use typed_index_collections::{TiSlice, TiVec};

use super::Context;
use super::bones;
use super::figures::FigureGroup;
use crate::bind::PartId;
use crate::geometry::{Outline, distance_squared, y_up};
use crate::labels::FigurePartId;
use crate::math;
use crate::mocap::Transform;
use crate::retarget::{RetargetedClip, Rig};

/// At how many times of a clip the parts are looked at.
const TIMES: usize = 24;
/// By how much the gap between a part and what it hangs on may grow, as a share of the figure's height.
const MAX_GROWTH: f64 = 0.03;
/// The most points of a part that are looked at.
const MAX_POINTS: usize = 48;
/// The most parts of a figure that are looked at frame by frame: joints of the others lie on both parts.
const MAX_PARTS: usize = 64;
/// How many pairs of a point and an edge are compared for a part.
const MAX_PAIRS: usize = 1 << 20;

/// A part that comes off what it hangs on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Loose {
    pub(super) part: FigurePartId,
    /// By how much the gap grows at most, as a share of the figure's height.
    pub(super) growth: f64,
}

/// The parts of a figure that its motion takes off what they hang on, the worst first.
pub(super) fn loose(
    context: &Context<'_>,
    group: &FigureGroup,
    rig: &Rig,
    clip: &RetargetedClip,
) -> Vec<Loose> {
    let frames = clip.grounded.len();
    let height = height(context, group);
    if frames == 0 || height <= 0.0 {
        return Vec::new();
    }
    let allowed = MAX_GROWTH * height;
    let pairs = group.parts.keys();
    let pairs = pairs.filter_map(|part| Pair::of(context, group, rig, part));
    let pairs: Vec<Pair<'_>> = pairs
        .filter(|pair| pair.may_grow_by() > allowed)
        .take(MAX_PARTS)
        .collect();
    if pairs.is_empty() {
        return Vec::new();
    }
    let order = rig.order();
    let mut placed: TiVec<FigurePartId, Transform> =
        rig.parts.iter().map(|part| part.node).collect();
    let mut most = vec![0.0_f64; pairs.len()];
    for time in 0..TIMES.min(frames) {
        let frame = time * (frames - 1) / (TIMES - 1).max(1);
        for part in &order {
            placed[*part] = clip.node(rig, *part, frame, &placed);
        }
        for (most, pair) in most.iter_mut().zip(&pairs) {
            let gap = pair.gap(rig, &placed);
            *most = most.max(gap - pair.drawn);
        }
    }
    let found = pairs.iter().zip(most).map(|(pair, growth)| Loose {
        part: pair.part,
        growth: growth / height,
    });
    let mut found: Vec<Loose> = found.filter(|found| found.growth > MAX_GROWTH).collect();
    found.sort_by(|a, b| b.growth.total_cmp(&a.growth));
    found
}

fn height(context: &Context<'_>, group: &FigureGroup) -> f64 {
    let bounds = group
        .parts
        .iter()
        .map(|part| context.bindings.parts[*part].measure.bounds);
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = bounds.fold(none, |(low, high), (from, to)| {
        (low.min(from.y), high.max(to.y))
    });
    high - low
}

/// A part and what it hangs on.
struct Pair<'a> {
    part: FigurePartId,
    parent: FigurePartId,
    /// Points of the part, where it is drawn, each with the bone that it is on.
    points: Vec<(FigurePartId, DVec3)>,
    /// The shapes of what it hangs on.
    below: Vec<&'a Outline>,
    /// How far apart the middles of both may be in depth, as they are drawn and as thick as they are.
    depth: f64,
    /// The gap between both in the drawing.
    drawn: f64,
    /// How far the joint is from both together: the gap never becomes larger.
    from_joint: f64,
}

impl<'a> Pair<'a> {
    fn of(
        context: &Context<'a>,
        group: &FigureGroup,
        rig: &Rig,
        part: FigurePartId,
    ) -> Option<Self> {
        let own = &rig.parts[part];
        let parent = own.parent?;
        let drawn = |part: FigurePartId| group.parts[rig.parts[part].inside.unwrap_or(part)];
        let [shapes, below] = [part, parent].map(|part| outlines(context, drawn(part)));
        let joint = own.joint.truncate();
        let [from_part, from_parent] = [&shapes, &below].map(|shapes| distance(shapes, joint));
        let apart = (own.joint.z - rig.parts[parent].node.position.z).abs();
        let thick = [part, parent].map(|part| half_thickness(context, drawn(part)));
        let depth = apart + thick[0] + thick[1];
        let edges: usize = below.iter().map(|outline| points(outline).count()).sum();
        let most = (MAX_PAIRS / (TIMES * edges.max(1))).clamp(4, MAX_POINTS);
        let all = shapes
            .iter()
            .map(|outline| points(outline).count())
            .sum::<usize>();
        let step = all.div_ceil(most).max(1);
        let border = shapes.iter().flat_map(|outline| points(outline));
        let mut points: Vec<DVec2> = border.step_by(step).map(y_up).collect();
        if from_part == 0.0 {
            points.push(joint);
        }
        let bend = context.bends[group.parts[part]].as_deref();
        // A garment follows the bones of its parent.
        let is_worn = bend.is_some_and(|bend| bend.is_worn);
        let mut chain = bones::chain(rig, if is_worn { parent } else { part });
        if is_worn {
            chain[0] = part;
        }
        let bone = |point: DVec2| chain[bend.map_or(0, |bend| bend.node_at(point))];
        let gaps = points.iter().map(|point| distance(&below, *point));
        let drawn = gaps.fold(f64::INFINITY, f64::min);
        (drawn.is_finite() && from_part.is_finite()).then(|| Self {
            part,
            parent,
            points: points
                .iter()
                .map(|point| (bone(*point), point.extend(own.joint.z)))
                .collect(),
            below,
            depth,
            drawn,
            from_joint: from_part + from_parent,
        })
    }

    /// The most by which the gap can grow, however the part turns.
    fn may_grow_by(&self) -> f64 {
        self.from_joint - self.drawn
    }

    /// The gap between both where they are placed.
    fn gap(&self, rig: &Rig, placed: &TiSlice<FigurePartId, Transform>) -> f64 {
        let below = &rig.parts[self.parent].node;
        let gaps = self.points.iter().map(|(bone, point)| {
            let at = placed[*bone].apply(rig.parts[*bone].node.to_local(*point));
            let at = below.apply(placed[self.parent].to_local(at));
            let beside = ((at.z - below.position.z).abs() - self.depth).max(0.0);
            math::hypot(distance(&self.below, at.truncate()), beside)
        });
        gaps.fold(f64::INFINITY, f64::min)
    }
}

/// Half the thickness of a node's thickest solid, a little within its outline.
fn half_thickness(context: &Context<'_>, part: PartId) -> f64 {
    let shapes = context.parts_of_node[part].iter();
    let solids = shapes.filter_map(|shape| context.thicknesses.get(*shape).copied().flatten());
    let halves = solids.map(|solid| {
        let half = (solid.depths[1] - solid.depths[0]) / 2.0;
        if solid.is_soft { half / 2.0 } else { half }
    });
    halves.fold(0.0, f64::max)
}

/// The outlines of the shapes of a node.
fn outlines<'a>(context: &Context<'a>, part: PartId) -> Vec<&'a Outline> {
    let shapes = context.parts_of_node[part].iter();
    let shapes = shapes.map(|shape| &*context.bindings.parts[*shape].outline);
    shapes.collect()
}

/// The distance from a point, y up, to the nearest of some areas.
fn distance(outlines: &[&Outline], point: DVec2) -> f64 {
    let point = y_up(point);
    let distances = outlines
        .iter()
        .map(|outline| distance_squared(outline, point));
    distances.fold(f64::INFINITY, f64::min).sqrt()
}

/// The points of an outline's borders.
fn points(outline: &Outline) -> impl Iterator<Item = DVec2> + '_ {
    let rings = outline.rings();
    rings.flatten().copied()
}
