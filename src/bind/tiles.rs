//! Tile layers: groups whose shapes are tiles of a map rather than parts (terrain.md, Input).

use rayon::prelude::*;

use super::bindings::{Bindings, Part, PartKind, Place};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::{self, Annotation};
use crate::lang::keyword::Keyword;
use crate::lang::{self, value::Value};
use crate::svg::{Drawing, PaintKey};
use crate::threads::GRAIN;

/// What a tile layer is called that has neither a name nor a label nor an id.
const NAMELESS: &str = "Tiles";

/// A tile layer.
#[derive(Debug, Clone)]
pub struct TileLayer {
    /// Its name, which no part and no other layer has.
    pub name: String,
    /// Index of its string.
    pub string: usize,
    /// Index of its group.
    pub group: usize,
    /// Index of the main part that it hangs on; `None` hangs on the root.
    pub parent: Option<usize>,
}

/// Whether each group is a tile layer's, or in one.
pub fn in_tile_layers(drawing: &Drawing) -> Vec<bool> {
    let labels = drawing.labels.par_iter().with_min_len(GRAIN);
    let of_labels = labels.filter_map(|(label, group)| {
        let (annotation, _) = lang::parse(&label.text, lang::Container::Text);
        makes_layer(&annotation).then_some(*group)
    });
    let mut holders: Vec<usize> = of_labels.collect();
    let groups = drawing.groups.iter().enumerate();
    let groups = groups.map(|(index, group)| (&group.element, index));
    let shapes = drawing.shapes.iter();
    let shapes = shapes.map(|shape| (&shape.element, shape.group));
    for (element, group) in groups.chain(shapes) {
        let desc = element.desc.as_deref();
        if let Some(text) = desc.filter(|text| lang::looks_like_string(text.as_str())) {
            let (annotation, _) = lang::parse(text, lang::Container::Desc);
            holders.extend(makes_layer(&annotation).then_some(group));
        }
    }
    let mut layer = vec![None; drawing.groups.len()];
    for group in holders {
        layer[group] = Some(0);
    }
    spread(drawing, &mut layer);
    layer.iter().map(Option::is_some).collect()
}

/// Gives every group without a layer of its own that of the group it is in.
fn spread(drawing: &Drawing, layer: &mut [Option<usize>]) {
    for (index, group) in drawing.groups.iter().enumerate() {
        layer[index] = layer[index].or(layer[group.parent]);
    }
}

fn makes_layer(annotation: &Annotation) -> bool {
    matches!(annotation, Annotation::Part(part) if has_tiles(part))
}

fn has_tiles(part: &ast::Part) -> bool {
    let mut attributes = part.attributes.iter();
    attributes.any(|attribute| attribute.keyword == Keyword::Tiles)
}

/// Finds the tile layers, before anything is bound.
pub(super) fn find(drawing: &Drawing, bindings: &mut Bindings, diagnostics: &mut Vec<Diagnostic>) {
    let mut layer: Vec<Option<usize>> = vec![None; drawing.groups.len()];
    let mut layers: Vec<TileLayer> = Vec::new();
    for (index, string) in bindings.strings.iter().enumerate() {
        let Annotation::Part(annotation) = &string.annotation else {
            continue;
        };
        if !has_tiles(annotation) {
            continue;
        }
        let group = match string.place {
            Place::Label(label) => drawing.labels[label].1,
            Place::Shape(shape) => drawing.shapes[shape].group,
            Place::Group(group) => group,
        };
        if let Some(first) = layer[group] {
            let other: &TileLayer = &layers[first];
            let element = &drawing.groups[group].element;
            diagnostics.push(
                Diagnostic::new(
                    Code::TwoStrings,
                    string.text.whole(),
                    format!(
                        "this string and another one make the same group a tile layer, {}",
                        element.describe()
                    ),
                )
                .related(
                    bindings.strings[other.string].text.whole(),
                    "the other string, which counts",
                )
                .related(element.span, "the group")
                .help(
                    "delete one of them, or put each into the group or layer that contains its tiles",
                ),
            );
            continue;
        }
        layer[group] = Some(layers.len());
        let name = annotation.name.as_ref().map(|name| name.text.clone());
        let named_by = match string.place {
            Place::Shape(shape) => &drawing.shapes[shape].element,
            _ => &drawing.groups[group].element,
        };
        let name = name.unwrap_or_else(|| match named_by.own_name() {
            "" => NAMELESS.to_owned(),
            own => own.to_owned(),
        });
        layers.push(TileLayer {
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
    /// Index of the innermost tile layer that a group is, or is in.
    pub fn layer_of_group(&self, group: usize) -> Option<usize> {
        self.layer_of_group.get(group).copied().flatten()
    }

    /// Whether a shape is a picture in a tile layer, and so no part.
    pub fn is_picture_of_tiles(&self, drawing: &Drawing, shape: usize) -> bool {
        let shape = &drawing.shapes[shape];
        let is_picture = matches!(shape.paint.key, PaintKey::Picture(_));
        is_picture && self.layer_of_group(shape.group).is_some()
    }

    /// Whether a string takes a picture out of its tile layer: pictures are no parts there, to which it could belong.
    pub(super) fn leaves_picture_out(&self, drawing: &Drawing, string: usize) -> bool {
        let string = &self.strings[string];
        let Place::Shape(shape) = string.place else {
            return false;
        };
        string.annotation == Annotation::Unused && self.is_picture_of_tiles(drawing, shape)
    }

    /// The number that a tile layer's own string, or a `%` string, sets an attribute to.
    pub fn layer_number(&self, layer: usize, keyword: Keyword) -> Option<f64> {
        let own = self.strings[self.layers[layer].string].settings.iter();
        let own = own.filter(|setting| setting.keyword == keyword);
        let value = own.map(|setting| &setting.value).next();
        match value.or_else(|| self.drawing_value(keyword))? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }
}

/// Makes tiles of what lies in tile layers and has no string.
pub(super) fn classify(drawing: &Drawing, bindings: &mut Bindings) {
    if bindings.layers.is_empty() {
        return;
    }
    for index in 0..bindings.parts.len() {
        let Part { shape, main, .. } = bindings.parts[index];
        let unbound =
            bindings.parts[index].string.is_none() && bindings.parts[main].string.is_none();
        if unbound
            && bindings
                .layer_of_group(drawing.shapes[shape].group)
                .is_some()
        {
            bindings.parts[index].kind = PartKind::Tile;
        }
    }
}

/// Says where attributes of tile layers stand in strings that make none.
pub(super) fn misplaced(bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    for string in &bindings.strings {
        let (attributes, what) = match &string.annotation {
            Annotation::Part(part) if !has_tiles(part) => (&part.attributes, "a part's string"),
            Annotation::Legend(attributes) => (attributes, "a legend"),
            // What stands there holds for all tile layers.
            Annotation::Defaults(attributes) => (attributes, "a `%` string"),
            _ => continue,
        };
        let for_all = matches!(string.annotation, Annotation::Defaults(_));
        for attribute in attributes {
            let misplaced = match attribute.keyword {
                Keyword::Tiles => true,
                Keyword::Bevel | Keyword::Roof => !for_all || bindings.layers.is_empty(),
                _ => false,
            };
            if misplaced {
                let name = attribute.keyword.name();
                let message =
                    format!("`{name}` has no effect in {what}: it applies to tile layers");
                diagnostics.push(
                    Diagnostic::new(
                        Code::NoTileLayer,
                        string.text.span(attribute.range.clone()),
                        message,
                    )
                    .help("write it into the string that makes a layer or group a map, as in `Island$Tiles 16 Bevel 0.2`"),
                );
            }
        }
    }
}
