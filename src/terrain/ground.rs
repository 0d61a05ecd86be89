//! Where something stands on a landscape, from the place where its foot is drawn.

use glam::{DVec2, DVec3};

use super::landscape::Landscape;
use super::map::Tile;
use super::occlusion::Visible;
use super::reading::Layer;
use super::solids::Solids;

/// By how much a foot at the lower edge of a cell may be drawn below it, tiles: on a grid, it stands on that edge.
const EDGE: f64 = 0.05;

/// What a foot is drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Footing {
    /// On a top.
    Ground,
    /// On a roof.
    Roof,
    /// On water, where it floats.
    Water,
    /// On the front of a wall: it stands on the wall instead.
    Front,
    /// Beside all that is drawn, at height 0.
    Outside,
}

impl Footing {
    /// The word for `inspect`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Ground => "ground",
            Self::Roof => "roof",
            Self::Water => "water",
            Self::Front => "front",
            Self::Outside => "outside",
        }
    }
}

/// Where something stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    /// What its foot is drawn on.
    pub(crate) footing: Footing,
    /// Column and row of that cell; `None` beside the map.
    pub(crate) cell: Option<[usize; 2]>,
    /// Its foot in the landscape: tiles, about the map's middle at height 0, as its surface.
    pub(crate) point: DVec3,
}

impl Layer {
    /// The cell that a foot at a point of the drawing stands on, if anything is drawn there.
    pub(crate) fn cell_under(&self, foot: DVec2) -> Option<[usize; 2]> {
        let point = foot - DVec2::new(0.0, EDGE * self.size);
        let cell = self.cell_at(point)?;
        let place = [cell % self.map.columns, cell / self.map.columns];
        (self.tile(place) != Tile::None).then_some(place)
    }

    fn tile(&self, [column, row]: [usize; 2]) -> Tile {
        self.map.tile(self.map.index(column, row))
    }

    /// Where something stands whose foot is drawn at a point, drawing units.
    pub(crate) fn place(&self, foot: DVec2) -> Place {
        let at = (foot - self.origin) / self.size;
        let cell = self.cell_under(foot);
        let (footing, height, row) = match cell {
            None => (Footing::Outside, 0.0, at.y),
            Some(cell) => match self.landscape.footing(cell, at.y, self.roof) {
                (Footing::Ground, height, row) if self.tile(cell) == Tile::Blue => {
                    (Footing::Water, height, row)
                }
                found => found,
            },
        };
        // Seen from 45° above, a point at this height is drawn as much farther up.
        let depth = if self.landscape.is_plain() {
            row
        } else {
            row + height
        };
        let extent = DVec2::new(self.map.columns as f64, self.map.rows as f64);
        Place {
            footing,
            cell,
            point: DVec3::new(at.x - extent.x / 2.0, height, depth - extent.y / 2.0),
        }
    }
}

impl Landscape {
    /// What is drawn at a row of a cell: its height, and the row at which something that stands there is drawn. `roof` is the ratio of a
    /// roof's height to its depth.
    fn footing(&self, [column, row]: [usize; 2], at: f64, roof: f64) -> (Footing, f64, f64) {
        if let Some(level) = self.top(column, row) {
            return (Footing::Ground, f64::from(level), at);
        }
        let Some(views) = self.views(column) else {
            return (Footing::Outside, 0.0, at);
        };
        let seen = views.iter().find(|(rows, _)| rows.contains(&(row as i32)));
        match seen {
            Some((rows, Visible::Roof(eaves))) => {
                let depth = self
                    .house_at(column, row)
                    .and_then(|house| self.houses().nth(house));
                let depth = depth.map_or(rows.len() as f64, |house| f64::from(house.depth));
                // From the eaves, whose lower edge is drawn at the end of the rows, up the front of the roof.
                let up = (f64::from(rows.end) - at) / (depth * (0.5 + roof));
                let up = up.clamp(0.0, 1.0);
                (Footing::Roof, f64::from(*eaves) + up * roof * depth, at)
            }
            Some((_, Visible::Front(plane))) => {
                // The top of the wall is the first thing above it that is none.
                let above = views.iter().rev().find(|(rows, visible)| {
                    let is_front = matches!(visible, Visible::Front(other) if other == plane);
                    rows.end <= row as i32 && !is_front
                });
                let edge = above.map_or(0, |(rows, _)| rows.end);
                (Footing::Front, f64::from(plane - edge), f64::from(edge))
            }
            Some((_, Visible::Top(level))) => (Footing::Ground, f64::from(*level), at),
            Some((_, Visible::Nothing)) | None => (Footing::Outside, 0.0, at),
        }
    }

    /// What is seen in a column, from the top of the map; `None` for a plain map.
    fn views(&self, column: usize) -> Option<Vec<(std::ops::Range<i32>, Visible)>> {
        if self.is_plain() {
            return None;
        }
        let mut solids = Solids::default();
        solids.read_views(self.context(), column);
        let views = solids.views.iter();
        Some(
            views
                .map(|view| (view.start..view.end, view.visible))
                .collect(),
        )
    }
}
