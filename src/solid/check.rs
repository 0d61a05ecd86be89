//! Checks of closed surfaces, for tests.

use std::collections::HashMap;

use crate::scene::Surface;

/// Checks that every directed edge and its reverse occur exactly once, with corners at the same
/// position merged.
///
/// # Errors
/// An edge or a triangle that breaks the rule.
pub(crate) fn closed(surface: &Surface) -> Result<(), String> {
    let mut ids = HashMap::new();
    let welded: Vec<usize> = surface
        .positions
        .iter()
        .map(|p| {
            // The sum maps -0.0 to 0.0.
            let next = ids.len();
            *ids.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    let mut edges: HashMap<[usize; 2], usize> = HashMap::new();
    for triangle in &surface.triangles {
        let corner = |i: usize| {
            let corner = triangle[i] as usize;
            welded
                .get(corner)
                .copied()
                .ok_or_else(|| format!("corner {corner} does not exist"))
        };
        let [a, b, c] = [corner(0)?, corner(1)?, corner(2)?];
        if a == b || b == c || c == a {
            return Err(format!(
                "triangle {triangle:?} has two corners in one place"
            ));
        }
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    for triangle in &surface.triangles {
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let [from, to] = [triangle[from] as usize, triangle[to] as usize];
            let [a, b] = [welded[from], welded[to]];
            for edge in [[a, b], [b, a]] {
                let count = edges.get(&edge).copied().unwrap_or(0);
                if count != 1 {
                    let [p, q] = [surface.positions[from], surface.positions[to]];
                    return Err(format!("edge {p:?} {q:?} occurs {count} times one way"));
                }
            }
        }
    }
    Ok(())
}

/// The enclosed volume, positive where the surface is wound outward.
pub(crate) fn volume(surface: &Surface) -> f64 {
    let at = |i: u32| glam::Vec3::from(surface.positions[i as usize]).as_dvec3();
    let Some(first) = surface.positions.first() else {
        return 0.0;
    };
    let origin = glam::Vec3::from(*first).as_dvec3();
    let tetrahedron = |[a, b, c]: [glam::DVec3; 3]| a.dot(b.cross(c)) / 6.0;
    surface
        .triangles
        .iter()
        .map(|t| tetrahedron(t.map(|i| at(i) - origin)))
        .sum()
}
