//! A column of the map as a list of segments from the top.

use super::grid::Grid;
use super::groups::{GROUND, GroupKind, Groups};

/// Consecutive cells of a column that belong to the same surface, front or house.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Segment {
    /// What the cells belong to.
    pub(super) kind: GroupKind,
    /// The first row.
    pub(super) start: i32,
    /// The row after the last.
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

/// Reads columns one after another into a reused list.
#[derive(Debug, Default)]
pub(super) struct Column {
    /// From the top, without gaps; empty cells form segments too.
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
            let kind = groups.kinds[*label as usize];
            let row = row as i32;
            if let Some(before) = self.segments.last_mut() {
                if before.kind == kind {
                    continue;
                }
                before.end = row;
            }
            self.segments.push(Segment {
                kind,
                start: row,
                end: grid.rows as i32,
            });
        }
    }

    /// How many rows of front follow a segment, what lies below them, and the index of that segment.
    pub(super) fn below(&self, index: usize) -> (i32, Below, usize) {
        let mut next = index + 1;
        let mut fronts = 0;
        if let Some(segment) = self.segments.get(next)
            && segment.kind == GroupKind::Front
        {
            fronts = segment.rows();
            next += 1;
        }
        let below = match self.segments.get(next).map(|segment| segment.kind) {
            Some(GroupKind::Surface(surface)) => Below::Surface(surface),
            Some(GroupKind::Roof(house) | GroupKind::Wall(house)) => Below::House(house),
            _ => Below::Surface(GROUND),
        };
        (fronts, below, next)
    }

    /// The surface that a segment stands on in this column and the rows of front between them; `None` if the foot is hidden.
    /// A segment on a house stands on whatever the house stands on.
    pub(super) fn stands_on(&self, groups: &Groups, index: usize) -> Option<(u32, i32)> {
        let kind = self.segments[index].kind;
        match (kind, self.below(index)) {
            // A pit hides what the segment stands on.
            (GroupKind::Surface(own), (_, Below::Surface(below), _)) if own == below => None,
            // Something nearer hides the foot, unless the segment is the bank of water.
            (GroupKind::Surface(_), (0, Below::Surface(below), _))
                if below != GROUND && !groups.surfaces[below as usize].water =>
            {
                None
            }
            (_, (fronts, Below::Surface(below), _)) => Some((below, fronts)),
            (_, (_, Below::House(_), next)) => self.foot(next),
        }
    }

    /// The surface that a house stands on in this column and the rows of front between them; `index` is a segment of the
    /// house. `None` where the roof has no wall below it.
    pub(super) fn foot(&self, index: usize) -> Option<(u32, i32)> {
        let (mut index, mut fronts) = (index, 0);
        loop {
            let house = self.segments[index].kind.house()?;
            while let Some(next) = self.segments.get(index + 1)
                && next.kind.house() == Some(house)
            {
                index += 1;
            }
            if !matches!(self.segments[index].kind, GroupKind::Wall(_)) {
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
