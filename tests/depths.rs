//! How deep figures are that nobody gave a depth.

mod common;

use std::ops::Range;

use common::law;
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::MemoryResolver;
use okoshi::scene::Size;
use proptest::prelude::*;

/// The size of the model of a drawing with these elements.
fn size(elements: &str) -> Size {
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">{elements}</svg>"#
    );
    let compiled = common::compiled(&text, &MemoryResolver::default());
    let model = to_memory(&GLB, &compiled.scene, None).expect("a scene keeps its own rules");
    model.written.size.expect("a model")
}

fn ellipse(name: &str, [x, y]: [f64; 2], [across, up]: [f64; 2]) -> String {
    format!(r##"<ellipse id="{name}" cx="{x}" cy="{y}" rx="{across}" ry="{up}" fill="#c08060"/>"##)
}

/// A person from the front: a head above a body with two arms and two legs.
fn person([head, body, leg, foot]: [f64; 4]) -> String {
    let ground = 100.0 + 2.0 * body + 80.0;
    [
        ellipse(
            "Left leg",
            [200.0 + 0.5 * leg + 12.0, ground - 60.0],
            [leg, 70.0],
        ),
        ellipse(
            "Right leg",
            [200.0 - 0.5 * leg - 12.0, ground - 60.0],
            [leg, 70.0],
        ),
        ellipse("Left foot", [212.0 + leg, ground], [foot, 8.0]),
        ellipse("Right foot", [188.0 - leg, ground], [foot, 8.0]),
        ellipse("Body", [200.0, 100.0 + body], [0.8 * body, body]),
        ellipse("Left arm", [200.0 + body, 110.0 + body], [12.0, 40.0]),
        ellipse("Right arm", [200.0 - body, 110.0 + body], [12.0, 40.0]),
        ellipse("Head", [200.0, 110.0 - head], [head, head]),
        ellipse("Left eye", [200.0 + 0.3 * head, 110.0 - head], [4.0, 6.0]),
        ellipse("Right eye", [200.0 - 0.3 * head, 110.0 - head], [4.0, 6.0]),
        ellipse(
            "Nose",
            [200.0, 110.0 - 0.7 * head],
            [0.2 * head, 0.2 * head],
        ),
    ]
    .concat()
}

/// An animal that looks to the left: four legs under a body, a head before it.
fn animal([head, body, leg, length]: [f64; 4]) -> String {
    let below = 200.0 + body + 0.5 * leg;
    let left = 200.0 - length;
    [
        ellipse("Far front leg", [left + 25.0, below], [10.0, leg]),
        ellipse("Far hind leg", [380.0 - left, below], [10.0, leg]),
        ellipse("Tail", [400.0 - left, 190.0], [12.0, 30.0]),
        ellipse("Body", [200.0, 200.0], [length, body]),
        ellipse("Near front leg", [left + 35.0, below], [10.0, leg]),
        ellipse("Near hind leg", [370.0 - left, below], [10.0, leg]),
        ellipse("Head", [left, 190.0 - body], [1.3 * head, head]),
        ellipse(
            "Snout",
            [left - 1.3 * head, 190.0 - body],
            [0.5 * head, 0.4 * head],
        ),
        ellipse("Eye", [left - 0.3 * head, 185.0 - body], [4.0, 4.0]),
    ]
    .concat()
}

fn four(ranges: [Range<f64>; 4]) -> impl Strategy<Value = [f64; 4]> {
    let [a, b, c, d] = ranges;
    (a, b, c, d).prop_map(|(a, b, c, d)| [a, b, c, d])
}

/// Says that all parts are balloons, as deep as they are wide.
const BALLOONS: &str = r#"<text x="390" y="395">%Shape inflate</text>"#;

#[test]
fn people_are_at_most_three_fifths_as_deep_as_they_are_wide() {
    let sizes = four([20.0..90.0, 30.0..60.0, 10.0..20.0, 12.0..30.0]);
    law::check(law::config(48), 40, sizes, |sizes| {
        let elements = person(sizes);
        let Size { width, depth, .. } = size(&elements);
        prop_assert!(depth <= 0.6 * width, "{depth} deep, {width} wide");
        prop_assert!(depth >= 0.2 * width, "{depth} deep, {width} wide");
        // Strings take it back: a balloon is as deep as its string says.
        let given = size(&(elements + BALLOONS));
        Ok(given.depth > 0.6 * given.width)
    });
}

#[test]
fn animals_in_profile_are_at_most_half_as_deep_as_they_are_high() {
    let sizes = four([20.0..40.0, 30.0..70.0, 30.0..60.0, 60.0..120.0]);
    law::check(law::config(48), 40, sizes, |sizes| {
        let elements = animal(sizes);
        let Size { height, depth, .. } = size(&elements);
        prop_assert!(depth <= 0.5 * height, "{depth} deep, {height} high");
        prop_assert!(depth >= 0.2 * height, "{depth} deep, {height} high");
        let given = size(&(elements + BALLOONS));
        Ok(given.depth > 0.5 * given.height)
    });
}
