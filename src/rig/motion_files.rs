//! Motion files that strings link to, read and prepared.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::motion::bvh;
use crate::motion::prepare::{self, PreparedClip, prepare};
use crate::motion::skeleton::Clip;
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;
use crate::svg::broken_link;

use super::diagnostics;

/// The files of the previous compile, by link.
pub(super) type Memory = BTreeMap<String, MotionFile>;

/// A file that was read.
#[derive(Debug, Clone)]
pub(super) struct MotionFile {
    bytes: Arc<[u8]>,
    clip: Option<Arc<PreparedClip>>,
    /// What is wrong with the file, and how many complete frames precede that.
    error: Option<(Arc<bvh::Error>, usize)>,
    notes: Arc<[String]>,
}

/// The motion files of a drawing.
pub(super) struct MotionFiles {
    before: Memory,
    now: BTreeMap<String, Result<MotionFile, LinkError>>,
}

impl MotionFiles {
    pub(super) fn new(before: Memory) -> Self {
        Self {
            before,
            now: BTreeMap::new(),
        }
    }

    /// The clip of a file. Problems of the file are reported for every string that links to it, because each of these has to be fixed.
    pub(super) fn get(
        &mut self,
        link: &str,
        span: Span,
        resolver: &dyn Resolver,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Arc<PreparedClip>> {
        let first = !self.now.contains_key(link);
        if first {
            let read = resolver
                .read(link)
                .map(|bytes| match self.before.remove(link) {
                    Some(known) if known.bytes == bytes => known,
                    _ => MotionFile::read(bytes),
                });
            self.now.insert(link.to_owned(), read);
        }
        match self.now.get(link)? {
            Err(error) => {
                diagnostics.push(broken_link(link, error, span));
                None
            }
            Ok(known) => {
                if let Some((error, frames)) = &known.error {
                    diagnostics.push(diagnostics::broken_file(link, error, *frames, span));
                }
                if first {
                    let notes = known.notes.iter();
                    diagnostics.extend(notes.map(|note| diagnostics::note(link, note, span)));
                }
                known.clip.clone()
            }
        }
    }

    /// Keeps what was read for the next compile.
    pub(super) fn into_memory(self) -> Memory {
        let read = self.now.into_iter();
        read.filter_map(|(link, known)| Some((link, known.ok()?)))
            .collect()
    }
}

impl MotionFile {
    fn read(bytes: Arc<[u8]>) -> Self {
        let (clip, mut notes, error) = match bvh::read_bytes(&bytes) {
            Ok(reading) => (Some(reading.clip), reading.notes, None),
            Err(mut error) => {
                let partial = error.partial.take().map(|clip| *clip);
                let frames = partial.as_ref().map_or(0, Clip::frames);
                (partial, Vec::new(), Some((Arc::new(error), frames)))
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
        Self {
            bytes,
            clip,
            error,
            notes: notes.into(),
        }
    }
}
