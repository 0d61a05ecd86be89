//! Incremental compiles: an editor compiles at every keystroke, and a keystroke changes little.

use std::sync::Arc;

use super::{Compiled, Options, Reading};
use crate::bind;
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::source::Change;
use crate::svg::{Drawing, TextEdit};
use crate::threads;

/// Compiles versions of one drawing. The result is that of [`compile`](super::compile), but comes sooner: if only the
/// characters of one text changed since the last version, the SVG is not parsed again.
///
/// It keeps about as much memory as the last version and the files that it links to.
#[derive(Debug, Default)]
pub struct Compiler {
    last: Option<Version>,
    memo: Memo,
    was_partial: bool,
}

/// A version of the drawing that was read.
#[derive(Debug)]
struct Version {
    source: String,
    options: Options,
    reading: Reading,
}

impl Compiler {
    /// Compiles a drawing. Never fails and never panics: a panic becomes a diagnostic.
    ///
    /// It is fastest if nobody holds the last [`Compiled`] any more: its drawing is then changed in place.
    pub fn compile(
        &mut self,
        source: &str,
        options: &Options,
        resolver: &dyn Resolver,
    ) -> Compiled {
        let last = self.last.take();
        let memo = &self.memo;
        let done = threads::run(move || {
            let updated = last.and_then(|last| last.updated(source, options, resolver));
            let is_partial = updated.is_some();
            let version = updated.unwrap_or_else(|| Version::read(source, options, resolver));
            let reading = version.reading.clone();
            (reading.build(resolver, memo), version, is_partial)
        });
        let (compiled, version, is_partial) = match done {
            Ok(done) => done,
            Err(crash) => {
                // A panic may have left anything half changed.
                self.forget();
                return Compiled::crashed(&crash);
            }
        };
        self.memo.next_generation();
        self.last = Some(version);
        self.was_partial = is_partial;
        compiled
    }

    /// Drops everything that is kept: the next compile takes as long as the first.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Whether the last compile did without parsing the SVG, for statistics and tests.
    pub fn last_was_partial(&self) -> bool {
        self.was_partial
    }
}

impl Version {
    fn read(source: &str, options: &Options, resolver: &dyn Resolver) -> Self {
        Self {
            source: source.to_owned(),
            options: *options,
            reading: Reading::read(source, options, resolver),
        }
    }

    /// The version with the text `source`; `None` if more changed than the characters of one text.
    fn updated(mut self, source: &str, options: &Options, resolver: &dyn Resolver) -> Option<Self> {
        let change = Change::between(&self.source, source);
        let mut dependencies = self.reading.dependencies.iter();
        if self.options != *options || !dependencies.all(|read| read.is_unchanged(resolver)) {
            return None;
        }
        if change.is_empty() {
            return Some(self);
        }
        let edit = TextEdit::find(&self.reading.drawing, &self.source, source, change)?;
        let drawing = Arc::make_mut(&mut self.reading.drawing);
        edit.apply(drawing);
        if !reads_same_pixels(drawing) || !bind::has_same_pose_layers(drawing) {
            return None;
        }
        for diagnostic in &mut self.reading.diagnostics {
            edit.apply_to_diagnostic(diagnostic);
        }
        let inserted = &source[change.start..change.new_end];
        self.source
            .replace_range(change.start..change.old_end, inserted);
        Some(self)
    }
}

/// Whether the strings, as they are now, ask for the same pictures to be read pixel by pixel (in tile layers) and the
/// same to be traced.
fn reads_same_pixels(drawing: &Drawing) -> bool {
    let known = drawing.pixel_groups.as_ref();
    known.is_none_or(|known| *known == bind::in_layers_of_pixels(drawing))
}
