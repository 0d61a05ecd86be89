//! The motions that strings ask for with `Motion`.

use std::ops::Range;

use super::SetBy;
use crate::bind::bindings::{Bindings, DrawingString, PartId};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::value::{HeldDrawing, Setting, Value};
use crate::source::{Span, Text};

use crate::lang::value::Motion;
pub(crate) use crate::lang::value::{
    Camerawork, MotionSource, MotionTurn, PerformanceEffects, SignedAxis,
};

/// A clip that a string asks for with `Motion`.
#[derive(Debug, Clone)]
pub struct ClipRequest<'a> {
    /// The main part of the string; `None` for a string that applies to all figures.
    pub part: Option<PartId>,
    /// The motions that play in turn; at least one.
    pub turns: Vec<TurnRequest<'a>>,
    /// The name of the clip, if the string gives one.
    pub name: Option<&'a str>,
    /// Whether the figure stays in place.
    pub is_in_place: bool,
    /// Whether it is made a loop.
    pub is_loop: bool,
    /// The `Limited` of this clip.
    pub limits: Option<ClipLimits>,
    /// The `Held` of this clip.
    pub held: Option<HeldRequest>,
    /// The `Perform` of this clip.
    pub performance: Option<PerformanceRequest<'a>>,
    /// The place of the setting.
    pub span: Span,
}

/// One of the motions that play in turn in a clip.
#[derive(Debug, Clone)]
pub struct TurnRequest<'a> {
    /// The motion, and what the string says of it.
    pub motion: &'a MotionTurn,
    /// Where the file or the word is written.
    written: Written<'a>,
}

/// Limited animation, as a string asks for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClipLimits {
    /// How many drawings to omit.
    pub omit: usize,
    /// How many frames to hold.
    pub hold: usize,
    /// The place of the setting.
    pub span: Span,
}

/// Drawings that are chosen by hand, as a string asks for them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HeldRequest {
    /// The drawings in the order of the motion, each with its place.
    pub drawings: Vec<(HeldDrawing, Span)>,
    /// The place of the setting.
    pub span: Span,
}

/// A performed track, as a string asks for it with `Perform`.
#[derive(Debug, Clone)]
pub struct PerformanceRequest<'a> {
    /// The link to the file of the track.
    pub file: &'a str,
    /// Where the file is written.
    written: Written<'a>,
    /// What the performance does to the clip.
    pub effects: PerformanceEffects,
    /// The name of the mark that is emphasised, if the string gives one.
    pub emphasized: Option<&'a str>,
    /// The key frames of the track and of the motion, if the string gives them, counted from 1 at 24 frames a second.
    pub keys: Option<[usize; 2]>,
    /// The place of the setting.
    pub span: Span,
}

/// An argument of a string that names a file.
#[derive(Debug, Clone)]
struct Written<'a> {
    text: &'a Text,
    range: Range<usize>,
}

impl<'a> Written<'a> {
    /// An argument of a setting; all of the setting if there is none.
    fn argument(string: &'a DrawingString, setting: &Setting, index: Option<usize>) -> Self {
        let attribute = string.annotation.attribute_at(&setting.range);
        let argument = attribute.and_then(|attribute| attribute.arguments.get(index?));
        Self {
            text: &string.text,
            range: argument.map_or(setting.range.clone(), |own| own.range.clone()),
        }
    }

    fn span(&self) -> Span {
        self.text.span(self.range.clone())
    }

    /// The name of a file as it is written in the place of this one, in quotes and escaped for XML.
    fn replaced_by(&self, file: &str) -> String {
        let quoted = format!("\"{file}\"");
        self.text.escape_at(self.range.start, &quoted)
    }
}

impl TurnRequest<'_> {
    /// The place of the file or the word; that of the setting if there is none.
    pub fn source_span(&self) -> Span {
        self.written.span()
    }

    /// The name of a file as it is written in the place of this one, in quotes and escaped for XML.
    pub fn written(&self, file: &str) -> String {
        self.written.replaced_by(file)
    }
}

impl<'a> PerformanceRequest<'a> {
    /// The value of a `Perform` in a string.
    fn of(setting: &'a Setting, string: &'a DrawingString) -> Option<Self> {
        match &setting.value {
            Value::Performance(performance) => Some(Self {
                file: &performance.file,
                written: Written::argument(string, setting, Some(0)),
                effects: performance.effects,
                emphasized: performance.emphasized.as_deref(),
                keys: performance.keys,
                span: string.text.span(setting.range.clone()),
            }),
            _ => None,
        }
    }

    /// The place of the file.
    pub fn file_span(&self) -> Span {
        self.written.span()
    }

    /// The name of a file as it is written in the place of this one, in quotes and escaped for XML.
    pub fn written(&self, file: &str) -> String {
        self.written.replaced_by(file)
    }
}

impl HeldRequest {
    /// The value of a `Held` in a string.
    fn of(setting: &Setting, string: &DrawingString) -> Option<Self> {
        let Value::Held(drawings) = &setting.value else {
            return None;
        };
        let attribute = string.annotation.attribute_at(&setting.range);
        let place = |index: usize| {
            let [frame, frames] = attribute?.arguments.get(2 * index..2 * index + 2)? else {
                return None;
            };
            Some(frame.range.start..frames.range.end)
        };
        let placed = drawings.iter().enumerate().map(|(index, drawing)| {
            let range = place(index).unwrap_or_else(|| setting.range.clone());
            (*drawing, string.text.span(range))
        });
        Some(Self {
            drawings: placed.collect(),
            span: string.text.span(setting.range.clone()),
        })
    }
}

impl ClipLimits {
    /// The value of a `Limited`, which the table allows whole numbers only.
    pub(in crate::bind) fn of(limited: &Setting, span: Span) -> Option<Self> {
        match limited.value {
            Value::Pair([omit, hold]) => Some(Self {
                omit: omit as usize,
                hold: hold as usize,
                span,
            }),
            _ => None,
        }
    }
}

fn turns<'a>(
    string: &'a DrawingString,
    setting: &Setting,
    motion: &'a Motion,
) -> Vec<TurnRequest<'a>> {
    let turns = motion.turns.iter().map(|turn| TurnRequest {
        motion: turn,
        written: Written::argument(string, setting, turn.argument),
    });
    turns.collect()
}

impl Bindings {
    /// The clips that strings ask for, in the order of the strings.
    pub fn clip_requests(&self) -> Vec<ClipRequest<'_>> {
        let requests = self.strings.iter().flat_map(|string| {
            let part = match string.annotation {
                Annotation::Defaults(_) => Some(None),
                _ => string
                    .binding
                    .map(|binding| Some(self.parts[binding.part].main)),
            };
            let settings = string.settings.iter();
            settings.filter_map(move |setting| match &setting.value {
                Value::Motion(motion) => Some(ClipRequest {
                    part: part?,
                    turns: turns(string, setting, motion),
                    name: motion.clip.as_deref(),
                    is_in_place: motion.is_in_place,
                    is_loop: motion.is_loop,
                    limits: setting.limited.as_ref().and_then(|limited| {
                        ClipLimits::of(limited, string.text.span(limited.range.clone()))
                    }),
                    held: setting
                        .held
                        .as_ref()
                        .and_then(|held| HeldRequest::of(held, string)),
                    performance: setting
                        .performance
                        .as_ref()
                        .and_then(|performance| PerformanceRequest::of(performance, string)),
                    span: string.text.span(setting.range.clone()),
                }),
                _ => None,
            })
        });
        requests.collect()
    }

    /// The `Limited` that applies to all clips of a part's figure, from the part's own string, the legend of its paint or a `%`
    /// string, and which of these it is.
    pub fn limits_of_clips(&self, part: PartId) -> Option<(SetBy, ClipLimits)> {
        let source = self.setting(part, Keyword::Limited)?;
        let limits = ClipLimits::of(source.setting, self.span_of(&source))?;
        Some((source.from, limits))
    }

    /// The `Held` that applies to all clips of a part's figure, likewise.
    pub fn held_of_clips(&self, part: PartId) -> Option<(SetBy, HeldRequest)> {
        let source = self.setting(part, Keyword::Held)?;
        let held = HeldRequest::of(source.setting, &self.strings[source.string])?;
        Some((source.from, held))
    }

    /// The word of the `Facing` that applies to a part's figure, likewise.
    pub fn facing_of_figure(&self, part: PartId) -> Option<(SetBy, &str)> {
        let source = self.setting(part, Keyword::Facing)?;
        match &source.setting.value {
            Value::Word(word) => Some((source.from, word.as_str())),
            _ => None,
        }
    }

    /// The `Perform` that applies to all clips of a part's figure, likewise.
    pub fn performance_of_clips(&self, part: PartId) -> Option<(SetBy, PerformanceRequest<'_>)> {
        let source = self.setting(part, Keyword::Perform)?;
        let performance = PerformanceRequest::of(source.setting, &self.strings[source.string])?;
        Some((source.from, performance))
    }
}
