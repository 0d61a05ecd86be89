//! Paths of new shapes: read, checked, and written with few digits.

use std::fmt::Write as _;

use glam::{DAffine2, DVec2};
use kurbo::{BezPath, PathEl, Point, Rect, Shape as _};

use super::written;
use crate::ide::changes::Refusal;

/// More pieces than a person draws in one go.
const MOST_PIECES: usize = 10_000;

/// A path whose pieces are closed.
pub(super) fn closed(data: &str) -> Result<BezPath, Refusal> {
    let read = BezPath::from_svg(data);
    let path = read.map_err(|_| {
        Refusal::new("the path is no path data of SVG, such as `M 0 0 H 20 V 30 Z`")
    })?;
    if path.elements().len() > MOST_PIECES {
        return Err(Refusal::new(format!(
            "the path has more than {MOST_PIECES} pieces: draw it as several shapes"
        )));
    }
    let mut whole = BezPath::new();
    let mut is_open = false;
    for element in path.elements() {
        if matches!(element, PathEl::MoveTo(_)) && is_open {
            whole.push(PathEl::ClosePath);
        }
        is_open = *element != PathEl::ClosePath;
        whole.push(*element);
    }
    if is_open {
        whole.push(PathEl::ClosePath);
    }
    Ok(whole)
}

/// The corners of the box around a path.
pub(super) fn bounds(path: &BezPath) -> (DVec2, DVec2) {
    let Rect { x0, y0, x1, y1 } = path.bounding_box();
    (DVec2::new(x0, y0), DVec2::new(x1, y1))
}

/// How much a path covers.
pub(super) fn area(path: &BezPath) -> f64 {
    path.area().abs()
}

/// Path data of a path that is moved by a transform.
pub(super) fn data(path: &BezPath, transform: DAffine2, digits: usize) -> String {
    let place = |point: Point| {
        let at = transform.transform_point2(DVec2::new(point.x, point.y));
        format!("{},{}", written(at.x, digits), written(at.y, digits))
    };
    let mut data = String::new();
    for element in path.elements() {
        let space = if data.is_empty() { "" } else { " " };
        // Writing to a string cannot fail.
        let _ = match *element {
            PathEl::MoveTo(to) => write!(data, "{space}M {}", place(to)),
            PathEl::LineTo(to) => write!(data, "{space}L {}", place(to)),
            PathEl::QuadTo(by, to) => write!(data, "{space}Q {} {}", place(by), place(to)),
            PathEl::CurveTo(by, and, to) => {
                write!(data, "{space}C {} {} {}", place(by), place(and), place(to))
            }
            PathEl::ClosePath => write!(data, "{space}Z"),
        };
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_closed_and_rounded() {
        for (before, after) in [
            ("M 0 0 h 20.004 v 10", "M 0,0 L 20,0 L 20,10 Z"),
            (
                "M0 0L1 0 1 1zm5,5 0.126 0 0 1",
                "M 0,0 L 1,0 L 1,1 Z M 5,5 L 5.13,5 L 5.13,6 Z",
            ),
            (
                "M0 0C1 1 2 2 3 3Q4 4 5 0",
                "M 0,0 C 1,1 2,2 3,3 Q 4,4 5,0 Z",
            ),
        ] {
            let path = closed(before).unwrap();
            assert_eq!(data(&path, DAffine2::IDENTITY, 2), after);
        }
        assert!(closed("rect").is_err());
    }
}
