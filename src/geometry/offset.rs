//! Outlines that are wider or narrower by the same distance everywhere.

use glam::DVec2;
use i_overlay::mesh::float::stroke::offset::StrokeOffset;
use i_overlay::mesh::float::style::{LineJoin, StrokeStyle};

use super::tangled::pixels;
use super::{
    FillRule, Outline, bounds, edges, pixel_borders, resolve_overlaps, squared_distances, subtract,
    union,
};

/// The angle between two points of a round corner, radians.
const ROUND: f64 = 0.3;
/// Outlines with more points are moved in a picture: the bands along their borders may lie over one another everywhere.
const MANY: usize = 4096;
/// The same goes for outlines with more points than this …
const SEVERAL: usize = 512;
/// … if the bands along their borders cover the box around them more often than this, on average: spirals, combs, tangles.
const DENSE: f64 = 3.0;
/// Pixels along the longer side of the picture.
const SIDE: f64 = 1024.0;
/// How many pixels the nearest pixel beyond a border is away from it.
const BEYOND: f64 = 0.25;

/// The outline moved outwards by a distance, user units, or inwards if that is negative. Corners that move apart become round.
///
/// The result is exact to within a pixel of a picture of 1,024 along the longer side if the outline has more than 4,096 points, or more than
/// 512 whose bands lie over one another.
pub(crate) fn offset(outline: &Outline, distance: f64) -> Outline {
    let count = outline.point_count();
    if count > MANY || count > SEVERAL && is_dense(outline, distance) {
        return offset_in_picture(outline, distance).unwrap_or_default();
    }
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

/// Whether the bands of this half width along the borders lie over one another many times.
fn is_dense(outline: &Outline, distance: f64) -> bool {
    let half = distance.abs();
    let lengths = edges(outline).map(|[from, to]| from.distance(to) + 2.0 * half);
    let covered = lengths.sum::<f64>() * 2.0 * half;
    bounds(outline)
        .is_some_and(|(low, high)| covered > DENSE * (high - low + 2.0 * half).element_product())
}

/// The same, in a picture; `None` if nothing is there.
fn offset_in_picture(outline: &Outline, distance: f64) -> Option<Outline> {
    let (low, high) = bounds(outline)?;
    let extent = (high - low).max_element() + 2.0 * distance.max(0.0);
    // With two empty pixels at each side.
    let pixel = extent / (SIDE - 4.0);
    let around = distance.max(0.0) + 2.0 * pixel;
    let origin = low - around;
    let size = ((high + around - origin) / pixel).ceil().max(DVec2::ONE);
    let (width, height) = (size.x as u32, size.y as u32);
    let place = |point: DVec2| (point - origin) / pixel;
    let solid = pixels(outline.rings(), FillRule::EvenOdd, place, [width, height]);
    let is_outwards = distance >= 0.0;
    let far: Vec<bool> = solid.iter().map(|solid| *solid != is_outwards).collect();
    let squares = squared_distances(&far, width as usize);
    // The middle of the nearest pixel on the other side is beyond the border: by half a pixel on average where that is level or upright, by
    // a tenth where it is round.
    let reach = (distance.abs() / pixel + BEYOND).powi(2);
    let mut rings = pixel_borders(width, height, |x, y| {
        let square = squares[(y * width + x) as usize];
        (square <= reach) == is_outwards
    });
    for point in rings.iter_mut().flatten() {
        *point = origin + *point * pixel;
    }
    Some(resolve_overlaps(rings, FillRule::EvenOdd))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

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

    #[test]
    fn a_picture_moves_borders_as_far() {
        // A gear of 40 teeth with a hole.
        let around = |count: usize, radius: &dyn Fn(usize) -> f64| -> Ring {
            let angle = |i: usize| i as f64 * std::f64::consts::TAU / count as f64;
            (0..count)
                .map(|i| radius(i) * DVec2::from_angle(angle(i)))
                .collect()
        };
        let teeth = around(800, &|i| if i / 10 % 2 == 0 { 100.0 } else { 90.0 });
        let hole = around(60, &|_| 30.0);
        let gear = resolve_overlaps(vec![teeth, hole], FillRule::EvenOdd);
        for distance in [-12.0, -3.0, 2.0, 9.0] {
            let exact = area(&offset(&gear, distance));
            let pictured = area(&offset_in_picture(&gear, distance).unwrap());
            assert!(
                (pictured / exact - 1.0).abs() < 0.004,
                "{distance}: {pictured}, not {exact}"
            );
        }
    }
}
