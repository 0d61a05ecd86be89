//! Findings for people: a line each, with place, cause and way out.
//!
//! A drawing with one habit has the same finding a hundred times. The first line of a kind says what it means; of the others
//! only their number and places are of use. Errors are an exception, because all of them have to be fixed.

use std::collections::BTreeMap;

use super::args::Common;
use super::counted;
use super::report::{Reports, Style};
use crate::diagnostic::{Code, Diagnostic, Severity, listed};
use crate::report::Findings;

/// The most findings of a drawing that get a line without `--verbose`.
const MAX_LINES: usize = 20;
/// The most errors of one kind that get a line without `--verbose`.
const MAX_ERRORS: usize = 10;
/// How to see what is left out.
const ALL: &str = "`okoshi check -v` shows all, each in its lines of the drawing";

/// Which findings to show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    /// With hints.
    All,
    /// The command reports repeatedly: without hints.
    Repeated,
}

/// The findings of a drawing as text for people: all with `--verbose`, errors with `--quiet`.
pub(super) fn describe(
    findings: Findings<'_>,
    common: Common,
    detail: Detail,
    style: Style,
) -> String {
    if findings.diagnostics.is_empty() {
        return String::new();
    }
    let reports = Reports::new(findings.path, findings.text, style);
    if common.verbose {
        return findings
            .diagnostics
            .iter()
            .map(|one| reports.report(one))
            .collect();
    }
    let last = match detail {
        _ if common.quiet => Severity::Error,
        Detail::Repeated => Severity::Warning,
        Detail::All => Severity::Hint,
    };
    let mut kinds: BTreeMap<(Code, Option<&str>), Vec<&Diagnostic>> = BTreeMap::new();
    let shown = |diagnostic: &&Diagnostic| diagnostic.severity() <= last;
    for diagnostic in findings.diagnostics.iter().filter(shown) {
        kinds.entry(kind(diagnostic)).or_default().push(diagnostic);
    }
    // Of one severity, those that are first in the drawing.
    let mut kinds: Vec<_> = kinds.into_values().collect();
    kinds.sort_by_key(|kind| (kind[0].severity(), kind[0].span));
    digest(&reports, &kinds)
}

/// What kind of finding it is: its code. Each feature of SVG is a kind of its own, which is told by its help.
fn kind(diagnostic: &Diagnostic) -> (Code, Option<&str>) {
    let is_feature = diagnostic.code == Code::NoSolidMeaning;
    let help = diagnostic.help.as_deref().filter(|_| is_feature);
    (diagnostic.code, help)
}

/// The text about all kinds, the most important first.
fn digest(reports: &Reports<'_>, kinds: &[Vec<&Diagnostic>]) -> String {
    let mut out = String::new();
    let mut free = MAX_LINES;
    let mut left_out: BTreeMap<Code, usize> = BTreeMap::new();
    let mut is_complete = true;
    for kind in kinds {
        let most = match kind[0].severity() {
            Severity::Error => MAX_ERRORS,
            Severity::Warning | Severity::Hint => 1,
        };
        let (shown, rest) = kind.split_at(kind.len().min(most).min(free));
        free -= shown.len();
        for (place, finding) in shown.iter().enumerate() {
            out += &reports.line(finding);
            if place + 1 == shown.len() && !rest.is_empty() {
                out += &more(reports, rest);
            }
            out.push('\n');
        }
        is_complete &= rest.is_empty();
        if shown.is_empty() {
            *left_out.entry(kind[0].code).or_default() += kind.len();
        }
    }
    if !left_out.is_empty() {
        let codes = left_out.iter();
        let codes = codes.map(|(code, count)| format!("{count} {}", code.id()));
        let codes: Vec<String> = codes.collect();
        let what = counted(left_out.values().sum(), "more finding");
        out += &format!("… and {what} ({}); {ALL}\n", codes.join(", "));
    } else if !is_complete {
        out += &format!("{ALL}\n");
    }
    out
}

/// How many others of a kind there are, and where.
fn more(reports: &Reports<'_>, rest: &[&Diagnostic]) -> String {
    let lines = rest.iter().map(|other| reports.place(other).0);
    let mut lines: Vec<usize> = lines.collect();
    lines.dedup();
    let word = if lines.len() == 1 { "line" } else { "lines" };
    let places = listed(lines.iter().map(usize::to_string));
    format!(" (and {} more in {word} {places})", rest.len())
}

#[cfg(test)]
#[path = "digest_tests.rs"]
mod tests;
