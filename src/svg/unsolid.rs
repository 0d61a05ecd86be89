//! Features of SVG that have no meaning for solids, or that are not read.

use super::{Drawing, GroupId, ShapeId};
use crate::diagnostic::{Code, Diagnostic, listed};
use crate::source::Span;

/// A feature without a meaning for solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Feature {
    Mask,
    Filter,
    Marker,
    /// `mix-blend-mode`.
    Blending,
    /// An element of an animation, or an animation of CSS.
    Animation,
    Script,
    /// A mesh gradient, a hatch and the like.
    OtherPaint,
    /// A paint that is not in the drawing, and no colour in its place.
    NoPaint,
    /// A filter that is not in the drawing.
    NoFilter,
    /// A clip or a mask that CSS describes.
    CssClip,
    /// A clip with texts.
    ClipText,
    PatternText,
    /// A transform with units, or one of the properties that CSS has beside it.
    CssTransform,
    /// A place or a size that CSS says.
    CssPlace,
    /// Rules of a style sheet.
    Rules,
    /// A number or a colour.
    Value,
    /// Something of another file.
    OtherFile,
    /// `vector-effect` on a stroke that is scaled.
    FixedWidth,
    /// For readers of another language.
    Language,
}

/// What uses a feature.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Who {
    Shape(ShapeId),
    Group(GroupId),
    /// Another element, by its name and place.
    Element(String, Span),
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
            Self::Marker => (
                "has markers, such as arrowheads, which are not built",
                "have markers, such as arrowheads, which are not built",
                "turn them into shapes: in Inkscape, Path → Stroke to Path",
            ),
            Self::Blending => (
                "is mixed with the colours below it (`mix-blend-mode`), which has no meaning for solids",
                "are mixed with the colours below them (`mix-blend-mode`), which has no meaning for solids",
                "give the shape the colour that it has on the page, or remove the blend mode; it is built in its own colour",
            ),
            Self::Animation => (
                "is animated, which is not read",
                "are animated, which is not read",
                "the model is the drawing without its animations; what moves it is a string with `Motion` (`okoshi explain Motion`)",
            ),
            Self::Script => (
                "is not run",
                "are not run",
                "if the script draws something, open the drawing in a browser and save what it shows as a drawing",
            ),
            Self::OtherPaint => (
                "has a paint that is not read, such as a mesh gradient or a hatch",
                "have paints that are not read, such as mesh gradients or hatches",
                "use a linear or radial gradient, or a picture (in Inkscape, Edit → Make a Bitmap Copy); only the colour behind such a paint is shown, if there is one",
            ),
            Self::NoPaint => (
                "has a paint that is not in the drawing, and no colour in its place",
                "have paints that are not in the drawing, and no colours in their place",
                "give it a colour or a gradient of this drawing",
            ),
            Self::NoFilter => (
                "is left out, because its filter is not in the drawing",
                "are left out, because their filters are not in the drawing",
                "remove the filter: it does nothing in other programs",
            ),
            Self::CssClip => (
                "has a clip or a mask of CSS, which is not read",
                "have clips or masks of CSS, which are not read",
                "clip it by a shape (in Inkscape, Object → Clip); the model is built without it",
            ),
            Self::ClipText => (
                "has a clip with text, which is not read: less of it is left, or nothing",
                "have clips with text, which is not read: less of them is left, or nothing",
                "turn the text into paths (in Inkscape, Path → Object to Path)",
            ),
            Self::PatternText => (
                "is text in a pattern, which is not drawn",
                "are texts in patterns, which are not drawn",
                "turn the text into paths (in Inkscape, Path → Object to Path)",
            ),
            Self::CssTransform => (
                "is moved, turned or scaled by CSS, which is not read",
                "are moved, turned or scaled by CSS, which is not read",
                "write the attribute `transform`, whose numbers have no units: `transform=\"rotate(20)\"`",
            ),
            Self::CssPlace => (
                "has its place or its size in CSS, which is not read",
                "have their places or sizes in CSS, which are not read",
                "write them as attributes: `width=\"50\"` in place of `style=\"width: 50px\"`",
            ),
            Self::Rules => (
                "has rules that are not read, such as `@media`, `:not()` or `var()`",
                "have rules that are not read, such as `@media`, `:not()` or `var()`",
                "save the drawing as plain SVG, or set the colours at the shapes themselves",
            ),
            Self::Value => (
                "has a colour or a length that is not read, such as `var()`, `calc()` or `3rem`",
                "have colours or lengths that are not read, such as `var()`, `calc()` or `3rem`",
                "write colours as `#cc3300` and lengths as numbers",
            ),
            Self::OtherFile => (
                "takes what it draws from another file, which is not read",
                "take what they draw from other files, which are not read",
                "copy it into this drawing; a whole file can be linked as a picture (`<image>`)",
            ),
            Self::FixedWidth => (
                "has a stroke that keeps its width when it is scaled (`vector-effect`), but is scaled with it here",
                "have strokes that keep their widths when they are scaled (`vector-effect`), but are scaled with them here",
                "remove the `vector-effect`, and give the stroke the width that it has on the page",
            ),
            Self::Language => (
                "is for readers of another language than English, and is left out",
                "are for readers of other languages than English, and are left out",
                "remove the `systemLanguage`, or put the languages into a `<switch>`",
            ),
        };
        let names = listed(users.iter().map(|user| user.describe(drawing)));
        let message = match users {
            [_] => format!("{names} {one}"),
            _ if users.iter().any(|user| matches!(user, Who::Element(..))) => {
                format!("{} elements {many}: {names}", users.len())
            }
            _ => format!("{} shapes and groups {many}: {names}", users.len()),
        };
        let span = users.first().map_or(Span::at(0), |user| user.span(drawing));
        Diagnostic::new(Code::NoSolidMeaning, span, message).help(help)
    }

    /// Whether elements that are not built are reported too; what was found in usvg's tree has other reports.
    pub(super) fn is_of_elements(self) -> bool {
        !matches!(
            self,
            Self::Mask | Self::Filter | Self::Marker | Self::Blending
        )
    }
}

impl Who {
    fn describe(&self, drawing: &Drawing) -> String {
        match self {
            Self::Shape(shape) => drawing.describe(*shape),
            Self::Group(group) => drawing.describe_group(*group),
            Self::Element(name, _) => name.clone(),
        }
    }

    fn span(&self, drawing: &Drawing) -> Span {
        match self {
            Self::Shape(shape) => drawing.shapes[*shape].element.span,
            Self::Group(group) => drawing.groups[*group].element.span,
            Self::Element(_, span) => *span,
        }
    }
}
