//! The feet of a clip: when they are in contact with the ground, and how far above it they are.

use glam::DVec3;

use super::planting::{CONTACT_HEIGHT, Hold, Planting, SOLE_HEIGHT};
use super::soles::{FootEnd, Sole};
use super::{Follow, Rig, Source};
use crate::labels::FigurePartId;
use crate::mocap::resample::TimeMap;

/// A foot whose sole is known is on the ground up to this height, in leg lengths: feet of actors that stand are not steadier.
const STEADY: f64 = 0.0125;

/// The walk of a clip, in the drawing's axes and the clip's unit.
pub(super) struct Walk {
    pub(super) hips: Vec<DVec3>,
    pub(super) feet: Vec<Foot>,
    planting: Planting,
}

/// A foot of the clip, and the parts of the figure that stand on it.
pub(super) struct Foot {
    pub(super) sole: Sole,
    pub(super) parts: Vec<FigurePartId>,
    /// Per frame how high above the ground it is shown, in the figure's unit: as high as the lowest point of its sole.
    pub(super) lift: Vec<f64>,
    /// Per frame how firmly it is in contact with the ground, from 0 to 1.
    pub(super) firm: Vec<f64>,
    /// Per frame how it holds the figure in place on the way from the frame before.
    pub(super) holds: Vec<Hold>,
}

impl Walk {
    /// The walk of a clip on a rig, given the lengths of their legs without feet.
    pub(super) fn of(source: &mut Source<'_>, [leg, own]: [f64; 2]) -> Self {
        let mut feet: Vec<Foot> = Vec::new();
        for (index, part) in source.rig.parts.iter_enumerated() {
            let Some(drive) = part.drive.filter(|_| part.is_leg && part.stands) else {
                continue;
            };
            let end = FootEnd::of(source.landmarks, &drive);
            match feet.iter_mut().find(|foot| foot.sole.end == end) {
                Some(foot) => foot.parts.push(index),
                None => feet.push(Foot {
                    sole: Sole::of(source, end, leg),
                    parts: vec![index],
                    lift: Vec::new(),
                    firm: Vec::new(),
                    holds: Vec::new(),
                }),
            }
        }
        let to_drawing = source.axes.first.inverse();
        let mut hips = Vec::with_capacity(source.clip.frames);
        let known = |foot: &Foot| {
            if foot.sole.is_known() {
                SOLE_HEIGHT
            } else {
                CONTACT_HEIGHT
            }
        };
        let mut paths: Vec<(Vec<Vec<DVec3>>, f64)> =
            feet.iter().map(|foot| (Vec::new(), known(foot))).collect();
        for frame in 0..source.clip.frames {
            let pose = source.poses.at(frame);
            hips.push(to_drawing * pose[source.landmarks.hips].position);
            for (foot, (paths, _)) in feet.iter().zip(&mut paths) {
                let places = foot.sole.places(&source.clip.skeleton, pose);
                paths.resize_with(places.len(), Vec::new);
                for (path, place) in paths.iter_mut().zip(places) {
                    path.push(to_drawing * place);
                }
            }
        }
        let planting = Planting::of(&paths, source.clip.frame_time, leg);
        let scale = height_scale(source.rig, &feet, [leg, own]);
        for (index, foot) in feet.iter_mut().enumerate() {
            let on_ground = if foot.sole.is_known() {
                STEADY
            } else {
                CONTACT_HEIGHT
            };
            let clearance = |frame: usize| {
                let points = paths[index].0.iter().zip(&planting.lowest[index]);
                let heights = points.map(|(path, lowest)| path[frame].y - lowest);
                heights.fold(f64::INFINITY, f64::min)
            };
            let frames = 0..source.clip.frames;
            let lift =
                frames.map(|frame| lifted(clearance(frame).max(0.0), on_ground * leg) * scale);
            foot.lift = lift.collect();
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
        let firmness = self.planting.firmness(places);
        for (foot, (holds, firm)) in self.feet.iter_mut().zip(holds.into_iter().zip(firmness)) {
            foot.holds = holds;
            foot.firm = firm;
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
            sole: foot.sole.clone(),
            parts: foot.parts.clone(),
            lift: map.apply(&foot.lift, between),
            firm: Vec::new(),
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

/// By how much heights in a clip are to be multiplied: legs down to the soles as long as these, given their lengths without feet.
fn height_scale(rig: &Rig, feet: &[Foot], [leg, own]: [f64; 2]) -> f64 {
    let mean = |drops: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = drops.fold((0.0, 0.0), |(sum, count), drop| (sum + drop, count + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    };
    let clip = leg + mean(&mut feet.iter().map(|foot| foot.sole.drop));
    let parts = feet.iter().flat_map(|foot| &foot.parts);
    let drawn = own + mean(&mut parts.map(|part| drop_of(rig, *part)));
    if clip > 0.0 { drawn / clip } else { 0.0 }
}

/// How far the lowest point of a part is below the end of its leg, as drawn.
fn drop_of(rig: &Rig, part: FigurePartId) -> f64 {
    let own = &rig.parts[part];
    let is_foot = own.drive.is_some_and(|drive| drive.follow == Follow::Sole);
    let leg = own
        .parent
        .filter(|parent| is_foot && rig.parts[*parent].is_leg);
    let end = leg.map_or(own.tip, |leg| rig.parts[leg].tip);
    let lowest = own.surface.iter().map(|point| point.y);
    (end.y - lowest.fold(end.y, f64::min)).max(0.0)
}

/// The height at which a foot is shown that has this clearance in the clip. Up to a height it is on the ground, because nobody knows its
/// sole exactly; from twice that height on it keeps its clearance.
fn lifted(clearance: f64, on_ground: f64) -> f64 {
    (2.0 * (clearance - on_ground)).max(0.0).min(clearance)
}
