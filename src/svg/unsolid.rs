//! Features of SVG that have no meaning for solids.

use super::{Drawing, GroupId, ShapeId};
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::source::Span;

/// A feature without a meaning for solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Feature {
    Mask,
    Filter,
    /// The opacity of a group of several shapes.
    GroupOpacity,
    Marker,
}

/// What uses a feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Who {
    Shape(ShapeId),
    Group(GroupId),
}

impl Feature {
    /// One warning about all that use the feature.
    pub(super) fn report(self, drawing: &Drawing, users: &[Who]) -> Diagnostic {
        let (one, many, help) = match self {
            Self::Mask => (
                "has a mask, which has no meaning for solids",
                "have masks, which have no meaning for solids",
                "cut the shape itself, or use a clip instead (in Inkscape, Object → Clip); the model is built without the mask",
            ),
            Self::Filter => (
                "has a filter, which has no meaning for solids",
                "have filters, which have no meaning for solids",
                "draw a blur or a shadow as a shape with a gradient, or remove the filter; the model is built without it",
            ),
            Self::GroupOpacity => (
                "is transparent as a whole, but its shapes become transparent one by one",
                "are transparent as a whole, but their shapes become transparent one by one",
                "where they overlap, they show through each other; unite them (in Inkscape, Path → Union), or remove the opacity of the group",
            ),
            Self::Marker => (
                "has markers, such as arrowheads, which are not built",
                "have markers, such as arrowheads, which are not built",
                "turn them into shapes: in Inkscape, Path → Stroke to Path",
            ),
        };
        let names = listed(users.iter().map(|user| user.describe(drawing)));
        let message = match users {
            [_] => format!("{names} {one}"),
            _ => format!("{} shapes and groups {many}: {names}", users.len()),
        };
        let span = users.first().map_or(Span::at(0), |user| user.span(drawing));
        Diagnostic::new(Code::NoSolidMeaning, span, message).help(help)
    }
}

impl Who {
    fn describe(self, drawing: &Drawing) -> String {
        match self {
            Self::Shape(shape) => drawing.describe(shape),
            Self::Group(group) => drawing.describe_group(group),
        }
    }

    fn span(self, drawing: &Drawing) -> Span {
        match self {
            Self::Shape(shape) => drawing.shapes[shape].element.span,
            Self::Group(group) => drawing.groups[group].element.span,
        }
    }
}
