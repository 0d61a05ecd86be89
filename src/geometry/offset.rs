//! Outlines that are wider or narrower by the same distance everywhere.

use i_overlay::mesh::float::stroke::offset::StrokeOffset;
use i_overlay::mesh::float::style::{LineJoin, StrokeStyle};

use super::{FillRule, Outline, resolve_overlaps, subtract, union};

/// The angle between two points of a round corner, radians.
const ROUND: f64 = 0.3;

/// The outline moved outwards by a distance, user units, or inwards if that is negative. Corners that move apart become round.
pub(crate) fn offset(outline: &Outline, distance: f64) -> Outline {
    let rings = outline.rings();
    let rings = rings.map(|ring| ring.iter().map(|p| p.to_array()).collect());
    let rings: Vec<Vec<[f64; 2]>> = rings.collect();
    let style = StrokeStyle::new(2.0 * distance.abs()).line_join(LineJoin::Round(ROUND));
    let band = rings.stroke_as::<i64>(style, true);
    let band = band.into_iter().flatten();
    let band = band.map(|ring| ring.into_iter().map(Into::into).collect());
    let band = resolve_overlaps(band.collect(), FillRule::NonZero);
    if distance < 0.0 {
        subtract(outline, &band)
    } else {
        union(&[outline.clone(), band])
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec2;

    use super::*;
    use crate::geometry::{Ring, area, bounds, contains};

    /// A square of side 10 with a hole of side 4 in its middle.
    fn frame() -> Outline {
        let square = |half: f64| -> Ring {
            [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]]
                .map(|corner| DVec2::from(corner) * half)
                .to_vec()
        };
        let hole = square(2.0).into_iter().rev().collect();
        resolve_overlaps(vec![square(5.0), hole], FillRule::NonZero)
    }

    #[test]
    fn both_borders_move() {
        let frame = frame();
        assert_eq!(area(&frame), 84.0);
        let wider = offset(&frame, 1.0);
        // Round corners outside, sharp ones in the hole.
        let expected = 100.0 + 40.0 + PI - 4.0;
        assert!((area(&wider) - expected).abs() < 0.1, "{}", area(&wider));
        assert_eq!(bounds(&wider).unwrap().1.round(), DVec2::splat(6.0));
        let narrower = offset(&frame, -1.0);
        let expected = 64.0 - (16.0 + 16.0 + PI);
        let found = area(&narrower);
        assert!((found - expected).abs() < 0.1, "{found}");
        assert!(contains(&narrower, DVec2::new(3.5, 0.0)));
    }

    #[test]
    fn what_is_too_narrow_vanishes() {
        assert!(offset(&frame(), -2.2).polygons.is_empty());
        assert!(offset(&Outline::default(), 1.0).polygons.is_empty());
    }
}
