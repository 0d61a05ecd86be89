//! Outlines around soft volumes: cords along the silhouette, as deep as they are wide, like the piping of a cushion.
//!
//! A band that is painted on the steep border of a soft volume looks as deep as the volume is there, however thin the line was
//! drawn. A volume with an outline therefore ends where the line begins, and the line becomes a tube around it. From the front
//! both look as drawn.

use std::sync::Arc;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::super::FigureContext;
use super::shapes::Shape;
use super::transparency::opaque_in;
use crate::bind::PartId;
use crate::geometry::{Outline, area, subtract};
use crate::solid::Profile;
use crate::threads::GRAIN;

/// The share of its area that is left of a volume within its outline, at least.
const LEFT: f64 = 0.2;
/// Limit of the points of an outline and its stroke.
const MAX_POINTS: usize = 20_000;

/// Makes cords of the strokes around soft volumes, and lets the volumes end there. `is_detail` says per shape whether it lies on
/// others.
pub(super) fn lay(context: &FigureContext<'_>, shapes: &mut [Shape], is_detail: &[bool]) {
    let strokes = shapes.iter().enumerate().filter(|(_, shape)| shape.is_ink);
    if strokes.clone().next().is_none() {
        return;
    }
    let place: FxHashMap<PartId, usize> = shapes
        .iter()
        .enumerate()
        .map(|(index, shape)| (shape.part, index))
        .collect();
    let around = |(index, stroke): (usize, &Shape)| {
        let host = *place.get(&context.bindings.parts[stroke.part].host?)?;
        if is_detail[host] || !is_balloon(&shapes[host]) {
            return None;
        }
        Some((
            [index, host],
            outline_width(context, stroke, &shapes[host])?,
        ))
    };
    let pairs: Vec<([usize; 2], f64)> = strokes.filter_map(around).collect();
    let narrowed = pairs.par_iter().with_min_len(GRAIN);
    let narrowed = narrowed.map(|([stroke, host], _)| {
        let [stroke, host] = [*stroke, *host].map(|shape| &*shapes[shape].outline);
        without(host, stroke)
    });
    let narrowed: Vec<Option<Outline>> = narrowed.collect();
    for (([stroke, host], width), inner) in pairs.into_iter().zip(narrowed) {
        let Some(inner) = inner else { continue };
        shapes[host].solid_outline = Arc::new(inner);
        shapes[stroke].profile = Profile::cord(width);
        shapes[stroke].is_cord = true;
    }
}

/// Whether a shape is blown up without a depth of its own.
fn is_balloon(shape: &Shape) -> bool {
    matches!(shape.profile, Profile::Inflate(_))
        && !shape.is_given
        && !shape.is_ink
        // A box has walls, and no border that a cord could lie along.
        && shape.of_vehicle.is_none()
}

/// The width of ink that is the stroke of the shape that it lies on, without gaps, and that nothing can be seen through.
fn outline_width(context: &FigureContext<'_>, stroke: &Shape, host: &Shape) -> Option<f64> {
    let [own, filled] = [stroke, host].map(|shape| &context.bindings.parts[shape.part]);
    let source = context.drawing.shapes[own.shape].stroke.as_ref()?;
    let is_outline = own.shape == filled.shape
        && own.is_stroke
        && context.bindings.form(stroke.part) == host.part
        && host.is_outlined
        && !source.is_dashed()
        && (context.is_opaque(stroke.part) || opaque_in(context, stroke).is_some());
    is_outline.then(|| source.width())
}

/// What is left of an outline beside a stroke around it, if that is enough of it.
fn without(outline: &Outline, stroke: &Outline) -> Option<Outline> {
    let points = outline.point_count() + stroke.point_count();
    if points > MAX_POINTS {
        return None;
    }
    let inner = subtract(outline, stroke);
    (area(&inner) >= LEFT * area(outline)).then_some(inner)
}
