//! Finds and parses the strings of a drawing, and computes their variables.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::bare_names;
use super::layers::LayerKind;
use super::settings::{DrawingSettings, Strokes};
use crate::bind::bindings::{StringHolder, StringId};
use crate::diagnostic::{Code, Diagnostic, Edit, Fix, few_or_one, listed};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::value::Setting;
use crate::lang::{self, variables::Variables};
use crate::source::{Span, Text};
use crate::svg::{Drawing, GroupKind, Label, ShapeId};
use crate::threads::GRAIN;

/// What the texts and descriptions of a drawing are taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::bind) enum Texts {
    /// Strings, if one of them looks like one.
    Strings,
    /// Lettering, which is nothing of ours.
    Lettering,
}

/// The strings of a drawing, and what its `%` strings set.
#[derive(Debug, Default)]
pub(super) struct Strings {
    /// Whether the drawing is annotated at all.
    pub(super) annotated: bool,
    /// Whether no string says `Shape`.
    pub(super) is_first_look: bool,
    /// In the order of the file.
    pub(super) all: TiVec<StringId, ReadString>,
    /// The settings of all `%` strings, each with its string; for each keyword the last one.
    pub(super) defaults: Vec<(StringId, Setting)>,
    pub(super) variables: Variables,
    pub(super) settings: DrawingSettings,
}

/// A string before it is bound.
#[derive(Debug)]
pub(super) struct ReadString {
    pub(super) holder: StringHolder,
    pub(super) text: Arc<Text>,
    pub(super) annotation: Annotation,
    pub(super) settings: Vec<Setting>,
    /// Whether it is about what a picture in a view shows, unless it is grouped with a shape.
    pub(super) is_of_picture: bool,
}

impl ReadString {
    /// Whether the string says something about a place in the drawing, to which a leader may lead from it.
    pub(super) fn means_a_place(&self) -> bool {
        self.wants_part() || matches!(self.annotation, Annotation::Feature(_))
    }

    /// Whether the string belongs to a part, rather than to a group or to the whole drawing.
    pub(super) fn wants_part(&self) -> bool {
        wants_part(&self.annotation)
    }

    /// Whether it says neither which part it is about nor what this hangs on, as the description of a part may.
    pub(super) fn says_attributes_alone(&self) -> bool {
        matches!(
            &self.annotation,
            Annotation::Part(part) if part.name.is_none() && part.parent.is_none()
        )
    }
}

/// Whether a string belongs to a part, rather than to a group or to the whole drawing.
pub(in crate::bind) fn wants_part(annotation: &Annotation) -> bool {
    match annotation {
        Annotation::Unused => true,
        Annotation::Legend(_) => LayerKind::of(annotation).is_none(),
        Annotation::Part(part) => {
            let mut attributes = part.attributes.iter();
            // A string with `Walk` belongs to a line, the path.
            LayerKind::of(annotation).is_none()
                && !attributes.any(|attribute| attribute.keyword == Keyword::Walk)
        }
        _ => false,
    }
}

/// Whether a text on the page belongs to a part: then a person names the parts by texts, and what has none is looked at in another
/// way. A description is about its own element, and tells nothing of others.
pub(super) fn texts_mean_parts(strings: &TiSlice<StringId, ReadString>) -> bool {
    let is_text = |string: &ReadString| matches!(string.holder, StringHolder::Label(_));
    strings
        .iter()
        .any(|string| is_text(string) && string.wants_part())
}

/// Per shape, whether its own description says which part it is: its name, or what it hangs on.
pub(super) fn described(
    drawing: &Drawing,
    strings: &TiSlice<StringId, ReadString>,
) -> TiVec<ShapeId, bool> {
    let mut described = ti_vec![false; drawing.shapes.len()];
    for string in strings.iter().filter(|string| string.wants_part()) {
        if let StringHolder::Shape(shape) = string.holder {
            described[shape] |= !string.says_attributes_alone();
        }
    }
    described
}

/// Whether a string is about the whole drawing: it says nothing about what other texts and descriptions are.
fn is_about_all(text: &str) -> bool {
    text.trim_start().starts_with(['%', '％'])
}

/// Finds and parses the strings.
pub(super) fn read(drawing: &Drawing, texts: Texts, diagnostics: &mut Vec<Diagnostic>) -> Strings {
    if texts == Texts::Lettering {
        return Strings {
            is_first_look: true,
            ..Strings::default()
        };
    }
    let mut signed = drawing
        .labels
        .iter()
        .map(|(label, _)| label.text.as_str())
        .filter(|text| lang::annotates(text));
    let is_signed = signed.clone().next().is_some();
    let mut texts = descriptions(drawing, signed.any(|text| !is_about_all(text)));
    let annotated = is_signed || !texts.is_empty() || bare_names::name_parts(drawing);
    if !annotated {
        return Strings {
            is_first_look: true,
            ..Strings::default()
        };
    }
    texts.extend(
        drawing
            .labels
            .iter()
            .enumerate()
            .map(|(index, (label, _))| (StringHolder::Label(index), Arc::clone(&label.text))),
    );
    texts.sort_by_key(|(_, text)| text.whole());
    let parsed: Vec<_> = texts
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(|(holder, text)| {
            let kind = if matches!(holder, StringHolder::Label(_)) {
                lang::Container::Text
            } else {
                lang::Container::Desc
            };
            let pieces = lang::strings_in(text.as_str());
            let (annotation, mut findings) = match pieces.as_slice() {
                [first, _, ..] => lang::parse(&text.truncated(first.end), kind),
                _ => lang::parse(&text, kind),
            };
            if pieces.len() > 1 {
                findings.push(several(drawing, holder, &text, &pieces));
            }
            (holder, text, annotation, findings)
        })
        .collect();
    let mut captions = Vec::new();
    let mut annotations = Vec::with_capacity(parsed.len());
    for (holder, text, annotation, findings) in parsed {
        diagnostics.extend(findings);
        if annotation == Annotation::Caption {
            captions.push(Arc::clone(&text));
        }
        annotations.push((holder, text, annotation));
    }
    let words = || {
        listed(
            captions
                .iter()
                .map(|text| format!("`{}`", shortened(text.as_str()))),
        )
    };
    few_or_one(
        captions.iter().map(|text| caption(text)).collect(),
        |count| {
            let words = words();
            format!("{count} texts are not strings; they are taken for captions: {words}")
        },
        diagnostics,
    );
    let variables = Variables::collect(
        annotations
            .iter()
            .filter(|(_, _, annotation)| matches!(annotation, Annotation::Defaults(_)))
            .map(|(_, text, annotation)| (&**text, annotation)),
        diagnostics,
    );
    let (all, findings): (Vec<ReadString>, Vec<Vec<Diagnostic>>) = annotations
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(|(holder, text, annotation)| {
            let mut findings = Vec::new();
            let settings = lang::settings(&text, &annotation, &variables, &mut findings);
            let string = ReadString {
                holder,
                text,
                annotation,
                settings,
                is_of_picture: false,
            };
            (string, findings)
        })
        .unzip();
    diagnostics.extend(findings.into_iter().flatten());
    let all = TiVec::from(all);
    let defaults = merged_defaults(&all, diagnostics);
    // A shape that is not understood yet is one all the same: a figure should not change as a whole while one types.
    let says_shape = |string: &ReadString| {
        let mut attributes = string.annotation.attributes().iter();
        attributes.any(|attribute| attribute.keyword == Keyword::Shape)
    };
    let is_first_look = !all.iter().any(says_shape);
    let strokes = match (is_first_look, texts_mean_parts(&all)) {
        (false, _) => Strokes::Ink,
        (true, true) => Strokes::Visible,
        (true, false) => Strokes::All,
    };
    Strings {
        annotated,
        settings: DrawingSettings::read(drawing, &defaults, strokes),
        is_first_look,
        all,
        defaults,
        variables,
    }
}

/// Descriptions of shapes and groups that are strings, and those that are the name of their part alone.
///
/// Office programs describe every element by its kind (`Drawing`, `Group`, `Slide`). So names alone count only if the drawing has
/// signs of parts elsewhere (`signed`), or if they can name parts: all are distinct, and none is about a group without shapes of its own.
fn descriptions(drawing: &Drawing, signed: bool) -> Vec<(StringHolder, Arc<Text>)> {
    let shapes = drawing.shapes.iter_enumerated();
    let shapes = shapes.map(|(index, shape)| (StringHolder::Shape(index), &shape.element.desc));
    let groups = drawing.groups.iter_enumerated();
    let groups = groups.map(|(index, group)| (StringHolder::Group(index), &group.element.desc));
    let (strings, others): (Vec<_>, Vec<_>) = shapes
        .chain(groups)
        .filter_map(|(holder, desc)| Some((holder, Arc::clone(desc.as_ref()?))))
        .partition(|(_, text)| lang::describes(text.as_str()));
    let mut names = others;
    names.retain(|(holder, text)| {
        // The description of the whole file is seldom about its only part.
        let is_root =
            matches!(holder, StringHolder::Group(group) if drawing.groups[*group].kind == GroupKind::Root);
        !is_root && bare_names::is_bare_name(text.as_str())
    });
    let signed = signed || strings.iter().any(|(_, text)| !is_about_all(text.as_str()));
    if !signed && !bare_names::descriptions_name_parts(drawing, &names) {
        names.clear();
    }
    [strings, names].concat()
}

/// Reports a text that holds several strings, of which only the first is read, with a fix that splits it.
fn several(
    drawing: &Drawing,
    holder: StringHolder,
    text: &Text,
    pieces: &[Range<usize>],
) -> Diagnostic {
    let strings = pieces
        .iter()
        .map(|piece| format!("`{}`", shortened(&text.as_str()[piece.clone()])));
    let message = format!(
        "this text holds {} strings, {}: only the first is read",
        pieces.len(),
        listed(strings)
    );
    let finding = Diagnostic::new(Code::UnexpectedSign, text.span(pieces[1].clone()), message)
        .label("another string begins here");
    let (help, fix) = match holder {
        StringHolder::Label(label) => (
            "cut the other strings out, and paste each into a text of its own (in Inkscape, click beside the text first)",
            split(&drawing.labels[label].0, pieces),
        ),
        StringHolder::Shape(_) | StringHolder::Group(_) => (
            "a description holds one string: write the others into the descriptions of their own shapes",
            None,
        ),
    };
    let mut finding = finding.help(help);
    finding.fixes.extend(fix);
    finding
}

/// With more strings in one text, no fix that splits it is offered.
const MAX_SPLIT: usize = 100;

/// The fix that makes each string of a text a text of its own; `None` if there are very many, or if the text is flowed or written
/// with entities that stand for several characters.
fn split(label: &Label, pieces: &[Range<usize>]) -> Option<Fix> {
    if pieces.len() > MAX_SPLIT {
        return None;
    }
    let text = &label.text;
    let mut edits = Vec::new();
    let mut markup = String::new();
    let ends = pieces.iter().map(|piece| piece.end);
    for (before, piece) in ends.zip(&pieces[1..]) {
        let cut = before..piece.end;
        if !text.can_replace(cut.clone()) {
            return None;
        }
        let spans = text.spans(cut).into_iter();
        edits.extend(spans.filter(|span| span.end > span.start).map(|span| Edit {
            span,
            text: String::new(),
        }));
        let string = &text.as_str()[piece.clone()];
        markup.push('\n');
        markup.push_str(&label.as_own_element(piece.start, string)?);
    }
    edits.push(Edit {
        span: Span::at(label.element.end),
        text: markup,
    });
    Some(Fix {
        title: "Give each string a text of its own".to_owned(),
        edits,
        safe: true,
    })
}

/// The first words of a text.
fn shortened(text: &str) -> String {
    const MOST: usize = 24;

    let words: Vec<&str> = text.split_whitespace().collect();
    let all = words.join(" ");
    match all.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &all[..end]),
        None => all,
    }
}

/// The white space between a name and a keyword that directly follows it, as in `Arm Shape round`.
fn without_sign(text: &str) -> Option<Range<usize>> {
    let name = text.find(|c: char| !lang::is_name_char(c))?;
    let rest = text[name..].trim_start();
    let word = rest.split_whitespace().next()?;
    let keyword = Keyword::from_name(word)?;
    (keyword.name() == word
        && rest.len() > word.len()
        && Keyword::from_name(&text[..name]).is_none())
    .then(|| name..text.len() - rest.len())
}

fn caption(text: &Text) -> Diagnostic {
    let start = text.span(0..0);
    let message = "this text is not a string; it is taken for a caption";
    let finding = Diagnostic::new(Code::Caption, text.whole(), message)
        .help(
            "put `#` before a caption to make it a comment; a part's name with spaces needs quotes",
        )
        .fix("Make it a comment", start, "#");
    match without_sign(text.as_str()) {
        Some(blank) => finding.label("is `$` missing before the attributes?").fix(
            "Insert `$`",
            text.span(blank),
            "$",
        ),
        None => finding,
    }
}

/// Merges the settings of the `%` strings; later strings override earlier ones.
fn merged_defaults(
    strings: &TiSlice<StringId, ReadString>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<(StringId, Setting)> {
    let mut defaults: Vec<(StringId, Setting)> = Vec::new();
    for (index, string) in strings.iter_enumerated() {
        if !matches!(string.annotation, Annotation::Defaults(_)) {
            continue;
        }
        for setting in &string.settings {
            // Repeated variables are reported where variables are collected; all motions count.
            if matches!(setting.keyword, Keyword::Let | Keyword::Motion) {
                continue;
            }
            let earlier = defaults
                .iter()
                .position(|(_, other)| other.keyword == setting.keyword);
            let Some(slot) = earlier else {
                defaults.push((index, setting.clone()));
                continue;
            };
            let (other, old) = &defaults[slot];
            if *other != index {
                let text = &strings[*other].text;
                let message = format!(
                    "`{}` is set again by a later `%` string, which counts",
                    setting.keyword.name()
                );
                diagnostics.push(
                    Diagnostic::new(Code::Overridden, text.span(old.range.clone()), message)
                        .related(string.text.span(setting.range.clone()), "the later setting")
                        .help("delete one of them"),
                );
            }
            defaults[slot] = (index, setting.clone());
        }
    }
    defaults
}
