//! Roofs: triangular prisms on the walls of houses.

use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::super::houses::House;
use super::corners::Corners;
use super::greedy::{Facing, Rect};
use super::mesh::Mesh;
use super::steps;

/// How far the ridge ends before a gable that something else touches, tiles.
const HIP: f64 = 1.0 / 16.0;

/// How a roof ends at its left or right.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Gable {
    /// Upright.
    Free,
    /// A block or another roof lies against it: it leans a little inward, so that no two faces lie back to back.
    Touched,
    /// It is also the gable of the roof beside it, and no face.
    Shared,
}

/// The left and right gables of roofs. `rects` are the faces of all blocks.
pub(super) fn gables(houses: &[&House], rects: &[Vec<Rect>], factor: f64) -> Vec<[Gable; 2]> {
    let mut gables = vec![[Gable::Free; 2]; houses.len()];
    let ridge = |house: &House| f64::from(house.eaves()) + factor * f64::from(house.depth);
    // The boxes around gables that look left, and around those that look right, in tiles.
    let sides = [Facing::Left, Facing::Right].map(|side| {
        let boxes = houses.iter().enumerate().map(|(index, house)| {
            let x = match side {
                Facing::Left => house.roof.start,
                _ => house.roof.end,
            };
            let [y, back, front] = [house.eaves(), house.back(), house.front].map(f64::from);
            let corners = [[x.into(), y, back], [x.into(), ridge(house), front]];
            GeomWithData::new(Rectangle::from_corners(corners[0], corners[1]), index)
        });
        RTree::bulk_load(boxes.collect())
    });
    let [left, right] = &sides;
    let outline = |house: &House| [house.eaves(), house.back(), house.front];
    for one in right {
        let (low, high) = (one.geom().lower(), one.geom().upper());
        for other in left.locate_in_envelope_intersecting(AABB::from_corners(low, high)) {
            if !overlap([low, high], [other.geom().lower(), other.geom().upper()]) {
                continue;
            }
            let [one, other] = [(one.data, 1), (other.data, 0)];
            let free = [one, other]
                .iter()
                .all(|(house, end)| gables[*house][*end] != Gable::Shared);
            if free && outline(houses[one.0]) == outline(houses[other.0]) {
                gables[one.0][one.1] = Gable::Shared;
                gables[other.0][other.1] = Gable::Shared;
                continue;
            }
            // It is enough that one of two leans; that of the lower roof shows less.
            let (house, end) = if ridge(houses[one.0]) <= ridge(houses[other.0]) {
                one
            } else {
                other
            };
            if gables[house][end] == Gable::Free {
                gables[house][end] = Gable::Touched;
            }
        }
    }
    let touched = rects.par_iter().flatten().flat_map_iter(|rect| {
        let tree = match rect.facing {
            Facing::Left => Some((right, 1)),
            Facing::Right => Some((left, 0)),
            _ => None,
        };
        let (x, [back, front]) = (rect.plane.into(), rect.across.map(f64::from));
        let [bottom, top] = rect.along.map(steps::height);
        let corners = [[x, bottom, back], [x, top, front]];
        let area = AABB::from_corners(corners[0], corners[1]);
        let found = tree.into_iter().flat_map(move |(tree, end)| {
            let found = tree.locate_in_envelope_intersecting(area);
            found.map(move |gable| (gable, end))
        });
        found.filter_map(move |(gable, end)| {
            let other = [gable.geom().lower(), gable.geom().upper()];
            overlap(corners, other).then_some((gable.data, end))
        })
    });
    for (house, end) in touched.collect::<Vec<_>>() {
        if gables[house][end] == Gable::Free {
            gables[house][end] = Gable::Touched;
        }
    }
    gables
}

/// Whether two boxes in one plane across the x axis have an area in common.
fn overlap([low, high]: [[f64; 3]; 2], [other_low, other_high]: [[f64; 3]; 2]) -> bool {
    [1, 2]
        .iter()
        .all(|axis| low[*axis].max(other_low[*axis]) < high[*axis].min(other_high[*axis]))
}

/// The corners of a roof's eaves, with their heights in steps.
pub(super) fn eaves(house: &House) -> [[i32; 3]; 4] {
    let (y, x) = (steps::step(house.eaves()), &house.roof);
    let [back, front] = [house.back(), house.front];
    [
        [x.start, y, front],
        [x.end, y, front],
        [x.end, y, back],
        [x.start, y, back],
    ]
}

/// Adds a roof: two slopes and its left and right gables. `factor` is the ratio of the ridge's height to the depth.
pub(super) fn roof(
    mesh: &mut Mesh,
    corners: &Corners,
    house: &House,
    factor: f64,
    gables: [Gable; 2],
) {
    let depth = f64::from(house.depth);
    let rise = factor * depth;
    let y = f64::from(house.eaves());
    let middle = f64::from(house.front) - depth / 2.0;
    let [near_left, near_right, far_right, far_left] = eaves(house);
    let inset = gables.map(|gable| if gable == Gable::Touched { HIP } else { 0.0 });
    let ridge = |x: i32| {
        let x = if x == house.roof.start {
            f64::from(x) + inset[0]
        } else {
            f64::from(x) - inset[1]
        };
        [x, y + rise, middle]
    };
    let slope = (depth / 2.0).hypot(rise);
    let line = |from: [i32; 3], to: [i32; 3]| {
        let mut points = vec![from];
        corners.between(None, from, to, |point| points.push(point));
        points.push(to);
        points
    };
    let material = house.materials[0];
    let [up, out] = [(depth / 2.0 / slope) as f32, (rise / slope) as f32];
    for (eave, normal) in [
        (line(near_left, near_right), [0.0, up, out]),
        (line(far_right, far_left), [0.0, up, -out]),
    ] {
        let [first, last] = [eave[0], eave[eave.len() - 1]];
        let uv = |x: f64, v: f64| [if normal[2] < 0.0 { -x } else { x }, v];
        let top = |x: i32| (ridge(x), uv(ridge(x)[0], 0.0));
        let foot = |point: &[i32; 3]| {
            let place = steps::place(*point);
            (place, uv(place[0], slope))
        };
        // A fan about the first end of the ridge covers the eave, and one more triangle the rest of the slope.
        let mut fan = vec![top(first[0])];
        fan.extend(eave.iter().map(foot));
        mesh.fan(material, normal, &fan);
        mesh.fan(
            material,
            normal,
            &[top(first[0]), foot(&last), top(last[0])],
        );
    }
    for (end, base, out) in [
        (0, line(far_left, near_left), -1.0),
        (1, line(near_right, far_right), 1.0),
    ] {
        if gables[end] == Gable::Shared {
            continue;
        }
        let length = rise.hypot(inset[end]);
        // Of a roof without height, a gable has no area.
        let [out, up] = if length > 0.0 {
            [out * rise / length, inset[end] / length]
        } else {
            [out, 0.0]
        };
        let normal = [out as f32, up as f32, 0.0];
        let wall = house.materials[1];
        let place = |[x, y, z]: [f64; 3]| ([x, y, z], [z, -y]);
        let mut fan = vec![place(ridge(base[0][0]))];
        fan.extend(base.iter().map(|point| place(steps::place(*point))));
        mesh.fan(wall, normal, &fan);
    }
}
