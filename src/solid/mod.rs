//! Solids: outlines that are given thickness (Arai & Horry, section 3.4).
//!
//! Conventions, stated once: outlines are in their part's frame, x across the axis, y along it,
//! y **up**, the part's centre at the origin. Borders run counter-clockwise, so their shoelace sum
//! is positive. Depths are towards the viewer, +z. All numbers are f64 until the surface is written.
//!
//! Invariant: a surface other than a flat one is closed ([`check::closed`]) and wound outward.

#[cfg(test)]
mod check;

mod border;
mod cap;
mod cells;
mod crease;
mod ears;
mod heights;
mod inflate;
mod kinds;
mod lathe;
mod layers;
mod pile;
mod prism;
mod ridge;
mod rings;
mod shade;
mod shell;
mod source;
mod stack;

use crate::math;
use glam::{DMat2, DVec2, DVec3};

use crate::budget::{self, Step};
use crate::geometry::{Outline, bounds};
use crate::scene::Surface;

pub(crate) use kinds::Profile;
pub(crate) use layers::segments_within;
pub(crate) use pile::{
    Body, Girth, LaidSolid, Lay, LayForm, Pile, RecentHeights, Section, SolidHeights, Toes,
};
pub use source::{Sides, Solid};

/// The fewest layers per half turn of roundings in drawings with very many triangles.
pub(crate) const LEAST_SEGMENTS: u32 = 4;

/// What a solid depends on besides its outline and its profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Layers per 180° of a rounding.
    pub segments: u32,
    /// Edges with a smaller angle between their faces are smooth, degrees; 0 makes all of them sharp.
    pub crease: f64,
    /// The solid's position in the model.
    pub placement: Placement,
}

/// Maps a point to `scale · (rotation · point + translation)`.
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
        math::rotation(self.rotation)
    }
}

/// The solid of an outline in its part's frame; nothing for an outline without area.
pub(crate) fn build(outline: &Outline, profile: &Profile, options: &Options) -> Surface {
    match half_extents(outline) {
        Some(half) => {
            let surface = profile.surface(outline, half, options);
            budget::count(Step::Triangle, surface.triangles.len());
            surface
        }
        None => Surface::default(),
    }
}

/// How far an outline reaches from its centre, across and along; `None` for one without points.
fn half_extents(outline: &Outline) -> Option<DVec2> {
    let (low, high) = bounds(outline)?;
    Some(low.abs().max(high.abs()))
}

#[cfg(test)]
mod hidden_tests;
#[cfg(test)]
mod laws;
#[cfg(test)]
mod pile_tests;
#[cfg(test)]
mod tests;
