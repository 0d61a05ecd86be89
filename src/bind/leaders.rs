//! Lines that lead from a string to its part (figure.md, Binding, rule 3).

use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use rustc_hash::FxHashMap;

use super::bindings::{Bindings, Place};
use crate::geometry::contains;
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, Line};

type Box2 = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Pairs of a string and the part to which a line leads from it.
pub(super) fn find(
    drawing: &Drawing,
    bindings: &Bindings,
    part_of_shape: &[Option<usize>],
) -> Vec<(usize, usize)> {
    let lines: Vec<&Line> = drawing
        .shapes
        .iter()
        .filter_map(|shape| shape.line.as_deref())
        .collect();
    if lines.is_empty() || bindings.strings.is_empty() {
        return vec![];
    }
    let context = Context::new(drawing, bindings, part_of_shape);
    let mut bound: FxHashMap<usize, usize> = FxHashMap::default();
    let mut found = Vec::new();
    for line in lines {
        let pair = context.connected(line).or_else(|| {
            let [a, b] = line.ends;
            context.pair(a, b).or_else(|| context.pair(b, a))
        });
        if let Some((string, part)) = pair
            && bound.insert(string, part).is_none()
        {
            found.push((string, part));
        }
    }
    found
}

struct Context<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    part_of_shape: &'a [Option<usize>],
    strings: RTree<Box2>,
    parts: RTree<Box2>,
    reach: f64,
}

impl<'a> Context<'a> {
    fn new(
        drawing: &'a Drawing,
        bindings: &'a Bindings,
        part_of_shape: &'a [Option<usize>],
    ) -> Self {
        let mut reach = 0.0_f64;
        let mut boxes = Vec::new();
        for (index, string) in bindings.strings.iter().enumerate() {
            if let Place::Label(label) = string.place
                && string.wants_part()
                && string.binding.is_none()
            {
                let label = &drawing.labels[label].0;
                reach = reach.max(label.font_size);
                boxes.push(rectangle(label.bounds, index));
            }
        }
        let parts = bindings.parts.iter().enumerate();
        let parts = parts.map(|(index, part)| rectangle(part.measure.bounds, index));
        Self {
            drawing,
            bindings,
            part_of_shape,
            strings: RTree::bulk_load(boxes),
            parts: RTree::bulk_load(parts.collect()),
            reach,
        }
    }

    /// The string and the part that an Inkscape connector joins.
    fn connected(&self, line: &Line) -> Option<(usize, usize)> {
        let [Some(a), Some(b)] = &line.connects else {
            return None;
        };
        let string = |id: &str| {
            self.bindings
                .strings
                .iter()
                .position(|string| match string.place {
                    Place::Label(label) => {
                        string.wants_part()
                            && string.binding.is_none()
                            && self.drawing.labels[label].0.id.as_deref() == Some(id)
                    }
                    _ => false,
                })
        };
        let part = |id: &str| {
            let shape = self.drawing.shapes.iter().position(|shape| {
                shape.element.id.as_deref() == Some(id)
                    || self.drawing.groups[shape.group].element.id.as_deref() == Some(id)
            })?;
            self.part_of_shape[shape]
        };
        let pair = |from: &str, to: &str| Some((string(from)?, part(to)?));
        pair(a, b).or_else(|| pair(b, a))
    }

    /// The string at one point and the part at another.
    fn pair(&self, from: DVec2, to: DVec2) -> Option<(usize, usize)> {
        let string = self.string_at(from)?;
        let part = self.part_at(to, string)?;
        Some((string, part))
    }

    fn string_at(&self, point: DVec2) -> Option<usize> {
        let near = AABB::from_corners(
            (point - self.reach).to_array(),
            (point + self.reach).to_array(),
        );
        self.strings
            .locate_in_envelope_intersecting(near)
            .filter_map(|found| {
                let Place::Label(label) = self.bindings.strings[found.data].place else {
                    return None;
                };
                let label = &self.drawing.labels[label].0;
                let (low, high) = label.bounds;
                let distance = (point - point.clamp(low, high)).length();
                (distance <= label.font_size).then_some((distance, found.data))
            })
            .min_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal))
            .map(|(_, string)| string)
    }

    /// The topmost part at a point; for a string that names a part, the main part candidate of its node.
    fn part_at(&self, point: DVec2, string: usize) -> Option<usize> {
        let part = self
            .parts
            .locate_all_at_point([point.x, point.y])
            .map(|found| found.data)
            .filter(|part| contains(&self.bindings.parts[*part].outline, point))
            .max()?;
        match self.bindings.strings[string].annotation {
            Annotation::Legend(_) => Some(part),
            _ => Some(self.bindings.parts[part].main),
        }
    }
}

fn rectangle((low, high): (DVec2, DVec2), data: usize) -> Box2 {
    GeomWithData::new(
        Rectangle::from_corners(low.to_array(), high.to_array()),
        data,
    )
}
