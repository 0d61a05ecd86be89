//! Texts with what is known of them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ls_types::Uri;

use super::convert::PositionMap;
use super::positions::Positions;
use crate::diagnostic::Code;
use crate::ide::Analysis;

/// Where each code is explained.
pub(crate) type Pages = BTreeMap<Code, Uri>;

/// A state of a text.
#[derive(Debug)]
pub(crate) struct Document {
    /// Its address, as the client writes it.
    pub(crate) uri: Uri,
    /// The client's version number.
    pub(crate) version: i32,
    /// The server's own version number: it also grows when only a linked file has changed.
    pub(crate) generation: u64,
    /// The text with its line index.
    pub(crate) positions: Positions,
    /// Its file, if it has one on disk.
    pub(crate) path: Option<PathBuf>,
}

impl Document {
    pub(crate) fn text(&self) -> &Arc<str> {
        self.positions.text()
    }

    /// The folder on disk that its links are relative to.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.path.as_deref().and_then(Path::parent)
    }
}

/// A state of a text with its analysis.
#[derive(Debug)]
pub(crate) struct Analyzed {
    pub(crate) document: Arc<Document>,
    pub(crate) analysis: Analysis,
    /// The last analysis of well-formed XML, if this is none.
    pub(crate) last_sound: Option<Arc<Analyzed>>,
}

impl Analyzed {
    /// A state of a text whose last one was `last`.
    pub(crate) fn new(
        document: Arc<Document>,
        analysis: Analysis,
        last: Option<Arc<Analyzed>>,
    ) -> Arc<Self> {
        let last_sound = match (analysis.is_sound(), last) {
            (false, Some(last)) if last.analysis.is_sound() => Some(last),
            (false, Some(last)) => last.last_sound.clone(),
            _ => None,
        };
        Arc::new(Self {
            document,
            analysis,
            last_sound,
        })
    }

    /// What is known of the drawing: the last analysis that was sound, if this one is not.
    pub(crate) fn known(&self) -> &Self {
        self.last_sound.as_deref().unwrap_or(self)
    }
}

/// A text and its analysis, which may be one of an earlier state.
pub(crate) struct View {
    pub(crate) document: Arc<Document>,
    pub(crate) analyzed: Arc<Analyzed>,
}

impl View {
    /// The text with its analysis, or, if it is not well-formed, the last analysis that was; `None` for a drawing without strings.
    pub(crate) fn of(analyzed: Arc<Analyzed>) -> Option<Self> {
        let document = analyzed.document.clone();
        let analyzed = analyzed.last_sound.clone().unwrap_or(analyzed);
        let view = Self { document, analyzed };
        view.analysis().is_annotated().then_some(view)
    }

    pub(crate) fn analysis(&self) -> &Analysis {
        &self.analyzed.analysis
    }

    pub(crate) fn map(&self) -> PositionMap<'_> {
        if Arc::ptr_eq(&self.document, &self.analyzed.document) {
            PositionMap::identity(&self.document.positions)
        } else {
            PositionMap::after_edit(&self.document.positions, self.analyzed.document.text())
        }
    }

    /// Whether the analysis is of this very text, so that it can be edited.
    pub(crate) fn is_current(&self) -> bool {
        Arc::ptr_eq(&self.document, &self.analyzed.document) && self.analysis().is_sound()
    }
}
