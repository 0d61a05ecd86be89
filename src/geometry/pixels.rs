//! Outlines of what is solid in a picture.

use glam::DVec2;
use rustc_hash::FxHashSet;

use super::{Ring, simplify};
use crate::regions::{Side, follow};

/// How far the outline may deviate from the pixels' edges, in pixels: enough to smooth the steps of slanted borders.
const BORDER_TOLERANCE: f64 = 0.75;

/// The rings of pixel edges between solid and other pixels, with the solid side on the right, simplified. The unit is a pixel, y
/// is down.
pub(crate) fn pixel_borders(
    width: u32,
    height: u32,
    is_solid: impl Fn(u32, u32) -> bool,
) -> Vec<Ring> {
    // In a picture with one more pixel on each side, which is not solid.
    let padded = width as usize + 2;
    let is_inside = |at: usize| {
        let (x, y) = (at % padded, at / padded);
        let is_in_picture = x > 0 && y > 0 && x <= width as usize && y <= height as usize;
        is_in_picture && is_solid(x as u32 - 1, y as u32 - 1)
    };
    // Pixels whose upper sides are in a ring.
    let mut seen: FxHashSet<usize> = FxHashSet::default();
    let mut rings = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let inner = (y as usize + 1) * padded + x as usize + 1;
            let is_start = is_solid(x, y) && (y == 0 || !is_solid(x, y - 1));
            if !is_start || seen.contains(&inner) {
                continue;
            }
            let mut ring = Vec::new();
            let outer = inner - padded;
            follow(Side { inner, outer }, padded, is_inside, |side| {
                let corner = match side.ahead(padded) {
                    1 => {
                        seen.insert(side.inner);
                        DVec2::ZERO
                    }
                    -1 => DVec2::ONE,
                    down if down > 0 => DVec2::X,
                    _ => DVec2::Y,
                };
                let (x, y) = (side.inner % padded - 1, side.inner / padded - 1);
                ring.push(DVec2::new(x as f64, y as f64) + corner);
            });
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
        let distance = |p: DVec2| {
            if direction == DVec2::ZERO {
                p.distance(line[from])
            } else {
                direction.perp_dot(p - line[from]).abs()
            }
        };
        let farthest =
            (from + 1..to).max_by(|a, b| distance(line[*a]).total_cmp(&distance(line[*b])));
        farthest.filter(|index| distance(line[*index]) > BORDER_TOLERANCE)
    });
    kept.into_iter().map(|index| line[index]).collect()
}
