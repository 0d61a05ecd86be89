//! Greedy meshing (Lysenko, *Meshing in a Minecraft Game*, 2012): coplanar faces of one material are merged to large rectangles.
//!
//! Faces come as lines of runs, in order. A rectangle grows as long as the next line covers it. Heights are in steps.

/// The direction that a face looks in.
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
    /// Its unit vector.
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

    /// The axis across the lines of a face, the axis along them, and the axis of its normal.
    pub(super) fn axes(self) -> [usize; 3] {
        match self {
            Self::Right | Self::Left => [2, 1, 0],
            Self::Up | Self::Down => [0, 2, 1],
            Self::Front | Self::Back => [0, 1, 2],
        }
    }
}

/// A run of faces of one material on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FaceRun {
    /// The position of the plane on its normal's axis.
    pub(super) plane: i32,
    pub(super) material: u8,
    /// Its range along the line.
    pub(super) along: [i32; 2],
}

impl FaceRun {
    pub(super) fn new(plane: i32, along: [i32; 2], material: u8) -> Self {
        Self {
            plane,
            material,
            along,
        }
    }
}

/// A rectangle of one material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rect {
    pub(super) facing: Facing,
    pub(super) material: u8,
    pub(super) plane: i32,
    /// Its range across the lines.
    pub(super) across: [i32; 2],
    /// Its range along the lines.
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

/// Merges the faces of one direction.
#[derive(Debug)]
pub(super) struct GreedyMesher {
    facing: Facing,
    /// The runs of the last line, in order, and the line at which the rectangle of each began.
    open: Vec<(FaceRun, i32)>,
    next: Vec<(FaceRun, i32)>,
    /// The end of the last line, across.
    end: i32,
}

impl GreedyMesher {
    pub(super) fn new(facing: Facing) -> Self {
        Self {
            facing,
            open: vec![],
            next: vec![],
            end: i32::MIN,
        }
    }

    fn close(&self, (run, start): (FaceRun, i32), rects: &mut Vec<Rect>) {
        rects.push(Rect {
            facing: self.facing,
            material: run.material,
            plane: run.plane,
            across: [start, self.end],
            along: run.along,
        });
    }

    /// Takes the next line: its range across, and its runs, which do not overlap and are sorted here.
    pub(super) fn line(
        &mut self,
        across: [i32; 2],
        runs: &mut Vec<FaceRun>,
        rects: &mut Vec<Rect>,
    ) {
        if across[0] != self.end {
            self.finish(rects);
        }
        runs.sort_unstable();
        runs.dedup_by(|next, last| {
            let joins = (next.plane, next.material, next.along[0])
                == (last.plane, last.material, last.along[1]);
            if joins {
                last.along[1] = next.along[1];
            }
            joins
        });
        let mut open = 0;
        self.next.clear();
        for run in runs.iter() {
            let key = (run.plane, run.material);
            let mut from = run.along[0];
            while let Some((last, start)) = self.open.get(open).copied() {
                let before = (last.plane, last.material, last.along[0]) < (key.0, key.1, from);
                if before {
                    // Its rectangle ends: the run is not covered by this line.
                    self.close((last, start), rects);
                    open += 1;
                    continue;
                }
                if (last.plane, last.material) != key || last.along[1] > run.along[1] {
                    break;
                }
                if last.along[0] > from {
                    let along = [from, last.along[0]];
                    self.next.push((FaceRun { along, ..*run }, across[0]));
                }
                self.next.push((last, start));
                from = last.along[1];
                open += 1;
            }
            if from < run.along[1] {
                let along = [from, run.along[1]];
                self.next.push((FaceRun { along, ..*run }, across[0]));
            }
        }
        for at in open..self.open.len() {
            self.close(self.open[at], rects);
        }
        std::mem::swap(&mut self.open, &mut self.next);
        self.end = across[1];
    }

    /// Ends all open rectangles.
    pub(super) fn finish(&mut self, rects: &mut Vec<Rect>) {
        for at in 0..self.open.len() {
            self.close(self.open[at], rects);
        }
        self.open.clear();
    }
}
