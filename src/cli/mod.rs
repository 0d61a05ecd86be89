//! The `okoshi` command. No other module prints.
//!
//! Exit status: 0 for success, 1 for errors in a drawing, 2 for wrong usage or a file that cannot be read or written.
//! stdout carries only the requested output.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "this is the module that prints"
)]

mod annotate;
mod app;
mod args;
mod build;
mod check;
mod digest;
mod edit;
mod explain;
mod fix;
mod inspect;
mod loading;
mod man;
mod motion;
mod new;
mod parallel;
mod preview;
mod progress;
mod puppet;
mod render;
pub(crate) mod report;
mod rewriting;
pub(crate) mod sarif;
mod serving;
mod terminal;
mod trace;
mod track;
mod watch;

use std::ffi::OsString;
use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, Parser};

use crate::{crash, disk};
use args::{Cli, Color, Command, Common};
use report::Style;

/// The letters behind the last dot of a file's name, in lower case; none if there is no dot.
fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_lowercase()
}

/// `1 part`, `2 parts`
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// How a command ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    Done,
    /// A drawing has errors.
    Errors,
    /// Wrong usage, or a file that cannot be read or written.
    Failed,
}

/// Why a command ends early.
enum Failure {
    /// An error message that is still to be printed.
    Message(String),
    /// The message was printed already.
    Reported(Outcome),
}

impl<E: Display> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Message(error.to_string())
    }
}

impl From<Outcome> for Failure {
    fn from(outcome: Outcome) -> Self {
        Self::Reported(outcome)
    }
}

/// Runs the command with its arguments, the program's name first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    crash::record_locations();
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => {
            if let Some(drawing) = drawing_as_command(&error) {
                eprint!("{drawing}");
                return ExitCode::from(2);
            }
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let outcome = match &cli.command {
        Command::New(arguments) => new::run(arguments, cli.common),
        Command::Trace(arguments) => trace::run(arguments, cli.common),
        Command::Annotate(arguments) => annotate::run(arguments, cli.common),
        Command::Edit(arguments) => edit::run(arguments, cli.common),
        Command::Build(arguments) => build::run(arguments, cli.common),
        Command::Render(arguments) => render::run(arguments, cli.common),
        Command::Check(arguments) => Ok(check::run(arguments, cli.common)),
        Command::Inspect(arguments) => inspect::run(arguments, cli.common),
        Command::Explain { topic } => explain::run(topic.as_deref(), cli.common),
        Command::Motion(arguments) => motion::run(arguments, cli.common),
        Command::Puppet(arguments) => puppet::run(arguments, cli.common),
        Command::Track(arguments) => track::run(arguments, cli.common),
        Command::Watch(arguments) => watch::run(arguments, cli.common),
        Command::Preview(arguments) => preview::run(arguments, cli.common),
        Command::App(arguments) => app::run(arguments, cli.common),
        Command::Lsp => lsp(),
        Command::Man { command } => man::run(command.as_deref()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "okoshi", &mut script);
            Ok(print_out(&String::from_utf8_lossy(&script)))
        }
    };
    let outcome = outcome.unwrap_or_else(|failure| match failure {
        Failure::Message(message) => fail(message),
        Failure::Reported(outcome) => outcome,
    });
    ExitCode::from(match outcome {
        Outcome::Done => 0,
        Outcome::Errors => 1,
        Outcome::Failed => 2,
    })
}

/// The way out for a drawing in the place of a command; `None` for other mistakes.
fn drawing_as_command(error: &clap::Error) -> Option<String> {
    let given = match error.get(ContextKind::InvalidSubcommand)? {
        ContextValue::String(given) => given,
        _ => return None,
    };
    let path = Path::new(given);
    if !disk::is_drawing(path) && !path.exists() {
        return None;
    }
    let quoted = if given.contains(char::is_whitespace) {
        format!("\"{given}\"")
    } else {
        given.clone()
    };
    let what = if path.is_dir() { "a folder" } else { "a file" };
    let build = if path.is_dir() { "watch" } else { "build" };
    Some(format!(
        "error: `{given}` is {what}, not a command; did you mean `okoshi {build} {quoted}`?\n\n\
         okoshi {build} {quoted}  makes a model\n\
         okoshi preview {quoted} --open  shows it in the browser\n\
         okoshi --help  lists all commands\n"
    ))
}

/// Serves an editor. The protocol makes it a failure if the editor disconnects without the `exit` notification.
fn lsp() -> Result<Outcome, Failure> {
    match crate::lsp::serve() {
        Ok(true) => Ok(Outcome::Done),
        Ok(false) => Ok(Outcome::Errors),
        Err(error) => Err(format!("the language server cannot start: {error}").into()),
    }
}

/// Prints the requested output. A reader that closes the pipe early, such as `head`, is not a failure.
fn print_out(text: &str) -> Outcome {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            fail(format!("stdout cannot be written: {error}"))
        }
        _ => Outcome::Done,
    }
}

/// Reports why a command failed.
fn fail(message: impl Display) -> Outcome {
    eprintln!("error: {message}");
    Outcome::Failed
}

/// Whether to use colours on a stream.
fn style(common: Common, stream: &impl IsTerminal) -> Style {
    let colored = match common.color {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => {
            stream.is_terminal()
                && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        }
    };
    if colored {
        Style::Colored
    } else {
        Style::Plain
    }
}
