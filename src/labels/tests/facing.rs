//! Where figures look.

use glam::DVec2;
use proptest::prelude::*;

use super::figures::{Row, figure};
use crate::labels::figure::label_drawn;
use crate::labels::{Detail, Facing, Figure, FigurePart, FigurePartId};
use crate::law;

/// Figures traced from emoji of the Fluent and Noto sets.
fn traced() -> Vec<(&'static str, Facing, &'static [Row<'static>])> {
    vec![
        (
            "dog",
            Facing::Left,
            &[
                ("Tail", "Body", [27.0, 17.0], [27.0, 25.0], 1.00),
                ("Leg1", "Body", [14.0, 11.0], [15.0, 2.0], 1.50),
                ("Leg2", "Body", [21.0, 11.0], [19.0, 2.0], 1.50),
                ("Body", "", [8.0, 15.0], [28.0, 15.0], 6.00),
                ("Leg3", "Body", [9.0, 11.0], [7.0, 5.0], 1.50),
                ("Leg4", "Body", [25.0, 11.0], [28.0, 2.0], 1.50),
                ("Head", "Body", [3.0, 22.0], [15.0, 22.0], 4.00),
                ("Ear", "Head", [11.0, 25.0], [12.0, 20.0], 1.50),
                ("Eye", "Head", [7.5, 20.3], [7.5, 21.7], 0.50),
                ("Nose", "Head", [1.8, 20.3], [4.2, 20.3], 0.80),
            ],
        ),
        (
            "pig",
            Facing::Left,
            &[
                ("Leg1", "Body", [15.0, 8.0], [17.0, 2.0], 1.00),
                ("Leg2", "Body", [22.0, 8.0], [21.0, 2.0], 1.00),
                ("Body", "", [4.0, 14.0], [30.0, 14.0], 8.50),
                ("Leg3", "Body", [11.0, 8.0], [12.0, 2.0], 1.00),
                ("Leg4", "Body", [26.0, 8.0], [28.0, 2.0], 1.00),
                ("Head", "Body", [7.0, 10.0], [7.0, 22.0], 5.00),
                ("Snout", "Head", [3.0, 11.0], [3.0, 17.0], 1.20),
                ("Eye", "Head", [7.5, 14.1], [7.5, 15.9], 0.50),
            ],
        ),
        (
            "rooster",
            Facing::Left,
            &[
                ("Tail", "Body", [19.0, 21.0], [31.0, 21.0], 6.00),
                ("Body", "", [5.0, 15.0], [27.0, 15.0], 9.00),
                ("Leg1", "Body", [13.0, 7.0], [12.5, 2.0], 0.75),
                ("Leg2", "Body", [18.0, 7.0], [17.5, 2.0], 0.75),
                ("Foot1", "Leg1", [11.0, 2.5], [16.0, 2.5], 0.50),
                ("Foot2", "Leg2", [16.5, 2.5], [21.0, 2.5], 0.50),
                ("Head", "Body", [8.0, 18.0], [8.0, 30.0], 4.00),
                ("Eye", "Head", [6.3, 24.3], [7.7, 24.3], 0.70),
                ("Beak", "Head", [6.0, 24.0], [3.0, 23.0], 1.00),
                ("Wing", "Body", [24.0, 14.0], [15.0, 12.0], 3.00),
            ],
        ),
        (
            "flamingo",
            Facing::Left,
            &[
                ("Leg1", "Body", [16.0, 13.0], [16.0, 3.0], 0.75),
                ("Leg2", "Body", [20.0, 13.0], [12.0, 8.0], 0.75),
                ("Body", "", [5.0, 18.0], [27.0, 18.0], 5.50),
                ("Wing", "Body", [25.0, 15.0], [15.0, 19.0], 3.50),
                ("Neck", "Body", [8.0, 16.0], [12.0, 25.0], 1.75),
                ("Head", "Neck", [8.0, 27.5], [14.0, 27.5], 3.00),
                ("Beak", "Head", [9.0, 28.0], [6.0, 27.0], 1.00),
                ("Eye", "Head", [11.0, 28.6], [12.0, 28.6], 0.50),
            ],
        ),
        (
            "person-walking-facing-right",
            Facing::Right,
            &[
                ("Leg1", "Body", [13.0, 15.0], [9.0, 4.0], 1.50),
                ("Shoe1", "Leg1", [8.0, 5.0], [11.0, 2.5], 1.25),
                ("Arm1", "Body", [18.0, 20.0], [23.0, 14.0], 1.00),
                ("Body", "", [16.0, 23.0], [16.0, 14.0], 2.50),
                ("Leg2", "Body", [17.0, 15.0], [20.0, 3.0], 1.50),
                ("Shoe2", "Leg2", [20.0, 2.5], [24.0, 3.0], 1.00),
                ("Arm2", "Body", [14.0, 20.0], [10.0, 14.0], 1.00),
                ("Neck", "Body", [17.0, 22.0], [17.0, 24.0], 1.00),
                ("Head", "Neck", [17.0, 22.5], [17.0, 29.5], 3.00),
                ("Eye", "Head", [19.0, 25.6], [19.0, 26.4], 0.30),
            ],
        ),
        (
            "fairy",
            Facing::Viewer,
            &[
                ("Wing1", "Body", [13.0, 19.0], [3.0, 24.0], 3.00),
                ("Wing2", "Body", [19.0, 19.0], [29.0, 23.0], 3.00),
                ("Leg1", "Body", [14.0, 12.0], [12.0, 1.0], 1.25),
                ("Leg2", "Body", [18.0, 12.0], [16.0, 6.0], 1.50),
                ("Body", "", [16.0, 12.0], [16.0, 24.0], 4.00),
                ("Arm1", "Body", [13.0, 20.0], [5.0, 14.0], 1.00),
                ("Arm2", "Body", [19.0, 21.0], [26.0, 20.0], 1.00),
                ("Head", "Body", [12.0, 26.0], [20.0, 26.0], 4.00),
                ("Eye1", "Head", [14.3, 25.0], [14.3, 26.0], 0.40),
                ("Eye2", "Head", [17.7, 25.0], [17.7, 26.0], 0.40),
                ("Wand", "Arm2", [25.0, 16.0], [27.5, 26.0], 0.30),
            ],
        ),
        (
            "person-standing",
            Facing::Viewer,
            &[
                ("Leg1", "Body", [14.5, 15.0], [14.0, 3.0], 1.00),
                ("Leg2", "Body", [17.5, 15.0], [18.0, 3.0], 1.00),
                ("Body", "", [16.0, 23.0], [16.0, 15.0], 3.00),
                ("Arm1", "Body", [12.7, 21.0], [11.7, 12.0], 0.80),
                ("Arm2", "Body", [19.3, 21.0], [20.3, 12.0], 0.80),
                ("Head", "Body", [16.0, 23.3], [16.0, 29.7], 2.70),
                ("Eye1", "Head", [14.7, 26.7], [15.3, 26.7], 0.30),
                ("Eye2", "Head", [16.7, 26.7], [17.3, 26.7], 0.30),
                ("Shoe1", "Leg1", [14.5, 2.5], [12.0, 2.5], 0.50),
                ("Shoe2", "Leg2", [17.5, 2.5], [20.0, 2.5], 0.50),
            ],
        ),
        (
            "crab",
            Facing::Viewer,
            &[
                ("Arm1", "Body", [8.0, 17.0], [11.0, 25.0], 2.00),
                ("Arm2", "Body", [24.0, 17.0], [21.0, 25.0], 2.00),
                ("Leg1", "Body", [8.0, 13.0], [4.0, 17.0], 1.00),
                ("Leg2", "Body", [24.0, 13.0], [28.0, 17.0], 1.00),
                ("Leg3", "Body", [8.0, 11.0], [2.0, 11.0], 1.00),
                ("Leg4", "Body", [24.0, 11.0], [30.0, 11.0], 1.00),
                ("Leg5", "Body", [9.0, 8.0], [6.0, 4.0], 1.00),
                ("Leg6", "Body", [23.0, 8.0], [26.0, 4.0], 1.00),
                ("Leg7", "Body", [12.0, 6.0], [12.0, 3.0], 1.00),
                ("Leg8", "Body", [20.0, 6.0], [20.0, 3.0], 1.00),
                ("Body", "", [7.0, 12.0], [25.0, 12.0], 7.00),
                ("Eye1", "Body", [12.0, 19.0], [14.0, 19.0], 1.00),
                ("Eye2", "Body", [18.0, 19.0], [20.0, 19.0], 1.00),
            ],
        ),
    ]
}

#[test]
fn animals_in_profile_and_people_look_where_they_are_drawn_to() {
    for (name, facing, rows) in traced() {
        let found = label_drawn(&figure(rows)).facing;
        assert_eq!(found.facing, facing, "{name}: {found:?}");
        assert!(!found.by_string);
    }
}

#[test]
fn strings_say_it_against_all_votes() {
    for (name, found, rows) in traced() {
        for said in [Facing::Viewer, Facing::Left, Facing::Right, Facing::Away] {
            let figure = Figure {
                facing: Some(said),
                ..figure(rows)
            };
            let labeled = label_drawn(&figure);
            assert_eq!(labeled.facing.facing, said, "{name}");
            assert!(labeled.facing.by_string);
            // What is drawn left is the right side of a figure that faces us, and the left one of one that turns its back to us.
            let sides = |figure: &Figure| {
                let labels = label_drawn(figure).labels;
                let sides = labels.iter().flatten().map(|label| label.side);
                sides.collect::<Vec<_>>()
            };
            if (said, found) == (Facing::Away, Facing::Viewer) {
                let front = Figure {
                    facing: Some(Facing::Viewer),
                    ..figure.clone()
                };
                let swapped = sides(&front).into_iter().map(|side| Some(side?.other()));
                assert_eq!(sides(&figure), swapped.collect::<Vec<_>>(), "{name}");
            }
        }
    }
}

/// A figure in its mirror image.
fn mirrored(figure: &Figure) -> Figure {
    let flip = |point: DVec2| DVec2::new(-point.x, point.y);
    let flipped =
        |[low, high]: [DVec2; 2]| [DVec2::new(-high.x, low.y), DVec2::new(-low.x, high.y)];
    let mut figure = figure.clone();
    for part in &mut figure.parts {
        part.joint = flip(part.joint);
        part.tip = flip(part.tip);
        part.bounds = flipped(part.bounds);
        part.main_shape = flipped(part.main_shape);
        for piece in &mut part.pieces {
            *piece = flipped(*piece);
        }
        for detail in &mut part.details {
            detail.bounds = flipped(detail.bounds);
            for piece in &mut detail.pieces {
                *piece = flipped(*piece);
            }
        }
    }
    figure
}

fn animal() -> impl Strategy<Value = Figure> {
    // On a grid, so that sums are exact.
    let place = || (-40..40_i32).prop_map(|at| f64::from(at) / 4.0);
    let size = || (1..24_i32).prop_map(|size| f64::from(size) / 4.0);
    let names = [
        "Body",
        "Head",
        "Leg",
        "Front leg",
        "Hind leg",
        "Arm",
        "Tail",
        "Eye",
        "Beak",
        "Neck",
        "Paw",
        "Horn",
        "Ear",
        "Far leg",
    ];
    let part = (
        prop::sample::select(names.to_vec()),
        any::<prop::sample::Index>(),
        [place(), place()],
        [place(), place()],
        size(),
    );
    prop::collection::vec(part, 2..14).prop_map(|parts| {
        let parts = parts.into_iter().enumerate();
        let parts = parts.map(|(index, (name, parent, joint, tip, half))| {
            let [joint, tip] = [joint, tip].map(DVec2::from_array);
            let bounds = [joint.min(tip) - half, joint.max(tip) + half];
            FigurePart {
                name: name.to_owned(),
                parent: (index > 0).then(|| FigurePartId::from(parent.index(index))),
                joint,
                tip,
                bounds,
                main_shape: bounds,
                drawing_order: index,
                ..FigurePart::default()
            }
        });
        Figure {
            parts: parts.collect(),
            facing: None,
        }
    })
}

#[test]
fn a_mirrored_figure_looks_the_other_way() {
    // A third of them look to a side.
    law::check(law::config(512), 20, animal(), |figure| {
        let [one, other] = [&figure, &mirrored(&figure)].map(|figure| label_drawn(figure).facing);
        let expected = match one.facing {
            Facing::Left => Facing::Right,
            Facing::Right => Facing::Left,
            same => same,
        };
        prop_assert_eq!(other.facing, expected, "{:?} {:?}", one, other);
        Ok(one.facing.is_profile())
    });
}

/// A box from its middle and its size.
fn around(x: f64, y: f64, width: f64, height: f64) -> [DVec2; 2] {
    let half = DVec2::new(width, height) / 2.0;
    [DVec2::new(x, y) - half, DVec2::new(x, y) + half]
}

/// A part: its name, what it hangs on, and the boxes of the pieces of its shape.
type Drawn<'a> = (&'a str, &'a str, &'a [[DVec2; 2]]);

/// A figure of shapes that were drawn in this order, the first of which carries the others.
fn drawn(rows: &[Drawn<'_>]) -> Figure {
    let parts = rows
        .iter()
        .enumerate()
        .map(|(order, (name, parent, pieces))| {
            let low = pieces.iter().map(|piece| piece[0]).reduce(DVec2::min);
            let high = pieces.iter().map(|piece| piece[1]).reduce(DVec2::max);
            let bounds = [low.unwrap_or_default(), high.unwrap_or_default()];
            let middle = bounds[0].midpoint(bounds[1]);
            FigurePart {
                name: (*name).to_owned(),
                parent: rows
                    .iter()
                    .position(|row| row.0 == *parent)
                    .map(FigurePartId::from),
                joint: DVec2::new(middle.x, bounds[1].y),
                tip: DVec2::new(middle.x, bounds[0].y),
                bounds,
                main_shape: bounds,
                pieces: if pieces.len() > 1 {
                    pieces.to_vec()
                } else {
                    Vec::new()
                },
                drawing_order: order,
                ..FigurePart::default()
            }
        });
    Figure {
        parts: parts.collect(),
        facing: None,
    }
}

/// Checks where a figure and its mirror image look, and that these words are among the reasons.
fn check_drawn(rows: &[Drawn<'_>], facing: Facing, reason: &str) {
    let figure = drawn(rows);
    let other = match facing {
        Facing::Left => Facing::Right,
        Facing::Right => Facing::Left,
        same => same,
    };
    for (figure, expected) in [(figure.clone(), facing), (mirrored(&figure), other)] {
        let found = label_drawn(&figure).facing;
        assert_eq!(found.facing, expected, "{found:?}");
        let says = |why: &String| why.contains(reason);
        assert!(found.reasons.iter().any(says), "{found:?}");
    }
}

#[test]
fn an_eye_far_from_the_middle_of_a_body_without_a_head_looks_to_its_side() {
    let body = [around(0.0, 0.0, 20.0, 12.0)];
    let eye = [around(-7.0, 4.0, 1.0, 1.0)];
    let rows: [Drawn<'_>; 2] = [("Body", "", &body), ("Eye", "Body", &eye)];
    check_drawn(&rows, Facing::Left, "its eye lies");
    // A cyclops, and a monster with both eyes in one shape at a side of it.
    let middle = [around(0.5, 4.0, 1.0, 1.0)];
    let rows: [Drawn<'_>; 2] = [("Body", "", &body), ("Eye", "Body", &middle)];
    check_drawn(&rows, Facing::Viewer, "nothing shows a profile");
    let both = [around(-8.0, 4.0, 1.0, 1.0), around(-5.0, 4.0, 1.0, 1.0)];
    let rows: [Drawn<'_>; 2] = [("Body", "", &body), ("Eyes", "Body", &both)];
    check_drawn(&rows, Facing::Viewer, "two eyes");
}

#[test]
fn what_leaves_a_body_on_one_side_is_a_beak_or_a_horn() {
    let body = [around(0.0, 0.0, 20.0, 12.0)];
    for (name, reason) in [
        ("Beak", "its nose leaves the body's outline"),
        ("Snout", "its nose leaves the body's outline"),
        ("Trunk", "its nose leaves the body's outline"),
        ("くちばし", "its nose leaves the body's outline"),
        ("Horn", "its horn leaves the body's outline"),
        ("角", "its horn leaves the body's outline"),
    ] {
        let beyond = [around(11.0, 3.0, 4.0, 1.0)];
        let rows: [Drawn<'_>; 2] = [("Body", "", &body), (name, "Body", &beyond)];
        check_drawn(&rows, Facing::Right, reason);
    }
    // A cow from the front.
    let horns = [around(-11.0, 3.0, 4.0, 1.0), around(11.0, 3.0, 4.0, 1.0)];
    let rows: [Drawn<'_>; 2] = [("Body", "", &body), ("Horns", "Body", &horns)];
    check_drawn(&rows, Facing::Viewer, "nothing shows a profile");
}

#[test]
fn far_and_near_say_a_profile_and_the_face_which() {
    let body = [around(0.0, 0.0, 10.0, 12.0)];
    let legs = [around(0.0, -8.0, 2.0, 5.0)];
    // Too near the middle to tell a profile on its own.
    let eye = [around(1.0, 4.0, 1.0, 1.0)];
    for far in ["Far leg", "Near leg", "奥の足", "手前の足"] {
        let rows: [Drawn<'_>; 3] = [
            ("Body", "", &body),
            (far, "Body", &legs),
            ("Eye", "Body", &eye),
        ];
        check_drawn(&rows, Facing::Right, "its far and on its near side");
    }
    let rows: [Drawn<'_>; 3] = [
        ("Body", "", &body),
        ("Leg", "Body", &legs),
        ("Eye", "Body", &eye),
    ];
    check_drawn(&rows, Facing::Viewer, "nothing shows a profile");
}

#[test]
fn a_head_with_patches_of_the_body_is_where_its_face_is() {
    let body = [around(0.0, 0.0, 20.0, 12.0)];
    let legs = [around(-6.0, -8.0, 2.0, 5.0), around(6.0, -8.0, 2.0, 5.0)];
    // The middle of the head with its patches is right of the body's middle.
    let head = [
        around(-11.0, 6.0, 6.0, 5.0),
        around(0.0, 0.0, 5.0, 5.0),
        around(12.0, -4.0, 5.0, 5.0),
    ];
    let eye = [around(-11.5, 7.0, 1.0, 1.0)];
    let rows: [Drawn<'_>; 4] = [
        ("Far legs", "Body", &legs),
        ("Body", "", &body),
        ("Head", "Body", &head),
        ("Eye", "Head", &eye),
    ];
    check_drawn(&rows, Facing::Left, "its head lies");
}

#[test]
fn legs_in_one_shape_stand_in_a_row_under_a_long_body() {
    let body = [around(0.0, 0.0, 20.0, 8.0)];
    let legs = [-7.0, -5.0, 5.0, 7.0].map(|x| around(x, -6.0, 1.0, 5.0));
    let head = [around(-12.0, 4.0, 5.0, 5.0)];
    let rows: [Drawn<'_>; 3] = [
        ("Body", "", &body),
        ("Legs", "Body", &legs),
        ("Head", "Body", &head),
    ];
    check_drawn(&rows, Facing::Left, "its legs stand in a row");
}

/// A dancer: legs and arms overlap, and the feet point one way. The face has these pieces.
fn dancer(face: &[Detail]) -> Figure {
    let piece = |x: f64, y: f64, width: f64, height: f64| [around(x, y, width, height)];
    let mut figure = drawn(&[
        ("Body", "", &piece(0.0, 0.0, 6.0, 10.0)),
        ("Left arm", "Body", &piece(1.0, 2.0, 6.0, 2.0)),
        ("Right arm", "Body", &piece(0.5, 3.0, 6.0, 2.0)),
        ("Left leg", "Body", &piece(0.4, -8.0, 3.0, 8.0)),
        ("Right leg", "Body", &piece(0.0, -8.0, 3.0, 8.0)),
        ("Left foot", "Left leg", &piece(1.5, -12.0, 4.0, 1.0)),
        ("Right foot", "Right leg", &piece(1.2, -12.0, 4.0, 1.0)),
        ("Head", "Body", &piece(0.0, 8.0, 6.0, 6.0)),
    ]);
    let head = figure.parts.last_mut().expect("a head");
    head.details = face.to_vec();
    figure
}

#[test]
fn a_symmetric_face_outvotes_legs_and_arms_that_overlap() {
    let detail = |pieces: &[[DVec2; 2]], color: [u8; 3]| {
        let low = pieces.iter().map(|piece| piece[0]).reduce(DVec2::min);
        let high = pieces.iter().map(|piece| piece[1]).reduce(DVec2::max);
        Detail {
            name: String::new(),
            bounds: [low.unwrap_or_default(), high.unwrap_or_default()],
            pieces: if pieces.len() > 1 {
                pieces.to_vec()
            } else {
                Vec::new()
            },
            color,
        }
    };
    let dark = [40, 20, 10];
    let one_eye = detail(&[around(1.5, 8.5, 0.8, 1.0)], dark);
    let found = label_drawn(&dancer(std::slice::from_ref(&one_eye))).facing;
    assert_eq!(found.facing, Facing::Right, "{found:?}");
    assert!(!found.shows_two_eyes);

    let eyes = detail(
        &[around(-1.5, 8.5, 0.8, 1.0), around(1.5, 8.5, 0.8, 1.0)],
        dark,
    );
    let mouth = detail(&[around(0.0, 6.5, 2.0, 0.5)], [200, 60, 60]);
    let found = label_drawn(&dancer(&[eyes, mouth])).facing;
    assert_eq!(found.facing, Facing::Viewer, "{found:?}");
    assert!(found.shows_two_eyes);
    let says = |why: &String| why.contains("half of its face mirror each other");
    assert!(found.reasons.iter().any(says), "{found:?}");
}

#[test]
fn ears_on_both_sides_of_the_head_speak_for_the_front() {
    let piece = |x: f64, y: f64, width: f64, height: f64| [around(x, y, width, height)];
    let ears = [around(-3.0, 11.0, 1.0, 2.0), around(3.0, 11.0, 1.0, 2.0)];
    let rows: [Drawn<'_>; 5] = [
        ("Body", "", &piece(0.0, 0.0, 6.0, 10.0)),
        ("Leg1", "Body", &piece(0.0, -8.0, 3.0, 8.0)),
        ("Leg2", "Body", &piece(0.4, -8.0, 3.0, 8.0)),
        ("Head", "Body", &piece(0.0, 8.0, 6.0, 6.0)),
        ("Ears", "Head", &ears),
    ];
    check_drawn(&rows, Facing::Viewer, "its ears lie on both sides");
}

#[test]
fn wheels_in_a_row_are_a_vehicle_from_its_side() {
    let body = [around(0.0, 0.0, 20.0, 8.0)];
    let wheels = [-6.0, 6.0].map(|x| around(x, -5.0, 4.0, 4.0));
    let light = [around(9.0, 0.0, 1.0, 1.0)];
    let both = [around(-8.0, 0.0, 1.0, 1.0), around(8.0, 0.0, 1.0, 1.0)];
    let row = "its wheels stand in a row";
    for name in [
        "Headlight",
        "ヘッドライト",
        "Driver",
        "Hood",
        "Front bumper",
    ] {
        let rows: [Drawn<'_>; 3] = [
            ("Car", "", &body),
            ("Wheels", "Car", &wheels),
            (name, "Car", &light),
        ];
        check_drawn(&rows, Facing::Right, row);
        let found = label_drawn(&drawn(&rows));
        assert!(found.facing.is_vehicle);
        // Neither is a wheel a leg, nor a light an arm.
        assert!(
            found
                .labels
                .iter()
                .flatten()
                .all(|label| !label.class.is_limb())
        );
    }
    for name in ["Taillight", "Trailer", "Exhaust"] {
        let rows: [Drawn<'_>; 3] = [
            ("Car", "", &body),
            ("Wheels", "Car", &wheels),
            (name, "Car", &light),
        ];
        check_drawn(&rows, Facing::Left, row);
    }
    let [rear, front] = wheels.map(|wheel| [wheel]);
    let rows: [Drawn<'_>; 3] = [
        ("Car", "", &body),
        ("Rear wheel", "Car", &rear),
        ("Front wheel", "Car", &front),
    ];
    check_drawn(&rows, Facing::Right, row);
    // Most drawings of vehicles look left.
    let rows: [Drawn<'_>; 2] = [("Car", "", &body), ("タイヤ", "Car", &wheels)];
    assert_eq!(label_drawn(&drawn(&rows)).facing.facing, Facing::Left);
    // From the front wheels are narrow, and there are two headlights.
    let narrow = [-8.0, 8.0].map(|x| around(x, -5.0, 1.5, 4.0));
    let rows: [Drawn<'_>; 2] = [("Car", "", &body), ("Wheels", "Car", &narrow)];
    assert!(!label_drawn(&drawn(&rows)).facing.is_vehicle);
    let rows: [Drawn<'_>; 3] = [
        ("Car", "", &body),
        ("Wheels", "Car", &wheels),
        ("Headlights", "Car", &both),
    ];
    check_drawn(&rows, Facing::Viewer, "a light on either side");
}

#[test]
fn wheels_that_touch_are_in_a_row_too() {
    let lorry = [around(0.0, 0.0, 28.0, 18.0)];
    // Two of three in one piece.
    let wheels = [around(-8.5, -9.5, 7.0, 7.0), around(5.0, -9.5, 14.0, 7.0)];
    let cab = [around(-12.0, 0.0, 4.0, 8.0)];
    let rows: [Drawn<'_>; 3] = [
        ("Box", "", &lorry),
        ("Wheels", "Box", &wheels),
        ("Cab", "Box", &cab),
    ];
    check_drawn(&rows, Facing::Left, "its wheels stand in a row");
}
