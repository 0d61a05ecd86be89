//! The threads that drawings are compiled on: one pool for everything, so that memory is used again where it was
//! used before, with room for deep drawings. usvg recurses over groups and clones, up to a thousand deep, and that
//! is more than a thread's usual stack holds.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::LazyLock;

/// Stack of each thread, bytes. It is address space: memory is taken where a drawing is deep.
const STACK: usize = 256 << 20;

/// How many parts, or strings, a thread takes at once: to hand over fewer takes longer than doing them.
pub(crate) const GRAIN: usize = 64;

static POOL: LazyLock<Option<rayon::ThreadPool>> = LazyLock::new(|| {
    let pool = rayon::ThreadPoolBuilder::new()
        .stack_size(STACK)
        .thread_name(|index| format!("okoshi {index}"));
    pool.build().ok()
});

/// What `work` makes, on such threads; `None` if it panics, or there can be no threads.
///
/// A pool and not a thread: whoever waits for it from a pool of rayon's goes on with other work there.
pub(crate) fn run<R: Send>(work: impl FnOnce() -> R + Send) -> Option<R> {
    let pool = POOL.as_ref()?;
    catch_unwind(AssertUnwindSafe(|| pool.install(work))).ok()
}

/// Does `work` on such a thread without waiting for it.
pub(crate) fn run_aside(work: impl FnOnce() + Send + 'static) {
    if let Some(pool) = POOL.as_ref() {
        pool.spawn(work);
    }
}
