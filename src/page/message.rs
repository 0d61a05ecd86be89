//! The messages between the program and a page. Their JSON is the protocol: names of variants and fields stay.

use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};
use serde_json::value::RawValue;

use crate::diagnostic::Diagnostic;
use crate::scene::Size;
use crate::source::LineIndex;

/// A message to a page.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(crate) enum ToPage<'a> {
    /// The list of all drawings.
    Drawings { drawings: Vec<Listed<'a>> },
    /// A drawing was built.
    Build {
        drawing: &'a str,
        build: &'a Build<'a>,
    },
    /// A drawing's file is gone.
    Gone { drawing: &'a str },
    /// What a page without drawings offers. `key` is asked for when one is chosen.
    Starters {
        key: &'a str,
        starters: Vec<ListedStarter>,
    },
    /// Why the drawing that was chosen is not there.
    #[serde(rename = "unbegun")]
    NotBegun { why: &'a str },
    /// The page may change drawings, with this key, or a copy of one that is open in another program.
    Editing { key: &'a str, copy: bool },
    /// What can be undone and redone in a drawing, in words.
    Steps {
        drawing: &'a str,
        undo: Option<&'a str>,
        redo: Option<&'a str>,
    },
    /// An editor's cursor is in the string of a part, or of none.
    Light {
        drawing: &'a str,
        part: Option<&'a str>,
    },
}

/// A drawing in the list.
#[derive(Debug, Serialize)]
pub(crate) struct Listed<'a> {
    pub(crate) id: &'a str,
    pub(crate) name: &'a str,
    pub(crate) folder: &'a str,
}

/// A drawing to start from.
#[derive(Debug, Serialize)]
pub(crate) struct ListedStarter {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    /// The address of its picture.
    pub(crate) picture: Option<String>,
}

#[derive(Debug, Serialize)]
pub(crate) struct Build<'a> {
    pub(crate) revision: u64,
    pub(crate) milliseconds: f64,
    /// The address of the last good model.
    pub(crate) model: Option<String>,
    /// The address of its picture.
    pub(crate) picture: Option<String>,
    /// The address of the page of the drawing; `None` if nothing on it belongs to a model.
    pub(crate) paper: Option<String>,
    /// Whether the model is from an earlier build, because this one failed.
    pub(crate) stale: bool,
    /// Whether the model is only what can be built of a drawing with errors.
    pub(crate) incomplete: bool,
    pub(crate) triangles: usize,
    /// The size of the model, metres; `None` without triangles.
    pub(crate) size: Option<Size>,
    pub(crate) findings: Vec<Finding<'a>>,
    /// The revision that kept parts are of; `None` if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) since: Option<u64>,
    pub(crate) parts: Vec<PartOrKept<'a>>,
    pub(crate) clips: &'a RawValue,
    /// The address of the clips before they were performed and limited.
    pub(crate) originals: Option<String>,
    /// The address of other files of the drawing, without their endings; `None` if there are none.
    pub(crate) exports: Option<String>,
    pub(crate) steps: Timestamps,
}

/// An entry of a list of parts.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum PartOrKept<'a> {
    Part(&'a RawValue),
    /// Parts of an earlier build that are still the same: the position of the first, and how many.
    Kept([usize; 2]),
}

/// The times of a build.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Times {
    /// When the change was noticed.
    pub(crate) noticed: SystemTime,
    /// When building started.
    pub(crate) started: SystemTime,
    /// When the model was finished.
    pub(crate) finished: SystemTime,
    /// When it was published.
    pub(crate) pushed: SystemTime,
}

impl Times {
    /// How long building took.
    pub(crate) fn duration(&self) -> Duration {
        let duration = self.finished.duration_since(self.started);
        duration.unwrap_or_default()
    }
}

/// The times of a build, in milliseconds since 1970.
#[derive(Debug, Serialize)]
pub(crate) struct Timestamps {
    noticed: f64,
    begun: f64,
    built: f64,
    pushed: f64,
}

impl From<Times> for Timestamps {
    fn from(times: Times) -> Self {
        let milliseconds = |time: SystemTime| {
            let since = time.duration_since(SystemTime::UNIX_EPOCH);
            since.unwrap_or_default().as_secs_f64() * 1e3
        };
        Self {
            noticed: milliseconds(times.noticed),
            begun: milliseconds(times.started),
            built: milliseconds(times.finished),
            pushed: milliseconds(times.pushed),
        }
    }
}

/// A finding with its line of the drawing. Lines and columns count from 1; `from` and `to`, the marked part of `text`, from 0.
/// All count characters.
#[derive(Debug, Serialize)]
pub(crate) struct Finding<'a> {
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<&'a str>,
    /// Where it is on the page.
    #[serde(skip_serializing_if = "Option::is_none")]
    place: Option<&'static str>,
    help: Vec<&'a str>,
    line: usize,
    column: usize,
    text: String,
    from: usize,
    to: usize,
}

/// How many characters of a line are shown on each side of the marked part.
const MAX_CONTEXT: usize = 60;
/// How many characters of the marked part are shown.
const MAX_MARKED: usize = 160;
/// How many findings are shown.
const MAX_FINDINGS: usize = 500;

/// The findings of a drawing; if there are too many, the most severe ones.
pub(crate) fn findings<'a>(diagnostics: &'a [Diagnostic], text: &str) -> Vec<Finding<'a>> {
    let places = LineIndex::new(text);
    let mut shown: Vec<&Diagnostic> = diagnostics.iter().collect();
    if shown.len() > MAX_FINDINGS {
        shown.sort_by_key(|diagnostic| diagnostic.severity());
        shown.truncate(MAX_FINDINGS);
    }
    let finding = |diagnostic: &'a Diagnostic| {
        let start = places.clamp(diagnostic.span.start);
        let (line, column) = places.line_column(start);
        let (low, high) = places.extent(line);
        let end = places
            .clamp(diagnostic.span.end)
            .clamp(start, high.max(start));
        let last = |text: &str, count| {
            let cut = text.chars().rev().take(count).collect::<Vec<_>>();
            cut.into_iter().rev().collect::<String>()
        };
        let before = last(&text[low.min(start)..start], MAX_CONTEXT);
        let marked: String = text[start..end].chars().take(MAX_MARKED).collect();
        let behind: String = text[end..high.max(end)].chars().take(MAX_CONTEXT).collect();
        let before = before.trim_start();
        let from = before.chars().count();
        Finding {
            severity: diagnostic.severity().name(),
            code: diagnostic.code.id(),
            message: &diagnostic.message,
            label: diagnostic.label.as_deref(),
            place: diagnostic.on_page,
            help: diagnostic.help.as_deref().into_iter().collect(),
            line,
            column,
            from,
            to: from + marked.chars().count(),
            text: format!("{before}{marked}{behind}"),
        }
    };
    shown.into_iter().map(finding).collect()
}

/// A message from a page. Unknown ones are ignored.
#[derive(Debug, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(crate) enum FromPage {
    /// A part was clicked.
    Pick { drawing: String, part: String },
    /// A finding was clicked. Lines and columns count from 1, columns in characters.
    Open {
        drawing: String,
        line: usize,
        column: usize,
    },
    /// The page shows this drawing.
    Want {},
    /// A drawing to start from was chosen.
    Begin { key: String, starter: String },
    #[serde(other)]
    Other,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Code;
    use crate::source::Span;

    #[test]
    fn findings_show_their_line() {
        let text = format!(
            "<svg>\n  {}腕$Shap</text>{}\n",
            "y".repeat(500),
            "z".repeat(500)
        );
        let at = text.find("Shap").unwrap();
        let found = Diagnostic::new(Code::UnknownKeyword, Span::new(at, at + 4), "unknown");
        let off = Diagnostic::new(Code::UnknownKeyword, Span::new(1 << 20, 1 << 21), "unknown");
        let diagnostics = [found, off];
        let shown = findings(&diagnostics, &text);
        let marked: String = shown[0].text.chars().skip(shown[0].from).take(4).collect();
        assert_eq!(marked, "Shap");
        assert_eq!((shown[0].line, shown[0].column), (2, 505));
        assert!(shown[0].text.chars().count() < 2 * MAX_CONTEXT + MAX_MARKED);
        assert_eq!(shown[1].text, "");
    }
}
