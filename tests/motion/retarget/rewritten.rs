//! The same motion, written in another way, moves a figure in the same way.

use glam::{DQuat, DVec3};
use okoshi::internals::labels::{Facing, label_clip};
use okoshi::internals::mocap::bvh::{Decimals, read_bytes, write};
use okoshi::internals::mocap::{Clip, JointId};
use okoshi::internals::retarget::{Landmarks, RestSource, RetargetedClip, Rig, retarget};

use fastrand::Rng;
use typed_index_collections::TiVec;

use super::clips::{FILES, Moving, clip};
use super::rigs::{Limbs, biped, stout};
use super::{Body, angle, apart, placed};

/// Retargets a clip to a figure that is built from the clip's own labels.
fn play(clip: &Clip, pieces: usize) -> (Rig, RetargetedClip) {
    let anatomy = label_clip(clip);
    let rig = biped(&anatomy, Limbs::Bound, pieces);
    let retargeted = retarget(clip, &rig, &Landmarks::of(&anatomy));
    (rig, retargeted)
}

/// The largest differences of two motions of a figure: degrees, and drawing units.
fn differences(a: &(Rig, RetargetedClip), b: &(Rig, RetargetedClip)) -> [f64; 2] {
    let frames = a.1.grounded.len();
    assert_eq!(frames, b.1.grounded.len());
    assert_eq!(a.1.rest, b.1.rest, "the rest pose");
    assert_eq!(a.1.grounded, b.1.grounded, "feet on the ground");
    let mut worst = [0.0_f64; 2];
    for frame in 0..frames {
        let [a, b] = [a, b].map(|(rig, retargeted)| placed(rig, retargeted, frame));
        for (a, b) in a.iter().zip(&b) {
            worst[0] = worst[0].max(apart(a.rotation, b.rotation));
            worst[1] = worst[1].max(a.position.distance(b.position));
        }
    }
    worst
}

#[track_caller]
fn same(file: &str, what: &str, a: &Clip, b: &Clip) {
    for pieces in 1..=3 {
        let [degrees, units] = differences(&play(a, pieces), &play(b, pieces));
        eprintln!("{file} {what} {pieces}: {degrees:.2e}° {units:.2e}");
        // The figure is 200 units high.
        assert!(
            degrees < 1e-3,
            "{file}, {what}, {pieces} pieces: {degrees}°"
        );
        assert!(
            units < 1e-3,
            "{file}, {what}, {pieces} pieces: {units} units"
        );
    }
}

fn random_turns(count: usize, seed: u64) -> TiVec<JointId, DQuat> {
    let mut random = Rng::with_seed(seed);
    let turns = (0..count).map(|_| {
        if random.u8(..100) < 20 {
            return DQuat::IDENTITY;
        }
        let mut number = || f64::from(random.i32(-1000..=1000)) / 1000.0;
        let [x, y, z, w] = [(); 4].map(|()| number());
        DQuat::from_xyzw(x, y, z, w + 1.5).normalize()
    });
    turns.collect()
}

#[test]
fn rotation_order_does_not_matter() {
    for file in FILES {
        let clip = clip(file).clip;
        for order in 0..6 {
            same(file, "order", &clip, &Moving::of(&clip).written(order));
        }
    }
}

#[test]
fn the_unit_does_not_matter() {
    for file in FILES {
        let clip = clip(file).clip;
        for unit in [0.0254, 100.0] {
            same(
                file,
                "unit",
                &clip,
                &Moving::of(&clip).scaled(unit).written(0),
            );
        }
    }
}

/// The up axis of a clip's world.
fn up(clip: &Clip) -> DVec3 {
    let landmarks = Landmarks::of(&label_clip(clip));
    Body::of(clip, &landmarks, Facing::Viewer).up
}

#[test]
fn the_heading_does_not_matter() {
    for file in FILES {
        let clip = clip(file).clip;
        for yaw in [37.0_f64, 90.0, 180.0, -101.0] {
            let turn = DQuat::from_axis_angle(up(&clip), yaw.to_radians());
            same(
                file,
                "yaw",
                &clip,
                &Moving::of(&clip).turned(turn).written(1),
            );
        }
    }
}

#[test]
fn the_up_axis_does_not_matter() {
    for file in FILES {
        let clip = clip(file).clip;
        for (axis, degrees) in [
            (DVec3::X, 90.0_f64),
            (DVec3::X, -90.0),
            (DVec3::Z, 90.0),
            (DVec3::X, 180.0),
        ] {
            let turn = DQuat::from_axis_angle(axis, degrees.to_radians());
            same(
                file,
                "up",
                &clip,
                &Moving::of(&clip).in_other_axes(turn).written(2),
            );
        }
    }
}

/// A skeleton in a world with another up axis: one whose offsets stand, and one whose offsets do not.
#[test]
fn the_up_axis_of_the_motion_alone_does_not_matter() {
    let mut standing = 0;
    for file in FILES {
        let clip = clip(file).clip;
        let joints = clip.skeleton.joints.len();
        standing += usize::from(play(&clip, 2).1.rest == RestSource::Offsets);
        let fallen = || Moving::of(&clip).reoriented(&random_turns(joints, 3));
        for turn in [DQuat::from_rotation_x, DQuat::from_rotation_z] {
            let turn = turn(std::f64::consts::FRAC_PI_2);
            let turned = Moving::of(&clip).turned(turn).written(0);
            same(file, "up alone", &clip, &turned);
            let turned = fallen().turned(turn).written(0);
            same(file, "up alone, fallen", &fallen().written(0), &turned);
        }
    }
    assert!(standing >= 4, "the offsets of only {standing} files stand");
}

/// Another rest pose in the file: the joints' frames are rotated by constants, and the motion compensates for that.
#[test]
fn the_rest_pose_does_not_matter() {
    for file in FILES {
        let clip = clip(file).clip;
        let legs_up = Moving::of(&clip).along_bones(up(&clip)).written(0);
        // Randomly rotated, few skeletons stand by chance; then the offsets are the rest pose.
        let falls = |clip: &Clip| matches!(play(clip, 2).1.rest, RestSource::Frame(_));
        assert!(
            falls(&legs_up),
            "{file}: its legs point up beside the trunk"
        );
        let joints = clip.skeleton.joints.len();
        let turned = (1..20).map(|seed| random_turns(joints, seed));
        let mut fallen = turned
            .map(|turns| Moving::of(&clip).reoriented(&turns).written(0))
            .filter(falls);
        let others: Vec<Clip> = fallen.by_ref().take(4).collect();
        assert_eq!(others.len(), 4, "{file}");
        let size: f64 = clip
            .skeleton
            .joints
            .iter()
            .map(|joint| joint.offset.length())
            .sum();
        for frame in [0, clip.frames - 1] {
            for (a, b) in clip.pose(frame).iter().zip(legs_up.pose(frame)) {
                assert!(
                    a.position.distance(b.position) < 1e-9 * size,
                    "{file}: it is another motion"
                );
            }
        }
        for other in others {
            same(file, "rest", &legs_up, &other);
        }
    }
}

/// Where the offsets do not stand, a trunk leans by as much as the actor's, whatever frame is nearest to the drawing.
#[test]
fn trunks_lean_as_the_actor_does() {
    for file in FILES {
        let clip = clip(file).clip;
        let clip = Moving::of(&clip).along_bones(up(&clip)).written(0);
        let anatomy = label_clip(&clip);
        let landmarks = Landmarks::of(&anatomy);
        let body = Body::of(&clip, &landmarks, Facing::Viewer);
        let first = clip.pose(0);
        let shoulders = landmarks.shoulders.expect("shoulders");
        for pieces in 1..=3 {
            let rig = stout(&anatomy, Limbs::Bound, pieces);
            let trunk = rig.parts.first_key().expect("a trunk");
            let retargeted = retarget(&clip, &rig, &landmarks);
            for frame in 0..clip.frames {
                let pose = clip.pose(frame);
                let [left, right] = shoulders.map(|joint| pose[joint].position);
                let line = (left + right) / 2.0 - pose[landmarks.hips].position;
                let drawn = rig.parts[trunk].node.rotation.inverse() * DVec3::Y;
                let leans = placed(&rig, &retargeted, frame)[trunk].rotation * drawn;
                let off = angle(leans, body.drawn(&first, line));
                assert!(off < 0.05, "{file}, {pieces} pieces, frame {frame}: {off}°");
            }
        }
    }
}

#[test]
fn a_written_file_gives_the_same() {
    for file in FILES {
        let clip = clip(file).clip;
        let mut text = Vec::new();
        write(&clip, Decimals::All, &mut text).expect("written");
        same(file, "file", &clip, &read_bytes(&text).expect("read").clip);
    }
}
