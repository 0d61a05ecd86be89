//! Dashes so fine that a short drawing has millions of them are drawn longer, with gaps as much longer.

use usvg::tiny_skia_path as skia;

use super::walk::{Leaf, Task};
use crate::budget::{Budget, Work};

/// How many dashes the strokes of a drawing may have, each of them, if they are limited.
pub(super) struct Dashes {
    share: Option<u64>,
}

impl Dashes {
    /// Shares out the budget among the strokes of a drawing.
    pub(super) fn of(tasks: &[Task<'_>], budget: Budget) -> Self {
        let wanted = tasks.iter().filter_map(|task| match task.node {
            Leaf::Path(path) => count(path.stroke()?, path.data()),
            Leaf::Image(_) => None,
        });
        Self {
            share: budget.share(Work::Dashes, wanted.collect()),
        }
    }

    /// The stroke of a path, its dashes as long as they have to be.
    pub(super) fn stroke(&self, stroke: &usvg::Stroke, path: &skia::Path) -> skia::Stroke {
        let mut drawn = stroke.to_tiny_skia();
        let count = count(stroke, path);
        if let (Some(share), Some(count), Some(dashes)) = (self.share, count, stroke.dasharray())
            && count > share
        {
            let longer = count as f32 / share.max(1) as f32;
            let dashes = dashes.iter().map(|length| length * longer).collect();
            drawn.dash = skia::StrokeDash::new(dashes, stroke.dashoffset() * longer);
        }
        drawn
    }
}

/// About how many dashes a stroke has; `None` for one that is not dashed.
fn count(stroke: &usvg::Stroke, path: &skia::Path) -> Option<u64> {
    let dashes = stroke.dasharray()?;
    let pattern: f32 = dashes.iter().sum();
    let count = length(path) / pattern * dashes.len() as f32 / 2.0;
    Some(count.ceil() as u64)
}

/// The length of a path, of curves that of their control polygons.
fn length(path: &skia::Path) -> f32 {
    let (mut start, mut at) = (skia::Point::zero(), skia::Point::zero());
    let mut sum = 0.0;
    for segment in path.segments() {
        let mut to = |point: skia::Point| {
            sum += at.distance(point);
            at = point;
        };
        match segment {
            skia::PathSegment::MoveTo(point) => (start, at) = (point, point),
            skia::PathSegment::LineTo(point) => to(point),
            skia::PathSegment::QuadTo(control, point) => [control, point].into_iter().for_each(to),
            skia::PathSegment::CubicTo(first, second, point) => {
                [first, second, point].into_iter().for_each(to);
            }
            skia::PathSegment::Close => to(start),
        }
    }
    sum
}
