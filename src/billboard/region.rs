//! The closed regions of a character's views.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde::Serialize;
use typed_index_collections::TiVec;

use crate::geometry::{Outline, bounds};
use crate::index::index_type;
use crate::scene::view_axes;

index_type!(
    /// Counts the regions of one view.
    pub RegionId
);

#[cfg(test)]
impl RegionId {
    /// The region that is painted first.
    pub(super) const FIRST: Self = Self(0);
}

/// A direction from which a character is drawn, degrees. (0, 0) is the front, where the viewer looks along −z; `theta` takes the
/// viewer towards the character's left (+x), `phi` above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Around the upright axis.
    pub theta: f64,
    /// Up from the horizontal.
    pub phi: f64,
}

impl Direction {
    /// The screen's right and up, and the direction towards the viewer, as unit vectors of the character's space.
    pub fn axes(self) -> [DVec3; 3] {
        view_axes([self.theta, self.phi])
    }
}

/// A closed region of one colour in a view.
#[derive(Debug, Clone)]
pub struct Region {
    /// The name that a string gives it.
    pub name: Option<String>,
    /// Its area, drawing units, y down. Holes that other regions make are filled.
    pub outline: Arc<Outline>,
    /// Its mean colour, sRGB with straight alpha, each from 0 to 1.
    pub color: [f64; 4],
    /// The smallest region of the view in which it lies.
    pub container: Option<RegionId>,
    /// Whether it is a line: the area of a stroke without a fill.
    pub is_line: bool,
}

/// A drawing of the character from one direction.
#[derive(Debug, Clone)]
pub struct View {
    /// The direction from which it is drawn.
    pub direction: Direction,
    /// Back-most first.
    pub regions: TiVec<RegionId, Region>,
}

/// What tells a region from others in its view.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Looks {
    /// Its mean colour, as `#rrggbb`.
    pub color: String,
    /// How far its middle is from the left and from the top of what the view shows, as shares of its width and height; `None` for a
    /// region without extent.
    pub at: Option<[f64; 2]>,
}

impl std::fmt::Display for Looks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { color, at } = self;
        f.write_str(color)?;
        let Some([left, top]) = at.map(|at| at.map(|share| share * 100.0)) else {
            return Ok(());
        };
        write!(f, ", {left:.0} % from the left and {top:.0} % from the top")
    }
}

impl View {
    /// How a region looks.
    pub(crate) fn looks(&self, id: RegionId) -> Looks {
        let region = &self.regions[id];
        let [r, g, b] = [0, 1, 2].map(|i| (region.color[i] * 255.0).round() as u8);
        let place = bounds(&region.outline).zip(self.bounds());
        Looks {
            color: format!("#{r:02x}{g:02x}{b:02x}"),
            at: place.map(|((low, high), (least, greatest))| {
                (((low + high) / 2.0 - least) / (greatest - least)).to_array()
            }),
        }
    }

    /// The lower and the upper corner of the box around what it shows, drawing units; `None` if that is nothing.
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let boxes = self
            .regions
            .iter()
            .filter_map(|region| bounds(&region.outline));
        boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }
}
