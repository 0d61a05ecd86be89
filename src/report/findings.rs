//! Diagnostics for programs: `check --format json`.
//!
//! The schema is stable: members may be added, but none is renamed or removed. `version` counts breaking changes.

use serde::Serialize;

use super::pretty;
use crate::diagnostic::{Diagnostic, Edit, Fix, Related};
use crate::source::LineIndex;
use crate::source::Span;

/// A drawing with its diagnostics, ready to be reported.
#[derive(Debug, Clone, Copy)]
pub struct Findings<'a> {
    /// The path as the user wrote it.
    pub path: &'a str,
    /// Its text, which the spans refer to.
    pub text: &'a str,
    /// The diagnostics.
    pub diagnostics: &'a [Diagnostic],
    /// How the model looks from the front, if that was asked for.
    pub look: Option<Likeness>,
}

/// How the model looks from the front, compared with the drawing.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Likeness {
    /// The share of the pixels that show the right color, 0 to 1.
    pub right: f64,
    /// The number of pixels that were compared.
    pub pixels: usize,
    /// The share of right pixels of the drawing without the lines that are not built, 0 to 1.
    pub right_without_lines: f64,
    /// The share of pixels that are wrong because lines are not built, 0 to 1.
    pub lines: f64,
    /// The argument of `Strokes` that would build these lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lines_built_by: Option<&'static str>,
}

/// The findings as JSON, with a line feed at the end.
///
/// Lines and columns count from 1, columns in characters; `start` and `end` are bytes of the drawing's
/// text. Ends are exclusive.
pub(crate) fn findings_json(drawings: &[Findings]) -> String {
    let report = Report {
        version: 1,
        drawings: drawings.iter().map(drawing).collect(),
    };
    pretty(&report)
}

#[derive(Serialize)]
struct Report<'a> {
    version: u32,
    drawings: Vec<Drawing<'a>>,
}

#[derive(Serialize)]
struct Drawing<'a> {
    drawing: &'a str,
    diagnostics: Vec<Finding<'a>>,
    /// With `--look`.
    #[serde(skip_serializing_if = "Option::is_none")]
    look: Option<Likeness>,
}

#[derive(Serialize)]
struct Finding<'a> {
    code: &'static str,
    severity: &'static str,
    message: &'a str,
    #[serde(flatten)]
    range: TextRange,
    /// Where on the page the text or the shape is.
    #[serde(skip_serializing_if = "Option::is_none")]
    on_page: Option<&'static str>,
    label: Option<&'a str>,
    help: Option<&'a str>,
    related: Vec<RelatedEntry<'a>>,
    fixes: Vec<FixEntry<'a>>,
}

#[derive(Serialize)]
struct TextRange {
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
    start: usize,
    end: usize,
}

#[derive(Serialize)]
struct RelatedEntry<'a> {
    message: &'a str,
    #[serde(flatten)]
    range: TextRange,
}

#[derive(Serialize)]
struct FixEntry<'a> {
    title: &'a str,
    edits: Vec<Change<'a>>,
}

#[derive(Serialize)]
struct Change<'a> {
    text: &'a str,
    #[serde(flatten)]
    range: TextRange,
}

fn drawing<'a>(findings: &Findings<'a>) -> Drawing<'a> {
    let lines = LineIndex::new(findings.text);
    let diagnostics = findings.diagnostics.iter();
    Drawing {
        drawing: findings.path,
        diagnostics: diagnostics.map(|one| finding(one, &lines)).collect(),
        look: findings.look.map(|look| Likeness {
            right: (look.right * 1e4).floor() / 1e4,
            right_without_lines: (look.right_without_lines * 1e4).floor() / 1e4,
            // Rounded up, so that 0 means none.
            lines: (look.lines * 1e4).ceil() / 1e4,
            ..look
        }),
    }
}

fn finding<'a>(diagnostic: &'a Diagnostic, lines: &LineIndex<&str>) -> Finding<'a> {
    let related = |related: &'a Related| RelatedEntry {
        message: &related.message,
        range: text_range(related.span, lines),
    };
    let change = |edit: &'a Edit| Change {
        text: &edit.text,
        range: text_range(edit.span, lines),
    };
    let fix = |fix: &'a Fix| FixEntry {
        title: &fix.title,
        edits: fix.edits.iter().map(change).collect(),
    };
    Finding {
        code: diagnostic.code.id(),
        severity: diagnostic.severity().name(),
        message: &diagnostic.message,
        range: text_range(diagnostic.span, lines),
        on_page: diagnostic.on_page,
        label: diagnostic.label.as_deref(),
        help: diagnostic.help.as_deref(),
        related: diagnostic.related.iter().map(related).collect(),
        fixes: diagnostic.fixes.iter().map(fix).collect(),
    }
}

fn text_range(span: Span, lines: &LineIndex<&str>) -> TextRange {
    let (line, column) = lines.line_column(span.start);
    let (end_line, end_column) = lines.line_column(span.end);
    TextRange {
        line,
        column,
        end_line,
        end_column,
        start: span.start,
        end: span.end,
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{DRAWING, at, misspelled};
    use super::*;

    #[test]
    fn the_schema_is_what_it_was() {
        let finding = misspelled(DRAWING).related(at(DRAWING, "頭"), "the parent");
        let one = Findings {
            path: "a.svg",
            text: DRAWING,
            diagnostics: &[finding],
            look: None,
        };
        let none = Findings {
            path: "b.svg",
            text: "",
            diagnostics: &[],
            look: None,
        };
        insta::assert_snapshot!(findings_json(&[one, none]), @r#"
        {
          "version": 1,
          "drawings": [
            {
              "drawing": "a.svg",
              "diagnostics": [
                {
                  "code": "E101",
                  "severity": "error",
                  "message": "unknown keyword `Shap`",
                  "line": 2,
                  "column": 21,
                  "end_line": 2,
                  "end_column": 25,
                  "start": 26,
                  "end": 30,
                  "label": "not a keyword",
                  "help": "`okoshi explain` lists the keywords",
                  "related": [
                    {
                      "message": "the parent",
                      "line": 7,
                      "column": 12,
                      "end_line": 7,
                      "end_column": 13,
                      "start": 82,
                      "end": 85
                    }
                  ],
                  "fixes": [
                    {
                      "title": "write `Shape`",
                      "edits": [
                        {
                          "text": "Shape",
                          "line": 2,
                          "column": 21,
                          "end_line": 2,
                          "end_column": 25,
                          "start": 26,
                          "end": 30
                        }
                      ]
                    }
                  ]
                }
              ]
            },
            {
              "drawing": "b.svg",
              "diagnostics": []
            }
          ]
        }
    "#);
    }
}
