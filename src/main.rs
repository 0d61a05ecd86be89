//! The `okoshi` command: a thin door to [`okoshi::internals::cli`].

use std::process::ExitCode;

/// Many threads make and drop many small lists; this allocator is made for that.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    okoshi::internals::cli::run(std::env::args_os())
}
