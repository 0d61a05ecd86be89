//! Root motion and foot locking: travel is scaled by leg length, and feet in contact with the ground do not slide.

use glam::DVec3;

use super::axes::Landmarks;
use super::contacts::{Foot, Walk};
use super::kinematics::ForwardKinematics;
use super::planting::Hold;
use super::rotations::Rotations;
use super::stance::Stance;
use super::{Rig, Source};
use crate::labels::FigurePartId;
use crate::math;
use crate::mocap::JointId;
use crate::retarget::Drive;

/// A foot rolls over the points of its sole that are about this high above the lowest one, in leg lengths.
const ROLLING: f64 = 0.01;

/// A foot is in contact with the ground in a frame if its share in holding the figure in place was this large on the way to it.
const GROUNDED: f64 = 0.9;

/// The motion of the root part.
pub(super) struct RootMotion {
    /// Per frame the position of its node.
    pub(super) path: Vec<DVec3>,
    /// Per frame whether a foot is in contact with the ground.
    pub(super) grounded: Vec<bool>,
}

/// The motion of the root of a rig whose parts turn like this. `legs` are the lengths of the clip's legs and of the rig's.
pub(super) fn root_motion(
    rig: &Rig,
    order: &[FigurePartId],
    rotations: &Rotations,
    walk: &Walk,
    legs: [f64; 2],
) -> RootMotion {
    let frames = walk.hips.len();
    let mut motion = RootMotion {
        path: Vec::with_capacity(frames),
        grounded: vec![false; frames],
    };
    let Some(&main) = order.first() else {
        return motion;
    };
    let scale = if legs[0] > 0.0 {
        legs[1] / legs[0]
    } else {
        0.0
    };
    let start = rig.parts[main].node.position;
    let standing = walk.feet.iter().flat_map(|foot| &foot.parts);
    let soles = standing.flat_map(|part| &rig.parts[*part].surface);
    let floor = soles.map(|point| point.y).reduce(f64::min);
    let surfaces = Surfaces::of(rig, order, floor);
    let mut kinematics = ForwardKinematics::new(rig);
    // Per foot of the clip, and per part that stands on it, the points of the part's surface.
    let mut before: Vec<Vec<Vec<DVec3>>> = Vec::new();
    // Per foot its steps on the ground, relative to the root.
    let mut steps = vec![vec![DVec3::ZERO]; walk.feet.len()];
    let mut stances = Vec::with_capacity(frames);
    let mut lowest = Vec::with_capacity(frames);
    for frame in 0..frames {
        kinematics.pose(rig, rotations, order, frame);
        let feet = Feet::of(rig, &kinematics, walk);
        for (steps, (before, now)) in steps.iter_mut().zip(before.iter().zip(&feet.0)) {
            steps.push(rolled(before, now, ROLLING * legs[1]));
        }
        let mut holds = walk.feet.iter().map(|foot| foot.holds[frame].mean);
        let stance = Stance::of(walk, frame, &feet.lowest());
        motion.grounded[frame] = stance.lift == 0.0 && holds.any(|held| held >= GROUNDED);
        stances.push(stance);
        lowest.push(surfaces.lowest(rig, &kinematics));
        before = feet.0;
    }
    motion.path = travel(walk, &steps, scale, start);
    let hips = |frame: usize| (walk.hips[frame].y - walk.hips[0].y) * scale;
    match floor {
        Some(floor) => {
            let places = motion.path.iter_mut().zip(stances.iter().zip(lowest));
            for (place, (stance, lowest)) in places {
                place.y = floor + stance.height().max(-lowest);
            }
        }
        None => {
            for (frame, place) in motion.path.iter_mut().enumerate() {
                place.y = start.y + hips(frame);
            }
        }
    }
    motion
}

/// The feet of a figure in a pose: per foot of the clip, and per part that stands on it, the points of the part's surface.
pub(super) struct Feet(Vec<Vec<Vec<DVec3>>>);

impl Feet {
    pub(super) fn of(rig: &Rig, kinematics: &ForwardKinematics, walk: &Walk) -> Self {
        let foot = |foot: &Foot| {
            let parts = foot.parts.iter();
            let surfaces = parts.map(|part| kinematics.surface(rig, *part).collect());
            surfaces.collect()
        };
        Self(walk.feet.iter().map(foot).collect())
    }

    /// Per foot the height of its lowest point.
    pub(super) fn lowest(&self) -> Vec<f64> {
        let lowest = |foot: &Vec<Vec<DVec3>>| {
            let heights = foot.iter().flatten().map(|point| point.y);
            heights.fold(f64::INFINITY, f64::min)
        };
        self.0.iter().map(lowest).collect()
    }
}

/// Where the root goes, frame by frame. Feet are locked: one stays in place if the root moves by the opposite of its step. Where none
/// holds it, the root goes as far as the clip's hips. `steps` are those of each foot from the frame before, relative to the root.
fn travel(walk: &Walk, steps: &[Vec<DVec3>], scale: f64, start: DVec3) -> Vec<DVec3> {
    let mut ways = vec![DVec3::ZERO];
    ways.extend(walk.hips.windows(2).map(|pair| (pair[1] - pair[0]) * scale));
    // The ways before, to and after a frame; nothing is known about those beyond the ends.
    let around = |ways: &[DVec3], frame: usize| {
        let before = ways[if frame > 1 { frame - 1 } else { frame }];
        [
            before,
            ways[frame],
            ways.get(frame + 1).copied().unwrap_or(ways[frame]),
        ]
    };
    let mut place = start;
    let mut path = Vec::with_capacity(walk.hips.len());
    for frame in 0..walk.hips.len() {
        if frame > 0 {
            let mut free = Hold {
                mean: 1.0,
                lean: 0.0,
            };
            for (foot, steps) in walk.feet.iter().zip(steps) {
                let hold = foot.holds[frame];
                place -= hold.part_of(around(steps, frame));
                free = free - hold;
            }
            place += free.part_of(around(&ways, frame));
        }
        path.push(place);
    }
    path
}

/// How far a foot moves from one pose to the next where it touches the ground: the mean over the points of its lowest part, of which
/// those count most that are lowest in both poses.
fn rolled(before: &[Vec<DVec3>], now: &[Vec<DVec3>], height: f64) -> DVec3 {
    let height_of = |(a, b): (&DVec3, &DVec3)| (a.y + b.y) / 2.0;
    let lowest_of = |(before, now): (&[DVec3], &[DVec3])| {
        let heights = before.iter().zip(now).map(height_of);
        heights.fold(f64::INFINITY, f64::min)
    };
    let parts = before.iter().zip(now).map(|(a, b)| (&a[..], &b[..]));
    let parts = parts.min_by(|a, b| lowest_of(*a).total_cmp(&lowest_of(*b)));
    let Some((before, now)) = parts else {
        return DVec3::ZERO;
    };
    let lowest = lowest_of((before, now));
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for (before, now) in before.iter().zip(now) {
        let at = height_of((before, now));
        let weight = if at > lowest {
            math::exp(-(at - lowest) / height)
        } else {
            1.0
        };
        sum += (*now - *before) * weight;
        weights += weight;
    }
    if weights > 0.0 {
        sum / weights
    } else {
        DVec3::ZERO
    }
}

/// The surfaces of the parts that the ground holds up, besides the feet: hands and knees of a figure that crawls.
struct Surfaces {
    /// Per part how far it may be below the ground, because it is drawn there.
    parts: Vec<(FigurePartId, f64)>,
}

impl Surfaces {
    fn of(rig: &Rig, order: &[FigurePartId], floor: Option<f64>) -> Self {
        let part = |part: &FigurePartId| {
            let surface = rig.parts[*part].surface.iter().map(|point| point.y);
            let lowest = surface.reduce(f64::min)?;
            Some((*part, (floor? - lowest).max(0.0)))
        };
        Self {
            parts: order.iter().filter_map(part).collect(),
        }
    }

    /// The height of the lowest point.
    fn lowest(&self, rig: &Rig, kinematics: &ForwardKinematics) -> f64 {
        let parts = self.parts.iter().map(|(part, below)| {
            let surface = kinematics.surface(rig, *part).map(|point| point.y);
            surface.fold(f64::INFINITY, f64::min) + below
        });
        parts.fold(f64::INFINITY, f64::min)
    }
}

/// Whether a drive is that of a foot, rather than that of a whole leg or its lower half.
fn is_foot(landmarks: &Landmarks, drive: &Drive) -> bool {
    landmarks
        .feet
        .is_some_and(|feet| feet.contains(&drive.joint))
}

/// The leg lengths of the clip and of the figure, feet excluded; if one of them has no legs, their sizes.
pub(super) fn leg_lengths(source: &mut Source<'_>) -> [f64; 2] {
    let pose = match source.clip.frames {
        0 => source.clip.skeleton.offset_pose(),
        _ => source.poses.at(0).to_vec(),
    };
    let mean = |lengths: Vec<f64>| match lengths.len() {
        0 => None,
        count => Some(lengths.iter().sum::<f64>() / count as f64).filter(|length| *length > 0.0),
    };
    let way = |from: JointId, to: JointId| (pose[to].position - pose[from].position).length();
    let clip_legs = match (source.landmarks.thighs, source.landmarks.feet) {
        (Some(thighs), Some(feet)) => [0, 1].map(|side| match source.landmarks.knees {
            Some(knees) => way(thighs[side], knees[side]) + way(knees[side], feet[side]),
            None => way(thighs[side], feet[side]),
        }),
        _ => [0.0; 2],
    };
    let parts = source.rig.parts.iter_enumerated();
    let stand_on = parts.filter(|(_, part)| part.is_leg && part.stands);
    let rig_legs = stand_on
        .map(|(index, _)| leg_length(source.rig, source.landmarks, index))
        .collect();
    match (mean(clip_legs.to_vec()), mean(rig_legs)) {
        (Some(clip), Some(rig)) => [clip, rig],
        _ => {
            let extent = |points: &mut dyn Iterator<Item = DVec3>| {
                let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                for point in points {
                    low = low.min(point);
                    high = high.max(point);
                }
                (high - low).max_element().max(0.0)
            };
            let ends = |part: &super::RigPart| [part.joint, part.tip];
            [
                extent(&mut pose.iter().map(|placed| placed.position)),
                extent(&mut source.rig.parts.iter().flat_map(ends)),
            ]
        }
    }
}

/// The length of the leg that ends with a part, from joint to joint: pieces reach into each other.
fn leg_length(rig: &Rig, landmarks: &Landmarks, end: FigurePartId) -> f64 {
    let above = |part: &FigurePartId| {
        let parent = rig.parts[*part].parent?;
        let above = &rig.parts[parent];
        let is_moving = above.drive.is_some() || above.shared.is_some();
        (above.is_leg && is_moving).then_some(parent)
    };
    let pieces = std::iter::successors(Some(end), above)
        // Parents that form a cycle have no top.
        .take(rig.parts.len())
        .map(|part| &rig.parts[part])
        .filter(|part| part.drive.is_none_or(|drive| !is_foot(landmarks, &drive)));
    let points: Vec<DVec3> = pieces
        .enumerate()
        .flat_map(|(index, piece)| [(index == 0).then_some(piece.tip), Some(piece.joint)])
        .flatten()
        .collect();
    let bones = points.windows(2);
    bones.map(|pair| pair[0].distance(pair[1])).sum()
}
