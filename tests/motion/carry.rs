//! What is carried over, against what the clip's own poses say: the laws of motions on figures.

mod again;
pub(crate) mod clips;
mod puppets;
mod random;
mod walks;

use glam::{DQuat, DVec3};
use okoshi::motion::carry::{Carried, Drive, Landmarks, Puppet, Rest, carry};
use okoshi::motion::labels::{Facing, Tip};
use okoshi::motion::matching::Follow;
use okoshi::motion::skeleton::{Clip, Placed};

use clips::{FILES, clip};
use puppets::{Limbs, biped, dog};

/// How far directions may be off, degrees.
const OFF: f64 = 0.05;

/// From a clip's world to a drawing's axes, worked out from nothing but places of joints.
pub(crate) struct Body {
    landmarks: Landmarks,
    up: DVec3,
    facing: Facing,
}

impl Body {
    pub(crate) fn of(clip: &Clip, landmarks: &Landmarks, facing: Facing) -> Self {
        let poses = (0..clip.frames()).map(|frame| clip.pose(frame));
        let rise = |pose: Vec<Placed>| {
            let [left, right] = landmarks.feet.expect("feet");
            let head = landmarks.head.expect("a head");
            pose[head].position - (pose[left].position + pose[right].position) / 2.0
        };
        let rise: DVec3 = poses.map(rise).sum();
        let axis = rise.abs().max_position();
        Self {
            landmarks: landmarks.clone(),
            up: DVec3::AXES[axis] * rise[axis].signum(),
            facing,
        }
    }

    /// The left and the front of the body in a pose, level, in the clip's world.
    fn left_and_front(&self, pose: &[Placed]) -> [DVec3; 2] {
        let line = |pair: Option<[usize; 2]>| {
            let [left, right] = pair.expect("hips and shoulders");
            (pose[left].position - pose[right].position).normalize()
        };
        let sum = line(self.landmarks.thighs) + line(self.landmarks.shoulders);
        let left = (sum - self.up * sum.dot(self.up)).normalize();
        [left, left.cross(self.up)]
    }

    /// A direction in the axes of a drawing of the body as it stands in a pose.
    pub(crate) fn drawn(&self, pose: &[Placed], way: DVec3) -> DVec3 {
        let [left, front] = self.left_and_front(pose).map(|axis| axis.dot(way));
        let up = self.up.dot(way);
        match self.facing {
            Facing::Viewer => DVec3::new(left, up, front),
            // Its right side is near the viewer.
            Facing::Right => DVec3::new(front, up, -left),
            Facing::Left => DVec3::new(-front, up, left),
        }
    }

    /// The same as a turn.
    fn turn(&self, pose: &[Placed]) -> DQuat {
        let columns = DVec3::AXES.map(|axis| self.drawn(pose, axis));
        DQuat::from_mat3(&glam::DMat3::from_cols(columns[0], columns[1], columns[2]))
    }
}

/// Where the far end of a chain is.
fn end(clip: &Clip, pose: &[Placed], tip: Tip) -> DVec3 {
    match tip {
        Tip::Joint(joint) => pose[joint].position,
        Tip::End { joint, end } => {
            let placed = pose[joint];
            placed.position + placed.rotation * clip.skeleton.joints[joint].ends[end]
        }
    }
}

/// The direction of a drive's chain in a pose, in the clip's world; nothing where it has no length.
fn direction(clip: &Clip, pose: &[Placed], drive: &Drive) -> Option<DVec3> {
    (end(clip, pose, drive.tip?) - pose[drive.joint].position).try_normalize()
}

/// Where the nodes of a puppet are in a frame, in the drawing's axes.
pub(crate) fn placed(puppet: &Puppet, carried: &Carried, frame: usize) -> Vec<Placed> {
    let mut done: Vec<Option<Placed>> = vec![None; puppet.parts.len()];
    fn place(
        puppet: &Puppet,
        carried: &Carried,
        frame: usize,
        part: usize,
        done: &mut Vec<Option<Placed>>,
    ) -> Placed {
        if let Some(placed) = done[part] {
            return placed;
        }
        let own = &puppet.parts[part];
        let turn = carried.turns[part].as_ref().map(|turns| turns[frame]);
        let place_ = carried.moves[part].as_ref().map(|moves| moves[frame]);
        let found = match own.parent.filter(|_| !own.is_rooted) {
            Some(parent) => {
                let above = place(puppet, carried, frame, parent, done);
                let rest = puppet.parts[parent].node;
                let back = rest.rotation.inverse();
                Placed {
                    rotation: above.rotation * turn.unwrap_or(back * own.node.rotation),
                    position: above.position
                        + above.rotation * (back * (own.node.position - rest.position)),
                }
            }
            None => Placed {
                rotation: turn.unwrap_or(own.node.rotation),
                position: place_.unwrap_or(own.node.position),
            },
        };
        done[part] = Some(found);
        found
    }
    (0..puppet.parts.len())
        .map(|part| place(puppet, carried, frame, part, &mut done))
        .collect()
}

/// Where a point of the drawing that belongs to a part is.
fn carried_to(puppet: &Puppet, placed: &[Placed], part: usize, point: DVec3) -> DVec3 {
    let rest = puppet.parts[part].node;
    placed[part].position
        + placed[part].rotation * (rest.rotation.inverse() * (point - rest.position))
}

/// The angle between directions, degrees; good for small ones too.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// The angle between turns, degrees.
pub(crate) fn apart(a: DQuat, b: DQuat) -> f64 {
    let turn = a * b.inverse();
    let sin = DVec3::new(turn.x, turn.y, turn.z).length();
    2.0 * sin.atan2(turn.w.abs()).to_degrees()
}

/// The worst that was seen, by what was looked at.
#[derive(Debug, Default)]
struct Worst {
    limbs: f64,
    bodies: f64,
    joints: f64,
    looked_at: usize,
}

/// Looks at every key of every part.
fn look(clip: &Clip, puppet: &Puppet, landmarks: &Landmarks) -> Worst {
    let carried = carry(clip, puppet, landmarks);
    let body = Body::of(clip, landmarks, puppet.facing);
    let first = clip.pose(0);
    let rest = match carried.rest {
        Rest::Offsets => clip.skeleton.offset_pose(),
        Rest::Frame(frame) => clip.pose(frame),
    };
    let size = puppet
        .parts
        .iter()
        .map(|part| part.tip.y)
        .fold(0.0, f64::max);
    let mut worst = Worst::default();
    for frame in 0..clip.frames() {
        let pose = clip.pose(frame);
        let placed = placed(puppet, &carried, frame);
        for (index, part) in puppet.parts.iter().enumerate() {
            assert!(placed[index].rotation.is_finite() && placed[index].position.is_finite());
            if let Some(parent) = part.parent {
                let [own, above] =
                    [index, parent].map(|part_| carried_to(puppet, &placed, part_, part.joint));
                worst.joints = worst.joints.max(own.distance(above) / size);
            }
            let Some(drive) = &part.drive else {
                let parent = part.parent.expect("all but the first hang on something");
                let now = placed[parent].rotation.inverse() * placed[index].rotation;
                let drawn = puppet.parts[parent].node.rotation.inverse() * part.node.rotation;
                worst.bodies = worst.bodies.max(apart(now, drawn));
                continue;
            };
            worst.looked_at += 1;
            match (drive.follow, direction(clip, &pose, drive)) {
                (Follow::Direction, Some(way)) => {
                    let axis = part.node.rotation.inverse() * (part.tip - part.joint);
                    let off = angle(placed[index].rotation * axis, body.drawn(&first, way));
                    worst.limbs = worst.limbs.max(off);
                }
                (Follow::Direction, None) => {}
                (Follow::Change, _) => {
                    // C₀ᵀ R(k) R(r)ᵀ C_r · D
                    let change = pose[drive.joint].rotation * rest[drive.joint].rotation.inverse();
                    let due = body.turn(&first)
                        * change
                        * body.turn(&rest).inverse()
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
        let ready = clip(file);
        let clip = &ready.clip;
        let landmarks = Landmarks::of(&ready.anatomy);
        let mut puppets: Vec<(String, Puppet)> = Vec::new();
        for limbs in Limbs::ALL {
            for pieces in 1..=3 {
                puppets.push((
                    format!("{limbs:?} {pieces}"),
                    biped(&ready.anatomy, limbs, pieces),
                ));
            }
        }
        for facing in [Facing::Left, Facing::Right] {
            puppets.push((format!("dog {facing:?}"), dog(&ready.anatomy, facing)));
        }
        for (name, puppet) in puppets {
            let worst = look(clip, &puppet, &landmarks);
            assert!(worst.limbs < OFF, "{file}, {name}: {worst:?}");
            assert!(worst.bodies < OFF, "{file}, {name}: {worst:?}");
            assert!(worst.joints < 1e-9, "{file}, {name}: {worst:?}");
            let parts = puppet
                .parts
                .iter()
                .filter(|part| part.drive.is_some())
                .count();
            assert_eq!(worst.looked_at, parts * clip.frames(), "{file}, {name}");
            assert!(parts >= 6, "{file}, {name}: {parts}");
            all.limbs = all.limbs.max(worst.limbs);
            all.bodies = all.bodies.max(worst.bodies);
            all.joints = all.joints.max(worst.joints);
        }
    }
    eprintln!("worst of all: {all:?}");
}
