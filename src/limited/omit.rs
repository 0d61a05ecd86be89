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
        Length::Kept => Some(Queue::new(
            poses.map(|pose| duplication_key(list, pose)).collect(),
        )),
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
            let place = slowest.first();
            let Some((place, twice)) = place.and_then(|place| Some((place, list.previous(place)?)))
            else {
                list.restore(pose);
                break;
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
