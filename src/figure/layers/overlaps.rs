//! Which shapes lie over which, and how much of them does.

use glam::DVec2;
use rayon::prelude::*;

use super::shapes::Shape;
use crate::bind::PartId;
use crate::budget::{Budget, Work};
use crate::geometry::{Intervals, OrderedBoxes, Scanlines};
use crate::threads::GRAIN;

/// Limit of the bounding boxes that are compared with a shape.
const MAX_BOXES: usize = 4096;
/// Limit of the shapes that a shape lies over: of a higher pile, only the topmost ones are looked at, …
const MAX_BELOW: usize = 64;
/// … in a drawing of very many shapes fewer of them, …
const MANY_SHAPES: usize = 4096;
const MAX_BELOW_OF_MANY: usize = 8;
/// … and of those under them only so many that they do not hide from the shape.
const MAX_UNHIDDEN: usize = 192;
/// Shapes overlap if they have more in common than this share of the smaller one.
const LEAST: f64 = 1e-4;
/// Points along a line of samples.
pub(super) const SAMPLES: usize = 12;

/// An earlier shape that a shape lies over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overlap {
    /// The earlier shape.
    pub(super) below: usize,
    /// The area that they have in common, square units.
    pub(super) area: f64,
}

/// Memory that is used again for the next shapes.
#[derive(Default)]
pub(super) struct Scratch {
    own: Intervals,
    /// The shape that `own` is of, and between which heights its lines are.
    own_of: Option<(PartId, [f64; 2])>,
    other: Intervals,
    /// What is left of a shape where nothing looked at so far hides what is under it.
    left: Intervals,
}

/// Per shape those that it lies over, back-most first. If all together are over the budget, those on top of many have only those of them
/// that others do not hide, and if need be only the topmost of these.
pub(super) fn overlaps(shapes: &[Shape], budget: Budget) -> Vec<Vec<Overlap>> {
    let boxes = OrderedBoxes::new(shapes.iter().map(|shape| shape.bounds).enumerate());
    let shapes_below = (0..shapes.len()).into_par_iter().with_min_len(GRAIN);
    let mut overlaps: Vec<Vec<Overlap>> = shapes_below
        .map_init(Scratch::default, |scratch, shape| {
            below(shapes, shape, &boxes, scratch)
        })
        .collect();
    let share = |overlaps: &[Vec<Overlap>]| {
        let counts = overlaps.iter().map(|below| below.len() as u64);
        let share = budget.share(Work::Overlaps, counts.collect());
        share.map(|share| share as usize)
    };
    if let Some(share) = share(&overlaps) {
        let many = overlaps.par_iter_mut().enumerate().with_min_len(GRAIN);
        let many = many.filter(|(_, below)| below.len() > share);
        many.for_each_init(Scratch::default, |scratch, (above, below)| {
            let own = &shapes[above];
            let lines = scratch.begin(own);
            below.reverse();
            below.retain(|overlap| scratch.hide(&lines, own, &shapes[overlap.below]));
            below.reverse();
        });
    }
    if let Some(share) = share(&overlaps) {
        for below in &mut overlaps {
            below.drain(..below.len().saturating_sub(share));
        }
    }
    overlaps
}

fn below(
    shapes: &[Shape],
    above: usize,
    boxes: &OrderedBoxes,
    scratch: &mut Scratch,
) -> Vec<Overlap> {
    let own = &shapes[above];
    let most = if shapes.len() > MANY_SHAPES {
        MAX_BELOW_OF_MANY
    } else {
        MAX_BELOW
    };
    let mut found: Vec<Overlap> = Vec::new();
    let mut many = None;
    boxes.before(above, own.bounds, MAX_BOXES, |below| {
        let other = &shapes[below];
        if found.len() >= most {
            let lines = many.get_or_insert_with(|| {
                let lines = scratch.begin(own);
                for overlap in &found {
                    scratch.hide(&lines, own, &shapes[overlap.below]);
                }
                lines
            });
            if scratch.left.is_empty() {
                return false;
            }
            if !scratch.hide(lines, own, other) {
                return true;
            }
        }
        let area = scratch.common(own, other);
        if area > LEAST * own.area.min(other.area) {
            found.push(Overlap { below, area });
        }
        found.len() < most + MAX_UNHIDDEN
    });
    found.reverse();
    found
}

impl Scratch {
    /// The lines across the common part of two bounding boxes, cut to both shapes.
    fn cut(&mut self, a: &Shape, b: &Shape) -> Option<Scanlines> {
        let (low, high) = (a.bounds.0.max(b.bounds.0), a.bounds.1.min(b.bounds.1));
        if !low.cmplt(high).all() {
            return None;
        }
        let lines = Scanlines::across((low, high));
        // One that lies within many others is cut at the same lines for all of them.
        let own_of = Some((a.part, [low.y, high.y]));
        if self.own_of != own_of {
            lines.cut(&a.outline, &a.ranges, &mut self.own);
            self.own_of = own_of;
        }
        lines.cut(&b.outline, &b.ranges, &mut self.other);
        Some(lines)
    }

    /// Begins to look for what is hidden under a shape, on these lines.
    fn begin(&mut self, own: &Shape) -> Scanlines {
        let lines = Scanlines::across(own.bounds);
        lines.cut(&own.outline, &own.ranges, &mut self.left);
        lines
    }

    /// Whether something of another shape is under a shape where none looked at before hides it. It hides what comes next. What no line
    /// meets counts as not hidden.
    fn hide(&mut self, lines: &Scanlines, own: &Shape, other: &Shape) -> bool {
        lines.cut(&other.outline, &other.ranges, &mut self.other);
        if self.other.is_empty() {
            return true;
        }
        let unhidden = self.left.remove(&self.other) * lines.weight();
        unhidden > LEAST * own.area.min(other.area)
    }

    /// The area that two shapes have in common.
    fn common(&mut self, a: &Shape, b: &Shape) -> f64 {
        let lines = self.cut(a, b);
        lines.map_or(0.0, |lines| self.own.common(&self.other) * lines.weight())
    }

    /// Points spread over what two shapes have in common, on each line across it as many as given if it is as wide everywhere.
    pub(super) fn samples(&mut self, a: &Shape, b: &Shape, on_line: usize) -> Vec<DVec2> {
        let Some(lines) = self.cut(a, b) else {
            return Vec::new();
        };
        let width = a.bounds.1.x.min(b.bounds.1.x) - a.bounds.0.x.max(b.bounds.0.x);
        let apart = width / on_line as f64;
        let mut points = Vec::new();
        self.own.spread_common(&self.other, apart, |line, x| {
            points.push(DVec2::new(x, lines.place(line)));
        });
        points
    }

    /// The share of a shape that lies over these others.
    pub(super) fn covered<'a>(
        &mut self,
        shape: &Shape,
        below: impl Iterator<Item = &'a Shape>,
    ) -> f64 {
        let lines = self.begin(shape);
        let whole = self.left.length();
        for other in below {
            if self.left.is_empty() {
                break;
            }
            self.hide(&lines, shape, other);
        }
        if whole > 0.0 {
            1.0 - self.left.length() / whole
        } else {
            0.0
        }
    }
}

/// Per shape the length of the longest chain of shapes that lie over one another and end in it.
pub(super) fn ranks(overlaps: &[Vec<Overlap>]) -> Vec<usize> {
    let mut ranks = Vec::with_capacity(overlaps.len());
    for below in overlaps {
        let below = below.iter().map(|overlap| ranks[overlap.below]);
        ranks.push(1 + below.max().unwrap_or(0));
    }
    ranks
}
