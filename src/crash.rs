//! Panics, caught and reported as what they are: mistakes in this program.
//!
//! [`catch`] turns a panic into a [`Crash`] with its message. Where it happened is only known to a panic hook, which is
//! global to the process: a library must not set one behind the back of the program that uses it. So programs call
//! [`record_locations`] if they want to see places in their reports; its hook also calls the one before it.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, Once, PoisonError};

/// A panic that was caught.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("okoshi crashed: {message}{}", .location.as_ref().map(|at| format!(" ({at})")).unwrap_or_default())]
pub struct Crash {
    /// What the panic says.
    pub message: String,
    /// File, line and column of the panic, if the program records them (see [`record_locations`]).
    pub location: Option<String>,
}

/// What the user can do about a crash.
pub const HELP: &str = concat!(
    "this is a mistake in okoshi, not in the drawing: please report it to the maintainers, with the drawing, this \
     message and the version (okoshi ",
    env!("CARGO_PKG_VERSION"),
    ")"
);

/// The last panic that the hook saw.
static LAST: Mutex<Option<Crash>> = Mutex::new(None);

/// Runs `work`; a panic becomes a [`Crash`].
///
/// # Errors
/// If `work` panics. Whatever it was changing may be half changed then, and must not be used again.
pub fn catch<R>(work: impl FnOnce() -> R) -> Result<R, Crash> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|payload| Crash::from_panic(&*payload))
}

/// Lets crashes know where they happened, from now on and in the whole process. Meant for programs, not for libraries.
pub fn record_locations() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let next = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let crash = Crash {
                message: message(info.payload()),
                location: info.location().map(ToString::to_string),
            };
            *LAST.lock().unwrap_or_else(PoisonError::into_inner) = Some(crash);
            next(info);
        }));
    });
}

impl Crash {
    /// The operating system starts no more threads.
    pub(crate) fn no_threads() -> Self {
        Self {
            message: "no threads can be started".to_owned(),
            location: None,
        }
    }

    /// The crash of a panic with this payload.
    ///
    /// A pool of threads hands a panic on from thread to thread, so that the payload alone says which panic it is: the
    /// last one, if it has the same message.
    pub(crate) fn from_panic(payload: &(dyn Any + Send)) -> Self {
        let message = message(payload);
        let last = LAST.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match last.filter(|last| last.message == message) {
            Some(last) => last,
            None => Self {
                message,
                location: None,
            },
        }
    }
}

fn message(payload: &dyn Any) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("a panic without a message").to_owned()
}
