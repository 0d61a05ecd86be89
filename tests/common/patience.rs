//! Waiting for what must happen. A limit only ends a test that hangs: how fast something is, no test judges.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// The longest wait for something that must happen, also on a slow machine that does much else.
pub(crate) const PATIENCE: Duration = Duration::from_secs(300);

/// The pause between two looks at a condition.
const PAUSE: Duration = Duration::from_millis(5);

/// Waits until a condition holds that no event reports, and fails after [`PATIENCE`]. What happens is received from a pipe, a channel or a
/// socket where there is one.
#[track_caller]
pub(crate) fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !condition() {
        assert!(Instant::now() < end, "waited in vain for {what}");
        std::thread::sleep(PAUSE);
    }
}

/// Does work that must end, and fails if it has not after [`PATIENCE`].
#[track_caller]
pub(crate) fn finish<T: Send + 'static>(
    what: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> T {
    let (sender, receiver) = channel();
    let worker = std::thread::spawn(move || {
        // Nobody receives it if the wait is over.
        let _ = sender.send(work());
    });
    match (receiver.recv_timeout(PATIENCE), worker) {
        (Ok(done), _) => done,
        (Err(RecvTimeoutError::Timeout), _) => panic!("waited in vain for {what}"),
        (Err(RecvTimeoutError::Disconnected), worker) => match worker.join() {
            Err(panic) => std::panic::resume_unwind(panic),
            Ok(()) => panic!("{what} gave nothing"),
        },
    }
}
