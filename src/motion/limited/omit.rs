//! Omission (naka-nashi): what is fast becomes faster (Kitamura 5.2.2, Algorithm 2).

use super::queue::{Queue, falling, rising};
use super::strip::Strip;
use super::{LONGEST_COPIED, Length};

/// What was done, as source frames in the order in which it was done.
pub(super) struct Omitted {
    pub(super) omitted: Vec<u32>,
    pub(super) duplicated: Vec<u32>,
    /// The most poses that are missing between two that are left.
    pub(super) gathered: usize,
}

/// Omits up to `asked` poses.
pub(super) fn omit(strip: &mut Strip<'_>, asked: usize, length: Length) -> Omitted {
    let mut done = Omitted {
        omitted: Vec::new(),
        duplicated: Vec::new(),
        gathered: 0,
    };
    if asked == 0 {
        return done;
    }
    let poses = 0..strip.poses();
    let mut fastest = Queue::new(poses.clone().map(|pose| fast(strip, pose)).collect());
    let mut slowest = match length {
        Length::Kept => Some(Queue::new(poses.map(|pose| slow(strip, pose)).collect())),
        Length::Shortened => None,
    };
    while done.omitted.len() < asked {
        let Some(pose) = fastest.first() else { break };
        let after = strip.after(pose);
        strip.take(pose);
        fastest.set(pose, Queue::OUT);
        if let Some(after) = after {
            fastest.set(after, fast(strip, after));
        }
        if let Some(slowest) = &mut slowest {
            slowest.set(pose, Queue::OUT);
            if let Some(after) = after {
                slowest.set(after, slow(strip, after));
            }
            let place = slowest.first();
            let Some((place, twice)) = place.and_then(|place| Some((place, strip.before(place)?)))
            else {
                strip.put_back(pose);
                break;
            };
            strip.shown[twice] += 1;
            fastest.set(twice, fast(strip, twice));
            slowest.set(place, slow(strip, place));
            done.duplicated.push(strip.source(twice));
        }
        done.omitted.push(strip.source(pose));
    }
    done.gathered = gathered(strip);
    done
}

fn fast(strip: &Strip<'_>, pose: usize) -> u64 {
    match strip.before(pose) {
        Some(_) if strip.shown[pose] == 1 => falling(strip.speed[pose]),
        _ => Queue::OUT,
    }
}

fn slow(strip: &Strip<'_>, pose: usize) -> u64 {
    match strip.before(pose) {
        Some(before) if strip.shown[before] < LONGEST_COPIED => rising(strip.speed[pose]),
        _ => Queue::OUT,
    }
}

/// The most poses that are missing in one place. Before anything is held, what is missing was omitted.
fn gathered(strip: &Strip<'_>) -> usize {
    let (mut most, mut next) = (0, 0);
    for pose in strip.left() {
        most = most.max(pose - next);
        next = pose + 1;
    }
    most.max(strip.poses() - next)
}
