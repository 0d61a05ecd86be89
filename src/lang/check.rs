//! Checks a syntax tree and computes the values of its attributes.
//!
//! An attribute with an error is dropped, the others are kept. Errors that the parser has reported are
//! not reported again.

mod arguments;
mod build;
mod diagnostics;
mod motion;

use std::collections::BTreeMap;

use super::ast::{Annotation, ArgumentKind, Attribute};
use super::keyword::signature::Takes;
use super::keyword::{AttributeString, Keyword, Status};
use super::value::Setting;
use super::variables::Variables;
use crate::diagnostic::Diagnostic;
use crate::source::Text;

/// Checks the attributes of a string and computes their values.
///
/// `text` is the string that `annotation` was parsed from.
pub fn settings(
    text: &Text,
    annotation: &Annotation,
    variables: &Variables,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<Setting> {
    let string = match annotation {
        Annotation::Defaults(_) => AttributeString::Defaults,
        Annotation::Legend(_) => AttributeString::Legend,
        _ => AttributeString::Part,
    };
    let mut checker = Checker {
        text,
        variables,
        diagnostics: vec![],
    };
    let settings = checker.attributes(annotation.attributes(), string);
    super::keep_safe_fixes(text, &mut checker.diagnostics);
    diagnostics.append(&mut checker.diagnostics);
    settings
}

/// The string that is being checked, with the diagnostics so far.
struct Checker<'a> {
    text: &'a Text,
    variables: &'a Variables,
    diagnostics: Vec<Diagnostic>,
}

impl Checker<'_> {
    fn attributes(&mut self, attributes: &[Attribute], string: AttributeString) -> Vec<Setting> {
        let mut settings: Vec<Option<Setting>> = vec![];
        let mut given: BTreeMap<Keyword, (usize, &Attribute)> = BTreeMap::new();
        let mut before: Option<&Attribute> = None;
        // After a sign that is not allowed here, another string seems to begin.
        let mut in_second_string = false;
        for attribute in attributes {
            if before.is_some_and(|before| self.is_sign_between(before, attribute)) {
                in_second_string = true;
                given.clear();
            }
            let allowed = attribute.keyword.row().allowed.permits(string);
            let setting = match (allowed, in_second_string) {
                (true, _) => self.attribute(attribute, before),
                (false, true) => None,
                (false, false) => {
                    self.not_allowed(attribute, string);
                    None
                }
            };
            if attribute.keyword == Keyword::Motion {
                // A `Limited` behind it is another one than those before it.
                given.retain(|keyword, _| !keyword.belongs_to_motion());
            }
            if !matches!(attribute.keyword, Keyword::Let | Keyword::Motion) {
                let earlier = given.insert(attribute.keyword, (settings.len(), attribute));
                if let Some((index, earlier)) = earlier {
                    self.given_twice(attribute, earlier);
                    if setting.is_some() {
                        settings[index] = None;
                    }
                }
            }
            settings.push(setting);
            before = Some(attribute);
        }
        give_to_motions(attributes, &mut settings);
        if in_second_string {
            self.keep_last(&mut settings);
        }
        settings.into_iter().flatten().collect()
    }

    /// Drops settings that a later one replaces without a diagnostic.
    fn keep_last(&self, settings: &mut [Option<Setting>]) {
        let mut seen = std::collections::BTreeSet::new();
        for setting in settings.iter_mut().rev() {
            let Some(keyword) = setting.as_ref().map(|setting| setting.keyword) else {
                continue;
            };
            let accumulates = matches!(keyword, Keyword::Let | Keyword::Motion);
            if !seen.insert(keyword) && !accumulates {
                *setting = None;
            }
        }
    }

    fn attribute(&mut self, attribute: &Attribute, before: Option<&Attribute>) -> Option<Setting> {
        let row = attribute.keyword.row();
        let flags_are_known = self.flags(attribute);
        let needs_arguments = !row.forms.iter().any(|form| form.accepts(0));
        if attribute.arguments.is_empty() && needs_arguments {
            if flags_are_known {
                self.missing_arguments(attribute, before);
            }
            return None;
        }
        if row.status == Status::Planned {
            self.not_built(attribute.keyword.name(), attribute.keyword_range.clone());
        }
        let mut arguments = attribute.arguments.iter();
        if arguments.any(|argument| argument.kind == ArgumentKind::Unreadable) {
            return None;
        }
        let (value, arguments) = self.value(attribute)?;
        if !flags_are_known {
            return None;
        }
        let mut text = String::new();
        if !attribute.flags.is_empty() {
            text.push('-');
            let letters = attribute.flags.iter().map(|(letter, _)| letter);
            text.extend(letters.map(char::to_ascii_lowercase));
        }
        for argument in arguments {
            if !text.is_empty() {
                text.push(' ');
            }
            text.push_str(&argument);
        }
        Some(Setting {
            keyword: attribute.keyword,
            value,
            text,
            range: attribute.range.clone(),
            limited: None,
            held: None,
            performance: None,
        })
    }

    fn flags(&mut self, attribute: &Attribute) -> bool {
        let known = attribute.keyword.row().flags;
        let mut all = true;
        for (letter, range) in &attribute.flags {
            if known
                .iter()
                .any(|flag| flag.letter.eq_ignore_ascii_case(letter))
            {
                continue;
            }
            if all {
                self.unknown_flag(attribute, *letter, range.clone());
            }
            all = false;
        }
        all
    }

    /// Whether there is a sign of the language between two attributes.
    fn is_sign_between(&self, left: &Attribute, right: &Attribute) -> bool {
        let between = self
            .text
            .as_str()
            .get(left.range.end..right.keyword_range.start);
        between.is_some_and(|between| {
            between.contains(['$', '@', '%', '＄', '＠', '％', '*', '＊', '^', '＾'])
        })
    }
}

/// Moves each `Limited`, `Held` and `Perform` into the `Motion` before it, which it belongs to. One behind a `Motion` with an error is dropped
/// like that.
fn give_to_motions(attributes: &[Attribute], settings: &mut [Option<Setting>]) {
    let mut motion = None;
    for (index, attribute) in attributes.iter().enumerate() {
        let keyword = attribute.keyword;
        if keyword == Keyword::Motion {
            motion = Some(index);
        }
        let Some(motion) = motion.filter(|_| keyword.belongs_to_motion()) else {
            continue;
        };
        let given = settings[index].take().map(Box::new);
        if let Some(motion) = &mut settings[motion] {
            let slot = match keyword {
                Keyword::Perform => &mut motion.performance,
                Keyword::Held => &mut motion.held,
                _ => &mut motion.limited,
            };
            *slot = given.or(slot.take());
        }
    }
}

/// Whether the attribute could take the keyword that follows it as a name.
fn takes_a_name(attribute: &Attribute) -> bool {
    let count = attribute.arguments.len();
    attribute.keyword.row().forms.iter().any(|form| {
        let parameter = form.parameters.get(count).or(form.parameters.last());
        parameter.is_some_and(|parameter| match parameter.takes {
            Takes::Names => true,
            Takes::Text | Takes::File | Takes::Variable => count < form.max_arguments(),
            _ => false,
        })
    })
}
