//! What is solid, column by column (terrain.md, rules 1 and 5 to 9).
//!
//! A column's solids are blocks one tile wide. What is drawn gives the visible ones. Where something nearer hides what
//! lies behind or below it, blocks go on, as far as nothing of that would be seen.

use std::ops::Range;

use super::column::{Below, Column};
use super::grid::Grid;
use super::groups::{GROUND, Groups, Role};
use super::houses::House;
use super::levels::Levels;
use super::map::Tile;
use super::ties::STRIPE;

/// A row that is behind all others, and still leaves room to reckon with.
const NEVER: i32 = i32::MAX / 2;

/// A block in a column: z from back to front, y from below to above. A sheet has no height.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) z: [i32; 2],
    pub(super) y: [i32; 2],
    /// The look of its top, where nothing is drawn there; `None` where a roof stands on it.
    pub(super) top: Option<u8>,
    /// The look of its sides, where nothing is drawn there.
    pub(super) side: u8,
}

/// What is seen in some rows of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    /// Nothing: the ground is thought to be there.
    Nothing,
    /// A top at a height.
    Top(i32),
    /// A front that stands at z.
    Front(i32),
    /// A roof over eaves at a height.
    Roof(i32),
}

/// Rows of a column and what is seen there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct View {
    pub(super) start: i32,
    pub(super) end: i32,
    pub(super) seen: Seen,
}

impl View {
    /// The least z that is seen there.
    fn back(&self) -> i32 {
        match self.seen {
            Seen::Nothing => self.start,
            Seen::Top(level) | Seen::Roof(level) => self.start + level,
            Seen::Front(plane) => plane,
        }
    }

    /// The least height that is seen there.
    fn bottom(&self) -> i32 {
        match self.seen {
            Seen::Nothing => 0,
            Seen::Top(level) | Seen::Roof(level) => level,
            Seen::Front(plane) => plane - self.end,
        }
    }

    /// The first row where what is seen lies lower than a height.
    fn sinks_below(&self, height: i32) -> i32 {
        match self.seen {
            Seen::Front(plane) => (plane - height).max(self.start),
            _ => self.start,
        }
    }
}

/// What is known of the whole map.
#[derive(Debug)]
pub(super) struct Known<'a> {
    pub(super) grid: &'a Grid,
    pub(super) groups: &'a Groups,
    pub(super) levels: &'a Levels,
    pub(super) houses: &'a [House],
    /// Per stripe of columns the houses that reach into it.
    pub(super) houses_of: &'a [Vec<u32>],
    /// Per group of fronts whether it ends flush with what is behind it (rule 6).
    pub(super) flush: &'a [Option<i32>],
    /// The look of earth where none is drawn.
    pub(super) earth: Option<u8>,
}

/// The blocks of a column and what is seen of them; both lists are used again.
#[derive(Debug, Default)]
pub(super) struct Solids {
    column: Column,
    /// What is seen, from the top.
    pub(super) views: Vec<View>,
    /// In no order; they may overlap.
    pub(super) blocks: Vec<Block>,
    /// Per segment how far back what it shows goes on: z.
    backs: Vec<i32>,
    hidden: Hidden,
}

/// Answers where things come to be seen. Filled from the column's bottom to its top.
#[derive(Debug, Default)]
struct Hidden {
    /// Views farther and farther down with lesser and lesser `back`; the last is the nearest.
    backs: Vec<usize>,
    /// The same for `bottom`.
    bottoms: Vec<usize>,
}

impl Hidden {
    fn clear(&mut self) {
        self.backs.clear();
        self.bottoms.clear();
    }

    fn push(&mut self, views: &[View], index: usize) {
        while let Some(last) = self.backs.last()
            && views[*last].back() >= views[index].back()
        {
            self.backs.pop();
        }
        self.backs.push(index);
        while let Some(last) = self.bottoms.last()
            && views[*last].bottom() >= views[index].bottom()
        {
            self.bottoms.pop();
        }
        self.bottoms.push(index);
    }

    /// The first row below all that was pushed, or of it, at which a wall at z would be seen.
    fn wall_seen(&self, views: &[View], z: i32, end: i32) -> i32 {
        let at = self.backs.partition_point(|view| views[*view].back() < z);
        match at.checked_sub(1) {
            Some(at) => views[self.backs[at]].start,
            // Below the border there is the ground.
            None if end < z => end,
            None => NEVER,
        }
    }

    /// The first row at which something at a height would be seen.
    fn level_seen(&self, views: &[View], height: i32, end: i32) -> i32 {
        let at = self
            .bottoms
            .partition_point(|view| views[*view].bottom() < height);
        match at.checked_sub(1) {
            Some(at) => views[self.bottoms[at]].sinks_below(height),
            None if height <= 0 => NEVER,
            None => end,
        }
    }
}

impl Solids {
    /// Finds what is seen in a column, and builds nothing.
    pub(super) fn look_at(&mut self, known: &Known<'_>, number: usize) {
        self.column.read(known.grid, known.groups, number);
        self.look(known);
    }

    /// Builds a column.
    pub(super) fn build(&mut self, known: &Known<'_>, number: usize) {
        self.look_at(known, number);
        self.go_back(known);
        self.blocks.clear();
        self.hidden.clear();
        let end = known.grid.rows as i32;
        for index in (0..self.views.len()).rev() {
            match self.column.segments[index].role {
                Role::Surface(surface) => self.surface(known, number, index, surface, end),
                Role::Front => self.front(known, number, index, end),
                Role::Wall(house) => self.foundation(known, number, index, house, end),
                Role::Roof(_) | Role::Nothing => {}
            }
            self.hidden.push(&self.views, index);
        }
        self.walls(known, number);
    }

    /// What is seen in each segment.
    fn look(&mut self, known: &Known<'_>) {
        self.views.clear();
        let level = |surface: u32| known.levels.level[surface as usize];
        let house = |house: u32| &known.houses[house as usize];
        for (index, segment) in self.column.segments.iter().enumerate() {
            let seen = match segment.role {
                Role::Nothing => Seen::Nothing,
                Role::Surface(surface) => Seen::Top(level(surface)),
                Role::Roof(number) => Seen::Roof(house(number).eaves()),
                Role::Wall(number) => Seen::Front(house(number).front),
                Role::Front => {
                    let above = index
                        .checked_sub(1)
                        .map(|above| self.column.segments[above]);
                    match above.map(|above| above.role) {
                        Some(Role::Surface(surface)) => Seen::Front(segment.start + level(surface)),
                        Some(Role::Wall(number)) => Seen::Front(house(number).front),
                        _ => Seen::Front(segment.end + self.level_below(known, index)),
                    }
                }
            };
            self.views.push(View {
                start: segment.start,
                end: segment.end,
                seen,
            });
        }
    }

    /// How high that lies which a front without a top stands on.
    fn level_below(&self, known: &Known<'_>, front: usize) -> i32 {
        let level = |surface: u32| known.levels.level[surface as usize];
        match self.column.segments.get(front + 1).map(|next| next.role) {
            Some(Role::Surface(surface)) => level(surface),
            Some(Role::Roof(_) | Role::Wall(_)) => {
                let foot = self.column.foot(front + 1);
                foot.map_or(0, |(surface, fronts)| level(surface) + fronts)
            }
            _ => 0,
        }
    }

    /// The look of the sides of what a segment's front belongs to.
    fn side(&self, known: &Known<'_>, number: usize, front: usize, top: u8) -> u8 {
        match self.column.segments.get(front) {
            Some(segment) if segment.role == Role::Front => {
                known.grid.cells[number * known.grid.rows + segment.start as usize]
            }
            _ => known.earth.unwrap_or(top),
        }
    }

    /// How far back the tops of a column go on: as far as what stands on them.
    fn go_back(&mut self, known: &Known<'_>) {
        self.backs.clear();
        for index in 0..self.views.len() {
            let back = match self.column.segments[index].role {
                Role::Surface(surface) => {
                    let level = known.levels.level[surface as usize];
                    let own = self.views[index].back();
                    own.min(self.back_of_block(known, index, level).unwrap_or(own))
                }
                Role::Wall(house) => known.houses[house as usize].back(),
                _ => self.views[index].back(),
            };
            self.backs.push(back);
        }
    }

    /// Where the back of that is which stands on a segment at a height, if something does.
    fn back_of_block(&self, known: &Known<'_>, index: usize, level: i32) -> Option<i32> {
        let above = index.checked_sub(1)?;
        let front = self.column.segments[above];
        if let Role::Wall(house) = front.role {
            // Where something nearer hides the foot the house stands behind that, not on it.
            let stands = known.houses[house as usize].base == level;
            return stands.then_some(self.backs[above]);
        }
        if front.role != Role::Front {
            return None;
        }
        let Seen::Front(plane) = self.views[above].seen else {
            return None;
        };
        let block = above.checked_sub(1);
        match block.map(|block| (block, self.column.segments[block].role)) {
            Some((block, Role::Surface(_) | Role::Wall(_))) => {
                (plane - front.end == level).then_some(self.backs[block])
            }
            // One tile deep.
            _ => Some(plane - 1),
        }
    }

    /// The block of a top, and what goes on hidden.
    fn surface(&mut self, known: &Known<'_>, number: usize, index: usize, surface: u32, end: i32) {
        let segment = self.column.segments[index];
        let level = known.levels.level[surface as usize];
        let look = known.grid.cells[number * known.grid.rows + segment.start as usize];
        let side = self.side(known, number, index + 1, look);
        let (fronts, _, _) = self.column.below(index);
        let [back, front] = [self.backs[index], segment.end + level];
        let bottom = self.bottom(known, index, surface, end);
        self.flush_below(known, number, index, [level, bottom], side);
        if fronts == 0 {
            self.support(known, index, surface, index + 1, end);
        }
        self.blocks.push(Block {
            z: [back, front],
            y: [bottom, level],
            top: Some(look),
            side,
        });
        // On behind what hides it.
        if fronts == 0
            && let Some(nearer) = self.views.get(index + 1)
            && let Seen::Top(top) | Seen::Roof(top) = nearer.seen
        {
            let seen = self.hidden.level_seen(&self.views, level, end);
            let hidden = (top - level).min(seen - segment.end);
            let end = self.hidden.wall_seen(&self.views, front + hidden, end);
            let bottom = bottom.max(front + hidden - end).min(level);
            self.blocks.push(Block {
                z: [front, front + hidden],
                y: [bottom, level],
                top: Some(look),
                side,
            });
        }
    }

    /// How far down the block of a top goes: to its foot, and farther where that is hidden.
    fn bottom(&self, known: &Known<'_>, index: usize, surface: u32, end: i32) -> i32 {
        let segment = self.column.segments[index];
        let level = known.levels.level[surface as usize];
        let (fronts, _, _) = self.column.below(index);
        let seen = self.hidden.wall_seen(&self.views, segment.end + level, end);
        let base = known.levels.base[surface as usize];
        (level - fronts).min(base.max(level - (seen - segment.end)))
    }

    /// Fills below a front that hangs, so that it ends flush with what is behind it (rule 6).
    fn flush_below(
        &mut self,
        known: &Known<'_>,
        number: usize,
        index: usize,
        [level, bottom]: [i32; 2],
        side: u8,
    ) {
        let Some(front) = self.column.segments.get(index + 1) else {
            return;
        };
        if front.role != Role::Front {
            return;
        }
        let label = known.groups.labels[number * known.grid.rows + front.start as usize];
        let Some(lowest) = known.flush[label as usize] else {
            return;
        };
        let segment = self.column.segments[index];
        // No farther than fronts are drawn in this column: what is added must not be seen elsewhere.
        let lowest = lowest.min(front.end - 1);
        let support = self.level_below(known, index + 1);
        let [back, plane] = [segment.start + level, segment.end + level];
        // Below the first of these levels nothing of the depth is left.
        for y in support.max(back - lowest)..bottom {
            self.blocks.push(Block {
                z: [back, plane.min(y + lowest + 1)],
                y: [y, y + 1],
                top: Some(side),
                side,
            });
        }
    }

    /// What a cliff stands on goes on below and before it where its foot is hidden. To be called when all that is below the
    /// cliff, and nothing of the cliff, is among what may hide something; `next` is what follows.
    fn support(&mut self, known: &Known<'_>, index: usize, surface: u32, next: usize, end: i32) {
        let Some(support) = known.levels.support[surface as usize] else {
            return;
        };
        let [level, base] =
            [&known.levels.level, &known.levels.base].map(|of| of[support as usize]);
        let follows = self.column.segments.get(next).map(|next| next.role);
        let follows = follows == Some(Role::Surface(support));
        let bottom = self.bottom(known, index, surface, end);
        if support == GROUND || base >= level || bottom != level || follows {
            return;
        }
        let plane = self.column.segments[index].end + known.levels.level[surface as usize];
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
            let cell = known.groups.surfaces[support as usize].first;
            let look = known.grid.cells[cell];
            self.blocks.push(Block {
                z: [back, front],
                y: [base, level],
                top: Some(look),
                side: known.earth.unwrap_or(look),
            });
        }
    }

    /// A front belongs to what is above it. One without anything above is a block one tile deep (rule 9).
    fn front(&mut self, known: &Known<'_>, number: usize, index: usize, end: i32) {
        let above = index
            .checked_sub(1)
            .map(|above| self.column.segments[above].role);
        match above {
            Some(Role::Surface(surface)) => {
                return self.support(known, index - 1, surface, index + 1, end);
            }
            Some(Role::Wall(_)) => return,
            _ => {}
        }
        let segment = self.column.segments[index];
        let Seen::Front(plane) = self.views[index].seen else {
            return;
        };
        let look = known.grid.cells[number * known.grid.rows + segment.start as usize];
        self.blocks.push(Block {
            z: [plane - 1, plane],
            y: [plane - segment.end, plane - segment.start],
            top: Some(look),
            side: look,
        });
    }

    /// The blocks of houses, also where something nearer hides the wall.
    fn walls(&mut self, known: &Known<'_>, number: usize) {
        let column = number as i32;
        for house in &known.houses_of[number / STRIPE] {
            let house = &known.houses[*house as usize];
            if house.walls.contains(&column) {
                let wall = house.looks[1];
                self.blocks.push(Block {
                    z: [house.back(), house.front],
                    y: [house.base, house.eaves()],
                    top: (!house.roof.contains(&column)).then_some(wall),
                    side: wall,
                });
            }
        }
    }

    /// What a house stands on where fronts are seen below its wall.
    fn foundation(&mut self, known: &Known<'_>, number: usize, index: usize, house: u32, end: i32) {
        let house = &known.houses[house as usize];
        let (fronts, below, _) = self.column.below(index);
        if fronts == 0 {
            return;
        }
        let foot = match below {
            Below::Surface(surface) => known.levels.level[surface as usize],
            Below::House(_) => house.base - fronts,
        };
        let side = self.side(known, number, index + 1, house.looks[1]);
        let seen = self.hidden.wall_seen(&self.views, house.front, end);
        let hidden = house.base - (seen - self.column.segments[index].end);
        self.blocks.push(Block {
            z: [house.back(), house.front],
            y: [(house.base - fronts).min(foot.max(hidden)), house.base],
            top: Some(side),
            side,
        });
    }

    /// The looks of rows, where what is seen there passes a test and where not: for each run of rows its first, the one
    /// behind its last, and the look that is drawn.
    pub(super) fn looks(
        &self,
        known: &Known<'_>,
        number: usize,
        rows: Range<i32>,
        is: impl Fn(Seen) -> bool,
        mut each: impl FnMut(Range<i32>, Option<u8>),
    ) {
        let end = rows.end.min(known.grid.rows as i32);
        let mut row = rows.start;
        if row < 0 {
            each(row..rows.end.min(0), None);
            row = 0;
        }
        let mut at = self.views.partition_point(|view| view.end <= row);
        let cells = &known.grid.cells[number * known.grid.rows..];
        while row < end {
            let view = &self.views[at];
            let to = view.end.min(end);
            if is(view.seen) {
                while row < to {
                    let look = cells[row as usize];
                    let same = cells[row as usize..to as usize].iter();
                    let run = same.take_while(|other| **other == look).count() as i32;
                    each(row..row + run, Some(look));
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

/// Which groups of fronts end flush with what is behind them: those with an edge to another front all of whose columns
/// hang; per group its lowest row (rule 6).
pub(super) fn flush(grid: &Grid, groups: &Groups, levels: &Levels) -> Vec<Option<i32>> {
    let mut lowest = vec![None::<i32>; groups.roles.len()];
    let rows = grid.rows;
    let front = |cell: usize| grid.tile(cell) == Tile::Brown;
    if !grid.edges.iter().any(|edges| *edges != 0) {
        return lowest;
    }
    for cell in 0..groups.labels.len() {
        if !front(cell) {
            continue;
        }
        let below = (cell % rows + 1 < rows && grid.edge_below(cell)).then_some(cell + 1);
        let right = cell + rows;
        let right = (right < groups.labels.len() && grid.edge_right(cell)).then_some(right);
        for other in [below, right].into_iter().flatten() {
            let [one, other] = [cell, other].map(|cell| groups.labels[cell] as usize);
            if one != other && groups.roles[other] == Role::Front {
                lowest[one].get_or_insert(0);
                lowest[other].get_or_insert(0);
            }
        }
    }
    let mut column = Column::default();
    for number in 0..grid.columns {
        column.read(grid, groups, number);
        for index in 0..column.segments.len() {
            let segment = column.segments[index];
            if segment.role != Role::Front {
                continue;
            }
            let cells =
                number * rows + segment.start as usize..number * rows + segment.end as usize;
            let hangs = hangs(&column, levels, index);
            for cell in cells {
                let label = groups.labels[cell] as usize;
                if let Some(low) = &mut lowest[label] {
                    // What stands somewhere needs no filling.
                    *low = if hangs && *low >= 0 {
                        (*low).max((cell % rows) as i32)
                    } else {
                        -1
                    };
                }
            }
        }
    }
    lowest
        .iter_mut()
        .for_each(|low| *low = low.filter(|low| *low >= 0));
    lowest
}

/// Whether a front's foot is seen to be above what lies below it.
fn hangs(column: &Column, levels: &Levels, front: usize) -> bool {
    let above = front
        .checked_sub(1)
        .map(|above| column.segments[above].role);
    let Some(Role::Surface(surface)) = above else {
        return false;
    };
    let foot = levels.level[surface as usize] - column.segments[front].rows();
    match column.below(front - 1) {
        (_, Below::Surface(below), _) => foot > levels.level[below as usize],
        (_, Below::House(_), _) => false,
    }
}
