use super::{Follow, MatchedPart, Problem, bent_arms, match_figure};
use crate::labels::tests::figures::{ANT, DOG, figure};
use crate::labels::{Carry, Class, Figure, FigurePartId, Side, Tip, label_clip};
use crate::mocap::bvh;
use crate::mocap::{Clip, JointId, Skeleton};

fn boxing() -> Clip {
    let bytes = include_bytes!("../../../examples/motion/boxing.bvh");
    bvh::read_bytes(bytes).unwrap().clip
}

/// What drives each part, in short: `LeftHip > LeftAnkle`, `Chest`, `-`.
fn drives(figure: &Figure, clip: &Clip) -> (Vec<String>, Vec<Problem>) {
    let skeleton = &clip.skeleton;
    let matching = match_figure(figure, skeleton, &label_clip(clip));
    let short = |part: &MatchedPart| match part.drive {
        None => "-".to_owned(),
        Some(drive) => {
            assert!(drive.tip.is_some() || drive.follow != Follow::Direction);
            let name = |joint: JointId| skeleton.joints[joint].name.clone();
            let tip = drive.tip.filter(|_| drive.follow == Follow::Direction);
            match tip {
                None => name(drive.joint),
                Some(Tip::Joint(tip)) => format!("{} > {}", name(drive.joint), name(tip)),
                Some(Tip::End { joint, .. }) => {
                    format!("{} > end of {}", name(drive.joint), name(joint))
                }
            }
        }
    };
    (
        matching.parts.iter().map(short).collect(),
        matching.problems,
    )
}

fn check(figure: &Figure, clip: &Clip, expected: &[&str]) {
    let (found, problems) = drives(figure, clip);
    assert_eq!(found, expected);
    assert_eq!(problems, []);
}

#[test]
fn limbs_of_one_piece_follow_the_whole_chain() {
    let human = figure(&[
        ("Lbody", "", [50.0, 60.0], [50.0, 45.0], 12.0),
        ("U-1", "Lbody", [42.0, 45.0], [40.0, 0.0], 5.0),
        ("U-2", "Lbody", [58.0, 45.0], [60.0, 0.0], 5.0),
        ("Ubody", "", [50.0, 60.0], [50.0, 90.0], 12.0),
        ("Head", "Ubody", [50.0, 90.0], [50.0, 115.0], 10.0),
        ("Rarm", "Ubody", [38.0, 85.0], [20.0, 55.0], 4.0),
        ("Larm", "Ubody", [62.0, 85.0], [80.0, 55.0], 4.0),
    ]);
    let expected = [
        "Hips",
        "RightHip > RightAnkle",
        "LeftHip > LeftAnkle",
        "Chest",
        "Head",
        "RightShoulder > RightWrist",
        "LeftShoulder > LeftWrist",
    ];
    check(&human, &boxing(), &expected);
}

#[test]
fn limbs_in_pieces_follow_their_bones() {
    let human = figure(&[
        ("Torso", "", [50.0, 50.0], [50.0, 85.0], 10.0),
        ("Neck", "Torso", [50.0, 85.0], [50.0, 90.0], 3.0),
        ("Head", "Neck", [50.0, 90.0], [50.0, 110.0], 9.0),
        ("Hat", "Head", [50.0, 108.0], [50.0, 120.0], 9.0),
        ("RThigh", "Torso", [44.0, 50.0], [42.0, 28.0], 4.0),
        ("RShin", "RThigh", [42.0, 28.0], [41.0, 6.0], 3.0),
        ("RBoot", "RShin", [41.0, 6.0], [36.0, 0.0], 3.0),
        ("LThigh", "Torso", [56.0, 50.0], [58.0, 28.0], 4.0),
        ("LShin", "LThigh", [58.0, 28.0], [59.0, 0.0], 3.0),
        ("RArm", "Torso", [40.0, 82.0], [30.0, 50.0], 3.0),
        ("RHand", "RArm", [30.0, 50.0], [28.0, 44.0], 3.0),
    ]);
    let expected = [
        "Chest",
        "Neck",
        "Head",
        "-",
        "RightHip > RightKnee",
        "RightKnee > RightAnkle",
        "RightAnkle",
        "LeftHip > LeftKnee",
        "LeftKnee > LeftAnkle",
        "RightShoulder > RightWrist",
        // An arm of one segment takes its hand along.
        "-",
    ];
    check(&human, &boxing(), &expected);
}

#[test]
fn a_trunk_in_pieces_is_spread_over_the_spine() {
    let human = figure(&[
        ("Chest", "Belly", [50.0, 70.0], [50.0, 90.0], 10.0),
        ("Belly", "Hips", [50.0, 55.0], [50.0, 70.0], 10.0),
        ("Hips", "", [50.0, 50.0], [50.0, 55.0], 10.0),
        ("Head", "Chest", [50.0, 90.0], [50.0, 110.0], 10.0),
    ]);
    check(&human, &boxing(), &["Chest", "Ab", "Hips", "Head"]);
}

#[test]
fn four_arms_follow_two() {
    let expected = [
        "Chest",
        "Head",
        "RightShoulder > RightWrist",
        "LeftShoulder > LeftWrist",
        "RightShoulder > RightWrist",
        "LeftShoulder > LeftWrist",
        "RightHip > RightAnkle",
        "LeftHip > LeftAnkle",
    ];
    check(&figure(&ANT), &boxing(), &expected);
}

#[test]
fn a_dog_trots() {
    let expected = [
        "LeftHip > LeftAnkle",
        "RightHip > RightAnkle",
        "-",
        "Chest",
        "Head",
        "-",
        "RightHip > RightAnkle",
        "RightAnkle",
        "LeftHip > LeftKnee",
        "LeftKnee > LeftAnkle",
    ];
    check(&figure(&DOG), &boxing(), &expected);
}

#[test]
fn splayed_limbs_follow_the_change() {
    let bird = |carry: Option<Carry>| {
        let mut bird = figure(&[
            ("body", "", [0.0, 20.0], [0.0, 60.0], 15.0),
            ("left wing", "body", [15.0, 50.0], [60.0, 70.0], 6.0),
            ("left leg", "body", [8.0, 20.0], [8.0, 0.0], 2.0),
        ]);
        for part in &mut bird.parts {
            part.carry = carry;
        }
        drives(&bird, &boxing()).0
    };
    let leg = "LeftHip > LeftAnkle";
    assert_eq!(bird(None), ["Chest", "LeftShoulder", leg]);
    let direction = bird(Some(Carry::Direction));
    assert_eq!(direction, ["Chest", "LeftShoulder > LeftWrist", leg]);
    let change = bird(Some(Carry::Change));
    assert_eq!(change, ["Chest", "LeftShoulder", "LeftHip"]);
}

#[test]
fn stretched_arms_on_a_boxer() {
    let human = figure(&[
        ("Body", "", [50.0, 50.0], [50.0, 85.0], 10.0),
        ("Rarm", "Body", [40.0, 82.0], [30.0, 50.0], 3.0),
        ("Larm", "Body", [60.0, 82.0], [66.0, 66.0], 3.0),
        ("Lforearm", "Larm", [66.0, 66.0], [70.0, 50.0], 3.0),
        ("Rleg", "Body", [45.0, 50.0], [45.0, 0.0], 3.0),
    ]);
    let bent = |clip: &Clip| {
        let anatomy = label_clip(clip);
        let matching = match_figure(&human, &clip.skeleton, &anatomy);
        bent_arms(&matching, clip, &anatomy)
    };
    match bent(&boxing()).as_slice() {
        [Problem::BentArm { part, error }] if usize::from(*part) == 1 => {
            assert!((0.25..1.0).contains(error), "{error}")
        }
        other => panic!("{other:?}"),
    }
    let zombie = include_bytes!("../../../examples/motion/zombie-walk.bvh");
    assert_eq!(bent(&bvh::read_bytes(zombie).unwrap().clip), []);
}

fn with_bones(bones: &[&str]) -> Figure {
    let mut human = figure(&[
        ("Body", "", [50.0, 50.0], [50.0, 85.0], 10.0),
        ("Rarm", "Body", [40.0, 82.0], [30.0, 50.0], 3.0),
    ]);
    human.parts.raw[1].bones = bones.iter().map(|bone| (*bone).to_owned()).collect();
    human
}

#[test]
fn bone_names_the_joints() {
    let arm = |bones: &[&str], clip: &Clip| drives(&with_bones(bones), clip).0[1].clone();
    let boxing = boxing();
    assert_eq!(arm(&["LeftElbow"], &boxing), "LeftElbow > LeftWrist");
    assert_eq!(arm(&["lefttoes"], &boxing), "LeftToes > end of LeftToes");
    assert_eq!(arm(&["Chest", "LeftWrist"], &boxing), "Chest > LeftWrist");
    let mut skeleton = Skeleton::clone(&boxing.skeleton);
    for joint in &mut skeleton.joints {
        joint.name = format!("actor:{}", joint.name);
    }
    let prefixed = Clip::new(skeleton.into(), boxing.frame_time, boxing.values().to_vec());
    assert_eq!(
        arm(&["leftelbow"], &prefixed),
        "actor:LeftElbow > actor:LeftWrist"
    );
    let mut body = with_bones(&[]);
    body.parts.raw[0].bones = vec!["LeftWrist".to_owned()];
    assert_eq!(drives(&body, &boxing).0[0], "LeftWrist");
}

#[test]
fn bones_that_cannot_be_used() {
    let boxing = boxing();
    let problems = |bones: &[&str]| drives(&with_bones(bones), &boxing);
    let (found, unknown) = problems(&["LeftElbo"]);
    assert_eq!(found[1], "RightShoulder > RightWrist");
    let name = "LeftElbo".to_owned();
    assert_eq!(
        unknown,
        [Problem::UnknownBone {
            part: 1.into(),
            name,
            nearest: vec!["LeftElbow".to_owned()]
        }]
    );
    let joint = |name: &str| {
        boxing
            .skeleton
            .joints
            .position(|joint| joint.name == name)
            .unwrap()
    };
    let (from, to) = (joint("LeftWrist"), joint("Chest"));
    assert_eq!(
        problems(&["LeftWrist", "Chest"]).1,
        [Problem::NotAChain {
            part: 1.into(),
            from,
            to
        }]
    );
    let (found, too_many) = problems(&["LeftShoulder", "LeftElbow", "LeftWrist"]);
    assert_eq!(found[1], "LeftShoulder > LeftElbow");
    assert_eq!(too_many, [Problem::TooManyBones { part: 1.into() }]);

    let mut skeleton = Skeleton::clone(&boxing.skeleton);
    skeleton.joints[to].name = "LeftWrist".to_owned();
    let twice = Clip::new(skeleton.into(), boxing.frame_time, boxing.values().to_vec());
    let (found, problems) = drives(&with_bones(&["LeftWrist"]), &twice);
    assert!(found[1].starts_with("LeftWrist"), "{}", found[1]);
    let joints = vec![to.min(from), to.max(from)];
    let name = "LeftWrist".to_owned();
    assert_eq!(
        problems,
        [Problem::AmbiguousBone {
            part: 1.into(),
            name,
            joints
        }]
    );
}

#[test]
fn limbs_that_the_motion_lacks() {
    let bytes = include_bytes!("../../../tests/motion/data/rotation_first.bvh");
    let clip = bvh::read_bytes(bytes).unwrap().clip;
    let (found, problems) = drives(&figure(&ANT), &clip);
    assert_eq!(
        found,
        [
            "Spine",
            "Head",
            "-",
            "-",
            "-",
            "-",
            "-",
            "LeftLeg > end of LeftLeg"
        ]
    );
    let lacks = |class, side, parts: &[usize]| Problem::NoSuchLimb {
        class,
        side,
        parts: parts.iter().copied().map(FigurePartId::from).collect(),
    };
    assert_eq!(
        problems,
        [
            lacks(Class::Arm, Side::Right, &[2, 4]),
            lacks(Class::Arm, Side::Left, &[3, 5]),
            lacks(Class::Leg, Side::Right, &[6]),
        ]
    );
    let empty = Clip::new(Skeleton::default().into(), 0.1, Vec::new());
    let (found, problems) = drives(&figure(&ANT), &empty);
    assert!(found.iter().all(|drive| drive == "-"));
    assert_eq!(problems.last(), Some(&Problem::NothingMatched));
}
