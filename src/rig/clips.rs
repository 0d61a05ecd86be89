//! Motion files that strings link to, read and made ready.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use crate::diagnostic::Diagnostic;
use crate::motion::bvh;
use crate::motion::labels::Anatomy;
use crate::motion::limited::{self, Cut, Options};
use crate::motion::ready::{self, Ready};
use crate::motion::skeleton::Clip;
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;
use crate::svg::broken_link;

use super::told;

/// A clip that is ready to be carried over.
#[derive(Debug)]
pub(super) struct Prepared {
    /// At 24 frames a second, without a lead-in.
    pub(super) clip: Clip,
    pub(super) anatomy: Arc<Anatomy>,
    /// Where the joints are: frames × joints, the file's unit.
    positions: Vec<DVec3>,
    /// Per frame how fast it is: the sum of the squares of the joints' steps from the frame before.
    pub(super) speeds: Arc<[f64]>,
}

impl Prepared {
    fn new(ready: Ready) -> Self {
        let joints = ready.clip.skeleton.joints.len();
        Self {
            speeds: limited::speeds(&ready.positions, joints).into(),
            positions: ready.positions,
            anatomy: Arc::new(ready.anatomy),
            clip: ready.clip,
        }
    }

    /// The clip as limited animation.
    pub(super) fn cut(&self, options: &Options) -> Cut {
        limited::limit(&self.positions, self.clip.skeleton.joints.len(), options)
    }
}

/// What was read the last time, by link.
pub(super) type Memory = BTreeMap<String, Known>;

/// A file that was read.
#[derive(Debug, Clone)]
pub(super) struct Known {
    bytes: Arc<[u8]>,
    clip: Option<Arc<Prepared>>,
    /// What is wrong with it, and how many frames were read before that.
    error: Option<(Arc<bvh::Error>, usize)>,
    notes: Arc<[String]>,
}

/// The files of a drawing.
pub(super) struct Stock {
    before: Memory,
    now: BTreeMap<String, Result<Known, LinkError>>,
}

impl Stock {
    pub(super) fn new(before: Memory) -> Self {
        Self {
            before,
            now: BTreeMap::new(),
        }
    }

    /// The clip of a file. What is wrong with the file is said each time it is asked for, for each string has to be mended.
    pub(super) fn get(
        &mut self,
        link: &str,
        span: Span,
        resolver: &dyn Resolver,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Arc<Prepared>> {
        let first = !self.now.contains_key(link);
        if first {
            let read = resolver
                .read(link)
                .map(|bytes| match self.before.remove(link) {
                    Some(known) if known.bytes == bytes => known,
                    _ => Known::read(bytes),
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
                    diagnostics.push(told::broken_file(link, error, *frames, span));
                }
                if first {
                    let notes = known.notes.iter();
                    diagnostics.extend(notes.map(|note| told::note(link, note, span)));
                }
                known.clip.clone()
            }
        }
    }

    /// Remembers what was read, for the next time.
    pub(super) fn into_memory(self) -> Memory {
        let read = self.now.into_iter();
        read.filter_map(|(link, known)| Some((link, known.ok()?)))
            .collect()
    }
}

impl Known {
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
            match ready::ready(clip, &ready::Options::default()) {
                Ok(ready) => {
                    notes.extend(ready.notes.iter().cloned());
                    Some(Arc::new(Prepared::new(ready)))
                }
                Err(error) => {
                    notes.push(format!(
                        "it cannot be shown at {} frames a second: {error}",
                        ready::FPS
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
