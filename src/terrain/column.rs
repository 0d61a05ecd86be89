//! A column of the map as a list of what follows what, from the top (terrain.md, rule 1).

use super::grid::Grid;
use super::groups::{GROUND, Groups, Role};

/// Cells of a column that belong to one thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Segment {
    /// What they belong to.
    pub(super) role: Role,
    /// The first row.
    pub(super) start: i32,
    /// The row behind the last.
    pub(super) end: i32,
}

impl Segment {
    /// How many rows it has.
    pub(super) fn rows(&self) -> i32 {
        self.end - self.start
    }
}

/// What lies below something in a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Below {
    /// A surface; the ground where nothing is drawn and at the border.
    Surface(u32),
    /// A house.
    House(u32),
}

/// Reads columns one after another; the list is used again.
#[derive(Debug, Default)]
pub(super) struct Column {
    /// From the top, without gaps; what is empty is a segment too.
    pub(super) segments: Vec<Segment>,
}

impl Column {
    /// Reads a column. Fronts of several groups that follow each other are one segment.
    pub(super) fn read(&mut self, grid: &Grid, groups: &Groups, column: usize) {
        self.segments.clear();
        let labels = &groups.labels[column * grid.rows..(column + 1) * grid.rows];
        let mut last = u32::MAX;
        for (row, label) in labels.iter().enumerate() {
            if *label == last {
                continue;
            }
            last = *label;
            let role = groups.roles[*label as usize];
            let row = row as i32;
            if let Some(before) = self.segments.last_mut() {
                if before.role == role {
                    continue;
                }
                before.end = row;
            }
            self.segments.push(Segment {
                role,
                start: row,
                end: grid.rows as i32,
            });
        }
    }

    /// How many rows of front follow a segment, and what lies below them.
    pub(super) fn below(&self, index: usize) -> (i32, Below, usize) {
        let mut next = index + 1;
        let mut fronts = 0;
        if let Some(segment) = self.segments.get(next)
            && segment.role == Role::Front
        {
            fronts = segment.rows();
            next += 1;
        }
        let below = match self.segments.get(next).map(|segment| segment.role) {
            Some(Role::Surface(surface)) => Below::Surface(surface),
            Some(Role::Roof(house) | Role::Wall(house)) => Below::House(house),
            _ => Below::Surface(GROUND),
        };
        (fronts, below, next)
    }

    /// What a segment stands on in this column, and how many rows of front are between, if that is seen. What stands
    /// on a house stands on what the house stands on.
    pub(super) fn stands_on(&self, groups: &Groups, index: usize) -> Option<(u32, i32)> {
        let role = self.segments[index].role;
        match (role, self.below(index)) {
            // A pit: what the segment stands on is hidden.
            (Role::Surface(own), (_, Below::Surface(below), _)) if own == below => None,
            // Something nearer hides its foot, unless it is the bank of water.
            (Role::Surface(_), (0, Below::Surface(below), _))
                if below != GROUND && !groups.surfaces[below as usize].water =>
            {
                None
            }
            (_, (fronts, Below::Surface(below), _)) => Some((below, fronts)),
            (_, (_, Below::House(_), next)) => self.foot(next),
        }
    }

    /// What a house stands on in this column, and how many rows of front are between; `index` is a segment of the
    /// house. `None` where the roof has no wall below it.
    pub(super) fn foot(&self, index: usize) -> Option<(u32, i32)> {
        let (mut index, mut fronts) = (index, 0);
        loop {
            let house = self.segments[index].role.house()?;
            while let Some(next) = self.segments.get(index + 1)
                && next.role.house() == Some(house)
            {
                index += 1;
            }
            if !matches!(self.segments[index].role, Role::Wall(_)) {
                return None;
            }
            let (more, below, next) = self.below(index);
            fronts += more;
            match below {
                Below::Surface(below) => return Some((below, fronts)),
                Below::House(_) => index = next,
            }
        }
    }
}
