//! The filled shapes of a drawing by their place, before they become parts.

use glam::DVec2;

use crate::geometry::{BoxTree, area_around, bounds, contains, distance_squared, indexed_box};
use crate::svg::{Drawing, ShapeId};

/// Filled shapes by their place.
pub(super) struct Fills<'a> {
    drawing: &'a Drawing,
    boxes: BoxTree<ShapeId>,
}

impl<'a> Fills<'a> {
    /// The filled shapes in front of the `behind` back-most ones.
    pub(super) fn in_front(drawing: &'a Drawing, behind: usize) -> Self {
        Self::of(drawing, drawing.shapes.keys().skip(behind))
    }

    /// Those of some shapes that are filled.
    pub(super) fn of(drawing: &'a Drawing, shapes: impl Iterator<Item = ShapeId>) -> Self {
        let bounds = |shape: ShapeId| bounds(&drawing.shapes[shape].outline);
        let boxes = shapes.filter_map(|shape| Some(indexed_box(bounds(shape)?, shape)));
        Self {
            drawing,
            boxes: BoxTree::bulk_load(boxes.collect()),
        }
    }

    /// The topmost shape at a point.
    pub(super) fn topmost(&self, point: DVec2) -> Option<ShapeId> {
        let found = self.boxes.locate_all_at_point([point.x, point.y]);
        let shapes = found.map(|found| found.data);
        shapes
            .filter(|shape| contains(&self.drawing.shapes[*shape].outline, point))
            .max()
    }

    /// The topmost shape at a point, or else the nearest one that is at most `reach` away.
    pub(super) fn nearest(&self, point: DVec2, reach: f64) -> Option<ShapeId> {
        self.topmost(point).or_else(|| {
            let around = area_around((point, point), reach);
            let near = self.boxes.locate_in_envelope_intersecting(around);
            let near = near.map(|found| {
                let outline = &self.drawing.shapes[found.data].outline;
                (distance_squared(outline, point), found.data)
            });
            let near = near.filter(|(distance, _)| *distance <= reach * reach);
            let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            nearest.map(|(_, shape)| shape)
        })
    }

    /// Whether a point is on a shape, or at most `reach` away from one.
    pub(super) fn is_near(&self, point: DVec2, reach: f64) -> bool {
        let around = area_around((point, point), reach);
        let mut found = self.boxes.locate_in_envelope_intersecting(around);
        found.any(|found| {
            let outline = &self.drawing.shapes[found.data].outline;
            distance_squared(outline, point) <= reach * reach
        })
    }
}
