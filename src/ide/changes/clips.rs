//! The clips of figures: what can be changed about them, and how they are written.

use serde::Serialize;

use super::form::{ArgumentField, Field, Said, Switch, switches};
use super::settings::{joined, without};
use super::strings::{Means, Piece};
use super::{Analysis, Change, Place, Refusal};
use crate::bind::{MotionSource, PartId, PartKind, StringHolder, StringId};
use crate::diagnostic::Edit;
use crate::lang::ast::{Annotation, Attribute};
use crate::lang::keyword::signature::{Bounds, Takes};
use crate::lang::keyword::{Keyword, vocabulary};
use crate::lang::quoting::{NamePlace, quoted_if_needed};
use crate::lang::value::{Motion, Setting, Value};
use crate::rig::{FigureGroup, find_figures};
use crate::source::Span;

/// The clips of a figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionForm {
    /// The name of the part that carries the figure.
    pub figure: String,
    /// One line of the manual.
    pub summary: &'static str,
    /// The words for clips that come along, each with a line about it.
    pub choices: Vec<[&'static str; 2]>,
    /// The motion files that a clip can play, as the drawing names them.
    pub files: Vec<String>,
    /// Its clips, in the order of the strings.
    pub clips: Vec<ClipForm>,
    /// One that is not there yet.
    pub new: ClipForm,
}

/// What can be changed about a clip.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClipForm {
    /// What the string says behind `Motion`; `None` for a clip that is not there yet.
    pub words: Option<String>,
    /// The same without its flags.
    pub arguments: String,
    /// The word of a clip that comes along; empty for the one that fits. `None` for a file, and for clips that play in turn.
    pub word: Option<String>,
    /// The file that it plays; `None` for all others.
    pub file: Option<String>,
    /// The axis of the file that points up, as it is written.
    pub up: Option<String>,
    /// Its name, as it is written.
    pub name: Option<String>,
    /// `own` if a string of the figure says it, `default` for a string for all figures.
    pub from: &'static str,
    /// The string that says it.
    pub string: Option<String>,
    /// The letters that may follow `-`.
    pub flags: Vec<Switch>,
    /// How long it plays.
    pub seconds: ArgumentField,
    /// Where in the file it begins.
    pub start: ArgumentField,
    /// Where in the file it ends.
    pub end: ArgumentField,
    /// How fast it plays.
    pub speed: ArgumentField,
    /// Its limited animation.
    pub limited: Field,
    /// The drawings that are chosen by hand.
    pub held: Field,
    /// The clip in the model; `None` if the figure does not play it.
    pub plays: Option<PlayedClip>,
}

/// A clip in the model.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PlayedClip {
    /// Its name, which clips of other figures may have too.
    pub name: String,
    /// The part that it moves as the figure's root. The motion decides: the hips may be another part than the one that carries the figure.
    pub root: String,
}

/// What a change says of a clip: the words behind its `Motion`, its `Limited` and its `Held`.
#[derive(Clone, Copy)]
pub(super) struct ClipWords<'a> {
    pub motion: &'a str,
    pub limited: Option<&'a str>,
    pub held: Option<&'a str>,
}

impl<'a> ClipWords<'a> {
    /// What belongs to the `Motion`, in the order in which it is written.
    fn belonging(self) -> [(Keyword, Option<&'a str>); 2] {
        [(Keyword::Limited, self.limited), (Keyword::Held, self.held)]
    }
}

/// A `Motion` in a string.
#[derive(Clone, Copy)]
struct Written<'a> {
    string: StringId,
    setting: &'a Setting,
    motion: &'a Motion,
    /// Its number among the attributes of the string.
    at: usize,
}

impl Analysis {
    /// The figure that a part belongs to.
    fn figure_with(&self, part: PartId) -> Option<FigureGroup> {
        let found = &self.bindings().parts[part];
        let main = match found.kind {
            PartKind::Main => part,
            PartKind::Sub => found.main,
            _ => return None,
        };
        let mut figures = find_figures(self.bindings()).into_iter();
        figures.find(|figure| figure.parts.contains(&main))
    }

    /// The motions that strings ask for of a figure, in their order.
    fn motions(&self, figure: &FigureGroup) -> Vec<Written<'_>> {
        let bindings = self.bindings();
        let strings = bindings.strings.iter_enumerated();
        let addressing = strings.filter(|(_, string)| {
            matches!(string.annotation, Annotation::Defaults(_))
                || string.binding.is_some_and(|binding| {
                    figure.parts.contains(&bindings.parts[binding.part].main)
                })
        });
        let motions = addressing.flat_map(|(index, string)| {
            let settings = string.settings.iter();
            settings.filter_map(move |setting| {
                let Value::Motion(motion) = &setting.value else {
                    return None;
                };
                let attributes = string.annotation.attributes();
                Some(Written {
                    string: index,
                    setting,
                    motion,
                    at: attributes
                        .iter()
                        .position(|one| one.range == setting.range)?,
                })
            })
        });
        motions.collect()
    }

    /// The words of an attribute behind its keyword, as they are written, with its flags or without.
    fn words_of(&self, string: StringId, attribute: &Attribute, with_flags: bool) -> String {
        let start = match attribute.flags.last() {
            Some((_, last)) if !with_flags => last.end,
            _ => attribute.keyword_range.end,
        };
        let text = self.bindings().strings[string].text.as_str();
        let words = text.get(start..attribute.range.end).unwrap_or_default();
        words.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// What strings say of the clips of a part's figure.
    pub(super) fn clips_said(&self, part: PartId) -> Vec<String> {
        let figure = self.figure_with(part);
        let motions = figure.iter().flat_map(|figure| self.motions(figure));
        motions.map(|written| said(written.setting)).collect()
    }

    /// Whether at most one clip of all figures differs from those of another text of the drawing: one that is `wanted` came, or one
    /// that was there went.
    pub(super) fn has_all_other_clips(&self, before: &Self, wanted: bool) -> bool {
        let all = |analysis: &Self| -> Vec<String> {
            let strings = analysis.bindings().strings.iter();
            let settings = strings.flat_map(|string| &string.settings);
            let motions = settings.filter(|setting| setting.keyword == Keyword::Motion);
            motions.map(said).collect()
        };
        let (mut gone, mut came) = (all(before), vec![]);
        for clip in all(self) {
            match gone.iter().position(|old| *old == clip) {
                Some(at) => {
                    gone.remove(at);
                }
                None => came.push(clip),
            }
        }
        gone.len() <= 1 && came.len() <= usize::from(wanted)
    }

    /// What can be changed about the clips of a part's figure.
    pub(super) fn motion_form(&self, part: PartId) -> Option<MotionForm> {
        let figure = self.figure_with(part)?;
        let motions = self.motions(&figure);
        Some(MotionForm {
            figure: self.bindings().parts[figure.root].name.clone(),
            summary: Keyword::Motion.row().summary,
            choices: vocabulary::CLIPS
                .iter()
                .map(|word| [word.name, word.summary])
                .collect(),
            files: vec![],
            clips: motions
                .iter()
                .map(|written| self.clip_form(&figure, Some(written)))
                .collect(),
            new: self.clip_form(&figure, None),
        })
    }

    fn clip_form(&self, figure: &FigureGroup, written: Option<&Written<'_>>) -> ClipForm {
        let root = figure.root;
        let strings = &self.bindings().strings;
        let attribute = written.map(|written| {
            let attributes = strings[written.string].annotation.attributes();
            (written.string, &attributes[written.at])
        });
        let motion = written.map(|written| written.motion);
        let only = motion.and_then(|motion| match motion.turns.as_slice() {
            [turn] => Some(turn),
            _ => None,
        });
        let word = only.and_then(|turn| match &turn.source {
            MotionSource::BuiltIn(word) => Some(word.clone()),
            MotionSource::Fitting => Some(String::new()),
            MotionSource::File(_) => None,
        });
        let file = only.and_then(|turn| match &turn.source {
            MotionSource::File(file) => Some(file.clone()),
            MotionSource::BuiltIn(_) | MotionSource::Fitting => None,
        });
        let up = only.and_then(|turn| turn.up).map(|up| {
            let sign = if up.negative { '-' } else { '+' };
            format!("{sign}{}", ["x", "y", "z"][up.axis])
        });
        let speed = only.map(|turn| turn.speed).filter(|speed| *speed != 1.0);
        let seconds = only.and_then(|turn| turn.seconds);
        let requested = written.map(|written| {
            strings[written.string]
                .text
                .span(written.setting.range.clone())
        });
        let mut clips = self.compiled.clips.iter();
        let played = clips
            .find(|clip| Some(clip.requested_at) == requested && figure.parts.contains(&clip.root));
        let said = |keyword| self.field(root, keyword, self.said_of_clip(root, written, keyword));
        ClipForm {
            words: attribute.map(|(string, attribute)| self.words_of(string, attribute, true)),
            arguments: attribute.map_or_else(String::new, |(string, attribute)| {
                self.words_of(string, attribute, false)
            }),
            word,
            file,
            up,
            name: motion
                .and_then(|motion| motion.clip.as_deref())
                .map(|name| quoted_if_needed(name, NamePlace::Argument)),
            from: attribute.map_or("builtin", |(string, _)| self.teller(string)),
            string: attribute.map(|(string, _)| strings[string].text.as_str().trim().to_owned()),
            flags: switches(
                Keyword::Motion.row(),
                attribute.map(|(_, attribute)| attribute),
            ),
            seconds: self.number(root, "seconds", seconds, None),
            start: self.number(root, "start", only.and_then(|turn| turn.from), None),
            end: self.number(root, "end", only.and_then(|turn| turn.to), None),
            speed: self.number(root, "factor", speed, Some(1.0)),
            limited: said(Keyword::Limited),
            held: said(Keyword::Held),
            plays: played.map(|clip| PlayedClip {
                name: clip.name.clone(),
                root: self.bindings().parts[clip.root].name.clone(),
            }),
        }
    }

    /// Whether a string speaks of a figure or of all.
    fn teller(&self, string: StringId) -> &'static str {
        match self.bindings().strings[string].annotation {
            Annotation::Defaults(_) => "default",
            _ => "own",
        }
    }

    /// The `Limited` or `Held` of a clip, also if it applies to all of them.
    fn said_of_clip(
        &self,
        root: PartId,
        written: Option<&Written<'_>>,
        keyword: Keyword,
    ) -> Option<Said> {
        let own = written.and_then(|written| {
            let own = match keyword {
                Keyword::Held => &written.setting.held,
                _ => &written.setting.limited,
            };
            Some((written.string, own.as_ref()?))
        });
        if let Some((string, own)) = own {
            return Some(Said {
                value: own.text.clone(),
                from: "own",
                string: Some(string),
            });
        }
        let resolved = self.bindings().resolved(self.drawing(), root);
        let found = resolved.into_iter().find(|one| one.keyword == keyword)?;
        Some(Said {
            value: found.value,
            // It is of all clips, and cannot be taken away from one.
            from: "default",
            string: found.string,
        })
    }

    /// A number that is said of a clip.
    fn number(
        &self,
        root: PartId,
        name: &'static str,
        value: Option<f64>,
        start: Option<f64>,
    ) -> ArgumentField {
        let (summary, bounds) = parameter(name).unwrap_or(("", Bounds::POSITIVE));
        ArgumentField {
            name,
            summary,
            takes: self.slider(root, bounds, start, value),
            value: value.map(|value| value.to_string()),
        }
    }

    /// Writes a clip of a part's figure: its `Motion` and what belongs to it; with `None`, takes it away.
    pub(super) fn set_clip(
        &self,
        name: &str,
        clip: usize,
        wanted: Option<ClipWords<'_>>,
        place: Place,
    ) -> Result<Vec<Edit>, Refusal> {
        let part = self.part_to_change(name)?;
        let Some(figure) = self.figure_with(part) else {
            return Err(Refusal::new(format!(
                "`{name}` is in no figure, so it plays no clip"
            )));
        };
        let change = |place| Change::Clip {
            part: name.to_owned(),
            clip,
            motion: wanted.map(|words| words.motion.to_owned()),
            limited: wanted.and_then(|words| words.limited.map(str::to_owned)),
            held: wanted.and_then(|words| words.held.map(str::to_owned)),
            place,
        };
        let motions = self.motions(&figure);
        let Some(written) = motions.get(clip) else {
            return match wanted {
                Some(words) if clip == motions.len() => self.add_clip(figure.root, words),
                Some(_) => Err(Refusal::new(format!(
                    "the figure of `{name}` has no clip of this number any more"
                ))),
                None => Ok(vec![]),
            };
        };
        if place == Place::Ask {
            self.ask_about_others(written, &change)?;
        }
        let string = &self.bindings().strings[written.string];
        let attributes = string.annotation.attributes();
        let attribute = &attributes[written.at];
        let belonging = self.belonging(written);
        let Some(words) = wanted else {
            let goes = |at: usize| at == written.at || belonging.contains(&at);
            if let Some(label) = self.label_of_only(written, &goes) {
                return Ok(vec![Edit {
                    span: label,
                    text: String::new(),
                }]);
            }
            return self.rewritten(
                written.string,
                &without(&string.annotation, goes),
                Means::Clips,
            );
        };
        let text = string.text.as_str();
        let wanted = self.wanted(Keyword::Motion, words.motion)?;
        let mut pieces = self.changed(text, attribute, &wanted, place, &change)?;
        // Where what is not there yet is written: behind what is written before it.
        let mut end = attribute.range.end;
        for (keyword, said) in words.belonging() {
            let is_own = |at: usize| belonging.contains(&at) && attributes[at].keyword == keyword;
            let last = belonging.iter().copied().rfind(|at| is_own(*at));
            match (last, said) {
                (None, None) => {}
                (None, Some(said)) => {
                    let words = self.wanted(keyword, said)?.words;
                    pieces.push((end..end, format!(" {} {words}", keyword.name())));
                }
                (Some(at), Some(said)) => {
                    let wanted = self.wanted(keyword, said)?;
                    pieces.extend(self.changed(text, &attributes[at], &wanted, place, &change)?);
                }
                (Some(_), None) => {
                    pieces.extend::<Vec<Piece>>(without(&string.annotation, is_own));
                }
            }
            end = last.map_or(end, |at| attributes[at].range.end);
        }
        pieces.sort_by_key(|(range, _)| range.start);
        self.rewritten(written.string, &joined(pieces), Means::Clips)
    }

    /// Adds a clip to the string of the part that carries a figure.
    fn add_clip(&self, root: PartId, said: ClipWords<'_>) -> Result<Vec<Edit>, Refusal> {
        let mut words = self.wanted(Keyword::Motion, said.motion)?.words;
        for (keyword, said) in said.belonging() {
            if let Some(said) = said {
                let own = self.wanted(keyword, said)?.words;
                words += &format!(" {} {own}", keyword.name());
            }
        }
        match self.bindings().parts[root].string {
            Some(string) => {
                let piece = self.appended(string, Keyword::Motion, words.trim())?;
                self.rewritten(string, &[piece], Means::Clips)
            }
            None => self.given(root, format!("Motion {words}").trim_end()),
        }
    }

    /// Refuses to change what other figures play without a word.
    fn ask_about_others(
        &self,
        written: &Written<'_>,
        change: &dyn Fn(Place) -> Change,
    ) -> Result<(), Refusal> {
        let string = &self.bindings().strings[written.string];
        let span = string.text.span(written.setting.range.clone());
        let clips = self.compiled.clips.iter();
        let figures = clips.filter(|clip| clip.requested_at == span).count();
        if figures < 2 {
            return Ok(());
        }
        Err(Refusal::new(format!(
            "`{}` is for all {figures} figures of the drawing",
            string.text.as_str().trim()
        ))
        .or(format!("Change it for all {figures}"), change(Place::Own)))
    }

    /// The numbers of the attributes that belong to a clip: those behind its `Motion`, up to the next.
    fn belonging(&self, written: &Written<'_>) -> Vec<usize> {
        let attributes = self.bindings().strings[written.string]
            .annotation
            .attributes();
        let behind = attributes.iter().enumerate().skip(written.at + 1);
        let own = behind.take_while(|(_, one)| one.keyword != Keyword::Motion);
        let own = own.filter(|(_, one)| one.keyword.belongs_to_motion());
        own.map(|(at, _)| at).collect()
    }

    /// The text on the page that would say nothing any more without some attributes.
    fn label_of_only(&self, written: &Written<'_>, goes: &dyn Fn(usize) -> bool) -> Option<Span> {
        let string = &self.bindings().strings[written.string];
        let Annotation::Defaults(attributes) = &string.annotation else {
            return None;
        };
        let StringHolder::Label(label) = string.holder else {
            return None;
        };
        let element = self.drawing().labels[label].0.element;
        let labels = self.drawing().labels.iter();
        let is_copied = labels.filter(|(other, _)| other.element == element).count() != 1;
        let holds_more = self.bindings().strings.iter().any(|other| {
            !std::ptr::eq(other, string) && {
                let at = other.text.whole().start;
                (element.start..element.end).contains(&at)
            }
        });
        ((0..attributes.len()).all(goes)
            && !is_copied
            && !holds_more
            && element.start < element.end)
            .then_some(element)
    }
}

/// What a number of the clips that come along means, and what it may be.
fn parameter(name: &str) -> Option<(&'static str, Bounds)> {
    let forms = Keyword::Motion.row().forms.iter();
    let mut all = forms.flat_map(|form| form.options);
    all.find_map(|parameter| match parameter.takes {
        Takes::Number(bounds) if parameter.name == name => Some((parameter.summary, bounds)),
        _ => None,
    })
}

/// All that a `Motion` says.
fn said(setting: &Setting) -> String {
    let text = |setting: &Option<Box<Setting>>| setting.as_ref().map(|one| one.text.clone());
    let [limited, held, performed] =
        [&setting.limited, &setting.held, &setting.performance].map(text);
    format!("{} {limited:?} {held:?} {performed:?}", setting.text)
}
