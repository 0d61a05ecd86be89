//! Flattens curves to rings of points.
//!
//! The number of points follows the curvature: a chord of length `L` on a curve of curvature `κ` is off by `κ L² / 8`,
//! so the points are spread evenly over `∫ √(κ / 8 tolerance) ds`. Units are those of the path.

use glam::DVec2;
use kurbo::{BezPath, PathEl, Point};

use super::Ring;

/// How much more than the tolerance chords may be off. Without it a circle of eight quadratic curves would get one point
/// too many in each.
const SLACK: f64 = 1.1;
/// In a path of so many subpaths small ones are as coarse as large ones: nobody looks at them one by one.
const SUBPATHS: f64 = 1000.0;
/// The smallest tolerance, relative to the path's larger extent.
const MIN_TOLERANCE: f64 = 1e-5;
/// Points this close are merged, relative to the path's larger extent.
const SAME: f64 = 1e-9;
/// The largest number of points per curve.
const MAX_POINTS: f64 = 1024.0;
/// Steps of the numerical integration along a curve.
const STEPS: usize = 8;

/// Every subpath of a path as a closed ring, off by at most about `tolerance`, relative to the path's larger extent. For a small subpath
/// it is relative to the geometric mean of that extent and its own, so that eyes and freckles that are drawn as one path stay round.
///
/// Points that are not finite and repeated points are dropped, and so are subpaths with fewer than three points left.
pub(crate) fn flatten(path: &BezPath, tolerance: f64) -> Vec<Ring> {
    let elements = path.elements();
    let extent = extent(elements);
    let allowed = tolerance.max(MIN_TOLERANCE) * SLACK;
    let count = elements
        .iter()
        .filter(|element| matches!(element, PathEl::MoveTo(_)))
        .count();
    let least = extent * (count as f64 / SUBPATHS).min(1.0);
    // Of a subpath that begins at an element.
    let tolerance_at = |first: usize| {
        let rest = &elements[first..];
        let next = rest
            .iter()
            .skip(1)
            .position(|element| matches!(element, PathEl::MoveTo(_)));
        let own = self::extent(&rest[..next.map_or(rest.len(), |next| next + 1)]);
        allowed * (own * extent).sqrt().clamp(least, extent)
    };
    let mut tolerance = allowed * extent;
    let same = SAME * extent;
    let mut rings = Vec::new();
    let mut ring = Ring::with_capacity(64);
    // The start of the subpath, and the current point after it was closed.
    let mut start = None;
    for (place, element) in elements.iter().enumerate() {
        match *element {
            PathEl::MoveTo(p) => {
                finish(&mut ring, &mut rings, same);
                if count > 1 {
                    tolerance = tolerance_at(place);
                }
                start = finite(p);
                ring.extend(start);
            }
            PathEl::ClosePath => finish(&mut ring, &mut rings, same),
            PathEl::LineTo(p) => {
                resume(&mut ring, start);
                line(&mut ring, p);
            }
            PathEl::QuadTo(b, c) => {
                resume(&mut ring, start);
                match (ring.last().copied(), finite(b), finite(c)) {
                    (Some(a), Some(b), Some(c)) => {
                        let towards = 2.0 / 3.0;
                        let controls = [a, a.lerp(b, towards), c.lerp(b, towards), c];
                        cubic(&mut ring, controls, tolerance);
                    }
                    _ => line(&mut ring, c),
                }
            }
            PathEl::CurveTo(b, c, d) => {
                resume(&mut ring, start);
                match (ring.last().copied(), finite(b), finite(c), finite(d)) {
                    (Some(a), Some(b), Some(c), Some(d)) => {
                        cubic(&mut ring, [a, b, c, d], tolerance);
                    }
                    _ => line(&mut ring, d),
                }
            }
        }
    }
    finish(&mut ring, &mut rings, same);
    rings
}

fn finite(p: Point) -> Option<DVec2> {
    p.is_finite().then_some(DVec2::new(p.x, p.y))
}

fn extent(elements: &[PathEl]) -> f64 {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let mut grow = |p: Point| {
        if let Some(p) = finite(p) {
            (low, high) = (low.min(p), high.max(p));
        }
    };
    for element in elements {
        match *element {
            PathEl::MoveTo(a) | PathEl::LineTo(a) => grow(a),
            PathEl::QuadTo(a, b) => [a, b].into_iter().for_each(&mut grow),
            PathEl::CurveTo(a, b, c) => [a, b, c].into_iter().for_each(&mut grow),
            PathEl::ClosePath => {}
        }
    }
    (high - low).max_element().max(f64::MIN_POSITIVE)
}

fn finish(ring: &mut Ring, rings: &mut Vec<Ring>, same: f64) {
    ring.dedup_by(|b, a| b.distance(*a) <= same);
    while ring.len() > 1 && ring[0].distance(ring[ring.len() - 1]) <= same {
        ring.pop();
    }
    if ring.len() > 2 {
        // Copied to a list without spare capacity: there may be a hundred thousand.
        rings.push(Ring::from(&ring[..]));
    }
    ring.clear();
}

fn resume(ring: &mut Ring, start: Option<DVec2>) {
    if ring.is_empty() {
        ring.extend(start);
    }
}

fn line(ring: &mut Ring, p: Point) {
    if let Some(p) = finite(p) {
        ring.push(p);
    }
}

/// Appends a cubic curve without its first point.
fn cubic(ring: &mut Ring, [a, b, c, d]: [DVec2; 4], tolerance: f64) {
    let (d0, d1, d2) = (3.0 * (b - a), 3.0 * (c - b), 3.0 * (d - c));
    let density = |t: f64| {
        let u = 1.0 - t;
        let first = d0 * (u * u) + d1 * (2.0 * u * t) + d2 * (t * t);
        let second = 2.0 * ((d1 - d0) * u + (d2 - d1) * t);
        let speed = first.length();
        let bend = first.perp_dot(second).abs();
        // At a cusp both the speed and the bend are zero.
        if speed > 0.0 && bend.is_finite() {
            (bend / speed).sqrt()
        } else {
            0.0
        }
    };
    let mut sums = [0.0; STEPS + 1];
    let mut before = density(0.0);
    for i in 1..=STEPS {
        let here = density(i as f64 / STEPS as f64);
        sums[i] = sums[i - 1] + (before + here) / (2 * STEPS) as f64;
        before = here;
    }
    let total = sums[STEPS];
    let count = (total / (8.0 * tolerance).sqrt()).ceil();
    if count > 1.0 {
        let count = count.min(MAX_POINTS) as usize;
        let mut i = 1;
        for k in 1..count {
            let goal = total * k as f64 / count as f64;
            while i < STEPS && sums[i] < goal {
                i += 1;
            }
            let width = sums[i] - sums[i - 1];
            let part = if width > 0.0 {
                (goal - sums[i - 1]) / width
            } else {
                0.0
            };
            let t = ((i - 1) as f64 + part) / STEPS as f64;
            let u = 1.0 - t;
            let p =
                a * (u * u * u) + b * (3.0 * u * u * t) + c * (3.0 * u * t * t) + d * (t * t * t);
            if p.is_finite() {
                ring.push(p);
            }
        }
    }
    ring.push(d);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(pieces: usize, degree: usize) -> BezPath {
        let step = std::f64::consts::TAU / pieces as f64;
        let at = |angle: f64, r: f64| Point::new(r * angle.cos(), r * angle.sin());
        let mut path = BezPath::new();
        path.move_to(at(0.0, 1.0));
        for i in 0..pieces {
            let (from, to) = (i as f64 * step, (i + 1) as f64 * step);
            if degree == 2 {
                path.quad_to(at(from + step / 2.0, 1.0 / (step / 2.0).cos()), at(to, 1.0));
            } else {
                let k = 4.0 / 3.0 * (step / 4.0).tan();
                let (p, q) = (at(from, 1.0), at(to, 1.0));
                path.curve_to(
                    Point::new(p.x - k * p.y, p.y + k * p.x),
                    Point::new(q.x + k * q.y, q.y - k * q.x),
                    q,
                );
            }
        }
        path.close_path();
        path
    }

    #[test]
    fn circles_get_the_same_points_in_every_quadrant() {
        for (pieces, degree) in [(4, 3), (8, 2)] {
            let rings = flatten(&circle(pieces, degree), 0.001);
            assert_eq!(rings.len(), 1);
            let n = rings[0].len();
            assert!((48..=52).contains(&n), "{n}");
            assert_eq!(n % 4, 0);
            for (i, p) in rings[0].iter().enumerate() {
                let q = rings[0][(i + n / 4) % n];
                assert!((p.perp() - q).length() < 1e-3, "{p} {q}");
                let middle = (*p + rings[0][(i + 1) % n]) / 2.0;
                assert!(1.0 - middle.length() < 0.0025);
            }
        }
    }

    #[test]
    fn subpaths_are_closed_and_repeated_points_dropped() {
        let path = BezPath::from_svg("M0 0H4V4H0V0ZL1 0 1 1M9 9M5 5H6M7 7 8 7 8 7 8 8").unwrap();
        let rings = flatten(&path, 0.01);
        assert_eq!(rings.iter().map(Vec::len).collect::<Vec<_>>(), [4, 3, 3]);
        assert_eq!(rings[1][0], DVec2::ZERO);
    }

    #[test]
    fn small_subpaths_stay_round() {
        let mut path = circle(4, 3);
        for size in [0.1, 0.01] {
            let small = kurbo::Affine::scale(size) * circle(4, 3);
            path.extend(small);
        }
        let counts = |path: &BezPath| Vec::from_iter(flatten(path, 0.001).iter().map(Vec::len));
        let few = counts(&path);
        assert!(few[1] >= 24 && few[2] >= 16, "{few:?}");
        let small = kurbo::Affine::scale(0.1) * circle(4, 3);
        for _ in 0..SUBPATHS as usize {
            path.extend(small.clone());
        }
        let many = counts(&path);
        assert_eq!(many[0], few[0]);
        assert!(many[1] <= 16, "{}", many[1]);
    }

    #[test]
    fn extreme_numbers_are_handled() {
        for wild in [f64::NAN, f64::INFINITY, 1e300, 1e30, 1e-300] {
            for tolerance in [0.0, -1.0, f64::NAN, 1e-300, 1e300] {
                let mut path = BezPath::new();
                path.move_to((0.0, 0.0));
                path.curve_to((1.0, wild), (2.0, 2.0), (3.0, 0.0));
                path.line_to((wild, 1.0));
                path.quad_to((wild, 2.0), (0.0, 9.0));
                path.quad_to((3.0, 2.0), (wild, wild));
                path.close_path();
                for ring in flatten(&path, tolerance) {
                    assert!(ring.len() < 4000 && ring.iter().all(|p| p.is_finite()));
                }
            }
        }
    }

    #[test]
    fn curves_stay_within_the_tolerance() {
        let path =
            BezPath::from_svg("M0 0C10 40-20 40 15 3C30 0 30 0 0-9C0-30 40-30 40-9Z").unwrap();
        let ring = &flatten(&path, 0.05 / extent(path.elements()))[0];
        for segment in path.segments() {
            for i in 0..=200 {
                let p = kurbo::ParamCurve::eval(&segment, i as f64 / 200.0);
                let p = DVec2::new(p.x, p.y);
                let near = (0..ring.len())
                    .map(|k| {
                        let (a, b) = (ring[k], ring[(k + 1) % ring.len()]);
                        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                        (a.lerp(b, t) - p).length()
                    })
                    .fold(f64::INFINITY, f64::min);
                assert!(near < 0.1, "{near}");
            }
        }
    }
}
