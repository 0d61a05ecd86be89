//! Skeletons of real files: by their names, and with the names taken away.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use typed_index_collections::{TiVec, ti_vec};

use super::limbs;
use crate::labels::skeleton::label_skeleton;
use crate::labels::{Anatomy, Class, Limb, Side, Tip, label_clip};
use crate::mocap::bvh;
use crate::mocap::{Axis, Channel, Clip, Joint, JointId, Skeleton};

const FILES: [(&str, &[u8], [&str; 4]); 4] = [
    (
        "boxing",
        include_bytes!("../../../examples/motion/boxing.bvh"),
        [
            "LeftShoulder LeftElbow LeftWrist",
            "LeftHip LeftKnee LeftAnkle",
            "Chest",
            "Head",
        ],
    ),
    (
        "zombie-walk",
        include_bytes!("../../../examples/motion/zombie-walk.bvh"),
        [
            "UpArm_L LoArm_L Hand_L",
            "UpLeg_L LoLeg_L Foot_L",
            "Spine3",
            "Head",
        ],
    ),
    (
        "mocapbank",
        include_bytes!("../../../tests/motion/data/mocapbank.bvh"),
        [
            "LeftShoulder LeftElbow LeftWrist",
            "LeftHip LeftKnee LeftAnkle",
            "Chest2",
            "Head",
        ],
    ),
    (
        "mixed_orders",
        include_bytes!("../../../tests/motion/data/mixed_orders.bvh"),
        [
            "LeftArm LeftForeArm LeftHand",
            "LeftUpLeg LeftLeg LeftFoot",
            "Spine3",
            "Head",
        ],
    ),
];

fn clips() -> Vec<(&'static str, Clip)> {
    let read = |bytes| bvh::read_bytes(bytes).unwrap().clip;
    FILES
        .iter()
        .map(|(name, bytes, _)| (*name, read(bytes)))
        .collect()
}

/// Upper, lower and end joint per limb, hips, chest and head.
fn bones(anatomy: &Anatomy) -> (Vec<[Option<JointId>; 3]>, [Option<JointId>; 3]) {
    let limbs = [Class::Arm, Class::Leg]
        .into_iter()
        .flat_map(|class| Side::BOTH.map(|side| anatomy.limb(class, side)))
        .map(|limb| limb.map_or([None; 3], |limb| [Some(limb.upper), limb.lower, limb.end]))
        .collect();
    (limbs, [anatomy.hips, anatomy.chest(), anatomy.head])
}

fn blank(clip: &Clip) -> Clip {
    let mut skeleton = Skeleton::clone(&clip.skeleton);
    for joint in &mut skeleton.joints {
        joint.name.clear();
    }
    Clip::new(Arc::new(skeleton), clip.frame_time, clip.values().to_vec())
}

#[test]
fn by_words() {
    for (name, bytes, [arm, leg, chest, head]) in FILES {
        let clip = bvh::read_bytes(bytes).unwrap().clip;
        let anatomy = label_clip(&clip);
        let skeleton = &*clip.skeleton;
        let right = |left: &str| left.replace("Left", "Right").replace("_L", "_R");
        let expected = [arm.to_owned(), right(arm), leg.to_owned(), right(leg)];
        let found: Vec<String> = limbs(skeleton, &anatomy)
            .iter()
            .map(|limb| limb.join(" "))
            .collect();
        assert_eq!(found, expected, "{name}");
        assert_eq!(
            skeleton.joints[anatomy.hips.unwrap()].name,
            "Hips",
            "{name}"
        );
        assert_eq!(
            skeleton.joints[anatomy.chest().unwrap()].name,
            chest,
            "{name}"
        );
        assert_eq!(skeleton.joints[anatomy.head.unwrap()].name, head, "{name}");
        assert!(
            anatomy.limbs.iter().all(|limb| limb.tip.is_some()),
            "{name}"
        );
    }
}

#[test]
fn names_of_one_leg_are_enough_for_it() {
    let bytes = include_bytes!("../../../tests/motion/data/rotation_first.bvh");
    let clip = bvh::read_bytes(bytes).unwrap().clip;
    let anatomy = label_clip(&clip);
    assert_eq!(anatomy.limbs.len(), 1);
    let leg = anatomy.limb(Class::Leg, Side::Left).unwrap();
    assert_eq!(clip.skeleton.joints[leg.upper].name, "LeftLeg");
    assert!(leg.tip.is_some());
    assert_eq!(clip.skeleton.joints[anatomy.head.unwrap()].name, "Head");
}

#[test]
fn by_shape_alone() {
    for (name, clip) in clips() {
        let expected = bones(&label_clip(&clip));
        let blank = blank(&clip);
        assert_eq!(bones(&label_clip(&blank)), expected, "{name}");
        assert_eq!(
            bones(&label_skeleton(&blank.skeleton)),
            expected,
            "{name}, without frames"
        );
    }
}

/// A clip whose siblings stand in another order, and per joint its place in the other.
fn shuffled(clip: &Clip, seed: u64) -> (Clip, TiVec<JointId, JointId>) {
    let children = clip.skeleton.children();
    let mut random = fastrand::Rng::with_seed(seed);
    let mut order = Vec::new();
    let joints = clip.skeleton.joints.keys();
    let mut open: Vec<JointId> = joints
        .filter(|joint| clip.skeleton.joints[*joint].parent.is_none())
        .collect();
    while !open.is_empty() {
        let joint = open.swap_remove(random.usize(..open.len()));
        order.push(joint);
        open.extend(&children[joint]);
    }
    let mut places: TiVec<JointId, JointId> = ti_vec![0.into(); order.len()];
    for (place, joint) in order.iter().enumerate() {
        places[*joint] = place.into();
    }
    let joints = order.iter().map(|joint| {
        let mut joint = clip.skeleton.joints[*joint].clone();
        joint.parent = joint.parent.map(|parent| places[parent]);
        joint
    });
    let skeleton = Skeleton {
        joints: joints.collect(),
    };
    let mut next = 0;
    let columns: TiVec<JointId, Range<usize>> = clip
        .skeleton
        .joints
        .iter()
        .map(|joint| {
            let start = next;
            next += joint.channels.len();
            start..next
        })
        .collect();
    let values = (0..clip.frames)
        .flat_map(|frame| {
            let row = clip.row(frame);
            order
                .iter()
                .flat_map(|joint| row[columns[*joint].clone()].to_vec())
                .collect::<Vec<f64>>()
        })
        .collect();
    (
        Clip::new(Arc::new(skeleton), clip.frame_time, values),
        places,
    )
}

#[test]
fn by_shape_whatever_the_order_of_siblings() {
    for (name, clip) in clips() {
        let blank = blank(&clip);
        let (limbs, trunk) = bones(&label_clip(&clip));
        for seed in 0..20 {
            let (other, places) = shuffled(&blank, seed);
            let to = |joint: Option<JointId>| joint.map(|joint| places[joint]);
            let expected = (
                limbs.iter().map(|limb| limb.map(to)).collect(),
                trunk.map(to),
            );
            assert_eq!(bones(&label_clip(&other)), expected, "{name}, order {seed}");
        }
    }
}

/// The clip as a mirror shows it, left and right changed.
fn mirrored(clip: &Clip) -> Clip {
    let mut skeleton = Skeleton::clone(&clip.skeleton);
    let flip = |point: DVec3| DVec3::new(-point.x, point.y, point.z);
    for joint in &mut skeleton.joints {
        joint.offset = flip(joint.offset);
        joint.ends = joint.ends.iter().map(|end| flip(*end)).collect();
    }
    let signs: Vec<f64> = skeleton
        .joints
        .iter()
        .flat_map(|joint| &joint.channels)
        .map(|channel| match channel {
            Channel::Position(Axis::X) | Channel::Rotation(Axis::Y | Axis::Z) => -1.0,
            _ => 1.0,
        })
        .collect();
    let values = clip.values().chunks(signs.len()).flat_map(|row| {
        row.iter()
            .zip(&signs)
            .map(|(number, sign)| number * sign)
            .collect::<Vec<f64>>()
    });
    Clip::new(Arc::new(skeleton), clip.frame_time, values.collect())
}

#[test]
fn a_mirrored_figure_has_its_sides_changed() {
    for (name, clip) in clips() {
        let (limbs, trunk) = bones(&label_clip(&clip));
        let expected = (vec![limbs[1], limbs[0], limbs[3], limbs[2]], trunk);
        let mirrored = mirrored(&blank(&clip));
        assert_eq!(bones(&label_clip(&mirrored)), expected, "{name}");
    }
}

#[test]
fn a_hand_points_to_its_middle_finger() {
    for (name, clip) in clips() {
        let anatomy = label_clip(&clip);
        let hand = anatomy.limb(Class::Arm, Side::Right).unwrap();
        let tip = match hand.tip.unwrap() {
            Tip::Joint(joint) => clip.skeleton.joints[joint].name.clone(),
            Tip::End { joint, .. } => format!("end of {}", clip.skeleton.joints[joint].name),
        };
        let expected = match name {
            "zombie-walk" => "Middle1_R",
            "mixed_orders" => "RightHandMiddle1",
            _ => "end of RightWrist",
        };
        assert_eq!(tip, expected, "{name}");
    }
}

/// The clip with a joint that only twists in the middle of each bone of the limbs, and the places of the old joints.
fn with_twist_joints(clip: &Clip, anatomy: &Anatomy) -> (Clip, TiVec<JointId, JointId>) {
    let of_limb = |limb: &Limb| [limb.lower, limb.end];
    let split: Vec<JointId> = anatomy.limbs.iter().flat_map(of_limb).flatten().collect();
    let mut joints: TiVec<JointId, Joint> = TiVec::new();
    let mut places: TiVec<JointId, JointId> = TiVec::new();
    let mut new = Vec::new();
    for (id, joint) in clip.skeleton.joints.iter_enumerated() {
        let mut joint = joint.clone();
        joint.parent = joint.parent.map(|parent| places[parent]);
        if split.contains(&id) {
            joint.offset /= 2.0;
            let twist = joints.push_and_get_key(Joint {
                channels: Vec::new(),
                ends: Vec::new(),
                ..joint.clone()
            });
            new.push(twist);
            joint.parent = Some(twist);
        }
        places.push(joints.push_and_get_key(joint));
    }
    let skeleton = Arc::new(Skeleton { joints });
    let clip = Clip::new(skeleton, clip.frame_time, clip.values().to_vec());
    (clip, places)
}

#[test]
fn elbows_and_knees_are_where_the_motion_bends() {
    for (name, clip) in clips() {
        let known = label_clip(&clip);
        let (split, places) = with_twist_joints(&blank(&clip), &known);
        let to = |joint: Option<JointId>| joint.map(|joint| places[joint]);
        let (limbs, _) = bones(&known);
        let found = bones(&label_clip(&split)).0;
        for (limb, found) in limbs.iter().zip(found) {
            assert_eq!(found[..2], [to(limb[0]), to(limb[1])], "{name}");
        }
    }
}
