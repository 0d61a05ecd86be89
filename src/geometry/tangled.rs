//! Recognises rings that cross themselves so often that finding their area would take very long.

use glam::{DVec2, Vec2Swizzles as _};

use super::Ring;

/// How often the edges of an outline may cross. An area with more crossings is in as many pieces.
pub const MAX_CROSSINGS: usize = 20_000;

/// How many pairs of edges are compared. Rings with more edges above each other that hardly cross are let through.
const MAX_PAIRS: usize = 1 << 26;

/// Whether the edges of rings cross more than [`MAX_CROSSINGS`] times: sweep and prune along the axis along which edges
/// are shorter.
pub fn is_tangled(rings: &[Ring]) -> bool {
    let count: usize = rings.iter().map(Vec::len).sum();
    // Fewer edges cannot cross so often.
    if count.saturating_mul(count) / 2 <= MAX_CROSSINGS {
        return false;
    }
    let mut edges: Vec<[DVec2; 2]> = Vec::with_capacity(count);
    for ring in rings {
        let mut from = ring.last().copied().unwrap_or_default();
        for &to in ring {
            edges.push([from, to]);
            from = to;
        }
    }
    let extent: DVec2 = edges.iter().map(|[from, to]| (*to - *from).abs()).sum();
    for edge in &mut edges {
        if extent.y < extent.x {
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
            if crossings > MAX_CROSSINGS {
                return true;
            }
        }
        if pairs > MAX_PAIRS {
            return false;
        }
    }
    false
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
    use crate::geometry::{FillRule, resolve_overlaps};

    /// A star whose every edge passes by the middle: nearly all pairs of edges cross.
    fn star(points: usize) -> Ring {
        let step = (points / 2 - 1) as f64 * std::f64::consts::TAU / points as f64;
        (0..points)
            .map(|index| 100.0 * DVec2::from_angle(index as f64 * step))
            .collect()
    }

    #[test]
    fn stars_are_tangled_from_some_number_of_points() {
        assert!(!is_tangled(&[star(101)]));
        assert!(is_tangled(&[star(401)]));
        assert!(is_tangled(&[star(40_001)]));
        let outline = resolve_overlaps(vec![star(101)], FillRule::NonZero);
        assert!(!outline.polygons.is_empty());
        assert!(
            resolve_overlaps(vec![star(4001)], FillRule::EvenOdd)
                .polygons
                .is_empty()
        );
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
            assert!(!is_tangled(&[upright]));
            assert!(!is_tangled(&[lying]));
        }
    }
}
