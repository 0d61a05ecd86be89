//! The `okoshi` command: a thin door to [`okoshi::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    okoshi::cli::run(std::env::args_os())
}
