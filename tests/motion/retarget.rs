//! Retargeted clips against the poses of their source: the laws of motion on figures.

pub(crate) mod clips;
mod frame_rates;
mod random;
mod rewritten;
pub(crate) mod rigs;
pub(crate) mod splayed;
mod swing;
mod walks;

use glam::{DQuat, DVec3};
use okoshi::internals::labels::{Facing, FigurePartId, Tip};
use okoshi::internals::mocap::{Clip, JointId, Pose, Transform};
use okoshi::internals::retarget::{Drive, Follow};
use okoshi::internals::retarget::{Landmarks, RestSource, RetargetedClip, Rig, retarget};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use clips::{FILES, clip};
use rigs::{Limbs, biped, dog, stout};
use splayed::{SplayedLeg, Steps};

/// Tolerance of directions, degrees.
const OFF: f64 = 0.05;

/// From a clip's world to a drawing's axes, computed from positions of joints only.
pub(crate) struct Body {
    landmarks: Landmarks,
    up: DVec3,
    facing: Facing,
}

impl Body {
    pub(crate) fn of(clip: &Clip, landmarks: &Landmarks, facing: Facing) -> Self {
        let poses = (0..clip.frames).map(|frame| clip.pose(frame));
        let rise: DVec3 = poses.map(|pose| rise(landmarks, &pose)).sum();
        Self::from_rise(landmarks, facing, rise)
    }

    /// The same for the skeleton's offset pose, which may have been made in other axes.
    fn of_offsets(clip: &Clip, landmarks: &Landmarks, facing: Facing) -> Self {
        let pose = clip.skeleton.offset_pose();
        Self::from_rise(landmarks, facing, rise(landmarks, &pose))
    }

    fn from_rise(landmarks: &Landmarks, facing: Facing, rise: DVec3) -> Self {
        let axis = rise.abs().max_position();
        Self {
            landmarks: landmarks.clone(),
            up: DVec3::AXES[axis] * rise[axis].signum(),
            facing,
        }
    }

    /// The left and the front of the body in a pose, horizontal, in the clip's world.
    fn left_and_front(&self, pose: &Pose) -> [DVec3; 2] {
        let line = |pair: Option<[JointId; 2]>| {
            let [left, right] = pair.expect("hips and shoulders");
            (pose[left].position - pose[right].position).normalize()
        };
        let sum = line(self.landmarks.thighs) + line(self.landmarks.shoulders);
        let left = (sum - self.up * sum.dot(self.up)).normalize();
        [left, left.cross(self.up)]
    }

    /// A direction of the clip's world in the axes of a drawing of the body in a pose.
    pub(crate) fn drawn(&self, pose: &Pose, way: DVec3) -> DVec3 {
        let [left, front] = self.left_and_front(pose).map(|axis| axis.dot(way));
        let up = self.up.dot(way);
        match self.facing {
            Facing::Viewer | Facing::UpHeadDown => DVec3::new(left, up, front),
            // Its right side is near the viewer.
            Facing::Right => DVec3::new(front, up, -left),
            Facing::Left => DVec3::new(-front, up, left),
            Facing::Away | Facing::Up => DVec3::new(-left, up, -front),
        }
    }

    /// The mean of a direction over all frames, in the axes of a drawing of the body.
    pub(crate) fn mean(&self, clip: &Clip, way: impl Fn(&Pose) -> Option<DVec3>) -> DVec3 {
        let poses = (0..clip.frames).map(|frame| clip.pose(frame));
        let ways = poses.filter_map(|pose| Some(self.drawn(&pose, way(&pose)?.normalize())));
        ways.sum::<DVec3>().normalize()
    }

    /// From the clip's world to the axes of a drawing of the body in a pose.
    pub(crate) fn turn(&self, pose: &Pose) -> DQuat {
        let columns = DVec3::AXES.map(|axis| self.drawn(pose, axis));
        DQuat::from_mat3(&glam::DMat3::from_cols(columns[0], columns[1], columns[2]))
    }
}

/// From feet to head.
fn rise(landmarks: &Landmarks, pose: &Pose) -> DVec3 {
    let [left, right] = landmarks.feet.expect("feet");
    let head = landmarks.head.expect("a head");
    pose[head].position - (pose[left].position + pose[right].position) / 2.0
}

/// The far end of a chain.
fn end(clip: &Clip, pose: &Pose, tip: Tip) -> DVec3 {
    match tip {
        Tip::Joint(joint) => pose[joint].position,
        Tip::End { joint, end } => {
            let placed = pose[joint];
            placed.position + placed.rotation * clip.skeleton.joints[joint].ends[end]
        }
    }
}

/// The direction of a drive's chain in a pose, in the clip's world; `None` if it has no length.
fn direction(clip: &Clip, pose: &Pose, drive: &Drive) -> Option<DVec3> {
    (end(clip, pose, drive.tip?) - pose[drive.joint].position).try_normalize()
}

/// Per part the transform of its node.
type Placed = TiSlice<FigurePartId, Transform>;

/// The transforms of a rig's nodes in a frame, in the drawing's axes.
pub(crate) fn placed(
    rig: &Rig,
    retargeted: &RetargetedClip,
    frame: usize,
) -> TiVec<FigurePartId, Transform> {
    let mut done: TiVec<FigurePartId, Option<Transform>> = ti_vec![None; rig.parts.len()];
    fn place(
        rig: &Rig,
        retargeted: &RetargetedClip,
        frame: usize,
        part: FigurePartId,
        done: &mut TiSlice<FigurePartId, Option<Transform>>,
    ) -> Transform {
        if let Some(placed) = done[part] {
            return placed;
        }
        let own = &rig.parts[part];
        let turn = retargeted.rotations[part]
            .as_ref()
            .map(|turns| turns[frame]);
        let place_ = retargeted.translations[part]
            .as_ref()
            .map(|moves| moves[frame]);
        let found = match own.parent.filter(|_| !own.is_rooted) {
            Some(parent) => {
                let above = place(rig, retargeted, frame, parent, done);
                let rest = rig.parts[parent].node;
                let back = rest.rotation.inverse();
                Transform {
                    rotation: above.rotation * turn.unwrap_or(back * own.node.rotation),
                    position: above.position
                        + above.rotation * (back * (own.node.position - rest.position)),
                }
            }
            None => Transform {
                rotation: turn.unwrap_or(own.node.rotation),
                position: place_.unwrap_or(own.node.position),
            },
        };
        done[part] = Some(found);
        found
    }
    rig.parts
        .keys()
        .map(|part| place(rig, retargeted, frame, part, &mut done))
        .collect()
}

/// The position of a point of the drawing that belongs to a part.
fn moved_point(rig: &Rig, placed: &Placed, part: FigurePartId, point: DVec3) -> DVec3 {
    let rest = rig.parts[part].node;
    placed[part].position
        + placed[part].rotation * (rest.rotation.inverse() * (point - rest.position))
}

/// The angle between directions, degrees; precise for small ones too.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// The angle between rotations, degrees.
pub(crate) fn apart(a: DQuat, b: DQuat) -> f64 {
    let turn = a * b.inverse();
    let sin = DVec3::new(turn.x, turn.y, turn.z).length();
    2.0 * sin.atan2(turn.w.abs()).to_degrees()
}

/// The worst deviations, by kind.
#[derive(Debug, Default)]
struct Worst {
    limbs: f64,
    bodies: f64,
    joints: f64,
    checked: usize,
}

/// Checks every key of every part.
fn check(clip: &Clip, rig: &Rig, landmarks: &Landmarks) -> Worst {
    let retargeted = retarget(clip, rig, landmarks);
    let body = Body::of(clip, landmarks, rig.facing);
    let first = clip.pose(0);
    let at_first = placed(rig, &retargeted, 0);
    let (rest, at_rest) = match retargeted.rest {
        RestSource::Offsets => (
            clip.skeleton.offset_pose(),
            Body::of_offsets(clip, landmarks, rig.facing),
        ),
        RestSource::Frame(frame) => (clip.pose(frame), Body::of(clip, landmarks, rig.facing)),
    };
    let size = rig.parts.iter().map(|part| part.tip.y).fold(0.0, f64::max);
    let first_room = |part: FigurePartId| {
        let turned = retargeted.turned[part].as_ref();
        turned.map_or(0.0, |turned| turned[0].to_degrees())
    };
    let legs = rig.parts.keys();
    let legs: Vec<SplayedLeg> = legs
        .filter_map(|part| SplayedLeg::of(rig, landmarks, part))
        .collect();
    let steps = Steps::of(clip, &body, &legs);
    let mut worst = Worst::default();
    for frame in 0..clip.frames {
        let pose = clip.pose(frame);
        let placed = placed(rig, &retargeted, frame);
        for (index, part) in rig.parts.iter_enumerated() {
            assert!(placed[index].rotation.is_finite() && placed[index].position.is_finite());
            if let Some(parent) = part.parent {
                let [own, above] =
                    [index, parent].map(|part_| moved_point(rig, &placed, part_, part.joint));
                worst.joints = worst.joints.max(own.distance(above) / size);
            }
            let Some(drive) = &part.drive else {
                let parent = part.parent.expect("all but the first hang on something");
                let now = placed[parent].rotation.inverse() * placed[index].rotation;
                let drawn = rig.parts[parent].node.rotation.inverse() * part.node.rotation;
                worst.bodies = worst.bodies.max(apart(now, drawn));
                continue;
            };
            worst.checked += 1;
            let turned = retargeted.turned[index]
                .as_ref()
                .map_or(0.0, |turned| turned[frame]);
            let room = turned.to_degrees();
            match (drive.follow, direction(clip, &pose, drive)) {
                (Follow::Direction, Some(way)) => {
                    let axis = part.node.rotation.inverse() * (part.tip - part.joint);
                    let off = angle(placed[index].rotation * axis, body.drawn(&first, way));
                    worst.limbs = worst.limbs.max(off - room);
                }
                (Follow::Direction, None) => worst.checked -= 1,
                // A foot turns by as much as its joint, from the first frame on.
                (Follow::Sole, _) => {
                    let change = pose[drive.joint].rotation * first[drive.joint].rotation.inverse();
                    let drawn = body.turn(&first);
                    let due = drawn * change * drawn.inverse() * at_first[index].rotation;
                    worst.bodies = worst
                        .bodies
                        .max(apart(placed[index].rotation, due) - room - first_room(index));
                }
                (Follow::Trunk { hips, shoulders }, _) => {
                    let lean = |pose: &Pose| {
                        let joints = [hips, shoulders[0], shoulders[1]];
                        let [hips, left, right] = joints.map(|joint| pose[joint].position);
                        (left + right) / 2.0 - hips
                    };
                    let turned = placed[index].rotation * part.node.rotation.inverse();
                    let drawn = at_rest.drawn(&rest, lean(&rest));
                    let off = angle(turned * drawn, body.drawn(&first, lean(&pose)));
                    worst.limbs = worst.limbs.max(off);
                }
                // A limb that keeps its drawn pose turns by as much as its chain does, from where that is on average; a leg steps.
                (Follow::Change, Some(way)) => {
                    let turned = placed[index].rotation * part.node.rotation.inverse();
                    let off = match SplayedLeg::of(rig, landmarks, index) {
                        Some(leg) => {
                            let due = steps.due(&leg, &pose);
                            angle(turned * leg.points, body.drawn(&first, due))
                        }
                        None => {
                            let mean = body.mean(clip, |pose| direction(clip, pose, drive));
                            angle(turned * mean, body.drawn(&first, way))
                        }
                    };
                    worst.limbs = worst.limbs.max(off - room);
                }
                (Follow::Change, None) => {
                    // C₀ᵀ R(k) R(r)ᵀ C_r · D
                    let change = pose[drive.joint].rotation * rest[drive.joint].rotation.inverse();
                    let due = body.turn(&first)
                        * change
                        * at_rest.turn(&rest).inverse()
                        * part.node.rotation;
                    worst.bodies = worst.bodies.max(apart(placed[index].rotation, due));
                }
            }
        }
    }
    worst
}

#[test]
fn parts_point_where_bones_do() {
    let mut all = Worst::default();
    for file in FILES {
        let prepared = clip(file);
        let clip = &prepared.clip;
        let landmarks = Landmarks::of(&prepared.anatomy);
        let mut rigs: Vec<(String, Rig)> = Vec::new();
        for limbs in Limbs::ALL {
            for pieces in 1..=3 {
                rigs.push((
                    format!("{limbs:?} {pieces}"),
                    biped(&prepared.anatomy, limbs, pieces),
                ));
                rigs.push((
                    format!("stout, {limbs:?} {pieces}"),
                    stout(&prepared.anatomy, limbs, pieces),
                ));
            }
        }
        for facing in [Facing::Left, Facing::Right] {
            rigs.push((format!("dog {facing:?}"), dog(&prepared.anatomy, facing)));
            let mut splayed = dog(&prepared.anatomy, facing);
            for part in splayed.parts.iter_mut().filter(|part| part.is_leg) {
                let drive = part.drive.as_mut().expect("a leg is driven");
                drive.follow = Follow::Change;
            }
            rigs.push((format!("splayed dog {facing:?}"), splayed));
        }
        for (name, rig) in rigs {
            let worst = check(clip, &rig, &landmarks);
            assert!(worst.limbs < OFF, "{file}, {name}: {worst:?}");
            assert!(worst.bodies < OFF, "{file}, {name}: {worst:?}");
            assert!(worst.joints < 1e-9, "{file}, {name}: {worst:?}");
            let parts = rig.parts.iter().filter(|part| part.drive.is_some()).count();
            assert_eq!(worst.checked, parts * clip.frames, "{file}, {name}");
            assert!(parts >= 6, "{file}, {name}: {parts}");
            all.limbs = all.limbs.max(worst.limbs);
            all.bodies = all.bodies.max(worst.bodies);
            all.joints = all.joints.max(worst.joints);
        }
    }
    eprintln!("worst of all: {all:?}");
}
