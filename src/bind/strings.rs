//! Finds and parses the strings of a drawing, and computes their variables.

use std::sync::Arc;

use rayon::prelude::*;

use super::bindings::{Bindings, DrawingString, Place};
use super::settings::DrawingSettings;
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::{self, variables::Variables};
use crate::source::Text;
use crate::svg::Drawing;
use crate::threads::GRAIN;

pub(super) fn read(drawing: &Drawing, diagnostics: &mut Vec<Diagnostic>) -> Bindings {
    let mut texts = descriptions(drawing);
    let annotated = !texts.is_empty()
        || drawing
            .labels
            .iter()
            .any(|(label, _)| lang::looks_like_string(label.text.as_str()));
    if !annotated {
        return Bindings::default();
    }
    texts.extend(
        drawing
            .labels
            .iter()
            .enumerate()
            .map(|(index, (label, _))| (Place::Label(index), Arc::clone(&label.text))),
    );
    texts.sort_by_key(|(_, text)| text.whole());
    let parsed: Vec<_> = texts
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(|(place, text)| {
            let kind = if matches!(place, Place::Label(_)) {
                lang::Container::Text
            } else {
                lang::Container::Desc
            };
            let (annotation, findings) = lang::parse(&text, kind);
            (place, text, annotation, findings)
        })
        .collect();
    let mut bindings = Bindings {
        annotated,
        ..Bindings::default()
    };
    for (place, text, annotation, findings) in parsed {
        diagnostics.extend(findings);
        if annotation == Annotation::Caption {
            diagnostics.push(caption(&text));
        }
        bindings.strings.push(DrawingString {
            place,
            text,
            annotation,
            settings: vec![],
            binding: None,
            runner_up: None,
            scope: None,
        });
    }
    let variables = Variables::collect(
        bindings
            .strings
            .iter()
            .filter(|string| matches!(string.annotation, Annotation::Defaults(_)))
            .map(|string| (&*string.text, &string.annotation)),
        diagnostics,
    );
    let findings: Vec<Vec<Diagnostic>> = bindings
        .strings
        .par_iter_mut()
        .with_min_len(GRAIN)
        .map(|string| {
            let mut findings = Vec::new();
            string.settings =
                lang::settings(&string.text, &string.annotation, &variables, &mut findings);
            findings
        })
        .collect();
    diagnostics.extend(findings.into_iter().flatten());
    bindings.variables = variables;
    merge_defaults(&mut bindings, diagnostics);
    bindings.settings = DrawingSettings::read(drawing, &bindings);
    bindings
}

/// Descriptions of shapes and groups that are strings.
fn descriptions(drawing: &Drawing) -> Vec<(Place, Arc<Text>)> {
    let mut texts = Vec::new();
    let mut take = |desc: &Option<Arc<Text>>, place| {
        if let Some(text) = desc
            && lang::looks_like_string(text.as_str())
        {
            texts.push((place, Arc::clone(text)));
        }
    };
    for (index, shape) in drawing.shapes.iter().enumerate() {
        take(&shape.element.desc, Place::Shape(index));
    }
    for (index, group) in drawing.groups.iter().enumerate() {
        take(&group.element.desc, Place::Group(index));
    }
    texts
}

fn caption(text: &Text) -> Diagnostic {
    let start = text.span(0..0);
    let message = "this text is not a string; it is taken for a caption";
    Diagnostic::new(Code::Caption, text.whole(), message)
        .help("put `#` before it to make it a comment; a part's name with spaces needs quotes")
        .fix("Make it a comment", start, "#")
}

/// Merges the settings of the `%` strings; later strings override earlier ones.
fn merge_defaults(bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    for (index, string) in bindings.strings.iter().enumerate() {
        if !matches!(string.annotation, Annotation::Defaults(_)) {
            continue;
        }
        for setting in &string.settings {
            // Repeated variables are reported where variables are collected; all motions count.
            if matches!(setting.keyword, Keyword::Let | Keyword::Motion) {
                continue;
            }
            let earlier = bindings
                .defaults
                .iter()
                .position(|(_, other)| other.keyword == setting.keyword);
            let Some(slot) = earlier else {
                bindings.defaults.push((index, setting.clone()));
                continue;
            };
            let (other, old) = &bindings.defaults[slot];
            if *other != index {
                let text = &bindings.strings[*other].text;
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
            bindings.defaults[slot] = (index, setting.clone());
        }
    }
}
