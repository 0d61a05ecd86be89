//! What arms hold.

use glam::DVec2;
use proptest::prelude::*;

use super::figures::figure;
use crate::labels::figure::label_drawn;
use crate::labels::{Figure, FigurePart, Label};
use crate::law;

/// A person with arms of one or two pieces, with hands or without.
fn person(two_pieces: bool, hands: bool) -> Figure {
    let mut rows = vec![
        ("Body", "", [50.0, 50.0], [50.0, 90.0], 12.0),
        ("Head", "Body", [50.0, 90.0], [50.0, 112.0], 9.0),
        ("Lleg", "Body", [56.0, 50.0], [58.0, 0.0], 4.0),
        ("Rleg", "Body", [44.0, 50.0], [42.0, 0.0], 4.0),
        ("Larm", "Body", [62.0, 86.0], [80.0, 56.0], 3.0),
    ];
    let holder = if two_pieces {
        rows.push(("Rupperarm", "Body", [38.0, 86.0], [29.0, 71.0], 3.0));
        rows.push(("Rforearm", "Rupperarm", [29.0, 71.0], [20.0, 56.0], 3.0));
        "Rforearm"
    } else {
        rows.push(("Rarm", "Body", [38.0, 86.0], [20.0, 56.0], 3.0));
        "Rarm"
    };
    if hands {
        rows.push(("Rhand", holder, [20.0, 56.0], [18.0, 52.0], 2.5));
    }
    figure(&rows)
}

/// The same with something in the right hand: how long it is, in lengths of the arm, how far it is turned from the arm, in degrees,
/// and which share of it lies behind the hand.
fn holding(person: &Figure, name: &str, length: f64, angle: f64, behind: f64) -> Figure {
    let mut figure = person.clone();
    let holder = figure.parts.last_key().expect("an arm");
    let at = figure.parts[holder].tip;
    let arm = DVec2::new(-18.0, -30.0);
    let way = DVec2::from_angle(angle.to_radians()).rotate(arm) * length;
    let [near, far] = [at - way * behind, at + way * (1.0 - behind)];
    figure.parts.push(FigurePart {
        name: name.to_owned(),
        parent: Some(holder),
        joint: if behind > 0.3 { at } else { near },
        tip: far,
        near_end: Some(near),
        width: 1.5,
        bounds: [near.min(far) - 0.75, near.max(far) + 0.75],
        drawing_order: usize::from(holder) + 1,
        ..FigurePart::default()
    });
    figure
}

fn labels(figure: &Figure) -> Vec<Option<Label>> {
    label_drawn(figure).labels.raw
}

#[test]
fn what_a_hand_holds_is_no_piece_of_the_arm_and_changes_no_label() {
    let shapes = (
        any::<bool>(),
        any::<bool>(),
        0.3..2.5_f64,
        -180.0..180.0_f64,
        0.0..0.5_f64,
        prop::sample::select(vec!["Broom", "pan", "U-7", "Besen", "旗"]),
    );
    // In the others the thing is short and goes on where the arm ends: it may be a hand.
    law::check(
        law::config(512),
        60,
        shapes,
        |(two, hands, length, angle, behind, name)| {
            let person = person(two, hands);
            let with = holding(&person, name, length, angle, behind);
            let labeled = label_drawn(&with);
            let aside = angle.abs().min(180.0 - angle.abs());
            // Half of arm and hand together.
            let is_held = length > 0.57 || aside > 41.0;
            let why = labeled.held.raw.last().cloned().flatten();
            if is_held {
                prop_assert!(why.is_some_and(|why| why.starts_with("held by `")));
                prop_assert_eq!(labeled.labels.raw.last(), Some(&None));
                let without = labels(&person);
                prop_assert_eq!(&labeled.labels.raw[..without.len()], &without[..]);
            }
            Ok(is_held)
        },
    );
}

#[test]
fn pieces_of_an_arm_are_not_held() {
    let upper = {
        let mut figure = person(false, false);
        let arm = figure.parts.last_mut().expect("an arm");
        arm.name = "Rupperarm".to_owned();
        figure
    };
    // What an upper arm carries is the forearm, however long and wherever it points.
    for (length, angle) in [(1.0, 0.0), (0.9, 80.0)] {
        let figure = holding(&upper, "x", length, angle, 0.0);
        let labels = labels(&figure);
        let last = labels.last().and_then(Option::as_ref).map(Label::describe);
        assert_eq!(last.as_deref(), Some("right arm, lower"));
    }
    // So is what is as wide as an arm by its name, and begins where that ends.
    let mut figure = holding(&person(false, false), "Rfore", 0.9, 80.0, 0.0);
    figure.parts.last_mut().expect("a forearm").width = 5.0;
    let last = labels(&figure).pop().flatten();
    assert_eq!(
        last.as_ref().map(Label::describe).as_deref(),
        Some("right arm, lower")
    );
    // A name says so too, and so does a short thing that goes on where the arm ends.
    for (name, length, angle) in [
        ("Forearm", 1.0, 60.0),
        ("Hand", 0.7, 70.0),
        ("x", 0.3, 10.0),
    ] {
        let figure = holding(&person(false, false), name, length, angle, 0.0);
        let labeled = label_drawn(&figure);
        assert_eq!(labeled.held.raw.last(), Some(&None), "{name}");
        assert!(
            labeled.labels.raw.last().is_some_and(Option::is_some),
            "{name}"
        );
    }
}

#[test]
fn the_reason_says_what_shows_it() {
    let cases = [
        (
            1.5,
            0.0,
            0.45,
            "held by `Rhand`: `Broom` reaches beyond the hand at both sides",
        ),
        (
            0.8,
            10.0,
            0.0,
            "held by `Rhand`: `Broom` is longer than half the arm",
        ),
        (
            0.4,
            60.0,
            0.0,
            "held by `Rhand`: `Broom` points 60° away from the arm",
        ),
    ];
    for (length, angle, behind, why) in cases {
        let figure = holding(&person(true, true), "Broom", length, angle, behind);
        let labeled = label_drawn(&figure);
        let found = labeled.held.raw.last().and_then(Option::as_deref);
        assert_eq!(found, Some(why));
    }
}
