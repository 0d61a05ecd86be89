//! Outlines of what is solid in a picture.

use glam::DVec2;
use rustc_hash::FxHashSet;

use super::{Ring, simplify};
use crate::regions::{Side, follow};

/// How far the outline may deviate from the pixels' edges, in pixels: enough to smooth the steps of slanted borders.
const BORDER_TOLERANCE: f64 = 0.75;
/// Of a longer line, pieces are simplified each by itself: the time for one that winds grows with the square of its length.
const MAX_LINE: usize = 8192;
const PIECE: usize = 1024;

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
    let mut out = simplified(&ring[..=far]);
    let mut back = ring[far..].to_vec();
    back.push(*first);
    out.extend(simplified(&back));
    out
}

/// The points of a line that matter, without its last one.
fn simplified(line: &[DVec2]) -> Vec<DVec2> {
    let mut out = Vec::new();
    let length = if line.len() > MAX_LINE {
        PIECE
    } else {
        line.len().max(2)
    };
    // Each piece begins where the one before it ends.
    for start in (0..line.len() - 1).step_by(length - 1) {
        let end = (start + length).min(line.len());
        let mut kept = kept(&line[start..end]);
        kept.pop();
        out.append(&mut kept);
    }
    out
}

/// The points of a line that matter, with both ends.
fn kept(line: &[DVec2]) -> Vec<DVec2> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::query::shoelace;

    #[test]
    fn long_borders_lose_nothing() {
        let (width, height) = (201, 150);
        let is_solid = |x: u32, y: u32| x.is_multiple_of(2) || y == height - 1;
        let borders = pixel_borders(width, height, is_solid);
        let [border] = &borders[..] else {
            panic!("a comb has one border");
        };
        let steps = border.iter().zip(border.iter().cycle().skip(1));
        let length: f64 = steps.map(|(from, to)| from.distance(*to)).sum();
        assert!(length > 2.0 * MAX_LINE as f64, "{length}");
        let pixels = (0..width).flat_map(|x| (0..height).map(move |y| (x, y)));
        let solid = pixels.filter(|(x, y)| is_solid(*x, *y)).count();
        assert_eq!(shoelace(border).abs(), solid as f64);
    }
}
