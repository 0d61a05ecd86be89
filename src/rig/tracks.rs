//! Retargeted clips as animations of the scene's nodes.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DQuat, DVec3};
use typed_index_collections::{TiSlice, TiVec};

use crate::bind::PartId;
use crate::labels::FigurePartId;
use crate::limited::KeyTimes;
use crate::mocap::turns::{continuous, is_continuous};
use crate::retarget::RetargetedClip;
use crate::scene::{Animation, NodeId, Track, Values, WorldTransform};

use super::RestNode;

/// How a figure is moved in front of a camera that stands still.
pub(super) struct Shifts<'a> {
    /// A key for each shown frame.
    pub(super) keys: &'a KeyTimes,
    /// Per shown frame the frame of the clip.
    pub(super) shown: &'a [usize],
    /// Per shown frame by how much the figure is moved, in the drawing's axes and unit.
    pub(super) ways: &'a [DVec3],
}

/// The nodes that a drawing's clips animate.
#[derive(Debug)]
pub(super) struct AnimatedNodes {
    /// The first nodes of the scene, in its order.
    pub(super) nodes: TiVec<NodeId, RestNode>,
    pub(super) world: WorldTransform,
}

impl AnimatedNodes {
    /// The animation of a figure. `parts` are its parts in the order of `clip`, each with the number of the node that moves: 0 is the
    /// part's own one.
    pub(super) fn animation(
        &self,
        name: &str,
        parts: &TiSlice<FigurePartId, (PartId, usize)>,
        clip: &RetargetedClip,
        keys: &KeyTimes,
        shifts: Option<&Shifts<'_>>,
    ) -> Animation {
        let index = parts.iter_enumerated().map(|(index, part)| (*part, index));
        let index: BTreeMap<(PartId, usize), FigurePartId> = index.collect();
        let mut tracks = Vec::new();
        for (node, rest) in self.nodes.iter_enumerated() {
            let Some(&index) = index
                .get(&(rest.part, rest.bone))
                .filter(|_| !keys.frames.is_empty())
            else {
                continue;
            };
            let mut add = |timing, values| {
                tracks.push(Track {
                    node,
                    timing,
                    values,
                })
            };
            // Only children of the model's root change their position, and only they are in the world's axes.
            if let Some(positions) = clip.translations[index].as_ref().filter(|_| rest.is_rooted) {
                let placed = |position: DVec3| {
                    self.world.point(if rest.is_mirrored {
                        position * MIRROR
                    } else {
                        position
                    })
                };
                match shifts {
                    Some(shifts) => {
                        let moved = shifts.shown.iter().zip(shifts.ways);
                        let moved = moved
                            .map(|(frame, way)| placed(positions[*frame]) + self.world.way(*way));
                        let moved: Vec<DVec3> = moved.collect();
                        let values = shifts.keys.of(&moved).collect();
                        add(shifts.keys.timing(), Values::Translations(values));
                    }
                    None => {
                        let values = keys.of(positions).map(placed).collect();
                        add(keys.timing(), Values::Translations(values));
                    }
                }
            }
            if let Some(rotations) = &clip.rotations[index] {
                let is_as_it_is = !rest.is_mirrored
                    && !rest.is_rooted
                    && keys.are_frames(rotations.len())
                    && is_continuous(rotations);
                let rotations = if is_as_it_is {
                    Arc::clone(rotations)
                } else {
                    let rotations = keys.of(rotations).map(|rotation| {
                        let rotation = if rest.is_mirrored {
                            mirrored(rotation)
                        } else {
                            rotation
                        };
                        if rest.is_rooted {
                            self.world.rotate(rotation)
                        } else {
                            rotation
                        }
                    });
                    continuous(rotations.collect()).into()
                };
                add(keys.timing(), Values::Rotations(rotations));
            }
        }
        Animation {
            name: name.to_owned(),
            tracks,
        }
    }
}

/// Mirrors in the drawing plane.
const MIRROR: DVec3 = DVec3::new(1.0, 1.0, -1.0);

/// The rotation of a part's copy on the other side of the drawing plane.
fn mirrored(rotation: DQuat) -> DQuat {
    DQuat::from_xyzw(-rotation.x, -rotation.y, rotation.z, rotation.w)
}

/// Adds an animation to others. Animations of the same name are merged.
pub(super) fn add(animations: &mut Vec<Animation>, animation: Animation) {
    match animations
        .iter_mut()
        .find(|other| other.name == animation.name)
    {
        Some(other) => other.tracks.extend(animation.tracks),
        None => animations.push(animation),
    }
}
