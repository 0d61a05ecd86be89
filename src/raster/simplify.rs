//! Borders with fewer points.

use glam::DVec2;

use crate::geometry::simplify;

/// Two edges whose directions have a smaller cross product are one straight line for the purpose of moving them.
const STRAIGHT: f64 = 0.2;

/// An edge of so many points is long.
const LONG: usize = 7;
/// The points at each end of a long edge that do not count.
const TRIM: usize = 2;
/// Pixels cut off corners by less than this, pixels.
const CUT: f64 = 1.6;

/// What happens to the ends of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ends {
    /// They stay, because other lines end there too.
    Fixed,
    /// They are one point, which moves like the others.
    Joined,
}

/// An arc without points that lie within the tolerance of the line between others. The ends stay, and both directions give the
/// same points.
pub(super) fn simplified_arc(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    if points.len() < 3 {
        return points.to_vec();
    }
    // An arc may return to the node from which it comes.
    let is_backward = match order(*first, *last) {
        std::cmp::Ordering::Equal => order(points[1], points[points.len() - 2]).is_gt(),
        order => order.is_gt(),
    };
    let mut arc = points.to_vec();
    if is_backward {
        arc.reverse();
    }
    let corners = corners(&arc, tolerance);
    let mut result = balanced(&arc, &corners, tolerance, Ends::Fixed);
    if is_backward {
        result.reverse();
    }
    result
}

/// A closed border without points that lie within the tolerance of the line between others; both directions give the same
/// points.
pub(super) fn simplified_loop(points: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let first = (0..points.len()).min_by(|a, b| order(points[*a], points[*b]));
    let Some(first) = first.filter(|_| points.len() > 3) else {
        return points.to_vec();
    };
    let mut ring = points.to_vec();
    ring.rotate_left(first);
    let is_backward = order(ring[1], ring[ring.len() - 1]).is_gt();
    if is_backward {
        ring[1..].reverse();
    }
    // The point farthest from any point of a round shape is as good as any other; that of a polygon is a corner.
    let start = farthest_from(&ring, ring[0]);
    ring.rotate_left(start);
    let middle = farthest_from(&ring, ring[0]);
    ring.push(ring[0]);
    let mut kept = corners(&ring[..=middle], tolerance);
    let rest = corners(&ring[middle..], tolerance);
    kept.extend(rest.into_iter().skip(1).map(|index| index + middle));
    let mut result = balanced(&ring, &kept, tolerance, Ends::Joined);
    result.pop();
    if is_backward {
        result.reverse();
    }
    result
}

fn order(a: DVec2, b: DVec2) -> std::cmp::Ordering {
    a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x))
}

fn farthest_from(points: &[DVec2], from: DVec2) -> usize {
    let distance = |index: &usize| points[*index].distance_squared(from);
    (0..points.len())
        .max_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0)
}

/// The indices of the points at corners, the ends included.
fn corners(line: &[DVec2], tolerance: f64) -> Vec<usize> {
    simplify(line.len(), |from, to| {
        let edge = line[to] - line[from];
        let length = edge.length_squared();
        let distance = |index: usize| {
            let to_point = line[index] - line[from];
            if length > 0.0 {
                let along = (to_point.dot(edge) / length).clamp(0.0, 1.0);
                (to_point - edge * along).length_squared()
            } else {
                to_point.length_squared()
            }
        };
        let mut farthest = (tolerance * tolerance, None);
        for index in from + 1..to {
            let distance = distance(index);
            if distance > farthest.0 {
                farthest = (distance, Some(index));
            }
        }
        farthest.1
    })
}

/// An edge between kept points.
#[derive(Debug, Clone, Copy)]
struct Edge {
    /// A point of the line through the middle of the points that the edge stands for.
    middle: DVec2,
    /// Its direction.
    along: DVec2,
}

/// The kept points, moved so that each edge runs through the middle of the points it stands for: chords of a curve would make
/// round shapes smaller.
fn balanced(line: &[DVec2], kept: &[usize], tolerance: f64, ends: Ends) -> Vec<DVec2> {
    let edges: Vec<Edge> = kept
        .windows(2)
        .map(|ends| fitted(&line[ends[0]..=ends[1]]))
        .collect();
    let mut result: Vec<DVec2> = kept.iter().map(|index| line[*index]).collect();
    let last = result.len() - 1;
    let is_closed = last > 1 && ends == Ends::Joined;
    for corner in 0..last {
        let before = match corner {
            0 if is_closed => edges[last - 1],
            0 => continue,
            _ => edges[corner - 1],
        };
        let from = result[corner];
        result[corner] = from + shift(from, before, edges[corner], tolerance);
    }
    if is_closed {
        result[last] = result[0];
    }
    sharpened(result, is_closed)
}

/// The line nearest to points (total least squares); for few points, the chord moved to their middle. The ends of a long edge are
/// left out, because pixels cut off corners.
fn fitted(points: &[DVec2]) -> Edge {
    let (first, last) = (points[0], points[points.len() - 1]);
    let chord = (last - first).normalize_or_zero();
    let inner = if points.len() >= LONG {
        &points[TRIM..points.len() - TRIM]
    } else {
        points
    };
    // Each stretch between two points counts by its length, so that unequal steps do not matter.
    let (mut length, mut sum) = (0.0, DVec2::ZERO);
    for pair in inner.windows(2) {
        let step = pair[0].distance(pair[1]);
        length += step;
        sum += (pair[0] + pair[1]) / 2.0 * step;
    }
    if length <= 0.0 {
        return Edge {
            middle: first,
            along: chord,
        };
    }
    let middle = sum / length;
    let mut along = chord;
    if points.len() >= LONG {
        // How the heights over the chord rise along it.
        let (mut products, mut squares) = (0.0, 0.0);
        for point in inner {
            let (x, y) = (chord.dot(*point - middle), chord.perp_dot(*point - middle));
            products += x * y;
            squares += x * x;
        }
        let slope = if squares > 0.0 {
            products / squares
        } else {
            0.0
        };
        along = (chord + chord.perp() * slope).normalize_or_zero();
    }
    Edge { middle, along }
}

/// How far a corner moves to where its edges' lines meet, or, if they are nearly one line, to their middle.
fn shift(corner: DVec2, before: Edge, after: Edge, tolerance: f64) -> DVec2 {
    let turn = before.along.perp_dot(after.along);
    if turn.abs() >= STRAIGHT {
        let along = (after.middle - before.middle).perp_dot(after.along) / turn;
        let moved = before.middle + before.along * along - corner;
        if moved.length() <= CUT {
            return moved;
        }
    }
    let off = |edge: Edge| {
        let normal = edge.along.perp();
        normal * normal.dot(edge.middle - corner)
    };
    ((off(before) + off(after)) / 2.0).clamp_length_max(tolerance)
}

/// The line with the corners that pixels cut off: where two edges meet beyond a short one, their common point replaces it.
fn sharpened(line: Vec<DVec2>, is_closed: bool) -> Vec<DVec2> {
    let count = line.len() - 1;
    let shortest = if is_closed { 4 } else { 3 };
    if count < shortest {
        return line;
    }
    let at = |index: usize| line[if is_closed { index % count } else { index }];
    // Of each edge, where its neighbours meet.
    let tip = |edge: usize| {
        let before = match edge {
            0 if is_closed => at(count - 1),
            0 => return None,
            _ => at(edge - 1),
        };
        let (a, b) = (at(edge), at(edge + 1));
        if edge + 2 > count && !is_closed {
            return None;
        }
        let after = at(edge + 2);
        let (into, out) = (a - before, b - after);
        let turn = into.perp_dot(out);
        let length = a.distance(b);
        let is_short = length < CUT && into.length() > 2.0 * length && out.length() > 2.0 * length;
        if !is_short || turn.abs() < STRAIGHT * into.length() * out.length() {
            return None;
        }
        let along = (b - a).perp_dot(out) / turn;
        let tip = a + into * along;
        (along > 0.0 && tip.distance((a + b) / 2.0) < CUT).then_some(tip)
    };
    let tips: Vec<Option<DVec2>> = (0..count).map(tip).collect();
    let mut result = Vec::with_capacity(line.len());
    for index in 0..count {
        let before = match index {
            0 if is_closed => tips[count - 1],
            0 => None,
            _ => tips[index - 1],
        };
        match (before, tips[index]) {
            // The tip was added for the edge before.
            (Some(_), _) => {}
            (None, Some(tip)) => result.push(tip),
            (None, None) => result.push(line[index]),
        }
    }
    if is_closed {
        result.extend(result.first().copied())
    } else {
        result.push(line[count])
    }
    result
}
