//! Gaps in outlines, through which one area would run into another of the same colour.
//!
//! A ball that is wider than a gap does not pass it (trapped-ball segmentation, Zhang et al. 2009); but nor does it pass a thin arm. So
//! lines are followed to where they end, and an end is joined to another one that faces it, or to a line before it, if that parts an area
//! in two of which each has room for more than the gap. The join is a border and no ink: the picture keeps its gap.

use super::Seen;
use super::canvas::{Canvas, PAD};
use super::components::components;
use super::ink::{Ink, Part};
use super::palette::NONE;
use super::seeds::min_area;
use crate::math;
use glam::DVec2;

/// The longest gap, in the height of what is inked.
const LONGEST: f64 = 0.03;
/// The least cosine of the angles between a gap and the lines that end at it.
const FACING: f64 = 0.3;
/// The directions, degrees from its own, in which a line that ends looks for another line.
const AHEAD: [f64; 7] = [0.0, 10.0, -10.0, 20.0, -20.0, 35.0, -35.0];
/// The length of a line that tells its direction, in its half-width, and the least length of one that is no corner of a line, pixels more.
const BACK: f64 = 4.0;
const SHORTEST: (f64, f64) = (2.0, 2.0);
/// The greatest share of an area's border that gaps take, and the least side of a square in it, in the longest gap that is closed.
const MOST_OF_BORDER: f64 = 0.3;
const ROOM: f64 = 0.6;
/// The same in each of its gaps.
const ROOM_OF_GAP: f64 = 1.25;
/// Drawings with more ends of lines are hatched.
const MOST_ENDS: usize = 2000;
/// How often joins that part nothing are left out.
const ROUNDS: usize = 6;
/// How far beside a join the areas are looked for, pixels.
const BESIDE: f64 = 4.0;

/// The end of a line.
#[derive(Clone, Copy)]
struct End {
    at: usize,
    /// Pixels.
    place: DVec2,
    /// Away from the line.
    direction: DVec2,
    /// Half the line's width, pixels.
    half: f64,
}

/// A gap that may be closed.
struct Join {
    ends: [DVec2; 2],
    /// Its pixels without ink.
    pixels: Vec<usize>,
}

/// The classes of pixels with the gaps between lines closed by pixels without a class; `None` if there are no gaps.
pub(super) fn closed(seen: &Seen<'_>, ink: &Ink) -> Option<Vec<u16>> {
    let canvas = seen.canvas;
    let middle = middle_lines(canvas, ink);
    let ends = ends(canvas, ink, &middle);
    if ends.is_empty() || ends.len() > MOST_ENDS {
        return None;
    }
    let reach = LONGEST * inked_height(canvas, ink);
    let mut joins = joins(canvas, ink, &ends, reach);
    let mut changed = !joins.is_empty();
    for _ in 0..ROUNDS {
        if !changed {
            break;
        }
        let count = joins.len();
        drop_idle(seen, ink, &mut joins, ROOM * reach);
        changed = joins.len() < count;
    }
    (!joins.is_empty() && !changed).then(|| with_joins(seen, &joins))
}

fn with_joins(seen: &Seen<'_>, joins: &[Join]) -> Vec<u16> {
    let mut classes = seen.palette.classes.clone();
    for at in joins.iter().flat_map(|join| &join.pixels) {
        classes[*at] = NONE;
    }
    classes
}

fn place(canvas: &Canvas, at: usize) -> DVec2 {
    DVec2::new((at % canvas.width) as f64, (at / canvas.width) as f64)
}

/// The height of what is inked, pixels.
fn inked_height(canvas: &Canvas, ink: &Ink) -> f64 {
    let is_inked = |row: usize| {
        let parts = &ink.parts[row * canvas.width..][..canvas.width];
        parts.iter().any(|part| *part != Part::None)
    };
    let mut rows = (PAD..canvas.height - PAD).filter(|row| is_inked(*row));
    let first = rows.next().unwrap_or_default();
    let last = rows.next_back().unwrap_or(first);
    (last - first + 1) as f64
}

/// The eight neighbours of a pixel in the order in which they lie around it.
fn ring(canvas: &Canvas) -> [isize; 8] {
    let width = canvas.width as isize;
    [
        -width,
        1 - width,
        1,
        width + 1,
        width,
        width - 1,
        -1,
        -width - 1,
    ]
}

/// How many of a pixel's neighbours are on, and how many runs of them there are around it.
fn around(is_on: &[bool], ring: &[isize; 8], at: usize) -> (usize, usize) {
    let on = ring.map(|offset| is_on[at.wrapping_add_signed(offset)]);
    let count = on.iter().filter(|on| **on).count();
    let runs = (0..8).filter(|i| !on[*i] && on[(i + 1) % 8]).count();
    (count, runs)
}

/// By pixel whether it is on the middle of a line (thinned as by Zhang and Suen 1984), or in a dark region.
fn middle_lines(canvas: &Canvas, ink: &Ink) -> Vec<bool> {
    let ring = ring(canvas);
    let mut is_on: Vec<bool> = ink.parts.iter().map(|part| *part != Part::None).collect();
    let lines = canvas.rows().flatten();
    let mut lines: Vec<usize> = lines.filter(|at| ink.is_line(*at)).collect();
    loop {
        let mut thinned = false;
        for corners in [[[0, 2, 4], [2, 4, 6]], [[0, 2, 6], [0, 4, 6]]] {
            let can_go = |at: &usize| {
                let (count, runs) = around(&is_on, &ring, *at);
                let off = |side: usize| !is_on[at.wrapping_add_signed(ring[side])];
                (2..=6).contains(&count)
                    && runs == 1
                    && corners
                        .iter()
                        .all(|sides| sides.iter().any(|side| off(*side)))
            };
            let going: Vec<usize> = lines.iter().copied().filter(can_go).collect();
            for at in &going {
                is_on[*at] = false;
            }
            if !going.is_empty() {
                thinned = true;
                lines.retain(|at| is_on[*at]);
            }
        }
        if !thinned {
            return is_on;
        }
    }
}

/// Where lines end.
fn ends(canvas: &Canvas, ink: &Ink, is_on: &[bool]) -> Vec<End> {
    let ring = ring(canvas);
    let mut ends = Vec::new();
    for at in canvas.rows().flatten() {
        if !is_on[at] || !ink.is_line(at) {
            continue;
        }
        let (count, runs) = around(is_on, &ring, at);
        if count > 2 || runs != 1 {
            continue;
        }
        let half = f64::from(ink.depth.distance(at)) - 0.5;
        // Back along the line.
        let mut path = vec![at];
        let longest = (BACK * half).ceil() as usize + 4;
        let mut is_corner = false;
        while path.len() < longest {
            let last = path[path.len() - 1];
            let next = ring
                .iter()
                .map(|offset| last.wrapping_add_signed(*offset))
                .find(|next| is_on[*next] && !path.contains(next));
            let Some(next) = next else { break };
            path.push(next);
            if !ink.is_line(next) || around(is_on, &ring, next).1 > 2 {
                is_corner = (path.len() as f64) < SHORTEST.0 * half + SHORTEST.1;
                break;
            }
        }
        let back = place(canvas, path[path.len() - 1]);
        let own = place(canvas, at);
        let is_dot = (path.len() as f64) < SHORTEST.0 * half + SHORTEST.1;
        if let Some(direction) = (own - back)
            .try_normalize()
            .filter(|_| !is_corner && !is_dot)
        {
            ends.push(End {
                at,
                place: own,
                direction,
                half,
            });
        }
        if ends.len() > MOST_ENDS {
            break;
        }
    }
    ends
}

/// The gaps between ends of lines that face each other, and between other ends and the lines before them.
fn joins(canvas: &Canvas, ink: &Ink, ends: &[End], reach: f64) -> Vec<Join> {
    let facing = |a: &End, b: &End| {
        let way = b.place - a.place;
        let length = way.length();
        let way = way / length;
        let faces = a.direction.dot(way) >= FACING && b.direction.dot(-way) >= FACING;
        // Thinning shortens lines by about half their width.
        let is_near = length <= reach + 4.0 * (a.half + b.half) + 4.0;
        (a.at != b.at && faces && is_near).then_some(length)
    };
    let mut joins = Vec::new();
    for (index, end) in ends.iter().enumerate() {
        let others = ends.iter().enumerate();
        let near = others.filter_map(|(other, b)| Some((facing(end, b)?, other)));
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
        let to = match nearest {
            // Each pair once: from the first, or from the one whose nearest is a third.
            Some((_, other)) => Some((other, ends[other].place)),
            None => ahead(canvas, ink, end, reach).map(|to| (usize::MAX, to)),
        };
        let Some((other, to)) = to else { continue };
        let is_known = |join: &Join| join.ends == [to, end.place];
        if other < index && joins.iter().any(is_known) {
            continue;
        }
        let pixels = between(canvas, end.place, to);
        let pixels = pixels.filter(|at| ink.parts[*at] == Part::None);
        let pixels: Vec<usize> = pixels.collect();
        let step = 1.0 / (to - end.place).normalize().abs().max_element();
        if !pixels.is_empty() && pixels.len() as f64 * step <= reach + 1.0 {
            joins.push(Join {
                ends: [end.place, to],
                pixels,
            });
        }
    }
    joins
}

/// The nearest ink before the end of a line.
fn ahead(canvas: &Canvas, ink: &Ink, end: &End, reach: f64) -> Option<DVec2> {
    let along = |degrees: &f64| {
        let direction = math::direction(degrees.to_radians()).rotate(end.direction);
        let most = (reach + 2.0 * end.half).ceil() as usize + 3;
        let mut left = false;
        for step in 1..=most {
            let at = end.place + direction * step as f64;
            let [x, y] = at.round().to_array();
            let is_inside = x >= PAD as f64
                && y >= PAD as f64
                && x < (canvas.width - PAD) as f64
                && y < (canvas.height - PAD) as f64;
            if !is_inside {
                return None;
            }
            let pixel = y as usize * canvas.width + x as usize;
            let is_inked = ink.parts[pixel] != Part::None;
            if left && is_inked {
                return Some((step, DVec2::new(x, y)));
            }
            left |= !is_inked;
        }
        None
    };
    let found = AHEAD.iter().filter_map(along);
    found.min_by_key(|(step, _)| *step).map(|(_, at)| at)
}

/// The pixels of a straight line, connected over edges and corners.
fn between(canvas: &Canvas, from: DVec2, to: DVec2) -> impl Iterator<Item = usize> + use<> {
    let steps = (to - from).abs().max_element().round().max(1.0);
    let width = canvas.width;
    (0..=steps as usize).map(move |step| {
        let at = from.lerp(to, step as f64 / steps).round();
        at.y as usize * width + at.x as usize
    })
}

/// Leaves out the joins that part no area in two, each with a border that is much longer than its gaps, and with room for a square that
/// passes none of them and has at least this side.
fn drop_idle(seen: &Seen<'_>, ink: &Ink, joins: &mut Vec<Join>, room: f64) {
    let canvas = seen.canvas;
    let classes = with_joins(seen, joins);
    let (found, ids) = components(&classes, canvas.width);
    let mut borders = vec![0_u32; found.len()];
    for row in canvas.rows() {
        for at in row {
            for other in [at + 1, at + canvas.width] {
                if ids[at] != ids[other] {
                    borders[ids[at] as usize] += 1;
                    borders[ids[other] as usize] += 1;
                }
            }
        }
    }
    let is_area = |at: usize| {
        let class = classes[at];
        class != NONE && class != ink.class && ink.parts[at] == Part::None
    };
    let sides = |join: &Join| {
        let middle = join.pixels[join.pixels.len() / 2];
        let normal = (join.ends[1] - join.ends[0]).perp().try_normalize()?;
        let side = |way: f64| {
            let last = DVec2::new(canvas.width as f64, canvas.height as f64) - 1.0;
            let mut steps = (1..=BESIDE as usize).map(|step| {
                let at = place(canvas, middle) + normal * (way * step as f64);
                let at = at.round().clamp(DVec2::ZERO, last);
                at.y as usize * canvas.width + at.x as usize
            });
            steps.find(|at| is_area(*at)).map(|at| ids[at] as usize)
        };
        let both = [side(1.0)?, side(-1.0)?];
        let is_parted = both[0] != both[1] && found[both[0]].class == found[both[1]].class;
        is_parted.then_some(both)
    };
    let sides: Vec<Option<[usize; 2]>> = joins.iter().map(sides).collect();
    // Of each area the sum of its gaps and the longest.
    let mut gaps = vec![[0_usize; 2]; found.len()];
    for (join, sides) in joins.iter().zip(&sides) {
        let length = join.pixels.len();
        for side in sides.iter().flatten() {
            let [sum, longest] = gaps[*side];
            gaps[*side] = [sum + length, longest.max(length)];
        }
    }
    // The background's own border is that of the picture.
    let outside = ids[0] as usize;
    let least = min_area(canvas);
    let has_room = |side: &usize| {
        let (area, [sum, longest]) = (&found[*side], gaps[*side]);
        let square = f64::from(area.square);
        *side == outside
            || (area.area >= least
                && sum as f64 <= MOST_OF_BORDER * f64::from(borders[*side])
                && square >= (ROOM_OF_GAP * longest as f64).max(room))
    };
    let mut sides = sides.iter();
    joins.retain(|_| {
        let sides = sides.next().copied().flatten();
        sides.is_some_and(|sides| sides.iter().all(has_room))
    });
}
