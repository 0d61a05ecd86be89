//! Solids: outlines that get thickness (Arai & Horry, section 3.4; language.md, Shapes).
//!
//! Conventions, stated once: outlines stand in their part's frame, x across the axis, y along it,
//! y **up**, the part's centre at the origin; borders run counter-clockwise, so their shoelace sum
//! is positive. Depths are towards the viewer, +z. Everything is f64 until the surface is written.
//!
//! Invariant: a surface other than a flat one is closed ([`check::closed`]) and wound outward.

pub mod check;

mod cap;
mod ears;
mod groups;
mod inflate;
mod lathe;
mod layers;
mod prism;
mod recipe;
mod ridge;
mod rings;
mod shade;
mod skin;
mod stack;

use glam::{DMat2, DVec3};

use crate::geometry::{Outline, bounds};
use crate::lang::value::ShapeKind;
use crate::scene::Surface;
use layers::layers;

pub use layers::depths;
pub use recipe::{Sides, Solid};

/// How a solid is made, besides its kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Layers per 180° of a rounding.
    pub segments: u32,
    /// Edges with less than this angle between their faces are smooth, degrees; 0 makes all flat.
    pub crease: f64,
    /// Depths of `default` where it has no parameters.
    pub thickness: [f64; 2],
    /// Where the solid goes.
    pub placement: Placement,
}

/// Carries a point to `scale · (rotation · point + translation)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// About z, radians, counter-clockwise.
    pub rotation: f64,
    /// Before scaling.
    pub translation: DVec3,
    /// Model units a drawing unit, positive.
    pub scale: f64,
}

impl Default for Placement {
    fn default() -> Placement {
        Placement {
            rotation: 0.0,
            translation: DVec3::ZERO,
            scale: 1.0,
        }
    }
}

impl Placement {
    fn turn(&self) -> DMat2 {
        DMat2::from_angle(self.rotation)
    }
}

/// The solid of an outline in its part's frame. `Model` is built as `Default` without parameters; `None`, and
/// an outline without area, as nothing.
pub fn build(outline: &Outline, kind: &ShapeKind, options: &Options) -> Surface {
    let Some((low, high)) = bounds(outline) else {
        return Surface::default();
    };
    let half = low.abs().max(high.abs());
    match kind {
        ShapeKind::Inflate(given) => {
            return inflate::inflate(outline, *given, half, options);
        }
        ShapeKind::Lathe(degrees) => return lathe::lathe(outline, *degrees, options),
        _ => {}
    }
    let Some(layers) = layers(kind, half.x, half.y, options) else {
        return Surface::default();
    };
    if layers.len() < 2 {
        return layers.first().map_or_else(Surface::default, |layer| {
            stack::flat(outline, layer.z, options)
        });
    }
    stack::stack(outline, &layers, options)
}

#[cfg(test)]
mod laws;
#[cfg(test)]
mod tests;
