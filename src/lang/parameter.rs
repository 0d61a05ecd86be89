//! Finds the parameter that an argument is for.

use super::ast::{ArgumentKind, Attribute};
use super::keyword::signature::{Form, Parameter, Takes};
use super::keyword::{Keyword, colors, kinds};
use super::motion;

/// The parameter that an argument is for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ParameterRef {
    /// The keyword, or for a kind's own parameters the kind: `Offset`, `roundv`.
    pub owner: &'static str,
    /// The kind of `Shape` whose parameter it is.
    pub kind: Option<&'static kinds::Kind>,
    /// The form that the parameter belongs to.
    pub form: &'static Form,
    /// The parameter's index in the form.
    pub index: usize,
}

impl ParameterRef {
    /// The parameter.
    pub(crate) fn parameter(&self) -> &'static Parameter {
        let parameters = self.form.parameters;
        match self.index.checked_sub(parameters.len()) {
            None => &parameters[self.index],
            Some(option) => &self.form.options[option],
        }
    }
}

/// The parameter that argument `index` of an attribute is for. The argument need not exist yet. `None` after the
/// last parameter.
pub(crate) fn parameter_at(
    attribute: &Attribute,
    index: usize,
    is_variable: &dyn Fn(&str) -> bool,
) -> Option<ParameterRef> {
    let first = attribute.arguments.first().map(|argument| &argument.kind);
    if attribute.keyword == Keyword::Shape && index > 0 {
        let Some(ArgumentKind::Word(word)) = first else {
            return None;
        };
        let kind = kinds::from_name(word)?;
        return Some(ParameterRef {
            owner: kind.name,
            kind: Some(kind),
            form: &kind.form,
            index: kind.form.parameter_index(index - 1)?,
        });
    }
    if attribute.keyword == Keyword::Motion {
        return motion::parameter(&attribute.arguments, index, is_variable);
    }
    let forms = attribute.keyword.row().forms;
    let form = form_by_first_argument(attribute, is_variable)
        .or_else(|| forms.iter().find(|form| form.max_arguments() > index))
        .or(forms.first())?;
    Some(ParameterRef {
        owner: attribute.keyword.name(),
        kind: None,
        form,
        index: form.parameter_index(index)?,
    })
}

/// The form that an attribute's first argument fits; `None` if it fits none of them.
pub(super) fn form_by_first_argument(
    attribute: &Attribute,
    is_variable: &dyn Fn(&str) -> bool,
) -> Option<&'static Form> {
    let forms = attribute.keyword.row().forms;
    let first = attribute.arguments.first()?;
    let takes = |form: &&'static Form| form.parameters.first().map(|parameter| &parameter.takes);
    let fits = |form: &&'static Form| match (takes(form), &first.kind) {
        (Some(Takes::Number(_)), ArgumentKind::Number(_) | ArgumentKind::Expression(_))
        | (Some(Takes::Hex), ArgumentKind::Hex(_)) => true,
        (Some(Takes::Number(_)), ArgumentKind::Word(word)) => is_variable(word),
        (Some(Takes::Choice(words)), ArgumentKind::Word(word)) => words
            .iter()
            .any(|choice| choice.name.eq_ignore_ascii_case(word)),
        (Some(Takes::ColorName), ArgumentKind::Word(word)) => colors::is_color(word),
        (Some(Takes::File), ArgumentKind::Quoted(_)) => fits_second(form, attribute),
        // A file name with an ending is read without quotes.
        (Some(Takes::File), ArgumentKind::Word(word)) if word.contains('.') => {
            fits_second(form, attribute)
        }
        _ => false,
    };
    // Words of the language have precedence over variables with the same name.
    let takes_words = |form: &&'static Form| !matches!(takes(form), Some(Takes::Number(_)));
    let found = forms.iter().filter(takes_words).find(fits);
    found.or_else(|| forms.iter().find(fits))
}

/// Whether the second argument can be that of a form whose second parameter is an axis, a number or a text: an axis has a sign.
fn fits_second(form: &Form, attribute: &Attribute) -> bool {
    let second = attribute.arguments.get(1).map(|argument| &argument.kind);
    let is_axis = matches!(second, Some(ArgumentKind::Word(word)) if word.starts_with(['+', '-']));
    match form.parameters.get(1).map(|parameter| &parameter.takes) {
        Some(Takes::SignedAxis) => is_axis || second.is_none(),
        Some(Takes::Number(_)) => matches!(
            second,
            None | Some(ArgumentKind::Number(_) | ArgumentKind::Expression(_))
        ),
        Some(Takes::Text) => !is_axis,
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::ast::Annotation;
    use crate::lang::{Container, parse};
    use crate::source::Text;

    fn name(string: &str, index: usize) -> Option<(&'static str, &'static str)> {
        let (annotation, _) = parse(&Text::plain(string, 0), Container::Text);
        let (Annotation::Legend(attributes) | Annotation::Defaults(attributes)) = annotation else {
            panic!("{string} has no attributes");
        };
        let found = parameter_at(&attributes[0], index, &|name| name == "w")?;
        Some((found.owner, found.parameter().name))
    }

    #[test]
    fn arguments_find_their_parameters() {
        for (string, index, expected) in [
            ("$Color 1 0 0", 1, Some(("Color", "g"))),
            ("$Color w 0 0", 2, Some(("Color", "b"))),
            ("$Color w 0 0", 4, None),
            ("$Color", 0, Some(("Color", "r"))),
            ("$Color red", 0, Some(("Color", "colour"))),
            ("$Color red", 1, None),
            ("$Shape", 0, Some(("Shape", "kind"))),
            ("$Shape cone 0 1", 2, Some(("cone", "z1"))),
            ("$Shape cone 0 1", 3, Some(("cone", "top"))),
            ("$Shape cone 0 1", 4, None),
            ("$Shape nonsense 0", 1, None),
            ("$Origin 1", 1, Some(("Origin", "y"))),
            ("$Origin center", 1, None),
            ("$Follow a b c", 7, Some(("Follow", "name"))),
            ("$Held 1 2 3", 3, Some(("Held", "frames"))),
            ("$Held 1 2 3 4", 4, Some(("Held", "frame"))),
            ("$Hidden", 0, None),
            ("$Motion \"a.bvh\"", 1, Some(("Motion", "up"))),
            ("$Motion \"a.bvh\" +z", 1, Some(("Motion", "up"))),
            ("$Motion \"a.bvh\" +z", 2, Some(("Motion", "seconds"))),
            ("$Motion \"a.bvh\" from", 2, Some(("Motion", "start"))),
            (
                "$Motion \"a.bvh\" to 2 speed 3",
                4,
                Some(("Motion", "factor")),
            ),
            ("$Motion \"a.bvh\" kick", 1, Some(("Motion", "name"))),
            ("$Motion \"a.bvh\" kick", 2, Some(("Motion", "up"))),
            ("$Perform \"a.json\" 10", 1, Some(("Perform", "input-key"))),
            (
                "$Perform \"a.json\" (5 + 5) 7",
                2,
                Some(("Perform", "motion-key")),
            ),
            ("$Perform \"a.json\" 10 7", 3, None),
            ("$Perform \"a.json\" red", 1, Some(("Perform", "mark"))),
            (
                "$Perform a.json \"left hand\" 10",
                3,
                Some(("Perform", "motion-key")),
            ),
            ("$Motion walk", 0, Some(("Motion", "clip"))),
            ("$Motion walk", 1, Some(("Motion", "name"))),
            ("$Motion walk stroll", 2, Some(("Motion", "seconds"))),
            ("$Motion walk w wave", 1, Some(("Motion", "seconds"))),
            ("$Motion walk w wave", 2, Some(("Motion", "clip"))),
            ("$Motion walk +z", 1, None),
        ] {
            assert_eq!(name(string, index), expected, "{string} {index}");
        }
    }
}
