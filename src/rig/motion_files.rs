//! Motion files that strings link to, read and prepared.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::memo::Memo;
use crate::motion::bvh;
use crate::motion::prepare::{self, PreparedClip, prepare};
use crate::motion::skeleton::Clip;
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;
use crate::svg::broken_link;

use super::diagnostics;

/// A link to a motion file, as the key of a cached [`MotionFile`].
#[derive(PartialEq, Eq, Hash)]
struct MotionLink(String);

/// A file that was read.
#[derive(Debug)]
struct MotionFile {
    clip: Option<Arc<PreparedClip>>,
    /// What is wrong with the file, and how many complete frames precede that.
    error: Option<(bvh::Error, usize)>,
    notes: Vec<String>,
}

/// The motion files of a drawing, by link.
#[derive(Default)]
pub(super) struct MotionFiles(BTreeMap<String, Result<Arc<MotionFile>, LinkError>>);

impl MotionFiles {
    /// The clip of a file. Problems of the file are reported for every string that links to it, because each of these has to be fixed.
    pub(super) fn get(
        &mut self,
        link: &str,
        span: Span,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Arc<PreparedClip>> {
        let first = !self.0.contains_key(link);
        if first {
            let key = MotionLink(link.to_owned());
            let file = memo.get_reading(key, resolver, |key, resolver| {
                let bytes = resolver.read(&key.0)?;
                Ok(Arc::new(MotionFile::read(&bytes)))
            });
            self.0.insert(link.to_owned(), file);
        }
        match self.0.get(link)? {
            Err(error) => {
                diagnostics.push(broken_link(link, error, span));
                None
            }
            Ok(file) => {
                if let Some((error, frames)) = &file.error {
                    diagnostics.push(diagnostics::broken_file(link, error, *frames, span));
                }
                if first {
                    let notes = file.notes.iter();
                    diagnostics.extend(notes.map(|note| diagnostics::note(link, note, span)));
                }
                file.clip.clone()
            }
        }
    }
}

impl MotionFile {
    fn read(bytes: &[u8]) -> Self {
        let (clip, mut notes, error) = match bvh::read_bytes(bytes) {
            Ok(reading) => (Some(reading.clip), reading.notes, None),
            Err(mut error) => {
                let partial = error.partial.take().map(|clip| *clip);
                let frames = partial.as_ref().map_or(0, Clip::frames);
                (partial, Vec::new(), Some((error, frames)))
            }
        };
        let notes = notes.drain(..).map(|note| note.to_string());
        let mut notes: Vec<String> = notes.collect();
        let clip = clip.filter(|clip| clip.frames() > 0).and_then(|clip| {
            match prepare(clip, &prepare::Options::default()) {
                Ok(prepared) => {
                    notes.extend(prepared.notes.iter().cloned());
                    Some(Arc::new(prepared))
                }
                Err(error) => {
                    notes.push(format!(
                        "it cannot be shown at {} frames a second: {error}",
                        prepare::FPS
                    ));
                    None
                }
            }
        });
        Self { clip, error, notes }
    }
}
