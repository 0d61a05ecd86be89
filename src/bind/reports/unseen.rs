//! Strings that are there but not read: in hidden layers, or converted to paths.

use std::sync::Arc;

use crate::bind::matching::{Matched, is_bare_name};
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::lang::annotates;
use crate::source::Text;
use crate::svg::{ConvertedText, Drawing, GroupKind, Hidden};

impl Hidden {
    /// What is hidden, for people.
    pub(super) fn describe(&self) -> String {
        let what = match self.kind {
            Some(GroupKind::Layer) => "the hidden layer",
            Some(_) => "the hidden group",
            None => "the hidden shape",
        };
        match (&self.element.label, &self.element.id) {
            (Some(label), _) => format!("{what} `{label}`"),
            (None, Some(id)) => format!("{what} `#{id}`"),
            (None, None) => what.replacen("the", "a", 1),
        }
    }
}

/// Reports strings that are hidden, if the drawing has no others.
pub(super) fn hidden(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    if matched.annotated {
        return;
    }
    let is_string = |text: &&Arc<Text>| annotates(text.as_str());
    let strings = |hidden: &Hidden| hidden.texts.iter().filter(is_string).count();
    let all = drawing.unseen.hidden.iter();
    let all: Vec<(&Hidden, usize)> = all
        .map(|hidden| (hidden, strings(hidden)))
        .filter(|(_, strings)| *strings > 0)
        .collect();
    let Some((first, _)) = all.first() else {
        return;
    };
    let places = listed(all.iter().map(|(hidden, _)| hidden.describe()));
    let message = match all.iter().map(|(_, strings)| strings).sum() {
        1_usize => format!("the drawing's only string is in {places}, so it is not read"),
        count => format!("all {count} strings are in {places}, so none is read"),
    };
    let mut finding = Diagnostic::new(Code::HiddenStrings, first.element.span, message)
        .help("show the layer (in Inkscape, the eye in Layer → Layers and Objects): strings in hidden layers do not count");
    if let Some(text) = first.texts.iter().find(is_string) {
        finding = finding.related(text.whole(), "a string in it");
    }
    diagnostics.push(finding);
}

/// The fewest words that may be names which are reported: one is a title or a signature.
const FEWEST_NAMES: usize = 2;
/// The most letters of a word that may be a name.
const LONGEST_NAME: usize = 24;

/// Reports words that may be names of parts, in a drawing whose texts are not read.
pub(super) fn names(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    if matched.annotated {
        return;
    }
    let texts = drawing.labels.iter().map(|(label, _)| &label.text);
    // Letters by themselves are lettering along a curve.
    let may_be_name = |text: &&Arc<Text>| {
        let word = text.as_str().trim();
        is_bare_name(word) && (2..=LONGEST_NAME).contains(&word.chars().count())
    };
    let words: Vec<&Arc<Text>> = texts.filter(may_be_name).collect();
    if words.len() < FEWEST_NAMES || 2 * words.len() < drawing.labels.len() {
        return;
    }
    let all = listed(
        words
            .iter()
            .map(|word| format!("`{}`", word.as_str().trim())),
    );
    let message = format!(
        "{} words may be names of parts, but are not read: {all}",
        words.len()
    );
    diagnostics.push(
        Diagnostic::new(Code::UnreadNames, words[0].whole(), message).help(
            "move each word onto its shape, or group it with that, and put `#` before texts that are no names; or write a string with a sign, such as `Head@Body`",
        ),
    );
}

/// Reports texts that were strings until they were converted to paths.
pub(super) fn converted(drawing: &Drawing, diagnostics: &mut Vec<Diagnostic>) {
    let converted = drawing.unseen.converted.iter();
    let converted: Vec<&ConvertedText> = converted
        .filter(|converted| annotates(&converted.text))
        .collect();
    let findings = converted.iter().map(|converted| {
        let message = format!(
            "the text `{}` was converted to paths, so it is no longer a string",
            converted.text.trim()
        );
        Diagnostic::new(Code::ConvertedText, converted.element.span, message)
            .help("undo the conversion (Ctrl+Z), or delete the paths and type the text again")
    });
    let texts = || {
        let texts = converted.iter();
        listed(texts.map(|converted| format!("`{}`", converted.text.trim())))
    };
    few_or_one(
        findings.collect(),
        |count| {
            format!(
                "{count} texts were converted to paths, so they are no longer strings: {}",
                texts()
            )
        },
        diagnostics,
    );
}
