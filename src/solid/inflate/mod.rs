//! Outlines blown up like a balloon (language.md, Shapes).
//!
//! The height over a point is 2√u, scaled so that the highest has the height that is asked for, where
//! Δu = −1 inside the outline and u = 0 on its border. Over a disc this is a sphere, or a spheroid; over a bar
//! an elliptic cylinder; thin limbs come out thinner than the trunk, and near the border the surface is upright,
//! so that both sides meet without an edge. Nothing in it hangs on where the outline's points are.

mod mesh;
mod points;
mod poisson;

use glam::DVec2;

use super::Options;
use super::groups::Crease;
use super::layers::{THIN, steps_per_half_turn};
use super::shade::shade;
use super::stack::Put;
use crate::geometry::Outline;
use crate::scene::Surface;

/// The least height over a point inside, relative to depths, that `f32` can tell from 0.
const FINE: f64 = 1e-6;

/// The surface over both sides of an outline whose box has these half extents. Its highest points have the height
/// that is given, drawing units.
///
/// Without one they are as high as the field itself is, a ball over a disc and about 0.7 of its width over a narrow
/// bar, but no higher than half the box's smaller side: what is thin everywhere, a ring or a letter, stays thin.
pub(super) fn inflate(
    outline: &Outline,
    given: Option<f64>,
    half: DVec2,
    options: &Options,
) -> Surface {
    let most = height(given, half);
    let put = Put::new(options);
    let points = points::points(outline, steps_per_half_turn(options));
    let mesh = mesh::mesh(&points, &put);
    let Some(first) = mesh.points.first() else {
        return Surface::default();
    };

    // Relative to one of the points and to the extent, so that products neither lose digits nor overflow.
    let flat = |[x, y]: &[f32; 2]| DVec2::new((*x).into(), (*y).into());
    let origin = flat(first);
    let distances = mesh
        .points
        .iter()
        .map(|p| (flat(p) - origin).abs().max_element());
    let extent = distances.fold(f64::MIN_POSITIVE, f64::max);
    let plane: Vec<DVec2> = mesh
        .points
        .iter()
        .map(|p| (flat(p) - origin) / extent)
        .collect();
    let field = poisson::solve(&plane, &mesh.triangles, &mesh.on_border);
    let highest = field.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let own = 2.0 * highest.sqrt() * extent / options.placement.scale;
    let height = if given.is_none() { most.min(own) } else { most };

    let least = (FINE * options.placement.translation.z.abs()).max(FINE * height);
    let middle = put.depth(0.0);
    let mut written = Vec::with_capacity(2 * plane.len());
    let mut back: Vec<u32> = (0..plane.len() as u32).collect();
    let heights: Vec<f64> = field
        .iter()
        .map(|u| ((u / highest).max(0.0).sqrt() * height).max(least))
        .collect();
    for (i, [x, y]) in mesh.points.iter().enumerate() {
        written.push([
            *x,
            *y,
            if mesh.on_border[i] {
                middle
            } else {
                put.depth(heights[i])
            },
        ]);
    }
    for (i, [x, y]) in mesh.points.iter().enumerate() {
        if !mesh.on_border[i] {
            back[i] = written.len() as u32;
            written.push([*x, *y, put.depth(-heights[i])]);
        }
    }
    let mut triangles = mesh.triangles;
    let behind: Vec<[u32; 3]> = triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|i| back[i as usize]);
            [a, c, b]
        })
        .collect();
    triangles.extend(behind);
    // There are no edges but those of the steps: they are all smooth, or all are seen.
    let step = 180.0 / f64::from(steps_per_half_turn(options));
    let crease = if options.crease > step {
        180.0
    } else {
        options.crease
    };
    shade(&written, &triangles, Crease::new(crease), |_| false)
}

/// How high an outline is blown up at most whose box has these half extents, drawing units.
pub(super) fn height(given: Option<f64>, half: DVec2) -> f64 {
    let given = given.map(|h| if h.is_finite() { h.abs() } else { 0.0 });
    given
        .unwrap_or(half.min_element())
        .max(THIN * half.max_element())
}

#[cfg(test)]
mod tests;
