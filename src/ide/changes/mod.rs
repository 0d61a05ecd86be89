//! Changes of a drawing that speak of its parts, and the edits of its text that make them.
//!
//! This is the only place that decides how a value gets into a string. A [`Change`] is made with [`edits`], which rewrites as few
//! characters as it can, or is refused with a sentence and what could be done instead. [`check`] compares the drawing before and
//! after: a change must do what it says, and nothing else.

mod check;
mod clips;
mod drawn;
mod elements;
mod form;
mod given;
mod history;
mod open_groups;
mod place;
mod poses;
mod same;
mod session;
mod settings;
mod strings;
mod taken;
#[cfg(test)]
mod tests;
mod unnamed;
mod written;

pub use check::check;
use check::no_worse;
pub use drawn::{NewShape, Stacking};
pub(crate) use form::PartForm;
pub use history::{History, Step, rebased};
pub use poses::{Moment, PartTurn};
pub(crate) use session::{Action, Done, Reading, Session, Steps};
pub(crate) use unnamed::Suggestion;

pub(super) use given::{as_description, string_for};

use std::sync::Arc;

use clips::ClipWords;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Analysis, Subject, Which};
use crate::bind::{PartId, PartKind};
use crate::diagnostic::{Edit, applied};
use crate::lang::keyword::Keyword;

/// So much of a text is in the title of what was written.
const MOST_LETTERS: usize = 40;

/// A change of a drawing. Parts are called as in `inspect`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "change", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Change {
    /// A part gets an attribute.
    Set {
        /// The part.
        part: String,
        /// The attribute.
        #[serde(serialize_with = "write_keyword", deserialize_with = "read_keyword")]
        attribute: Keyword,
        /// Its flags and arguments, as in a string: `-c roundv -60 60`.
        value: String,
        /// Where it is written.
        #[serde(default)]
        place: Place,
    },
    /// The string of a part no longer says an attribute.
    Reset {
        /// The part.
        part: String,
        /// The attribute.
        #[serde(serialize_with = "write_keyword", deserialize_with = "read_keyword")]
        attribute: Keyword,
        /// Only [`Place::Own`] makes a change that others may not like.
        #[serde(default)]
        place: Place,
    },
    /// A part, or a shape without a name, is called otherwise, wherever it is mentioned.
    Name {
        /// The part.
        part: String,
        /// Its new name.
        name: String,
    },
    /// A part hangs on another one.
    Hang {
        /// The part.
        part: String,
        /// What it hangs on; `None` for nothing.
        parent: Option<String>,
    },
    /// A part is no longer built.
    LeaveOut {
        /// The part.
        part: String,
    },
    /// Every part that nobody has named gets a name, as far as shapes tell what they are.
    NameParts,
    /// A clip of a figure becomes another one, is added, or is taken away.
    Clip {
        /// A part of the figure.
        part: String,
        /// Its number among the figure's clips, in the order of the strings; the next number is that of a new one.
        clip: usize,
        /// The flags and arguments of its `Motion`; `None` takes it away, with all that is said of it.
        motion: Option<String>,
        /// The arguments of its own `Limited`, if it has one.
        #[serde(default)]
        limited: Option<String>,
        /// The arguments of its own `Held`, likewise.
        #[serde(default)]
        held: Option<String>,
        /// [`Place::Own`] also changes it for the other figures that play it.
        #[serde(default)]
        place: Place,
    },
    /// The pose of a figure becomes its next key pose, in a layer of its own behind everything else.
    KeepPose {
        /// The parts that are turned. All others of their figures are as they are drawn.
        turns: Vec<PartTurn>,
    },
    /// A recorded movement becomes key poses after the last one, in layers of their own behind everything else.
    KeepMovement {
        /// What was recorded, in order of time.
        moments: Vec<Moment>,
    },
    /// A shape is drawn in front of all others in the layer of the front-most part.
    Draw {
        /// The shape.
        shape: NewShape,
        /// Its colour, `#rrggbb`.
        fill: String,
    },
    /// What a part is drawn as is moved, with the strings beside it.
    Move {
        /// The part.
        part: String,
        /// How far, user units to the right and down.
        by: [f64; 2],
    },
    /// What a part is drawn as is drawn later or earlier than others in its layer or group.
    Restack {
        /// The part.
        part: String,
        /// Where it goes.
        to: Stacking,
    },
    /// What a part is drawn as is deleted, with the strings beside it.
    Erase {
        /// The part.
        part: String,
    },
    /// The shape of a part is drawn in another colour.
    Paint {
        /// The part.
        part: String,
        /// The colour, `#rrggbb`.
        fill: String,
    },
    /// A variable of the drawing gets a number.
    Variable {
        /// Its name.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A text is written otherwise. Whoever types it may make mistakes: it is made also if the drawing has more errors then.
    Write {
        /// Where it begins in the drawing, in bytes.
        start: usize,
        /// What it was.
        was: String,
        /// What it becomes: one line.
        text: String,
        /// What is written with the same number is undone at once.
        typing: u64,
    },
    /// Something that an editor offers is done: a fix, or another way to write a string.
    Apply {
        /// Where the text begins at which it was offered, in bytes.
        start: usize,
        /// The text.
        was: String,
        /// Where in it, in bytes.
        at: usize,
        /// What it is called.
        title: String,
    },
}

/// Where an attribute is written, if that can be chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// Where it belongs. A change that is about more than the part, or would lose a calculation, is refused with the choices.
    #[default]
    Ask,
    /// In the part's own string, in place of whatever stands there.
    Own,
    /// In the legend of its paint, for all parts that are painted like it.
    Legend,
}

/// Why a change is not made.
#[derive(Debug, Clone, PartialEq, Serialize, thiserror::Error)]
#[error("{why}")]
pub struct Refusal {
    /// A sentence without a full stop.
    pub why: String,
    /// What can be done instead.
    pub choices: Vec<Choice>,
}

/// A change that can be made instead of one that is refused.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// What it does, as an imperative.
    pub title: String,
    /// The change.
    pub change: Change,
}

impl Change {
    /// The part that it is about; `None` if it is about none, or about all.
    pub fn part(&self) -> Option<&str> {
        match self {
            Self::Set { part, .. }
            | Self::Reset { part, .. }
            | Self::Name { part, .. }
            | Self::Hang { part, .. }
            | Self::LeaveOut { part }
            | Self::Clip { part, .. }
            | Self::Move { part, .. }
            | Self::Restack { part, .. }
            | Self::Erase { part }
            | Self::Paint { part, .. } => Some(part),
            Self::NameParts
            | Self::KeepPose { .. }
            | Self::KeepMovement { .. }
            | Self::Draw { .. }
            | Self::Variable { .. }
            | Self::Write { .. }
            | Self::Apply { .. } => None,
        }
    }

    /// Whether it is about what is drawn, instead of what strings say of it.
    fn is_drawn(&self) -> bool {
        matches!(
            self,
            Self::Draw { .. }
                | Self::Move { .. }
                | Self::Restack { .. }
                | Self::Erase { .. }
                | Self::Paint { .. }
        )
    }

    /// What it changes, for a list of steps: `Shape of Arm`.
    pub fn title(&self) -> String {
        match self {
            Self::Set {
                part, attribute, ..
            }
            | Self::Reset {
                part, attribute, ..
            } => format!("{} of {part}", attribute.name()),
            Self::Name { name, .. } => format!("the name {name}"),
            Self::Hang { part, .. } => format!("the parent of {part}"),
            Self::LeaveOut { part } => format!("leaving out {part}"),
            Self::NameParts => "the names of the parts".to_owned(),
            Self::Clip { motion: None, .. } => "taking a clip away".to_owned(),
            Self::Clip {
                motion: Some(motion),
                ..
            } => format!("Motion {motion}").trim_end().to_owned(),
            Self::KeepPose { .. } => "a key pose".to_owned(),
            Self::KeepMovement { .. } => "a recorded movement".to_owned(),
            Self::Draw { .. } => "a new shape".to_owned(),
            Self::Move { part, .. } => format!("the place of {part}"),
            Self::Restack { part, .. } => format!("the order of {part}"),
            Self::Erase { part } => format!("deleting {part}"),
            Self::Paint { part, .. } => format!("the paint of {part}"),
            Self::Variable { name, .. } => format!("the number {name}"),
            Self::Write { text, .. } => format!("the string {}", shortened(text)),
            Self::Apply { title, .. } => title.clone(),
        }
    }
}

impl Refusal {
    /// A refusal without anything that could be done instead.
    pub fn without_choice(why: impl Into<String>) -> Self {
        Self::new(why)
    }

    fn new(why: impl Into<String>) -> Self {
        Self {
            why: why.into(),
            choices: vec![],
        }
    }

    fn or(mut self, title: impl Into<String>, change: Change) -> Self {
        let title = title.into();
        self.choices.push(Choice { title, change });
        self
    }
}

/// The edits of the text that make a change, in order; none if everything is so already.
///
/// # Errors
/// If the change cannot be made, or it has to be decided how.
pub fn edits(analysis: &Analysis, change: &Change) -> Result<Vec<Edit>, Refusal> {
    readable(analysis)?;
    let mut edits = match change {
        Change::Set {
            part,
            attribute,
            value,
            place,
        } => analysis.set(part, *attribute, value, *place)?,
        Change::Reset {
            part,
            attribute,
            place,
        } => analysis.reset(part, *attribute, *place)?,
        Change::Name { part, name } => analysis.call(part, name)?,
        Change::Hang { part, parent } => analysis.hang(part, parent.as_deref())?,
        Change::LeaveOut { part } => analysis.leave_out(part)?,
        Change::NameParts => analysis.named_parts()?.0,
        Change::Clip {
            part,
            clip,
            motion,
            limited,
            held,
            place,
        } => {
            let wanted = motion.as_deref().map(|motion| ClipWords {
                motion,
                limited: limited.as_deref(),
                held: held.as_deref(),
            });
            analysis.set_clip(part, *clip, wanted, *place)?
        }
        Change::KeepPose { turns } => analysis.keep_pose(turns)?,
        Change::KeepMovement { moments } => analysis.keep_movement(moments)?,
        Change::Draw { shape, fill } => analysis.draw(shape, fill)?,
        Change::Move { part, by } => analysis.shift(part, *by)?,
        Change::Restack { part, to } => analysis.restack(part, *to)?,
        Change::Erase { part } => analysis.erase(part)?,
        Change::Paint { part, fill } => analysis.paint(part, fill)?,
        Change::Variable { name, value } => analysis.set_variable(name, *value)?,
        Change::Write {
            start, was, text, ..
        } => analysis.write_text(*start, was, text)?,
        Change::Apply {
            start,
            was,
            at,
            title,
        } => analysis.apply(*start, was, *at, title)?,
    };
    edits.sort_by_key(|edit| edit.span);
    edits.dedup();
    edits.retain(|edit| analysis.source[edit.span.start..edit.span.end] != edit.text);
    Ok(edits)
}

/// What a change makes of a drawing.
#[derive(Debug)]
pub(crate) struct Possible {
    pub(crate) edits: Vec<Edit>,
    /// The drawing with them; `None` if everything is so already.
    pub(crate) after: Option<Arc<Analysis>>,
    /// The part that it is about, by the name that it has then.
    pub(crate) part: Option<String>,
    /// What else it does, as a sentence without a full stop.
    pub(crate) note: Option<String>,
}

/// Finds what a change makes of a drawing; `read` compiles the new text.
///
/// # Errors
/// If it is refused.
pub(crate) fn possible(
    before: &Analysis,
    change: &Change,
    read: impl FnOnce(&str) -> Arc<Analysis>,
) -> Result<Possible, Refusal> {
    let edits = edits(before, change)?;
    let text = applied(before.source(), &edits);
    if text == **before.source() {
        return Ok(Possible {
            part: part_after(before, before, change, &edits),
            edits,
            after: None,
            note: None,
        });
    }
    let after = read(&text);
    let note = check(before, &after, change)?;
    Ok(Possible {
        part: part_after(before, &after, change, &edits),
        edits,
        after: Some(after),
        note,
    })
}

/// The part of a change that was made by some edits, by its name after it.
pub fn part_after(
    before: &Analysis,
    after: &Analysis,
    change: &Change,
    edits: &[Edit],
) -> Option<String> {
    match change {
        change if change.is_drawn() => drawn::part_after(before, after, change, edits),
        Change::Name { name, .. } => crate::lang::quoting::read_name(name),
        change => change.part().map(str::to_owned),
    }
}

/// Refuses to change a drawing that cannot be read.
fn readable(analysis: &Analysis) -> Result<(), Refusal> {
    if analysis.is_sound() {
        return Ok(());
    }
    Err(Refusal::new(
        "the drawing cannot be read as it is: correct its errors first",
    ))
}

/// The attributes that a change can set. The others decide what a string is about, or belong to the clips around them.
pub fn can_set(keyword: Keyword) -> bool {
    let is_of_layers = matches!(
        keyword,
        Keyword::Tiles
            | Keyword::Bevel
            | Keyword::Roof
            | Keyword::Height
            | Keyword::View
            | Keyword::Backing
            | Keyword::Mirror
            | Keyword::Match
            | Keyword::Hidden
            | Keyword::Depth
            | Keyword::Walk
            | Keyword::Pose
    );
    let is_of_clips = matches!(
        keyword,
        Keyword::Motion | Keyword::Limited | Keyword::Held | Keyword::Perform
    );
    let in_part = crate::lang::keyword::AttributeString::Part;
    keyword.row().allowed.permits(in_part)
        && Keyword::built().any(|built| built == keyword)
        && !is_of_layers
        && !is_of_clips
}

impl Analysis {
    /// The part of a name that a change can be about.
    fn part_to_change(&self, name: &str) -> Result<PartId, Refusal> {
        let bindings = self.bindings();
        let named = Subject::all(&self.compiled).filter(|subject| subject.name() == name);
        let mut other = None;
        let mut parts = vec![];
        for subject in named {
            match subject.which {
                Which::Part(part) => parts.push(part),
                _ => other = Some(subject.kind()),
            }
        }
        let mains = parts.iter().copied();
        let mut mains = mains.filter(|part| bindings.parts[*part].kind == PartKind::Main);
        match (mains.next(), mains.next(), parts.as_slice(), other) {
            (Some(part), None, ..) => Ok(part),
            (None, _, [part], _) => Ok(*part),
            (None, _, [], None) => Err(Refusal::new(format!("there is no part `{name}`"))),
            (None, _, [], Some(kind)) => Err(Refusal::new(format!(
                "`{name}` is a {kind}, which is changed in the drawing"
            ))),
            _ => Err(Refusal::new(format!(
                "several parts are called `{name}`: give them different names in the drawing first"
            ))),
        }
    }

    /// The same, of a part that is a node of the figure.
    fn node_to_change(&self, name: &str) -> Result<PartId, Refusal> {
        let part = self.part_to_change(name)?;
        let found = &self.bindings().parts[part];
        match found.kind {
            PartKind::Main => Ok(part),
            PartKind::Sub => Err(Refusal::new(format!(
                "`{name}` belongs to `{}`, and has no place of its own in the figure",
                self.bindings().parts[found.main].name
            ))),
            kind => Err(Refusal::new(format!(
                "`{name}` is {}, and has no place in the figure",
                described(kind)
            ))),
        }
    }

    /// Whether another shape is made from the same element: then a description of it would be theirs, too.
    fn is_copied(&self, part: PartId) -> bool {
        let shapes = &self.drawing().shapes;
        let span = shapes[self.bindings().parts[part].shape].element.span;
        let alike = shapes
            .iter()
            .filter(|other| other.element.span == span && span.start < span.end);
        alike.count() != 1
    }
}

/// The beginning of a text, for a title.
fn shortened(text: &str) -> String {
    let mut letters = text.chars();
    let mut short: String = letters.by_ref().take(MOST_LETTERS).collect();
    if letters.next().is_some() {
        short.push('…');
    }
    short
}

/// A kind of part for people.
fn described(kind: PartKind) -> &'static str {
    match kind {
        PartKind::Main => "a part",
        PartKind::Sub => "a piece of a part",
        PartKind::Legend => "the sample of a legend",
        PartKind::Unused => "left out",
        PartKind::Tile => "drawn in a landscape",
        PartKind::Prop => "a prop on a map",
        PartKind::Region => "a region of a character",
    }
}

fn write_keyword<S: Serializer>(keyword: &Keyword, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(keyword.name())
}

fn read_keyword<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Keyword, D::Error> {
    let name = String::deserialize(deserializer)?;
    Keyword::from_name(&name)
        .ok_or_else(|| serde::de::Error::custom(format!("there is no attribute `{name}`")))
}
