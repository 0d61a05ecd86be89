//! Ink on rounded parts: a skin on the solids below it (layers.md, Ink). On plates and sheets it is a plate or sheet itself, and
//! stands out by relief.

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{FigureContext, Figures, overlap};
use crate::bind::{Bindings, Part, PartKind};
use crate::geometry::{BoxTree, area_around, indexed_box};
use crate::scene::{Piece, WorldTransform};
use crate::solid::{Drape, Profile, RecentHeights, Sides, Solid};
use crate::threads::GRAIN;

/// How far ink stands out, as a share of its figure's larger extent.
const STEP: f64 = 0.002;
/// The same, at most, as a share of its stroke's width.
const MAX_STEP: f64 = 0.5;
/// Limit of the solids that ink is laid on: only the last ones drawn before it count.
const MAX_BELOW: usize = 16;
/// Limit of the bounding boxes that are checked to find them.
const MAX_BOXES: usize = 1024;

/// What ink on rounded parts is laid on.
pub(super) struct Ink {
    /// The parts with solids that are not ink; empty if no ink lies on rounded parts.
    parts: BoxTree,
    recent: Arc<RecentHeights>,
}

impl Ink {
    pub(super) fn new(context: &FigureContext<'_>) -> Self {
        let parts = &context.bindings.parts;
        let any = (0..parts.len()).any(|part| context.is_draped(part));
        let solids = parts.iter().enumerate().filter(|(_, part)| {
            any && part.host.is_none() && matches!(part.kind, PartKind::Main | PartKind::Sub)
        });
        let boxes = solids.map(|(index, part)| indexed_box(part.measure.bounds, index));
        Self {
            parts: BoxTree::bulk_load(boxes.collect()),
            recent: Arc::default(),
        }
    }

    /// The parts whose solids ink is laid on: its host, and those of its node that are drawn on that.
    fn below(&self, parts: &[Part], ink: usize, host: usize) -> Vec<usize> {
        let area = area_around(parts[ink].measure.bounds, 0.0);
        let mut found: Vec<usize> = self
            .parts
            .locate_in_envelope_intersecting(area)
            .take(MAX_BOXES)
            .map(|other| other.data)
            .filter(|other| (host + 1..ink).contains(other))
            .filter(|other| parts[*other].main == parts[ink].main)
            .collect();
        found.sort_unstable_by_key(|other| std::cmp::Reverse(*other));
        found.truncate(MAX_BELOW);
        found.retain(|other| overlap(&parts[ink], &parts[*other]));
        found.push(host);
        found.reverse();
        found
    }
}

/// Per part the larger extent of the figure that it belongs to, drawing units; empty in a drawing without ink.
pub(super) fn figure_extents(bindings: &Bindings) -> Vec<f64> {
    let parts = &bindings.parts;
    if !parts.iter().any(|part| part.host.is_some()) {
        return Vec::new();
    }
    let mut roots: Vec<Option<usize>> = vec![None; parts.len()];
    for start in 0..parts.len() {
        let mut chain = Vec::new();
        let mut at = parts[start].main;
        let root = loop {
            if let Some(root) = roots[at] {
                break root;
            }
            chain.push(at);
            match parts[at].parent {
                Some(parent) => at = parent,
                None => break at,
            }
        };
        chain.into_iter().for_each(|part| roots[part] = Some(root));
        roots[start] = Some(root);
    }
    let mut bounds = vec![None; parts.len()];
    let built = parts.iter().zip(&roots);
    let built = built.filter(|(part, _)| matches!(part.kind, PartKind::Main | PartKind::Sub));
    for (part, root) in built {
        let (low, high) = part.measure.bounds;
        if let Some(root) = *root {
            let (all_low, all_high) = bounds[root].unwrap_or((low, high));
            bounds[root] = Some((low.min(all_low), high.max(all_high)));
        }
    }
    let extent = |root: &Option<usize>| match root.and_then(|root| bounds[root]) {
        Some((low, high)) => (high - low).max_element(),
        None => 0.0,
    };
    roots.par_iter().with_min_len(GRAIN).map(extent).collect()
}

impl FigureContext<'_> {
    /// Whether a part is ink that is laid on the rounded surface of another part.
    pub(super) fn is_draped(&self, part: usize) -> bool {
        let profile = || self.profile(part);
        self.bindings.form(part) != part
            && profile()
                .is_some_and(|profile| !matches!(profile, Profile::Default(_) | Profile::Flat(_)))
    }

    /// How far ink stands out from a rounded surface, drawing units.
    pub(super) fn ink_step(&self, part: usize) -> f64 {
        let own = &self.bindings.parts[part];
        let stroke = self.drawing.shapes[own.shape].stroke.as_ref();
        let extent = self.figure_extents.get(part).copied().unwrap_or(0.0);
        let most = stroke.map_or(f64::INFINITY, |stroke| MAX_STEP * stroke.width());
        (STEP * extent).min(most)
    }
}

impl Figures<'_> {
    /// Ink laid on the solids below it, in the frame of its node. `solids` are those of the node that ink has been laid on.
    pub(super) fn draped(
        &self,
        part: usize,
        texture: Option<DAffine2>,
        world: &WorldTransform,
        solids: &mut FxHashMap<usize, Arc<Solid>>,
    ) -> Option<Piece> {
        let parts = &self.context.bindings.parts;
        let (main, host) = (parts[part].main, parts[part].host?);
        let mut below = Vec::new();
        for other in self.ink.below(parts, part, host) {
            let solid = match solids.get(&other) {
                Some(solid) => Some(Arc::clone(solid)),
                None => self.solid(main, other, world).map(|solid| {
                    // Its copy has its own ink.
                    Arc::new(Solid {
                        sides: Sides::Front,
                        ..solid
                    })
                }),
            };
            if let Some(solid) = solid {
                solids.insert(other, Arc::clone(&solid));
                below.push(solid);
            }
        }
        let (own, node) = (&self.frames[part], &self.frames[main]);
        let to_node = DAffine2::from_translation(node.to_local(own.center))
            * DAffine2::from_angle(own.angle - node.angle)
            * own.from_drawing_about_center();
        let step = self.context.ink_step(part);
        let reach = [step, step + self.relief.step(part)].map(|reach| reach * world.scale);
        let (_, both) = self.context.stand(main, part);
        Some(Piece::Deferred(Arc::new(Drape {
            outline: Arc::clone(&parts[part].outline),
            to_model: DAffine2::from_scale(DVec2::splat(world.scale)) * to_node,
            below,
            reach,
            crease: self.context.options(part).crease,
            sides: if both { Sides::Both } else { Sides::Front },
            texture,
            recent: Arc::clone(&self.ink.recent),
        })))
    }
}
