//! Attributes of layers and of regions in places where they have no effect.

use crate::bind::bindings::DrawingString;
use crate::bind::matching::{LayerKind, Matched, group_of};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::svg::Drawing;

/// The attributes of parts that say how they move.
const MOVE: [Keyword; 11] = [
    Keyword::Bone,
    Keyword::Carry,
    Keyword::Bend,
    Keyword::Swing,
    Keyword::Facing,
    Keyword::Mark,
    Keyword::Follow,
    Keyword::Motion,
    Keyword::Limited,
    Keyword::Held,
    Keyword::Perform,
];

/// Reports attributes of tile layers in strings that make none, and attributes of regions outside of views.
pub(super) fn report(drawing: &Drawing, matched: &Matched, diagnostics: &mut Vec<Diagnostic>) {
    let has_tile_layers = matched.layers.tile_layers().next().is_some();
    for string in &matched.strings {
        stands(drawing, matched, string, has_tile_layers, diagnostics);
        let (attributes, what) = match &string.annotation {
            Annotation::Part(part)
                if LayerKind::of(&string.annotation) != Some(LayerKind::Tiles) =>
            {
                (&part.attributes, "a part's string")
            }
            Annotation::Legend(attributes) => (attributes, "a legend"),
            // A `%` string sets them for all tile layers.
            Annotation::Defaults(attributes) => (attributes, "a `%` string"),
            _ => continue,
        };
        let group = group_of(drawing, string.holder);
        let view = matched.layers.of_group_and_kind(group, LayerKind::View);
        let in_view = view.is_some();
        let of_view = attributes.iter().filter(|attribute| {
            !in_view && matches!(attribute.keyword, Keyword::Depth | Keyword::Hidden)
        });
        for attribute in of_view {
            let name = attribute.keyword.name();
            let message = format!(
                "`{name}` has no effect in {what} outside of a view: it applies to regions of a character"
            );
            let span = string.text.span(attribute.range.clone());
            diagnostics.push(
                Diagnostic::new(Code::NoTileLayer, span, message)
                    .help("put it into a layer with a string like `Boy$View 0 0`, or delete it"),
            );
        }
        let for_all = matches!(string.annotation, Annotation::Defaults(_));
        let in_map = matched.layers.of_group_and_kind(group, LayerKind::Tiles);
        for attribute in attributes {
            let misplaced = match attribute.keyword {
                Keyword::Tiles => true,
                Keyword::Bevel | Keyword::Roof => !for_all || !has_tile_layers,
                Keyword::Height => match string.annotation {
                    Annotation::Part(_) => in_map.is_none(),
                    _ => !has_tile_layers,
                },
                _ => false,
            };
            if misplaced {
                let name = attribute.keyword.name();
                let (whose, help) = match attribute.keyword {
                    Keyword::Height => (
                        "the tiles of tile layers",
                        "write it into a legend of a tile layer, as in `$Tile beige Height 3`, or into a group inside the layer, as in `Hill$Height 2`",
                    ),
                    _ => (
                        "tile layers",
                        "write it into the string that makes a layer or group a map, as in `Island$Tiles 16 Bevel 0.2`",
                    ),
                };
                let message = format!("`{name}` has no effect in {what}: it applies to {whose}");
                let span = string.text.span(attribute.range.clone());
                diagnostics.push(Diagnostic::new(Code::NoTileLayer, span, message).help(help));
            }
        }
    }
}

/// Whether a string is that of a prop, or of a layer of props.
pub(super) fn is_of_props(drawing: &Drawing, matched: &Matched, string: &DrawingString) -> bool {
    let is_of_layer = LayerKind::of(&string.annotation) == Some(LayerKind::Stand);
    let props = || matched.layers.of_props(group_of(drawing, string.holder));
    is_of_layer || (string.binding.is_some() && props().is_some())
}

/// Reports `Stand` where nothing stands, and what is said to hang on something or to move although it stands by itself.
fn stands(
    drawing: &Drawing,
    matched: &Matched,
    string: &DrawingString,
    has_tile_layers: bool,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let kind = LayerKind::of(&string.annotation);
    let props = matched.layers.of_props(group_of(drawing, string.holder));
    let mut attributes = string.annotation.attributes().iter();
    let stand = attributes.find(|attribute| attribute.keyword == Keyword::Stand);
    let mut report = |range, message: &str, help| {
        let span = string.text.span(range);
        diagnostics.push(Diagnostic::new(Code::NoTileLayer, span, message).help(help));
    };
    if let Some(stand) = stand {
        let range = stand.range.clone();
        let found = match (&string.annotation, kind) {
            (Annotation::Part(_), Some(LayerKind::Stand)) if !has_tile_layers => Some((
                "`Stand` has no effect: the drawing has no map to stand on",
                "make a map of a layer with a string like `Island$Tiles 16`, or delete `Stand`",
            )),
            (Annotation::Part(_), Some(LayerKind::Stand)) => None,
            (Annotation::Part(_), None) if props.is_some() => None,
            (Annotation::Part(_), None) => Some((
                "`Stand` with a point has no effect here: it applies to what stands in a layer of props",
                "put the shape into a layer with a string like `Trees$Stand`, or delete it",
            )),
            _ => Some((
                "`Stand` has no effect here: it applies to layers of props",
                "write it into a string of its own in the layer that holds the props: `Trees$Stand`",
            )),
        };
        if let Some((message, help)) = found {
            report(range, message, help);
        }
    }
    let of_prop = string.binding.is_some() && props.is_some();
    if let Annotation::Part(part) = &string.annotation
        && let Some(parent) = part.parent.as_ref().filter(|_| of_prop)
    {
        let message = format!("`@{}` has no effect: a prop stands by itself", parent.text);
        let help =
            "delete it, or draw what hangs together in one group, outside of the layer of props";
        report(parent.range.clone(), &message, help);
    }
    if is_of_props(drawing, matched, string) {
        let attributes = string.annotation.attributes().iter();
        for attribute in attributes.filter(|attribute| MOVE.contains(&attribute.keyword)) {
            let name = attribute.keyword.name();
            let message = format!("`{name}` has no effect here: a prop does not move");
            let help = "delete it, or draw what moves as a figure, outside of the layer of props";
            report(attribute.range.clone(), &message, help);
        }
    }
}
