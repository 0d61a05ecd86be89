//! Queries on outlines. They hold for either direction of y.

use glam::DVec2;

use super::{Outline, Ring};

/// The filled area in square units.
pub fn area(outline: &Outline) -> f64 {
    outline
        .polygons
        .iter()
        .map(|polygon| {
            let mut rings = polygon.rings.iter().map(|ring| shoelace(ring).abs());
            rings.next().unwrap_or(0.0) - rings.sum::<f64>()
        })
        .sum()
}

/// Whether a point is filled (even-odd ray casting). Points on a border may be either.
pub fn contains(outline: &Outline, point: DVec2) -> bool {
    let rings = outline.rings();
    rings.fold(false, |inside, ring| inside != is_inside(ring, point))
}

/// Whether a ring encloses a point.
pub(super) fn is_inside(ring: &Ring, point: DVec2) -> bool {
    let Some(mut a) = ring.last().copied() else {
        return false;
    };
    let mut inside = false;
    for &b in ring {
        inside ^= crosses([a, b], point);
        a = b;
    }
    inside
}

/// Whether an edge crosses the ray from a point to the right.
pub(crate) fn crosses([a, b]: [DVec2; 2], point: DVec2) -> bool {
    (a.y > point.y) != (b.y > point.y)
        && point.x < (b.x - a.x) * ((point.y - a.y) / (b.y - a.y)) + a.x
}

/// The square of the distance from a point to the filled area: 0 inside, infinite if there is no area.
pub(crate) fn distance_squared(outline: &Outline, point: DVec2) -> f64 {
    if contains(outline, point) {
        0.0
    } else {
        border_distance_squared(outline, point)
    }
}

/// The square of the distance from a point to the nearest border; infinite if there is none.
pub fn border_distance_squared(outline: &Outline, point: DVec2) -> f64 {
    edges(outline).fold(f64::INFINITY, |nearest, edge| {
        nearest.min(edge_distance_squared(edge, point))
    })
}

/// The square of the distance from a point to an edge; not a number for an edge without length.
pub(crate) fn edge_distance_squared([a, b]: [DVec2; 2], point: DVec2) -> f64 {
    let (edge, to) = (b - a, point - a);
    let along = (to.dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
    (to - edge * along).length_squared()
}

/// The lower and the upper corner of the bounding box; `None` without points.
pub fn bounds(outline: &Outline) -> Option<(DVec2, DVec2)> {
    let borders = outline.polygons.iter().flat_map(|p| p.rings.first());
    bounds_of(borders.flatten().copied())
}

/// The lower and the upper corner of the bounding box of points; `None` without points.
pub(crate) fn bounds_of(points: impl IntoIterator<Item = DVec2>) -> Option<(DVec2, DVec2)> {
    let mut points = points.into_iter();
    let first = points.next()?;
    Some(points.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
}

/// The centre of gravity of the filled area; `None` if there is none.
pub(crate) fn centroid(outline: &Outline) -> Option<DVec2> {
    let (low, _) = bounds(outline)?;
    let (mut twice, mut sum) = (0.0, DVec2::ZERO);
    for [a, b] in edges(outline) {
        // From a corner of the bounding box, for precision far from the origin.
        let (a, b) = (a - low, b - low);
        let cross = a.perp_dot(b);
        twice += cross;
        sum += (a + b) * cross;
    }
    let center = low + sum / (3.0 * twice);
    center.is_finite().then_some(center)
}

/// The signed area of a ring (shoelace formula), positive where it runs from x to y. Computed relative to the first
/// point, so that small rings far from the origin keep their precision.
pub(crate) fn shoelace(ring: &[DVec2]) -> f64 {
    let Some(&origin) = ring.first() else {
        return 0.0;
    };
    ring.windows(2)
        .map(|w| (w[0] - origin).perp_dot(w[1] - origin))
        .sum::<f64>()
        / 2.0
}

/// The edges of all rings of an outline, in their order.
pub(crate) fn edges(outline: &Outline) -> impl Iterator<Item = [DVec2; 2]> {
    edges_of(outline.rings())
}

/// The edges of rings, in their order.
pub(crate) fn edges_of<'a>(
    rings: impl IntoIterator<Item = &'a Ring>,
) -> impl Iterator<Item = [DVec2; 2]> {
    rings.into_iter().flat_map(|ring| {
        (0..ring.len()).map(move |i| [ring[i], ring[if i + 1 < ring.len() { i + 1 } else { 0 }]])
    })
}

/// The length of all borders of an outline.
pub(crate) fn perimeter(outline: &Outline) -> f64 {
    edges(outline).map(|[a, b]| a.distance(b)).sum()
}
