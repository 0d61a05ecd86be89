//! Outlines blown up like a balloon.
//!
//! The height over a point is 2√u, scaled to the requested maximum, where u solves the Poisson equation Δu = −1 inside the
//! outline with u = 0 on its border. Over a disc this is a sphere or a spheroid, over a bar an elliptic cylinder. Thin limbs
//! come out thinner than the trunk, and the surface is vertical at the border, so that both sides meet without an edge. The
//! result does not depend on how densely the outline is sampled.

mod delaunay;
mod discs;
mod mesh;
mod points;
mod poisson;
mod sides;
mod tube;

use glam::DVec2;

pub(super) use mesh::{Mesh, mesh};
pub(super) use points::{Points, points};
use sides::Sides;

use super::crease::Crease;
use super::layers::{MIN_THICKNESS, steps_per_half_turn};
use super::stack::PlacementTransform;
use super::{Options, Placement};
use crate::geometry::Outline;
use crate::math;
use crate::scene::Surface;

/// The smallest height over an inner point, relative to depths and to the highest point, that `f32` can distinguish from 0.
const MIN_HEIGHT: f64 = 1e-6;

/// The front of a solid that is a height field, over a mesh in the drawing plane.
#[derive(Debug, Default)]
pub struct Field {
    pub(in crate::solid) mesh: Mesh,
    /// Over each point of the mesh, model units: 0 on the border, positive elsewhere.
    pub(in crate::solid) heights: Vec<f64>,
}

/// The surface over both sides of a field about the plane that the options place it in.
pub(super) fn surface(field: &Field, options: &Options) -> Surface {
    let Placement {
        translation, scale, ..
    } = options.placement;
    let sides = Sides::of(field, scale * translation.z);
    // All edges come from the steps, so either all of them are smooth or none is.
    let step = 180.0 / f64::from(steps_per_half_turn(options));
    if options.crease <= step || options.crease.is_nan() {
        sides.shaded(Crease::new(options.crease))
    } else if field.mesh.has_pinches {
        sides.shaded(Crease::new(180.0))
    } else {
        sides.smooth()
    }
}

/// What is blown up, and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Balloon {
    /// The height of the highest points, drawing units.
    ///
    /// Without it the field is not scaled: a ball over a disc, about 0.7 of the width over a narrow bar. The height is then
    /// at most half the smaller side of the box, so that a ring or a letter stays thin.
    pub(super) height: Option<f64>,
    /// What the height is at most where none is given, drawing units: that of cloth.
    pub(super) most: Option<f64>,
    /// Whether it is as high as that wherever it is not narrower, with rounded edges.
    pub(super) is_box: bool,
    /// For the stroke of a line its width, drawing units: it becomes a tube.
    pub(super) line: Option<f64>,
}

impl Balloon {
    /// The points of a mesh of an outline, about as dense as a rounding of so many layers per 180°; `scale` are units of the
    /// outline a drawing unit.
    pub(super) fn points(&self, outline: &Outline, segments: u32, scale: f64) -> Points {
        match self.line {
            Some(width) => tube::points(outline, width * scale, segments),
            None => points::points(outline, segments),
        }
    }

    /// The heights over an outline whose bounding box has these half extents. The depth at which the options place it does not
    /// matter.
    pub(super) fn field(&self, outline: &Outline, half: DVec2, options: &Options) -> Field {
        let transform = PlacementTransform::new(options);
        let points = self.points(outline, steps_per_half_turn(options), 1.0);
        let mesh = mesh(&points, &transform);
        Field {
            heights: self.heights(&mesh, half, options.placement.scale),
            mesh,
        }
    }

    /// About how many points of an outline columns stand on, drawing units.
    pub(super) fn border_points(&self, outline: &Outline) -> usize {
        let between = self
            .line
            .map_or(0, |width| tube::points_between(outline, width));
        outline.point_count() + between
    }

    /// The heights of [`field`](Self::field) over a mesh of the outline at its final place, model units; `scale` are model units a
    /// drawing unit.
    pub(super) fn heights(&self, mesh: &Mesh, half: DVec2, scale: f64) -> Vec<f64> {
        match self.line {
            Some(width) => tube::heights(mesh, width * scale, self.most(half) * scale),
            None => balloon(mesh, self, self.most(half), scale),
        }
    }

    /// The largest height over an outline whose bounding box has these half extents, drawing units.
    pub(super) fn most(&self, half: DVec2) -> f64 {
        let own = self.line.map(|width| width / 2.0);
        let height = height(self.height.or(own), half);
        match self.most {
            Some(most) if self.height.is_none() => height.min(most),
            _ => height,
        }
    }
}

/// How sharp the edges of boxes are: how many times as steep as a balloon they begin, and the exponent of the power mean of that and
/// of the box.
const STEEP: f64 = 2.0;
const EDGE: f64 = 4.0;

/// The heights of a balloon over a mesh: at most `most`, or exactly that if the height is given.
fn balloon(mesh: &Mesh, kind: &Balloon, most: f64, scale: f64) -> Vec<f64> {
    let Some(first) = mesh.points.first() else {
        return Vec::new();
    };

    // Relative to one of the points and to the extent, so that products neither lose precision nor overflow.
    let flat = |[x, y]: &[f32; 2]| DVec2::new((*x).into(), (*y).into());
    let origin = flat(first);
    let mut plane: Vec<DVec2> = mesh.points.iter().map(|p| flat(p) - origin).collect();
    let distances = plane.iter().map(|p| p.abs().max_element());
    let extent = distances.fold(f64::MIN_POSITIVE, f64::max);
    for point in &mut plane {
        *point /= extent;
    }
    let solution = poisson::solve(&plane, &mesh.triangles, &mesh.on_border);
    let highest = solution.iter().copied().fold(f64::MIN_POSITIVE, f64::max);

    let own = 2.0 * highest.sqrt() * extent / scale;
    let height = if kind.height.is_none() {
        most.min(own)
    } else {
        most
    };
    let is_box = kind.is_box && kind.height.is_none();
    let least = MIN_HEIGHT * height;
    let heights = solution.iter().zip(&mesh.on_border);
    let heights = heights.map(|(u, on_border)| {
        if *on_border {
            0.0
        } else {
            let share = (u / highest).max(0.0).sqrt();
            let over = if is_box {
                boxed(STEEP * share * own, height)
            } else {
                share * height
            };
            scale * over.max(least)
        }
    });
    heights.collect()
}

/// The height of a box with rounded edges where it would have another one as a balloon.
fn boxed(height: f64, most: f64) -> f64 {
    if height <= 0.0 || most <= 0.0 {
        return 0.0;
    }
    most * math::powf(1.0 + math::powf(most / height, EDGE), -1.0 / EDGE)
}

/// The largest height over an outline whose bounding box has these half extents, drawing units.
fn height(given: Option<f64>, half: DVec2) -> f64 {
    let given = given.map(|h| if h.is_finite() { h.abs() } else { 0.0 });
    given
        .unwrap_or(half.min_element())
        .max(MIN_THICKNESS * half.max_element())
}

#[cfg(test)]
mod tests;
