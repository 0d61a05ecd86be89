//! The points of a part's surface that can touch the ground.

use glam::{DVec2, DVec3};

use super::Context;
use crate::geometry::y_up;

/// The directions around the viewer's axis in which a surface is measured …
const AROUND: usize = 16;
/// … and their angles with the drawing plane, degrees.
const TILTS: [f64; 3] = [-45.0, 0.0, 45.0];
/// A soft solid is as wide as this share of its outline where it has this share of its thickness, like an ellipse.
const SOFT: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The outermost points of the solids of nodes in evenly spread directions, in the drawing's axes and unit. `nodes` are main parts,
/// each with its node's depth.
pub(super) fn outermost(
    context: &Context<'_>,
    nodes: impl Iterator<Item = (usize, f64)> + Clone,
) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = Vec::new();
    for direction in directions() {
        let mut best: Option<(f64, DVec3)> = None;
        for (node, depth) in nodes.clone() {
            for part in &context.parts_of_node[node] {
                let Some(point) = support(context, *part, direction) else {
                    continue;
                };
                let point = point + DVec3::Z * depth;
                let reach = point.dot(direction);
                if best.is_none_or(|(most, _)| reach > most) {
                    best = Some((reach, point));
                }
            }
        }
        if let Some((_, point)) = best.filter(|(_, point)| !points.contains(point)) {
            points.push(point);
        }
    }
    points
}

fn directions() -> impl Iterator<Item = DVec3> {
    let tilted = TILTS.into_iter().flat_map(|tilt| {
        let (up, level) = tilt.to_radians().sin_cos();
        (0..AROUND).map(move |step| {
            let angle = std::f64::consts::TAU * step as f64 / AROUND as f64;
            DVec2::from_angle(angle).extend(0.0) * level + DVec3::Z * up
        })
    });
    tilted.chain([DVec3::Z, DVec3::NEG_Z])
}

/// The point of a part's solid that is farthest in a direction, relative to its node's plane.
fn support(context: &Context<'_>, part: usize, direction: DVec3) -> Option<DVec3> {
    let own = &context.bindings.parts[part];
    let rings = own.outline.polygons.iter().filter_map(|p| p.rings.first());
    let farthest = rings
        .flatten()
        .map(|point| y_up(*point))
        .reduce(|best, next| {
            match next.dot(direction.truncate()) > best.dot(direction.truncate()) {
                true => next,
                false => best,
            }
        })?;
    let Some(thickness) = context.thicknesses.get(part).copied().flatten() else {
        return Some(farthest.extend(0.0));
    };
    let [back, front] = thickness.depths;
    let face = if direction.z < 0.0 { back } else { front };
    if !thickness.is_soft {
        return Some(farthest.extend(face));
    }
    let (middle, center) = (back.midpoint(front), y_up(own.measure.center));
    let candidates = [
        farthest.extend(middle),
        center
            .lerp(farthest, SOFT)
            .extend(middle + SOFT * (face - middle)),
        center.extend(face),
    ];
    let reach = |point: &DVec3| point.dot(direction);
    candidates
        .into_iter()
        .max_by(|a, b| reach(a).total_cmp(&reach(b)))
}
