//! The soles of a clip's feet: the points of a foot that touch the ground.
//!
//! Skeletons have ankles and toes, but no soles. Where a foot stands flat, ankle and toes are as low as they get, and slow; there the
//! ground is as far below the ankle as the toes are.

use glam::{DMat3, DQuat, DVec3};
use typed_index_collections::TiSlice;

use super::Source;
use super::axes::Landmarks;
use super::planting::lowest;
use crate::labels::Tip;
use crate::mocap::{JointId, Skeleton, Transform};
use crate::retarget::Drive;

/// A foot is flat where ankle and toes together are higher by less than this than where they are lowest, in leg lengths.
const FLAT: f64 = 0.015;
/// How far a foot that moves is higher than it is, seconds of its way.
const MOVING: f64 = 0.03;
/// How far the heel is behind the ankle, in distances from ankle to toes.
const HEEL: f64 = 0.3;
/// How far the ball of the foot is before it, likewise.
const BALL: f64 = 0.7;

/// What a foot of a clip is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FootEnd {
    /// An ankle, and the far end of its toes.
    Foot(JointId, Option<Tip>),
    /// The end of a leg without a foot.
    End(Tip),
}

impl FootEnd {
    /// The foot of the leg whose bone or chain drives a part.
    pub(super) fn of(landmarks: &Landmarks, drive: &Drive) -> Self {
        let leg = landmarks.leg_of(drive.joint);
        match leg.and_then(|leg| Some((leg.end?, leg.tip))) {
            Some((ankle, tip)) => Self::Foot(ankle, tip.filter(|tip| *tip != Tip::Joint(ankle))),
            None => Self::End(drive.tip.unwrap_or(Tip::Joint(drive.joint))),
        }
    }
}

/// The sole of a foot.
#[derive(Debug, Clone)]
pub(super) struct Sole {
    pub(super) end: FootEnd,
    /// Points of the sole in the ankle's frame; none for a foot without toes.
    points: Vec<DVec3>,
    /// How far the ground is below the ankle while the foot is flat, in the clip's unit.
    pub(super) drop: f64,
    /// From the axes of the foot, y up from the sole and z to the toes, to the ankle's frame.
    pub(super) flat: DQuat,
}

/// A foot, frame by frame.
struct Track {
    /// Its ankle, relative to the ground's axes: +y is up.
    ankles: Vec<Transform>,
    toes: Vec<DVec3>,
    /// Where the body's front is.
    fronts: Vec<DVec3>,
}

impl Sole {
    /// The sole of a foot of a clip whose legs are `leg` long.
    pub(super) fn of(source: &mut Source<'_>, end: FootEnd, leg: f64) -> Self {
        let mut sole = Self {
            end,
            points: Vec::new(),
            drop: 0.0,
            flat: DQuat::IDENTITY,
        };
        let FootEnd::Foot(ankle, tip) = end else {
            return sole;
        };
        if source.clip.frames == 0 {
            return sole;
        }
        let track = Track::of(source, ankle, tip);
        let frames = track.flat(source.clip.frame_time, leg);
        let mean =
            |of: &dyn Fn(usize) -> DVec3| frames.iter().map(|frame| of(*frame)).sum::<DVec3>();
        let back = |frame: usize| track.ankles[frame].rotation.inverse();
        let up = mean(&|frame| back(frame) * DVec3::Y).normalize_or(DVec3::Y);
        let toes =
            mean(&|frame| track.ankles[frame].to_local(track.toes[frame])) / frames.len() as f64;
        let way = toes.reject_from(up);
        let front = mean(&|frame| back(frame) * track.fronts[frame]).reject_from(up);
        let ahead = way.try_normalize().or(front.try_normalize());
        let ahead = ahead.unwrap_or_else(|| up.any_orthonormal_vector());
        sole.flat = foot_axes(up, ahead);
        if tip.is_some() {
            let ground = up * toes.dot(up).min(0.0);
            sole.drop = ground.length();
            sole.points = vec![ground - way * HEEL, ground + way * BALL];
        }
        sole
    }

    /// Whether it has points of its own.
    pub(super) fn is_known(&self) -> bool {
        !self.points.is_empty()
    }

    /// The points that touch the ground, in a pose.
    pub(super) fn places(
        &self,
        skeleton: &Skeleton,
        pose: &TiSlice<JointId, Transform>,
    ) -> Vec<DVec3> {
        match self.end {
            FootEnd::End(tip) => vec![tip.place(skeleton, pose)],
            FootEnd::Foot(ankle, None) => vec![pose[ankle].position],
            FootEnd::Foot(ankle, Some(tip)) => {
                let own = self.points.iter().map(|point| pose[ankle].apply(*point));
                own.chain([tip.place(skeleton, pose)]).collect()
            }
        }
    }
}

/// The axes of a foot, by the directions up and ahead.
pub(super) fn foot_axes(up: DVec3, ahead: DVec3) -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(up.cross(ahead), up, ahead)).normalize()
}

impl Track {
    fn of(source: &mut Source<'_>, ankle: JointId, tip: Option<Tip>) -> Self {
        let mut track = Self {
            ankles: Vec::with_capacity(source.clip.frames),
            toes: Vec::with_capacity(source.clip.frames),
            fronts: Vec::with_capacity(source.clip.frames),
        };
        let to_drawing = source.axes.first.inverse();
        let front = source.rig.facing.turn() * DVec3::Z;
        for frame in 0..source.clip.frames {
            let pose = source.poses.at(frame);
            let placed = pose[ankle];
            let toes = tip.map_or(placed.position, |tip| {
                tip.place(&source.clip.skeleton, pose)
            });
            let body = source.axes.at(source.landmarks, pose);
            track.ankles.push(Transform {
                rotation: to_drawing * placed.rotation,
                position: to_drawing * placed.position,
            });
            track.toes.push(to_drawing * toes);
            track.fronts.push(to_drawing * body * front);
        }
        track
    }

    /// The frames in which the foot is flat on the ground, or as nearly so as it ever is.
    fn flat(&self, frame_time: f64, leg: f64) -> Vec<usize> {
        let floors = [
            lowest(self.ankles.iter().map(|ankle| ankle.position.y)),
            lowest(self.toes.iter().map(|toes| toes.y)),
        ];
        let heights = |frame: usize| {
            let own = [self.ankles[frame].position.y, self.toes[frame].y];
            (0..2)
                .map(move |end| (own[end] - floors[end]).max(0.0))
                .sum::<f64>()
        };
        let height = |frame: usize| {
            let [before, after] = [
                frame.saturating_sub(1),
                (frame + 1).min(self.toes.len() - 1),
            ];
            let way = self.ankles[after].position - self.ankles[before].position;
            let way = way.length() / (after - before).max(1) as f64;
            let moving = if frame_time > 0.0 {
                way / frame_time * MOVING
            } else {
                0.0
            };
            heights(frame) + moving
        };
        let heights: Vec<f64> = (0..self.toes.len()).map(height).collect();
        let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let is_flat = |frame: &usize| heights[*frame] <= least + FLAT * leg;
        (0..heights.len()).filter(is_flat).collect()
    }
}
