//! Limits how often the outlines of a drawing cross themselves: each crossing is a corner of a piece that has to be found, and a
//! short file can have millions of them, for example as clones of a star with many points.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::elements::start_tag;
use super::paths::{affine, bez_path};
use super::prepare::Prepared;
use super::shapes::Context;
use super::walk::{Leaf, Task};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{
    FillRule, MAX_PICTURED, Outline, Ring, count_crossings, flatten, resolve_crossings,
};

/// How often the outlines of any drawing may cross themselves: finding the pieces takes about a second.
const MOST: usize = 400_000;
/// Bytes of a large drawing that allow for one more crossing.
const BYTES_EACH: usize = 2;
/// How often the outline of a stroke crosses itself where its middle line does once: both of its sides cross both.
const BY_STROKE: usize = 4;

/// Paths with fewer points hardly cross themselves so often that their area is taken from a picture.
const MANY_POINTS: usize = 128;

/// How often the outlines of a drawing cross themselves so far.
pub(super) struct Tangles {
    count: AtomicUsize,
    most: usize,
    /// How many points each area that is taken from a picture may have.
    points_each: usize,
}

impl Tangles {
    /// None yet.
    pub(super) fn new(prepared: &Prepared, tasks: &[Task<'_>]) -> Self {
        let points = tasks.iter().map(Task::point_count);
        let long = points.filter(|points| *points >= MANY_POINTS).count();
        Self {
            count: AtomicUsize::new(0),
            most: MOST.max(prepared.text.len() / BYTES_EACH),
            points_each: MAX_PICTURED / long.max(1),
        }
    }

    /// The area that rings enclose by a fill rule; counts how often they cross.
    pub(super) fn resolve(&self, rings: Vec<Ring>, rule: FillRule, has_stroke: bool) -> Outline {
        let (outline, crossings) = resolve_crossings(rings, rule, self.points_each);
        self.add(crossings, has_stroke);
        outline
    }

    /// Whether there are so many that the drawing will be refused.
    pub(super) fn are_too_many(&self) -> bool {
        self.count.load(Ordering::Relaxed) > self.most
    }

    /// Adds the crossings of a filled shape, and of its stroke if it has one.
    fn add(&self, crossings: usize, has_stroke: bool) {
        let times = 1 + BY_STROKE * usize::from(has_stroke);
        self.count.fetch_add(times * crossings, Ordering::Relaxed);
    }

    /// Adds the crossings of the stroke of a line.
    pub(super) fn add_line(&self, line: &[Ring]) {
        let crossings = BY_STROKE * count_crossings(line);
        self.count.fetch_add(crossings, Ordering::Relaxed);
    }

    /// Refuses the drawing if there are too many, and names the shape that has most of those that were counted.
    pub(super) fn check(
        &self,
        context: &Context<'_, '_>,
        tasks: &[Task<'_>],
    ) -> Result<(), Box<Diagnostic>> {
        if !self.are_too_many() {
            return Ok(());
        }
        // The shapes were counted in no order: the same shape is to be named every time.
        let (mut worst, mut most, mut sum) = (None, 0, 0);
        for task in tasks {
            let Leaf::Path(path) = task.node else {
                continue;
            };
            let outline = bez_path(path.data(), affine(path.abs_transform()));
            let crossings = count_crossings(&flatten(&outline, context.tolerance));
            if crossings > most {
                (worst, most) = (Some(task), crossings);
            }
            sum += crossings;
            if sum > self.most {
                break;
            }
        }
        let node = worst.and_then(|task| context.document.get_node(task.xml));
        let node = node.unwrap_or_else(|| context.document.root_element());
        let message = format!(
            "the outlines of this drawing cross themselves more than {} times, {most} times in this shape alone",
            self.most
        );
        Err(Box::new(
            Diagnostic::new(
                Code::LimitPassed,
                start_tag(node, context.prepared),
                message,
            )
            .help("unite the shape with itself (Path > Union), or use fewer copies of it"),
        ))
    }
}
