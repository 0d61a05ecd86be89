//! Lines that lead from a string to what it names.

use std::cell::LazyCell;

use glam::DVec2;
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiSlice;

use super::fills::Fills;
use super::layers::Layers;
use super::node_groups::NodeGroups;
use super::stacking::ground_count;
use super::strings::ReadString;
use crate::bind::bindings::{Bindings, StringHolder, StringId};
use crate::geometry::{BoxTree, area_around, indexed_box};
use crate::svg::{Drawing, Shape, ShapeId};

/// The widest leader, font sizes.
const MAX_WIDTH: f64 = 0.25;
/// The shortest leader, and the least length of it that lies on no shape, font sizes.
const MIN_LENGTH: f64 = 1.0;
/// How far from a string's box a leader begins at most, and how far from a shape it ends, font sizes.
const REACH: f64 = 1.0;
/// How far from a string's box a line begins at most that may be meant as its leader, font sizes.
const FAR_REACH: f64 = 2.5;
/// By what share a string's box is made wider: its width is an estimate, and most fonts are wider for some words.
const WIDER: f64 = 0.15;
/// How finely a leader is sampled to find how much of it lies on no shape, font sizes.
const SAMPLE: f64 = 0.1;
/// Limit of the samples.
const MAX_SAMPLES: f64 = 1000.0;

/// The leaders of a drawing.
#[derive(Debug, Default)]
pub(in crate::bind) struct Leaders {
    /// Strings, each with the point that its leader leads to.
    pub(super) points: FxHashMap<StringId, DVec2>,
    /// Strings and shapes that an Inkscape connector joins.
    pub(super) connected: Vec<(StringId, ShapeId)>,
    /// The shapes that are leaders, ascending.
    pub(super) shapes: Vec<ShapeId>,
    /// Other thin lines that begin at a string, ascending: perhaps meant as leaders, but too far away, too short, or within one unit.
    doubtful: Vec<ShapeId>,
}

impl Leaders {
    /// Finds the lines that lead from a string to something else.
    pub(super) fn find(
        drawing: &Drawing,
        strings: &TiSlice<StringId, ReadString>,
        node_groups: &NodeGroups,
        layers: &Layers,
    ) -> Self {
        let has_line = |shape: &Shape| shape.line.is_some();
        let mut leaders = Self::default();
        if strings.is_empty() || !drawing.shapes.iter().any(has_line) {
            return leaders;
        }
        let strings = Labels::new(drawing, strings);
        // The ground lies under everything. What is drawn in a picture of a view is not known yet: lines lead over it.
        let is_picture = |shape: &ShapeId| layers.view_of_picture(drawing, *shape).is_some();
        let fills = LazyCell::new(|| {
            let outlines = drawing.shapes.iter().map(|shape| &*shape.outline);
            let ground = ground_count(outlines, drawing.page);
            let shapes = drawing.shapes.keys().skip(ground);
            Fills::of(drawing, shapes.filter(|shape| !is_picture(shape)))
        });
        let pictures = LazyCell::new(|| {
            let shapes = drawing.shapes.keys();
            Fills::of(drawing, shapes.filter(is_picture))
        });
        let mut bound = FxHashSet::default();
        for (index, shape) in drawing.shapes.iter_enumerated() {
            let Some(line) = &shape.line else { continue };
            if let Some((string, shape)) = strings.connected(&line.connects) {
                if bound.insert(string) {
                    leaders.connected.push((string, shape));
                }
                leaders.shapes.push(index);
                continue;
            }
            let [a, b] = line.ends;
            let at = |point| strings.at(point, REACH);
            let (string, from, to) = match (at(a), at(b)) {
                (Some(string), None) => (string, a, b),
                (None, Some(string)) => (string, b, a),
                // A line between two strings, or one that begins at none, leads from nothing.
                _ => {
                    let near = |point| strings.at(point, FAR_REACH);
                    if let Some(string) = near(a).xor(near(b))
                        && is_thin(shape, strings.em(string))
                    {
                        leaders.doubtful.push(index);
                    }
                    continue;
                }
            };
            let em = strings.em(string);
            let is_leader = is_thin(shape, em)
                && leads(shape, em, &fills)
                // A guide that only begins beside a string leads nowhere.
                && (fills.is_near(to, REACH * em) || pictures.is_near(to, REACH * em))
                && !in_one_unit(drawing, &fills, node_groups, [from, to]);
            if is_leader {
                leaders.shapes.push(index);
                if bound.insert(string) {
                    leaders.points.insert(string, to);
                }
            } else if is_thin(shape, em) {
                leaders.doubtful.push(index);
            }
        }
        leaders
    }

    /// Whether a shape is a line that leads from a string to what it means.
    pub(in crate::bind) fn leads(&self, shape: ShapeId) -> bool {
        self.shapes.binary_search(&shape).is_ok()
    }

    /// Whether a line begins at a string as a leader does, although it leads nowhere.
    pub(super) fn may_be_meant(&self, shape: ShapeId) -> bool {
        self.doubtful.binary_search(&shape).is_ok()
    }
}

impl Bindings {
    /// Whether a shape is a line that leads from a string to what it means.
    pub fn is_leader(&self, shape: ShapeId) -> bool {
        self.leaders.leads(shape)
    }

    /// The points on the page, user units, of which one is meant by a string's place: the end of its leader, or the beginning, the
    /// middle and the end of its text. `None` for a string that is no text.
    pub fn points_of_string(&self, drawing: &Drawing, string: StringId) -> Option<[DVec2; 3]> {
        let StringHolder::Label(label) = self.strings[string].holder else {
            return None;
        };
        let led_to = self.leaders.points.get(&string).map(|point| [*point; 3]);
        Some(led_to.unwrap_or(drawing.labels[label].0.position.points))
    }
}

/// Whether a line is thin enough for a leader.
fn is_thin(shape: &Shape, em: f64) -> bool {
    let mut stroke = shape.stroke.iter();
    stroke.any(|stroke| stroke.width() <= MAX_WIDTH * em)
}

/// Whether a line is long enough for a leader, and lies on no shape for long enough.
fn leads(shape: &Shape, em: f64, fills: &Fills<'_>) -> bool {
    let Some(stroke) = &shape.stroke else {
        return false;
    };
    let mut edges = Vec::new();
    stroke.middle_line(SAMPLE * em, |a, b| edges.push((a, b, a.distance(b))));
    let length: f64 = edges.iter().map(|edge| edge.2).sum();
    if length < MIN_LENGTH * em {
        return false;
    }
    let step = (SAMPLE * em).max(length / MAX_SAMPLES);
    let mut free = 0.0;
    for (a, b, length) in edges {
        let count = (length / step).ceil().max(1.0);
        for sample in 0..count as usize {
            let at = a.lerp(b, (sample as f64 + 0.5) / count);
            if fills.topmost(at).is_none() {
                free += length / count;
            }
        }
        if free >= MIN_LENGTH * em {
            return true;
        }
    }
    false
}

/// The strings that leaders can begin at.
struct Labels<'a> {
    drawing: &'a Drawing,
    strings: &'a TiSlice<StringId, ReadString>,
    boxes: BoxTree<StringId>,
    reach: f64,
}

impl<'a> Labels<'a> {
    fn new(drawing: &'a Drawing, strings: &'a TiSlice<StringId, ReadString>) -> Self {
        let mut reach = 0.0_f64;
        let mut boxes = Vec::new();
        for (index, string) in strings.iter_enumerated() {
            if let StringHolder::Label(label) = string.holder
                && string.means_a_place()
            {
                let label = &drawing.labels[label].0;
                reach = reach.max(FAR_REACH * label.font_size);
                let (low, high) = label.position.bounds;
                let wider = DVec2::new(WIDER * (high.x - low.x), 0.0);
                boxes.push(indexed_box((low, high + wider), index));
            }
        }
        Self {
            drawing,
            strings,
            boxes: BoxTree::bulk_load(boxes),
            reach,
        }
    }

    fn em(&self, string: StringId) -> f64 {
        match self.strings[string].holder {
            StringHolder::Label(label) => self.drawing.labels[label].0.font_size,
            StringHolder::Shape(_) | StringHolder::Group(_) => 0.0,
        }
    }

    /// The string at the end of a line: the nearest, if it is at most so many of its font sizes away.
    fn at(&self, point: DVec2, reach: f64) -> Option<StringId> {
        let near = area_around((point, point), self.reach);
        let found = self.boxes.locate_in_envelope_intersecting(near);
        let near = found.filter_map(|found| {
            let area = found.geom();
            let (low, high) = (DVec2::from(area.lower()), DVec2::from(area.upper()));
            let distance = point.distance(point.clamp(low, high));
            let string = found.data;
            (distance <= reach * self.em(string)).then_some((distance, string))
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map(|(_, string)| string)
    }

    /// The string and the shape that an Inkscape connector joins.
    fn connected(&self, connects: &[Option<String>; 2]) -> Option<(StringId, ShapeId)> {
        let [Some(a), Some(b)] = connects else {
            return None;
        };
        let string = |id: &str| {
            let mut strings = self.strings.iter_enumerated();
            let found = strings.find(|(_, string)| match string.holder {
                StringHolder::Label(label) => {
                    string.means_a_place() && self.drawing.labels[label].0.id.as_deref() == Some(id)
                }
                _ => false,
            });
            found.map(|(string, _)| string)
        };
        let shape = |id: &str| {
            self.drawing.shapes.position(|shape| {
                shape.element.id.as_deref() == Some(id)
                    || self.drawing.groups[shape.group].element.id.as_deref() == Some(id)
            })
        };
        let pair = |from: &str, to: &str| Some((string(from)?, shape(to)?));
        pair(a, b).or_else(|| pair(b, a))
    }
}

/// Whether two points lie on the same shape, or on the same group of shapes.
fn in_one_unit(
    drawing: &Drawing,
    fills: &Fills<'_>,
    node_groups: &NodeGroups,
    points: [DVec2; 2],
) -> bool {
    let [Some(a), Some(b)] = points.map(|point| fills.topmost(point)) else {
        return false;
    };
    let group = |shape: ShapeId| node_groups.outermost(drawing.shapes[shape].group);
    a == b || group(a).is_some_and(|group_of_a| Some(group_of_a) == group(b))
}
