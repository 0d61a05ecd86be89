//! Outlines of what is solid in a picture.

use glam::DVec2;
use rustc_hash::FxHashMap;

use super::{Ring, simplify};

/// How far the outline may deviate from the pixels' edges, in pixels: enough to smooth the steps of slanted borders.
const BORDER_TOLERANCE: f64 = 0.75;

/// The rings of pixel edges between solid and other pixels, with the solid side on the right, simplified. The unit is a pixel, y
/// is down.
pub fn pixel_borders(width: u32, height: u32, is_solid: impl Fn(u32, u32) -> bool) -> Vec<Ring> {
    let (width, height) = (i64::from(width), i64::from(height));
    let solid = |x: i64, y: i64| {
        x >= 0 && y >= 0 && x < width && y < height && is_solid(x as u32, y as u32)
    };
    // An edge is identified by its start and direction: 0 right, 1 down, 2 left, 3 up.
    let step = [(1, 0), (0, 1), (-1, 0), (0, -1)];
    let has = |x: i64, y: i64, direction: usize| match direction {
        0 => solid(x, y) && !solid(x, y - 1),
        1 => solid(x - 1, y) && !solid(x, y),
        2 => solid(x - 1, y - 1) && !solid(x - 1, y),
        _ => solid(x, y - 1) && !solid(x - 1, y - 1),
    };
    let mut seen: FxHashMap<(i64, i64), u8> = FxHashMap::default();
    let mut rings = Vec::new();
    for y in 0..=height {
        for x in 0..=width {
            let visited = seen.get(&(x, y)).is_some_and(|bits| bits & 1 != 0);
            if !has(x, y, 0) || visited {
                continue;
            }
            let mut ring = Vec::new();
            let (mut at, mut direction) = ((x, y), 0_usize);
            loop {
                let bits = seen.entry(at).or_default();
                if *bits & (1 << direction) != 0 {
                    break;
                }
                *bits |= 1 << direction;
                ring.push(DVec2::new(at.0 as f64, at.1 as f64));
                at = (at.0 + step[direction].0, at.1 + step[direction].1);
                // Turning right first separates pixels that touch only at a corner.
                let turns = [(direction + 1) % 4, direction, (direction + 3) % 4];
                match turns.into_iter().find(|turn| has(at.0, at.1, *turn)) {
                    Some(turn) => direction = turn,
                    None => break,
                }
            }
            rings.push(smoothed(&ring));
        }
    }
    rings.retain(|ring| ring.len() > 2);
    rings
}

/// A ring without the points that matter little, split at its first point and the point farthest from it.
fn smoothed(ring: &[DVec2]) -> Ring {
    let Some(first) = ring.first() else {
        return Ring::new();
    };
    let far = (0..ring.len())
        .max_by(|a, b| {
            first
                .distance_squared(ring[*a])
                .total_cmp(&first.distance_squared(ring[*b]))
        })
        .unwrap_or(0);
    let mut out = halves(&ring[..=far]);
    let mut back = ring[far..].to_vec();
    back.push(*first);
    out.pop();
    out.extend(halves(&back));
    out.pop();
    out
}

fn halves(line: &[DVec2]) -> Vec<DVec2> {
    let kept = simplify(line.len(), |from, to| {
        let direction = (line[to] - line[from]).normalize_or_zero();
        let distance = |p: DVec2| match direction == DVec2::ZERO {
            true => p.distance(line[from]),
            false => direction.perp_dot(p - line[from]).abs(),
        };
        let farthest =
            (from + 1..to).max_by(|a, b| distance(line[*a]).total_cmp(&distance(line[*b])));
        farthest.filter(|index| distance(line[*index]) > BORDER_TOLERANCE)
    });
    kept.into_iter().map(|index| line[index]).collect()
}
