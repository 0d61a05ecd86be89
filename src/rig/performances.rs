//! The performed tracks that strings link to with `Perform`.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::diagnostics;
use super::missing_files::missing_file;
use crate::bind::PerformanceRequest;
use crate::diagnostic::Diagnostic;
use crate::mark_tracks::{self, MarkId, MarkTracks};
use crate::memo::Memo;
use crate::resolver::{LinkError, Resolver};
use crate::source::Span;

/// A link to a file of tracks, as the key of the cached file.
#[derive(Clone, PartialEq, Eq, Hash)]
struct TrackKey(String);

/// What a file of tracks holds.
type TrackFile = Result<Arc<MarkTracks>, Arc<mark_tracks::Error>>;

/// The tracks that clips of a drawing have followed so far.
#[derive(Default)]
pub(super) struct Performances {
    files: BTreeMap<String, Result<TrackFile, LinkError>>,
    /// The places of links that were reported, however many clips they are for.
    reported: BTreeSet<Span>,
    /// Per place of a `Perform` its file, and which marks of it parts of figures have.
    used: BTreeMap<Span, (Arc<MarkTracks>, BTreeSet<MarkId>)>,
}

impl Performances {
    /// The tracks of a clip's performance. Files that cannot be read are reported.
    pub(super) fn get(
        &mut self,
        request: &PerformanceRequest<'_>,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Arc<MarkTracks>> {
        let file = self
            .files
            .entry(request.file.to_owned())
            .or_insert_with(|| {
                memo.get_reading(
                    TrackKey(request.file.to_owned()),
                    resolver,
                    |key, resolver| {
                        let bytes = resolver.read(&key.0)?;
                        Ok(MarkTracks::from_bytes(&bytes)
                            .map(Arc::new)
                            .map_err(Arc::new))
                    },
                )
            });
        let span = request.file_span();
        let problem = match file {
            Ok(Ok(tracks)) => return Some(Arc::clone(tracks)),
            Ok(Err(error)) => diagnostics::broken_track(request.file, error, span),
            Err(error) => {
                let written = |file: &str| request.written(file);
                missing_file(request.file, error, span, written, resolver)
            }
        };
        if self.reported.insert(span) {
            diagnostics.push(problem);
        }
        None
    }

    /// Notes which marks of a file a figure has, for the report of those that no figure has.
    pub(super) fn note_used(
        &mut self,
        request: &PerformanceRequest<'_>,
        tracks: &Arc<MarkTracks>,
        marks: impl Iterator<Item = MarkId>,
    ) {
        let none = || (Arc::clone(tracks), BTreeSet::new());
        let (_, used) = self.used.entry(request.span).or_insert_with(none);
        used.extend(marks);
    }

    /// Reports the marks that no part of the drawing has.
    pub(super) fn report_unused(&self, diagnostics: &mut Vec<Diagnostic>) {
        for (span, (tracks, used)) in &self.used {
            let unused = tracks.marks.keys().filter(|mark| !used.contains(mark));
            let unused: Vec<&str> = unused
                .map(|mark| tracks.marks[mark].name.as_str())
                .collect();
            // Without any mark the performance has no effect, which is reported by itself.
            if !unused.is_empty() && !used.is_empty() {
                diagnostics.push(diagnostics::unused_marks(&unused, *span));
            }
        }
    }
}
