//! Animals that are drawn from above.

use super::figures::{Row, figure};
use crate::labels::figure::label_drawn;
use crate::labels::{Facing, Side};

/// A beetle from above, with its head in a direction, whose feet are as far ahead of their joints, or behind them, as given.
fn beetle(name: &'static str, up: f64, ahead: [f64; 3]) -> Vec<Row<'static>> {
    let mut rows = vec![
        (name, "", [0.0, -10.0 * up], [0.0, 10.0 * up], 7.0),
        ("Head", name, [0.0, 9.0 * up], [0.0, 15.0 * up], 3.0),
    ];
    let names = [["A", "B"], ["C", "D"], ["E", "F"]];
    for ((names, at), ahead) in names.into_iter().zip([-7.0, 0.0, 7.0]).zip(ahead) {
        for (name, side) in names.into_iter().zip([-1.0, 1.0]) {
            let tip = [side * 16.0, (at + ahead) * up];
            rows.push((name, rows[0].0, [side * 6.0, at * up], tip, 0.8));
        }
    }
    rows
}

#[test]
fn legs_that_spread_to_all_sides_are_seen_from_above() {
    let facing = |rows: &[Row<'_>]| {
        let mut figure = figure(rows);
        for part in figure.parts.iter_mut().skip(2) {
            part.name.insert_str(0, "Leg ");
        }
        let labeled = label_drawn(&figure);
        let sides = labeled.labels.iter().skip(2).flatten();
        let sides: Vec<_> = sides.map(|label| label.side.expect("a leg")).collect();
        (labeled.facing.facing, sides)
    };
    let spread = [-6.0, 0.0, 6.0];
    // Its left is drawn left if its head is drawn above, else right.
    let (above, sides) = facing(&beetle("Trunk", 1.0, spread));
    assert_eq!((above, sides[0]), (Facing::Up, Side::Left));
    let (below, sides) = facing(&beetle("Trunk", -1.0, spread));
    assert_eq!((below, sides[0]), (Facing::UpHeadDown, Side::Right));
    // What stands on all its feet is seen from the front, but a beetle whose feet are far apart is not.
    let standing = [-2.0, -9.0, -16.0];
    assert_eq!(facing(&beetle("Trunk", 1.0, standing)).0, Facing::Viewer);
    assert_eq!(facing(&beetle("Beetle", 1.0, standing)).0, Facing::Viewer);
    let level = [-1.0, -1.0, -1.0];
    assert_eq!(facing(&beetle("Trunk", 1.0, level)).0, Facing::Viewer);
    assert_eq!(facing(&beetle("Beetle", 1.0, level)).0, Facing::Up);
    // Eyes on its head are seen from above as well, but a face on the body is turned to us.
    for (on, height, expected) in [("Head", 12.0, Facing::Up), ("Trunk", 2.0, Facing::Viewer)] {
        let mut rows = beetle("Trunk", 1.0, spread);
        rows[1].4 = 5.0;
        if on == "Trunk" {
            rows.remove(1);
        }
        let legs = rows.len() - 6;
        rows.push(("Eye1", on, [-1.5, height], [-1.4, height], 0.6));
        rows.push(("Eye2", on, [1.4, height], [1.5, height], 0.6));
        let mut eyed = figure(&rows);
        for part in eyed.parts.iter_mut().skip(legs).take(6) {
            part.name.insert_str(0, "Leg ");
        }
        assert_eq!(label_drawn(&eyed).facing.facing, expected, "{on}");
    }
    // A string says it too, wherever the legs are.
    let mut said = figure(&beetle("Trunk", -1.0, standing));
    said.facing = Facing::from_word("up");
    assert_eq!(label_drawn(&said).facing.facing, Facing::UpHeadDown);
}
