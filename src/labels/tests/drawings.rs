//! Figures whose names say little: what lies on the trunk, animals with many legs, heads in odd places.

use super::figures::{Row, check, figure};
use crate::labels::Facing;
use crate::labels::figure::label_drawn;

#[test]
fn what_lies_on_the_trunk_stays_there() {
    check(
        &[
            ("a", "", [50.0, 40.0], [50.0, 90.0], 20.0),
            ("b", "a", [50.0, 90.0], [50.0, 115.0], 12.0),
            ("panel", "a", [36.0, 70.0], [26.0, 70.0], 6.0),
            ("c", "a", [40.0, 60.0], [64.0, 60.0], 5.0),
            ("d", "a", [32.0, 85.0], [10.0, 60.0], 4.0),
            ("e", "a", [68.0, 85.0], [90.0, 60.0], 4.0),
            ("f", "a", [40.0, 42.0], [38.0, 0.0], 5.0),
            ("g", "a", [60.0, 42.0], [62.0, 0.0], 5.0),
        ],
        &[
            "body",
            "head",
            "-",
            "-",
            "right arm",
            "left arm",
            "right leg",
            "left leg",
        ],
    );
}

#[test]
fn what_lies_around_the_trunk_is_no_arm() {
    check(
        &[
            ("a", "", [50.0, 50.0], [50.0, 90.0], 6.0),
            ("b", "a", [50.0, 90.0], [50.0, 110.0], 10.0),
            ("tutu", "a", [20.0, 56.0], [90.0, 56.0], 4.0),
            ("c", "a", [50.0, 52.0], [44.0, 0.0], 2.0),
            ("d", "a", [50.0, 52.0], [58.0, 0.0], 2.0),
        ],
        &["body", "head", "-", "right leg", "left leg"],
    );
}

#[test]
fn a_belly_on_a_body_is_no_piece_of_the_trunk() {
    check(
        &[
            ("Body", "", [50.0, 10.0], [50.0, 90.0], 20.0),
            ("Belly", "Body", [50.0, 15.0], [50.0, 70.0], 14.0),
            ("Head", "Body", [50.0, 90.0], [50.0, 115.0], 12.0),
        ],
        &["body", "-", "head"],
    );
}

#[test]
fn words_for_skeletons_are_not_read_in_drawings() {
    check(
        &[
            ("Body", "", [50.0, 10.0], [50.0, 90.0], 20.0),
            ("Tail end", "Body", [50.0, 20.0], [90.0, 30.0], 2.0),
            ("R arm control", "Body", [32.0, 80.0], [10.0, 60.0], 3.0),
            ("Head", "Body", [50.0, 90.0], [50.0, 115.0], 12.0),
        ],
        &["body", "tail", "right arm", "head"],
    );
}

#[test]
fn clothes_and_shoes() {
    check(
        &[
            ("Armour", "", [50.0, 40.0], [50.0, 90.0], 20.0),
            ("Helmet", "Armour", [50.0, 90.0], [50.0, 115.0], 12.0),
            ("Plume", "Helmet", [50.0, 115.0], [50.0, 130.0], 3.0),
            ("Rarm", "Armour", [32.0, 85.0], [10.0, 60.0], 4.0),
            ("Rglove", "Rarm", [10.0, 60.0], [6.0, 54.0], 4.0),
            ("Lfoot", "Armour", [60.0, 42.0], [62.0, 0.0], 5.0),
            ("Lshoe", "Lfoot", [62.0, 0.0], [70.0, -4.0], 3.0),
            ("Skirt", "Armour", [50.0, 40.0], [50.0, 20.0], 12.0),
        ],
        &[
            "body",
            "head",
            "-",
            "right arm",
            "right arm end",
            "left leg",
            "-",
            "-",
        ],
    );
}

#[test]
fn a_hat_does_not_hide_that_its_head_has_no_name() {
    check(
        &[
            ("Body", "", [50.0, 40.0], [50.0, 90.0], 20.0),
            ("a", "Body", [50.0, 90.0], [50.0, 115.0], 12.0),
            ("Hat", "Body", [50.0, 112.0], [50.0, 125.0], 12.0),
        ],
        &["body", "head", "-"],
    );
}

#[test]
fn what_carries_a_head_or_both_arms_is_trunk_or_neck() {
    let with = |half: f64| -> [Row<'static>; 6] {
        [
            ("bottom", "", [50.0, 0.0], [50.0, 40.0], 22.0),
            ("middle", "bottom", [30.0, 55.0], [70.0, 55.0], 18.0),
            ("a", "middle", [50.0, 70.0], [50.0, 80.0], half),
            ("head", "a", [50.0, 80.0], [50.0, 100.0], 12.0),
            ("left arm", "middle", [68.0, 60.0], [95.0, 75.0], 2.0),
            ("right arm", "middle", [32.0, 60.0], [5.0, 75.0], 2.0),
        ]
    };
    let expected = |a| ["body", "body 1", a, "head", "left arm", "right arm"];
    check(&with(3.0), &expected("neck"));
    check(&with(10.0), &expected("body 2"));
}

#[test]
fn a_head_without_a_name_on_a_neck() {
    check(
        &[
            ("a", "", [50.0, 40.0], [50.0, 90.0], 20.0),
            ("b", "a", [50.0, 90.0], [50.0, 96.0], 4.0),
            ("c", "b", [50.0, 96.0], [50.0, 125.0], 14.0),
            ("d", "c", [50.0, 125.0], [50.0, 140.0], 1.0),
        ],
        &["body", "neck", "head", "-"],
    );
}

/// A spider seen from above: abdomen, thorax and head from top to bottom, eight legs of two segments on the thorax.
fn spider() -> Vec<Row<'static>> {
    const LEGS: [(&str, &str, &str, &str, f64, f64); 4] = [
        ("r0", "s0", "l0", "m0", 40.0, 90.0),
        ("r1", "s1", "l1", "m1", 15.0, 30.0),
        ("r2", "s2", "l2", "m2", -15.0, -40.0),
        ("r3", "s3", "l3", "m3", -45.0, -95.0),
    ];
    let mut rows: Vec<Row<'static>> = vec![
        ("a", "", [0.0, 15.0], [0.0, 85.0], 30.0),
        ("b", "a", [0.0, 20.0], [0.0, -24.0], 22.0),
        ("c", "b", [0.0, -20.0], [0.0, -40.0], 12.0),
    ];
    for (right, right_end, left, left_end, knee, foot) in LEGS {
        for (name, end, side) in [(right, right_end, -1.0), (left, left_end, 1.0)] {
            let [hip, knee, foot] = [
                [side * 18.0, knee / 8.0],
                [side * 55.0, knee],
                [side * 90.0, foot],
            ];
            rows.push((name, "b", hip, knee, 2.0));
            rows.push((end, name, knee, foot, 1.5));
        }
    }
    rows
}

#[test]
fn a_spider_that_is_seen_from_above_walks_on_eight_legs() {
    let mut expected: Vec<String> = ["body 1", "body", "head"].map(str::to_owned).into();
    for pair in ["", " 1", " 2", " 3"] {
        for side in ["right", "left"] {
            for segment in ["upper", "lower"] {
                expected.push(format!("{side} leg {segment}{pair}"));
            }
        }
    }
    let expected: Vec<&str> = expected.iter().map(String::as_str).collect();
    check(&spider(), &expected);
    let labeled = label_drawn(&figure(&spider()));
    assert_eq!(labeled.facing.facing, Facing::UpHeadDown);
    assert_eq!(labeled.splayed.raw[..3], [false; 3]);
    assert!(labeled.splayed.raw[3..].iter().all(|splayed| *splayed));
}

#[test]
fn a_cat_without_names_holds_its_tail_high() {
    check(
        &[
            ("a", "d", [82.0, 40.0], [80.0, 0.0], 4.0),
            ("b", "d", [152.0, 40.0], [154.0, 0.0], 4.0),
            ("c", "d", [72.0, 70.0], [44.0, 130.0], 10.0),
            ("d", "", [60.0, 60.0], [170.0, 60.0], 20.0),
            ("e", "d", [92.0, 40.0], [90.0, 0.0], 4.0),
            ("f", "d", [162.0, 40.0], [164.0, 0.0], 4.0),
            ("g", "d", [164.0, 84.0], [200.0, 84.0], 18.0),
            ("h", "g", [170.0, 98.0], [166.0, 118.0], 5.0),
        ],
        &[
            "left leg",
            "left leg 1",
            "tail",
            "body",
            "right leg",
            "right leg 1",
            "head",
            "-",
        ],
    );
}

#[test]
fn the_back_leg_of_a_bird_is_the_far_one() {
    check(
        &[
            ("back leg", "body", [112.0, 40.0], [110.0, 0.0], 2.0),
            ("body", "", [60.0, 60.0], [160.0, 60.0], 25.0),
            ("front leg", "body", [124.0, 40.0], [126.0, 0.0], 2.0),
            ("head", "body", [155.0, 80.0], [190.0, 90.0], 16.0),
        ],
        &["left leg", "body", "right leg", "head"],
    );
}

#[test]
fn a_raised_leg_is_a_leg() {
    check(
        &[
            ("a", "", [50.0, 50.0], [50.0, 90.0], 12.0),
            ("b", "a", [50.0, 90.0], [50.0, 110.0], 10.0),
            ("c", "a", [44.0, 52.0], [42.0, 0.0], 4.0),
            ("d", "a", [58.0, 54.0], [90.0, 30.0], 4.0),
        ],
        &["body", "head", "right leg", "left leg"],
    );
}

#[test]
fn only_wings_are_splayed_where_there_are_four_legs_or_fewer() {
    let bird = figure(&[
        ("body", "", [0.0, 20.0], [0.0, 60.0], 15.0),
        ("head", "body", [0.0, 60.0], [0.0, 80.0], 10.0),
        ("left wing", "body", [15.0, 50.0], [60.0, 70.0], 6.0),
        ("feather", "left wing", [60.0, 70.0], [80.0, 75.0], 2.0),
        ("right arm", "body", [-15.0, 50.0], [-60.0, 70.0], 6.0),
        ("left leg", "body", [8.0, 20.0], [8.0, 0.0], 2.0),
        ("right leg", "body", [-8.0, 20.0], [-8.0, 0.0], 2.0),
    ]);
    let splayed = label_drawn(&bird).splayed.raw;
    assert_eq!(splayed, [false, false, true, true, false, false, false]);
}

#[test]
fn a_penguin_has_hanging_wings_and_feet_without_legs() {
    let penguin = figure(&[
        ("body", "", [0.0, 5.0], [0.0, 60.0], 20.0),
        ("head", "body", [0.0, 60.0], [0.0, 80.0], 12.0),
        ("right wing", "body", [-18.0, 55.0], [-26.0, 20.0], 4.0),
        ("left wing", "body", [18.0, 55.0], [26.0, 20.0], 4.0),
        ("right foot", "body", [-6.0, 3.0], [-20.0, 3.0], 3.0),
        ("left foot", "body", [6.0, 3.0], [20.0, 3.0], 3.0),
    ]);
    let splayed = label_drawn(&penguin).splayed.raw;
    assert_eq!(splayed, [false, false, false, false, true, true]);
}
