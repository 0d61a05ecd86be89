//! Rings that cross themselves so often that the pieces they make would take very long to find: the area is taken from a picture.

use glam::{DVec2, Vec2Swizzles as _};

use super::{FillRule, Ring, bounds_of, pixel_borders};
use crate::budget::{self, Step};

/// How often edges may cross for an area to be found exactly. An area with more crossings is in as many pieces.
pub(super) const MAX_CROSSINGS: usize = 20_000;
/// How many pairs of edges are compared. Where there are more, edges lie beside each other so densely that finding their pieces takes long
/// even if they hardly cross.
const MAX_PAIRS: usize = 1 << 24;
/// With more edges above each other, a sweep takes long and much memory.
const MANY_ABOVE: f64 = 1000.0;
/// Pixels along the longer side of the picture, at most and at least.
const SIDES: std::ops::RangeInclusive<u32> = 64..=2048;
/// How many rows of pixels the edges of a picture may pass, all together, at more than the smallest size.
const MAX_ROWS: f64 = 4e6;
/// The largest number of points of all areas of a drawing that are taken from pictures at more than the smallest size.
pub(crate) const MAX_PICTURED: usize = 100_000;

/// How often the edges of rings cross, or a number above 20,000.
pub(crate) fn count_crossings(rings: &[Ring]) -> usize {
    crossings(rings).count
}

/// How the edges of rings cross.
pub(super) struct Crossings {
    /// How often, or a number above 20,000.
    pub(super) count: usize,
    /// Whether very many edges lie beside each other, as in rings in rings or a star of ten thousand tips.
    pub(super) is_dense: bool,
    /// See [`sweeps_better_along_y`].
    pub(super) is_better_along_y: bool,
}

/// About how many edges of rings are above each other along each axis: those of a row of dashes are few along the row only.
fn edges_above<'a>(rings: impl Iterator<Item = &'a [DVec2]> + Clone) -> DVec2 {
    let edges = rings.clone().flat_map(|ring| {
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        ends.map(|(from, to)| (*to - *from).abs())
    });
    let lengths: DVec2 = edges.sum();
    let (low, high) = bounds_of(rings.flatten().copied()).unwrap_or_default();
    lengths / (high - low).max(DVec2::splat(f64::MIN_POSITIVE))
}

/// Whether a sweep along x meets very many edges at a time, and one along y fewer: then it is worth turning the rings.
pub(crate) fn sweeps_better_along_y<'a>(rings: impl Iterator<Item = &'a [DVec2]> + Clone) -> bool {
    is_better_along_y(edges_above(rings))
}

fn is_better_along_y(above: DVec2) -> bool {
    above.x > MANY_ABOVE && above.y < above.x
}

/// How the edges of rings cross: sweep and prune along the axis along which edges are shorter, compared with all of the rings.
pub(super) fn crossings(rings: &[Ring]) -> Crossings {
    let count: usize = rings.iter().map(Vec::len).sum();
    let mut edges: Vec<[DVec2; 2]> = Vec::with_capacity(count);
    for ring in rings {
        let mut from = ring.last().copied().unwrap_or_default();
        for &to in ring {
            edges.push([from, to]);
            from = to;
        }
    }
    let above = edges_above(rings.iter().map(Vec::as_slice));
    for edge in &mut edges {
        if above.y < above.x {
            *edge = edge.map(DVec2::yx);
        }
        if edge[0].x > edge[1].x {
            edge.reverse();
        }
    }
    edges.sort_unstable_by(|[a, _], [b, _]| a.x.total_cmp(&b.x));
    let (mut pairs, mut crossings) = (0, 0);
    for (index, a) in edges.iter().enumerate() {
        for b in edges[index + 1..].iter().take_while(|b| b[0].x < a[1].x) {
            pairs += 1;
            crossings += usize::from(cross(a, b));
        }
        if crossings > MAX_CROSSINGS || pairs > MAX_PAIRS {
            break;
        }
    }
    budget::count(Step::Pair, pairs);
    Crossings {
        count: crossings,
        is_dense: pairs > MAX_PAIRS,
        is_better_along_y: is_better_along_y(above),
    }
}

/// The borders of the area that rings enclose by a fill rule, to within a pixel of a picture of it, with at most so many points unless
/// the picture is of the smallest size. They may touch.
pub(super) fn pictured(rings: &[Ring], rule: FillRule, most: usize) -> Vec<Ring> {
    let Some((low, high)) = bounds_of(rings.iter().flatten().copied()) else {
        return Vec::new();
    };
    let extent = (high - low).max_element();
    let mut side = *SIDES.end();
    let edges = rings.iter().flat_map(|ring| ring.windows(2));
    let upright: f64 = edges.map(|edge| (edge[1].y - edge[0].y).abs()).sum();
    // A quarter of the pixels has about a quarter of the points.
    let fewest = MAX_PICTURED as f64 / most.max(1) as f64;
    let is_too_fine = |side: u32| {
        let coarser = f64::from(SIDES.end() / side);
        coarser * coarser < fewest || f64::from(side) * upright / extent > MAX_ROWS
    };
    while side > *SIDES.start() && is_too_fine(side) {
        side /= 2;
    }
    loop {
        let scale = f64::from(side) / extent;
        let size = (high - low) * scale;
        let [width, height] = size.to_array().map(|side| (side.ceil() as u32).max(1));
        let solid = pixels(rings, rule, |point| (point - low) * scale, [width, height]);
        let mut borders = pixel_borders(width, height, |x, y| solid[(y * width + x) as usize]);
        let count: usize = borders.iter().map(Vec::len).sum();
        if count <= most || side <= *SIDES.start() {
            let points = borders.iter_mut().flatten();
            points.for_each(|point| *point = low + *point / scale);
            return borders;
        }
        side /= 2;
    }
}

/// Which pixels of a picture of this size have their middle in the area that rings enclose, row by row.
pub(super) fn pixels<'a>(
    rings: impl IntoIterator<Item = &'a Ring>,
    rule: FillRule,
    place: impl Fn(DVec2) -> DVec2,
    [width, height]: [u32; 2],
) -> Vec<bool> {
    let columns = width as usize;
    // Per pixel how many more borders go down between it and the pixel to its left than up. Unlike a list of the edges that pass a row,
    // this takes no longer where they cross.
    let mut turns = vec![0_i32; columns * height as usize];
    for ring in rings {
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        for (from, to) in ends.map(|(from, to)| (place(*from), place(*to))) {
            let (upper, lower, turn) = if from.y < to.y {
                (from, to, 1)
            } else {
                (to, from, -1)
            };
            let slope = (lower.x - upper.x) / (lower.y - upper.y);
            let row = |y: f64| (y - 0.5).ceil().clamp(0.0, f64::from(height)) as usize;
            for row in row(upper.y)..row(lower.y) {
                let x = upper.x + (row as f64 + 0.5 - upper.y) * slope;
                let column = (x - 0.5).ceil().max(0.0) as usize;
                if column < columns {
                    turns[row * columns + column] += turn;
                }
            }
        }
    }
    for row in turns.chunks_exact_mut(columns) {
        let mut sum = 0;
        for turn in row {
            sum += *turn;
            *turn = sum;
        }
    }
    let is_filled = |turns: i32| match rule {
        FillRule::NonZero => turns != 0,
        FillRule::EvenOdd => turns % 2 != 0,
    };
    turns.into_iter().map(is_filled).collect()
}

/// Whether two edges cross at a point that is an end of neither.
fn cross(a: &[DVec2; 2], b: &[DVec2; 2]) -> bool {
    let parts = |[from, to]: &[DVec2; 2], other: &[DVec2; 2]| {
        let along = *to - *from;
        let sides = other.map(|point| along.perp_dot(point - *from));
        (sides[0] < 0.0 && sides[1] > 0.0) || (sides[0] > 0.0 && sides[1] < 0.0)
    };
    parts(a, b) && parts(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{area, resolve_overlaps};

    /// A star whose every edge passes by the middle: nearly all pairs of edges cross. The number of points is prime, so that it is
    /// one ring.
    fn star(points: usize) -> Ring {
        let step = (points / 2 - 1) as f64 * std::f64::consts::TAU / points as f64;
        (0..points)
            .map(|index| 100.0 * DVec2::from_angle(index as f64 * step))
            .collect()
    }

    #[test]
    fn every_star_has_its_area() {
        for points in [101, 199, 211, 401, 4001] {
            let is_tangled = count_crossings(&[star(points)]) > MAX_CROSSINGS;
            assert_eq!(is_tangled, points > 199, "{points} points");
            let outline = resolve_overlaps(vec![star(points)], FillRule::NonZero);
            // Its border goes from the tips to where the edges beside them first cross.
            let turn = |k: usize| (k as f64 * std::f64::consts::PI / points as f64).cos();
            let notch = 100.0 * turn(points / 2 - 1) / turn(points / 2 - 2);
            let exact =
                points as f64 * 100.0 * notch * (std::f64::consts::PI / points as f64).sin();
            let off = area(&outline) / exact - 1.0;
            // The tips of the largest are narrower than a pixel.
            let most = if points > 1000 { 0.08 } else { 0.003 };
            assert!(off.abs() < most, "{points} points: {off}");
        }
    }

    #[test]
    fn long_outlines_that_cross_little_are_not() {
        let comb = |teeth: usize| -> Ring {
            let tooth = |index: usize| {
                let x = index as f64;
                [
                    DVec2::new(x, 0.0),
                    DVec2::new(x, 100.0),
                    DVec2::new(x + 0.5, 100.0),
                    DVec2::new(x + 0.5, 0.0),
                ]
            };
            let bottom = [DVec2::new(teeth as f64, -1.0), DVec2::new(0.0, -1.0)];
            (0..teeth).flat_map(tooth).chain(bottom).collect()
        };
        for teeth in [100, 20_000] {
            let upright = comb(teeth);
            let lying: Ring = upright.iter().map(|point| point.yx()).collect();
            assert_eq!(count_crossings(&[upright]), 0);
            assert_eq!(count_crossings(&[lying]), 0);
        }
    }

    #[test]
    fn rings_in_rings_are_taken_from_a_picture() {
        let circle = |radius: f64| -> Ring {
            let angle = |i: u32| f64::from(i) * std::f64::consts::TAU / 60.0;
            (0..60)
                .map(|i| radius * DVec2::from_angle(angle(i)))
                .collect()
        };
        let rings: Vec<Ring> = (1..=1000).map(|i| circle(f64::from(i) / 10.0)).collect();
        let found = crossings(&rings);
        assert!(found.is_dense && found.count == 0);
        let whole = area(&resolve_overlaps(vec![circle(100.0)], FillRule::NonZero));
        let striped = area(&resolve_overlaps(rings, FillRule::EvenOdd));
        assert!((striped / whole - 0.5).abs() < 0.03, "{striped} of {whole}");
    }
}
