//! One drawing that a person changes bit by bit: what a change would make of its text, and what can be undone.
//!
//! Whoever keeps the text (a file that other programs write too, a page in a browser) asks for the [`Pending`] state, stores its text,
//! and confirms that with [`Session::done`].

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Change, History, Possible, Refusal, Step, no_worse, part_after, possible};
use crate::compile::{Compiler, Options};
use crate::diagnostic::{Edit, applied};
use crate::ide::Analysis;
use crate::resolver::Resolver;

/// How many of the last changes are known by their texts: a page may make one after the other before it has seen a build.
const MAX_KNOWN: usize = 16;
/// How many bytes these texts may have together.
const MAX_KNOWN_BYTES: usize = 32 << 20;

/// What is to be done to a drawing.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Action {
    /// A change is made.
    Make(Change),
    /// A change is made that was offered when the last one was refused.
    Choose(Change),
    /// The last change is undone.
    Undo,
    /// What was undone last is made again.
    Redo,
}

/// What was done to a drawing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Done {
    /// The part that it was about, by the name that it has now.
    pub part: Option<String>,
    /// What else has changed, as a sentence without a full stop.
    pub note: Option<String>,
}

/// What can be undone and redone, in words.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Steps {
    /// The change that would be undone.
    pub undo: Option<String>,
    /// The change that would be made again.
    pub redo: Option<String>,
}

/// What an action makes of a drawing, which is not stored yet.
#[derive(Debug)]
pub(crate) struct Pending {
    /// The text that it makes.
    pub(crate) text: Arc<str>,
    before: Arc<str>,
    edits: Vec<Edit>,
    /// The drawing with this text; `None` if nothing changes.
    after: Option<Arc<Analysis>>,
    /// The part that it is about, by the name that it has then.
    part: Option<String>,
    note: Option<String>,
}

/// A drawing that is changed.
#[derive(Debug, Default)]
pub(crate) struct Session {
    history: History,
    compiler: Compiler,
    /// The last state that was compiled.
    last: Option<Arc<Analysis>>,
    /// The last state that was only tried: mostly it is then made.
    tried: Option<Arc<Analysis>>,
    /// The texts before and after the last changes.
    made: VecDeque<[Arc<str>; 2]>,
    /// The text in which a change was refused last.
    refused: Option<Arc<str>>,
}

/// How a drawing is compiled.
#[derive(Clone, Copy)]
pub(crate) struct Reading<'a> {
    pub(crate) options: Options,
    pub(crate) resolver: &'a dyn Resolver,
}

impl Session {
    /// Forgets what was compiled: a file that the drawing links to may have changed.
    pub(crate) fn forget(&mut self) {
        self.last = None;
        self.tried = None;
    }

    /// Whether this is the text that was compiled last, or that the last change made.
    pub(crate) fn knows(&self, text: &str) -> bool {
        let is_own = self.made.back().is_some_and(|[_, after]| **after == *text);
        let last = self.last.as_ref();
        is_own || last.is_some_and(|last| **last.source() == *text)
    }

    /// What can be undone and redone.
    pub(crate) fn steps(&self) -> Steps {
        let title = |step: &Step| step.change.title();
        Steps {
            undo: self.history.last().map(title),
            redo: self.history.next().map(title),
        }
    }

    /// The drawing with this text.
    pub(crate) fn compiled(&mut self, text: &str, reading: Reading<'_>) -> Arc<Analysis> {
        let mut known = [&self.last, &self.tried].into_iter().flatten();
        if let Some(known) = known.find(|known| **known.source() == *text) {
            return known.clone();
        }
        let Reading { options, resolver } = reading;
        let compiled = self.compiler.compile(text, &options, resolver);
        Arc::new(Analysis::new(text, compiled))
    }

    /// The drawing as it is now.
    ///
    /// # Errors
    /// If it is no drawing at the moment.
    pub(crate) fn current(
        &mut self,
        text: &str,
        reading: Reading<'_>,
    ) -> Result<Arc<Analysis>, Refusal> {
        let analysis = self.compiled(text, reading);
        if !analysis.is_sound() {
            return Err(Refusal::without_choice(
                "the drawing cannot be read as it is, or is being written: correct its errors first",
            ));
        }
        self.last = Some(analysis.clone());
        Ok(analysis)
    }

    /// What an action makes of the drawing as it is now. `shown` is the text for which the action was decided; `None` if that is not known any more.
    ///
    /// # Errors
    /// If the action is refused, or the drawing has changed so that it would mean something else.
    pub(crate) fn pending(
        &mut self,
        before: &Arc<Analysis>,
        action: &Action,
        shown: Option<&str>,
        reading: Reading<'_>,
    ) -> Result<Pending, Refusal> {
        let Possible {
            edits,
            after,
            part,
            note,
        } = match action {
            Action::Make(change) | Action::Choose(change) => {
                // Who chooses has been told what is in that text, also if no build of it is shown yet.
                let refused = self.refused.take();
                let told = refused
                    .as_deref()
                    .filter(|_| matches!(action, Action::Choose(_)));
                let wanted = self.wanted(before, change, told.or(shown), reading);
                self.refused = wanted.is_err().then(|| before.source().clone());
                wanted?
            }
            Action::Undo | Action::Redo => self.stepped(before, action, reading)?,
        };
        let before = before.source().clone();
        Ok(Pending {
            text: applied(&before, &edits).into(),
            before,
            edits,
            after,
            part,
            note,
        })
    }

    /// The pending state is the drawing's now.
    pub(crate) fn done(&mut self, action: &Action, pending: Pending) -> Done {
        let Pending {
            text,
            before,
            edits,
            after,
            part,
            note,
        } = pending;
        let history = &mut self.history;
        match action {
            Action::Make(_) | Action::Choose(_) if text == before => {}
            Action::Make(change) if goes_on(history, change, &before) => {
                history.go_on(change.clone(), &text);
            }
            Action::Make(change) | Action::Choose(change) => {
                history.add(Step::new(change.clone(), &before, &edits))
            }
            Action::Undo => history.undo(&before, &edits),
            Action::Redo => history.redo(&before, &edits),
        }
        if after.is_some() {
            self.last = after;
        }
        if text != before {
            self.know([before, text]);
        }
        Done { part, note }
    }

    /// What a change would make of a drawing. That stays as it is, and nothing is to be undone.
    ///
    /// # Errors
    /// If the change would be refused, or nothing changes: the drawing is what there is to see.
    pub(crate) fn tried(
        &mut self,
        before: &Arc<Analysis>,
        change: &Change,
        shown: Option<&str>,
        reading: Reading<'_>,
    ) -> Result<Arc<Analysis>, Refusal> {
        let wanted = self.wanted(before, change, shown, reading)?;
        let tried = wanted.after.ok_or_else(|| {
            Refusal::without_choice("the drawing says so already: nothing is changed by it")
        })?;
        self.tried = Some(tried.clone());
        Ok(tried)
    }

    /// What a change makes that a person wants.
    fn wanted(
        &mut self,
        before: &Analysis,
        change: &Change,
        shown: Option<&str>,
        reading: Reading<'_>,
    ) -> Result<Possible, Refusal> {
        let shown = shown.ok_or_else(|| {
            Refusal::without_choice(
                "the drawing has changed too often since: look at it again, and try once more",
            )
        })?;
        // What was changed here meanwhile did not come from elsewhere.
        let shown = self.since(shown);
        if *shown != **before.source() {
            let shown = self.compiled(&shown, reading);
            before.still_means(&shown, change)?;
        }
        possible(before, change, |text| self.compiled(text, reading))
    }

    /// What undoes or redoes a step. A step that does not fit any more is forgotten, so that those before it can be undone.
    fn stepped(
        &mut self,
        before: &Analysis,
        action: &Action,
        reading: Reading<'_>,
    ) -> Result<Possible, Refusal> {
        let is_undo = *action == Action::Undo;
        let step = match is_undo {
            true => self.history.last(),
            false => self.history.next(),
        };
        let step = step.ok_or_else(|| {
            Refusal::without_choice(match is_undo {
                true => "there is nothing to undo",
                false => "there is nothing to redo",
            })
        })?;
        let (change, title) = (step.change.clone(), step.change.title());
        let text = before.source();
        let found = step.undone(text).ok_or_else(|| {
            format!("what was changed is not there any more, because another program saved the drawing: {title} stays as it is")
        });
        let is_typed = matches!(change, Change::Write { .. } | Change::Apply { .. });
        let found = found.and_then(|edits| {
            let after = self.compiled(&applied(text, &edits), reading);
            // What was typed is undone and made again with its mistakes.
            if !is_typed {
                let worse = no_worse(before, &after);
                worse.map_err(|refusal| refusal.why)?;
            }
            let part = match is_undo {
                true => change.part().map(str::to_owned),
                false => part_after(before, &after, &change, &edits),
            };
            Ok(Possible {
                edits,
                after: Some(after),
                part,
                note: None,
            })
        });
        found.map_err(|why| {
            match is_undo {
                true => self.history.forget_last(),
                false => self.history.forget_next(),
            }
            Refusal::without_choice(why)
        })
    }

    /// Keeps the texts before and after a change.
    fn know(&mut self, texts: [Arc<str>; 2]) {
        self.made.push_back(texts);
        let bytes = |made: &VecDeque<[Arc<str>; 2]>| -> usize {
            made.iter().map(|[_, after]| after.len()).sum()
        };
        while self.made.len() > MAX_KNOWN
            || self.made.len() > 1 && bytes(&self.made) > MAX_KNOWN_BYTES
        {
            self.made.pop_front();
        }
    }

    /// The text that changes made here have led to from this one.
    fn since(&self, shown: &str) -> Arc<str> {
        let mut text: Arc<str> = shown.into();
        for [before, after] in &self.made {
            if *before == text {
                text = after.clone();
            }
        }
        text
    }
}

/// Whether a change goes on with what the last step began, in the text that it made.
fn goes_on(history: &History, change: &Change, before: &str) -> bool {
    let Some(last) = history.last() else {
        return false;
    };
    let typing = |change: &Change| match change {
        Change::Write { start, typing, .. } => Some((*start, *typing)),
        _ => None,
    };
    typing(change).is_some() && typing(change) == typing(&last.change) && **last.after() == *before
}
