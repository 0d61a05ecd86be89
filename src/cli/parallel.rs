//! Work on several drawings in parallel.

use std::num::NonZero;
use std::sync::Mutex;
use std::thread::{available_parallelism, scope};

/// Calls `work` on every item in parallel, and returns the results in the order of the items.
///
/// The threads are not of a rayon pool: a worker there that waits for one drawing would start others on the same stack.
pub(super) fn each<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = available_parallelism()
        .map_or(1, NonZero::get)
        .min(items.len());
    let next = Mutex::new(items.iter().enumerate());
    let take = || next.lock().ok()?.next();
    let share = || -> Vec<(usize, R)> {
        std::iter::from_fn(take)
            .map(|(index, item)| (index, work(item)))
            .collect()
    };
    let mut made: Vec<(usize, R)> = scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(share)).collect();
        let mut made = share();
        for other in others {
            match other.join() {
                Ok(share) => made.extend(share),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        made
    });
    made.sort_by_key(|(index, _)| *index);
    made.into_iter().map(|(_, made)| made).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
    use std::thread::available_parallelism;

    use super::each;
    use crate::patience::wait_until;

    #[test]
    fn results_keep_the_order() {
        let items: Vec<usize> = (0..100).collect();
        let last_made = AtomicUsize::new(0);
        let made = each(&items, |item| {
            // The first is made last, unless one thread makes all.
            if *item == 0 && available_parallelism().is_ok_and(|threads| threads.get() > 1) {
                wait_until("the last item", || last_made.load(Relaxed) == 99);
            }
            last_made.fetch_max(*item, Relaxed);
            item * 2
        });
        assert_eq!(made, (0..100).map(|item| item * 2).collect::<Vec<_>>());
        assert!(each(&Vec::<u8>::new(), |item| *item).is_empty());
    }
}
