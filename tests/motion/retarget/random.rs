//! Whatever the skeleton, motion and figure, the results are finite.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use okoshi::internals::labels::{Facing, Tip, label_clip};
use okoshi::internals::mocap::{Axis, Channel, Clip, Joint, JointId, Skeleton, Transform};
use okoshi::internals::retarget::{Drive, Follow};
use okoshi::internals::retarget::{Landmarks, Rig, RigPart, retarget};
use proptest::prelude::*;

use super::placed;
use crate::common::law;

fn place() -> impl Strategy<Value = DVec3> {
    // Bones without length and flat figures are common.
    let number = prop_oneof![2 => Just(0.0), 3 => -100.0..100.0_f64, 1 => -1e-9..1e-9_f64, 1 => -1e9..1e9_f64];
    (number.clone(), number.clone(), number).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn joint(index: usize) -> impl Strategy<Value = Joint> {
    let names = prop::sample::select(vec![
        "Hips",
        "LeftArm",
        "RightArm",
        "LeftUpLeg",
        "LeftLeg",
        "RightLeg",
        "RightFoot",
        "Head",
        "Spine",
        "x",
    ]);
    (
        names,
        any::<prop::sample::Index>(),
        place(),
        prop::collection::vec(place(), 0..2),
        0..3_u8,
        0..8_u8,
    )
        .prop_map(move |(name, parent, offset, ends, kind, lone)| Joint {
            name: name.to_owned(),
            parent: (index > 0 && lone > 0).then(|| parent.index(index).into()),
            offset,
            channels: match kind {
                0 => vec![],
                1 => [Axis::Z, Axis::X, Axis::Y].map(Channel::Rotation).into(),
                _ => [Axis::X, Axis::Y, Axis::Z]
                    .map(Channel::Position)
                    .into_iter()
                    .chain([Axis::Y, Axis::X, Axis::Z].map(Channel::Rotation))
                    .collect(),
            },
            ends,
        })
}

fn motion() -> impl Strategy<Value = Clip> {
    let skeleton = (1..8_usize).prop_flat_map(|count| (0..count).map(joint).collect::<Vec<_>>());
    let numbers = prop::collection::vec(
        prop_oneof![Just(0.0), Just(180.0), -1000.0..1000.0_f64],
        0..200,
    );
    (skeleton, numbers).prop_map(|(joints, numbers)| {
        let joints = joints.into();
        Clip::new(Arc::new(Skeleton { joints }), 1.0 / 24.0, numbers)
    })
}

type PartSpec = (
    prop::sample::Index,
    bool,
    (DVec3, DVec3, DVec3),
    f64,
    Option<(prop::sample::Index, u8, prop::sample::Index)>,
    bool,
);

fn figure() -> impl Strategy<Value = (Vec<PartSpec>, Facing)> {
    let drive = prop::option::weighted(
        0.8,
        (
            any::<prop::sample::Index>(),
            0..4_u8,
            any::<prop::sample::Index>(),
        ),
    );
    let part = (
        any::<prop::sample::Index>(),
        any::<bool>(),
        (place(), place(), place()),
        -7.0..7.0_f64,
        drive,
        any::<bool>(),
    );
    let facing = prop::sample::select(vec![Facing::Viewer, Facing::Left, Facing::Right]);
    (prop::collection::vec(part, 1..7), facing)
}

fn rig(clip: &Clip, (parts, facing): (Vec<PartSpec>, Facing)) -> Rig {
    let joints = &clip.skeleton.joints;
    let part = |(index, (parent, is_rooted, (joint, tip, node), turn, drive, stands)): (
        usize,
        PartSpec,
    )| {
        let drive = drive.map(|(from, kind, to)| {
            let [joint, to] = [from, to].map(|at| JointId::from(at.index(joints.len())));
            let end = Tip::End { joint: to, end: 0 };
            Drive {
                joint,
                tip: match kind {
                    0 => None,
                    1 if !joints[to].ends.is_empty() => Some(end),
                    _ => Some(Tip::Joint(to)),
                },
                follow: if kind == 0 {
                    Follow::Change
                } else {
                    Follow::Direction
                },
            }
        });
        RigPart {
            parent: (index > 0).then(|| parent.index(index).into()),
            is_rooted: index == 0 || is_rooted,
            node: Transform {
                rotation: DQuat::from_rotation_z(turn),
                position: node,
            },
            joint,
            tip,
            surface: if is_rooted { vec![] } else { vec![tip, joint] },
            outline: Vec::new(),
            is_arm: false,
            stands,
            drive,
            is_leg: stands,
            swing: (turn > 3.0).then_some(turn),
            inside: None,
            shared: None,
        }
    };
    Rig {
        parts: parts.into_iter().enumerate().map(part).collect(),
        facing,
    }
}

#[test]
fn random_rigs_and_motions_give_finite_results() {
    law::check(
        law::config(2000),
        20,
        (motion(), figure()),
        |(clip, parts)| {
            let rig = rig(&clip, parts);
            let landmarks = Landmarks::of(&label_clip(&clip));
            let retargeted = retarget(&clip, &rig, &landmarks);
            prop_assert_eq!(retargeted.grounded.len(), clip.frames);
            for part in rig.parts.keys() {
                if let Some(turns) = &retargeted.rotations[part] {
                    prop_assert_eq!(turns.len(), clip.frames);
                    prop_assert!(turns.iter().all(|turn| (turn.length() - 1.0).abs() < 1e-9));
                    prop_assert!(turns.windows(2).all(|pair| pair[0].dot(pair[1]) >= 0.0));
                }
                if let Some(moves) = &retargeted.translations[part] {
                    prop_assert!(rig.parts[part].is_rooted);
                    prop_assert_eq!(moves.len(), clip.frames);
                }
            }
            for frame in 0..clip.frames {
                for placed in placed(&rig, &retargeted, frame) {
                    prop_assert!(placed.position.is_finite() && placed.rotation.is_finite());
                }
            }
            Ok(clip.frames > 1 && retargeted.rotations.iter().any(Option::is_some))
        },
    );
}
