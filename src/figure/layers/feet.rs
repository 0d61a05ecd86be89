//! Feet of figures that face the viewer: they point forward.
//!
//! A foot that is drawn from the front is a half disc or an oval; blown up like all else, it would end at the shin, and the figure
//! would stand on balls. Its toes reach forward instead, and what lies above them, where the leg goes into it, stays as it is.

use super::super::FigureContext;
use super::shapes::Shape;
use crate::bind::Seen;
use crate::solid::Profile;

/// How far a foot reaches forward, in its widths, and in its heights at most.
const FORWARD: f64 = 1.2;
const MOST: f64 = 2.0;
/// The width of a foot that is seen from the front, in its heights: higher ones are boots with a shaft, wider ones lie sideways.
const WIDTHS: std::ops::RangeInclusive<f64> = 0.6..=3.5;
/// Where toes begin and where they reach forward most, from the top, in heights of the foot.
const TOES: [f64; 2] = [0.2, 0.8];

/// The toes of a foot.
#[derive(Debug, Clone, Copy)]
pub(super) struct Toes {
    /// Where they begin and where they reach forward most: distances down the drawing, drawing units.
    pub(super) down: [f64; 2],
    /// How far they reach forward, drawing units.
    pub(super) reach: f64,
    /// Whether forward is away from the viewer.
    pub(super) away: bool,
}

/// The toes of a shape that is a foot without a `Shape` of its own, on a figure that is drawn from the front or from behind.
pub(super) fn toes(context: &FigureContext<'_>, shape: &Shape) -> Option<Toes> {
    let away = match context.seen[shape.main] {
        Seen::FromFront => false,
        Seen::FromBehind => true,
        Seen::InProfile | Seen::VehicleInProfile | Seen::Anyhow => return None,
    };
    let part = &context.bindings.parts[shape.part];
    let (low, high) = shape.bounds;
    let size = high - low;
    let is_foot = shape.is_named
        && !shape.is_ink
        && matches!(shape.profile, Profile::Inflate(_))
        && WIDTHS.contains(&(size.x / size.y))
        && !context.bindings.is_shape_set(shape.part)
        && part.is_foot();
    is_foot.then_some(Toes {
        down: TOES.map(|share| low.y + share * size.y),
        reach: (FORWARD * size.x).min(MOST * size.y),
        away,
    })
}
