//! Layers: the scaled copies of an outline that most kinds of solids join.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;

use super::Options;
use crate::geometry::Outline;
use crate::math;

/// Smaller scales become 0: the copy is a line or a point.
pub(super) const MIN_SCALE: f64 = 1e-3;
/// The smallest thickness, relative to the larger extent.
pub(super) const MIN_THICKNESS: f64 = 1e-4;
/// Edges that are turned by less than this, as a share of the squared extent, make no copy reach out visibly.
const OVERFLOW: f64 = 1e-3;
/// Layers per 180°: from the fewest that enclose a volume to more than are visible.
const SEGMENTS: std::ops::RangeInclusive<u32> = 2..=512;

/// Layers per 180° where nobody says how many.
pub(super) const DEFAULT_SEGMENTS: u32 = 16;

/// The number of steps per half turn, clamped.
pub(super) fn steps_per_half_turn(options: &Options) -> u32 {
    options.segments.clamp(*SEGMENTS.start(), *SEGMENTS.end())
}

/// The steps per half turn with which the chords of a circle of this radius are off by this much.
pub(crate) fn segments_within(deviation: f64, radius: f64) -> f64 {
    // With n steps they are off by r(π / 2n)² / 2.
    FRAC_PI_2 * (radius / (2.0 * deviation)).sqrt()
}

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

impl Layer {
    /// The outline in full size.
    pub(super) fn whole(z: f64) -> Self {
        Self {
            across: 1.0,
            along: 1.0,
            z,
        }
    }
}

/// The smallest thickness of a solid over an outline with these half extents.
pub(super) fn least_thickness(half: DVec2) -> f64 {
    (MIN_THICKNESS * 2.0 * half.max_element()).max(f64::MIN_POSITIVE)
}

/// Sorts layers by depth and gives them the smallest thickness if theirs is less.
pub(super) fn with_thickness(mut layers: Vec<Layer>, half: DVec2) -> Vec<Layer> {
    if let [first, .., last] = &layers[..]
        && first.z > last.z
    {
        layers.reverse();
    }
    let least = least_thickness(half);
    if let [first, .., last] = &layers[..]
        && last.z - first.z < least
    {
        let z = first.z + least;
        layers = vec![*first, Layer { z, ..*last }];
    }
    layers
}

/// The layers of a rounding from angle to angle; `scale` gives the scales across and along the axis from the cosine.
pub(super) fn rounding(
    angles: [f64; 2],
    radius: f64,
    options: &Options,
    scale: fn(f64) -> [f64; 2],
) -> Vec<Layer> {
    let layer = |t: f64| {
        let [across, along] = scale(snap(math::cos(t.to_radians())));
        let z = radius * math::sin(t.to_radians());
        Layer { across, along, z }
    };
    steps(angles, steps_per_half_turn(options))
        .map(layer)
        .collect()
}

/// The scales across and along the axis where the outline is scaled in these directions only.
pub(super) fn scales<const ACROSS: bool, const ALONG: bool>(scale: f64) -> [f64; 2] {
    [ACROSS, ALONG].map(|is_scaled| if is_scaled { scale } else { 1.0 })
}

/// Whether copies of an outline that are smaller across the axis, along it or both reach out of it. `outline` is relative to its
/// centre.
pub(super) fn overflows<const ACROSS: bool, const ALONG: bool>(outline: &Outline) -> bool {
    let rings = || outline.rings();
    let reach = rings().flatten().map(|point| point.length_squared());
    let slack = OVERFLOW * reach.fold(0.0, f64::max);
    // Copies stay inside if each edge sees the centre, or the line to which copies shrink, on its filled side.
    let is_turned = |from: DVec2, to: DVec2| match (ACROSS, ALONG) {
        (true, true) => from.perp_dot(to) < -slack,
        (true, false) => (from.x + to.x) * (to.y - from.y) < -slack,
        (false, true) => (from.y + to.y) * (from.x - to.x) < -slack,
        (false, false) => false,
    };
    rings().any(|ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter()
            .zip(next)
            .any(|(from, to)| is_turned(*from, *to))
    })
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

/// A scale; one that is too small to be built is 0.
pub(super) fn snap(scale: f64) -> f64 {
    if scale < MIN_SCALE { 0.0 } else { scale }
}

/// A number; 0 for one that is not finite.
pub(super) fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}
