//! The same drawing again, a little changed: what an editor asks for at every keystroke.

use std::sync::Arc;

use super::{Compiled, Followed, Memory, Options, Reading, given_up};
use crate::bind;
use crate::diagnostic::Diagnostic;
use crate::resolver::Resolver;
use crate::source::Change;
use crate::svg::{Drawing, Retyped};
use crate::threads;

/// Compiles a drawing again and again. It gives what [`compile`](super::compile) gives, sooner: a drawing in which
/// only the characters of a text changed since the last time is not read anew.
///
/// What it remembers is as large as the last drawing and the files that it links to.
#[derive(Debug, Default)]
pub struct Compiler {
    last: Option<Last>,
    memory: Memory,
    partial: bool,
}

/// What is left of the last time.
#[derive(Debug)]
struct Last {
    source: String,
    options: Options,
    drawing: Arc<Drawing>,
    /// What reading it had to say.
    diagnostics: Vec<Diagnostic>,
    /// Where the links led that reading it followed.
    followed: Vec<Followed>,
}

impl Compiler {
    /// Compiles a drawing. Never fails and never panics.
    ///
    /// It is soonest done where the last [`Compiled`] is no longer held by anyone.
    pub fn compile(
        &mut self,
        source: &str,
        options: &Options,
        resolver: &dyn Resolver,
    ) -> Compiled {
        // A panic loses it, so that nothing half changed is used again.
        let last = self.last.take();
        let mut memory = std::mem::take(&mut self.memory);
        self.partial = false;
        let done = threads::run(move || {
            let again = last.and_then(|last| last.again(source, options, resolver));
            let partial = again.is_some();
            let last = again.unwrap_or_else(|| Last::of(source, options, resolver));
            let compiled = last.reading().compiled(resolver, Some(&mut memory));
            (compiled, last, memory, partial)
        });
        let Some((compiled, last, memory, partial)) = done else {
            return given_up();
        };
        self.last = Some(last);
        self.memory = memory;
        self.partial = partial;
        compiled
    }

    /// Drops all that is remembered. The next time takes as long as the first.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Whether the last drawing was not read anew, for statistics and tests.
    pub fn last_was_partial(&self) -> bool {
        self.partial
    }
}

impl Last {
    /// Reads a drawing.
    fn of(source: &str, options: &Options, resolver: &dyn Resolver) -> Self {
        let (reading, followed) = Reading::of(source, options, resolver);
        Self {
            source: source.to_owned(),
            options: *options,
            drawing: reading.drawing,
            diagnostics: reading.diagnostics,
            followed,
        }
    }

    /// The same with what changed in the characters of one text; `None` where more changed than that.
    fn again(mut self, source: &str, options: &Options, resolver: &dyn Resolver) -> Option<Self> {
        let change = Change::between(&self.source, source);
        let followed = &self.followed;
        let as_before = |(link, found): &Followed| match (resolver.read(link), found) {
            (Ok(now), Ok(before)) => Arc::ptr_eq(&now, before) || now == *before,
            (now, before) => now == *before,
        };
        if self.options != *options || !followed.iter().all(as_before) {
            return None;
        }
        if change.is_empty() {
            return Some(self);
        }
        let retyped = Retyped::find(&self.drawing, &self.source, source, change)?;
        let drawing = Arc::make_mut(&mut self.drawing);
        retyped.apply(drawing);
        if !pictures_stay(drawing) {
            return None;
        }
        for diagnostic in &mut self.diagnostics {
            retyped.apply_to_finding(diagnostic);
        }
        let inserted = &source[change.start..change.new_end];
        self.source
            .replace_range(change.start..change.old_end, inserted);
        Some(self)
    }

    fn reading(&self) -> Reading {
        Reading {
            drawing: Arc::clone(&self.drawing),
            diagnostics: self.diagnostics.clone(),
            links: self.followed.iter().map(|(link, _)| link.clone()).collect(),
        }
    }
}

/// Whether every picture is read as its strings now say: pixel by pixel in tile layers, as a part elsewhere.
fn pictures_stay(drawing: &Drawing) -> bool {
    let known = drawing.as_they_are.as_ref();
    known.is_none_or(|known| *known == bind::in_tile_layers(drawing))
}
