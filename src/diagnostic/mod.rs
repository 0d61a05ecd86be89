//! Diagnostics: what is wrong with a drawing, where, and how to fix it.
//!
//! A diagnostic is made by the code that detects the problem. The codes, severities and manual pages are
//! in one table, [`codes`].

mod apply;
pub mod codes;
mod gather;

pub(crate) use apply::applied;
pub use apply::apply_safe_fixes;
pub use codes::Code;
pub(crate) use gather::{FEW, few_or_one};

use std::borrow::Cow;
use std::ops::Range;

use crate::source::{Span, Text};

/// The severity of a diagnostic. With errors, `build` does not write a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The drawing does not say what to build.
    Error,
    /// The drawing can be built, but the result may not be what was meant.
    Warning,
    /// Useful to know.
    Hint,
}

impl Severity {
    /// The lower-case English name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Hint => "hint",
        }
    }
}

/// Another place that is related to a diagnostic.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Related {
    /// The place.
    pub span: Span,
    /// What is at that place.
    pub message: String,
}

/// A replacement of a range of the drawing's text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// The replaced range; an empty span inserts.
    pub span: Span,
    /// The new text, already escaped for XML.
    pub text: String,
}

impl Edit {
    /// The edits that replace the decoded characters `range` of a text by `new`, and nothing else: tags between them stay.
    /// `None` if they are only a part of an entity's expansion.
    pub fn replacing(text: &Text, range: Range<usize>, new: &str) -> Option<Vec<Self>> {
        if !text.can_replace(range.clone()) {
            return None;
        }
        let escaped = text.escape_at(range.start, new);
        let pieces = text.spans(range).into_iter().enumerate();
        let edits = pieces.map(|(index, span)| Self {
            span,
            text: match index {
                0 => escaped.clone(),
                _ => String::new(),
            },
        });
        Some(edits.collect())
    }
}

/// A fix that can be applied to the drawing automatically.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Fix {
    /// What the fix does, as an imperative.
    pub title: String,
    /// The edits; they do not overlap.
    pub edits: Vec<Edit>,
    /// Whether it cannot change what a person meant, so that it can be applied without asking.
    pub safe: bool,
}

/// A problem in a drawing, or something worth knowing about it.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Its stable code, which determines the severity.
    pub code: Code,
    /// One sentence that names the problem, without a full stop.
    pub message: String,
    /// The exact characters that the diagnostic is about.
    pub span: Span,
    /// Where on the page the text or the shape is: `at the top left of the page`. Set when a drawing has been compiled, unless
    /// the message says so.
    pub on_page: Option<&'static str>,
    /// A few words below the marked characters.
    pub label: Option<Cow<'static, str>>,
    /// Related places.
    pub related: Vec<Related>,
    /// How to fix the problem, in one sentence.
    pub help: Option<Cow<'static, str>>,
    /// Automatic fixes.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// A diagnostic with a message and nothing else.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            span,
            on_page: None,
            label: None,
            related: vec![],
            help: None,
            fixes: vec![],
        }
    }

    /// Adds a label below the marked characters.
    #[must_use]
    pub fn label(mut self, label: impl Into<Cow<'static, str>>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Adds a related place.
    #[must_use]
    pub fn related(mut self, span: Span, message: impl Into<String>) -> Self {
        self.related.push(Related {
            span,
            message: message.into(),
        });
        self
    }

    /// Adds help: how to fix the problem.
    #[must_use]
    pub fn help(mut self, help: impl Into<Cow<'static, str>>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds a fix with a single edit.
    #[must_use]
    pub fn fix(mut self, title: impl Into<String>, span: Span, text: impl Into<String>) -> Self {
        self.fixes.push(Fix {
            title: title.into(),
            edits: vec![Edit {
                span,
                text: text.into(),
            }],
            safe: false,
        });
        self
    }

    /// Marks the fixes as safe: they cannot change what a person meant.
    #[must_use]
    pub fn safe(mut self) -> Self {
        self.fixes.iter_mut().for_each(|fix| fix.safe = true);
        self
    }

    /// The severity, given by the code.
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }
}

/// Sorts diagnostics by their position in the text, errors first at one position, and drops duplicates.
pub fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by(|a, b| {
        (a.span, a.severity(), a.code, &a.message).cmp(&(b.span, b.severity(), b.code, &b.message))
    });
    diagnostics.dedup();
}

/// The first few of many things for people: `a, b, c and 9 more`.
pub fn listed(all: impl ExactSizeIterator<Item = String>) -> String {
    const SHOWN: usize = 3;

    let count = all.len();
    let shown = if count > SHOWN + 1 { SHOWN } else { count };
    let mut names: Vec<String> = all.take(shown).collect();
    let last = match count - shown {
        0 => names.pop(),
        more => Some(format!("{more} more")),
    };
    match (names.as_slice(), last) {
        ([], last) => last.unwrap_or_default(),
        (names, last) => format!("{} and {}", names.join(", "), last.unwrap_or_default()),
    }
}

/// The candidate with the smallest edit distance to `word`, if `word` could be a misspelling of it.
///
/// Case is ignored; up to a third of the letters may differ.
pub fn nearest_word<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let near = near_words(word, candidates);
    near.min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Whether `word` could be a misspelling of exactly one of the candidates.
pub fn has_one_near_word<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> bool {
    near_words(word, candidates).count() == 1
}

/// The candidates that `word` could be a misspelling of, each with its edit distance.
fn near_words<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> impl Iterator<Item = (usize, &'a str)> {
    let word = word.to_lowercase();
    let letters = word.chars().count();
    let allowed = (letters / 3).max(1);
    candidates
        .into_iter()
        // The comparison takes time and memory proportional to the product of both lengths.
        .filter(move |candidate| candidate.chars().count().abs_diff(letters) <= allowed.min(64))
        .map(move |candidate| {
            (
                strsim::damerau_levenshtein(&word, &candidate.to_lowercase()),
                candidate,
            )
        })
        // Two different one-letter words have nothing in common.
        .filter(move |(distance, candidate)| {
            *distance <= allowed && *distance < letters.max(candidate.chars().count())
        })
}
