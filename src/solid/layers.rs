//! The stack of scaled copies that a kind of shape stands for (language.md, Shapes).

use super::Options;
use crate::lang::value::ShapeKind;

/// Scales below this are 0: the copy is a line or a point.
pub(super) const LEAST: f64 = 1e-3;
/// The least thickness, relative to the larger extent.
const THIN: f64 = 1e-4;
/// Layers per 180°, from the fewest that have any volume to more than can be seen.
const SEGMENTS: std::ops::RangeInclusive<u32> = 2..=512;

/// A copy of the outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Scale across the axis.
    pub across: f64,
    /// Scale along the axis.
    pub along: f64,
    /// Depth, drawing units.
    pub z: f64,
}

/// The layers of a kind, by rising depth; `None` where there is no solid. Only the first and the
/// last may have a scale of 0. A solid always has some thickness, if only a little.
pub fn layers(
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
        steps(angles, options.segments).map(layer).collect()
    };
    let cone = |[z0, z1, top]: [f64; 3], scale: fn(f64) -> [f64; 2]| {
        let top = snap(finite(top));
        let [across, along] = scale(top);
        let z = finite(z1);
        vec![whole(finite(z0)), Layer { across, along, z }]
    };
    let mut layers: Vec<Layer> = match *kind {
        ShapeKind::None => return None,
        ShapeKind::Flat(z) => return Some(vec![whole(finite(z))]),
        ShapeKind::Default(Some(z)) => z.map(finite).map(whole).to_vec(),
        ShapeKind::Default(None)
        | ShapeKind::Inflate(_)
        | ShapeKind::Lathe(_)
        | ShapeKind::Model(_) => options.thickness.map(finite).map(whole).to_vec(),
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
    let step = 180.0 / f64::from(segments.clamp(*SEGMENTS.start(), *SEGMENTS.end()));
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
