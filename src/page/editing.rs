//! What pages ask about changes of the drawings that they show, and what is answered.

use std::fmt::Debug;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::hub::Hub;
use super::models::Bytes;
use crate::ide::Analysis;
use crate::ide::changes::{Action, Change, Choice, Done, Refusal, Steps};

/// Keeps the texts of drawings, and changes them. Drawings have the ids that they are published by.
pub(crate) trait Editor: Debug + Send + Sync {
    /// Does something to a drawing; `shown` is the text for which that was decided, `None` if it is not known any more.
    ///
    /// # Errors
    /// If that is not possible; then the drawing is as it was.
    fn act(&self, id: &str, action: &Action, shown: Option<&str>) -> Result<Done, Refusal>;

    /// What a change would make of a drawing, as binary glTF.
    ///
    /// # Errors
    /// If the change would be refused.
    fn tried(&self, id: &str, change: &Change, shown: Option<&str>) -> Result<Vec<u8>, Refusal>;

    /// A drawing as it is now.
    ///
    /// # Errors
    /// If it cannot be read at the moment.
    fn analysis(&self, id: &str) -> Result<Arc<Analysis>, Refusal>;

    /// What can be undone and redone in a drawing.
    fn steps(&self, id: &str) -> Steps;

    /// A drawing was built again: a file that it links to may have changed.
    fn forget(&self, id: &str);

    /// Whether copies of drawings are changed that are open in another program.
    fn changes_copy(&self) -> bool;

    /// The motion files in a drawing's folder, sorted, as the drawing names them.
    fn motion_files(&self, id: &str) -> Vec<String>;
}

/// What lets pages change drawings. Without it they only show them.
#[derive(Debug)]
pub(crate) struct Editing {
    /// Only who has read the messages of this hub knows it.
    pub(crate) key: String,
    pub(crate) editor: Box<dyn Editor>,
}

impl Editing {
    /// Changes are made by this editor, for pages that name the key.
    pub(crate) fn new(key: String, editor: impl Editor + 'static) -> Self {
        Self {
            key,
            editor: Box::new(editor),
        }
    }
}

/// A request to change a drawing.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToChange {
    drawing: String,
    /// The build that the page showed.
    revision: u64,
    #[serde(rename = "do")]
    action: ToDo,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ToDo {
    Make(Change),
    /// What was offered when the last change was refused.
    Choose(Change),
    Undo,
    Redo,
}

/// A request for what a change would make of a drawing.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToTry {
    drawing: String,
    revision: u64,
    change: Change,
    /// The address of the model that the page shows.
    shows: String,
}

/// A request for what can be changed about a part.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToShow {
    drawing: String,
    part: String,
}

/// Why something was not done, and what could be done instead.
#[derive(Debug, Serialize)]
pub(crate) struct Refused {
    why: String,
    choices: Vec<Choice>,
}

impl From<Refusal> for Refused {
    fn from(Refusal { why, choices }: Refusal) -> Self {
        Self { why, choices }
    }
}

impl Hub {
    /// Makes a change, undoes or redoes one.
    ///
    /// # Errors
    /// If it is refused.
    pub(crate) fn change_as_asked(&self, asked: ToChange) -> Result<Value, Refusal> {
        let action = match asked.action {
            ToDo::Make(change) => Action::Make(change),
            ToDo::Choose(change) => Action::Choose(change),
            ToDo::Undo => Action::Undo,
            ToDo::Redo => Action::Redo,
        };
        let Done { part, note } = self.act(&asked.drawing, asked.revision, &action)?;
        Ok(json!({ "part": part, "note": note }))
    }

    /// What a change would make of a drawing, while it is being decided: the address of the model as binary glTF, and what differs from
    /// the model that the page shows.
    ///
    /// # Errors
    /// If the change would be refused: there is nothing to show of it, and why is said once it is made.
    pub(crate) fn tried_as_asked(&self, asked: &ToTry) -> Result<(String, Bytes), Refusal> {
        self.tried(&asked.drawing, asked.revision, &asked.change, &asked.shows)
    }

    /// What can be changed about a part.
    ///
    /// # Errors
    /// If the drawing cannot be read, or has no such part.
    pub(crate) fn form_as_asked(&self, asked: &ToShow) -> Result<impl Serialize + use<>, Refusal> {
        let editing = self.editing_of(&asked.drawing)?;
        let form = editing.editor.analysis(&asked.drawing)?.form(&asked.part)?;
        Ok(form.with_motion_files(editing.editor.motion_files(&asked.drawing)))
    }
}
