//! Figures as people draw them.

use glam::DVec2;
use typed_index_collections::TiSlice;

use crate::labels::{Class, Label, LimbSegment, Side, label_figure};
use crate::labels::{Figure, FigurePart, FigurePartId};

/// A part: its name, what it hangs on, its joint, its tip, and half its width.
pub(super) type Row<'a> = (&'a str, &'a str, [f64; 2], [f64; 2], f64);

/// A figure of rods that were drawn in this order.
pub(crate) fn figure(rows: &[Row<'_>]) -> Figure {
    let rows: &TiSlice<FigurePartId, Row<'_>> = TiSlice::from_ref(rows);
    let parts = rows
        .iter()
        .enumerate()
        .map(|(drawn, (name, parent, joint, tip, half))| {
            let (joint, tip) = (DVec2::from_array(*joint), DVec2::from_array(*tip));
            let across = (tip - joint).perp().normalize_or_zero().abs() * *half;
            FigurePart {
                name: (*name).to_owned(),
                parent: rows.position(|row| row.0 == *parent),
                joint,
                tip,
                bounds: [joint.min(tip) - across, joint.max(tip) + across],
                width: 2.0 * *half,
                drawing_order: drawn,
                bones: Vec::new(),
                carry: None,
                ..FigurePart::default()
            }
        });
    Figure {
        parts: parts.collect(),
        facing: None,
    }
}

/// A label in short: `right arm upper 0`.
pub(crate) fn short(label: &Option<Label>) -> String {
    let Some(label) = label else {
        return "-".to_owned();
    };
    let mut words = Vec::new();
    words.extend(label.side.map(Side::name));
    words.push(label.class.name());
    words.extend(match label.segment {
        LimbSegment::Whole => None,
        LimbSegment::Collar => Some("collar"),
        LimbSegment::Upper => Some("upper"),
        LimbSegment::Lower => Some("lower"),
        LimbSegment::End => Some("end"),
        LimbSegment::Beyond => Some("beyond"),
    });
    let mut text = words.join(" ");
    if label.pair > 0 {
        text += &format!(" {}", label.pair);
    }
    text
}

pub(super) fn check(rows: &[Row<'_>], expected: &[&str]) {
    let figure = figure(rows);
    let labels = label_figure(&figure);
    let found: Vec<String> = labels.iter().map(short).collect();
    let named: Vec<String> = rows
        .iter()
        .zip(&found)
        .map(|(row, label)| format!("{}: {label}", row.0))
        .collect();
    let wanted: Vec<String> = rows
        .iter()
        .zip(expected)
        .map(|(row, label)| format!("{}: {label}", row.0))
        .collect();
    assert_eq!(named, wanted);
    for label in labels.iter().flatten() {
        assert!(label.why.contains('`'), "no reason: {}", label.why);
    }
}

/// The thesis' human: trunk in two, limbs of one segment, legs without telling names.
const HUMAN: [Row<'static>; 7] = [
    ("Lbody", "", [50.0, 60.0], [50.0, 45.0], 12.0),
    ("U-1", "Lbody", [42.0, 45.0], [40.0, 0.0], 5.0),
    ("U-2", "Lbody", [58.0, 45.0], [60.0, 0.0], 5.0),
    ("Ubody", "", [50.0, 60.0], [50.0, 90.0], 12.0),
    ("Head", "Ubody", [50.0, 90.0], [50.0, 115.0], 10.0),
    ("Rarm", "Ubody", [38.0, 85.0], [20.0, 55.0], 4.0),
    ("Larm", "Ubody", [62.0, 85.0], [80.0, 55.0], 4.0),
];

#[test]
fn human_of_the_thesis() {
    check(
        &HUMAN,
        &[
            "hips",
            "right leg",
            "left leg",
            "body",
            "head",
            "right arm",
            "left arm",
        ],
    );
}

#[test]
fn human_without_any_name_that_says_something() {
    let rows: Vec<Row<'_>> = HUMAN
        .iter()
        .map(|row| match row.0 {
            "Lbody" => ("U-3", "", row.2, row.3, row.4),
            "Ubody" => ("U-4", "", row.2, row.3, row.4),
            "Head" => ("U-5", "U-4", row.2, row.3, row.4),
            "Rarm" => ("U-6", "U-4", row.2, row.3, row.4),
            "Larm" => ("U-7", "U-4", row.2, row.3, row.4),
            name => (name, "U-3", row.2, row.3, row.4),
        })
        .collect();
    check(
        &rows,
        &[
            "hips",
            "right leg",
            "left leg",
            "body",
            "head",
            "right arm",
            "left arm",
        ],
    );
}

#[test]
fn stick_figure_by_shape() {
    check(
        &[
            ("U-1", "", [0.0, 50.0], [0.0, 80.0], 1.0),
            ("U-2", "U-1", [0.0, 80.0], [0.0, 100.0], 8.0),
            ("U-3", "U-1", [0.0, 75.0], [-25.0, 60.0], 1.0),
            ("U-4", "U-1", [0.0, 75.0], [25.0, 95.0], 1.0),
            ("U-5", "U-1", [0.0, 50.0], [-8.0, 25.0], 1.0),
            ("U-6", "U-5", [-8.0, 25.0], [-12.0, 0.0], 1.0),
            ("U-7", "U-1", [0.0, 50.0], [8.0, 25.0], 1.0),
            ("U-8", "U-7", [8.0, 25.0], [12.0, 0.0], 1.0),
        ],
        &[
            "body",
            "head",
            "right arm",
            "left arm",
            "right leg upper",
            "right leg lower",
            "left leg upper",
            "left leg lower",
        ],
    );
}

#[test]
fn human_in_pieces_with_clothes() {
    check(
        &[
            ("RThigh", "Torso", [44.0, 50.0], [42.0, 28.0], 4.0),
            ("RShin", "RThigh", [42.0, 28.0], [41.0, 6.0], 3.0),
            ("RBoot", "RShin", [41.0, 6.0], [36.0, 0.0], 3.0),
            ("LThigh", "Torso", [56.0, 50.0], [58.0, 28.0], 4.0),
            ("LShin", "LThigh", [58.0, 28.0], [59.0, 6.0], 3.0),
            ("LBoot", "LShin", [59.0, 6.0], [64.0, 0.0], 3.0),
            ("Torso", "", [50.0, 50.0], [50.0, 85.0], 10.0),
            ("Skirt", "Torso", [50.0, 52.0], [50.0, 35.0], 14.0),
            ("Neck", "Torso", [50.0, 85.0], [50.0, 90.0], 3.0),
            ("Head", "Neck", [50.0, 90.0], [50.0, 110.0], 9.0),
            ("Hat", "Head", [50.0, 108.0], [50.0, 120.0], 9.0),
            ("R_Arm", "Torso", [40.0, 82.0], [30.0, 50.0], 3.0),
            ("R_Hand", "R_Arm", [30.0, 50.0], [28.0, 44.0], 3.0),
            ("LArm", "Torso", [60.0, 82.0], [66.0, 66.0], 3.0),
            ("LForearm", "LArm", [66.0, 66.0], [70.0, 50.0], 3.0),
        ],
        &[
            "right leg upper",
            "right leg lower",
            "right leg end",
            "left leg upper",
            "left leg lower",
            "left leg end",
            "body",
            "-",
            "neck",
            "head",
            "-",
            "right arm",
            "right arm end",
            "left arm upper",
            "left arm lower",
        ],
    );
}

#[test]
fn japanese() {
    check(
        &[
            ("胴体", "", [50.0, 45.0], [50.0, 85.0], 10.0),
            ("頭", "胴体", [50.0, 85.0], [50.0, 110.0], 9.0),
            ("帽子", "頭", [50.0, 108.0], [50.0, 120.0], 9.0),
            ("右腕", "胴体", [40.0, 82.0], [30.0, 50.0], 3.0),
            ("右手", "右腕", [30.0, 50.0], [28.0, 42.0], 3.0),
            ("ひだりうで", "胴体", [60.0, 82.0], [70.0, 50.0], 3.0),
            ("右脚", "胴体", [44.0, 45.0], [42.0, 0.0], 4.0),
            ("左足", "胴体", [56.0, 45.0], [58.0, 0.0], 4.0),
        ],
        &[
            "body",
            "head",
            "-",
            "right arm",
            "right arm end",
            "left arm",
            "right leg",
            "left leg",
        ],
    );
}

/// An ant that stands upright: four arms, two legs.
pub(crate) const ANT: [Row<'static>; 8] = [
    ("Body", "", [50.0, 40.0], [50.0, 90.0], 12.0),
    ("Head", "Body", [50.0, 90.0], [50.0, 115.0], 10.0),
    ("A1", "Body", [40.0, 80.0], [15.0, 70.0], 3.0),
    ("A2", "Body", [60.0, 80.0], [85.0, 70.0], 3.0),
    ("A3", "Body", [40.0, 60.0], [15.0, 50.0], 3.0),
    ("A4", "Body", [60.0, 60.0], [85.0, 50.0], 3.0),
    ("A5", "Body", [44.0, 40.0], [40.0, 0.0], 4.0),
    ("A6", "Body", [56.0, 40.0], [60.0, 0.0], 4.0),
];

#[test]
fn ant_with_four_arms() {
    check(
        &ANT,
        &[
            "body",
            "head",
            "right arm 1",
            "left arm 1",
            "right arm",
            "left arm",
            "right leg",
            "left leg",
        ],
    );
}

/// A dog that looks to the drawing's left, its far legs drawn first.
pub(crate) const DOG: [Row<'static>; 10] = [
    ("Leg1", "Body", [32.0, 40.0], [30.0, 0.0], 4.0),
    ("Leg2", "Body", [82.0, 40.0], [80.0, 0.0], 4.0),
    ("Tail", "Body", [90.0, 55.0], [110.0, 70.0], 2.0),
    ("Body", "", [60.0, 50.0], [30.0, 50.0], 15.0),
    ("Head", "Body", [25.0, 60.0], [5.0, 65.0], 10.0),
    ("Ear", "Head", [15.0, 70.0], [15.0, 80.0], 2.0),
    ("Leg3", "Body", [38.0, 40.0], [38.0, 20.0], 4.0),
    ("Paw3", "Leg3", [38.0, 20.0], [38.0, 0.0], 4.0),
    ("Leg4", "Body", [88.0, 40.0], [88.0, 20.0], 4.0),
    ("Shin4", "Leg4", [88.0, 20.0], [88.0, 0.0], 4.0),
];

#[test]
fn dog_in_profile() {
    check(
        &DOG,
        &[
            "right leg 1",
            "right leg",
            "tail",
            "body",
            "head",
            "-",
            "left leg 1",
            "left leg end 1",
            "left leg upper",
            "left leg lower",
        ],
    );
    // Turned around, the same legs are near, but right ones.
    let turned = DOG.map(|row| {
        (
            row.0,
            row.1,
            [-row.2[0], row.2[1]],
            [-row.3[0], row.3[1]],
            row.4,
        )
    });
    check(
        &turned,
        &[
            "left leg 1",
            "left leg",
            "tail",
            "body",
            "head",
            "-",
            "right leg 1",
            "right leg end 1",
            "right leg upper",
            "right leg lower",
        ],
    );
}

#[test]
fn dog_with_hind_and_fore_only() {
    check(
        &[
            ("Hind", "Body", [88.0, 40.0], [88.0, 0.0], 4.0),
            ("Fore", "Body", [32.0, 40.0], [32.0, 0.0], 4.0),
            ("Body", "", [60.0, 50.0], [30.0, 50.0], 15.0),
            ("Head", "Body", [25.0, 60.0], [5.0, 65.0], 10.0),
            ("U-1", "Body", [90.0, 55.0], [110.0, 70.0], 2.0),
        ],
        &["left leg", "left leg 1", "body", "head", "tail"],
    );
}

#[test]
fn bug_with_six_legs() {
    let leg = |name: &'static str, x: f64| (name, "Thorax", [x, 20.0], [x, 0.0], 1.0);
    check(
        &[
            leg("leg a", 20.0),
            leg("leg b", 40.0),
            leg("leg c", 60.0),
            ("Abdomen", "Thorax", [70.0, 25.0], [95.0, 25.0], 8.0),
            ("Thorax", "", [50.0, 25.0], [25.0, 25.0], 8.0),
            ("Head", "Thorax", [15.0, 25.0], [5.0, 25.0], 6.0),
            ("Antenna", "Head", [8.0, 30.0], [0.0, 45.0], 1.0),
            leg("leg d", 22.0),
            leg("leg e", 42.0),
            leg("leg f", 62.0),
        ],
        &[
            "right leg 2",
            "right leg 1",
            "right leg",
            "body",
            "body 1",
            "head",
            "-",
            "left leg 2",
            "left leg 1",
            "left leg",
        ],
    );
}

#[test]
fn names_of_sides() {
    let arms = [
        ("Rarm", Some(Side::Right)),
        ("R_Arm", Some(Side::Right)),
        ("RArm2", Some(Side::Right)),
        ("arm_r", Some(Side::Right)),
        ("armR", Some(Side::Right)),
        ("RARM", Some(Side::Right)),
        ("rightarm", Some(Side::Right)),
        ("みぎうで", Some(Side::Right)),
        ("ミギウデ", Some(Side::Right)),
        ("右腕", Some(Side::Right)),
        ("Larm", Some(Side::Left)),
        ("upperarm.L", Some(Side::Left)),
        ("Left Wing", Some(Side::Left)),
        ("左手首", Some(Side::Left)),
    ];
    for (name, side) in arms {
        let far = [95.0, 60.0];
        let label = &label_figure(&figure(&[
            ("Body", "", [50.0, 0.0], [50.0, 100.0], 10.0),
            ("Head", "Body", [50.0, 100.0], [50.0, 120.0], 10.0),
            (name, "Body", [60.0, 80.0], far, 2.0),
        ]))
        .raw[2];
        let label = label.as_ref().unwrap();
        assert_eq!((label.class, label.side), (Class::Arm, side), "{name}");
    }
}

#[test]
fn words_inside_other_words_mean_nothing() {
    for name in [
        "alarm",
        "Swarm",
        "charm",
        "legend",
        "slegs",
        "chip",
        "headline",
        "Tailor",
        "Rally",
        "もうてん",
        "armchairs",
    ] {
        let label = &label_figure(&figure(&[
            ("Body", "", [50.0, 0.0], [50.0, 100.0], 10.0),
            ("Head", "Body", [50.0, 100.0], [50.0, 120.0], 10.0),
            (name, "Body", [48.0, 60.0], [52.0, 60.0], 2.0),
        ]))
        .raw[2];
        assert_eq!(label, &None, "{name}");
    }
}

#[test]
fn a_shoulder_that_carries_an_arm_is_the_collar_bone() {
    check(
        &[
            ("Body", "", [50.0, 0.0], [50.0, 100.0], 10.0),
            ("RShoulder", "Body", [45.0, 90.0], [35.0, 90.0], 3.0),
            ("RArm", "RShoulder", [35.0, 90.0], [30.0, 70.0], 3.0),
            ("RForearm", "RArm", [30.0, 70.0], [28.0, 50.0], 3.0),
            ("RHand", "RForearm", [28.0, 50.0], [27.0, 45.0], 3.0),
            ("RThumb", "RHand", [28.0, 50.0], [30.0, 45.0], 1.0),
        ],
        &[
            "body",
            "right arm collar",
            "right arm upper",
            "right arm lower",
            "right arm end",
            "-",
        ],
    );
}

#[test]
fn a_dog_with_one_hind_leg_hidden() {
    check(
        &[
            ("Rleg", "Body", [84.0, 40.0], [84.0, 0.0], 4.0),
            ("a", "Body", [32.0, 40.0], [32.0, 0.0], 4.0),
            ("Body", "", [60.0, 50.0], [30.0, 50.0], 15.0),
            ("Head", "Body", [25.0, 60.0], [5.0, 65.0], 10.0),
            ("b", "Body", [36.0, 40.0], [36.0, 0.0], 4.0),
        ],
        &["right leg", "right leg 1", "body", "head", "left leg 1"],
    );
}

#[test]
fn an_octopus_walks_on_its_arms() {
    let classes = |word: &str, count: usize, extra: &[Row<'_>]| -> Vec<Class> {
        let names: Vec<String> = (1..=count).map(|i| format!("{word} {i}")).collect();
        let body = ("Body", "", [0.0, 40.0], [0.0, 90.0], 35.0);
        let limb = |(i, name)| {
            let x = 8.0 * (i as f64 - (count - 1) as f64 / 2.0);
            (name, "Body", [x, 40.0], [1.5 * x, 0.0], 2.0)
        };
        let limbs = names.iter().map(String::as_str).enumerate().map(limb);
        let rows: Vec<Row<'_>> = std::iter::once(body)
            .chain(limbs)
            .chain(extra.iter().copied())
            .collect();
        let labels = label_figure(&figure(&rows)).raw;
        let limbs = labels.iter().skip(1).take(count);
        limbs.map(|label| label.as_ref().unwrap().class).collect()
    };
    for word in ["Tentacle", "Arm", "触手"] {
        assert_eq!(classes(word, 8, &[]), [Class::Leg; 8], "{word}");
        // A jellyfish may have two beside its body, and what has legs stands on these.
        assert_eq!(classes(word, 2, &[]), [Class::Arm; 2], "{word}");
        let legs = [
            ("Left leg", "Body", [-4.0, 40.0], [-4.0, 0.0], 2.0),
            ("Right leg", "Body", [4.0, 40.0], [4.0, 0.0], 2.0),
        ];
        assert_eq!(classes(word, 8, &legs), [Class::Arm; 8], "{word}");
    }
}
