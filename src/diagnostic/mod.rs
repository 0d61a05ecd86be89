//! What is wrong with a drawing, where, and what to do about it.
//!
//! Diagnostics are made where the fault is seen; their codes, severities and manual pages are one
//! table, [`codes`].

pub mod codes;

pub use codes::Code;

use std::borrow::Cow;

use crate::source::Span;

/// How bad it is. Errors keep `build` from writing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The drawing does not say what to build.
    Error,
    /// It can be built, but perhaps not as it was meant.
    Warning,
    /// Worth knowing.
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

/// Another place that has to do with a diagnostic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Related {
    /// The place.
    pub span: Span,
    /// What is there.
    pub message: String,
}

/// A replacement of one stretch of the drawing's text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// What is replaced; an empty span inserts.
    pub span: Span,
    /// What takes its place, already escaped for XML.
    pub text: String,
}

/// A way out that can be applied to the drawing as it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// What it does, as an imperative.
    pub title: String,
    /// The edits, which do not overlap.
    pub edits: Vec<Edit>,
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Its stable code, which fixes the severity.
    pub code: Code,
    /// One sentence that names the thing, without a full stop.
    pub message: String,
    /// The exact characters that it is about.
    pub span: Span,
    /// A few words under the caret.
    pub label: Option<Cow<'static, str>>,
    /// Other places.
    pub related: Vec<Related>,
    /// What to do, in a sentence.
    pub help: Option<Cow<'static, str>>,
    /// What can be done at a click.
    pub fixes: Vec<Fix>,
}

impl Diagnostic {
    /// A finding with a message at a place, and nothing else.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            span,
            label: None,
            related: vec![],
            help: None,
            fixes: vec![],
        }
    }

    /// Adds the words under the caret.
    #[must_use]
    pub fn label(mut self, label: impl Into<Cow<'static, str>>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Adds another place.
    #[must_use]
    pub fn related(mut self, span: Span, message: impl Into<String>) -> Self {
        self.related.push(Related {
            span,
            message: message.into(),
        });
        self
    }

    /// Adds what to do.
    #[must_use]
    pub fn help(mut self, help: impl Into<Cow<'static, str>>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Adds a fix of one edit.
    #[must_use]
    pub fn fix(mut self, title: impl Into<String>, span: Span, text: impl Into<String>) -> Self {
        self.fixes.push(Fix {
            title: title.into(),
            edits: vec![Edit {
                span,
                text: text.into(),
            }],
        });
        self
    }

    /// The severity of its code.
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }
}

/// Puts diagnostics in the order of the text, errors first at one place, and drops exact repeats.
pub fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by(|a, b| {
        (a.span, a.severity(), a.code, &a.message).cmp(&(b.span, b.severity(), b.code, &b.message))
    });
    diagnostics.dedup();
}

/// The candidate nearest to `word` in spelling, if it is near enough to be a slip of the pen.
///
/// Case is ignored; up to a third of the letters may differ.
pub fn nearest_word<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let word = word.to_lowercase();
    let letters = word.chars().count();
    let allowed = (letters / 3).max(1);
    candidates
        .into_iter()
        // Comparing takes time and memory of the product of both lengths.
        .filter(|candidate| candidate.chars().count().abs_diff(letters) <= allowed.min(64))
        .map(|candidate| {
            (
                strsim::damerau_levenshtein(&word, &candidate.to_lowercase()),
                candidate,
            )
        })
        // Words of one letter each have nothing in common.
        .filter(|(distance, candidate)| {
            *distance <= allowed && *distance < letters.max(candidate.chars().count())
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}
