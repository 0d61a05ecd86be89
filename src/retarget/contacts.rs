//! The feet of a clip: when they are in contact with the ground, and how far above it they are.

use glam::DVec3;

use super::Source;
use super::axes::Landmarks;
use super::planting::{Hold, Planting};
use crate::labels::{FigurePartId, Tip};
use crate::mocap::resample::TimeMap;
use crate::retarget::Drive;

/// The walk of a clip, in the drawing's axes and the clip's unit.
pub(super) struct Walk {
    pub(super) hips: Vec<DVec3>,
    pub(super) feet: Vec<Foot>,
    planting: Planting,
}

/// A foot of the clip, and the parts of the figure that stand on it.
pub(super) struct Foot {
    drive: Drive,
    pub(super) parts: Vec<FigurePartId>,
    /// Per frame its height above its lowest height: that of its heel or of its toes, whichever is lower.
    pub(super) clearance: Vec<f64>,
    /// Per frame how it holds the figure in place on the way from the frame before.
    pub(super) holds: Vec<Hold>,
}

impl Walk {
    /// The walk of a clip whose legs are `leg` long.
    pub(super) fn of(source: &mut Source<'_>, leg: f64) -> Self {
        let mut feet: Vec<Foot> = Vec::new();
        for (index, part) in source.rig.parts.iter_enumerated() {
            let Some(drive) = part.drive.filter(|_| part.is_leg && part.stands) else {
                continue;
            };
            let end = |drive: &Drive| (drive.joint, drive.tip);
            match feet.iter_mut().find(|foot| end(&foot.drive) == end(&drive)) {
                Some(foot) => foot.parts.push(index),
                None => feet.push(Foot {
                    drive,
                    parts: vec![index],
                    clearance: vec![f64::INFINITY; source.clip.frames],
                    holds: Vec::new(),
                }),
            }
        }
        let ends: Vec<Vec<Tip>> = feet
            .iter()
            .map(|foot| ground_points(source.landmarks, &foot.drive))
            .collect();
        let to_drawing = source.axes.first.inverse();
        let mut hips = Vec::with_capacity(source.clip.frames);
        let mut paths: Vec<Vec<Vec<DVec3>>> = ends
            .iter()
            .map(|ends| vec![Vec::with_capacity(source.clip.frames); ends.len()])
            .collect();
        for frame in 0..source.clip.frames {
            let pose = source.poses.at(frame);
            hips.push(to_drawing * pose[source.landmarks.hips].position);
            for (ends, paths) in ends.iter().zip(&mut paths) {
                for (end, path) in ends.iter().zip(paths) {
                    path.push(to_drawing * end.place(&source.clip.skeleton, pose));
                }
            }
        }
        let planting = Planting::of(&paths, source.clip.frame_time, leg);
        for (index, foot) in feet.iter_mut().enumerate() {
            for (path, lowest) in paths[index].iter().zip(&planting.lowest[index]) {
                foot.measure(path, *lowest);
            }
        }
        let frames: Vec<f64> = (0..source.clip.frames).map(|frame| frame as f64).collect();
        Self {
            hips,
            feet,
            planting,
        }
        .held_at(&frames)
    }

    /// The same walk, whose frames are at these places of the clip.
    fn held_at(mut self, places: &[f64]) -> Self {
        let holds = self.planting.holds(places);
        for (foot, holds) in self.feet.iter_mut().zip(holds) {
            foot.holds = holds;
        }
        self
    }

    /// The same walk, played along a map of time. Feet hold the figure in place where they did so in the source, however slow or fast
    /// they are now.
    #[must_use]
    pub(super) fn timed(&self, map: &TimeMap) -> Self {
        let places = map.places.iter();
        let places: Vec<f64> = places.map(|mix| mix.from as f64 + mix.t).collect();
        let between = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let foot = |foot: &Foot| Foot {
            drive: foot.drive,
            parts: foot.parts.clone(),
            clearance: map.apply(&foot.clearance, between),
            holds: Vec::new(),
        };
        Self {
            hips: map.apply(&self.hips, DVec3::lerp),
            feet: self.feet.iter().map(foot).collect(),
            planting: self.planting.clone(),
        }
        .held_at(&places)
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
    /// Measures how far a point of the foot is above its lowest height.
    fn measure(&mut self, path: &[DVec3], lowest: f64) {
        for (clearance, point) in self.clearance.iter_mut().zip(path) {
            *clearance = clearance.min(point.y - lowest);
        }
    }
}
