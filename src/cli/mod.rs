//! The `okoshi` command.

pub mod json;
mod places;
pub mod report;
#[cfg(test)]
mod samples;
pub mod sarif;

use crate::diagnostic::Diagnostic;

/// A drawing and what was found in it, ready to be reported.
#[derive(Debug, Clone, Copy)]
pub struct Findings<'a> {
    /// The drawing as the user named it.
    pub path: &'a str,
    /// Its text, which the spans are about.
    pub text: &'a str,
    /// What was found.
    pub diagnostics: &'a [Diagnostic],
}

/// Indented JSON. Reports hold texts and numbers only, so writing them does not fail.
fn pretty(report: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(report).unwrap_or_default();
    text.push('\n');
    text
}

/// Runs the command.
pub fn run(_: std::env::ArgsOs) -> std::process::ExitCode {
    std::process::ExitCode::SUCCESS
}
