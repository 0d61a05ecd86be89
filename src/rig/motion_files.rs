//! Motion files that strings link to, read and prepared.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::bind::{ClipRequest, SignedAxis};
use crate::diagnostic::Diagnostic;
use crate::memo::Memo;
use crate::mocap::Axis;
use crate::mocap::{UpAxis, bvh};
use crate::prepare::{self, PreparedClip, prepare};
use crate::resolver::{LinkError, Resolver};

use super::diagnostics;
use super::missing_files::missing_file;

/// A link to a motion file and what is done with it, as the key of a cached [`MotionFile`].
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct MotionKey {
    link: String,
    up: Option<UpAxis>,
    is_loop: bool,
}

/// A file that was read.
#[derive(Debug)]
struct MotionFile {
    clip: Option<Arc<PreparedClip>>,
    /// What is wrong with the file, and how many complete frames precede that.
    error: Option<(bvh::Error, usize)>,
    notes: Vec<String>,
}

/// The motion files of a drawing.
#[derive(Default)]
pub(super) struct MotionFiles(BTreeMap<MotionKey, Result<Arc<MotionFile>, LinkError>>);

impl MotionFiles {
    /// The clip of the file that a string requests. Problems of the file are reported for every string that links to it, because
    /// each of these has to be fixed.
    pub(super) fn get(
        &mut self,
        link: &str,
        request: &ClipRequest<'_>,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Arc<PreparedClip>> {
        let key = MotionKey {
            link: link.to_owned(),
            up: request.up.and_then(up_axis),
            is_loop: request.is_loop,
        };
        let first = !self.0.keys().any(|known| known.link == link);
        let file = self.0.entry(key.clone()).or_insert_with(|| {
            memo.get_reading(key, resolver, |key, resolver| {
                let bytes = resolver.read(&key.link)?;
                Ok(Arc::new(MotionFile::read(&bytes, key)))
            })
        });
        match file {
            Err(error) => {
                let span = request.source_span();
                let written = |file: &str| request.written(file);
                diagnostics.push(missing_file(link, error, span, written, resolver));
                None
            }
            Ok(file) => {
                let span = request.span;
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

/// The axis that a string names; the language's axes are numbered like those of skeletons.
fn up_axis(axis: SignedAxis) -> Option<UpAxis> {
    let found = *[Axis::X, Axis::Y, Axis::Z].get(axis.axis)?;
    Some(UpAxis {
        axis: found,
        is_negative: axis.negative,
    })
}

impl MotionFile {
    fn read(bytes: &[u8], key: &MotionKey) -> Self {
        let (clip, mut notes, error) = match bvh::read_bytes(bytes) {
            Ok(reading) => (Some(reading.clip), reading.notes, None),
            Err(mut error) => {
                let partial = error.partial.take().map(|clip| *clip);
                let frames = partial.as_ref().map_or(0, |clip| clip.frames);
                (partial, Vec::new(), Some((error, frames)))
            }
        };
        let notes = notes.drain(..).map(|note| note.to_string());
        let mut notes: Vec<String> = notes.collect();
        let clip = clip.filter(|clip| clip.frames > 0).and_then(|clip| {
            let options = prepare::Options {
                up: key.up,
                is_loop: key.is_loop,
                ..prepare::Options::default()
            };
            match prepare(clip, &options) {
                Ok(prepared) => {
                    notes.extend(prepared.notes.iter().cloned());
                    Some(Arc::new(prepared))
                }
                Err(error) => {
                    notes.push(format!(
                        "it cannot be shown at {} frames a second: {error}",
                        crate::mocap::resample::FPS
                    ));
                    None
                }
            }
        });
        Self { clip, error, notes }
    }
}
