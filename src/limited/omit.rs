//! Omission (naka-nashi): makes fast motion faster (Kitamura 5.2.2, Algorithm 2).

use super::pose_list::PoseList;
use super::queue::{Queue, ascending, descending};
use super::{Length, MAX_COPIED_FRAMES};

/// The omissions, as source frames in the order in which they were chosen.
pub(super) struct Omitted {
    pub(super) omitted: Vec<u32>,
    pub(super) duplicated: Vec<u32>,
    /// The most poses that are missing between two remaining ones.
    pub(super) omitted_run: usize,
}

/// Omits up to `asked` poses.
pub(super) fn omit(list: &mut PoseList<'_>, asked: usize, length: Length) -> Omitted {
    let mut done = Omitted {
        omitted: Vec::new(),
        duplicated: Vec::new(),
        omitted_run: 0,
    };
    if asked == 0 {
        return done;
    }
    let poses = 0..list.len();
    let mut fastest = Queue::new(poses.clone().map(|pose| omission_key(list, pose)).collect());
    let mut slowest = match length {
        Length::Kept => {
            let keys = poses.map(|pose| duplication_key(list, pose)).collect();
            Some(Sides::new(list, keys))
        }
        Length::Shortened => None,
    };
    while done.omitted.len() < asked {
        let Some(pose) = fastest.first() else { break };
        let after = list.next(pose);
        list.remove(pose);
        fastest.set(pose, Queue::OUT);
        if let Some(after) = after {
            fastest.set(after, omission_key(list, after));
        }
        if let Some(slowest) = &mut slowest {
            slowest.set(pose, Queue::OUT);
            if let Some(after) = after {
                slowest.set(after, duplication_key(list, after));
            }
            let place = slowest.first_beside(pose);
            let Some((place, twice)) = place.and_then(|place| Some((place, list.previous(place)?)))
            else {
                list.restore(pose);
                // Poses on the other side of the key pose may still be omitted.
                for pose in slowest.side_of(pose) {
                    fastest.set(pose, Queue::OUT);
                }
                continue;
            };
            list.shown[twice] += 1;
            fastest.set(twice, omission_key(list, twice));
            slowest.set(place, duplication_key(list, place));
            done.duplicated.push(list.source(twice));
        }
        done.omitted.push(list.source(pose));
    }
    done.omitted_run = omitted_run(list);
    done
}

/// The poses by which others are duplicated, up to the key pose and after it. The key pose itself is duplicated after its first frame,
/// so neither side moves it.
struct Sides {
    queues: [Queue; 2],
    /// The number of poses up to the key pose; of all if there is none.
    split: usize,
}

impl Sides {
    fn new(list: &PoseList<'_>, mut keys: Vec<u64>) -> Self {
        let split = list.key().map_or(keys.len(), |key| key + 1);
        let after = keys.split_off(split);
        Self {
            queues: [keys, after].map(Queue::new),
            split,
        }
    }

    fn set(&mut self, pose: usize, key: u64) {
        match pose.checked_sub(self.split) {
            None => self.queues[0].set(pose, key),
            Some(pose) => self.queues[1].set(pose, key),
        }
    }

    /// The first pose on the same side of the key pose as another one.
    fn first_beside(&self, pose: usize) -> Option<usize> {
        if pose < self.split {
            self.queues[0].first()
        } else {
            Some(self.queues[1].first()? + self.split)
        }
    }

    /// All poses on the same side of the key pose as another one.
    fn side_of(&self, pose: usize) -> std::ops::Range<usize> {
        if pose < self.split {
            0..self.split
        } else {
            self.split..self.split + self.queues[1].len()
        }
    }
}

fn omission_key(list: &PoseList<'_>, pose: usize) -> u64 {
    if list.is_removable(pose) {
        descending(list.speed[pose])
    } else {
        Queue::OUT
    }
}

fn duplication_key(list: &PoseList<'_>, pose: usize) -> u64 {
    match list.previous(pose) {
        Some(before) if list.shown[before] < MAX_COPIED_FRAMES => ascending(list.speed[pose]),
        _ => Queue::OUT,
    }
}

/// The most poses that were removed in a row. Nothing has been held yet, so every missing pose was omitted.
fn omitted_run(list: &PoseList<'_>) -> usize {
    let (mut most, mut next) = (0, 0);
    for pose in list.remaining() {
        most = most.max(pose - next);
        next = pose + 1;
    }
    most.max(list.len() - next)
}
