//! How the parts of a rig turn in a clip, before it is known where the figure goes.
//!
//! Retargeting has two stages, because a performance changes how parts turn, and the ground holds up the result: the turns, with what
//! the clip's feet do, and then the travel, so that feet in contact stay in place whatever became of the legs.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::axes::Axes;
use super::contacts::Walk;
use super::rotations::{self, Rotations};
use super::{
    Landmarks, PoseBuffer, RestSource, RetargetedClip, Rig, Source, kinematics, rest_pose, room,
    root_motion, stepping, swing,
};
use crate::labels::FigurePartId;
use crate::mocap::Clip;
use crate::mocap::resample::TimeMap;
use crate::mocap::turns::continuous;

/// How the parts of a rig turn in a clip, frame by frame, and when its feet are in contact with the ground.
pub struct Turns<'a> {
    rig: &'a Rig,
    /// The parts, parents before children.
    order: Vec<FigurePartId>,
    /// `None` if nothing moves.
    moving: Option<Moving>,
    frames: usize,
    frame_time: f64,
}

/// How long turns are.
pub(super) struct Length {
    pub(super) frames: usize,
    /// Seconds from one frame to the next.
    frame_time: f64,
    /// Whether they end as they begin.
    pub(super) is_cycle: bool,
}

impl Length {
    fn of(rotations: &Rotations, frames: usize, frame_time: f64) -> Self {
        Self {
            frames,
            frame_time,
            is_cycle: frames > 0 && swing::is_cycle(rotations, frames),
        }
    }

    /// The number of frames that is nearest to a time in seconds; 0 if frames take no time.
    pub(super) fn frames_in(&self, seconds: f64) -> usize {
        if self.frame_time > 0.0 && self.frame_time.is_finite() {
            (seconds / self.frame_time).round() as usize
        } else {
            0
        }
    }
}

struct Moving {
    rotations: Rotations,
    walk: Walk,
    /// The lengths of the clip's legs and of the figure's.
    legs: [f64; 2],
    rest: RestSource,
}

impl<'a> Turns<'a> {
    /// The turns of a rig in a clip. Every index in `rig` and `landmarks` must be valid. Nothing moves if no part is driven; parts whose
    /// parents form a cycle stay in place.
    pub fn new(clip: &Clip, rig: &'a Rig, landmarks: &Landmarks) -> Self {
        let order = rig.order();
        let is_still = rig.parts.iter().all(|part| part.drive.is_none()) || order.is_empty();
        let moving = (!is_still).then(|| {
            let axes = Axes::of(clip, landmarks, rig.facing);
            let poses = PoseBuffer::new(clip);
            let mut source = Source {
                clip,
                rig,
                landmarks,
                axes,
                poses,
            };
            let rest = rest_pose::choose(&mut source);
            let legs = root_motion::leg_lengths(&mut source);
            let mut rotations = rotations::rotations(&mut source, &rest, &order, legs[0]);
            let walk = Walk::of(&mut source, legs);
            let length = Length::of(&rotations, clip.frames, clip.frame_time);
            stepping::place(rig, &order, &mut rotations, &walk, legs[1], &length);
            room::open(rig, &order, &mut rotations, &length);
            Moving {
                rotations,
                walk,
                legs,
                rest: rest.source,
            }
        });
        Self {
            rig,
            order,
            moving,
            frames: clip.frames,
            frame_time: clip.frame_time,
        }
    }

    /// The same turns, played along a map of time, which shows no frame beyond the last one.
    #[must_use]
    pub fn timed(mut self, map: &TimeMap) -> Self {
        self.frames = map.frames();
        self.moving = self.moving.map(|moving| Moving {
            rotations: moving.rotations.timed(map),
            walk: moving.walk.timed(map),
            ..moving
        });
        self
    }

    /// The same turns, some of them damped: per part the ratio R of its turns that is left, relative to its parent and to the first
    /// frame; `None` and 1 leave the part as it is.
    ///
    /// Source: Manya & Matsuda, equation 1, Fᵢ = B + (Fᵢ − B)·R, with slerp for the sum of angles.
    #[must_use]
    pub fn damped(mut self, ratios: &TiSlice<FigurePartId, Option<f64>>) -> Self {
        if let Some(moving) = &mut self.moving {
            moving.rotations.damp(self.rig, &self.order, ratios);
        }
        self
    }

    /// Where the figure goes, how what hangs on it swings, and all of that in the frames of the nodes.
    pub fn travel(mut self) -> RetargetedClip {
        let count = self.rig.parts.len();
        let Some(moving) = self.moving.take() else {
            return RetargetedClip {
                rotations: ti_vec![None; count],
                translations: ti_vec![None; count],
                grounded: vec![false; self.frames],
                turned: ti_vec![None; count],
                rest: RestSource::default(),
            };
        };
        let mut rotations = moving.rotations;
        let root_motion =
            root_motion::root_motion(self.rig, &self.order, &rotations, &moving.walk, moving.legs);
        swing::swing(
            self.rig,
            &self.order,
            &root_motion.path,
            self.frame_time,
            &mut rotations,
        );
        rotations.share(self.rig, &self.order);
        RetargetedClip {
            rotations: self.node_rotations(&rotations),
            translations: self.node_translations(&rotations, &root_motion.path),
            grounded: root_motion.grounded,
            turned: rotations.turned,
            rest: moving.rest,
        }
    }

    /// Per part the rotations of its node in its parent's frame, of rooted nodes in the drawing's axes.
    fn node_rotations(
        &self,
        rotations: &Rotations,
    ) -> TiVec<FigurePartId, Option<Arc<Vec<DQuat>>>> {
        let Self {
            rig, order, frames, ..
        } = self;
        let mut local = ti_vec![None; rig.parts.len()];
        for part in order {
            let own = &rig.parts[*part];
            let turned: Vec<DQuat> = match own.parent.filter(|_| !own.is_rooted) {
                None => (0..*frames)
                    .map(|frame| rotations.at(*part, frame))
                    .collect(),
                Some(parent) if rotations.is_own(*part) => (0..*frames)
                    .map(|frame| rotations.local(*part, parent, frame))
                    .collect(),
                Some(_) => continue,
            };
            local[*part] = Some(continuous(turned).into());
        }
        local
    }

    /// Per part the positions of its node, for the root part and for nodes that are children of the model's root.
    fn node_translations(
        &self,
        rotations: &Rotations,
        path: &[DVec3],
    ) -> TiVec<FigurePartId, Option<Vec<DVec3>>> {
        let Self { rig, order, .. } = self;
        let mut translations = ti_vec![None; rig.parts.len()];
        let is_moving =
            |part: &FigurePartId| Some(part) == order.first() || rig.parts[*part].is_rooted;
        let moving: Vec<FigurePartId> = order.iter().copied().filter(is_moving).collect();
        for part in &moving {
            translations[*part] = Some(Vec::with_capacity(path.len()));
        }
        let mut kinematics = kinematics::ForwardKinematics::new(rig);
        for (frame, root) in path.iter().enumerate() {
            // The root part itself is at the origin.
            if moving.len() > 1 {
                kinematics.pose(rig, rotations, order, frame);
            }
            for part in &moving {
                if let Some(places) = &mut translations[*part] {
                    places.push(*root + kinematics.transforms[*part].position);
                }
            }
        }
        translations
    }
}
