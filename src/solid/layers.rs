//! The stack of scaled copies that a kind of shape stands for (language.md, Shapes).

use glam::DVec2;

use super::{Options, inflate, lathe};
use crate::lang::value::ShapeKind;

/// Scales below this are 0: the copy is a line or a point.
pub(super) const LEAST: f64 = 1e-3;
/// The least thickness, relative to the larger extent.
pub(super) const THIN: f64 = 1e-4;
/// Layers per 180°, from the fewest that have any volume to more than can be seen.
const SEGMENTS: std::ops::RangeInclusive<u32> = 2..=512;

/// Steps of a half turn as they are built.
pub(super) fn steps_per_half_turn(options: &Options) -> u32 {
    options.segments.clamp(*SEGMENTS.start(), *SEGMENTS.end())
}

/// A copy of the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Layer {
    /// Scale across the axis.
    pub(super) across: f64,
    /// Scale along the axis.
    pub(super) along: f64,
    /// Depth, drawing units.
    pub(super) z: f64,
}

/// How deep a solid reaches to the back and to the front, drawing units, for an outline with these half
/// extents; `None` where there is no solid. A turn is taken to reach as far as the outline does.
pub fn depths(
    kind: &ShapeKind,
    half_across: f64,
    half_along: f64,
    options: &Options,
) -> Option<[f64; 2]> {
    match *kind {
        ShapeKind::Inflate(given) => {
            let height = inflate::height(given, DVec2::new(half_across, half_along));
            Some([-height, height])
        }
        ShapeKind::Lathe(degrees) => {
            let side = (lathe::turn(degrees) / 2.0).to_radians();
            Some([half_across * side.cos().min(0.0), half_across])
        }
        _ => {
            let layers = layers(kind, half_across, half_along, options)?;
            Some([layers.first()?.z, layers.last()?.z])
        }
    }
}

/// The layers of a kind, by rising depth; `None` where there is no solid or it is no stack. Only the first
/// and the last may have a scale of 0. A solid always has some thickness, if only a little.
pub(super) fn layers(
    kind: &ShapeKind,
    half_across: f64,
    half_along: f64,
    options: &Options,
) -> Option<Vec<Layer>> {
    let least = (THIN * 2.0 * half_across.max(half_along)).max(f64::MIN_POSITIVE);
    let whole = |z| Layer {
        across: 1.0,
        along: 1.0,
        z,
    };
    let round = |angles: [f64; 2], radius: f64, scale: fn(f64) -> [f64; 2]| {
        let layer = |t: f64| {
            let [across, along] = scale(snap(t.to_radians().cos()));
            let z = radius * t.to_radians().sin();
            Layer { across, along, z }
        };
        steps(angles, steps_per_half_turn(options))
            .map(layer)
            .collect()
    };
    let cone = |[z0, z1, top]: [f64; 3], scale: fn(f64) -> [f64; 2]| {
        let top = snap(finite(top));
        let [across, along] = scale(top);
        let z = finite(z1);
        vec![whole(finite(z0)), Layer { across, along, z }]
    };
    let mut layers: Vec<Layer> = match *kind {
        ShapeKind::None | ShapeKind::Inflate(_) | ShapeKind::Lathe(_) => return None,
        ShapeKind::Flat(z) => return Some(vec![whole(finite(z))]),
        ShapeKind::Default(Some(z)) => z.map(finite).map(whole).to_vec(),
        ShapeKind::Default(None) | ShapeKind::Model(_) => {
            options.thickness.map(finite).map(whole).to_vec()
        }
        ShapeKind::RoundV(angles) => round(angles, half_across, |s| [s, 1.0]),
        ShapeKind::RoundH(angles) => round(angles, half_along, |s| [1.0, s]),
        ShapeKind::Round(angles, radius) => {
            let radius = radius.map(|r| finite(r).abs());
            let radius = radius.unwrap_or(half_across.min(half_along));
            round(angles, radius.max(least), |s| [s, s])
        }
        ShapeKind::Cone(z) => cone(z, |s| [s, s]),
        ShapeKind::ConeV(z) => cone(z, |s| [s, 1.0]),
        ShapeKind::ConeH(z) => cone(z, |s| [1.0, s]),
    };
    if let [first, .., last] = &layers[..]
        && first.z > last.z
    {
        layers.reverse();
    }
    if let [first, .., last] = &mut layers[..]
        && last.z - first.z < least
    {
        let (bottom, top) = (
            *first,
            Layer {
                z: first.z + least,
                ..*last
            },
        );
        layers = vec![bottom, top];
    }
    Some(layers)
}

/// Angles from `a0` to `a1`, within a half turn, in equal steps on either side of 0, where the outline is whole.
fn steps([a0, a1]: [f64; 2], segments: u32) -> impl Iterator<Item = f64> {
    let [a0, a1] = [a0, a1].map(|a| finite(a).clamp(-90.0, 90.0));
    let step = 180.0 / f64::from(segments);
    let equal = move |from: f64, to: f64| {
        let count = ((to - from).abs() / step - 1e-9).ceil().max(1.0);
        (0..count as usize).map(move |i| from + (to - from) * (i as f64 / count))
    };
    let through = a0 * a1 < 0.0;
    let second = through.then(|| equal(0.0, a1)).into_iter().flatten();
    equal(a0, if through { 0.0 } else { a1 })
        .chain(second)
        .chain([a1])
}

fn snap(scale: f64) -> f64 {
    if scale < LEAST { 0.0 } else { scale }
}

fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}
