//! Signature help: the parameters of the attribute at the cursor.

use std::ops::Range;

use super::Analysis;
use super::at::attributes;
use super::typed::typed_at;
use crate::bind::StringHolder;
use crate::lang::ast::{ArgumentKind, Attribute};
use crate::lang::keyword::signature::Form;
use crate::lang::keyword::{Keyword, kinds};
use crate::lang::{self, parameter_at};
use crate::source::Text;

/// The forms of an attribute, and the parameter at the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SignatureHelp {
    /// The forms.
    pub signatures: Vec<Signature>,
    /// The form that is being written.
    pub active: usize,
    /// The parameter at the cursor.
    pub parameter: usize,
}

/// One form of an attribute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Signature {
    /// The form: `Shape roundv [a0 a1]`.
    pub label: String,
    /// A one-line summary.
    pub summary: &'static str,
    /// The parameters: the byte range of each in the label, and its meaning.
    pub parameters: Vec<(Range<usize>, String)>,
}

/// The signature of the attribute at byte `offset` of the present text; `None` after its last parameter.
pub(crate) fn signature(source: &str, analysis: &Analysis, offset: usize) -> Option<SignatureHelp> {
    let is_current = analysis.is_sound() && **analysis.source() == *source;
    let (head, place) = match is_current.then(|| analysis.string_at(offset)).flatten() {
        Some((string, at)) => {
            let string = &analysis.bindings().strings[string];
            let place = match string.holder {
                StringHolder::Label(_) => lang::Container::Text,
                StringHolder::Shape(_) | StringHolder::Group(_) => lang::Container::Desc,
            };
            (string.text.as_str().get(..at)?.to_owned(), place)
        }
        None => {
            let typed = typed_at(source, offset)?;
            let place = if typed.in_desc {
                lang::Container::Desc
            } else {
                lang::Container::Text
            };
            (typed.text.as_str().get(..typed.offset)?.to_owned(), place)
        }
    };
    let (annotation, _) = lang::parse(&Text::plain(&head, 0), place);
    let attribute = attributes(&annotation).last()?;
    let is_variable = |name: &str| analysis.is_variable(name);
    help(attribute, &head, &is_variable)
}

fn help(
    attribute: &Attribute,
    head: &str,
    is_variable: &dyn Fn(&str) -> bool,
) -> Option<SignatureHelp> {
    let row = attribute.keyword.row();
    let nothing_typed = attribute.arguments.is_empty() && attribute.flags.is_empty();
    if nothing_typed && attribute.keyword_range.end == head.len() {
        return None;
    }
    // The word that the cursor touches is still being written.
    let last = attribute.arguments.last();
    let touches = last.is_some_and(|argument| argument.range.end == head.len());
    let index = attribute.arguments.len() - usize::from(touches);
    let kind = match attribute.arguments.first().map(|first| &first.kind) {
        Some(ArgumentKind::Word(word)) if attribute.keyword == Keyword::Shape && index > 0 => {
            kinds::from_name(word)
        }
        _ => None,
    };
    if let Some(kind) = kind {
        let name = format!("Shape {}", kind.name);
        return Some(SignatureHelp {
            signatures: vec![written(&name, &kind.form, kind.summary)],
            active: 0,
            parameter: parameter_at(attribute, index, is_variable)?.index,
        });
    }
    let flags: String = row.flags.iter().map(|flag| flag.letter).collect();
    let name = if flags.is_empty() {
        attribute.keyword.name().to_owned()
    } else {
        format!("{} [-{flags}]", attribute.keyword.name())
    };
    let forms = row.forms.iter();
    let signatures: Vec<_> = forms
        .map(|form| written(&name, form, row.summary))
        .collect();
    let slot = parameter_at(attribute, index, is_variable)?;
    let active = row.forms.iter();
    let active = active
        .into_iter()
        .position(|form| std::ptr::eq(form, slot.form));
    Some(SignatureHelp {
        signatures,
        active: active.unwrap_or(0),
        parameter: slot.index,
    })
}

/// The signature of a form of `name`.
fn written(name: &str, form: &Form, summary: &'static str) -> Signature {
    let printed = form.print();
    let label = if printed.is_empty() {
        name.to_owned()
    } else {
        format!("{name} {printed}")
    };
    let mut from = name.len();
    let parameters = form.all().map(|parameter| {
        let text = parameter.print();
        let start = label[from..].find(&text).map_or(from, |at| from + at);
        from = start + text.len();
        let described = format!("{} ({})", parameter.summary, parameter.takes.describe());
        (start..from, described)
    });
    let parameters = parameters.collect();
    Signature {
        label,
        summary,
        parameters,
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};
    use super::*;

    fn described(string: &str) -> Option<(String, String)> {
        let (analysis, at) = analysis(&figure(["Body", string, "", "", ""]));
        let help = signature(&analysis.source().clone(), &analysis, at)?;
        let signature = &help.signatures[help.active];
        let parameter = signature.label[signature.parameters[help.parameter].0.clone()].to_owned();
        Some((signature.label.clone(), parameter))
    }

    #[test]
    fn the_next_parameter_is_marked() {
        for (string, label, parameter) in [
            (
                "Rarm@Body$Shape ¦",
                "Shape [-scd] kind parameters…",
                "kind parameters…",
            ),
            (
                "Rarm@Body$Shape cone ¦0 20",
                "Shape cone [z0 z1 [top]]",
                "z0",
            ),
            (
                "Rarm@Body$Shape cone 0 2¦0",
                "Shape cone [z0 z1 [top]]",
                "z1",
            ),
            (
                "Rarm@Body$Shape cone 0 20 ¦",
                "Shape cone [z0 z1 [top]]",
                "top",
            ),
            ("Rarm@Body$Color ¦", "Color r g b [a]", "r"),
            (
                "Rarm@Body$Motion \"a.bvh\" from ¦",
                "Motion [-il] \"file\" [up] [seconds] [from start] [to end] [speed factor] …",
                "start",
            ),
            ("Rarm@Body$Color 1 ¦", "Color r g b [a]", "g"),
            ("Rarm@Body$Color #f0f¦", "Color #rrggbb[aa]", "#rrggbb[aa]"),
            (
                "Rarm@Body$Origin ce¦",
                "Origin center|start|end",
                "center|start|end",
            ),
        ] {
            let expected = (label.to_owned(), parameter.to_owned());
            assert_eq!(described(string), Some(expected), "{string}");
        }
        assert_eq!(described("Rarm@Body$Shape cone 0 20 1 ¦"), None);
        assert_eq!(described("Rarm@Body$Shape¦"), None);
        assert_eq!(described("Rarm@¦Body"), None);
    }
}
