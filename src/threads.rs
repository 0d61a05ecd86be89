//! The thread pool that everything runs on: one pool for all drawings, so that the allocator reuses memory on the same
//! threads. Where the system gives no threads, as in a browser, the thread of the caller does the work.
//!
//! usvg recurses over groups and clones, so how deep they may be nested depends on the stack ([`nesting_limit`]).

use std::sync::LazyLock;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::crash::{self, Crash};

/// The stack of each thread of the pool, bytes. It is address space: only deep drawings use that much memory.
const STACK: usize = 256 << 20;

/// How deep elements may be nested on the pool; usvg's own limit is slightly higher.
const DEEPEST: usize = 1000;

/// How deep they may be nested on a thread of the caller, which has a stack of 1 MiB or more.
const DEEPEST_ALONE: usize = 160;

/// How many parts, or strings, a thread takes at once: handing over fewer costs more than the work itself.
pub(crate) const GRAIN: usize = 64;

static POOL: LazyLock<Option<ThreadPool>> = LazyLock::new(|| {
    let pool = ThreadPoolBuilder::new()
        .stack_size(STACK)
        .thread_name(|index| format!("okoshi {index}"));
    pool.build().ok()
});

/// The pool, if the system gives threads.
fn pool() -> Option<&'static ThreadPool> {
    #[cfg(test)]
    if tests::ALONE.get() {
        return None;
    }
    POOL.as_ref()
}

/// Whether the system gives no threads beside that of the caller.
pub(crate) fn are_none() -> bool {
    pool().is_none()
}

/// Does work on a thread that is given no others.
#[cfg(test)]
pub(crate) fn without_others<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let alone = || {
        tests::ALONE.set(true);
        work()
    };
    std::thread::scope(|scope| scope.spawn(alone).join()).unwrap()
}

/// How deep elements of a drawing may be nested, so that reading them fits the stack.
pub(crate) fn nesting_limit() -> usize {
    pool().map_or(DEEPEST_ALONE, |_| DEEPEST)
}

/// Runs `work` on the pool and waits for its result; without a pool, on this thread.
///
/// A thread of another rayon pool that waits here takes other jobs of its pool meanwhile.
///
/// # Errors
/// If `work` panics.
pub(crate) fn run<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, Crash> {
    if let Some(pool) = pool() {
        return crash::catch(|| pool.install(work));
    }
    // From now on, rayon's pool for this thread is this thread. It fails if there is one already, which does as well.
    let _ = ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build();
    crash::catch(work)
}

/// Runs `work` on every thread of the pool without waiting for it.
pub(crate) fn run_on_each(work: impl Fn() + Send + Sync + 'static) {
    if let Some(pool) = pool() {
        pool.spawn_broadcast(move |_| work());
    }
}

/// Runs `work` on the pool without waiting for it; without a pool, at once.
pub(crate) fn run_aside(work: impl FnOnce() + Send + 'static) {
    match pool() {
        Some(pool) => pool.spawn(work),
        None => work(),
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::thread::Builder;

    use super::DEEPEST_ALONE;
    use crate::compile::{Compiled, Options, compile};
    use crate::diagnostic::Code;
    use crate::export::{GLB, to_memory};
    use crate::resolver::MemoryResolver;

    thread_local! {
        /// Whether this thread does its work itself.
        pub(super) static ALONE: Cell<bool> = const { Cell::new(false) };
    }

    /// Compiles a drawing on a thread with a stack of 1 MiB, and writes its model.
    fn on_a_small_stack(drawing: String) -> Compiled {
        let build = move || {
            ALONE.set(true);
            let compiled = compile(&drawing, &Options::default(), &MemoryResolver::default());
            to_memory(&GLB, &compiled.scene, None).unwrap();
            compiled
        };
        let thread = Builder::new().stack_size(1 << 20).spawn(build);
        thread.unwrap().join().unwrap()
    }

    fn drawing(content: &str) -> String {
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="99" height="99">{content}</svg>"#
        )
    }

    /// As deep as is allowed, in everything that usvg recurses over: groups with effects, clones, text.
    #[test]
    fn deep_drawings_fit_a_small_stack() {
        let shape = r#"<rect id="a0" width="9" height="9"/>"#;
        for (open, close) in [
            ("<g>", "</g>"),
            (r#"<g opacity=".9" transform="scale(.99)">"#, "</g>"),
            (r#"<svg width="99" height="99">"#, "</svg>"),
            (r#"<a style="stroke: red">"#, "</a>"),
        ] {
            let count = DEEPEST_ALONE - 2;
            let nested = [&open.repeat(count), shape, &close.repeat(count)].concat();
            let compiled = on_a_small_stack(drawing(&nested));
            assert_eq!(
                compiled.scene.nodes.len(),
                1,
                "{open}: {:?}",
                compiled.diagnostics
            );
        }
        let count = DEEPEST_ALONE - 2;
        let text = ["<text>", &"<tspan>".repeat(count - 1), "A$Depth 1"].concat();
        let text = [text, "</tspan>".repeat(count - 1), "</text>".to_owned()].concat();
        on_a_small_stack(drawing(&[shape, &text].concat()));
        for clone in [
            |level: usize| {
                format!(
                    r##"<g id="a{level}"><use xlink:href="#a{}"/></g>"##,
                    level - 1
                )
            },
            |level| {
                let below = level - 1;
                format!(
                    r##"<clipPath id="c{level}"><rect width="9" height="9" clip-path="url(#c{below})"/></clipPath>
                    <rect id="a{level}" width="9" height="9" clip-path="url(#c{level})"/>"##
                )
            },
            |level| {
                let below = level - 1;
                format!(
                    r##"<mask id="m{level}"><rect width="9" height="9" fill="white" mask="url(#m{below})"/></mask>
                    <rect id="a{level}" width="9" height="9" mask="url(#m{level})"/>"##
                )
            },
            |level| {
                let below = level - 1;
                format!(
                    r##"<pattern id="p{level}" width="1" height="1"><rect width="9" height="9" fill="url(#p{below})"/></pattern>
                    <rect id="a{level}" width="9" height="9" fill="url(#p{level})"/>"##
                )
            },
        ] {
            let levels: String = (1..DEEPEST_ALONE).map(clone).collect();
            on_a_small_stack(drawing(&[shape, &levels].concat()));
        }
    }

    #[test]
    fn deeper_ones_are_refused_by_name() {
        let count = DEEPEST_ALONE + 1;
        let nested = ["<g>".repeat(count), "</g>".repeat(count)].concat();
        let compiled = on_a_small_stack(drawing(&nested));
        let told = compiled.diagnostics.iter();
        let limit: Vec<_> = told.filter(|one| one.code == Code::LimitPassed).collect();
        let message = format!("elements are nested more than {DEEPEST_ALONE} deep");
        assert_eq!(limit[0].message, message);
    }
}
