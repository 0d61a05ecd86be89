//! Surfaces that are bound to the nodes of a part that bends.

use std::any::Any;
use std::hash::Hasher;
use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rustc_hash::FxHasher;

use super::cuts::cut;
use super::{Bend, BendNode, Centerline};
use crate::scene::{Influence, Surface, SurfaceSource};

/// The distance of cuts where the surface passes from one node to the next, in widths, where a turn is shared and in a chain, whose
/// joints turn less …
const CUT: [f64; 2] = [0.14, 0.25];
/// … of which there are at least, and at most, as many as this from node to node.
const CUTS: [f64; 2] = [3.0, 12.0];

/// The nodes of a part that bends, in the frame of its own node.
#[derive(Debug, PartialEq)]
pub(crate) struct Bones {
    line: Centerline,
    /// How far along the line each node after the first is, and how far from there the surface begins to follow it.
    nodes: Vec<[f64; 2]>,
    is_chain: bool,
}

impl Bones {
    /// Those of a part, given the map from the drawing, y up, to the frame of its node, which scales evenly.
    pub(crate) fn new(bend: &Bend, to_frame: DAffine2) -> Self {
        let scale = to_frame.matrix2.determinant().abs().sqrt();
        let place = |node: &BendNode| [node.at * scale, node.reach * scale];
        Self {
            line: bend.line.mapped(to_frame, scale),
            nodes: bend.nodes.iter().map(place).collect(),
            is_chain: bend.shares() == 1,
        }
    }

    /// What moves a point at a distance along the line.
    ///
    /// Turns are blended by quadratic B-splines. So the surface bends evenly; a smoothstep from node to node leaves a dent on the inside
    /// of a bend at each of them.
    pub(super) fn influence(&self, along: f64) -> Influence {
        let first = self
            .nodes
            .partition_point(|[at, reach]| at + reach <= along);
        let mut influence = Influence::whole(first as u16);
        let mut rest = 1.0;
        for (number, [at, reach]) in self.nodes[first..].iter().take(3).enumerate() {
            // How much of the turn of this node, and of those after it, a point here makes.
            let passed = passed((along - at) / reach).min(rest);
            if passed <= 0.0 {
                break;
            }
            influence.weights[number] = (rest - passed) as f32;
            influence.weights[number + 1] = passed as f32;
            influence.joints[number + 1] = (first + number + 1) as u16;
            rest = passed;
        }
        influence
    }

    /// What is no longer than this along the line follows a bend without being cut.
    fn shortest(&self) -> f64 {
        CUT[usize::from(self.is_chain)] * self.line.width()
    }

    /// How far along the line the surface is cut, ascending: where it passes from one node to the next.
    fn levels(&self) -> Vec<f64> {
        let mut levels: Vec<f64> = Vec::new();
        // What is nearer than this is one place.
        let least = 1e-6 * self.line.width();
        for [at, reach] in &self.nodes {
            for to in [at - reach, *at, at + reach] {
                match levels.last().copied() {
                    Some(from) if to > from + least => {
                        let cuts = ((to - from) / self.shortest()).ceil();
                        let cuts = cuts.clamp(CUTS[0], CUTS[1]);
                        let place = |cut: usize| from + (to - from) * cut as f64 / cuts;
                        levels.extend((1..=cuts as usize).map(place));
                    }
                    Some(_) => {}
                    None => levels.push(to),
                }
            }
        }
        levels
    }
}

/// The share of a turn that is made at a place, in reaches of its node from it: from 0 at −1 to 1 at 1.
fn passed(place: f64) -> f64 {
    let place = place.clamp(-1.0, 1.0);
    let left = (1.0 - place.abs()).powi(2) / 2.0;
    if place < 0.0 { left } else { 1.0 - left }
}

/// The surface of a solid of a part that bends, bound to the part's nodes.
#[derive(Debug, Clone)]
pub(crate) struct BentSurface {
    /// The surface, in the frame of the part's own node.
    pub(crate) solid: Arc<dyn SurfaceSource>,
    pub(crate) bones: Arc<Bones>,
    /// The node that all of it follows; `None` if it bends.
    pub(crate) rigid: Option<u16>,
}

impl SurfaceSource for BentSurface {
    fn surface(&self) -> Surface {
        let mut surface = self.solid.surface();
        if let Some(node) = self.rigid {
            surface.influences = vec![Influence::whole(node); surface.positions.len()];
            return surface;
        }
        let along = |[x, y, _]: [f32; 3]| {
            let point = DVec2::new(f64::from(x), f64::from(y));
            self.bones.line.along(point)
        };
        let values = cut(
            &mut surface,
            along,
            self.bones.shortest(),
            self.bones.levels().into_iter(),
        );
        let influences = values.into_iter().map(|value| self.bones.influence(value));
        surface.influences = influences.collect();
        surface
    }

    fn mirrored(&self) -> Arc<dyn SurfaceSource> {
        Arc::new(Self {
            solid: self.solid.mirrored(),
            ..self.clone()
        })
    }

    fn key(&self) -> u64 {
        let mut hasher = FxHasher::default();
        hasher.write_u64(self.solid.key());
        hasher.write_u32(self.rigid.map_or(u32::MAX, u32::from));
        let nodes = self.bones.nodes.iter().flatten().copied();
        let numbers = self.bones.line.numbers().chain(nodes);
        numbers.for_each(|number| hasher.write_u64(number.to_bits()));
        hasher.finish()
    }

    fn is_equal(&self, other: &dyn SurfaceSource) -> bool {
        let other = (other as &dyn Any).downcast_ref::<Self>();
        other.is_some_and(|other| {
            self.rigid == other.rigid
                && self.bones == other.bones
                && self.solid.is_equal(&*other.solid)
        })
    }
}
