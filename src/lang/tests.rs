//! Tests of the language: strings in, diagnostics out.

mod arguments;
mod laws;
mod recovery;
mod structure;
mod tables;
mod warnings;

use super::ast::Annotation;
use super::value::Setting;
use super::{Container, Variables, parse, settings};
use crate::diagnostic::{Diagnostic, sort};
use crate::source::Text;

/// The result of parsing and checking a text.
pub(super) struct Reading {
    pub(super) annotation: Annotation,
    pub(super) settings: Vec<Setting>,
    pub(super) diagnostics: Vec<Diagnostic>,
}

pub(super) fn read(text: &Text, container: Container) -> Reading {
    let (annotation, mut diagnostics) = parse(text, container);
    let variables = Variables::collect([(text, &annotation)], &mut diagnostics);
    let settings = settings(text, &annotation, &variables, &mut diagnostics);
    sort(&mut diagnostics);
    Reading {
        annotation,
        settings,
        diagnostics,
    }
}

/// The string, and below it each diagnostic with carets at its span.
pub(super) fn show(input: &str, diagnostics: &[Diagnostic]) -> String {
    let mut out = format!("{input}\n");
    let column = |offset: usize| input[..offset].chars().count();
    for found in diagnostics {
        let (start, end) = (column(found.span.start), column(found.span.end));
        out.push_str(&" ".repeat(start));
        out.push_str(&"^".repeat((end - start).max(1)));
        out.push_str(&format!(" {}: {}", found.code.id(), found.message));
        if let Some(label) = &found.label {
            out.push_str(&format!(" ({label})"));
        }
        out.push('\n');
        for related in &found.related {
            let place = &input[related.span.start..related.span.end];
            out.push_str(&format!("  see `{place}`: {}\n", related.message));
        }
        if let Some(help) = &found.help {
            out.push_str(&format!("  help: {help}\n"));
        }
        for fix in &found.fixes {
            out.push_str(&format!("  fix: {} -> {}\n", fix.title, apply(input, fix)));
        }
    }
    out
}

/// `input` with a fix applied.
pub(super) fn apply(input: &str, fix: &crate::diagnostic::Fix) -> String {
    let mut edits = fix.edits.clone();
    edits.sort_by_key(|edit| edit.span);
    let mut out = String::new();
    let mut at = 0;
    for edit in edits {
        out.push_str(&input[at..edit.span.start]);
        out.push_str(&edit.text);
        at = edit.span.end;
    }
    out.push_str(&input[at..]);
    out
}

/// Compares the diagnostics of `input` with `expect`, both without the indentation of the test.
#[track_caller]
pub(super) fn check(input: &str, expect: &str) {
    let reading = read(&Text::plain(input, 0), Container::Text);
    let shown = show(input, &reading.diagnostics);
    if std::env::var_os("OKOSHI_SHOW").is_some() {
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), "{shown}");
        return;
    }
    let expect = unindent(expect);
    assert!(shown == expect, "found:\n{shown}\nexpected:\n{expect}");
}

fn unindent(text: &str) -> String {
    let lines: Vec<&str> = text.lines().skip(1).collect();
    let margin = lines
        .iter()
        .filter(|line| !line.trim().is_empty())
        .map(|line| line.len() - line.trim_start().len())
        .min()
        .unwrap_or(0);
    let mut out = String::new();
    for line in &lines {
        if !line.trim().is_empty() {
            out.push_str(&line[margin..]);
            out.push('\n');
        }
    }
    out
}
