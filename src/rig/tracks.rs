//! Retargeted clips as animations of the scene's nodes.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use crate::motion::limited::Exposure;
use crate::motion::retarget::RetargetedClip;
use crate::motion::turns::continuous;
use crate::scene::{Animation, Interpolation, Timing, Track, Values, WorldTransform};

use super::RestNode;

/// The keys of an animation: their times, and the frames that they show.
pub(super) struct KeyTimes {
    timing: Arc<Timing>,
    /// Per key the frame of the clip.
    frames: Vec<usize>,
}

impl KeyTimes {
    /// A key for every frame, interpolated linearly.
    pub(super) fn full(frames: usize, frame_time: f64) -> Self {
        Self {
            timing: Arc::new(Timing {
                times: (0..frames)
                    .map(|frame| (frame as f64 * frame_time) as f32)
                    .collect(),
                interpolation: Interpolation::Linear,
            }),
            frames: (0..frames).collect(),
        }
    }

    /// A key for every drawing of an exposure sheet, held until the next one, and one that closes the clip.
    pub(super) fn stepped(exposure: &Exposure, frame_time: f64) -> Self {
        let time = |frame: usize| (frame as f64 * frame_time) as f32;
        let keys = exposure.step_keys().into_iter();
        let (times, frames) = keys.map(|[frame, source]| (time(frame), source)).unzip();
        Self {
            timing: Arc::new(Timing {
                times,
                interpolation: Interpolation::Step,
            }),
            frames,
        }
    }
}

/// The nodes that a drawing's clips animate.
#[derive(Debug)]
pub(super) struct AnimatedNodes {
    /// The first nodes of the scene, in its order.
    pub(super) nodes: Vec<RestNode>,
    pub(super) world: WorldTransform,
}

impl AnimatedNodes {
    /// The animation of a figure. `parts` are its parts in the order of `clip`.
    pub(super) fn animation(
        &self,
        name: &str,
        parts: &[usize],
        clip: &RetargetedClip,
        keys: &KeyTimes,
    ) -> Animation {
        let index: BTreeMap<usize, usize> = parts.iter().copied().zip(0..).collect();
        let mut tracks = Vec::new();
        for (node, rest) in self.nodes.iter().enumerate() {
            let Some(&index) = index.get(&rest.part).filter(|_| !keys.frames.is_empty()) else {
                continue;
            };
            let mut add = |values| {
                tracks.push(Track {
                    node,
                    timing: Arc::clone(&keys.timing),
                    values,
                });
            };
            // Only children of the model's root change their position, and only they are in the world's axes.
            if let Some(positions) = clip.translations[index].as_ref().filter(|_| rest.is_rooted) {
                let positions = keys.frames.iter().map(|frame| {
                    let position = positions[*frame];
                    self.world.point(match rest.is_mirrored {
                        true => position * MIRROR,
                        false => position,
                    })
                });
                add(Values::Translations(positions.collect()));
            }
            if let Some(rotations) = &clip.rotations[index] {
                let rotations = keys.frames.iter().map(|frame| {
                    let rotation = match rest.is_mirrored {
                        true => mirrored(rotations[*frame]),
                        false => rotations[*frame],
                    };
                    match rest.is_rooted {
                        true => self.world.rotate(rotation),
                        false => rotation,
                    }
                });
                add(Values::Rotations(continuous(rotations.collect())));
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
