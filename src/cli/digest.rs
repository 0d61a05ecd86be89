//! Findings for people: one report a kind, and a few lines for the others.
//!
//! A drawing with one habit has the same finding a hundred times. The first report of a kind says what it means; of the others
//! only their number and places are of use. Errors are an exception, because all of them have to be fixed.

use std::collections::BTreeMap;

use super::args::Common;
use super::counted;
use super::report::{Reports, Style};
use crate::diagnostic::{Code, Diagnostic, Severity, listed};
use crate::report::Findings;

/// The most lines of text for the findings of a drawing without `--verbose`; errors do not count.
const MAX_LINES: usize = 20;
/// The most errors of one kind that are reported without `--verbose`.
const MAX_ERRORS: usize = 10;
/// How to see what is left out.
const ALL: &str = "`okoshi check -v` shows all";

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
    Digest {
        reports,
        out: String::new(),
        lines: 0,
        is_short: false,
        left_out: vec![],
    }
    .of(&kinds)
}

/// What kind of finding it is: its code. Each feature of SVG is a kind of its own, which is told by its help.
fn kind(diagnostic: &Diagnostic) -> (Code, Option<&str>) {
    let is_feature = diagnostic.code == Code::NoSolidMeaning;
    let help = diagnostic.help.as_deref().filter(|_| is_feature);
    (diagnostic.code, help)
}

/// Text that is being written.
struct Digest<'a> {
    reports: Reports<'a>,
    out: String,
    /// The lines of `out` that are not about errors.
    lines: usize,
    /// Whether a kind got a line instead of a report.
    is_short: bool,
    /// Kinds of which nothing is shown.
    left_out: Vec<&'a [&'a Diagnostic]>,
}

impl<'a> Digest<'a> {
    /// The text about all kinds.
    fn of(mut self, kinds: &'a [Vec<&'a Diagnostic>]) -> String {
        for (place, kind) in kinds.iter().enumerate() {
            if kind[0].severity() == Severity::Error {
                self.errors(kind);
            } else {
                self.others(kind, kinds.len() - place - 1);
            }
        }
        if self.left_out.is_empty() && self.is_short {
            self.out += &format!("{ALL} in full\n");
        }
        if !self.left_out.is_empty() {
            let mut counts: BTreeMap<Code, usize> = BTreeMap::new();
            for kind in &self.left_out {
                *counts.entry(kind[0].code).or_default() += kind.len();
            }
            let codes = counts.iter();
            let codes = codes.map(|(code, count)| format!("{count} {}", code.id()));
            let codes: Vec<String> = codes.collect();
            let all: usize = counts.values().sum();
            let what = counted(all, "more finding");
            self.out += &format!("… and {what} ({}); {ALL}\n", codes.join(", "));
        }
        self.out
    }

    /// Reports errors of one kind.
    fn errors(&mut self, kind: &[&Diagnostic]) {
        let (shown, rest) = kind.split_at(kind.len().min(MAX_ERRORS));
        let shown: String = shown
            .iter()
            .map(|error| self.reports.report(error))
            .collect();
        self.out += &shown;
        self.more(rest);
    }

    /// Reports the first of a kind, if it is the first of all, or there is space beside a line for each of so many other kinds; else
    /// as one line.
    fn others(&mut self, kind: &'a [&'a Diagnostic], waiting: usize) {
        let (first, rest) = (kind[0], &kind[1..]);
        let report = self.reports.report(first);
        let lines = report.lines().count() + 2 * usize::from(!rest.is_empty());
        let free = MAX_LINES - self.lines;
        let is_first = self.lines == 0 && lines <= free;
        if is_first || lines + waiting <= free {
            self.out += &report;
            self.more(rest);
            self.lines += lines;
        } else if free > 0 {
            self.is_short = true;
            self.out += &self.reports.line(first);
            self.out += &match rest.len() {
                0 => "\n".to_owned(),
                more => format!(" (and {more} more)\n"),
            };
            self.lines += 1;
        } else {
            self.left_out.push(kind);
        }
    }

    /// One line about others of the kind that was reported last, if there are any, and an empty one.
    fn more(&mut self, rest: &[&Diagnostic]) {
        let Some(next) = rest.first() else {
            return;
        };
        let lines = rest.iter().map(|other| self.reports.place(other).0);
        let mut lines: Vec<usize> = lines.collect();
        lines.dedup();
        let word = if lines.len() == 1 { "line" } else { "lines" };
        let places = listed(lines.iter().map(usize::to_string));
        let what = format!("{} more {}", rest.len(), next.code.id());
        // It belongs to the report above.
        self.out.truncate(self.out.trim_end().len());
        self.out += &format!("\n   … and {what} in {word} {places}; {ALL}\n\n");
    }
}

#[cfg(test)]
#[path = "digest_tests.rs"]
mod tests;
