//! Where a drawing lies on its screen: its centre and its size.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use crate::billboard::region::{Direction, View};
use crate::scene::ViewId;

/// Angles that differ by less are the same, degrees.
const SAME_ANGLE: f64 = 1e-6;

/// From drawing units to heights of the character around its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The character's centre, drawing units.
    pub center: DVec2,
    /// The length of one unit on the screen, drawing units: finite and positive.
    pub height: f64,
}

impl Frame {
    /// A point of the drawing on the screen: heights, y up.
    pub fn on_screen(&self, point: DVec2) -> DVec2 {
        let p = (point - self.center) / self.height;
        DVec2::new(p.x, -p.y)
    }

    /// A point of the screen in the drawing: drawing units, y down.
    pub fn in_drawing(&self, point: DVec2) -> DVec2 {
        self.center + DVec2::new(point.x, -point.y) * self.height
    }
}

/// The frame of each view: the centre of what it shows, and the size that makes the views agree.
///
/// Level views of a character are equally high, so that each is measured in its own height. A change of pitch leaves widths
/// alone, so that views of one `theta` get the scale that makes them equally wide. Otherwise the drawings are taken to be equally
/// large. The unit is the height of the first view that shows anything.
pub(crate) fn frames(views: &TiSlice<ViewId, View>) -> TiVec<ViewId, Frame> {
    let extents: TiVec<ViewId, _> = views.iter().map(extent).collect();
    let first = extents.position(Option::is_some).unwrap_or(ViewId::FIRST);
    let base = extents.get(first).copied().flatten();
    let frame = |(i, view): (ViewId, &View)| {
        let (Some((center, size)), Some((_, base))) = (extents[i], base) else {
            return Frame {
                center: DVec2::ZERO,
                height: 1.0,
            };
        };
        let turn = difference(views[first].direction, view.direction);
        let levels = [views[first].direction.phi, view.direction.phi];
        let height = if levels.iter().all(|phi| phi.abs() < SAME_ANGLE) {
            size.y
        } else if turn.x.abs() < SAME_ANGLE {
            base.y * (size.x / base.x)
        } else {
            base.y
        };
        let height = [height, size.y, size.x].into_iter();
        Frame {
            center,
            height: height.filter(|h| h.is_normal()).fold(0.0, first_of),
        }
        .valid()
    };
    views.iter_enumerated().map(frame).collect()
}

impl Frame {
    fn valid(self) -> Self {
        let height = if self.height > 0.0 { self.height } else { 1.0 };
        Self { height, ..self }
    }
}

fn first_of(kept: f64, next: f64) -> f64 {
    if kept > 0.0 { kept } else { next }
}

/// The angles from one direction to another, degrees, the turn between −180 and 180.
pub(super) fn difference(from: Direction, to: Direction) -> DVec2 {
    let turn = (to.theta - from.theta + 180.0).rem_euclid(360.0) - 180.0;
    DVec2::new(turn, to.phi - from.phi)
}

/// The centre and the size of what a view shows.
fn extent(view: &View) -> Option<(DVec2, DVec2)> {
    let (low, high) = view.bounds()?;
    let size = high - low;
    size.is_finite().then_some(((low + high) / 2.0, size))
}
