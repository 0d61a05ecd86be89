//! Where figures look.

use glam::DVec2;
use proptest::prelude::*;

use super::figures::{Row, figure};
use crate::labels::figure::label_drawn;
use crate::labels::{Facing, Figure, FigurePart, FigurePartId};
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
        for detail in &mut part.details {
            detail.bounds = flipped(detail.bounds);
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
