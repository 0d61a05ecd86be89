//! Splits overlapping blocks into slices that do not overlap.

use std::cmp::{Ordering, Reverse};

use rustc_hash::FxHashSet;

use super::super::solids::Block;
use super::steps::{step, underside};

/// A solid range of heights in a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    /// `[bottom, top]` in steps, which are equal for the underside of a roof.
    pub(super) y: [i32; 2],
    /// The material of its top where none is drawn; `None` under a roof.
    pub(super) top: Option<u8>,
    /// The material of its underside.
    pub(super) bottom: u8,
}

/// A range of z in which a column has the same spans.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slice {
    /// `[back, front]`.
    pub(super) z: [i32; 2],
    /// The range of its spans in the list; `sides` likewise.
    spans: [usize; 2],
    sides: [usize; 2],
}

/// The slices of a column, from back to front, without those that have no spans; in reused lists.
#[derive(Debug, Default)]
pub(super) struct Slices {
    pub(super) list: Vec<Slice>,
    spans: Vec<Span>,
    /// The materials of sides where none is drawn, from below, each with the step up to which it goes.
    sides: Vec<(i32, u8)>,
    /// Eaves inside of another solid: step, range of z, and the material of the walls.
    pub(super) inner: Vec<(i32, [i32; 2], u8)>,
    bounds: Vec<i32>,
    order: Vec<Block>,
    active: Vec<Block>,
}

impl Slices {
    pub(super) fn clear(&mut self) {
        self.list.clear();
        self.spans.clear();
        self.sides.clear();
        self.inner.clear();
    }

    /// The spans of a slice, from below, with gaps between them.
    pub(super) fn spans(&self, slice: &Slice) -> &[Span] {
        &self.spans[slice.spans[0]..slice.spans[1]]
    }

    /// The materials of a slice's sides between two steps, from below.
    pub(super) fn sides(&self, slice: &Slice, y: [i32; 2], mut each: impl FnMut([i32; 2], u8)) {
        let mut from = y[0];
        for (to, material) in &self.sides[slice.sides[0]..slice.sides[1]] {
            let to = (*to).min(y[1]);
            if to > from {
                each([from, to], *material);
                from = to;
            }
        }
    }

    /// Builds the slices of a column. `plates` are the heights of [`Levels::plates`](super::super::levels::Levels::plates).
    pub(super) fn build(&mut self, blocks: &[Block], plates: &FxHashSet<i32>) {
        self.clear();
        self.order.clear();
        let solid = blocks.iter().filter(|block| block.z[0] < block.z[1]);
        self.order.extend(solid.map(|block| Block {
            y: in_steps(block, plates),
            ..*block
        }));
        self.order.sort_unstable_by_key(|block| block.z[0]);
        self.bounds.clear();
        self.bounds
            .extend(self.order.iter().flat_map(|block| block.z));
        self.bounds.sort_unstable();
        self.bounds.dedup();
        self.active.clear();
        let mut next = 0;
        for bound in 1..self.bounds.len() {
            let z = [self.bounds[bound - 1], self.bounds[bound]];
            self.active.retain(|block| block.z[1] > z[0]);
            while let Some(block) = self.order.get(next)
                && block.z[0] == z[0]
            {
                // What is higher comes first: a plate that goes on below a block is not seen at the block's sides.
                let order = |block: &Block| (block.y[0], Reverse(block.y[1]));
                let at = self
                    .active
                    .partition_point(|other| order(other) <= order(block));
                self.active.insert(at, *block);
                next += 1;
            }
            self.slice(z);
        }
    }

    /// Adds the slice between two neighbouring bounds.
    fn slice(&mut self, z: [i32; 2]) {
        let start = self.spans.len();
        let sides = self.sides.len();
        for block in &self.active {
            let span = Span {
                y: block.y,
                top: block.top,
                bottom: block.side,
            };
            let known = self.sides[sides..].last().map_or(i32::MIN, |side| side.0);
            if block.y[1] > known.max(block.y[0]) {
                self.sides.push((block.y[1], block.side));
            }
            match self.spans[start..].last_mut() {
                Some(last) if last.y[1] >= span.y[0] => {
                    let order = span.y[1].cmp(&last.y[1]);
                    // A roof that is covered by another block needs an underside.
                    let roofed = match order {
                        Ordering::Greater => last.top.is_none().then_some(last.y[1]),
                        Ordering::Less => span.top.is_none().then_some(span.y[1]),
                        Ordering::Equal => {
                            (last.top.is_none() && span.top.is_none()).then_some(last.y[1])
                        }
                    };
                    self.inner.extend(roofed.map(|y| (y, z, span.bottom)));
                    if order.is_gt() || (order.is_eq() && span.top.is_none()) {
                        (last.y[1], last.top) = (span.y[1], span.top);
                    }
                }
                _ => self.spans.push(span),
            }
        }
        if self.spans.len() == start {
            return;
        }
        if let Some(last) = self.list.last_mut()
            && last.z[1] == z[0]
            && self.spans[last.spans[0]..last.spans[1]] == self.spans[start..]
            && self.sides[last.sides[0]..last.sides[1]] == self.sides[sides..]
        {
            last.z[1] = z[1];
            self.spans.truncate(start);
            self.sides.truncate(sides);
            return;
        }
        self.list.push(Slice {
            z,
            spans: [start, self.spans.len()],
            sides: [sides, self.sides.len()],
        });
    }
}

/// The bottom and top of a block in steps, with the thickness that plates have below.
fn in_steps(block: &Block, plates: &FxHashSet<i32>) -> [i32; 2] {
    let [bottom, top] = block.y;
    let founded = match block.top {
        // What stands beside a plate reaches as deep as the plate, so that they are one solid.
        _ if bottom < top => plates.contains(&bottom),
        // Without a top it is the underside of a roof.
        top => top.is_some(),
    };
    let bottom = if founded {
        underside(bottom)
    } else {
        step(bottom)
    };
    [bottom, step(top)]
}
