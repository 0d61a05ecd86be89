//! The thread pool that everything runs on: one pool for all drawings, so that the allocator reuses memory on the same
//! threads.
//!
//! Its stacks are large: usvg recurses over groups and clones, up to a thousand deep, which overflows a default stack.

use std::sync::LazyLock;

use crate::crash::{self, Crash};

/// The stack of each thread, bytes. It is address space: only deep drawings use that much memory.
const STACK: usize = 256 << 20;

/// How many parts, or strings, a thread takes at once: handing over fewer costs more than the work itself.
pub(crate) const GRAIN: usize = 64;

static POOL: LazyLock<Option<rayon::ThreadPool>> = LazyLock::new(|| {
    let pool = rayon::ThreadPoolBuilder::new()
        .stack_size(STACK)
        .thread_name(|index| format!("okoshi {index}"));
    pool.build().ok()
});

/// Runs `work` on the pool and waits for its result.
///
/// A thread of another rayon pool that waits here takes other jobs of its pool meanwhile.
///
/// # Errors
/// If `work` panics, or no threads can be started.
pub(crate) fn run<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, Crash> {
    let Some(pool) = POOL.as_ref() else {
        return Err(Crash::no_threads());
    };
    crash::catch(|| pool.install(work))
}

/// Runs `work` on every thread of the pool without waiting for it.
pub(crate) fn run_on_each(work: impl Fn() + Send + Sync + 'static) {
    if let Some(pool) = POOL.as_ref() {
        pool.spawn_broadcast(move |_| work());
    }
}

/// Runs `work` on the pool without waiting for it.
pub(crate) fn run_aside(work: impl FnOnce() + Send + 'static) {
    if let Some(pool) = POOL.as_ref() {
        pool.spawn(work);
    }
}
