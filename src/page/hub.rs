//! The drawings that pages show, and their updates.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rustc_hash::FxHashMap;
use serde_json::value::{RawValue, to_raw_value};
use tokio::sync::{Semaphore, watch};

use super::delta::delta;
use super::editing::Editing;
use super::exports::Reads;
use super::message::{Build, Listed, PartOrKept, Times, ToPage, findings};
use super::models::{Bytes, StoredModel, TriedModels, originals};
use super::paper::Paper;
use super::starters::Starters;
use super::texts::Texts;
use crate::compile::Compiled;
use crate::export::Written;
use crate::ide::changes::{Action, Change, Done, Refusal, Steps};
use crate::report::{clips, everything};

/// All drawings that pages can show. Each page asks for the updates since its last request, so that a slow page gets only
/// the newest ones, and nothing is queued for a page that does not read.
pub(crate) struct Hub {
    state: Mutex<State>,
    /// Counts the updates.
    clock: watch::Sender<u64>,
    on_pick: Box<OnPick>,
    /// What pages offer while there are no drawings, if they may have some written.
    pub(crate) starters: Option<Starters>,
    /// What lets pages change drawings.
    pub(crate) editing: Option<Editing>,
    /// How drawings are read again for other files than the model, if pages may have those.
    pub(crate) exporting: Option<Box<Reads>>,
    /// Thumbnails are drawn one at a time, so that they do not delay builds.
    pub(crate) drawing_pictures: Semaphore,
    /// So are moving pictures and other files, which take longer.
    pub(crate) drawing_films: Semaphore,
}

impl std::fmt::Debug for Hub {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Hub").finish_non_exhaustive()
    }
}

/// Called with the id of a drawing and what was clicked in it.
type OnPick = dyn Fn(&str, Picked<'_>) + Send + Sync;

/// Something that was clicked on a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Picked<'a> {
    /// A part, by its name.
    Part(&'a str),
    /// A position in the drawing's text. Lines and columns count from 1, columns in characters.
    Position {
        /// The line.
        line: usize,
        /// The column.
        column: usize,
    },
}

#[derive(Default)]
struct State {
    clock: u64,
    /// The time of the last change to the list of drawings.
    listed: u64,
    /// Since when starters are offered; 0 if they are not.
    offered: u64,
    drawings: BTreeMap<String, Entry>,
    /// The number of the last model; numbers are never reused.
    models: u64,
    /// Models of changes that were only tried. They are no drawing's, and are not sent by themselves.
    tried: TriedModels,
}

/// A drawing, with the time of the last change to each of its parts.
#[derive(Default)]
struct Entry {
    name: String,
    folder: String,
    revision: u64,
    build: Option<StoredBuild>,
    gone: Option<u64>,
    light: (u64, Option<String>),
    /// What can be undone and redone.
    steps: (u64, Steps),
    /// The last texts that were built, if pages may change or export the drawing.
    texts: Texts,
    /// The last two models: a page may still be about to fetch the older one.
    models: Vec<Arc<StoredModel>>,
    /// The page of the drawing, with the time of its build.
    paper: Option<(u64, Arc<Paper>)>,
    /// Whether a model of it without errors was shown.
    was_good: bool,
}

/// A build as messages.
struct StoredBuild {
    /// When it was published.
    time: u64,
    revision: u64,
    /// The descriptions of its parts.
    parts: Vec<Box<RawValue>>,
    /// All of it.
    message: Arc<str>,
    /// The time of the build before, and what pages that know that one need.
    changes: Option<(u64, Arc<str>)>,
}

/// How builds are sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Builds {
    /// Each by itself.
    Whole,
    /// Without the parts that are the same as in the build before, where that was sent.
    Changes,
}

/// A build to show.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shown<'a> {
    /// The drawing's text.
    pub text: &'a str,
    /// The compiled drawing.
    pub compiled: &'a Compiled,
    /// The model as binary glTF, and how much that is; `None` keeps the last one. With errors it is what can be built.
    pub model: Option<(&'a Arc<[u8]>, Written)>,
    /// When it was built and published: where there is no clock, who publishes it says so.
    pub times: Times,
}

impl Hub {
    /// A hub without drawings; `on_pick` is called when something is clicked on a page. With `editing`, the ids of drawings are their
    /// paths. Without `exporting`, pages get no other files than models and pictures.
    pub(crate) fn new(
        on_pick: impl Fn(&str, Picked<'_>) + Send + Sync + 'static,
        starters: Option<Starters>,
        editing: Option<Editing>,
        exporting: Option<Box<Reads>>,
    ) -> Arc<Self> {
        Arc::new(Self {
            // Who has got something has a time after 0, even if there is no drawing yet.
            state: Mutex::new(State {
                clock: 1,
                ..State::default()
            }),
            clock: watch::Sender::new(1),
            on_pick: Box::new(on_pick),
            starters,
            editing,
            exporting,
            drawing_pictures: Semaphore::new(1),
            drawing_films: Semaphore::new(1),
        })
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes the state and notifies pages.
    fn change(&self, change: impl FnOnce(&mut State, u64)) {
        let mut state = self.state();
        state.clock += 1;
        let now = state.clock;
        change(&mut state, now);
        drop(state);
        self.clock.send_replace(now);
    }

    /// Shows a build of the drawing `id`, which is listed with its folder and name.
    pub(crate) fn publish(&self, id: &str, [folder, name]: [&str; 2], shown: &Shown<'_>) {
        // Everything that takes long happens before the lock is taken.
        let found = findings(&shown.compiled.diagnostics, shown.text);
        let parts = everything(shown.compiled, shown.text);
        let parts = parts.iter().flat_map(to_raw_value).collect::<Vec<_>>();
        let clips = to_raw_value(&clips(shown.compiled)).unwrap_or_default();
        let originals = shown.model.and_then(|_| originals(shown.compiled));
        let text: Arc<str> = shown.text.into();
        let paper = Paper::new(shown.compiled, &text);
        if let Some(editing) = &self.editing {
            editing.editor.forget(id);
        }
        self.change(|state, now| {
            let number = state.models + 1;
            if !state.drawings.contains_key(id) {
                state.listed = now;
            }
            let entry = state.drawings.entry(id.to_owned()).or_default();
            entry.name = name.to_owned();
            entry.folder = folder.to_owned();
            entry.revision += 1;
            entry.gone = None;
            if self.editing.is_some() || self.exporting.is_some() {
                entry.texts.keep(entry.revision, &text);
            }
            // That of a text which is not XML at the moment stays, as its model does.
            if let Some(paper) = paper {
                entry.paper = Some((now, Arc::new(paper)));
            }
            entry.was_good |= shown.model.is_some() && !shown.compiled.has_errors();
            if let Some((bytes, written)) = shown.model {
                let is_equal = |last: &Arc<StoredModel>| last.is(bytes, originals.as_ref(), &clips);
                let same = entry.models.last().is_some_and(is_equal);
                if !same {
                    state.models = number;
                    let model = StoredModel::new(number, bytes.clone(), originals, clips, written);
                    entry.models.push(Arc::new(model));
                    let old = entry.models.len().saturating_sub(2);
                    entry.models.drain(..old);
                }
            }
            let model = entry.models.last();
            let last = entry.build.take();
            // A text that is not XML at the moment has no parts: the list stays beside the last model.
            let parts = match &last {
                Some(last) if parts.is_empty() && shown.compiled.has_errors() => last.parts.clone(),
                _ => parts,
            };
            let mut build = Build {
                revision: entry.revision,
                milliseconds: shown.times.duration().as_secs_f64() * 1e3,
                model: model.map(|model| format!("builds/{}.glb", model.number)),
                picture: model.map(|model| format!("pictures/{}.png", model.number)),
                paper: entry
                    .paper
                    .as_ref()
                    .map(|(time, _)| format!("papers/{time}.json")),
                stale: shown.model.is_none() && model.is_some(),
                incomplete: shown.model.is_some() && shown.compiled.has_errors(),
                triangles: model.map_or(0, |model| model.written.triangles),
                size: model.and_then(|model| model.written.size),
                findings: found,
                since: None,
                parts: parts.iter().map(|part| PartOrKept::Part(part)).collect(),
                clips: model.map_or(RawValue::NULL, |model| &model.clips),
                originals: model
                    .filter(|model| model.originals.is_some())
                    .map(|model| format!("originals/{}.glb", model.number)),
                exports: model
                    .filter(|_| self.exporting.is_some())
                    .map(|model| format!("exports/{}", model.number)),
                steps: shown.times.into(),
            };
            let message = json(&ToPage::Build {
                drawing: id,
                build: &build,
            });
            let changes = last.map(|last| {
                build.since = Some(last.revision);
                build.parts = changed(&last.parts, &parts);
                (
                    last.time,
                    json(&ToPage::Build {
                        drawing: id,
                        build: &build,
                    }),
                )
            });
            entry.build = Some(StoredBuild {
                time: now,
                revision: entry.revision,
                message,
                changes,
                parts,
            });
        });
    }

    /// Does something to the file of a drawing; `revision` is the build that the page showed. Returns what was done.
    ///
    /// # Errors
    /// If that is not possible; then the file is as it was.
    pub(crate) fn act(&self, id: &str, revision: u64, action: &Action) -> Result<Done, Refusal> {
        let editing = self.editing_of(id)?;
        let shown = self.text_of(id, revision);
        let done = editing.editor.act(id, action, shown.as_deref());
        let steps = editing.editor.steps(id);
        self.change(|state, now| {
            if let Some(entry) = state.drawings.get_mut(id)
                && entry.steps.1 != steps
            {
                entry.steps = (now, steps);
            }
        });
        done
    }

    /// What a change would make of a drawing: the address of the model, and what differs in it from the model of another address.
    ///
    /// # Errors
    /// If the change would be refused.
    pub(crate) fn tried(
        &self,
        id: &str,
        revision: u64,
        change: &Change,
        shows: &str,
    ) -> Result<(String, Bytes), Refusal> {
        let editing = self.editing_of(id)?;
        let shown = self.text_of(id, revision);
        let bytes = editing.editor.tried(id, change, shown.as_deref())?;
        let bytes = Bytes::from(bytes);
        let before = self.numbered(shows);
        let changed = before.and_then(|(number, before)| delta(&before, &bytes, number));
        let sent = changed.map_or_else(|| bytes.clone(), Bytes::from);
        let mut state = self.state();
        state.models += 1;
        let number = state.models;
        state.tried.keep(number, bytes);
        Ok((format!("tries/{number}.glb"), sent))
    }

    /// The text of a build of a drawing; `None` if it is not known any more.
    fn text_of(&self, id: &str, revision: u64) -> Option<Arc<str>> {
        self.state().drawings.get(id)?.texts.of(revision)
    }

    /// The model of an address, also if it was only tried.
    fn numbered(&self, address: &str) -> Option<(u64, Bytes)> {
        let (_, file) = address.split_once('/')?;
        let number = file.strip_suffix(".glb")?.parse().ok()?;
        if let Some(model) = self.model(number) {
            return Some((number, model.bytes.clone()));
        }
        Some((number, self.state().tried.get(number)?))
    }

    /// What changes a drawing that is shown.
    ///
    /// # Errors
    /// If it is not shown, or nothing may be changed.
    pub(crate) fn editing_of(&self, id: &str) -> Result<&Editing, Refusal> {
        let state = self.state();
        let is_shown = state
            .drawings
            .get(id)
            .is_some_and(|entry| entry.gone.is_none());
        let editing = self.editing.as_ref().filter(|_| is_shown);
        editing.ok_or_else(|| {
            Refusal::without_choice("this drawing is not open here, or its file is missing")
        })
    }

    /// Reports that a drawing's file is gone; its last build stays.
    pub(crate) fn gone(&self, id: &str) {
        self.change(|state, now| {
            if let Some(entry) = state.drawings.get_mut(id) {
                entry.gone = Some(now);
            }
        });
    }

    /// Reports that a drawing's file is back, as it was: pages get its last build again, as if it were new.
    pub(crate) fn back(&self, id: &str) {
        self.change(|state, now| {
            if let Some(entry) = state.drawings.get_mut(id) {
                entry.gone = None;
                if let Some(build) = &mut entry.build {
                    build.time = now;
                    build.changes = None;
                }
            }
        });
    }

    /// Removes a drawing.
    pub(crate) fn remove(&self, id: &str) {
        self.change(|state, now| {
            if state.drawings.remove(id).is_some() {
                state.listed = now;
            }
        });
    }

    /// Highlights a part, or none.
    pub(crate) fn light(&self, id: &str, part: Option<&str>) {
        let lit = |state: &State| state.drawings.get(id).map(|entry| entry.light.1.clone());
        if lit(&self.state()).is_none_or(|lit| lit.as_deref() == part) {
            return;
        }
        self.change(|state, now| {
            if let Some(entry) = state.drawings.get_mut(id) {
                entry.light = (now, part.map(str::to_owned));
            }
        });
    }

    /// Whether a model of a drawing without errors was shown.
    pub(crate) fn was_good(&self, id: &str) -> bool {
        let state = self.state();
        let entry = state.drawings.get(id);
        entry.is_some_and(|entry| entry.was_good)
    }

    /// Whether a drawing is shown.
    pub(crate) fn shows(&self, id: &str) -> bool {
        self.state().drawings.contains_key(id)
    }

    /// The model of a number.
    pub(crate) fn model(&self, number: u64) -> Option<Arc<StoredModel>> {
        let state = self.state();
        let models = state.drawings.values().flat_map(|entry| &entry.models);
        models
            .into_iter()
            .find(|model| model.number == number)
            .cloned()
    }

    /// The page of the drawing that was built at a time.
    fn paper(&self, built: u64) -> Option<Arc<Paper>> {
        let state = self.state();
        let mut papers = state.drawings.values().flat_map(|entry| &entry.paper);
        let (_, paper) = papers.find(|(time, _)| *time == built)?;
        Some(paper.clone())
    }

    /// Id, name and last text of the drawing whose last model has a number.
    pub(super) fn drawing_of(&self, number: u64) -> Option<(String, String, Arc<str>)> {
        let state = self.state();
        let is_it = |entry: &Entry| {
            entry
                .models
                .last()
                .is_some_and(|last| last.number == number)
        };
        let (id, entry) = state.drawings.iter().find(|(_, entry)| is_it(entry))?;
        let text = entry.texts.of(entry.revision)?;
        Some((id.clone(), entry.name.clone(), text))
    }

    /// Whether newer models replaced the one of a number.
    pub(crate) fn is_replaced(&self, number: u64) -> bool {
        let given = (1..=self.state().models).contains(&number);
        given && self.model(number).is_none()
    }

    /// The bytes of a model or of a drawing's page, by the address in a message, or what changed since another one (`?since=` and its address).
    pub(crate) fn bytes(&self, address: &str) -> Option<Arc<[u8]>> {
        let (address, since) = match address.split_once("?since=") {
            Some((address, since)) => (address, Some(since)),
            None => (address, None),
        };
        let (kind, file) = address.split_once('/')?;
        if kind == "papers" {
            let paper = self.paper(file.strip_suffix(".json")?.parse().ok()?)?;
            return Some(paper.json().into());
        }
        let by_file = |file: &str| self.model(file.strip_suffix(".glb")?.parse().ok()?);
        let model = by_file(file)?;
        match kind {
            "builds" => Some(match since.and_then(|since| self.numbered(since)) {
                Some(before) => model.since(&before),
                None => model.bytes.clone(),
            }),
            "originals" => model.originals.clone(),
            _ => None,
        }
    }

    /// Changes whenever there are updates.
    pub(crate) fn clock(&self) -> watch::Receiver<u64> {
        self.clock.subscribe()
    }

    /// The updates since a time, of all drawings or only one, as messages, and the current time. Whoever has got all messages
    /// until that time can be sent parts of builds.
    pub(crate) fn updates(
        &self,
        since: u64,
        only: Option<&str>,
        builds: Builds,
    ) -> (Vec<Arc<str>>, u64) {
        let state = self.state();
        let wanted = |id: &&String| only.is_none_or(|only| *id == only);
        let drawings = || state.drawings.iter().filter(|(id, _)| wanted(id));
        let mut updates = vec![];
        if let Some(starters) = &self.starters
            && state.offered > since
        {
            updates.push(json(&starters.message()));
        }
        if let Some(editing) = &self.editing
            && since == 0
        {
            updates.push(json(&ToPage::Editing {
                key: &editing.key,
                copy: editing.editor.changes_copy(),
            }));
        }
        if state.listed > since || since == 0 {
            let listed = drawings().map(|(id, entry)| Listed {
                id,
                name: &entry.name,
                folder: &entry.folder,
            });
            updates.push(json(&ToPage::Drawings {
                drawings: listed.collect(),
            }));
        }
        for (drawing, entry) in drawings() {
            if let Some(build) = &entry.build
                && build.time > since
            {
                updates.push(match (builds, &build.changes) {
                    (Builds::Changes, Some((last, changes))) if *last <= since => changes.clone(),
                    _ => build.message.clone(),
                });
            }
            if entry.gone.is_some_and(|when| when > since) {
                updates.push(json(&ToPage::Gone { drawing }));
            }
            let (when, steps) = &entry.steps;
            if *when > since {
                updates.push(json(&ToPage::Steps {
                    drawing,
                    undo: steps.undo.as_deref(),
                    redo: steps.redo.as_deref(),
                }));
            }
            let (when, part) = &entry.light;
            if *when > since {
                updates.push(json(&ToPage::Light {
                    drawing,
                    part: part.as_deref(),
                }));
            }
        }
        (updates, state.clock)
    }

    /// Handles a click on a page.
    pub(crate) fn picked(&self, drawing: &str, picked: Picked<'_>) {
        if self.shows(drawing) {
            (self.on_pick)(drawing, picked);
        }
    }

    /// Offers drawings to start from, because there are none. Not before that is known: at first no drawing is listed.
    pub(crate) fn offer_starters(&self) {
        self.change(|state, now| state.offered = now);
    }

    /// Begins a drawing that a page offers; an error says why not.
    pub(crate) fn begin(&self, key: &str, starter: &str) -> Result<(), String> {
        let starters = self.starters.as_ref();
        let starters = starters.ok_or("this page offers no drawings to start from")?;
        let state = self.state();
        if state.offered == 0 || !state.drawings.is_empty() {
            return Err("the folder has drawings already".to_owned());
        }
        drop(state);
        starters.begin(key, starter)
    }
}

/// A list of parts in which those of another list are named by their positions there.
fn changed<'a>(before: &[Box<RawValue>], after: &'a [Box<RawValue>]) -> Vec<PartOrKept<'a>> {
    let places = before.iter().enumerate();
    let places: FxHashMap<&str, usize> = places.map(|(at, part)| (part.get(), at)).collect();
    let mut changed = vec![];
    for part in after {
        match (places.get(part.get()), changed.last_mut()) {
            (Some(at), Some(PartOrKept::Kept([first, count]))) if *first + *count == *at => {
                *count += 1;
            }
            (Some(at), _) => changed.push(PartOrKept::Kept([*at, 1])),
            (None, _) => changed.push(PartOrKept::Part(part)),
        }
    }
    changed
}

/// Messages hold only text and numbers, so this cannot fail.
pub(crate) fn json(message: &ToPage<'_>) -> Arc<str> {
    serde_json::to_string(message).unwrap_or_default().into()
}

/// Tells a page that changes go by an editor, which needs no key.
pub(crate) fn editing_in_client() -> Arc<str> {
    json(&ToPage::Editing {
        key: "",
        copy: false,
    })
}
