//! The world's axes, origin and scale: `Axes`, `Ground` and `Scale`.

use glam::{DMat3, DQuat, DVec2, DVec3};
use rayon::prelude::*;

use crate::bind::{Bindings, Part, PartKind};
use crate::lang::keyword::Keyword;
use crate::lang::value::{Ground, Value};
use crate::scene::WorldTransform;
use crate::svg::Drawing;
use crate::terrain::Layer;
use crate::threads::GRAIN;

/// Metres in a centimetre: one drawing unit is `Scale` centimetres.
const CENTIMETRE: f64 = 0.01;

/// How a drawing lies in the world.
pub(super) fn world_transform(
    drawing: &Drawing,
    bindings: &Bindings,
    layers: &[Layer],
) -> WorldTransform {
    let scale = match bindings.drawing_value(Keyword::Scale) {
        Some(Value::Number(scale)) => *scale,
        _ => 1.0,
    };
    WorldTransform {
        origin: origin(drawing, bindings, layers),
        rotation: axes(bindings),
        scale: scale * CENTIMETRE,
    }
}

/// The rotation from the drawing's right, its up and the viewer's direction to the world (`Axes`), which is
/// right-handed: other axes are refused where they are read.
fn axes(bindings: &Bindings) -> DQuat {
    let Some(Value::Axes(axes)) = bindings.drawing_value(Keyword::Axes) else {
        return DQuat::IDENTITY;
    };
    let [right, up, front] = axes.map(|axis| {
        let mut vector = [0.0; 3];
        vector[axis.axis] = if axis.negative { -1.0 } else { 1.0 };
        DVec3::from(vector)
    });
    DQuat::from_mat3(&DMat3::from_cols(right, up, front))
}

/// The point of the drawing that lies at the world's origin.
fn origin(drawing: &Drawing, bindings: &Bindings, layers: &[Layer]) -> DVec2 {
    match bindings.drawing_value(Keyword::Ground) {
        Some(Value::Ground(Ground::Page)) => drawing.page.0,
        Some(Value::Ground(Ground::Point([x, y]))) => DVec2::new(*x, *y),
        _ => {
            let is_built = |part: &&Part| matches!(part.kind, PartKind::Main | PartKind::Sub);
            let built = bindings
                .parts
                .par_iter()
                .with_min_len(GRAIN)
                .filter(is_built);
            let boxes = built.map(|part| part.measure.bounds);
            let both = |one: (DVec2, DVec2), other: (DVec2, DVec2)| {
                (one.0.min(other.0), one.1.max(other.1))
            };
            let landscapes = layers.iter().map(Layer::bounds);
            let landscapes = landscapes.map(|[low, high]| (low, high)).reduce(both);
            let all = boxes.reduce_with(both);
            let all = all.into_iter().chain(landscapes).reduce(both);
            all.map_or(DVec2::ZERO, |(low, high)| {
                DVec2::new((low.x + high.x) / 2.0, high.y)
            })
        }
    }
}
