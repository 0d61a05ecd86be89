//! Skeletons and figures that nobody would make.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use crate::labels::skeleton::label_skeleton;
use crate::labels::{Anatomy, label_figure};
use crate::labels::{Figure, FigurePart, FigurePartId};
use crate::law;
use crate::mocap::{Joint, Skeleton};
use crate::patience::finish;
use crate::retarget::{MatchedPart, match_figure};

fn name() -> impl Strategy<Value = String> {
    let words = prop::sample::select(vec![
        "",
        "Hips",
        "LeftArm",
        "LeftArm1",
        "rShldr",
        "L",
        "__UpLeg_L",
        "UpLeg_L",
        "Spine",
        "Neck",
        "Head",
        "Tail",
        "左足",
        "LeftFoot",
        "RightLeg",
        "a:b:",
        ":",
        "_",
        "x_Left",
        "ﾋｼﾞ",
        "Skirt",
        "hat",
    ]);
    prop_oneof![words.prop_map(str::to_owned), "\\PC{0,12}"]
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -100.0..100.0, 1 => Just(0.0), 1 => Just(1.0), 1 => any::<f64>(), 1 => Just(f64::NAN)]
}

fn skeleton() -> impl Strategy<Value = Skeleton> {
    let joint = (
        name(),
        any::<prop::sample::Index>(),
        any::<bool>(),
        [number(), number(), number()],
        0..3_usize,
    );
    prop::collection::vec(joint, 0..60).prop_map(|joints| {
        let joints =
            joints
                .into_iter()
                .enumerate()
                .map(|(index, (name, parent, root, offset, ends))| Joint {
                    name,
                    parent: (index > 0 && !root).then(|| parent.index(index).into()),
                    offset: DVec3::from_array(offset),
                    ends: vec![DVec3::from_array(offset); ends],
                    ..Joint::default()
                });
        Skeleton {
            joints: joints.collect(),
        }
    })
}

fn figure() -> impl Strategy<Value = Figure> {
    let point = || [number(), number()].prop_map(DVec2::from_array);
    let part = (
        name(),
        prop::option::of(0..40_usize),
        point(),
        point(),
        [point(), point()],
        prop::collection::vec(name(), 0..4),
    );
    prop::collection::vec(part, 0..30).prop_map(|parts| {
        let parts = parts.into_iter().enumerate().map(
            |(drawn, (name, parent, joint, tip, bounds, bones))| FigurePart {
                name,
                parent: parent.map(FigurePartId::from),
                joint,
                tip,
                bounds,
                drawing_order: drawn / 2,
                bones,
                carry: None,
                ..FigurePart::default()
            },
        );
        Figure {
            parts: parts.collect(),
            facing: None,
        }
    })
}

fn joints_are_there(anatomy: &Anatomy, joints: usize) {
    let limbs = anatomy.limbs.iter().flat_map(|limb| {
        [
            limb.collar,
            Some(limb.upper),
            limb.lower,
            limb.end,
            limb.toe,
        ]
    });
    let trunk = [anatomy.hips, anatomy.head]
        .into_iter()
        .chain(limbs)
        .flatten();
    let all = trunk.chain(
        anatomy
            .spine
            .iter()
            .chain(&anatomy.neck)
            .chain(&anatomy.tail)
            .copied(),
    );
    assert!(all.into_iter().all(|joint| usize::from(joint) < joints));
}

#[test]
fn any_skeleton_and_any_figure() {
    // In 96 % a part is driven.
    law::check(
        law::config(256),
        80,
        (skeleton(), figure()),
        |(skeleton, figure)| {
            let anatomy = label_skeleton(&skeleton);
            prop_assert_eq!(anatomy.labels.len(), skeleton.joints.len());
            joints_are_there(&anatomy, skeleton.joints.len());
            let matching = match_figure(&figure, &skeleton, &anatomy);
            prop_assert_eq!(matching.parts.len(), figure.parts.len());
            for MatchedPart { drive, why, .. } in &matching.parts {
                prop_assert!(!why.is_empty());
                prop_assert!(
                    drive
                        .as_ref()
                        .is_none_or(|drive| drive.joint < skeleton.joints.next_key())
                );
            }
            let is_driven = matching.parts.iter().any(|part| part.drive.is_some());
            let again = match_figure(&figure, &skeleton, &label_skeleton(&skeleton));
            prop_assert_eq!(matching, again);
            Ok(is_driven)
        },
    );
}

/// A skeleton of many joints; `parent` gives the parent of a joint.
fn many(count: usize, name: impl Fn(usize) -> String, parent: impl Fn(usize) -> usize) -> Skeleton {
    let joints = (0..count).map(|index| Joint {
        name: name(index),
        parent: (index > 0).then(|| parent(index).into()),
        offset: DVec3::ONE,
        ..Joint::default()
    });
    Skeleton {
        joints: joints.collect(),
    }
}

#[test]
fn many_joints_in_any_shape() {
    // So many that work in their square would not end.
    const JOINTS: usize = 100_000;
    let names: [fn(usize) -> String; 3] = [
        |_| String::new(),
        |_| "LeftArm".to_owned(),
        |index| format!("x_{index}"),
    ];
    let parents: [fn(usize) -> usize; 5] = [
        |index| index - 1,
        |_| 0,
        |index| (index - 1) / 2,
        |index| (index - 1) & !1,
        |index| (index - 1) / 100,
    ];
    finish("the labels of many joints", move || {
        for name in names {
            for parent in parents {
                let skeleton = many(JOINTS, name, parent);
                let anatomy = label_skeleton(&skeleton);
                assert_eq!(anatomy.labels.len(), JOINTS);
            }
        }
    });
}

#[test]
fn cycles_and_parents_out_of_range() {
    let part = |name: &str, parent: usize| FigurePart {
        name: name.to_owned(),
        parent: Some(parent.into()),
        tip: DVec2::Y,
        ..FigurePart::default()
    };
    let figure = Figure {
        parts: vec![
            part("a", 1),
            part("Rarm", 2),
            part("b", 0),
            part("c", 3),
            part("d", 99),
            part("e", 0),
        ]
        .into(),
        facing: None,
    };
    assert_eq!(label_figure(&figure).len(), 6);
    // A root with children is a trunk.
    assert!(label_figure(&figure).raw[1].is_some());
}

#[test]
fn parents_after_their_children_are_ignored() {
    let mut skeleton = many(5, |_| "Head".to_owned(), |index| index - 1);
    for (joint, parent) in [(0, 3), (2, 99), (3, 3)] {
        skeleton.joints.raw[joint].parent = Some(parent.into());
    }
    assert_eq!(label_skeleton(&skeleton).labels.len(), 5);
}
