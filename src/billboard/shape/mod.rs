//! A region's outline between the views in which it is drawn, and one triangle list for the whole range.
//!
//! Outlines are interpolated linearly between corresponding points. The triangles are the same for all blends, so that a
//! region is one mesh with a morph target for each view.

mod contour;
mod correspondence;
mod features;
mod holes;
mod lines;
mod pairs;
mod rings;
mod simplify;
mod triangles;
mod unite;

use std::borrow::Borrow;

use glam::DVec2;
use typed_index_collections::TiVec;

pub(super) use contour::Ends;
pub(super) use lines::{line_mesh, match_lines};

use crate::geometry::Outline;
use crate::scene::ViewId;

/// A mesh in the drawing plane whose points move from view to view.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Morph {
    /// For every view the same number of points, drawing units, y down.
    pub points: TiVec<ViewId, Vec<DVec2>>,
    /// Indices of points, counter-clockwise as seen with y up. The list holds for all views and what is between them.
    pub triangles: Vec<[u32; 3]>,
    /// Rings of point indices that form the border, holes included, in the directions that outlines have.
    pub rings: Vec<Vec<u32>>,
}

/// A region's shape from its outlines in two or more views.
///
/// Each view is reproduced to within 0.05 % of its extent. `features` are named points beside the outline in each view: those
/// whose name is in all views belong together. What has no partner in a view shrinks to a point there: a polygon of the region
/// to a point inside another, a hole to a point inside its polygon. In a view whose outline is empty all points are at the
/// middle of the first one that is not.
pub(super) fn morph(outlines: &[impl Borrow<Outline>], features: &[Vec<(String, DVec2)>]) -> Morph {
    let Some(plane) = rings::Plane::new(outlines) else {
        return Morph {
            points: vec![Vec::new(); outlines.len()].into(),
            ..Morph::default()
        };
    };
    let features: Vec<Vec<DVec2>> = if features.len() == outlines.len() {
        let common = features::common(features).into_iter();
        common.map(|point| plane.to_frame(&point)).collect()
    } else {
        Vec::new()
    };
    let mut morph = Morph {
        points: vec![Vec::new(); outlines.len()].into(),
        ..Morph::default()
    };
    for polygon in rings::polygons(&plane, features) {
        let first = morph.points.first().map_or(0, Vec::len) as u32;
        for (all, own) in morph.points.iter_mut().zip(&polygon.points) {
            all.extend(own);
        }
        let border = holes::join(&polygon.points, &polygon.rings[0], &polygon.rings[1..]);
        let triangles = triangles::triangulate(&polygon.points, &border);
        let moved = triangles.iter().map(|triangle| triangle.map(|i| i + first));
        morph.triangles.extend(moved);
        let moved = polygon
            .rings
            .iter()
            .map(|ring| ring.iter().map(|i| i + first));
        morph.rings.extend(moved.map(Iterator::collect::<Vec<u32>>));
    }
    plane.to_drawing(&mut morph.points.raw);
    morph
}

#[cfg(test)]
mod tests;
