//! Lines that begin on a shape and go out of it: antennas, whiskers, strings, the limbs of stick figures.
//!
//! They are parts of their own, which hang on what they begin on. A line that only crosses shapes is a guide.

use glam::DVec2;

use super::fills::Fills;
use super::ink;
use crate::geometry::distance_squared;
use crate::svg::{Drawing, ShapeId};

/// How far beside a shape a line may end on it, in widths of the line.
const BESIDE: f64 = 0.75;
/// How far a line goes out of the shape that it begins on, at least, in widths of the line.
const OUT: f64 = 1.0;

/// Where a line is held.
#[derive(Debug, Clone, Copy)]
pub(in crate::bind) struct Hold {
    /// The shape that it begins on.
    pub(in crate::bind) by: ShapeId,
    /// The end that lies there, drawing units.
    pub(in crate::bind) at: DVec2,
    /// Another shape that its other end touches, and that end.
    pub(in crate::bind) to: Option<(ShapeId, DVec2)>,
}

/// Where an open line is held: by its beginning if that lies on one of the filled shapes, else by its end.
pub(super) fn hold(drawing: &Drawing, line: ShapeId, fills: &Fills<'_>) -> Option<Hold> {
    let shape = &drawing.shapes[line];
    let (ends, stroke) = (shape.line.as_ref()?.ends, shape.stroke.as_ref()?);
    let width = stroke.width();
    let points = ink::along(stroke, width);
    let [start, end] = ends;
    [[start, end], [end, start]]
        .into_iter()
        .find_map(|[at, other]| {
            let by = fills.nearest(at, BESIDE * width)?;
            let outline = &drawing.shapes[by].outline;
            let out = OUT * OUT * width * width;
            let goes_out = |point: &DVec2| distance_squared(outline, *point) > out;
            let to = || fills.nearest(other, BESIDE * width).filter(|to| *to != by);
            points.iter().any(goes_out).then(|| Hold {
                by,
                at,
                to: to().map(|to| (to, other)),
            })
        })
}
