//! What becomes of limbs where their joints turn.

use std::sync::Arc;

use glam::{DAffine2, DQuat, DVec2, DVec3, Vec3};

use super::PLATE;
use crate::bend::{Bend, BentSurface, Bones, Centerline};
use crate::geometry::{Outline, y_up};
use crate::scene::{Influence, Surface, SurfaceSource};
use crate::solid::{Options, Placement, Profile, Sides, Solid};

/// The angle between the bones of an elbow that is bent as far as it can be, degrees.
const WHOLE: f64 = 150.0;

/// A part that bends, in drawing units.
pub(super) struct Bent {
    pub(super) bend: Bend,
    pub(super) surface: Surface,
    pub(super) rigid: Surface,
    /// The corners at either side of its first joint.
    sides: [usize; 2],
}

fn solid(outline: &Outline, kind: &str, plate: f64) -> Solid {
    Solid {
        outline: Arc::new(outline.clone()),
        to_frame: DAffine2::from_scale(DVec2::new(1.0, -1.0)),
        profile: Profile::new(kind, &[], plate).unwrap(),
        options: Options {
            segments: 12,
            crease: 30.0,
            placement: Placement::default(),
        },
        sides: Sides::Front,
        texture: None,
    }
}

/// A part that hangs on the origin.
pub(super) fn bent(outline: &Outline, kind: &str, bend: impl Fn(Centerline) -> Bend) -> Bent {
    bent_at(outline, DVec2::ZERO, kind, PLATE, bend)
}

/// A part whose joint is at a place of the drawing.
pub(super) fn bent_at(
    outline: &Outline,
    joint: DVec2,
    kind: &str,
    plate: f64,
    bend: impl Fn(Centerline) -> Bend,
) -> Bent {
    let bend = bend(Centerline::new(outline, y_up(joint)).unwrap());
    let solid = solid(outline, kind, plate);
    let source = BentSurface {
        solid: Arc::new(solid.clone()),
        bones: Arc::new(Bones::new(&bend, DAffine2::IDENTITY)),
        rigid: None,
    };
    let surface = source.surface();
    Bent {
        sides: sides(&bend, &surface),
        surface,
        rigid: solid.surface(),
        bend,
    }
}

impl Bent {
    /// The corners where each joint is turned by an angle about an axis.
    pub(super) fn posed(&self, axis: DVec3, angle: f64) -> Vec<DVec3> {
        let mut transforms = vec![(DQuat::IDENTITY, DVec3::ZERO)];
        let shares = self.bend.shares() as f64;
        for node in &self.bend.nodes {
            let (turn, shift) = *transforms.last().unwrap();
            let own = DQuat::from_axis_angle(axis, angle / shares);
            let at = node.position.extend(0.0);
            // About the node, then as the one before.
            transforms.push((turn * own, turn * (at - own * at) + shift));
        }
        let corners = self.surface.positions.iter().zip(&self.surface.influences);
        let corners = corners.map(|(position, influence)| {
            let own = Vec3::from(*position).as_dvec3();
            let moved = |(joint, weight): (u16, f32)| {
                let (turn, shift) = transforms[usize::from(joint)];
                (turn * own + shift) * f64::from(weight)
            };
            weighted(influence).map(moved).sum()
        });
        corners.collect()
    }

    /// The triangles that face another way than their corners' bones turn them.
    pub(super) fn folded(&self, moved: &[DVec3], axis: DVec3, angle: f64) -> Vec<[u32; 3]> {
        let count = self.bend.shares() as f64;
        let rest = at_rest(&self.surface);
        let normal = |points: &[DVec3], triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| points[corner as usize]);
            (b - a).cross(c - a)
        };
        let turned = |triangle: &&[u32; 3]| {
            let turns = triangle.map(|corner| {
                let influence = &self.surface.influences[corner as usize];
                weighted(influence)
                    .map(|(joint, weight)| f64::from(joint) * f64::from(weight))
                    .sum::<f64>()
            });
            let turn = turns.iter().sum::<f64>() / 3.0 / count * angle;
            let before = DQuat::from_axis_angle(axis, turn) * normal(&rest, triangle);
            let after = normal(moved, triangle);
            // A sliver has no side.
            let [a, b, c] = triangle.map(|corner| rest[corner as usize]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            before.length() / longest > 0.02 * self.bend.width() && before.dot(after) < 0.0
        };
        self.surface
            .triangles
            .iter()
            .filter(turned)
            .copied()
            .collect()
    }
}

/// The joints of a corner with their weights.
pub(super) fn weighted(influence: &Influence) -> impl Iterator<Item = (u16, f32)> {
    influence.joints.into_iter().zip(influence.weights)
}

pub(super) fn volume(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let corner = |corner: u32| points[corner as usize];
    let tetrahedra = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(corner);
        a.cross(b).dot(c) / 6.0
    });
    tetrahedra.sum()
}

pub(super) fn at_rest(surface: &Surface) -> Vec<DVec3> {
    let positions = surface.positions.iter();
    positions.map(|at| Vec3::from(*at).as_dvec3()).collect()
}

/// Corners at either side of a part at its first joint, opposite each other.
fn sides(bend: &Bend, surface: &Surface) -> [usize; 2] {
    let middle = bend.nodes.iter().filter(|node| node.joint == 0);
    let joint = middle.map(|node| node.at).sum::<f64>() / bend.shares() as f64;
    let reach = 0.25 * bend.width();
    let [before, at, after] = [-reach, 0.0, reach].map(|off| bend.line.at(joint + off));
    let left = (after - before).perp().normalize();
    let corners = at_rest(surface);
    let near = |corner: &DVec3| {
        corner.truncate().distance(at) <= bend.width()
            && (bend.line.along(corner.truncate()) - joint).abs() <= reach
    };
    // How far off a side, how far along and how deep each corner is.
    let places = corners
        .iter()
        .enumerate()
        .filter(|(_, corner)| near(corner));
    let places = places.map(|(number, corner)| {
        let across = (corner.truncate() - at).dot(left);
        let off = (across.abs() - bend.width() / 2.0).abs();
        let along = bend.line.along(corner.truncate());
        (number, across > 0.0, off, along, corner.z)
    });
    let places: Vec<_> = places.collect();
    let mut best = (f64::INFINITY, [0; 2]);
    for (one, _, off, along, z) in places.iter().filter(|place| !place.1) {
        for (other, _, other_off, other_along, other_z) in places.iter().filter(|place| place.1) {
            // As deep and as far along, so that their distance is the width.
            let sum = off + other_off + (along - other_along).abs() + (z - other_z).abs();
            if sum < best.0 {
                best = (sum, [*one, *other]);
            }
        }
    }
    best.1
}

/// By how much a part is drawn bent at its first joint, radians.
pub(super) fn drawn_bend(bend: &Bend) -> f64 {
    let joint = bend.nodes.iter().filter(|node| node.joint == 0);
    let joint = joint.map(|node| node.at).sum::<f64>() / bend.shares() as f64;
    let line = &bend.line;
    let [from, at, to] = [0.0, joint, line.length()].map(|along| line.at(along));
    (at - from).angle_to(to - at)
}

/// What becomes of limbs where their joints are turned by an angle to both sides and about the viewer axis and an axis of the drawing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// The least width at a joint, as a share of that at rest.
    pub(super) narrowest: f64,
    /// How many triangles are turned over, and how many there are.
    pub(super) folded: [usize; 2],
    /// By how much a volume changes at most.
    pub(super) volume: f64,
}

impl Measured {
    pub(super) fn of(bent: &Bent, degrees: f64) -> Self {
        let rest = at_rest(&bent.surface);
        let triangles = &bent.surface.triangles;
        let drawn = drawn_bend(&bent.bend);
        let mut measured = Self {
            narrowest: 1.0,
            folded: [0; 2],
            volume: 0.0,
        };
        for (sign, axis) in [(1.0, DVec3::Z), (-1.0, DVec3::Z), (1.0, DVec3::X)] {
            let turn = sign * degrees.to_radians();
            // What is drawn bent is not bent further than this: no elbow is.
            if axis == DVec3::Z && (turn + drawn).abs() > WHOLE.to_radians() {
                continue;
            }
            let moved = bent.posed(axis, turn);
            let width = |corners: &[DVec3]| {
                let [one, other] = bent.sides.map(|corner| corners[corner]);
                one.distance(other)
            };
            let width = width(&moved) / width(&rest);
            let change = volume(&moved, triangles) / volume(&rest, triangles) - 1.0;
            measured = measured.with(&Self {
                narrowest: width,
                folded: [bent.folded(&moved, axis, turn).len(), triangles.len()],
                volume: change.abs(),
            });
        }
        measured
    }

    /// The worst of both.
    fn with(&self, other: &Self) -> Self {
        Self {
            narrowest: self.narrowest.min(other.narrowest),
            folded: [0, 1].map(|at| self.folded[at] + other.folded[at]),
            volume: self.volume.max(other.volume),
        }
    }

    pub(super) fn worst<'a>(limbs: impl Iterator<Item = &'a Self>) -> Self {
        let none = Self {
            narrowest: 1.0,
            folded: [0; 2],
            volume: 0.0,
        };
        limbs.fold(none, |worst, one| worst.with(one))
    }

    /// The share of triangles that are turned over.
    pub(super) fn share_folded(&self) -> f64 {
        self.folded[0] as f64 / self.folded[1].max(1) as f64
    }
}
