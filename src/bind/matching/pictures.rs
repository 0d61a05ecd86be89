//! Strings that are about what a picture in a view shows. Its regions are found only when the characters are, so that their strings wait
//! until then.

use std::collections::BTreeMap;

use typed_index_collections::TiSlice;

use super::fills::Fills;
use super::layers::{LayerId, LayerKind, Layers};
use super::leaders::Leaders;
use super::strings::ReadString;
use crate::bind::bindings::{StringHolder, StringId};
use crate::lang::ast::Annotation;
use crate::svg::Drawing;

/// Marks the strings of pictures in views: their descriptions, and the texts that lie or whose leaders end on a picture rather than on a
/// shape, or nearer to one.
pub(super) fn mark(
    drawing: &Drawing,
    strings: &mut TiSlice<StringId, ReadString>,
    layers: &Layers,
    leaders: &Leaders,
) {
    let view = |group| layers.of_group_and_kind(group, LayerKind::View);
    // Per view with a picture all its fills.
    let mut fills: BTreeMap<LayerId, Fills<'_>> = BTreeMap::new();
    for shape in drawing.shapes.keys() {
        if let Some(layer) = layers.view_of_picture(drawing, shape) {
            fills.entry(layer).or_insert_with(|| {
                let all = drawing.shapes.iter_enumerated();
                let own = all.filter(|(_, shape)| view(shape.group) == Some(layer));
                Fills::of(drawing, own.map(|(index, _)| index))
            });
        }
    }
    if fills.is_empty() {
        return;
    }
    let is_picture = |shape| layers.view_of_picture(drawing, shape).is_some();
    for (index, string) in strings.iter_mut_enumerated() {
        let names = string.wants_part() && matches!(string.annotation, Annotation::Part(_));
        string.is_of_picture = names
            && match string.holder {
                StringHolder::Group(_) => false,
                StringHolder::Shape(shape) => is_picture(shape),
                StringHolder::Label(label) => {
                    let (label, group) = &drawing.labels[label];
                    let fills = view(*group).and_then(|layer| fills.get(&layer));
                    let meant = fills.and_then(|fills| {
                        let led_to = leaders.points.get(&index).copied();
                        let point = led_to.unwrap_or(label.position.points[1]);
                        fills.nearest(point, f64::INFINITY)
                    });
                    meant.is_some_and(is_picture)
                }
            };
    }
}
