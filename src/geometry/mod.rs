//! Plane geometry of parts: outlines, their clean polygons, axes and frames.
//!
//! Conventions, stated once: outlines as drawn are in drawing units, x right and y **down**, f64.
//! [`Outline`]s are clean: rings do not cross or touch themselves or each other but in points, the
//! first ring of a polygon is its border and runs counter-clockwise in a frame with y **up**, the
//! others are holes and run clockwise; no ring repeats its first point at its end, has fewer than
//! three points or no area.

pub mod clean;
pub mod flatten;
mod frame;
pub mod measure;
mod plain;
mod query;
mod touch;

pub use clean::{clean, intersect, union};
pub use flatten::flatten;
pub use frame::{Frame, y_up};
pub use measure::{Measure, measure, measure_along};
pub(crate) use query::crosses;
pub use query::{area, bounds, contains, distance_squared};

use glam::DVec2;

/// A ring of points without repetition of the first.
pub type Ring = Vec<DVec2>;

/// Which side of a path is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FillRule {
    /// Points that the path winds around.
    #[default]
    NonZero,
    /// Points that the path winds around an odd number of times.
    EvenOdd,
}

/// A border and its holes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polygon {
    /// The border, then the holes.
    pub rings: Vec<Ring>,
}

/// A clean filled area.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    /// Polygons without common area.
    pub polygons: Vec<Polygon>,
}
