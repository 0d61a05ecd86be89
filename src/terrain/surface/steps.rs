//! Heights in steps, so that the corners of faces have whole coordinates although plates are thinner than a tile.
//!
//! Even steps are whole tiles; the odd step below each is the underside of a plate. A tile therefore has two steps of unequal height.

/// How thick ground and water are that have nothing below them, in tiles.
const THICKNESS: f64 = 0.25;

/// The step of a height in whole tiles.
pub(super) fn step(height: i32) -> i32 {
    2 * height
}

/// The step of the underside of a plate whose top is at a height in whole tiles.
pub(super) fn underside(height: i32) -> i32 {
    2 * height - 1
}

/// The height of a step, in tiles.
pub(super) fn height(step: i32) -> f64 {
    let above = f64::from((step + 1).div_euclid(2));
    if step % 2 == 0 {
        above
    } else {
        above - THICKNESS
    }
}

/// The whole heights that enclose a range of steps.
pub(super) fn tiles([bottom, top]: [i32; 2]) -> [i32; 2] {
    [bottom.div_euclid(2), (top + 1).div_euclid(2)]
}

/// A point in tiles, whose y was in steps.
pub(super) fn place([x, y, z]: [i32; 3]) -> [f64; 3] {
    [f64::from(x), height(y), f64::from(z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_rise_and_tiles_enclose_them() {
        for whole in -3..=3 {
            assert_eq!(height(step(whole)), f64::from(whole));
            assert_eq!(height(underside(whole)), f64::from(whole) - THICKNESS);
            assert_eq!(tiles([underside(whole), step(whole)]), [whole - 1, whole]);
            assert_eq!(
                tiles([step(whole - 1), underside(whole)]),
                [whole - 1, whole]
            );
            assert_eq!(tiles([step(whole), step(whole + 1)]), [whole, whole + 1]);
        }
        assert!((-9..9).all(|at| height(at) < height(at + 1)));
    }
}
