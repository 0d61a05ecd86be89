//! The feet of a clip: when they are in contact with the ground, and how far above it they are.

use glam::DVec3;

use super::axes::{Axes, Landmarks};
use super::{PoseBuffer, Rig};
use crate::motion::labels::Tip;
use crate::motion::matching::Drive;
use crate::motion::resample::TimeMap;
use crate::motion::skeleton::Clip;

/// A point of a foot is in contact if it is lower than this above its lowest height, in leg lengths …
pub(super) const CONTACT_HEIGHT: f64 = 0.08;
/// … and slower than this, in leg lengths per second.
const CONTACT_SPEED: f64 = 0.6;
/// The lowest height of a foot is this quantile of its heights, because single frames may be wrong.
const LOWEST: f64 = 0.02;

/// The walk of a clip, in the drawing's axes and the clip's unit.
pub(super) struct Walk {
    pub(super) hips: Vec<DVec3>,
    pub(super) feet: Vec<Foot>,
}

/// A foot of the clip, and the parts of the figure that stand on it.
pub(super) struct Foot {
    drive: Drive,
    pub(super) parts: Vec<usize>,
    /// Per frame its height above its lowest height: that of its heel or of its toes, whichever is lower.
    pub(super) clearance: Vec<f64>,
    /// Per frame the length of its step from the frame before, if its heel or its toes were in contact since then.
    contact: Vec<Option<f64>>,
}

impl Walk {
    /// The walk of a clip whose legs are `leg` long.
    pub(super) fn of(
        clip: &Clip,
        rig: &Rig,
        landmarks: &Landmarks,
        axes: &Axes,
        leg: f64,
        poses: &mut PoseBuffer<'_>,
    ) -> Self {
        let mut feet: Vec<Foot> = Vec::new();
        for (index, part) in rig.parts.iter().enumerate() {
            let Some(drive) = part.drive.filter(|_| part.is_leg && part.stands) else {
                continue;
            };
            let end = |drive: &Drive| (drive.joint, drive.tip);
            match feet.iter_mut().find(|foot| end(&foot.drive) == end(&drive)) {
                Some(foot) => foot.parts.push(index),
                None => feet.push(Foot {
                    drive,
                    parts: vec![index],
                    clearance: vec![f64::INFINITY; clip.frames()],
                    contact: vec![None; clip.frames()],
                }),
            }
        }
        let ends: Vec<Vec<Tip>> = feet
            .iter()
            .map(|foot| ground_points(landmarks, &foot.drive))
            .collect();
        let to_drawing = axes.first.inverse();
        let mut hips = Vec::with_capacity(clip.frames());
        let mut paths: Vec<Vec<Vec<DVec3>>> = ends
            .iter()
            .map(|ends| vec![Vec::with_capacity(clip.frames()); ends.len()])
            .collect();
        for frame in 0..clip.frames() {
            let pose = poses.at(frame);
            hips.push(to_drawing * pose[landmarks.hips].position);
            for (ends, paths) in ends.iter().zip(&mut paths) {
                for (end, path) in ends.iter().zip(paths) {
                    path.push(to_drawing * end.place(&clip.skeleton, pose));
                }
            }
        }
        for (foot, paths) in feet.iter_mut().zip(&paths) {
            for path in paths {
                foot.measure(path, clip.frame_time, leg);
            }
        }
        Self { hips, feet }
    }

    /// The same walk, played along a map of time. A foot is in contact on the way to a frame if it was in contact on the whole way in
    /// the source, however slow or fast it is now.
    #[must_use]
    pub(super) fn timed(&self, map: &TimeMap) -> Self {
        let between = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let foot = |foot: &Foot| Foot {
            drive: foot.drive,
            parts: foot.parts.clone(),
            clearance: map.apply(&foot.clearance, between),
            contact: (0..map.frames())
                .map(|frame| foot.contact_between(map, frame))
                .collect(),
        };
        Self {
            hips: map.apply(&self.hips, DVec3::lerp),
            feet: self.feet.iter().map(foot).collect(),
        }
    }

    /// The foot that is locked on the way to a frame: the same as before while it is in contact, else the slowest one in
    /// contact.
    pub(super) fn planted(&self, frame: usize, before: Option<usize>) -> Option<usize> {
        let stays = before.filter(|foot| self.feet[*foot].contact[frame].is_some());
        let standing = self.feet.iter().enumerate();
        let standing = standing.filter_map(|(foot, own)| Some((foot, own.contact[frame]?)));
        let slowest = standing.min_by(|(_, a), (_, b)| a.total_cmp(b));
        stays.or(slowest.map(|(foot, _)| foot))
    }
}

/// The points of a clip's foot that touch the ground: ankle and toes, or the end of a leg without them.
fn ground_points(landmarks: &Landmarks, drive: &Drive) -> Vec<Tip> {
    let legs = [landmarks.thighs, landmarks.knees, landmarks.feet];
    let side = |side: &usize| {
        let mut joints = legs.iter().flatten().map(|pair| pair[*side]);
        joints.any(|joint| joint == drive.joint)
    };
    let side = (0..2).find(side).filter(|_| drive.tip.is_some());
    let ankle = side.and_then(|side| Some(Tip::Joint(landmarks.feet?[side])));
    let toes = side.and_then(|side| Some(landmarks.foot_tips?[side]));
    match (ankle, toes) {
        (None, None) => vec![drive.tip.unwrap_or(Tip::Joint(drive.joint))],
        (ankle, toes) => ankle.into_iter().chain(toes).collect(),
    }
}

impl Foot {
    /// The length of the foot's step in the source between two frames of a map, if it was in contact all the time.
    fn contact_between(&self, map: &TimeMap, frame: usize) -> Option<f64> {
        let place = |frame: usize| {
            let mix = &map.places()[frame];
            mix.from as f64 + mix.t
        };
        let [start, end] = [place(frame.saturating_sub(1)), place(frame)];
        // A source frame's contact is that of the way to it. A pose that is held is one moment of such a way.
        let first = (start.floor() as usize + 1).min(end.ceil() as usize);
        let ways = first..=end.ceil() as usize;
        let mut length = 0.0;
        for source in ways {
            let share = end.min(source as f64) - start.max(source as f64 - 1.0);
            length += self.contact[source]? * share.max(0.0);
        }
        Some(length)
    }

    fn measure(&mut self, path: &[DVec3], frame_time: f64, leg: f64) {
        let mut heights: Vec<f64> = path.iter().map(|point| point.y).collect();
        heights.sort_by(f64::total_cmp);
        let lowest = match heights.len() {
            0 => 0.0,
            count => heights[((count - 1) as f64 * LOWEST) as usize],
        };
        let is_low = |frame: usize| path[frame].y - lowest < CONTACT_HEIGHT * leg;
        for (frame, point) in path.iter().enumerate() {
            self.clearance[frame] = self.clearance[frame].min(point.y - lowest);
            let before = frame.saturating_sub(1);
            let step = point.distance(path[before]);
            if is_low(frame) && is_low(before) && step < CONTACT_SPEED * leg * frame_time {
                let contact = &mut self.contact[frame];
                *contact = Some(contact.map_or(step, |least| least.min(step)));
            }
        }
    }
}
