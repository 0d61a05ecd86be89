//! Outlines blown up like a balloon (language.md, Shapes).
//!
//! The height over a point is 2√u, scaled to the requested maximum, where u solves the Poisson equation Δu = −1 inside the
//! outline with u = 0 on its border. Over a disc this is a sphere or a spheroid, over a bar an elliptic cylinder. Thin limbs
//! come out thinner than the trunk, and the surface is vertical at the border, so that both sides meet without an edge. The
//! result does not depend on how densely the outline is sampled.

mod mesh;
mod points;
mod poisson;

use glam::DVec2;

pub(super) use mesh::{Mesh, mesh};
pub(super) use points::Points;

use super::Options;
use super::crease::Crease;
use super::layers::{MIN_THICKNESS, steps_per_half_turn};
use super::shade::shade;
use super::stack::PlacementTransform;
use crate::geometry::Outline;
use crate::scene::Surface;

/// The smallest height over an inner point, relative to depths, that `f32` can distinguish from 0.
const MIN_HEIGHT: f64 = 1e-6;

/// The surface over both sides of an outline whose bounding box has these half extents. Its highest points have the given
/// height, drawing units.
///
/// Without a given height the field is not scaled: a ball over a disc, about 0.7 of the width over a narrow bar. The height is
/// at most half the smaller side of the box, so that a ring or a letter stays thin.
pub(super) fn inflate(
    outline: &Outline,
    given: Option<f64>,
    half: DVec2,
    options: &Options,
) -> Surface {
    let most = height(given, half);
    let transform = PlacementTransform::new(options);
    let points = points::points(outline, steps_per_half_turn(options));
    let mesh = mesh(&points, &transform);
    let Some(first) = mesh.points.first() else {
        return Surface::default();
    };

    // Relative to one of the points and to the extent, so that products neither lose precision nor overflow.
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

    let least = (MIN_HEIGHT * options.placement.translation.z.abs()).max(MIN_HEIGHT * height);
    let middle = transform.depth(0.0);
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
                transform.depth(heights[i])
            },
        ]);
    }
    for (i, [x, y]) in mesh.points.iter().enumerate() {
        if !mesh.on_border[i] {
            back[i] = written.len() as u32;
            written.push([*x, *y, transform.depth(-heights[i])]);
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
    // All edges come from the steps, so either all of them are smooth or none is.
    let step = 180.0 / f64::from(steps_per_half_turn(options));
    let crease = if options.crease > step {
        180.0
    } else {
        options.crease
    };
    shade(&written, &triangles, Crease::new(crease), |_| false)
}

/// The largest height over an outline whose bounding box has these half extents, drawing units.
pub(super) fn height(given: Option<f64>, half: DVec2) -> f64 {
    let given = given.map(|h| if h.is_finite() { h.abs() } else { 0.0 });
    given
        .unwrap_or(half.min_element())
        .max(MIN_THICKNESS * half.max_element())
}

#[cfg(test)]
mod tests;
