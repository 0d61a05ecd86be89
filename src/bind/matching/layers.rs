//! Layers: groups with a string of their own, such as a map of tiles.

use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::strings::ReadString;
use crate::bind::bindings::{Bindings, DrawingString, StringHolder, StringId};
use crate::diagnostic::{Code, Diagnostic};
use crate::index::index_type;
use crate::lang;
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::source::Text;
use crate::svg::{Drawing, GroupId, PaintKey, ShapeId};
use crate::threads::GRAIN;

index_type!(
    /// A layer of a drawing.
    pub LayerId
);

/// What a string makes of its group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerKind {
    /// A map of tiles: shapes in the group are tiles, not parts.
    Tiles,
    /// A character as seen from one side: shapes in the group are its regions, not parts.
    View,
    /// A key pose of a figure: what is drawn in the group are copies of parts, not shapes of the drawing.
    Pose,
    /// Tiles of one height, in a map.
    Level,
    /// Props: what is drawn in the group stands on the ground of a map.
    Stand,
}

/// The attributes that make a string a group string, each with the kind of its layer. Of several the first in this list counts. `Stand`
/// with a point is that of a prop.
const KINDS: [(Keyword, LayerKind); 5] = [
    (Keyword::Tiles, LayerKind::Tiles),
    (Keyword::View, LayerKind::View),
    (Keyword::Pose, LayerKind::Pose),
    (Keyword::Height, LayerKind::Level),
    (Keyword::Stand, LayerKind::Stand),
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
    /// Its string.
    pub string: StringId,
    /// Its group.
    pub group: GroupId,
}

/// The layers of a drawing, in the order of their strings.
#[derive(Debug, Default)]
pub struct Layers {
    all: TiVec<LayerId, Layer>,
    /// Per group the innermost tile layer, view or layer of props that it is, or is in; empty if there are no layers.
    of_group: TiVec<GroupId, Option<LayerId>>,
}

impl LayerKind {
    /// Whether shapes in the group are the layer's content: neither parts nor lines have a meaning of their own there.
    fn holds_content(self) -> bool {
        matches!(self, Self::Tiles | Self::View)
    }

    /// Whether shapes in the group belong to the layer: they are no parts of figures, and strings elsewhere do not mean them.
    fn encloses(self) -> bool {
        self.holds_content() || self == Self::Stand
    }

    /// The kind of layer that a string makes of its group, if it does.
    pub(in crate::bind) fn of(annotation: &Annotation) -> Option<Self> {
        let attributes = match annotation {
            Annotation::Part(part) => &part.attributes,
            // The copies say whose pose it is: it needs no name.
            Annotation::Legend(attributes) => {
                let mut keywords = attributes.iter().map(|attribute| attribute.keyword);
                let is_pose = keywords.any(|keyword| keyword == Keyword::Pose);
                return is_pose.then_some(Self::Pose);
            }
            _ => return None,
        };
        let is_set = |keyword| {
            let mut attributes = attributes.iter();
            attributes.any(|attribute| {
                let is_of_prop = keyword == Keyword::Stand && !attribute.arguments.is_empty();
                attribute.keyword == keyword && !is_of_prop
            })
        };
        let kind = KINDS.iter().find(|(keyword, _)| is_set(*keyword));
        kind.map(|(_, kind)| *kind)
    }
}

/// Whether a text makes a pose layer of the group that holds it; `is_desc` says whether it is a description.
pub fn makes_pose_layer(text: &Text, is_desc: bool) -> bool {
    if is_desc && !lang::describes(text.as_str()) {
        return false;
    }
    let container = if is_desc {
        lang::Container::Desc
    } else {
        lang::Container::Text
    };
    LayerKind::of(&lang::parse(text, container).0) == Some(LayerKind::Pose)
}

/// Whether the strings, as they are now, make the same pose layers as when the drawing was read.
pub(crate) fn has_same_pose_layers(drawing: &Drawing) -> bool {
    let labels = drawing.labels.iter();
    let labels = labels.filter(|(label, _)| makes_pose_layer(&label.text, false));
    let mut made: Vec<GroupId> = labels.map(|(_, group)| *group).collect();
    let groups = drawing.groups.iter_enumerated();
    made.extend(groups.filter_map(|(index, group)| {
        let desc = group.element.desc.as_ref()?;
        makes_pose_layer(desc, true).then_some(index)
    }));
    made.retain(|group| *group != GroupId::ROOT);
    let mut known = drawing.poses.layers.clone();
    made.sort_unstable();
    made.dedup();
    known.sort_unstable();
    made == known
}

/// Whether each group is a layer whose pictures are read pixel by pixel, or in one.
pub fn in_layers_of_pixels(drawing: &Drawing) -> TiVec<GroupId, bool> {
    let kind = |text, place| {
        let (annotation, _) = lang::parse(text, place);
        LayerKind::of(&annotation).filter(|kind| kind.encloses())
    };
    let labels = drawing.labels.par_iter().with_min_len(GRAIN);
    let of_labels = labels
        .filter_map(|(label, group)| Some((*group, kind(&label.text, lang::Container::Text)?)));
    let mut layer_groups: Vec<(GroupId, LayerKind)> = of_labels.collect();
    let groups = drawing.groups.iter_enumerated();
    let groups = groups.map(|(index, group)| (&group.element, index));
    let shapes = drawing.shapes.iter();
    let shapes = shapes.map(|shape| (&shape.element, shape.group));
    for (element, group) in groups.chain(shapes) {
        let desc = element.desc.as_deref();
        if let Some(text) = desc.filter(|text| lang::describes(text.as_str())) {
            layer_groups.extend(kind(text, lang::Container::Desc).map(|kind| (group, kind)));
        }
    }
    let mut layer = ti_vec![None; drawing.groups.len()];
    for (group, kind) in layer_groups {
        layer[group].get_or_insert(kind.holds_content());
    }
    spread(drawing, &mut layer);
    layer.iter().map(|holds| *holds == Some(true)).collect()
}

/// Gives every group without a layer of its own the layer of the group around it.
fn spread<L: Copy>(drawing: &Drawing, layer: &mut TiSlice<GroupId, Option<L>>) {
    for (index, group) in drawing.groups.iter_enumerated() {
        layer[index] = layer[index].or(layer[group.parent]);
    }
}

/// The group that holds a string.
pub(in crate::bind) fn group_of(drawing: &Drawing, holder: StringHolder) -> GroupId {
    match holder {
        StringHolder::Label(label) => drawing.labels[label].1,
        StringHolder::Shape(shape) => drawing.shapes[shape].group,
        StringHolder::Group(group) => group,
    }
}

/// Finds the layers, before anything is bound.
pub(super) fn find(
    drawing: &Drawing,
    strings: &TiSlice<StringId, ReadString>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Layers {
    let mut layer: TiVec<GroupId, Option<LayerId>> = ti_vec![None; drawing.groups.len()];
    let mut layers: TiVec<LayerId, Layer> = TiVec::new();
    for (index, string) in strings.iter_enumerated() {
        let Some(kind) = LayerKind::of(&string.annotation) else {
            continue;
        };
        let group = group_of(drawing, string.holder);
        if let Some(first) = layer[group].filter(|_| kind.encloses()) {
            let other: &Layer = &layers[first];
            let element = &drawing.groups[group].element;
            let message = format!(
                "this string and another one make the same group a layer, {}",
                drawing.describe_group(group)
            );
            diagnostics.push(
                Diagnostic::new(Code::TwoStrings, string.text.whole(), message)
                .related(
                    strings[other.string].text.whole(),
                    "the other string, which counts",
                )
                .related(element.span, "the group")
                .help(
                    "delete one of them, or put each into the group or layer that contains its shapes",
                ),
            );
            continue;
        }
        if kind.encloses() {
            layer[group] = Some(layers.next_key());
        }
        let name = match &string.annotation {
            Annotation::Part(part) => part.name.as_ref().map(|name| name.text.clone()),
            _ => None,
        };
        let named_by = match string.holder {
            StringHolder::Shape(shape) => &drawing.shapes[shape].element,
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
        });
    }
    if layers.is_empty() {
        return Layers::default();
    }
    if !layers.iter().any(|layer| layer.kind == LayerKind::Tiles) {
        // There is no ground to stand on: what would be props are parts.
        let is_stand = |layer: &LayerId| layers[*layer].kind == LayerKind::Stand;
        let of_group = layer
            .iter_mut()
            .filter(|layer| layer.as_ref().is_some_and(is_stand));
        of_group.for_each(|layer| *layer = None);
    }
    spread(drawing, &mut layer);
    Layers {
        all: layers,
        of_group: layer,
    }
}

impl std::ops::Deref for Layers {
    type Target = TiSlice<LayerId, Layer>;

    fn deref(&self) -> &Self::Target {
        &self.all
    }
}

impl Layers {
    /// The layers of a kind, each with its index.
    fn of_kind(&self, kind: LayerKind) -> impl Iterator<Item = (LayerId, &Layer)> {
        let layers = self.all.iter_enumerated();
        layers.filter(move |(_, layer)| layer.kind == kind)
    }

    /// The tile layers, each with its index.
    pub(in crate::bind) fn tile_layers(&self) -> impl Iterator<Item = (LayerId, &Layer)> {
        self.of_kind(LayerKind::Tiles)
    }

    /// The innermost tile layer, view or layer of props that a group is, or is in.
    pub(in crate::bind) fn of_group(&self, group: GroupId) -> Option<LayerId> {
        self.of_group.get(group).copied().flatten()
    }

    /// The same, if shapes are its content and no parts: a tile layer or a view.
    pub(in crate::bind) fn with_content(&self, group: GroupId) -> Option<LayerId> {
        let layer = self.of_group(group);
        layer.filter(|layer| self.all[*layer].kind.holds_content())
    }

    /// The layer of props that a group is, or is in.
    pub(in crate::bind) fn of_props(&self, group: GroupId) -> Option<LayerId> {
        self.of_group_and_kind(group, LayerKind::Stand)
    }

    /// The same, if that is of a kind.
    pub(in crate::bind) fn of_group_and_kind(
        &self,
        group: GroupId,
        kind: LayerKind,
    ) -> Option<LayerId> {
        let layer = self.of_group(group);
        layer.filter(|layer| self.all[*layer].kind == kind)
    }

    /// Whether a shape is a picture in a tile layer or a view, and so no part.
    pub(in crate::bind) fn hold_picture(&self, drawing: &Drawing, shape: ShapeId) -> bool {
        let shape = &drawing.shapes[shape];
        let is_picture = matches!(shape.paint.key, PaintKey::Picture(_));
        is_picture && self.with_content(shape.group).is_some()
    }

    /// The view whose picture a shape is; `None` if it is none.
    pub(super) fn view_of_picture(&self, drawing: &Drawing, shape: ShapeId) -> Option<LayerId> {
        let view = self.of_group_and_kind(drawing.shapes[shape].group, LayerKind::View);
        view.filter(|_| self.hold_picture(drawing, shape))
    }

    /// Whether a string excludes a picture from its tile layer. It cannot be bound, because such pictures are no parts.
    pub(in crate::bind) fn leave_picture_out(
        &self,
        drawing: &Drawing,
        string: &DrawingString,
    ) -> bool {
        let StringHolder::Shape(shape) = string.holder else {
            return false;
        };
        string.annotation == Annotation::Unused && self.hold_picture(drawing, shape)
    }
}

impl Bindings {
    /// The tile layers, each with its index.
    pub fn tile_layers(&self) -> impl Iterator<Item = (LayerId, &Layer)> {
        self.layers.tile_layers()
    }

    /// Per group the height that its own string or that of a group around it gives its tiles, with `Height`; the innermost counts.
    /// Empty if no group has one.
    pub(crate) fn levels_of_groups(&self, drawing: &Drawing) -> TiVec<GroupId, Option<i8>> {
        let levels = self.layers.of_kind(LayerKind::Level);
        let mut levels = levels.filter_map(|(index, layer)| {
            self.tile_layer_of_group(layer.group)?;
            Some((layer.group, self.layer_attributes(index).height()?.value))
        });
        let Some(first) = levels.next() else {
            return TiVec::new();
        };
        let mut of_group = ti_vec![None; drawing.groups.len()];
        for (group, height) in std::iter::once(first).chain(levels) {
            of_group[group] = Some(height);
        }
        spread(drawing, &mut of_group);
        of_group
    }

    /// The pose layers, each with its index.
    pub fn pose_layers(&self) -> impl Iterator<Item = (LayerId, &Layer)> {
        self.layers.of_kind(LayerKind::Pose)
    }

    /// The views of characters, each with its index.
    pub fn views(&self) -> impl Iterator<Item = (LayerId, &Layer)> {
        self.layers.of_kind(LayerKind::View)
    }

    /// Whether a group is a layer whose shapes are no ordinary parts, or is in one: a map, a view.
    pub fn is_in_layer(&self, group: GroupId) -> bool {
        self.layers.with_content(group).is_some()
    }

    /// The tile layer that a group is, or is in.
    pub fn tile_layer_of_group(&self, group: GroupId) -> Option<LayerId> {
        self.layers.of_group_and_kind(group, LayerKind::Tiles)
    }

    /// The view of a character that a group is, or is in.
    pub fn view_of_group(&self, group: GroupId) -> Option<LayerId> {
        self.layers.of_group_and_kind(group, LayerKind::View)
    }

    /// The view that a string is in.
    pub fn view_of_string(&self, drawing: &Drawing, string: StringId) -> Option<LayerId> {
        self.view_of_group(group_of(drawing, self.strings[string].holder))
    }

    /// Whether a shape is a picture in a tile layer or a view, and so no part.
    pub fn is_picture_of_layer(&self, drawing: &Drawing, shape: ShapeId) -> bool {
        self.layers.hold_picture(drawing, shape)
    }
}
