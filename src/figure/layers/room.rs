//! Room to turn: how far an arm that is drawn over the trunk lies in front of it, so that it can swing without sinking in.

use crate::math;
use glam::DVec2;

use super::super::FigureContext;
use super::nodes::{Nodes, RootedShapes};
use super::overlaps::{SAMPLES, Scratch};
use super::shapes::Shape;
use super::{Cover, node_depths::quantile};
use crate::geometry::contains;

/// How far a limb swings to either side, and in what steps it is looked at, degrees.
const SWING: i32 = 60;
const STEP: usize = 15;
/// The share of a limb, without the surroundings of its joint, from which on it is wholly drawn over the trunk.
const OVER: f64 = 0.25;
/// How far the surroundings of a joint reach, in half widths of the limb.
const JOINT: f64 = 1.5;
/// How deep a figure may become by this, as a share of its width.
const DEEPEST: f64 = 0.6;

/// Per node how far it lies in front of what it hangs on at least; 0 for what is no arm drawn over a trunk, or has a depth of its
/// own, and in drawings that say `Shape`.
pub(super) fn room(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    nodes: &Nodes,
    figures: &RootedShapes,
    covers: &[Cover],
) -> Vec<f64> {
    let parts = &context.bindings.parts;
    if !context.bindings.is_first_look {
        return vec![0.0; nodes.len()];
    }
    // Names are read once: many nodes are compared with each arm.
    let is_garment = nodes
        .main
        .iter()
        .map(|part| parts[*part].garment().is_some());
    let is_garment: Vec<bool> = is_garment.collect();
    let of_node = |node: usize| {
        let limb = limb(
            context,
            shapes,
            nodes,
            covers,
            figures.shapes(node),
            &is_garment,
            node,
        )?;
        Some(limb.room(DEEPEST * figures.width(node)))
    };
    let rooms = (0..nodes.len()).map(of_node);
    rooms.map(Option::unwrap_or_default).collect()
}

/// A limb, and the trunk that it swings across.
struct Limb<'a> {
    joint: DVec2,
    /// How far the surroundings of the joint reach.
    near: f64,
    pieces: Vec<&'a Shape>,
    trunk: Vec<&'a Shape>,
}

/// The limb of a node of a figure with these shapes; `is_garment` is about nodes.
fn limb<'a>(
    context: &FigureContext<'_>,
    shapes: &'a [Shape],
    nodes: &Nodes,
    covers: &[Cover],
    figure: &[usize],
    is_garment: &[bool],
    node: usize,
) -> Option<Limb<'a>> {
    let parts = &context.bindings.parts;
    let part = |node: usize| &parts[nodes.main[node]];
    let [main, parent] = [nodes.shape[node]?, nodes.parent[node]?];
    let own = &shapes[main];
    let is_free = nodes.given[node].is_none()
        // Both arms in one shape do not swing.
        && own.outline.polygons.len() == 1;
    if !is_free || !part(node).is_arm() || part(parent).is_piece_of_limb() {
        return None;
    }
    let is_volume = |index: &usize| {
        let shape = &shapes[*index];
        !shape.is_ink && !shape.is_given && !covers[*index].is_detail
    };
    let is_of_trunk = |index: &usize| {
        let other = nodes.of_shape[*index];
        let carrier = nodes.parent[other].filter(|_| is_garment[other]);
        nodes.hangs_on(parent, carrier.unwrap_or(other))
    };
    let is_piece = |index: &usize| {
        let other = nodes.of_shape[*index];
        nodes.hangs_on(other, node) && (other == node || part(other).is_piece_of_limb())
    };
    let volumes = || figure.iter().copied().filter(is_volume);
    let measure = part(node).node_measure();
    Some(Limb {
        joint: part(node).origin,
        near: JOINT * measure.half_across,
        pieces: volumes()
            .filter(is_piece)
            .map(|index| &shapes[index])
            .collect(),
        // What is drawn later stays in front of it.
        trunk: (volumes().filter(|index| *index < main))
            .filter(is_of_trunk)
            .map(|index| &shapes[index])
            .collect(),
    })
}

impl Limb<'_> {
    /// How far it lies in front of the trunk, which makes a figure no deeper than this.
    fn room(&self, deepest: f64) -> f64 {
        let heights = |shapes: &[&Shape]| {
            shapes
                .iter()
                .map(|shape| shape.height())
                .fold(0.0, f64::max)
        };
        let half = heights(&self.trunk);
        let most = half.min(deepest - half - heights(&self.pieces));
        let mut scratch = Scratch::default();
        let pieces = self.pieces.iter();
        let mut points: Vec<(DVec2, f64)> = pieces
            .flat_map(|piece| {
                let points = scratch.samples(piece, piece, SAMPLES);
                points.into_iter().map(|point| (point, piece.front(point)))
            })
            .collect();
        let is_beyond = |(point, _): &(DVec2, f64)| point.distance(self.joint) > self.near;
        if points.iter().any(is_beyond) {
            points.retain(is_beyond);
        }
        let over = points
            .iter()
            .filter(|(point, _)| self.front_of_trunk(*point).is_some());
        let share = over.count() as f64 / (points.len() as f64).max(1.0);
        let turns = (-SWING..=SWING).step_by(STEP);
        let turns = turns.map(|degrees| math::direction(f64::from(degrees).to_radians()));
        let missing = |turn: DVec2| {
            let missing = points.iter().filter_map(|(point, own)| {
                let turned = self.joint + turn.rotate(point - self.joint);
                Some(self.front_of_trunk(turned)? - own)
            });
            quantile(missing.collect())
        };
        let room = turns.map(missing).fold(0.0, f64::max);
        room.min(most.max(0.0)) * (share / OVER).min(1.0)
    }

    /// How far the trunk reaches to the front over a point, if it is there.
    fn front_of_trunk(&self, point: DVec2) -> Option<f64> {
        let over = self.trunk.iter().filter(|shape| {
            let (low, high) = shape.bounds;
            point.clamp(low, high) == point && contains(&shape.outline, point)
        });
        over.map(|shape| shape.front(point)).reduce(f64::max)
    }
}
