//! A hub without a server and without files: drawings in memory, for pages that have the program as a module.
//!
//! There is no clock either: who calls says what time it is, in milliseconds since 1970.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use self::asking::ToAsk;
use super::editing::{Editing, Editor, Refused, ToChange, ToShow, ToTry};
use super::hub::{Builds, Hub, Shown, json as message_json};
use super::message::{FromPage, Times, ToPage};
use super::models::Bytes;
use super::starters::Starters;
use crate::compile::{Compiled, Compiler, Options};
use crate::export::{self, GLB, Model};
use crate::ide::Analysis;
use crate::ide::changes::{Action, Change, Done, Reading, Refusal, Session, Steps};
use crate::memo::Memo;
use crate::resolver::{
    LinkError, MemoryResolver, Resolver, first_spelling, folder_and_name, inside,
};
use crate::starters::Template;

/// The key of a page that nobody else can reach.
const KEY: &str = "";

/// Drawings and the files that they link to, shown on one page.
pub struct Studio {
    hub: Arc<Hub>,
    project: Arc<Mutex<Project>>,
    /// Until when the page has got messages.
    told: u64,
    /// Messages that are not the hub's.
    answers: Vec<Arc<str>>,
}

/// A model of a change that was only tried.
#[derive(Debug)]
pub struct Tried {
    /// By which it is known.
    pub address: String,
    /// What differs from the model that the page shows, or all of it, as binary glTF.
    pub bytes: Arc<[u8]>,
}

/// Everything that was put into a studio.
#[derive(Debug, Default)]
struct Project {
    /// What drawings may link to, by path.
    files: MemoryResolver,
    drawings: BTreeMap<String, Drawing>,
}

/// A drawing of the project.
#[derive(Debug, Default)]
struct Drawing {
    text: Arc<str>,
    /// The text that is shown.
    built: Option<Arc<str>>,
    compiler: Compiler,
    surfaces: Memo,
    /// The links of the text that is shown.
    links: Vec<String>,
    session: Session,
    /// The surfaces of the last model of a change that was only tried.
    tried_surfaces: Memo,
}

/// The files of a project, for a drawing in one of its folders.
struct FromFolder<'a> {
    /// With its slash; empty for the project's own folder.
    folder: &'a str,
    files: &'a MemoryResolver,
}

impl FromFolder<'_> {
    /// All files that the drawing can link to, as it names them.
    fn all(&self) -> Vec<String> {
        let below = self.files.paths();
        let below = below.filter_map(|path| path.strip_prefix(self.folder));
        below.map(str::to_owned).collect()
    }
}

impl Resolver for FromFolder<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        // Spelled once: what is decoded twice could lead out of the folder.
        first_spelling(link, inside, |path| {
            self.files.file(&format!("{}{path}", self.folder))
        })
    }

    fn siblings(&self, link: &str) -> Vec<String> {
        let found = self.files.siblings(&format!("{}{link}", self.folder));
        let below = found
            .iter()
            .filter_map(|path| path.strip_prefix(self.folder));
        below.map(str::to_owned).collect()
    }
}

fn locked(project: &Mutex<Project>) -> MutexGuard<'_, Project> {
    project.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Changes the drawings of a project.
#[derive(Debug)]
struct ProjectEditor(Arc<Mutex<Project>>);

impl ProjectEditor {
    /// Does something with a drawing and how that is read.
    fn with<R>(
        &self,
        id: &str,
        work: impl FnOnce(&mut Drawing, Reading<'_>, &MemoryResolver) -> Result<R, Refusal>,
    ) -> Result<R, Refusal> {
        let mut project = locked(&self.0);
        let Project { files, drawings } = &mut *project;
        let drawing = drawings.get_mut(id);
        let drawing = drawing.ok_or_else(|| {
            Refusal::without_choice("this drawing is not open any more: open it again")
        })?;
        let resolver = FromFolder {
            folder: folder_and_name(id).0,
            files,
        };
        let reading = Reading {
            options: Options::default(),
            resolver: &resolver,
        };
        work(drawing, reading, files)
    }
}

impl Editor for ProjectEditor {
    fn act(&self, id: &str, action: &Action, shown: Option<&str>) -> Result<Done, Refusal> {
        self.with(id, |drawing, reading, _| {
            let session = &mut drawing.session;
            let before = session.current(&drawing.text, reading)?;
            let pending = session.pending(&before, action, shown, reading)?;
            drawing.text = pending.text.clone();
            Ok(session.done(action, pending))
        })
    }

    fn tried(&self, id: &str, change: &Change, shown: Option<&str>) -> Result<Vec<u8>, Refusal> {
        self.with(id, |drawing, reading, _| {
            let session = &mut drawing.session;
            let before = session.current(&drawing.text, reading)?;
            let tried = session.tried(&before, change, shown, reading)?;
            let scene = &tried.compiled().scene;
            let model = export::to_memory(&GLB, scene, Some(&mut drawing.tried_surfaces));
            let model = model.map_err(|error| Refusal::without_choice(error.to_string()))?;
            Ok(model.bytes)
        })
    }

    fn analysis(&self, id: &str) -> Result<Arc<Analysis>, Refusal> {
        self.with(id, |drawing, reading, _| {
            drawing.session.current(&drawing.text, reading)
        })
    }

    fn steps(&self, id: &str) -> Steps {
        let steps = self.with(id, |drawing, _, _| Ok(drawing.session.steps()));
        steps.unwrap_or_default()
    }

    /// Nothing changes behind the back of a studio: what is forgotten it says itself.
    fn forget(&self, _id: &str) {}

    fn changes_copy(&self) -> bool {
        false
    }

    fn motion_files(&self, id: &str) -> Vec<String> {
        let files = self.with(id, |_, reading, _| Ok(reading.resolver.siblings("any.bvh")));
        let files = files.unwrap_or_default().into_iter();
        files.filter(|name| !name.contains('"')).collect()
    }
}

impl Default for Studio {
    fn default() -> Self {
        let project = Arc::new(Mutex::default());
        let begun = Arc::clone(&project);
        let starters = Starters::new(KEY.to_owned(), move |template: Template| {
            let path = format!("{}.svg", template.name());
            let drawing = Drawing {
                text: template.drawing().into(),
                ..Drawing::default()
            };
            locked(&begun).drawings.insert(path, drawing);
            Ok(())
        });
        let editing = Editing::new(KEY.to_owned(), ProjectEditor(Arc::clone(&project)));
        Self {
            hub: Hub::new(|_, _| (), Some(starters), Some(editing), None),
            project,
            told: 0,
            answers: Vec::new(),
        }
    }
}

impl fmt::Debug for Studio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Studio").finish_non_exhaustive()
    }
}

impl Studio {
    /// Puts a file into the project, or replaces it, by its path from the project's folder. One that ends in `.svg` is a drawing, which
    /// is shown; those that link to another file are built again.
    ///
    /// # Errors
    /// If a drawing is not text.
    pub fn put(&mut self, path: &str, bytes: Vec<u8>, now: f64) -> Result<(), String> {
        let mut project = locked(&self.project);
        if is_drawing(path) {
            let text = String::from_utf8(bytes)
                .map_err(|_| "the drawing is not text in UTF-8: save it as plain SVG".to_owned())?;
            let drawing = project.drawings.entry(path.to_owned()).or_default();
            drawing.text = text.into();
        } else {
            let files = std::mem::take(&mut project.files);
            project.files = files.with(path, bytes);
            project.outdate(path);
        }
        drop(project);
        self.build(now);
        Ok(())
    }

    /// Takes a file out of the project.
    pub fn remove(&mut self, path: &str, now: f64) {
        let mut project = locked(&self.project);
        if project.drawings.remove(path).is_some() {
            self.hub.remove(path);
        } else {
            let files = std::mem::take(&mut project.files);
            project.files = files.without(path);
            project.outdate(path);
        }
        drop(project);
        self.build(now);
    }

    /// The text of a drawing, with the changes that were made on the page; `None` if there is no such drawing.
    pub fn text(&self, path: &str) -> Option<Arc<str>> {
        let project = locked(&self.project);
        Some(project.drawings.get(path)?.text.clone())
    }

    /// The links of a drawing as it is shown, to files that may be there or not; none if there is no such drawing.
    pub fn links(&self, path: &str) -> Vec<String> {
        let project = locked(&self.project);
        let drawing = project.drawings.get(path);
        drawing.map_or(vec![], |drawing| drawing.links.clone())
    }

    /// Offers drawings to start from, as long as there are none.
    pub fn offer(&self) {
        self.hub.offer_starters();
    }

    /// Handles a message of the page, which is JSON.
    pub fn receive(&mut self, message: &str, now: f64) {
        if let Ok(FromPage::Begin { key, starter }) = serde_json::from_str(message) {
            match self.hub.begin(&key, &starter) {
                Ok(()) => self.build(now),
                Err(why) => self
                    .answers
                    .push(message_json(&ToPage::NotBegun { why: &why })),
            }
        }
    }

    /// The messages for the page since the last call, as JSON.
    pub fn messages(&mut self) -> Vec<Arc<str>> {
        let (mut messages, now) = self.hub.updates(self.told, None, Builds::Changes);
        self.told = now;
        messages.append(&mut self.answers);
        messages
    }

    /// The bytes behind an address in a message: a model, or a picture of one.
    pub fn bytes(&self, address: &str) -> Option<Arc<[u8]>> {
        let (kind, file) = address.split_once('/')?;
        let picture = || file.strip_suffix(".png");
        match kind {
            "pictures" => self.hub.model(picture()?.parse().ok()?)?.picture(),
            "starters" => self.hub.starters.as_ref()?.picture(picture()?),
            _ => self.hub.bytes(address),
        }
    }

    /// Makes a change that a page asks for, undoes or redoes one. Request and answer are JSON, the answer with whether it was done.
    pub fn change(&mut self, request: &str, now: f64) -> String {
        let answer = answer(request, |asked: ToChange| self.hub.change_as_asked(asked));
        self.build(now);
        answer
    }

    /// What can be changed about a part. Request and answer are JSON, the answer with whether there is one.
    pub fn form(&self, request: &str) -> String {
        answer(request, |asked: ToShow| self.hub.form_as_asked(&asked))
    }

    /// A model of what a change would make of a drawing, while it is being decided; `None` if the change would be refused.
    pub fn attempt(&self, request: &str) -> Option<Tried> {
        let asked: ToTry = serde_json::from_str(request).ok()?;
        let (address, bytes) = self.hub.tried_as_asked(&asked).ok()?;
        Some(Tried { address, bytes })
    }

    /// What is known of the texts of a drawing as it is now. Request and answer are JSON, the answer with whether there is one.
    pub fn ask(&self, request: &str) -> String {
        answer(request, |asked: ToAsk| {
            let editor = ProjectEditor(Arc::clone(&self.project));
            editor.with(&asked.drawing, |drawing, reading, files| {
                let analysis = drawing.session.current(&drawing.text, reading)?;
                asking::answered(&asked, &analysis, files)
            })
        })
    }

    /// Builds and shows what has changed.
    fn build(&self, now: f64) {
        let now = SystemTime::UNIX_EPOCH + Duration::from_secs_f64(now.max(0.0) / 1e3);
        let mut project = locked(&self.project);
        let Project { files, drawings } = &mut *project;
        let outdated = drawings
            .iter_mut()
            .filter(|(_, drawing)| drawing.built.as_ref() != Some(&drawing.text));
        for (path, drawing) in outdated {
            let (folder, name) = folder_and_name(path);
            let (compiled, model) = drawing.compiled(&FromFolder { folder, files });
            let model: Option<(Bytes, _)> = model.map(|model| (model.bytes.into(), model.written));
            let shown = Shown {
                text: &drawing.text,
                compiled: &compiled,
                model: model.as_ref().map(|(bytes, written)| (bytes, *written)),
                times: Times {
                    noticed: now,
                    started: now,
                    finished: now,
                    pushed: now,
                },
            };
            let listed = folder.trim_end_matches('/');
            self.hub.publish(path, [listed, name], &shown);
            drawing.links = compiled.dependencies;
            drawing.built = Some(drawing.text.clone());
        }
    }
}

impl Project {
    /// A file that drawings may link to has changed.
    fn outdate(&mut self, path: &str) {
        for (drawing, outdated) in &mut self.drawings {
            if path.starts_with(folder_and_name(drawing).0) {
                outdated.built = None;
                outdated.session.forget();
            }
        }
    }
}

impl Drawing {
    /// The drawing and its model, with errors what can be built of it.
    fn compiled(&mut self, resolver: &dyn Resolver) -> (Compiled, Option<Model>) {
        let compiled = self
            .compiler
            .compile(&self.text, &Options::default(), resolver);
        if compiled.has_errors() && compiled.scene.nodes.is_empty() {
            return (compiled, None);
        }
        match export::to_memory(&GLB, &compiled.scene, Some(&mut self.surfaces)) {
            Ok(model) => (compiled, Some(model)),
            Err(_) if compiled.has_errors() => (compiled, None),
            Err(error) => (Compiled::unwritten(&error), None),
        }
    }
}

/// Whether a file is a drawing, by its name.
fn is_drawing(path: &str) -> bool {
    let ending = path.rsplit_once('.').map(|(_, ending)| ending);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
}

/// The answer to a request, both as JSON.
fn answer<Q: DeserializeOwned, A: Serialize>(
    request: &str,
    work: impl FnOnce(Q) -> Result<A, Refusal>,
) -> String {
    let refused = |refusal: Refusal| serde_json::to_value(Refused::from(refusal));
    let (ok, body) = match serde_json::from_str(request) {
        Ok(asked) => match work(asked) {
            Ok(answer) => (true, serde_json::to_value(answer)),
            Err(refusal) => (false, refused(refusal)),
        },
        Err(error) => (
            false,
            refused(Refusal::without_choice(format!(
                "the change cannot be read: {error}"
            ))),
        ),
    };
    json!({ "ok": ok, "body": body.unwrap_or(Value::Null) }).to_string()
}

mod asking;
#[cfg(test)]
mod tests;
