//! The solid blocks of each column.
//!
//! A column consists of blocks one tile wide. Visible blocks follow from what is drawn. Where something nearer hides the space
//! behind or below it, blocks continue there as far as they stay hidden.

use std::ops::Range;

use super::column::{Below, Column};
use super::constraints::STRIPE;
use super::grid::Grid;
use super::groups::{GROUND, GroupKind, Groups};
use super::houses::House;
use super::levels::Levels;
use super::occlusion::{Occlusion, View, Visible};
use super::plain::Plain;

/// A block in a column: `[back, front]` and `[bottom, top]`. If these are equal, it is a plate whose top is there, or, under a
/// roof, the roof's underside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) z: [i32; 2],
    pub(super) y: [i32; 2],
    /// The material of its top where none is drawn; `None` under a roof.
    pub(super) top: Option<u8>,
    /// The material of its sides where none is drawn.
    pub(super) side: u8,
}

/// The map and everything computed from it, which columns are built from.
#[derive(Debug)]
pub(super) struct MapContext {
    pub(super) grid: Grid,
    pub(super) groups: Groups,
    pub(super) levels: Levels,
    pub(super) houses: Vec<House>,
    /// Per stripe of columns the houses that extend into it.
    pub(super) houses_of: Vec<Vec<u32>>,
    /// Per group of fronts its lowest row, if it ends flush with what is behind it (rule 6).
    pub(super) flush: Vec<Option<i32>>,
    /// The material of earth where none is drawn.
    pub(super) earth: Option<u8>,
    /// For plain maps their floor and walls; `None` for maps in the drawn look.
    pub(super) plain: Option<Plain>,
    /// Per column the ground that the drawing hides (rule 10); empty before it is known, and if there is none.
    pub(super) backs: Vec<Vec<Block>>,
}

/// The blocks of a column and what is visible of them, in reused lists.
#[derive(Debug, Default)]
pub(super) struct Solids {
    /// Its number in the map.
    number: usize,
    column: Column,
    /// What is visible, from the top; one view a segment.
    pub(super) views: Vec<View>,
    /// In no order; they may overlap.
    pub(super) blocks: Vec<Block>,
    /// How many of the blocks, from the first, are ground and not houses.
    pub(super) grounds: usize,
    /// Per segment the z of its block's back.
    backs: Vec<i32>,
    hidden: Occlusion,
}

impl Solids {
    /// Reads a column and finds what is visible in it, without building blocks.
    pub(super) fn read_views(&mut self, context: &MapContext, number: usize) {
        self.number = number;
        self.column.read(&context.grid, &context.groups, number);
        self.find_views(context);
    }

    pub(super) fn build(&mut self, context: &MapContext, number: usize) {
        if let Some(plain) = &context.plain {
            self.number = number;
            self.blocks.clear();
            return plain.blocks(context, number, &mut self.blocks);
        }
        self.read_views(context, number);
        self.extend_backs(context);
        self.blocks.clear();
        self.hidden.clear();
        let end = context.grid.rows as i32;
        for index in (0..self.views.len()).rev() {
            match self.column.segments[index].kind {
                GroupKind::Surface(surface) => self.surface(context, index, surface, end),
                GroupKind::Front => self.front(context, index, end),
                GroupKind::Wall(house) => self.foundation(context, index, house, end),
                GroupKind::Roof(_) | GroupKind::Nothing => {}
            }
            self.hidden.push(&self.views, index);
        }
        let houses = context.houses_of[number / STRIPE].iter();
        let houses = houses.map(|house| &context.houses[*house as usize]);
        let houses = houses.filter(|house| house.walls.contains(&(number as i32)));
        self.blocks.extend(houses.filter_map(|house| house.under));
        if let Some(backs) = context.backs.get(number) {
            self.blocks.extend(backs);
        }
        self.grounds = self.blocks.len();
        self.walls(context);
    }

    /// Finds what is visible in each segment.
    fn find_views(&mut self, context: &MapContext) {
        self.views.clear();
        let level = |surface: u32| context.levels.level[surface as usize];
        let house = |house: u32| &context.houses[house as usize];
        for (index, segment) in self.column.segments.iter().enumerate() {
            let visible = match segment.kind {
                GroupKind::Nothing => Visible::Nothing,
                GroupKind::Surface(surface) => Visible::Top(level(surface)),
                GroupKind::Roof(number) => Visible::Roof(house(number).eaves()),
                GroupKind::Wall(number) => Visible::Front(house(number).front),
                GroupKind::Front => {
                    let above = index
                        .checked_sub(1)
                        .map(|above| self.column.segments[above]);
                    match above.map(|above| above.kind) {
                        Some(GroupKind::Surface(surface)) => {
                            Visible::Front(segment.start + level(surface))
                        }
                        Some(GroupKind::Wall(number)) => Visible::Front(house(number).front),
                        _ => Visible::Front(segment.end + self.level_below(context, index)),
                    }
                }
            };
            self.views.push(View {
                start: segment.start,
                end: segment.end,
                visible,
            });
        }
    }

    /// The height of what a front without a top stands on.
    fn level_below(&self, context: &MapContext, front: usize) -> i32 {
        let level = |surface: u32| context.levels.level[surface as usize];
        match self.column.segments.get(front + 1).map(|next| next.kind) {
            Some(GroupKind::Surface(surface)) => level(surface),
            Some(GroupKind::Roof(_) | GroupKind::Wall(_)) => {
                let foot = self.column.foot(front + 1);
                foot.map_or(0, |(surface, fronts)| level(surface) + fronts)
            }
            _ => 0,
        }
    }

    /// The material of the sides of the block that a front belongs to.
    fn side(&self, context: &MapContext, front: usize, top: u8) -> u8 {
        match self.column.segments.get(front) {
            Some(segment) if segment.kind == GroupKind::Front => {
                context.grid.cells[self.number * context.grid.rows + segment.start as usize]
            }
            _ => context.earth.unwrap_or(top),
        }
    }

    /// Extends the tops of a column to the back of what stands on them.
    fn extend_backs(&mut self, context: &MapContext) {
        self.backs.clear();
        for index in 0..self.views.len() {
            let back = match self.column.segments[index].kind {
                GroupKind::Surface(surface) => {
                    let level = context.levels.level[surface as usize];
                    let own = self.views[index].back();
                    own.min(self.back_of_block(context, index, level).unwrap_or(own))
                }
                GroupKind::Wall(house) => context.houses[house as usize].back(),
                _ => self.views[index].back(),
            };
            self.backs.push(back);
        }
    }

    /// The back of the block that stands on a segment of this height, if there is one.
    fn back_of_block(&self, context: &MapContext, index: usize, level: i32) -> Option<i32> {
        let above = index.checked_sub(1)?;
        let front = self.column.segments[above];
        if let GroupKind::Wall(house) = front.kind {
            // Where something nearer hides the foot, the house stands behind that, not on it.
            let stands = context.houses[house as usize].base == level;
            return stands.then_some(self.backs[above]);
        }
        if front.kind != GroupKind::Front {
            return None;
        }
        let Visible::Front(plane) = self.views[above].visible else {
            return None;
        };
        let block = above.checked_sub(1);
        match block.map(|block| (block, self.column.segments[block].kind)) {
            Some((block, GroupKind::Surface(_) | GroupKind::Wall(_))) => {
                (plane - front.end == level).then_some(self.backs[block])
            }
            // One tile deep.
            _ => Some(plane - 1),
        }
    }

    /// Adds the block of a top and its hidden continuation.
    fn surface(&mut self, context: &MapContext, index: usize, surface: u32, end: i32) {
        let segment = self.column.segments[index];
        let level = context.levels.level[surface as usize];
        let material = context.grid.cells[self.number * context.grid.rows + segment.start as usize];
        let (fronts, _, _) = self.column.below(index);
        let [back, front] = [self.backs[index], segment.end + level];
        let bottom = self.bottom(context, index, surface, end);
        let side = if context.groups.surfaces[surface as usize].water && bottom == level {
            material
        } else {
            self.side(context, index + 1, material)
        };
        self.flush_below(context, index, [bottom, level], side);
        if fronts == 0 {
            self.support(context, index, surface, index + 1, end);
        }
        self.blocks.push(Block {
            z: [back, front],
            y: [bottom, level],
            top: Some(material),
            side,
        });
        // It continues behind what hides it.
        if fronts == 0
            && let Some(nearer) = self.views.get(index + 1)
            && let Visible::Top(top) | Visible::Roof(top) = nearer.visible
        {
            let rows = segment.end..segment.end + top - level;
            self.hidden_top(rows, [bottom, level], [material, side], end);
        }
    }

    /// Adds the block of a top at a height that something nearer hides in some rows, as far as it is hidden there. Must be called
    /// when `hidden` has all views from these rows on and no others.
    fn hidden_top(&mut self, rows: Range<i32>, y: [i32; 2], [top, side]: [u8; 2], end: i32) {
        let [bottom, level] = y;
        let seen = self.hidden.level_seen(&self.views, level, end);
        let front = rows.end.min(seen) + level;
        let seen = self.hidden.wall_seen(&self.views, front, end);
        self.blocks.push(Block {
            z: [rows.start + level, front],
            y: [bottom.max(front - seen).min(level), level],
            top: Some(top),
            side,
        });
    }

    /// Adds the floor of a pit below its near bank (rule 7). `front` is its far wall.
    fn floor(&mut self, context: &MapContext, front: usize, surface: u32, end: i32) {
        let wall = self.column.segments[front];
        let level = context.levels.level[surface as usize] - wall.rows();
        let base = context.levels.base[surface as usize];
        let top = context.grid.cells[self.number * context.grid.rows + wall.start as usize - 1];
        let side = self.side(context, front, top);
        let rows = wall.end..wall.end + wall.rows();
        self.hidden_top(rows, [base, level], [top, side], end);
    }

    /// The bottom of a top's block: its foot, or lower where that stays hidden.
    fn bottom(&self, context: &MapContext, index: usize, surface: u32, end: i32) -> i32 {
        let segment = self.column.segments[index];
        let level = context.levels.level[surface as usize];
        let (fronts, _, _) = self.column.below(index);
        let seen = self.hidden.wall_seen(&self.views, segment.end + level, end);
        let base = context.levels.base[surface as usize];
        (level - fronts).min(base.max(level - (seen - segment.end)))
    }

    /// Fills below a front that hangs, so that it ends flush with what is behind it (rule 6).
    fn flush_below(&mut self, context: &MapContext, index: usize, y: [i32; 2], side: u8) {
        let [bottom, level] = y;
        let Some(front) = self.column.segments.get(index + 1) else {
            return;
        };
        if front.kind != GroupKind::Front {
            return;
        }
        let label = context.groups.labels[self.number * context.grid.rows + front.start as usize];
        let Some(lowest) = context.flush[label as usize] else {
            return;
        };
        let segment = self.column.segments[index];
        // No lower than the fronts drawn in this column, so that the added blocks are not visible elsewhere.
        let lowest = lowest.min(front.end - 1);
        let support = self.level_below(context, index + 1);
        let [back, plane] = [segment.start + level, segment.end + level];
        // Below the first of these levels the remaining depth is 0.
        for y in support.max(back - lowest)..bottom {
            self.blocks.push(Block {
                z: [back, plane.min(y + lowest + 1)],
                y: [y, y + 1],
                top: Some(side),
                side,
            });
        }
    }

    /// Continues the support of a cliff below and in front of it where its foot is hidden. Must be called when `hidden` has all
    /// views below the cliff and none of the cliff; `next` is the segment after the cliff.
    fn support(&mut self, context: &MapContext, index: usize, surface: u32, next: usize, end: i32) {
        let Some(support) = context.levels.support[surface as usize] else {
            return;
        };
        let [level, base] =
            [&context.levels.level, &context.levels.base].map(|of| of[support as usize]);
        let follows = self.column.segments.get(next).map(|next| next.kind);
        let follows = follows == Some(GroupKind::Surface(support));
        let bottom = self.bottom(context, index, surface, end);
        if support == GROUND || base >= level || bottom != level || follows {
            return;
        }
        let plane = self.column.segments[index].end + context.levels.level[surface as usize];
        let back = self.backs[index];
        let before = self.views.get(next).map_or(plane, View::back);
        let hidden = self.hidden.level_seen(&self.views, level, end);
        let front = if before > plane && hidden >= before - level {
            before
        } else {
            plane
        };
        let seen = self.hidden.wall_seen(&self.views, front, end);
        let base = base.max(front - seen);
        if base < level {
            let cell = context.groups.surfaces[support as usize].first;
            let material = context.grid.cells[cell];
            self.blocks.push(Block {
                z: [back, front],
                y: [base, level],
                top: Some(material),
                side: context.earth.unwrap_or(material),
            });
        }
    }

    /// Adds the block of a front. A front belongs to what is above it; without anything above it is one tile deep (rule 9).
    fn front(&mut self, context: &MapContext, index: usize, end: i32) {
        let above = index
            .checked_sub(1)
            .map(|above| self.column.segments[above].kind);
        match above {
            Some(GroupKind::Surface(surface)) => {
                if self.column.below(index - 1).1 == Below::Surface(surface) {
                    self.floor(context, index, surface, end);
                }
                return self.support(context, index - 1, surface, index + 1, end);
            }
            Some(GroupKind::Wall(_)) => return,
            _ => {}
        }
        let segment = self.column.segments[index];
        let Visible::Front(plane) = self.views[index].visible else {
            return;
        };
        let material = context.grid.cells[self.number * context.grid.rows + segment.start as usize];
        self.blocks.push(Block {
            z: [plane - 1, plane],
            y: [plane - segment.end, plane - segment.start],
            top: Some(material),
            side: material,
        });
    }

    /// Adds the blocks of houses, also where something nearer hides the wall.
    fn walls(&mut self, context: &MapContext) {
        let column = self.number as i32;
        for house in &context.houses_of[self.number / STRIPE] {
            let house = &context.houses[*house as usize];
            let [roof, wall] = house.materials;
            let roofed = house.roof.contains(&column) && house.depth > 0;
            if house.walls.contains(&column) {
                self.blocks.push(Block {
                    z: [house.back(), house.front],
                    y: [house.base, house.eaves()],
                    top: (!roofed).then_some(wall),
                    side: wall,
                });
            } else if roofed {
                // The underside of a roof that extends beyond the walls.
                self.blocks.push(Block {
                    z: [house.back(), house.front],
                    y: [house.eaves(); 2],
                    top: None,
                    side: roof,
                });
            }
        }
    }

    /// Adds the block below a house where fronts are visible below its wall.
    fn foundation(&mut self, context: &MapContext, index: usize, house: u32, end: i32) {
        let house = &context.houses[house as usize];
        let (fronts, below, _) = self.column.below(index);
        if fronts == 0 {
            return;
        }
        let foot = match below {
            Below::Surface(surface) => context.levels.level[surface as usize],
            Below::House(_) => house.base - fronts,
        };
        let side = self.side(context, index + 1, house.materials[1]);
        let seen = self.hidden.wall_seen(&self.views, house.front, end);
        let hidden = house.base - (seen - self.column.segments[index].end);
        self.blocks.push(Block {
            z: [house.back(), house.front],
            y: [(house.base - fronts).min(foot.max(hidden)), house.base],
            top: Some(side),
            side,
        });
    }

    /// Splits rows into runs of one material: the drawn one where what is visible passes the test `is`, `None` elsewhere.
    pub(super) fn drawn_materials(
        &self,
        context: &MapContext,
        rows: Range<i32>,
        is: impl Fn(Visible) -> bool,
        mut each: impl FnMut(Range<i32>, Option<u8>),
    ) {
        // The blocks of plain maps have the materials that are drawn.
        if context.plain.is_some() {
            return each(rows, None);
        }
        let end = rows.end.min(context.grid.rows as i32);
        let mut row = rows.start;
        if row < 0 {
            each(row..rows.end.min(0), None);
            row = 0;
        }
        let mut at = self.views.partition_point(|view| view.end <= row);
        let cells = &context.grid.cells[self.number * context.grid.rows..];
        while row < end {
            let view = &self.views[at];
            let to = view.end.min(end);
            if is(view.visible) {
                while row < to {
                    let material = cells[row as usize];
                    let same = cells[row as usize..to as usize].iter();
                    let run = same.take_while(|other| **other == material).count() as i32;
                    each(row..row + run, Some(material));
                    row += run;
                }
            } else {
                each(row..to, None);
                row = to;
            }
            at += 1;
        }
        if row < rows.end {
            each(row..rows.end, None);
        }
    }
}
