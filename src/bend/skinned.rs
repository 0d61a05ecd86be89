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
const CUT: [f64; 2] = [0.125, 0.25];
/// … of which there are at least, and at most, as many as this.
const CUTS: [f64; 2] = [4.0, 12.0];

/// How the surface passes from one node to the next: from evenly, 0, to smoothly, 1. With 1 the inside of a joint folds at 120°.
const SMOOTHNESS: f64 = 0.5;

/// The nodes of a part that bends, in the frame of its own node.
#[derive(Debug, PartialEq)]
pub(crate) struct Bones {
    line: Centerline,
    /// How far along the line each node after the first is, and half the length over which the surface passes to it.
    nodes: Vec<[f64; 2]>,
    is_chain: bool,
}

impl Bones {
    /// Those of a part, given the map from the drawing, y up, to the frame of its node, which scales evenly.
    pub(crate) fn new(bend: &Bend, to_frame: DAffine2) -> Self {
        let scale = to_frame.matrix2.determinant().abs().sqrt();
        let place = |node: &BendNode| [node.at * scale, node.blend * scale];
        Self {
            line: bend.line.mapped(to_frame, scale),
            nodes: bend.nodes.iter().map(place).collect(),
            is_chain: bend.shares() == 1,
        }
    }

    /// What moves a point at a distance along the line.
    pub(super) fn influence(&self, along: f64) -> Influence {
        let after = self
            .nodes
            .partition_point(|[at, blend]| at + blend <= along);
        match self.nodes.get(after) {
            Some([at, blend]) if along > at - blend => {
                let share = (along - (at - blend)) / (2.0 * blend);
                let smooth = share * share * (3.0 - 2.0 * share);
                let passed = share + SMOOTHNESS * (smooth - share);
                Influence {
                    joints: [after as u16, after as u16 + 1],
                    first: (1.0 - passed) as f32,
                }
            }
            _ => Influence::whole(after as u16),
        }
    }

    /// What is no longer than this along the line follows a bend without being cut.
    fn shortest(&self) -> f64 {
        CUT[usize::from(self.is_chain)] * self.line.width()
    }

    /// How far along the line the surface is cut, ascending: where it passes from one node to the next.
    fn levels(&self) -> impl Iterator<Item = f64> + '_ {
        let mut last = f64::NEG_INFINITY;
        let levels = self.nodes.iter().flat_map(|[at, blend]| {
            let cuts = 2.0 * blend / self.shortest();
            let cuts = cuts.ceil().clamp(CUTS[0], CUTS[1]);
            let place = move |cut: usize| at - blend + 2.0 * blend * cut as f64 / cuts;
            (0..=cuts as usize).map(place)
        });
        // Where one range ends and the next begins one cut is enough.
        let least = 1e-6 * self.line.width();
        levels.filter(move |level| {
            let is_new = *level > last + least;
            last = last.max(*level);
            is_new
        })
    }
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
            self.bones.levels(),
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
