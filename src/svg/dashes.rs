//! Dashes so fine that a short drawing has millions of them are drawn longer, with gaps as much longer.

use usvg::tiny_skia_path as skia;

use super::elements::start_tag;
use super::prepare::Prepared;
use super::walk::{Leaf, Task};
use crate::budget::{Budget, Work};
use crate::diagnostic::{Code, Diagnostic};

/// How many dashes the strokes of a drawing may have, each of them, if they are limited.
pub(super) struct Dashes {
    share: Option<u64>,
    /// How many they may have in all.
    most: u64,
}

impl Dashes {
    /// Shares out the budget among the strokes of a drawing.
    pub(super) fn of(tasks: &[Task<'_>], budget: Budget) -> Self {
        let wanted = tasks.iter().filter_map(of_task);
        Self {
            share: budget.share(Work::Dashes, wanted.collect()),
            most: budget.most(Work::Dashes),
        }
    }

    /// The warning that dashes are drawn longer, at the first of the strokes.
    pub(super) fn warning(
        &self,
        tasks: &[Task<'_>],
        document: &roxmltree::Document<'_>,
        prepared: &Prepared,
    ) -> Option<Diagnostic> {
        let share = self.share?;
        let wanted = tasks.iter().map(|task| (task, of_task(task).unwrap_or(0)));
        let longer: Vec<(&Task<'_>, u64)> = wanted.filter(|(_, count)| *count > share).collect();
        let (first, _) = longer.first()?;
        let most = longer.iter().map(|(_, count)| *count).max()?;
        let strokes = match longer.len() {
            1 => "a stroke".to_owned(),
            count => format!("{count} strokes"),
        };
        let message = format!(
            "the dashes of {strokes} are drawn up to {:.1} times as long as they are: with so fine ones the drawing would have more than \
             {} dashes",
            most as f64 / share.max(1) as f64,
            self.most
        );
        let span = start_tag(document.get_node(first.xml)?, prepared);
        let help = "make the dashes longer, or draw the lines without dashes";
        Some(Diagnostic::new(Code::LongerDashes, span, message).help(help))
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

/// About how many dashes what is drawn has; `None` if it has no dashed stroke.
fn of_task(task: &Task<'_>) -> Option<u64> {
    match task.node {
        Leaf::Path(path) => count(path.stroke()?, path.data()),
        Leaf::Image(_) => None,
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
