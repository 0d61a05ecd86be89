//! Legs in one piece: trousers are often one shape, from the waist down to both feet.
//!
//! What lies between the legs is the deepest pocket between the shape and its convex hull. The shape is cut from the bottom of that pocket
//! on, in the direction in which it goes.

use glam::DVec2;
use rustc_hash::FxHashSet;

use crate::geometry::{Outline, Polygon, Ring, area, centroid, contains, convex_hull};

/// How deep the pocket between legs is at least, as a share of the shape's extent in its direction.
const DEEP: f64 = 0.3;
/// How deep it is at least, as a multiple of its width: the hollow of a knee is wider.
const NARROW: f64 = 0.6;
/// The area of a leg, as a share of that of the other one at least.
const ALIKE: f64 = 0.4;
/// What is this much less deep than a pocket, as a share of that, is at its bottom, too; what is this deep belongs to its rim.
const FLAT: f64 = 0.02;

/// The two legs of an outline; `None` if it has none that lie apart.
pub(super) fn legs(outline: &Outline) -> Option<[Outline; 2]> {
    let [polygon] = outline.polygons.as_slice() else {
        return None;
    };
    let (border, holes) = polygon.rings.split_first()?;
    let pocket = deepest_pocket(border)?;
    let along = (pocket.bottom - pocket.mouth).try_normalize()?;
    let places = || border.iter().map(|point| point.dot(along));
    let extent =
        places().fold(f64::NEG_INFINITY, f64::max) - places().fold(f64::INFINITY, f64::min);
    if pocket.depth < DEEP * extent || pocket.depth < NARROW * pocket.width {
        return None;
    }
    let legs = cut(border, &pocket, along)?;
    let [mut one, mut other] = legs.map(|border| Outline {
        polygons: vec![Polygon {
            rings: vec![border],
        }],
    });
    for hole in holes {
        let legs = [&mut one, &mut other];
        let mut holding = legs
            .into_iter()
            .filter(|leg| hole.iter().all(|point| contains(leg, *point)));
        // A hole that the cut goes through is in neither.
        holding.next()?.polygons[0].rings.push(hole.clone());
    }
    let areas = [&one, &other].map(area);
    if areas[0].min(areas[1]) < ALIKE * areas[0].max(areas[1]) {
        return None;
    }
    // However the shape was drawn, the left one comes first, or of legs above each other the upper one.
    let [first, second] = [&one, &other].map(|leg| centroid(leg).map(|at| (at.x, at.y)));
    Some(if first <= second {
        [one, other]
    } else {
        [other, one]
    })
}

/// The two pieces of a border that is cut from the bottom of a pocket on, in a direction.
fn cut(border: &[DVec2], pocket: &Pocket, along: DVec2) -> Option<[Ring; 2]> {
    let (start, from, count) = (pocket.bottom, pocket.from, border.len());
    let hits = (1..count).filter_map(|step| {
        let edge = (from + step) % count;
        let [a, b] = [border[edge] - start, border[(edge + 1) % count] - start];
        let [aside_a, aside_b] = [a, b].map(|point| along.perp_dot(point));
        // An edge has its first end, so that a cut through a corner meets one edge.
        if (aside_a >= 0.0) == (aside_b >= 0.0) {
            return None;
        }
        let distance = a.lerp(b, aside_a / (aside_a - aside_b)).dot(along);
        (distance > 0.0).then_some((distance, step))
    });
    let (distance, steps) = hits.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let end = start + distance * along;
    let corner = |step: usize| border[(from + step) % count];
    let one = [start]
        .into_iter()
        .chain((1..=steps).map(corner))
        .chain([end]);
    let other = [end]
        .into_iter()
        .chain((steps + 1..=count).map(corner))
        .chain([start]);
    let rings = [one.collect::<Ring>(), other.collect()];
    Some(rings.map(|mut ring| {
        // The cut may begin or end at a corner.
        ring.dedup();
        ring
    }))
}

/// A pocket between a border and its convex hull.
struct Pocket {
    /// The middle of its opening.
    mouth: DVec2,
    /// How wide that is.
    width: f64,
    /// How far from the hull it goes.
    depth: f64,
    /// The middle of what is farthest from its opening.
    bottom: DVec2,
    /// The edge of the border that it lies on: that which begins at the point with this number.
    from: usize,
}

/// The deepest pocket; `None` for a border that is its own convex hull.
fn deepest_pocket(border: &[DVec2]) -> Option<Pocket> {
    let bits = |point: &DVec2| point.to_array().map(f64::to_bits);
    let hull: FxHashSet<[u64; 2]> = convex_hull(border.to_vec()).iter().map(bits).collect();
    let corners = (0..border.len()).filter(|at| hull.contains(&bits(&border[*at])));
    let corners: Vec<usize> = corners.collect();
    let next = corners.iter().cycle().skip(1);
    let spans = corners.iter().zip(next).map(|(from, to)| {
        let steps = (to + border.len() - from) % border.len();
        let (a, b) = (border[*from], border[*to]);
        let depth = move |point: DVec2| (point - a).perp_dot((b - a).normalize_or_zero()).abs();
        let depths = (0..=steps).map(|step| depth(border[(from + step) % border.len()]));
        let depths: Vec<f64> = depths.collect();
        (depths.iter().copied().fold(0.0, f64::max), *from, depths)
    });
    let (deepest, from, depths) = spans.max_by(|one, other| one.0.total_cmp(&other.0))?;
    let point = |step: usize| border[(from + step) % border.len()];
    // Flat soles lie along the hull: the pocket opens between them.
    let on_rim = |depth: &f64| *depth <= FLAT * deepest;
    let opens = depths
        .iter()
        .take_while(|depth| on_rim(depth))
        .count()
        .checked_sub(1)?;
    let closes = depths.len()
        - depths
            .iter()
            .rev()
            .take_while(|depth| on_rim(depth))
            .count();
    let at_bottom = |depth: &f64| *depth >= (1.0 - FLAT) * deepest;
    let first = depths.iter().position(at_bottom)?;
    let last = depths.iter().rposition(at_bottom)?;
    let middle = point(first).midpoint(point(last));
    let on_edge = |step: usize| {
        let (a, b) = (point(step), point(step + 1));
        let share = (middle - a).dot(b - a) / (b - a).length_squared();
        (step, a.lerp(b, share.clamp(0.0, 1.0)))
    };
    let edges = (first.saturating_sub(1)..=last.min(depths.len() - 2)).map(on_edge);
    let distance = |one: &(usize, DVec2)| one.1.distance_squared(middle);
    let (step, bottom) = edges.min_by(|one, other| distance(one).total_cmp(&distance(other)))?;
    Some(Pocket {
        mouth: point(opens).midpoint(point(closes)),
        width: point(opens).distance(point(closes)),
        depth: deepest,
        bottom,
        from: (from + step) % border.len(),
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::union;

    fn outline(points: &[(f64, f64)], place: impl Fn(DVec2) -> DVec2) -> Outline {
        let ring = points.iter().map(|(x, y)| place(DVec2::new(*x, *y)));
        Outline {
            polygons: vec![Polygon {
                rings: vec![ring.collect()],
            }],
        }
    }

    /// Trousers, 60 wide and 100 high, whose legs part `crotch` below the waist, `gap` apart, the right one `wider` at its foot.
    fn trousers(crotch: f64, gap: f64, wider: f64) -> Vec<(f64, f64)> {
        let (left, right) = (30.0 - gap, 30.0 + gap);
        vec![
            (0.0, 0.0),
            (60.0, 0.0),
            (60.0 + wider, 100.0),
            (right, 100.0),
            (30.0, crotch),
            (left, 100.0),
            (0.0, 100.0),
        ]
    }

    proptest! {
        /// Wherever and in whatever direction trousers are drawn, both legs are found: one on either side, and together everything.
        #[test]
        fn trousers_have_two_legs(
            crotch in 15.0..65.0_f64, gap in 2.0..9.0_f64, wider in -5.0..10.0_f64, turn in 0.0..TAU, size in 0.01..100.0_f64,
        ) {
            let place = |point: DVec2| size * (DVec2::from_angle(turn).rotate(point) + DVec2::new(70.0, -30.0));
            let outline = outline(&trousers(crotch, gap, wider), place);
            let [one, other] = legs(&outline).expect("two legs");
            let (whole, both) = (area(&outline), union(&[one.clone(), other.clone()]));
            prop_assert!((area(&one) + area(&other) - whole).abs() < 1e-3 * whole);
            prop_assert!((area(&both) - whole).abs() < 1e-3 * whole);
            for foot in [DVec2::new(5.0, 97.0), DVec2::new(53.0, 97.0)] {
                let holding = [&one, &other].map(|leg| contains(leg, place(foot)));
                prop_assert!(holding[0] != holding[1], "{foot}: {holding:?}");
            }
            let [one, other] = [one, other].map(|leg| centroid(&leg).expect("an area"));
            prop_assert!(one.distance(other) > 20.0 * size && one.x <= other.x);
        }
    }

    #[test]
    fn what_has_no_legs_is_not_cut() {
        let as_it_is = |point: DVec2| point;
        // A skirt with a notch in its hem, a box, and a leg that is bent.
        let notched = trousers(80.0, 8.0, 0.0);
        let whole = [(0.0, 0.0), (60.0, 0.0), (60.0, 100.0), (0.0, 100.0)];
        let bent = [
            (0.0, 0.0),
            (20.0, 0.0),
            (20.0, 40.0),
            (90.0, 40.0),
            (90.0, 50.0),
            (0.0, 50.0),
        ];
        for points in [&notched[..], &whole, &bent] {
            assert!(legs(&outline(points, as_it_is)).is_none(), "{points:?}");
        }
        let mut two = outline(&whole, as_it_is);
        two.polygons
            .push(outline(&whole, |point| point + 200.0).polygons.remove(0));
        assert!(legs(&two).is_none(), "legs that do not hang together");
        assert!(legs(&Outline::default()).is_none());
    }
}
