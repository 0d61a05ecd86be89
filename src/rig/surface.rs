//! The points of a part's surface that can touch the ground.

use glam::{DVec2, DVec3};

use super::Context;
use crate::bind::PartId;
use crate::geometry::y_up;
use crate::math;

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
    nodes: impl Iterator<Item = (PartId, f64)> + Clone,
) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = Vec::new();
    for step in 0..AROUND {
        let around = math::direction(std::f64::consts::TAU * step as f64 / AROUND as f64);
        // The outline is searched once for all tilts.
        let supports = nodes.clone().flat_map(|(node, depth)| {
            let parts = context.parts_of_node[node].iter();
            parts.filter_map(move |part| Support::of(context, *part, depth, around))
        });
        let supports: Vec<Support> = supports.collect();
        let tilts = TILTS.map(|tilt| {
            let (up, level) = math::sin_cos(tilt.to_radians());
            (around * level).extend(up)
        });
        // Straight to the front and to the back it makes no difference where on the outline.
        let poles = [DVec3::Z, DVec3::NEG_Z];
        let poles = poles.into_iter().filter(|_| step == 0);
        for direction in tilts.into_iter().chain(poles) {
            let reach = |point: &DVec3| point.dot(direction);
            let farthest = supports.iter().map(|support| support.point(direction));
            let farthest = farthest.reduce(|best, next| {
                if reach(&next) > reach(&best) {
                    next
                } else {
                    best
                }
            });
            points.extend(farthest.filter(|point| !points.contains(point)));
        }
    }
    points
}

/// What is needed of a part's solid to find the points that are farthest in directions with the same bearing in the drawing plane.
struct Support {
    /// The farthest point of its outline, and its centre.
    border: DVec2,
    center: DVec2,
    /// The back and the front of its solid.
    faces: [f64; 2],
    is_soft: bool,
}

impl Support {
    /// That of a part whose node has a depth; `None` without an outline.
    fn of(context: &Context<'_>, part: PartId, depth: f64, around: DVec2) -> Option<Self> {
        let own = &context.bindings.parts[part];
        let rings = own.outline.polygons.iter().filter_map(|p| p.rings.first());
        let points = rings.flatten().map(|point| y_up(*point));
        let border = points.reduce(|best, next| {
            if next.dot(around) > best.dot(around) {
                next
            } else {
                best
            }
        })?;
        let thickness = context.thicknesses.get(part).copied().flatten();
        Some(Self {
            border,
            center: y_up(own.measure.center),
            faces: thickness.map_or([depth; 2], |thickness| {
                thickness.depths.map(|face| face + depth)
            }),
            is_soft: thickness.is_some_and(|thickness| thickness.is_soft),
        })
    }

    /// The farthest point in a direction.
    fn point(&self, direction: DVec3) -> DVec3 {
        let [back, front] = self.faces;
        let face = if direction.z < 0.0 { back } else { front };
        if !self.is_soft {
            return self.border.extend(face);
        }
        let middle = back.midpoint(front);
        let candidates = [
            self.border.extend(middle),
            self.center
                .lerp(self.border, SOFT)
                .extend(middle + SOFT * (face - middle)),
            self.center.extend(face),
        ];
        let reach = |point: &DVec3| point.dot(direction);
        let mut farthest = candidates[0];
        for point in candidates {
            if reach(&point) >= reach(&farthest) {
                farthest = point;
            }
        }
        farthest
    }
}
