//! Shapes that are translucent together: what one of them hides of another one must not show through it.
//!
//! In a drawing with clips a part keeps what parts that may move beside it hide of it: when they do, it is seen.

use super::super::FigureContext;
use super::Cover;
use super::nodes::Nodes;
use super::overlaps::Overlap;
use super::shapes::Shape;
use crate::svg::TransparencyGroupId;

/// Per shape those that hide parts of it although they are translucent, as all of a transparency group hide each other.
pub(super) fn hidden(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    nodes: &Nodes,
    overlaps: &[Vec<Overlap>],
    covers: &[Cover],
) -> Vec<Vec<usize>> {
    let mut hidden = vec![Vec::new(); shapes.len()];
    if context.drawing.transparency_groups.is_empty() {
        return hidden;
    }
    let groups: Vec<Option<TransparencyGroupId>> = shapes
        .iter()
        .map(|shape| opaque_in(context, shape))
        .collect();
    let hides = |one: usize, other: usize| {
        let other = context.drawing.shapes[context.bindings.parts[shapes[other].part].shape]
            .transparency_group;
        let pair = groups[one].zip(other);
        pair.is_some_and(|(group, other)| context.drawing.is_in_transparency_group(other, group))
    };
    let is_still = context.bindings.clip_requests().is_empty();
    let move_together = |above: usize, below: usize| {
        let [node, other] = [above, below].map(|shape| nodes.of_shape[shape]);
        is_still || covers[above].is_detail || node == other
    };
    for (above, below) in overlaps.iter().enumerate() {
        for below in below.iter().map(|overlap| overlap.below) {
            if shapes[above].is_given || shapes[below].is_given || !move_together(above, below) {
                continue;
            }
            for [one, other] in [[above, below], [below, above]] {
                if hides(one, other) {
                    hidden[other].push(one);
                }
            }
        }
    }
    hidden
}

/// The transparency group in which nothing can be seen through a shape, if there is one and no string sets its opacity.
pub(super) fn opaque_in(context: &FigureContext<'_>, shape: &Shape) -> Option<TransparencyGroupId> {
    let part = &context.bindings.parts[shape.part];
    let drawn = &context.drawing.shapes[part.shape];
    let [.., alpha] = context
        .bindings
        .material_factors(context.drawing, shape.part)
        .color;
    let stroke = drawn.stroke.as_ref().filter(|_| part.is_stroke);
    let is_opaque = drawn.is_opaque_in_group && stroke.is_none_or(|stroke| stroke.is_opaque);
    drawn
        .transparency_group
        .filter(|_| is_opaque && alpha == drawn.opacity)
}
