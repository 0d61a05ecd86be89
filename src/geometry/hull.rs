//! Convex hulls.

use glam::DVec2;

use super::Ring;

/// The convex hull of some points (Andrew's monotone chain), in the direction in which x turns into y; empty for fewer than three.
pub(crate) fn convex_hull(mut points: Vec<DVec2>) -> Ring {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Ring = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut ring = chain(&mut points.iter().copied());
    ring.extend(chain(&mut points.iter().rev().copied()));
    if ring.len() < 3 { Ring::new() } else { ring }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_outermost_points_in_order() {
        let points = [
            (1.0, 1.0),
            (0.0, 0.0),
            (2.0, 2.0),
            (2.0, 0.0),
            (0.0, 2.0),
            (1.0, 0.0),
        ];
        let points = points.map(|(x, y)| DVec2::new(x, y)).to_vec();
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let corners = corners.map(|(x, y)| DVec2::new(x, y)).to_vec();
        assert_eq!(convex_hull(points.clone()), corners);
        assert!(convex_hull(points[..3].to_vec()).is_empty());
        assert!(convex_hull(Vec::new()).is_empty());
    }
}
