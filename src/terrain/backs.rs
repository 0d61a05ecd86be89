//! Hidden ground (rule 10): where a drawing hides whether there is ground, and there is some on both sides, the ground goes on.
//!
//! Each column has *gaps*: ranges of depth without any block that stands on the ground or lower; what hangs leaves a gap below it. A gap
//! that has ground to its left and right at its depth, or else behind and in front of it, is filled up to the lower of the two, as far as
//! nothing of the filling would be seen in the drawing.

use std::ops::Range;

use rayon::prelude::*;

use super::constraints::STRIPE;
use super::occlusion::{View, Visible, wall_seen};
use super::solids::{Block, MapContext, Solids};

/// Ground in a range of depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Ground {
    /// `[back, front]`.
    z: [i32; 2],
    /// Its lowest block's bottom, and its top.
    y: [i32; 2],
    /// The material of its top.
    top: u8,
    /// The material of its sides.
    side: u8,
}

impl Ground {
    fn within(&self, z: [i32; 2]) -> Option<Self> {
        let z = [self.z[0].max(z[0]), self.z[1].min(z[1])];
        (z[0] < z[1]).then_some(Self { z, ..*self })
    }

    /// The lower of two.
    fn lower<'a>(&'a self, other: &'a Self) -> &'a Self {
        if other.y[1] < self.y[1] { other } else { self }
    }
}

/// A column with gaps, as its neighbours need it.
#[derive(Debug, Default)]
struct Gaps {
    /// The gaps from back to front.
    gaps: Vec<[i32; 2]>,
    /// The ground of the column to the left, and to the right, as far as it is beside a gap.
    beside: [Vec<Ground>; 2],
}

/// The hidden ground of each column.
pub(super) fn backs(context: &MapContext) -> Vec<Vec<Block>> {
    let columns = context.grid.columns;
    let lowest = context.levels.level.iter().min().map_or(0, |low| *low);
    let stripes = (0..columns.div_ceil(STRIPE)).into_par_iter();
    let found = stripes.map(|stripe| {
        let columns = stripe * STRIPE..((stripe + 1) * STRIPE).min(columns);
        gaps_of(context, columns, lowest)
    });
    let mut found: Vec<Gaps> = found.collect::<Vec<_>>().into_iter().flatten().collect();
    if found.iter().all(|column| column.gaps.is_empty()) {
        return vec![];
    }
    // What is beside a gap is beside its continuation in the next column too.
    let mut pass_on = |side: usize, from: usize, to: usize| {
        let passed = common(&found[from].beside[side], &found[to].gaps);
        let here = &mut found[to].beside[side];
        here.extend(passed);
        here.sort_unstable_by_key(|ground| ground.z);
        here.truncate(context.grid.rows);
    };
    (1..columns).for_each(|column| pass_on(0, column - 1, column));
    (1..columns)
        .rev()
        .for_each(|column| pass_on(1, column, column - 1));
    let columns = found.into_par_iter().enumerate();
    columns
        .map_init(Solids::default, |solids, (number, column)| {
            if column.gaps.is_empty() {
                return vec![];
            }
            fill(context, solids, number, &column)
        })
        .collect()
}

/// The parts of ground within gaps; both from back to front.
fn common(ground: &[Ground], gaps: &[[i32; 2]]) -> Vec<Ground> {
    let mut parts = vec![];
    let mut at = 0;
    for gap in gaps {
        while let Some(ground) = ground.get(at)
            && ground.z[1] <= gap[0]
        {
            at += 1;
        }
        let near = ground[at..]
            .iter()
            .take_while(|ground| ground.z[0] < gap[1]);
        parts.extend(near.filter_map(|ground| ground.within(*gap)));
    }
    parts
}

/// The gaps of a range of columns, and the ground beside each.
fn gaps_of(context: &MapContext, columns: Range<usize>, lowest: i32) -> Vec<Gaps> {
    let mut solids = Solids::default();
    let mut before: Vec<Ground> = vec![];
    let mut found: Vec<Gaps> = Vec::with_capacity(columns.len());
    let end = (columns.end + 1).min(context.grid.columns);
    for number in columns.start.saturating_sub(1)..end {
        solids.build(context, number);
        let ground = ground(&solids);
        if let Some(last) = found.last_mut() {
            last.beside[1] = common(&ground, &last.gaps);
        }
        if columns.contains(&number) {
            let gaps = gaps(&solids, lowest);
            let left = common(&before, &gaps);
            found.push(Gaps {
                gaps,
                beside: [left, vec![]],
            });
        }
        before = ground;
    }
    found
}

/// The ground of a column from back to front, without houses, and without what hangs.
fn ground(solids: &Solids) -> Vec<Ground> {
    let mut blocks: Vec<&Block> = solids.blocks[..solids.grounds].iter().collect();
    blocks.retain(|block| block.z[0] < block.z[1] && block.y[0] <= 0);
    blocks.sort_unstable_by_key(|block| block.z[0]);
    let mut bounds: Vec<i32> = blocks.iter().flat_map(|block| block.z).collect();
    bounds.sort_unstable();
    bounds.dedup();
    let mut list: Vec<Ground> = vec![];
    let mut active: Vec<&Block> = vec![];
    let mut next = 0;
    for pair in bounds.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        active.retain(|block| block.z[1] > from);
        while let Some(block) = blocks.get(next)
            && block.z[0] == from
        {
            active.push(block);
            next += 1;
        }
        let highest = active.iter().max_by_key(|block| (block.y[1], block.top));
        let bottom = active.iter().map(|block| block.y[0]).min();
        let (Some(highest), Some(bottom)) = (highest, bottom) else {
            continue;
        };
        let ground = Ground {
            z: [from, to],
            y: [bottom, highest.y[1]],
            top: highest.top.unwrap_or(highest.side),
            side: highest.side,
        };
        match list.last_mut() {
            Some(last)
                if last.z[1] == from
                    && Ground {
                        z: ground.z,
                        ..*last
                    } == ground =>
            {
                last.z[1] = to;
            }
            _ => list.push(ground),
        }
    }
    list
}

/// The ranges of depth in a column without any block, except those that hang, that something drawn could hide. `lowest` is the lowest
/// height of the map.
fn gaps(solids: &Solids, lowest: i32) -> Vec<[i32; 2]> {
    let drawn = |view: &&View| view.visible != Visible::Nothing;
    let Some(first) = solids.views.iter().find(drawn) else {
        return vec![];
    };
    let blocks = solids.blocks.iter().enumerate();
    let blocks = blocks.filter(|(at, block)| *at >= solids.grounds || block.y[0] <= 0);
    let mut blocks: Vec<[i32; 2]> = blocks.map(|(_, block)| block.z).collect();
    blocks.sort_unstable();
    let mut gaps = vec![];
    let mut from = first.start + lowest;
    for [back, front] in blocks {
        if back > from {
            gaps.push([from, back]);
        }
        from = from.max(front);
    }
    gaps
}

/// The blocks that fill the gaps of a column.
fn fill(context: &MapContext, solids: &mut Solids, number: usize, column: &Gaps) -> Vec<Block> {
    let [left, right] = &column.beside;
    let mut blocks = vec![];
    solids.build(context, number);
    for one in left {
        let from = right.partition_point(|other| other.z[1] <= one.z[0]);
        let beside = right[from..]
            .iter()
            .take_while(|other| other.z[0] < one.z[1]);
        for other in beside {
            if let Some(lower) = one
                .lower(other)
                .within([one.z[0].max(other.z[0]), one.z[1].min(other.z[1])])
            {
                hidden_parts(&solids.views, &lower, &mut blocks);
            }
        }
    }
    // What is left between ground behind and in front.
    let known = solids.grounds..solids.grounds;
    solids.blocks.splice(known, blocks.iter().copied());
    solids.grounds += blocks.len();
    let ground = ground(solids);
    for gap in &column.gaps {
        let at = ground.partition_point(|ground| ground.z[1] <= gap[0]);
        // Ground that touches the gap at its back, and what fills it.
        let from = at.saturating_sub(1);
        for pair in ground[from..].windows(2) {
            let between = [pair[0].z[1], pair[1].z[0]];
            if between[1] > gap[1] {
                break;
            }
            let lower = pair[0].lower(&pair[1]);
            if between[0] >= gap[0] && between[0] < between[1] {
                hidden_parts(
                    &solids.views,
                    &Ground {
                        z: between,
                        ..*lower
                    },
                    &mut blocks,
                );
            }
        }
    }
    blocks
}

/// Adds the parts of ground that are hidden entirely.
fn hidden_parts(views: &[View], ground: &Ground, blocks: &mut Vec<Block>) {
    let [bottom, level] = ground.y;
    let [from, to] = ground.z.map(|z| z - level);
    let mut run: Option<[i32; 2]> = None;
    let mut close = |run: Option<[i32; 2]>| {
        let Some([from, to]) = run else {
            return;
        };
        let back = from + level;
        // One row less always hides the first row of the front.
        let mut front = to + level;
        if !hides_wall(views, to, front) {
            front -= 1;
        }
        if front <= back {
            return;
        }
        let seen = wall_seen(views, front - level, front);
        let base = bottom.max(front - seen).min(level);
        blocks.push(Block {
            z: [back, front],
            y: [base, level],
            top: Some(ground.top),
            side: ground.side,
        });
    };
    let start = views.partition_point(|view| view.end <= from);
    for view in views[start..].iter().take_while(|view| view.start < to) {
        let [first, past] = [view.start.max(from), view.end.min(to)];
        let past = match view.visible {
            Visible::Nothing => first,
            Visible::Top(top) => {
                if top > level {
                    past
                } else {
                    first
                }
            }
            Visible::Roof(eaves) => {
                if eaves >= level {
                    past
                } else {
                    first
                }
            }
            Visible::Front(plane) => past.min(plane - level),
        };
        if past > first {
            match &mut run {
                Some(run) if run[1] == first => run[1] = past,
                _ => close(run.replace([first, past])),
            }
        }
    }
    close(run);
}

/// Whether a wall at z would be hidden in a row.
fn hides_wall(views: &[View], row: i32, z: i32) -> bool {
    wall_seen(views, row, z) > row
}
