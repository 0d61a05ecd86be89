//! Limited animation as it is defined, in its simplest form: all speeds are computed from scratch in each step. The fast code is
//! compared with it.

use glam::DVec3;

/// For how many frames a pose may stand that is shown by copying.
const LONGEST: usize = 3;

/// What the plain algorithm made of a motion; numbers are source frames.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Plain {
    /// What is shown when.
    pub(crate) shown: Vec<u32>,
    pub(crate) omitted: Vec<u32>,
    pub(crate) duplicated: Vec<u32>,
    /// What was covered, and by what.
    pub(crate) held: Vec<(u32, u32)>,
}

/// A motion that is cut.
struct Motion<'a> {
    positions: &'a [DVec3],
    joints: usize,
    shown: Vec<u32>,
    /// What stays shown, in its frame.
    key: Option<u32>,
    /// Whether nothing more is omitted before that, and after it.
    ended: [bool; 2],
}

/// Per frame whether all its positions are those of the frame before.
pub(crate) fn repeats(positions: &[DVec3], joints: usize) -> Vec<bool> {
    let frames = positions.len().checked_div(joints).unwrap_or(0);
    let pose = |frame: usize| &positions[frame * joints..][..joints];
    let repeat = |frame: usize| frame > 0 && pose(frame) == pose(frame - 1);
    (0..frames).map(repeat).collect()
}

/// Omits and holds; `positions` are frames × joints, `repeats` says which frames are equal to the one before, and the pose of the
/// frame `key` stays where it is.
pub(crate) fn plain(
    positions: &[DVec3],
    joints: usize,
    repeats: &[bool],
    [omit, hold]: [usize; 2],
    kept: bool,
    key: Option<usize>,
) -> Plain {
    let frames = positions.len().checked_div(joints).unwrap_or(0);
    let mut motion = Motion {
        positions,
        joints,
        shown: (0..frames as u32).collect(),
        key: None,
        ended: [false; 2],
    };
    // Equal neighbours are one pose: its first frame stands for all.
    for (frame, repeats) in repeats.iter().enumerate().take(frames) {
        if *repeats {
            motion.shown[frame] = motion.shown[frame - 1];
        }
    }
    motion.key = key.and_then(|key| motion.shown.get(key).copied());
    let mut done = Plain::default();
    for _ in 0..omit {
        if !motion.omit(&mut done, kept) {
            break;
        }
    }
    for _ in 0..hold {
        if !motion.hold(&mut done) {
            break;
        }
    }
    done.shown = motion.shown;
    done
}

impl Motion<'_> {
    fn pose(&self, source: u32) -> &[DVec3] {
        &self.positions[source as usize * self.joints..][..self.joints]
    }

    /// The speed of each shown frame: equation 5.1. Infinite where it is no number.
    fn speeds(&self) -> Vec<f64> {
        let mut speeds = vec![0.0; self.shown.len().min(1)];
        for pair in self.shown.windows(2) {
            let mut sum = 0.0;
            for (before, here) in self.pose(pair[0]).iter().zip(self.pose(pair[1])) {
                let step = *here - *before;
                sum += step.x * step.x + step.y * step.y + step.z * step.z;
            }
            speeds.push(if sum.is_nan() { f64::INFINITY } else { sum });
        }
        speeds
    }

    /// For how many frames the pose stands that frame `k` shows.
    fn stands(&self, k: usize) -> usize {
        let same = |other: &&u32| **other == self.shown[k];
        let before = self.shown[..k].iter().rev().take_while(same).count();
        before + self.shown[k..].iter().take_while(same).count()
    }

    /// Whether the pose that frame `k` shows may go.
    fn is_free(&self, k: usize) -> bool {
        self.stands(k) == 1 && self.key != Some(self.shown[k])
    }

    fn begins(&self, k: usize) -> bool {
        self.shown[k] != self.shown[k - 1]
    }

    /// The slowest of the frames that begin a pose after one that may stand longer, and for which `fit` holds.
    fn slowest(&self, fit: impl Fn(usize) -> bool) -> Option<usize> {
        let speeds = self.speeds();
        let mut slowest = None;
        for k in 1..self.shown.len() {
            let may = self.begins(k) && self.stands(k - 1) < LONGEST && fit(k);
            if may && slowest.is_none_or(|slowest: usize| speeds[k] < speeds[slowest]) {
                slowest = Some(k);
            }
        }
        slowest
    }

    /// The first frame that shows what stays; the end if nothing does.
    fn stays(&self) -> usize {
        let key = self
            .shown
            .iter()
            .position(|source| Some(*source) == self.key);
        key.unwrap_or(self.shown.len())
    }

    fn omit(&mut self, done: &mut Plain, kept: bool) -> bool {
        let speeds = self.speeds();
        let stays = self.stays();
        let mut fastest = None;
        for k in 1..self.shown.len() {
            let faster = fastest.is_none_or(|fastest: usize| speeds[k] > speeds[fastest]);
            if self.is_free(k) && !self.ended[usize::from(k > stays)] && faster {
                fastest = Some(k);
            }
        }
        let Some(fastest) = fastest else { return false };
        let whole = self.shown.clone();
        let omitted = self.shown.remove(fastest);
        if kept {
            // What is duplicated makes up for what is omitted on the same side of what stays.
            let is_after = fastest > stays;
            let stays = self.stays();
            let Some(slowest) = self.slowest(|k| (k > stays) == is_after) else {
                self.shown = whole;
                self.ended[usize::from(is_after)] = true;
                return self.omit(done, kept);
            };
            let duplicated = self.shown[slowest - 1];
            self.shown.insert(slowest, duplicated);
            done.duplicated.push(duplicated);
        }
        done.omitted.push(omitted);
        true
    }

    fn hold(&mut self, done: &mut Plain) -> bool {
        let Some(slowest) = self.slowest(|k| self.is_free(k)) else {
            return false;
        };
        done.held
            .push((self.shown[slowest], self.shown[slowest - 1]));
        self.shown[slowest] = self.shown[slowest - 1];
        true
    }
}
