//! How much work a drawing may cause: one budget of counted work, which grows with the size of the drawing. Counts are the same in every
//! run and on every machine, unlike time.
//!
//! What would go over is done more coarsely where the drawing is too fine to see it, or refused. Tests count the steps that are taken.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// A kind of work that is limited.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Work {
    /// Dashes of strokes.
    Dashes,
    /// Triangles of solids.
    Triangles,
    /// Triangles of what is rounded or pointed, with the fewest layers that it may have.
    LeastTriangles,
    /// Triangles of plates, and of what is rounded although no string says so with the fewest layers.
    UnaskedTriangles,
    /// Points of clips, once for each shape that is clipped.
    ClipPoints,
    /// Pairs of corners of outlines with many, in kinds of solids that compare them, in units of 512.
    ComparedCorners,
    /// Pairs of shapes that lie over one another.
    Overlaps,
    /// Keys of clips: frames times parts that move.
    Keys,
}

impl Work {
    /// How much of it is free for any drawing, and how much more each point that it draws allows for.
    const fn allowance(self) -> (u64, u64) {
        match self {
            Self::Dashes => (5_000, 1),
            // A plate takes four of each point.
            Self::Triangles => (450_000, 8),
            Self::LeastTriangles => (600_000, 16),
            Self::UnaskedTriangles => (800_000, 0),
            Self::ClipPoints => (4_000_000, 32),
            // One outline of 4,096.
            Self::ComparedCorners => (1 << 15, 1),
            Self::Overlaps => (1 << 14, 1),
            Self::Keys => (2_000_000, 8),
        }
    }
}

/// The budget of a drawing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Budget {
    points: u64,
}

impl Budget {
    /// That of a drawing whose paths have so many points.
    pub(crate) fn of(points: usize) -> Self {
        Self {
            points: points as u64,
        }
    }

    /// How much of a kind of work it allows for.
    pub(crate) fn most(self, work: Work) -> u64 {
        let (free, each) = work.allowance();
        free.max(each.saturating_mul(self.points))
    }

    /// How much each of several may cause at most so that all of them together keep within the budget: those that want less than the
    /// others leave more to these. `None` if each may have what it wants.
    pub(crate) fn share(self, work: Work, mut wanted: Vec<u64>) -> Option<u64> {
        let mut left = self.most(work);
        wanted.sort_unstable();
        for (index, own) in wanted.iter().enumerate() {
            let share = left / (wanted.len() - index) as u64;
            if *own > share {
                return Some(share);
            }
            left -= own;
        }
        None
    }
}

/// What takes a step of counted work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// A point of an outline that is given valid polygons.
    Point,
    /// A pair of edges that is compared.
    Pair,
    /// An edge that is looked at for the disc at a point.
    DiscEdge,
    /// A cell of a grid with a triangle over it.
    Cell,
    /// A triangle of a surface.
    Triangle,
    /// A shape that a text may mean.
    Candidate,
    /// A pair of shapes, one of which may reach around the other.
    Overlap,
}

/// All kinds of steps.
pub const STEPS: [Step; 7] = [
    Step::Point,
    Step::Pair,
    Step::DiscEdge,
    Step::Cell,
    Step::Triangle,
    Step::Candidate,
    Step::Overlap,
];

static IS_COUNTING: AtomicBool = AtomicBool::new(false);
static COUNTS: [AtomicU64; STEPS.len()] = [const { AtomicU64::new(0) }; STEPS.len()];

/// Counts steps, if a test has asked for it.
pub(crate) fn count(step: Step, times: usize) {
    if IS_COUNTING.load(Ordering::Relaxed) {
        COUNTS[step as usize].fetch_add(times as u64, Ordering::Relaxed);
    }
}

/// Does work and returns how many steps of each kind of [`STEPS`] were taken by the process meanwhile.
pub fn counted(work: impl FnOnce()) -> [u64; STEPS.len()] {
    let read = || COUNTS.each_ref().map(|count| count.load(Ordering::Relaxed));
    IS_COUNTING.store(true, Ordering::Relaxed);
    let before = read();
    work();
    let after = read();
    std::array::from_fn(|step| after[step] - before[step])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_grows_with_the_drawing() {
        let [small, large] = [10, 100_000].map(Budget::of);
        assert_eq!(small.most(Work::Dashes), 5_000);
        assert_eq!(large.most(Work::Dashes), 100_000);
    }

    #[test]
    fn shares_keep_within_a_budget() {
        let budget = Budget::of(0);
        assert_eq!(budget.share(Work::Dashes, vec![2_000, 3_000]), None);
        let wanted = vec![12_500, 250, 7_500, 2250];
        let share = budget.share(Work::Dashes, wanted.clone()).unwrap();
        assert_eq!(share, 1_583);
        let given: u64 = wanted.iter().map(|own| *own.min(&share)).sum();
        assert!(given <= budget.most(Work::Dashes));
    }
}
