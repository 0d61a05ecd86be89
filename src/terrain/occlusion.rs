//! What is visible in a column, and how far something behind it stays hidden.

/// A row after all others, small enough for sums not to overflow.
const NEVER: i32 = i32::MAX / 2;

/// What is visible in some rows of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Visible {
    /// Nothing is drawn; the ground is assumed.
    Nothing,
    /// A top at a height.
    Top(i32),
    /// A front, with its z.
    Front(i32),
    /// A roof over eaves at a height.
    Roof(i32),
}

/// Rows of a column and what is visible there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct View {
    pub(super) start: i32,
    pub(super) end: i32,
    pub(super) visible: Visible,
}

impl View {
    /// The smallest visible z.
    pub(super) fn back(&self) -> i32 {
        match self.visible {
            Visible::Nothing => self.start,
            Visible::Top(level) | Visible::Roof(level) => self.start + level,
            Visible::Front(plane) => plane,
        }
    }

    /// The smallest visible height.
    fn bottom(&self) -> i32 {
        match self.visible {
            Visible::Nothing => 0,
            Visible::Top(level) | Visible::Roof(level) => level,
            Visible::Front(plane) => plane - self.end,
        }
    }

    /// The first row where the visible point is lower than a height.
    fn sinks_below(&self, height: i32) -> i32 {
        match self.visible {
            Visible::Front(plane) => (plane - height).max(self.start),
            _ => self.start,
        }
    }
}

/// Finds the row at which a hidden block would become visible. Filled from the column's bottom to its top.
#[derive(Debug, Default)]
pub(super) struct Occlusion {
    /// A monotonic stack of views: from the last to the first they are farther down and their `back` is smaller.
    backs: Vec<usize>,
    /// The same for `bottom`.
    bottoms: Vec<usize>,
}

impl Occlusion {
    pub(super) fn clear(&mut self) {
        self.backs.clear();
        self.bottoms.clear();
    }

    pub(super) fn push(&mut self, views: &[View], index: usize) {
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

    /// The first row at which a wall at z would be visible.
    pub(super) fn wall_seen(&self, views: &[View], z: i32, end: i32) -> i32 {
        let at = self.backs.partition_point(|view| views[*view].back() < z);
        match at.checked_sub(1) {
            Some(at) => views[self.backs[at]].start,
            // Beyond the border is the ground.
            None if end < z => end,
            None => NEVER,
        }
    }

    /// The first row at which a level at a height would be visible.
    pub(super) fn level_seen(&self, views: &[View], height: i32, end: i32) -> i32 {
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

/// The first row from `row` on in which a wall at z would be seen; beyond the drawing it would be.
pub(super) fn wall_seen(views: &[View], row: i32, z: i32) -> i32 {
    let start = views.partition_point(|view| view.end <= row);
    let mut row = row;
    for view in &views[start..] {
        let hides = match view.visible {
            Visible::Nothing => false,
            // The point of the wall in a row is hidden by a top that is farther to the front there.
            Visible::Top(level) | Visible::Roof(level) => row.max(view.start) + level >= z,
            Visible::Front(plane) => plane >= z,
        };
        if view.start > row || !hides {
            break;
        }
        row = view.end;
    }
    row
}
