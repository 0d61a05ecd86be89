//! Shadows that are drawn on the ground: flat grey or dark ellipses below a figure's feet.
//!
//! A model stands on a ground of its own and throws a shadow there; the drawn one would be a plate at its feet.

use std::f64::consts::FRAC_PI_4;

use glam::DVec2;

use crate::anatomy::{Thing, thing};
use crate::bind::names;
use crate::geometry::{area, bounds};
use crate::svg::{Drawing, PaintKey, Shape, ShapeId};

/// An ellipse is flat if it is at most this high, in widths.
const FLAT: f64 = 0.4;
/// How far the area of an outline may be from that of the ellipse in its box, as a share of it.
const ELLIPTIC: f64 = 0.03;
/// The middle of a shadow is at most this far above and below the lowest point of what stands on it, as a share of that one's
/// height.
const ABOVE: f64 = 0.1;
const BELOW: f64 = 0.2;
/// A shadow is this wide at most and at least, in widths of what stands on it.
const WIDEST: f64 = 2.5;
const NARROWEST: f64 = 0.3;
/// The largest difference between the channels of a grey, 0 to 255.
const GREY: u8 = 24;
/// The brightest channel of a dark colour at most.
const DARK: u8 = 96;

/// Whether the first of these shapes, in paint order, is a shadow on the ground below the others.
pub(super) fn is_shadow(drawing: &Drawing, first: ShapeId, others: &[ShapeId]) -> bool {
    let shape = &drawing.shapes[first];
    let named = names::of_element(&shape.element, None);
    let is_shadow = named
        .as_ref()
        .map(|named| thing(&named.name) == Some(Thing::Shadow));
    let may_be = is_shadow.unwrap_or_else(|| is_dim(shape));
    may_be && is_flat_ellipse(shape) && stands_on(drawing, shape, others)
}

/// Whether the colour is one of a shadow: dark, grey, or one that shows what is below.
fn is_dim(shape: &Shape) -> bool {
    let [r, g, b] = shape.paint.color;
    let (least, most) = (r.min(g).min(b), r.max(g).max(b));
    let is_grey = most - least <= GREY && most < u8::MAX;
    !matches!(shape.paint.key, PaintKey::Picture(_))
        && (is_grey || most <= DARK || shape.opacity < 1.0)
        && shape.stroke.is_none()
}

fn is_flat_ellipse(shape: &Shape) -> bool {
    let Some((low, high)) = bounds(&shape.outline) else {
        return false;
    };
    let [polygon] = shape.outline.polygons.as_slice() else {
        return false;
    };
    let size = high - low;
    let whole = FRAC_PI_4 * size.element_product();
    polygon.rings.len() == 1
        && size.y <= FLAT * size.x
        && (area(&shape.outline) - whole).abs() <= ELLIPTIC * whole
}

/// Whether what else is drawn has its lowest points on a shape.
fn stands_on(drawing: &Drawing, shape: &Shape, others: &[ShapeId]) -> bool {
    let boxes = others
        .iter()
        .filter_map(|other| bounds(&drawing.shapes[*other].outline));
    let all = boxes.reduce(|(low, high), (a, b)| (low.min(a), high.max(b)));
    let (Some((low, high)), Some((own_low, own_high))) = (all, bounds(&shape.outline)) else {
        return false;
    };
    let (size, own): (DVec2, DVec2) = (high - low, own_high - own_low);
    let middle = own_low.midpoint(own_high);
    let is_below = (-ABOVE * size.y..=BELOW * size.y).contains(&(middle.y - high.y));
    let is_beside = middle.x < low.x || middle.x > high.x;
    is_below && !is_beside && (NARROWEST * size.x..=WIDEST * size.x).contains(&own.x)
}
