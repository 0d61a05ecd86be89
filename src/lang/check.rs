//! From a syntax tree to checked settings.
//!
//! A setting with a fault is left out, the others are kept. What the parser has said already is not
//! said again.

mod build;
mod fit;
mod told;

use std::collections::BTreeMap;

use super::ast::{Annotation, ArgumentKind, Attribute};
use super::keyword::signature::Takes;
use super::keyword::{Holder, Keyword, Status};
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
    let (attributes, holder) = match annotation {
        Annotation::Defaults(attributes) => (attributes, Holder::Defaults),
        Annotation::Legend(attributes) => (attributes, Holder::Legend),
        Annotation::Part(part) => (&part.attributes, Holder::Part),
        Annotation::Empty
        | Annotation::Comment
        | Annotation::Unused
        | Annotation::Feature(_)
        | Annotation::Caption => return vec![],
    };
    let mut checker = Checker {
        text,
        variables,
        diagnostics: vec![],
    };
    let settings = checker.attributes(attributes, holder);
    super::keep_safe_fixes(text, &mut checker.diagnostics);
    diagnostics.append(&mut checker.diagnostics);
    settings
}

/// A string under examination.
struct Checker<'a> {
    text: &'a Text,
    variables: &'a Variables,
    diagnostics: Vec<Diagnostic>,
}

impl Checker<'_> {
    fn attributes(&mut self, attributes: &[Attribute], holder: Holder) -> Vec<Setting> {
        let mut settings: Vec<Option<Setting>> = vec![];
        let mut given: BTreeMap<Keyword, (usize, &Attribute)> = BTreeMap::new();
        let mut before: Option<&Attribute> = None;
        // Behind a sign that cannot stand in the string another string begins, by the look of it.
        let mut slipped = false;
        for attribute in attributes {
            if before.is_some_and(|before| self.is_sign_between(before, attribute)) {
                slipped = true;
                given.clear();
            }
            let allowed = attribute.keyword.row().allowed.permits(holder);
            let setting = match (allowed, slipped) {
                (true, _) => self.attribute(attribute, before),
                (false, true) => None,
                (false, false) => {
                    self.not_allowed(attribute, holder);
                    None
                }
            };
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
        if slipped {
            self.keep_last(&mut settings);
        }
        settings.into_iter().flatten().collect()
    }

    /// Drops settings that a later one replaces, where nothing was said about it.
    fn keep_last(&self, settings: &mut [Option<Setting>]) {
        let mut seen = std::collections::BTreeSet::new();
        for setting in settings.iter_mut().rev() {
            let Some(keyword) = setting.as_ref().map(|setting| setting.keyword) else {
                continue;
            };
            let adds_up = matches!(keyword, Keyword::Let | Keyword::Motion);
            if !seen.insert(keyword) && !adds_up {
                *setting = None;
            }
        }
    }

    fn attribute(&mut self, attribute: &Attribute, before: Option<&Attribute>) -> Option<Setting> {
        let row = attribute.keyword.row();
        let flags_are_known = self.flags(attribute);
        let needs_arguments = !row.forms.iter().any(|form| form.fits(0));
        if attribute.arguments.is_empty() && needs_arguments {
            if flags_are_known {
                self.nothing_given(attribute, before);
            }
            return None;
        }
        if row.status == Status::Planned {
            self.not_built(attribute.keyword.name(), attribute.keyword_range.clone());
        }
        let unreadable = attribute
            .arguments
            .iter()
            .any(|argument| argument.kind == ArgumentKind::Unreadable);
        if unreadable {
            return None;
        }
        let (value, words) = self.value(attribute)?;
        if !flags_are_known {
            return None;
        }
        let mut written = String::new();
        if !attribute.flags.is_empty() {
            written.push('-');
            written.extend(
                attribute
                    .flags
                    .iter()
                    .map(|(letter, _)| letter.to_ascii_lowercase()),
            );
        }
        for word in words {
            if !written.is_empty() {
                written.push(' ');
            }
            written.push_str(&word);
        }
        Some(Setting {
            keyword: attribute.keyword,
            value,
            words: written,
            range: attribute.range.clone(),
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

    /// Whether a sign of the language stands between two attributes.
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

/// Whether the attribute could take the keyword behind it as a name.
fn takes_a_name(attribute: &Attribute) -> bool {
    let count = attribute.arguments.len();
    attribute.keyword.row().forms.iter().any(|form| {
        let parameter = form.parameters.get(count).or(form.parameters.last());
        parameter.is_some_and(|parameter| match parameter.takes {
            Takes::Names => true,
            Takes::Text | Takes::File | Takes::Variable => count < form.most(),
            _ => false,
        })
    })
}
