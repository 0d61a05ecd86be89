//! Holds (koma-dori): what hardly moves stands (Kitamura 5.2.3, Algorithm 3).

use super::queue::{Queue, rising};
use super::strip::Strip;
use super::{Held, LONGEST_COPIED};

/// Holds up to `asked` poses for one frame more each; what each covered, in the order in which it was done.
pub(super) fn hold(strip: &mut Strip<'_>, asked: usize) -> Vec<Held> {
    let mut held = Vec::new();
    if asked == 0 {
        return held;
    }
    let keys = (0..strip.poses()).map(|pose| key(strip, pose)).collect();
    let mut slowest = Queue::new(keys);
    while held.len() < asked {
        let Some(pose) = slowest.first() else { break };
        let Some(before) = strip.before(pose) else {
            break;
        };
        held.push(Held {
            covered: strip.source(pose),
            by: strip.source(before),
        });
        strip.take(pose);
        strip.shown[before] += 1;
        slowest.set(pose, Queue::OUT);
        slowest.set(before, key(strip, before));
        if let Some(after) = strip.after(pose) {
            slowest.set(after, key(strip, after));
        }
    }
    held
}

fn key(strip: &Strip<'_>, pose: usize) -> u64 {
    match strip.before(pose) {
        Some(before) if strip.shown[pose] == 1 && strip.shown[before] < LONGEST_COPIED => {
            rising(strip.speed[pose])
        }
        _ => Queue::OUT,
    }
}
