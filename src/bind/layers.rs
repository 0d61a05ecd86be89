//! Layers: groups with a string of their own, such as a map of tiles (terrain.md, Input).

use rayon::prelude::*;

use super::bindings::{Bindings, Part, PartKind, Place};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang;
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::svg::{Drawing, PaintKey};
use crate::threads::GRAIN;

/// What a string makes of its group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerKind {
    /// A map of tiles: shapes in the group are tiles, not parts.
    Tiles,
    /// A character as seen from one side: shapes in the group are its regions, not parts.
    View,
    /// A key pose of a figure. No effect yet.
    Pose,
}

/// The attributes that make a string a group string, each with the kind of its layer. Of several the first in this list counts.
const KINDS: [(Keyword, LayerKind); 3] = [
    (Keyword::Tiles, LayerKind::Tiles),
    (Keyword::View, LayerKind::View),
    (Keyword::Pose, LayerKind::Pose),
];

/// The name of a layer whose string has no name and whose group has neither label nor id.
const NAMELESS: &str = "Tiles";

/// A layer: a group and its string.
#[derive(Debug, Clone)]
pub struct Layer {
    /// What the string makes of the group.
    pub kind: LayerKind,
    /// Its name. No part and no other tile layer has the name of a tile layer.
    pub name: String,
    /// Index of its string.
    pub string: usize,
    /// Index of its group.
    pub group: usize,
    /// Index of its parent, a main part; `None` for a child of the root.
    pub parent: Option<usize>,
}

impl LayerKind {
    /// Whether shapes in the group belong to the layer: they are no parts of figures.
    fn holds_content(self) -> bool {
        matches!(self, Self::Tiles | Self::View)
    }

    /// The kind of layer that a string makes of its group, if it does.
    pub(super) fn of(annotation: &Annotation) -> Option<Self> {
        let Annotation::Part(part) = annotation else {
            return None;
        };
        let is_set = |keyword| {
            let mut attributes = part.attributes.iter();
            attributes.any(|attribute| attribute.keyword == keyword)
        };
        let kind = KINDS.iter().find(|(keyword, _)| is_set(*keyword));
        kind.map(|(_, kind)| *kind)
    }
}

/// Whether each group is a layer whose pictures are read pixel by pixel, or in one.
pub fn in_layers_of_pixels(drawing: &Drawing) -> Vec<bool> {
    let is_layer = |text, place| {
        let (annotation, _) = lang::parse(text, place);
        LayerKind::of(&annotation).is_some_and(LayerKind::holds_content)
    };
    let labels = drawing.labels.par_iter().with_min_len(GRAIN);
    let of_labels = labels.filter_map(|(label, group)| {
        is_layer(&label.text, lang::Container::Text).then_some(*group)
    });
    let mut layer_groups: Vec<usize> = of_labels.collect();
    let groups = drawing.groups.iter().enumerate();
    let groups = groups.map(|(index, group)| (&group.element, index));
    let shapes = drawing.shapes.iter();
    let shapes = shapes.map(|shape| (&shape.element, shape.group));
    for (element, group) in groups.chain(shapes) {
        let desc = element.desc.as_deref();
        if let Some(text) = desc.filter(|text| lang::describes(text.as_str())) {
            layer_groups.extend(is_layer(text, lang::Container::Desc).then_some(group));
        }
    }
    let mut layer = vec![None; drawing.groups.len()];
    for group in layer_groups {
        layer[group] = Some(0);
    }
    spread(drawing, &mut layer);
    layer.iter().map(Option::is_some).collect()
}

/// Gives every group without a layer of its own the layer of the group around it.
fn spread(drawing: &Drawing, layer: &mut [Option<usize>]) {
    for (index, group) in drawing.groups.iter().enumerate() {
        layer[index] = layer[index].or(layer[group.parent]);
    }
}

/// Index of the group that holds a string.
fn group_of(drawing: &Drawing, place: Place) -> usize {
    match place {
        Place::Label(label) => drawing.labels[label].1,
        Place::Shape(shape) => drawing.shapes[shape].group,
        Place::Group(group) => group,
    }
}

/// Finds the layers, before anything is bound.
pub(super) fn find(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let mut layer: Vec<Option<usize>> = vec![None; drawing.groups.len()];
    let mut layers: Vec<Layer> = Vec::new();
    for (index, string) in bindings.strings.iter().enumerate() {
        let Annotation::Part(annotation) = &string.annotation else {
            continue;
        };
        let Some(kind) = LayerKind::of(&string.annotation) else {
            continue;
        };
        let group = group_of(drawing, string.place);
        if let Some(first) = layer[group].filter(|_| kind.holds_content()) {
            let other: &Layer = &layers[first];
            let element = &drawing.groups[group].element;
            let message = format!(
                "this string and another one make the same group a layer, {}",
                drawing.describe_group(group)
            );
            diagnostics.push(
                Diagnostic::new(Code::TwoStrings, string.text.whole(), message)
                .related(
                    bindings.strings[other.string].text.whole(),
                    "the other string, which counts",
                )
                .related(element.span, "the group")
                .help(
                    "delete one of them, or put each into the group or layer that contains its shapes",
                ),
            );
            continue;
        }
        if kind.holds_content() {
            layer[group] = Some(layers.len());
        }
        let name = annotation.name.as_ref().map(|name| name.text.clone());
        let named_by = match string.place {
            Place::Shape(shape) => &drawing.shapes[shape].element,
            _ => &drawing.groups[group].element,
        };
        let name = name.unwrap_or_else(|| match named_by.own_name() {
            "" => NAMELESS.to_owned(),
            own => own.to_owned(),
        });
        layers.push(Layer {
            kind,
            name,
            string: index,
            group,
            parent: None,
        });
    }
    if !layers.is_empty() {
        spread(drawing, &mut layer);
        bindings.layer_of_group = layer;
        bindings.layers = layers;
    }
}

impl Bindings {
    /// The tile layers, each with its index among all [`layers`](Self::layers).
    pub fn tile_layers(&self) -> impl Iterator<Item = (usize, &Layer)> {
        let layers = self.layers.iter().enumerate();
        layers.filter(|(_, layer)| layer.kind == LayerKind::Tiles)
    }

    /// The views of characters, each with its index among all [`layers`](Self::layers).
    pub fn views(&self) -> impl Iterator<Item = (usize, &Layer)> {
        let layers = self.layers.iter().enumerate();
        layers.filter(|(_, layer)| layer.kind == LayerKind::View)
    }

    /// Index of the innermost tile layer or view that a group is, or is in.
    pub fn layer_of_group(&self, group: usize) -> Option<usize> {
        self.layer_of_group.get(group).copied().flatten()
    }

    /// The same, if that is of a kind.
    fn layer_of_kind(&self, group: usize, kind: LayerKind) -> Option<usize> {
        let layer = self.layer_of_group(group);
        layer.filter(|layer| self.layers[*layer].kind == kind)
    }

    /// Index of the tile layer that a group is, or is in.
    pub fn tile_layer_of_group(&self, group: usize) -> Option<usize> {
        self.layer_of_kind(group, LayerKind::Tiles)
    }

    /// Index of the view of a character that a group is, or is in.
    pub fn view_of_group(&self, group: usize) -> Option<usize> {
        self.layer_of_kind(group, LayerKind::View)
    }

    /// Index of the view that a string is in.
    pub fn view_of_string(&self, drawing: &Drawing, string: usize) -> Option<usize> {
        self.view_of_group(group_of(drawing, self.strings[string].place))
    }

    /// Whether a shape is a picture in a tile layer or a view, and so no part.
    pub fn is_picture_of_layer(&self, drawing: &Drawing, shape: usize) -> bool {
        let shape = &drawing.shapes[shape];
        let is_picture = matches!(shape.paint.key, PaintKey::Picture(_));
        is_picture && self.layer_of_group(shape.group).is_some()
    }

    /// Whether a string excludes a picture from its tile layer. It cannot be bound, because such pictures are no parts.
    pub(super) fn leaves_picture_out(&self, drawing: &Drawing, string: usize) -> bool {
        let string = &self.strings[string];
        let Place::Shape(shape) = string.place else {
            return false;
        };
        string.annotation == Annotation::Unused && self.is_picture_of_layer(drawing, shape)
    }
}

/// Makes the parts without a string in tile layers tiles, and the parts in views regions of their characters.
pub(super) fn classify(drawing: &Drawing, bindings: &mut Bindings) {
    if bindings.layers.is_empty() {
        return;
    }
    for index in 0..bindings.parts.len() {
        let Part { shape, main, .. } = bindings.parts[index];
        let is_left_out = bindings.parts[index].kind == PartKind::Unused;
        let in_view = bindings
            .view_of_group(drawing.shapes[shape].group)
            .is_some();
        if in_view && !is_left_out {
            bindings.parts[index].kind = PartKind::Region;
            continue;
        }
        let unbound =
            bindings.parts[index].string.is_none() && bindings.parts[main].string.is_none();
        if unbound
            && bindings
                .tile_layer_of_group(drawing.shapes[shape].group)
                .is_some()
        {
            bindings.parts[index].kind = PartKind::Tile;
        }
    }
}

/// Reports attributes of tile layers in strings that make none, and attributes of regions outside of views.
pub(super) fn misplaced(drawing: &Drawing, bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let has_tile_layers = bindings.tile_layers().next().is_some();
    for string in &bindings.strings {
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
        let group = group_of(drawing, string.place);
        let in_view = bindings.view_of_group(group).is_some();
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
        for attribute in attributes {
            let misplaced = match attribute.keyword {
                Keyword::Tiles => true,
                Keyword::Bevel | Keyword::Roof => !for_all || !has_tile_layers,
                _ => false,
            };
            if misplaced {
                let name = attribute.keyword.name();
                let message =
                    format!("`{name}` has no effect in {what}: it applies to tile layers");
                diagnostics.push(
                    Diagnostic::new(Code::NoTileLayer, string.text.span(attribute.range.clone()), message)
                    .help("write it into the string that makes a layer or group a map, as in `Island$Tiles 16 Bevel 0.2`"),
                );
            }
        }
    }
}
