//! Holds (koma-dori): where the motion is slow, the pose before is held (Kitamura 5.2.3, Algorithm 3).

use super::pose_list::PoseList;
use super::queue::{Queue, ascending};
use super::{Hold, MAX_COPIED_FRAMES};

/// Holds up to `asked` poses for one frame more each. Returns which pose each of them covers, in the order of the steps.
pub(super) fn hold(list: &mut PoseList<'_>, asked: usize) -> Vec<Hold> {
    let mut held = Vec::new();
    if asked == 0 {
        return held;
    }
    let keys = (0..list.len()).map(|pose| hold_key(list, pose)).collect();
    let mut slowest = Queue::new(keys);
    while held.len() < asked {
        let Some(pose) = slowest.first() else { break };
        let Some(before) = list.previous(pose) else {
            break;
        };
        held.push(Hold {
            covered: list.source(pose),
            by: list.source(before),
        });
        list.remove(pose);
        list.shown[before] += 1;
        slowest.set(pose, Queue::OUT);
        slowest.set(before, hold_key(list, before));
        if let Some(after) = list.next(pose) {
            slowest.set(after, hold_key(list, after));
        }
    }
    held
}

fn hold_key(list: &PoseList<'_>, pose: usize) -> u64 {
    match list.previous(pose) {
        Some(before) if list.is_removable(pose) && list.shown[before] < MAX_COPIED_FRAMES => {
            ascending(list.speed[pose])
        }
        _ => Queue::OUT,
    }
}
