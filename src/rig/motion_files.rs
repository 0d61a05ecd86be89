//! Motion files that strings link to, read and prepared.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::bind::{MotionSource, MotionTurn, SignedAxis, TurnRequest};
use crate::diagnostic::Diagnostic;
use crate::memo::Memo;
use crate::mocap::resample::{Outside, Range};
use crate::mocap::{Axis, UpAxis, bvh};
use crate::prepare::{self, PreparedClip, prepare};
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;

use super::diagnostics;
use super::missing_files::missing_file;

/// A link to a motion file and what is done with it, as the key of a cached [`MotionFile`].
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct MotionKey {
    link: String,
    up: Option<UpAxis>,
    /// Where in the file it begins and ends, as far as the string says so: the bits of numbers of seconds.
    cut: [Option<u64>; 2],
    is_loop: bool,
}

/// A file that was read.
#[derive(Debug)]
struct MotionFile {
    clip: Option<Arc<PreparedClip>>,
    /// What is wrong with the file, and how many complete frames precede that.
    error: Option<(bvh::Error, usize)>,
    notes: Vec<String>,
    /// What of the asked range the file does not have.
    outside: Option<Outside>,
}

/// The most numbers of all motions together; or so many times those of the longest one.
const MAX_NUMBERS: usize = 1 << 22;
const TIMES_LONGEST: usize = 4;

/// The motion files of a drawing.
#[derive(Default)]
pub(super) struct MotionFiles {
    read: BTreeMap<MotionKey, Result<Arc<MotionFile>, LinkError>>,
    /// How many numbers all of them have, and the longest one.
    numbers: usize,
    longest: usize,
    is_full: bool,
}

impl MotionFiles {
    /// The clip of the file that one of a string's motions links to, `None` if it links to none; `is_loop` says whether it is made one.
    /// Problems of the file are reported at `span` for every string that links to it, because each of these has to be fixed.
    pub(super) fn get(
        &mut self,
        request: &TurnRequest<'_>,
        is_loop: bool,
        span: Span,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Arc<PreparedClip>> {
        let MotionSource::File(link) = &request.motion.source else {
            return None;
        };
        let key = MotionKey {
            link: link.clone(),
            up: request.motion.up.and_then(up_axis),
            cut: cut(request.motion, is_loop).map(|seconds| seconds.map(f64::to_bits)),
            is_loop,
        };
        let first = !self.read.keys().any(|known| known.link == *link);
        let most = MAX_NUMBERS.max(TIMES_LONGEST.saturating_mul(self.longest));
        if !self.read.contains_key(&key) {
            // A short file that is cut in a thousand ways would fill the memory.
            if self.numbers > most {
                if !std::mem::replace(&mut self.is_full, true) {
                    diagnostics.push(diagnostics::too_many_numbers(self.numbers, most, span));
                }
                return None;
            }
            let file = memo.get_reading(key.clone(), resolver, |key, resolver| {
                let bytes = resolver.read(&key.link)?;
                Ok(Arc::new(MotionFile::read(&bytes, key)))
            });
            let clip = file.as_ref().ok().and_then(|file| file.clip.as_ref());
            let own = clip.map_or(0, |clip| clip.clip.values().len());
            self.numbers = self.numbers.saturating_add(own);
            self.longest = self.longest.max(own);
            self.read.insert(key.clone(), file);
        }
        match self.read.get(&key)? {
            Err(error) => {
                let span = request.source_span();
                let written = |file: &str| request.written(file);
                diagnostics.push(missing_file(link, error, span, written, resolver));
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
                if let Some(outside) = file.outside {
                    let timed = request.motion.seconds.is_some();
                    let span = request.source_span();
                    diagnostics.push(diagnostics::outside(link, outside, timed, span));
                }
                file.clip.clone()
            }
        }
    }
}

/// Where in a file the motion begins and ends, seconds, as far as a string says so: a number of seconds cuts one that is no loop.
fn cut(motion: &MotionTurn, is_loop: bool) -> [Option<f64>; 2] {
    let seconds = motion.seconds.filter(|_| !is_loop);
    let from = motion.from;
    let to = seconds.map(|seconds| from.unwrap_or(0.0) + seconds * motion.speed);
    [from, motion.to.or(to)]
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
        let mut outside = None;
        let clip = clip.filter(|clip| clip.frames > 0).and_then(|clip| {
            let cut = key.cut.map(|bits| bits.map(f64::from_bits));
            let (range, beyond) = Range::of_seconds(&clip, cut);
            outside = beyond;
            if outside.is_some_and(|outside| outside.is_beginning) {
                return None;
            }
            let options = prepare::Options {
                range,
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
        Self {
            clip,
            error,
            notes,
            outside,
        }
    }
}
