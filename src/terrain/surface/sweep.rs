//! Coplanar faces merged while lines of them go by: as large rectangles as can be had in one passage.

/// Directions that faces look in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Facing {
    Right,
    Left,
    Up,
    Down,
    Front,
    Back,
}

impl Facing {
    /// The unit vector.
    pub(super) fn normal(self) -> [f32; 3] {
        match self {
            Self::Right => [1.0, 0.0, 0.0],
            Self::Left => [-1.0, 0.0, 0.0],
            Self::Up => [0.0, 1.0, 0.0],
            Self::Down => [0.0, -1.0, 0.0],
            Self::Front => [0.0, 0.0, 1.0],
            Self::Back => [0.0, 0.0, -1.0],
        }
    }

    /// The axes of the plane, the one across lines first, and the axis that it stands on.
    pub(super) fn axes(self) -> [usize; 3] {
        match self {
            Self::Right | Self::Left => [2, 1, 0],
            Self::Up | Self::Down => [0, 2, 1],
            Self::Front | Self::Back => [0, 1, 2],
        }
    }
}

/// A piece of a face on one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Strip {
    /// Where the plane stands.
    pub(super) plane: i32,
    pub(super) look: u8,
    /// Along the line.
    pub(super) along: [i32; 2],
}

/// A rectangle of one look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rect {
    pub(super) facing: Facing,
    pub(super) look: u8,
    pub(super) plane: i32,
    /// Across the lines.
    pub(super) across: [i32; 2],
    /// Along them.
    pub(super) along: [i32; 2],
}

impl Rect {
    /// Its corners, counter-clockwise seen from outside.
    pub(super) fn corners(&self) -> [[i32; 3]; 4] {
        let [across, along, up] = self.facing.axes();
        let corner = |a: usize, b: usize| {
            let mut point = [0; 3];
            point[across] = self.across[a];
            point[along] = self.along[b];
            point[up] = self.plane;
            point
        };
        // x × y = z and z × x = y, but x × z = −y.
        let turned = matches!(self.facing, Facing::Up | Facing::Right | Facing::Back);
        if turned {
            [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)]
        } else {
            [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]
        }
    }
}

/// Rectangles that may still grow.
#[derive(Debug)]
pub(super) struct Sweep {
    facing: Facing,
    /// The last line's pieces and where each began, in order.
    open: Vec<(Strip, i32)>,
    next: Vec<(Strip, i32)>,
    /// Where the last line ended.
    end: i32,
}

impl Sweep {
    pub(super) fn new(facing: Facing) -> Self {
        Self {
            facing,
            open: vec![],
            next: vec![],
            end: i32::MIN,
        }
    }

    fn close(&self, (strip, start): (Strip, i32), rects: &mut Vec<Rect>) {
        rects.push(Rect {
            facing: self.facing,
            look: strip.look,
            plane: strip.plane,
            across: [start, self.end],
            along: strip.along,
        });
    }

    /// Takes the next line: its place, and its pieces, which do not overlap and are sorted here.
    pub(super) fn line(
        &mut self,
        across: [i32; 2],
        strips: &mut Vec<Strip>,
        rects: &mut Vec<Rect>,
    ) {
        if across[0] != self.end {
            self.finish(rects);
        }
        strips.sort_unstable();
        strips.dedup_by(|next, last| {
            let joins =
                (next.plane, next.look, next.along[0]) == (last.plane, last.look, last.along[1]);
            if joins {
                last.along[1] = next.along[1];
            }
            joins
        });
        let mut open = 0;
        self.next.clear();
        for strip in strips.iter() {
            let key = (strip.plane, strip.look);
            let mut from = strip.along[0];
            while let Some((last, start)) = self.open.get(open).copied() {
                let before = (last.plane, last.look, last.along[0]) < (key.0, key.1, from);
                if before {
                    // It reaches out of what is here, or belongs elsewhere: it ends.
                    self.close((last, start), rects);
                    open += 1;
                    continue;
                }
                if (last.plane, last.look) != key || last.along[1] > strip.along[1] {
                    break;
                }
                if last.along[0] > from {
                    let along = [from, last.along[0]];
                    self.next.push((Strip { along, ..*strip }, across[0]));
                }
                self.next.push((last, start));
                from = last.along[1];
                open += 1;
            }
            if from < strip.along[1] {
                let along = [from, strip.along[1]];
                self.next.push((Strip { along, ..*strip }, across[0]));
            }
        }
        for at in open..self.open.len() {
            self.close(self.open[at], rects);
        }
        std::mem::swap(&mut self.open, &mut self.next);
        self.end = across[1];
    }

    /// Ends all rectangles.
    pub(super) fn finish(&mut self, rects: &mut Vec<Rect>) {
        for at in 0..self.open.len() {
            self.close(self.open[at], rects);
        }
        self.open.clear();
    }
}
