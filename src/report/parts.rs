//! The parts of a drawing.

use std::collections::BTreeMap;

use glam::DVec2;
use serde::Serialize;

use super::depths::depth_reason;
use super::drivers;
use crate::bind::{self, DrawingString, PartKind, SetBy};
use crate::compile::Compiled;
use crate::source::LineIndex;
use crate::terrain::Layer;

/// A part. Coordinates are drawing units, y down.
#[derive(Debug, Clone, Serialize)]
pub struct Part<'a> {
    /// Its name.
    pub name: &'a str,
    /// Where its name is from: `string`, `label`, `id`, `automatic`; `None` for parts that are not in the hierarchy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub named_by: Option<&'static str>,
    /// The name of its parent; `None` for the root.
    pub parent: Option<&'a str>,
    /// `main`, `sub`, `legend` or `unused`; `terrain` in [`landscapes`], `character` and `region` in
    /// [`characters`](super::characters).
    pub kind: &'static str,
    /// For ink, the name of the part on which it lies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ink_on: Option<&'a str>,
    /// The `id` of its element.
    pub element: Option<&'a str>,
    /// Its string.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub string: Option<StringReport<'a>>,
    /// The centroid of its area.
    pub center: [f64; 2],
    /// The end points of its axis.
    pub ends: [[f64; 2]; 2],
    /// Its joint.
    pub origin: [f64; 2],
    /// The direction of its axis.
    pub axis: [f64; 2],
    /// For a main part, how far its plane lies in front of the drawing's, drawing units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
    /// Why it lies there; `None` for a part in the plane of what it hangs on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_why: Option<String>,
    /// All attributes that are set, and those that every solid has.
    pub attributes: BTreeMap<&'static str, AttributeReport>,
    /// The joint that drives it in the first clip that does.
    pub joint: Option<&'a str>,
    /// Why that joint, or why none; `None` for parts of figures without clips.
    pub joint_why: Option<&'a str>,
}

/// A string. Lines and columns count from 1, columns in characters.
#[derive(Debug, Clone, Serialize)]
pub struct StringReport<'a> {
    /// Its line.
    pub line: usize,
    /// Its column.
    pub column: usize,
    /// Its characters.
    pub text: &'a str,
    /// The rule by which it is bound to its part.
    pub bound_by: &'static str,
    /// For an uncertain binding, the other shape that it may mean.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub may_mean: Option<String>,
}

/// An attribute.
#[derive(Debug, Clone, Serialize)]
pub struct AttributeReport {
    /// Its value, variables resolved.
    pub value: String,
    /// `own`, `legend`, `default` or `builtin`.
    pub from: &'static str,
}

impl<'a> Part<'a> {
    /// A part without anything that only parts of figures have.
    pub(super) fn plain(name: &'a str, kind: &'static str, center: DVec2) -> Self {
        let center = center.to_array();
        Self {
            name,
            named_by: None,
            parent: None,
            kind,
            ink_on: None,
            element: None,
            string: None,
            center,
            ends: [center; 2],
            origin: center,
            axis: [1.0, 0.0],
            depth: None,
            depth_why: None,
            attributes: BTreeMap::new(),
            joint: None,
            joint_why: None,
        }
    }
}

/// The parts of a drawing, in paint order.
pub fn parts<'a>(compiled: &'a Compiled, text: &'a str) -> Vec<Part<'a>> {
    let bindings = &compiled.bindings;
    let lines = LineIndex::new(text);
    let drivers = drivers(compiled);
    let parts = bindings.parts.iter().enumerate();
    let parts = parts.filter(|(_, part)| !matches!(part.kind, PartKind::Tile | PartKind::Region));
    let report = |(index, part): (usize, &'a bind::Part)| Part {
        name: own_name(compiled, part),
        named_by: (part.kind == PartKind::Main).then(|| part.named_by.name()),
        parent: match part.kind {
            PartKind::Main => part
                .parent
                .map(|parent| bindings.parts[parent].name.as_str()),
            _ => (part.main != index).then(|| own_name(compiled, &bindings.parts[part.main])),
        },
        kind: part.kind.name(),
        ink_on: part
            .host
            .map(|host| own_name(compiled, &bindings.parts[host])),
        element: compiled.drawing.shapes[part.shape].element.id.as_deref(),
        string: part.string.map(|string| {
            let string = &bindings.strings[string];
            string_report(compiled, string, &lines)
        }),
        center: part.measure.center.to_array(),
        ends: part.measure.ends.map(|end| end.to_array()),
        origin: part.origin.to_array(),
        axis: part.measure.axis.to_array(),
        depth: compiled.depths[index].map(|node| node.depth),
        depth_why: depth_reason(compiled, index),
        attributes: attributes(compiled, index),
        joint: drivers[index].and_then(|driver| driver.joint),
        joint_why: drivers[index].map(|driver| driver.why),
    };
    parts.map(report).collect()
}

/// The number of parts in the model of a drawing, as every command and page counts them: main parts, landscapes and the regions of
/// characters. Sub-parts, which are solids of a main part, and copies do not count.
pub fn part_count(compiled: &Compiled) -> usize {
    let parts = compiled.bindings.parts.iter();
    let main = parts.filter(|part| part.kind == PartKind::Main).count();
    let regions = compiled.characters.iter();
    let regions = regions.map(|character| character.regions.len());
    main + compiled.layers.len() + regions.sum::<usize>()
}

/// The landscapes of a drawing as parts of the kind `terrain`, for lists of everything in the model.
pub fn landscapes<'a>(compiled: &'a Compiled, text: &'a str) -> Vec<Part<'a>> {
    let (bindings, lines) = (&compiled.bindings, LineIndex::new(text));
    let report = |layer: &'a Layer| {
        let [low, high] = layer.bounds();
        let (center, middle) = ((low + high) / 2.0, (low.y + high.y) / 2.0);
        let string = &bindings.strings[layer.string];
        let settings = string.settings.iter().map(|setting| {
            let report = AttributeReport {
                value: setting.text.clone(),
                from: SetBy::Own.name(),
            };
            (setting.keyword.name(), report)
        });
        Part {
            parent: layer.parent.map(|part| bindings.parts[part].name.as_str()),
            element: compiled.drawing.groups[layer.group].element.id.as_deref(),
            string: Some(string_report(compiled, string, &lines)),
            ends: [[low.x, middle], [high.x, middle]],
            attributes: settings.collect(),
            ..Part::plain(&layer.name, "terrain", center)
        }
    };
    compiled.layers.iter().map(report).collect()
}

fn string_report<'a>(
    compiled: &Compiled,
    string: &'a DrawingString,
    lines: &LineIndex<&str>,
) -> StringReport<'a> {
    let (line, column) = lines.line_column(string.text.whole().start);
    StringReport {
        line,
        column,
        text: string.text.as_str(),
        bound_by: string.binding.map_or("none", |binding| binding.by.name()),
        may_mean: string.runner_up.map(|part| {
            let shape = compiled.bindings.parts[part].shape;
            compiled.drawing.describe(shape)
        }),
    }
}

/// A part's name; the name of its element for sub-parts, legends and unused parts without one.
pub fn own_name<'a>(compiled: &'a Compiled, part: &'a bind::Part) -> &'a str {
    if part.name.is_empty() {
        compiled.drawing.shapes[part.shape].element.own_name()
    } else {
        &part.name
    }
}

fn attributes(compiled: &Compiled, part: usize) -> BTreeMap<&'static str, AttributeReport> {
    let resolved = compiled.bindings.resolved(&compiled.drawing, part);
    let reports = resolved.into_iter().map(|attribute| {
        let report = AttributeReport {
            value: attribute.value,
            from: attribute.from.name(),
        };
        (attribute.keyword.name(), report)
    });
    reports.collect()
}
