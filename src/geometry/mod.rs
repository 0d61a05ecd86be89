//! Plane geometry of parts: outlines as valid polygons, their axes and bounds.
//!
//! Conventions, stated once: outlines are in drawing units, x right and y **down**, `f64`. Every [`Outline`] is valid
//! in the sense of OGC Simple Features: rings do not cross, and touch themselves or each other at most in points. The
//! first ring of a polygon is its border and runs counter-clockwise in a frame with y **up**; the others are holes and
//! run clockwise. A ring does not repeat its first point at its end, has at least three points and encloses some area.

mod bands;
mod boolean;
mod boxes;
mod contact;
mod disjoint;
mod distances;
mod flatten;
mod frame;
mod hull;
mod measure;
mod offset;
mod pixels;
mod query;
mod scanline;
mod similarity;
mod simplify;
mod tangled;
mod touching;

pub(crate) use bands::Bands;
pub use boolean::{intersect, resolve_overlaps};
pub(crate) use boolean::{is_convex, remove_collinear};
pub(crate) use boolean::{resolve_crossings, subtract, union};
pub(crate) use boxes::{BoxTree, OrderedBoxes, area_around, indexed_box};
pub(crate) use contact::{Body, connected, touching};
pub(crate) use distances::squared_distances;
pub(crate) use flatten::flatten;
pub(crate) use frame::{Frame, y_up};
pub(crate) use hull::convex_hull;
pub(crate) use measure::{Measure, Thickness, measure, measure_along};
pub(crate) use offset::offset;
pub(crate) use pixels::pixel_borders;
pub use query::{area, border_distance_squared, bounds, contains};
pub(crate) use query::{bounds_of, centroid, distance_squared};
pub(crate) use query::{crosses, edge_distance_squared, edges, edges_of, perimeter, shoelace};
pub(crate) use scanline::{EdgeRanges, Intervals, LINES, Scanlines};
pub(crate) use similarity::{Similarity, between_points, between_rings};
pub(crate) use simplify::simplify;
pub(crate) use tangled::{MAX_PICTURED, count_crossings, sweeps_better_along_y};

use glam::DVec2;

/// A closed ring of points; the first point is not repeated at the end.
pub(crate) type Ring = Vec<DVec2>;

/// Which points a path fills.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FillRule {
    /// Points with a winding number other than zero.
    #[default]
    NonZero,
    /// Points with an odd winding number.
    EvenOdd,
}

/// A border and its holes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polygon {
    /// The border, then the holes.
    pub rings: Vec<Ring>,
}

/// A filled area made of valid polygons.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    /// Polygons that do not overlap.
    pub polygons: Vec<Polygon>,
}

impl Outline {
    /// The rings of all polygons.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        self.polygons.iter().flat_map(|polygon| &polygon.rings)
    }

    /// The number of points of all rings.
    pub fn point_count(&self) -> usize {
        self.rings().map(Vec::len).sum()
    }

    /// The outline with each ring replaced by what `ring` makes of it.
    pub fn map_rings(&self, ring: impl Fn(&Ring) -> Ring) -> Self {
        let polygon = |polygon: &Polygon| Polygon {
            rings: polygon.rings.iter().map(&ring).collect(),
        };
        Self {
            polygons: self.polygons.iter().map(polygon).collect(),
        }
    }
}
