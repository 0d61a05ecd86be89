//! A progress indicator for work that takes more than a second.

use std::io::IsTerminal;
use std::sync::mpsc;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How long work may take before the indicator appears.
const DELAY: Duration = Duration::from_secs(1);

/// Runs `work`; after a second a spinner with `message` appears, if stderr is a terminal.
pub(super) fn spinning<T>(message: &str, work: impl FnOnce() -> T) -> T {
    counting(message, 0, |_| work())
}

/// Runs `work`, which reports how many of `total` pieces are done; after a second the count appears after `message`, if
/// stderr is a terminal. A `total` of 0 shows only the spinner.
pub(super) fn counting<T>(message: &str, total: u32, work: impl FnOnce(&dyn Fn(u32)) -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return work(&|_| ());
    }
    let bar = ProgressBar::with_draw_target(Some(u64::from(total)), ProgressDrawTarget::hidden());
    let template = match total {
        0 => "{spinner} {msg} ({elapsed})",
        _ => "{spinner} {msg} {pos} of {len} ({elapsed})",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.set_message(message.to_owned());
    std::thread::scope(|scope| {
        let (done, wait) = mpsc::channel::<()>();
        let shown = bar.clone();
        scope.spawn(move || {
            if wait.recv_timeout(DELAY) == Err(mpsc::RecvTimeoutError::Timeout) {
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(Duration::from_millis(100));
                let _ = wait.recv();
                shown.finish_and_clear();
            }
        });
        let result = work(&|done| bar.set_position(u64::from(done)));
        drop(done);
        result
    })
}
