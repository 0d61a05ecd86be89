//! Drawn lines as meshes that keep their width.

use crate::math;
use glam::DVec2;

use super::Morph;
use super::contour::{Contour, Ends};
use super::simplify::{Limits, simplify};
use super::unite::unite;

/// Joins turn by at most this at a time, radians.
const JOIN_TURN: f64 = 0.6;
/// At most so many points at a join.
const MAX_JOIN: usize = 6;
/// Where the points of a round end are, half turns from the line's side.
const END_ANGLES: [f64; 3] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 6.0];
/// The inner side of a join is at most this many half widths away.
const MAX_MITER: f64 = 10.0;
/// Points that are closer are at the same place, relative to the line's extent.
const SAME_POINT: f64 = 1e-9;
/// Larger coordinates are not drawn geometry: their squares would overflow.
const MAX_COORDINATE: f64 = 1e60;
/// The points of an inner line.
const LIMITS: Limits = Limits {
    fine: 5e-5,
    few: 64,
    coarse: 4e-4,
    many: 512,
};

/// The same points on an inner line in all views, in the order of the line, with the ends fixed. A line that is drawn the other
/// way round in a view is turned. In a view where the line has no length all points are the same.
pub(crate) fn match_lines(views: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let is_drawn = |p: &DVec2| p.is_finite() && p.abs().max_element() < MAX_COORDINATE;
    let mut lines: Vec<Vec<DVec2>> = (views.iter())
        .map(|line| line.iter().copied().filter(is_drawn).collect())
        .collect();
    let extents: Vec<f64> = (lines.iter())
        .map(|line| middle_and_extent(line).1)
        .collect();
    let home = extents.iter().position(|e| *e > 0.0).unwrap_or(0);
    let ends = |line: &[DVec2]| {
        let (middle, extent) = middle_and_extent(line);
        let end = |p: Option<&DVec2>| p.map_or(DVec2::ZERO, |p| (*p - middle) / extent);
        [end(line.first()), end(line.last())]
    };
    let first = lines.get(home).map(|line| ends(line)).unwrap_or_default();
    for line in &mut lines {
        let [from, to] = ends(line);
        let straight = first[0].distance_squared(from) + first[1].distance_squared(to);
        let turned = first[0].distance_squared(to) + first[1].distance_squared(from);
        if turned < straight {
            line.reverse();
        }
    }
    let contours: Vec<Option<Contour>> = (lines.iter())
        .map(|line| Contour::new(line, Ends::Free))
        .collect();
    let spots: Vec<DVec2> = lines.iter().map(|line| middle_and_extent(line).0).collect();
    let points = unite(&contours, &[], &spots);
    let kept = simplify(std::slice::from_ref(&points), &extents, LIMITS, Ends::Free);
    let kept = kept.first().map_or(&[][..], Vec::as_slice);
    let each = points.iter();
    each.map(|line| kept.iter().map(|i| line[*i]).collect())
        .collect()
}

fn middle_and_extent(line: &[DVec2]) -> (DVec2, f64) {
    let Some(first) = line.first() else {
        return (DVec2::ZERO, 0.0);
    };
    let bounds = line.iter();
    let (low, high) = bounds.fold((*first, *first), |(low, high), p| {
        (low.min(*p), high.max(*p))
    });
    (low.midpoint(high), (high - low).max_element())
}

/// A stroke along corresponding points (one of a [`Morph`]'s rings, or what [`match_lines`] returns) with a width for each
/// view, drawing units. Corners and free ends are round. The topology is that of all views: a corner has as many points
/// everywhere as it needs where it is sharpest.
///
/// Between views the width is the blend of the views' widths, less where the line turns: by 1.5 % halfway through a turn of 20°.
/// In a view where all points are the same, the mesh is a point.
pub(crate) fn line_mesh(points: &[Vec<DVec2>], widths: &[f64], ends: Ends) -> Morph {
    let count = points.iter().map(Vec::len).min().unwrap_or(0);
    let mut morph = Morph {
        points: vec![Vec::new(); points.len()].into(),
        ..Morph::default()
    };
    let is_drawn = |p: &DVec2| p.is_finite() && p.abs().max_element() < MAX_COORDINATE;
    if count < 2 || !points.iter().flatten().all(is_drawn) {
        return morph;
    }
    let y_up = |line: &Vec<DVec2>| {
        let points = line.iter().take(count);
        points.map(|p| DVec2::new(p.x, -p.y)).collect()
    };
    let lines: Vec<Vec<DVec2>> = points.iter().map(y_up).collect();
    let joins: Vec<Vec<Join>> = lines.iter().map(|line| joins(line, ends)).collect();
    // How many cross-sections each point has, so that no view turns too far between two.
    let mut sections = vec![1; count];
    for joins in &joins {
        for join in joins {
            let turns = (join.turn().abs() / JOIN_TURN).floor() as usize;
            let wanted = if turns == 0 {
                1
            } else {
                (turns + 2).min(MAX_JOIN)
            };
            let own: usize = (0..join.count)
                .map(|i| sections[(join.first + i) % count])
                .sum();
            sections[join.first] += wanted.saturating_sub(own);
        }
    }
    for (view, all) in morph.points.raw.iter_mut().enumerate() {
        let width = widths.get(view).copied().unwrap_or(0.0);
        let half = if width.is_finite() {
            width.max(0.0) / 2.0
        } else {
            0.0
        };
        let sides = sides(&lines[view], &joins[view], &sections, half, ends);
        let y_down = |p: DVec2| DVec2::new(p.x, -p.y);
        all.extend(sides.into_iter().flatten().map(y_down));
    }

    let total = morph.points.first().map_or(0, Vec::len) as u32 / 2;
    let last = if ends == Ends::Joined {
        total
    } else {
        total - 1
    };
    for from in 0..last {
        let to = (from + 1) % total;
        let [left, right, left_to, right_to] = [2 * from, 2 * from + 1, 2 * to, 2 * to + 1];
        morph.triangles.push([right, right_to, left_to]);
        morph.triangles.push([right, left_to, left]);
    }
    let right = (0..total).map(|i| 2 * i + 1);
    let left = (0..total).rev().map(|i| 2 * i);
    morph.rings = match ends {
        Ends::Joined => vec![right.collect(), left.collect()],
        Ends::Free => vec![right.chain(left).collect()],
    };
    morph
}

/// One or more points of a line at the same place.
struct Join {
    first: usize,
    count: usize,
    /// The directions in which the line comes and goes.
    along: [DVec2; 2],
    /// The length of the shorter edge beside it.
    beside: f64,
}

impl Join {
    /// Positive to the left, radians.
    fn turn(&self) -> f64 {
        let [before, after] = self.along;
        math::atan2(before.perp_dot(after), before.dot(after))
    }
}

/// The places of a line in order; none if all are the same.
fn joins(line: &[DVec2], ends: Ends) -> Vec<Join> {
    let count = line.len();
    let near = SAME_POINT * middle_and_extent(line).1;
    let is_new = |i: usize| line[i].distance(line[(i + count - 1) % count]) > near;
    let start = match ends {
        Ends::Joined => (0..count).find(|i| is_new(*i)),
        Ends::Free => (1..count).any(is_new).then_some(0),
    };
    let Some(start) = start else {
        return Vec::new();
    };
    let mut joins: Vec<Join> = Vec::new();
    for i in 0..count {
        let index = (start + i) % count;
        match joins.last_mut() {
            Some(join) if !is_new(index) => join.count += 1,
            _ => joins.push(Join {
                first: index,
                count: 1,
                along: [DVec2::ZERO; 2],
                beside: f64::INFINITY,
            }),
        }
    }
    let places = joins.len();
    for i in 0..places {
        if ends == Ends::Free && i + 1 == places {
            continue;
        }
        let next = (i + 1) % places;
        let edge = line[joins[next].first] - line[joins[i].first];
        let direction = edge.normalize_or_zero();
        joins[i].along[1] = direction;
        joins[next].along[0] = direction;
        for join in [i, next] {
            joins[join].beside = joins[join].beside.min(edge.length());
        }
    }
    if ends == Ends::Free {
        joins[0].along[0] = joins[0].along[1];
        joins[places - 1].along[1] = joins[places - 1].along[0];
    }
    joins
}

/// The left and the right end of every cross-section, in the order of the points.
fn sides(
    line: &[DVec2],
    joins: &[Join],
    sections: &[usize],
    half: f64,
    ends: Ends,
) -> Vec<[DVec2; 2]> {
    let count = line.len();
    let mut of_point: Vec<Vec<[DVec2; 2]>> = line
        .iter()
        .zip(sections)
        .map(|(p, sections)| vec![[*p; 2]; *sections])
        .collect();
    for join in joins {
        let turn = join.turn();
        let indices = (0..join.count).map(|i| (join.first + i) % count);
        let total: usize = indices.clone().map(|i| sections[i]).sum();
        let normal = join.along[0].perp();
        let half_turn = math::cos(turn / 2.0).max(1.0 / MAX_MITER);
        let miter = (half / half_turn).min(math::hypot(half, join.beside));
        let inner = math::direction(turn / 2.0).rotate(normal) * miter;
        let mut number = 0;
        for point in indices {
            for section in &mut of_point[point] {
                let place = line[point];
                *section = if total == 1 {
                    [place + inner, place - inner]
                } else {
                    let share = number as f64 / (total - 1) as f64;
                    let outer = math::direction(turn * share).rotate(normal) * half;
                    // The outer side is the right one where the line turns left.
                    if turn > 0.0 {
                        [place + inner, place - outer]
                    } else {
                        [place + outer, place - inner]
                    }
                };
                number += 1;
            }
        }
    }
    let mut sides: Vec<[DVec2; 2]> = of_point.concat();
    if ends == Ends::Free {
        let along = joins.first().map_or(DVec2::ZERO, |join| join.along[1]);
        let start = round_end(line[0], -along, half).map(|[left, right]| [right, left]);
        let along = joins.last().map_or(DVec2::ZERO, |join| join.along[0]);
        let end = round_end(line[count - 1], along, half);
        let end = end.into_iter().rev();
        sides = start.into_iter().chain(sides).chain(end).collect();
    }
    sides
}

/// Cross-sections of a half disc, from its tip on.
fn round_end(place: DVec2, along: DVec2, half: f64) -> [[DVec2; 2]; END_ANGLES.len()] {
    END_ANGLES.map(|angle| {
        let (sin, cos) = math::sin_cos(angle * std::f64::consts::PI);
        let middle = place + along * (half * sin);
        let side = along.perp() * (half * cos);
        [middle + side, middle - side]
    })
}
