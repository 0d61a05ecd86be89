//! A solid that is still to be made.

use std::sync::Arc;

use glam::DAffine2;

use super::{Options, build, mirror};
use crate::geometry::{Outline, Polygon};
use crate::lang::value::ShapeKind;
use crate::scene::Surface;

/// All that a solid is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Its outline as drawn, y down.
    pub outline: Arc<Outline>,
    /// From there to the part's own frame, y up, its centre at the origin; turns without scaling.
    pub to_frame: DAffine2,
    /// How it gets its thickness.
    pub kind: ShapeKind,
    /// How fine, how smooth, and where it goes.
    pub options: Options,
    /// On which sides of the drawing plane it stands.
    pub sides: Sides,
}

/// On which sides of the drawing plane a solid stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Where it was described.
    Front,
    /// Mirrored in the plane.
    Back,
    /// On both (`-s`).
    Both,
}

impl Solid {
    /// Makes the solid.
    pub fn surface(&self) -> Surface {
        let ring = |ring: &Vec<_>| {
            ring.iter()
                .map(|point| self.to_frame.transform_point2(*point))
                .collect()
        };
        let polygon = |polygon: &Polygon| Polygon {
            rings: polygon.rings.iter().map(ring).collect(),
        };
        let local = Outline {
            polygons: self.outline.polygons.iter().map(polygon).collect(),
        };
        let mut surface = build(&local, &self.kind, &self.options);
        match self.sides {
            Sides::Front => surface,
            Sides::Back => mirror(&surface),
            Sides::Both => {
                let back = mirror(&surface);
                surface.append(&back);
                surface
            }
        }
    }

    /// The solid mirrored in the drawing plane.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let sides = match self.sides {
            Sides::Front => Sides::Back,
            Sides::Back => Sides::Front,
            Sides::Both => Sides::Both,
        };
        Self {
            sides,
            ..self.clone()
        }
    }
}
