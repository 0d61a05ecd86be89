//! What an editor of strings asks about a drawing: its texts, and what `ide` knows of a place in one. Places in texts are in UTF-16 code
//! units, as editors in browsers have them.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{FromFolder, MemoryResolver, folder_and_name};
use crate::diagnostic::{Diagnostic, Edit, applied};
use crate::ide::changes::Refusal;
use crate::ide::{self, Analysis, Context, ProposalKind};
use crate::source::{Text, unescape_xml};

/// A question about a drawing.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ToAsk {
    pub(super) drawing: String,
    ask: Question,
}

/// The question. A text is known by the byte of the drawing where it begins.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum Question {
    /// All texts, each with what is wrong in it.
    Texts,
    /// What is at a place, and what can be done about it.
    Place { start: usize, at: usize },
    /// What can be written at a place of a text that is perhaps not in the drawing yet.
    Proposals {
        start: usize,
        at: usize,
        text: String,
    },
}

/// A text of a drawing.
#[derive(Debug, Serialize)]
struct Line<'a> {
    start: usize,
    text: &'a str,
    /// The name of what it is about.
    part: Option<&'a str>,
    problems: Vec<Problem<'a>>,
}

/// Something wrong in a text.
#[derive(Debug, Serialize)]
struct Problem<'a> {
    from: usize,
    to: usize,
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    help: Option<&'a str>,
}

/// Answers a question.
///
/// # Errors
/// If the text is not there any more.
pub(super) fn answered(
    asked: &ToAsk,
    analysis: &Analysis,
    files: &MemoryResolver,
) -> Result<Value, Refusal> {
    match &asked.ask {
        Question::Texts => Ok(json!(lines(analysis))),
        Question::Place { start, at } => {
            let text = text_from(analysis, *start)?;
            Ok(place(analysis, text, byte_of(text.as_str(), *at)))
        }
        Question::Proposals { start, at, text } => {
            let old = text_from(analysis, *start)?;
            let at = byte_of(text, *at);
            Ok(proposals(analysis, old, text, at, &|| {
                FromFolder {
                    folder: folder_and_name(&asked.drawing).0,
                    files,
                }
                .all()
            }))
        }
    }
}

fn text_from(analysis: &Analysis, start: usize) -> Result<&Text, Refusal> {
    let text = analysis.text_from(start);
    text.ok_or_else(|| Refusal::without_choice("this string is not in the drawing any more"))
}

fn lines(analysis: &Analysis) -> Vec<Line<'_>> {
    let texts = analysis.texts().into_iter();
    let lines = texts.map(|text| {
        let start = text.whole().start;
        Line {
            start,
            text: text.as_str(),
            part: analysis.part_at(start),
            problems: analysis
                .problems_of(text)
                .map(|(range, found)| problem(text, range, found))
                .collect(),
        }
    });
    lines.collect()
}

fn problem<'a>(text: &Text, range: Range<usize>, found: &'a Diagnostic) -> Problem<'a> {
    Problem {
        from: unit_of(text.as_str(), range.start),
        to: unit_of(text.as_str(), range.end),
        severity: found.severity().name(),
        code: found.code.id(),
        message: &found.message,
        help: found.help.as_deref(),
    }
}

fn place(analysis: &Analysis, text: &Text, at: usize) -> Value {
    let hover = analysis.hover(text.span(at..at).start);
    let hover = hover.map(|hover| {
        let decoded = |raw| text.offset_of(raw).map(|at| unit_of(text.as_str(), at));
        json!({ "from": decoded(hover.span.start), "to": decoded(hover.span.end), "markdown": hover.markdown })
    });
    let actions = analysis.actions_in(text, at).into_iter();
    let actions = actions
        .map(|action| json!({ "title": action.title, "fixes": action.diagnostic.is_some() }));
    json!({ "hover": hover, "actions": actions.collect::<Vec<_>>(), "byte": at })
}

/// What can be written at byte `at` of `new`, which stands or will stand in the place of a text.
fn proposals(
    analysis: &Analysis,
    old: &Text,
    new: &str,
    at: usize,
    files: &dyn Fn() -> Vec<String>,
) -> Value {
    let Some(edits) = Edit::replacing(old, 0..old.as_str().len(), new) else {
        return Value::Null;
    };
    let source = match old.as_str() == new {
        true => analysis.source().to_string(),
        false => applied(analysis.source(), &edits),
    };
    let start = old.whole().start;
    let offset = match old.as_str() == new {
        true => old.span(at..at).start,
        false => start + old.escape_at(0, &new[..at]).len(),
    };
    let context = Context {
        source: &source,
        analysis,
        files,
    };
    let Some(found) = ide::completion(&context, offset) else {
        return Value::Null;
    };
    let decoded = |text: &str| unescape_xml(text);
    // From the beginning of the word to the cursor, and on to its end.
    let before = decoded(&source[found.span.start..offset]).len();
    let behind = decoded(&source[offset..found.span.end.max(offset)]).len();
    let options = found.proposals.iter().map(|proposal| {
        json!({
            "label": proposal.label,
            "kind": kind(proposal.kind),
            "detail": proposal.detail,
            "text": decoded(&proposal.text),
        })
    });
    json!({
        "from": unit_of(new, at.saturating_sub(before)),
        "to": unit_of(new, (at + behind).min(new.len())),
        "options": options.collect::<Vec<_>>(),
        "more": found.is_incomplete,
    })
}

fn kind(kind: ProposalKind) -> &'static str {
    match kind {
        ProposalKind::String => "text",
        ProposalKind::Keyword | ProposalKind::Flag => "keyword",
        ProposalKind::Word | ProposalKind::Color => "constant",
        ProposalKind::Part | ProposalKind::Joint => "class",
        ProposalKind::Variable => "variable",
        ProposalKind::Function => "function",
        ProposalKind::File => "namespace",
    }
}

/// The byte where the UTF-16 code unit `unit` of a text begins; its end if it is shorter.
fn byte_of(text: &str, unit: usize) -> usize {
    let mut units = 0;
    let found = text.char_indices().find(|(_, c)| {
        let is_here = units >= unit;
        units += c.len_utf16();
        is_here
    });
    found.map_or(text.len(), |(byte, _)| byte)
}

/// The UTF-16 code unit of a byte of a text.
fn unit_of(text: &str, byte: usize) -> usize {
    let before = text.char_indices().take_while(|(at, _)| *at < byte);
    before.map(|(_, c)| c.len_utf16()).sum()
}
