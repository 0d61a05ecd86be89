//! The performed tracks that strings link to with `Perform`.

use std::collections::BTreeSet;

use crate::bind::PerformanceRequest;
use crate::diagnostic::Diagnostic;
use crate::resolver::Resolver;
use crate::source::Span;

use super::missing_files::missing_file;

/// The links to tracks that clips of the drawing have followed so far, by the places of their `Perform`.
#[derive(Default)]
pub(super) struct Performances(BTreeSet<Span>);

impl Performances {
    /// Follows the link of a clip's performance. One that cannot be followed is reported once, however many clips it is for.
    pub(super) fn follow(
        &mut self,
        request: &PerformanceRequest<'_>,
        resolver: &dyn Resolver,
        diagnostics: &mut Vec<Diagnostic>,
    ) {
        if !self.0.insert(request.span) {
            return;
        }
        if let Err(error) = resolver.read(request.file) {
            let span = request.file_span();
            let written = |file: &str| request.written(file);
            diagnostics.push(missing_file(request.file, &error, span, written, resolver));
        }
    }
}
