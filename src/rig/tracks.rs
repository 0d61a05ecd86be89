//! What was carried over, as animations of the scene's nodes.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use crate::motion::carry::{Carried, continuous};
use crate::motion::limited::Exposure;
use crate::scene::{Animation, Interpolation, Timing, Track, Values, WorldTransform};

use super::puppet::Nodes;

/// When the frames of a clip are shown.
pub(super) struct Shown {
    timing: Arc<Timing>,
    /// Per key the frame.
    frames: Vec<usize>,
    seconds: f64,
}

impl Shown {
    /// Every frame, and the way from each to the next.
    pub(super) fn full(frames: usize, frame_time: f64) -> Self {
        Self {
            timing: Arc::new(Timing {
                times: (0..frames)
                    .map(|frame| (frame as f64 * frame_time) as f32)
                    .collect(),
                interpolation: Interpolation::Linear,
            }),
            frames: (0..frames).collect(),
            seconds: frames.saturating_sub(1) as f64 * frame_time,
        }
    }

    /// The drawings of an exposure sheet, each held until the next.
    pub(super) fn held(exposure: &Exposure, frame_time: f64) -> Self {
        let drawings = exposure.drawings();
        let keys = drawings.map(|drawing| {
            (
                (drawing.start as f64 * frame_time) as f32,
                drawing.source as usize,
            )
        });
        let (times, frames) = keys.unzip();
        Self {
            timing: Arc::new(Timing {
                times,
                interpolation: Interpolation::Step,
            }),
            frames,
            seconds: exposure.len() as f64 * frame_time,
        }
    }
}

/// The animation of the figure whose parts, in the order of `carried`, are these parts of the drawing.
pub(super) fn animation(
    world: &WorldTransform,
    nodes: &Nodes,
    name: &str,
    parts: &[usize],
    carried: &Carried,
    shown: &Shown,
) -> Animation {
    let index: BTreeMap<usize, usize> = parts.iter().copied().zip(0..).collect();
    let mut tracks = Vec::new();
    for (node, link) in nodes.links.iter().enumerate() {
        let Some(&index) = index.get(&link.part).filter(|_| !shown.frames.is_empty()) else {
            continue;
        };
        let mut add = |values| {
            tracks.push(Track {
                node,
                timing: Arc::clone(&shown.timing),
                values,
            });
        };
        // Only nodes that hang on the model's root move, and only they stand in the world's axes.
        if let Some(places) = carried.moves[index].as_ref().filter(|_| link.is_rooted) {
            let places = shown.frames.iter().map(|frame| {
                let place = places[*frame];
                let place = if link.is_mirrored {
                    place * MIRROR
                } else {
                    place
                };
                world.point(place)
            });
            add(Values::Translations(places.collect()));
        }
        if let Some(turns) = &carried.turns[index] {
            let turns = shown.frames.iter().map(|frame| {
                let turn = turns[*frame];
                let turn = if link.is_mirrored {
                    mirrored(turn)
                } else {
                    turn
                };
                if link.is_rooted {
                    world.rotate(turn)
                } else {
                    turn
                }
            });
            add(Values::Rotations(continuous(turns.collect())));
        }
    }
    Animation {
        name: name.to_owned(),
        seconds: shown.seconds,
        tracks,
    }
}

/// Mirrors in the drawing plane.
const MIRROR: DVec3 = DVec3::new(1.0, 1.0, -1.0);

/// A turn as the copy of a part makes it on the other side of the drawing plane.
fn mirrored(turn: DQuat) -> DQuat {
    DQuat::from_xyzw(-turn.x, -turn.y, turn.z, turn.w)
}

/// Adds an animation to others: what moves under one name is one.
pub(super) fn add(animations: &mut Vec<Animation>, animation: Animation) {
    match animations
        .iter_mut()
        .find(|other| other.name == animation.name)
    {
        Some(other) => {
            other.seconds = other.seconds.max(animation.seconds);
            other.tracks.extend(animation.tracks);
        }
        None => animations.push(animation),
    }
}
