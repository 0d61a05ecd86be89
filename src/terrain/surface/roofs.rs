//! Roofs: triangular prisms on the walls of houses.

use crate::math;
use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::super::groups::GroupKind;
use super::super::houses::House;
use super::super::solids::MapContext;
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

/// The materials of a roof that is drawn in several: per row from the eaves up those of its columns. `None` if it is drawn in one.
pub(super) fn tiles(context: &MapContext, number: u32) -> Option<Vec<Vec<u8>>> {
    let (grid, house) = (&context.grid, &context.houses[number as usize]);
    let eaves = house.front - house.eaves();
    let material = |row: i32, column: i32| {
        let cell = column as usize * grid.rows + row.max(0) as usize;
        let is_own = row >= 0 && context.groups.kind(cell) == GroupKind::Roof(number);
        if is_own {
            grid.cells[cell]
        } else {
            house.materials[0]
        }
    };
    let rows = (1..=house.depth).map(|up| {
        let columns = house.roof.clone();
        columns.map(|column| material(eaves - up, column)).collect()
    });
    let rows: Vec<Vec<u8>> = rows.collect();
    let is_plain = rows
        .iter()
        .flatten()
        .all(|material| *material == house.materials[0]);
    (!is_plain).then_some(rows)
}

/// The points of a roof's eaves between its corners, where its tiles meet.
pub(super) fn eaves_between(house: &House) -> impl Iterator<Item = [i32; 3]> {
    let y = steps::step(house.eaves());
    let sides = [house.back(), house.front];
    let columns = house.roof.start + 1..house.roof.end;
    columns.flat_map(move |x| sides.map(|z| [x, y, z]))
}

/// A roof to be built.
pub(super) struct Roof<'a> {
    pub(super) house: &'a House,
    /// The ratio of the ridge's height to the depth.
    pub(super) factor: f64,
    /// How it ends at its left and right.
    pub(super) gables: [Gable; 2],
    /// The materials of its tiles (see [`tiles`]); `None` if its slopes are whole.
    pub(super) tiles: Option<Vec<Vec<u8>>>,
}

impl Roof<'_> {
    /// The columns at which the ridge ends.
    fn inset(&self) -> [f64; 2] {
        let inset = |gable: Gable| if gable == Gable::Touched { HIP } else { 0.0 };
        self.gables.map(inset)
    }

    /// A point of the ridge.
    fn ridge(&self, x: i32) -> [f64; 3] {
        let house = self.house;
        let depth = f64::from(house.depth);
        let [left, right] = self.inset();
        let x = match x {
            x if x == house.roof.start => f64::from(x) + left,
            x if x == house.roof.end => f64::from(x) - right,
            x => f64::from(x),
        };
        let y = f64::from(house.eaves()) + self.factor * depth;
        [x, y, f64::from(house.front) - depth / 2.0]
    }

    /// A point of a slope: `up` of the roof's rows above the eaves at z.
    fn on_slope(&self, x: i32, up: i32, z: i32) -> [f64; 3] {
        let eave = steps::place([x, steps::step(self.house.eaves()), z]);
        let share = f64::from(up) / f64::from(self.house.depth);
        let ridge = self.ridge(x);
        match up {
            0 => eave,
            up if up == self.house.depth => ridge,
            _ => [0, 1, 2].map(|axis| eave[axis] + (ridge[axis] - eave[axis]) * share),
        }
    }

    /// Adds two slopes, and the left and right gables.
    pub(super) fn add(&self, mesh: &mut Mesh<'_>, corners: &Corners) {
        let house = self.house;
        let depth = f64::from(house.depth);
        let rise = self.factor * depth;
        let slope = math::hypot(depth / 2.0, rise);
        let [near_left, near_right, far_right, far_left] = eaves(house);
        let line = |from: [i32; 3], to: [i32; 3]| {
            let mut points = vec![from];
            corners.between(None, from, to, |point| points.push(point));
            points.push(to);
            points
        };
        let [up, out] = [(depth / 2.0 / slope) as f32, (rise / slope) as f32];
        for (from, to, normal) in [
            (near_left, near_right, [0.0, up, out]),
            (far_right, far_left, [0.0, up, -out]),
        ] {
            match &self.tiles {
                None => self.slope(mesh, &line(from, to), normal, slope),
                Some(tiles) => self.tiled(mesh, [from, to], normal, slope, tiles),
            }
        }
        for (end, base, out) in [
            (0, line(far_left, near_left), -1.0),
            (1, line(near_right, far_right), 1.0),
        ] {
            if self.gables[end] == Gable::Shared {
                continue;
            }
            let inset = self.inset()[end];
            let length = math::hypot(rise, inset);
            // Of a roof without height, a gable has no area.
            let [out, up] = if length > 0.0 {
                [out * rise / length, inset / length]
            } else {
                [out, 0.0]
            };
            self.gable(mesh, &base, [out as f32, up as f32, 0.0]);
        }
    }

    /// Adds a whole slope over an eave: a fan about the first end of the ridge covers the eave, and one more triangle the rest.
    fn slope(&self, mesh: &mut Mesh<'_>, eave: &[[i32; 3]], normal: [f32; 3], slope: f64) {
        let [first, last] = [eave[0], eave[eave.len() - 1]];
        let uv = |x: f64, v: f64| [if normal[2] < 0.0 { -x } else { x }, v];
        let top = |x: i32| (self.ridge(x), uv(self.ridge(x)[0], 0.0));
        let foot = |point: &[i32; 3]| {
            let place = steps::place(*point);
            (place, uv(place[0], slope))
        };
        let material = self.house.materials[0];
        let mut fan = vec![top(first[0])];
        fan.extend(eave.iter().map(foot));
        mesh.fan(material, normal, &fan);
        mesh.fan(
            material,
            normal,
            &[top(first[0]), foot(&last), top(last[0])],
        );
    }

    /// Adds a slope tile by tile. `ends` are those of its eave.
    fn tiled(
        &self,
        mesh: &mut Mesh<'_>,
        [from, to]: [[i32; 3]; 2],
        normal: [f32; 3],
        slope: f64,
        tiles: &[Vec<u8>],
    ) {
        let step = (to[0] - from[0]).signum();
        for (up, row) in (0..).zip(tiles) {
            for (column, material) in (self.house.roof.start..).zip(row) {
                // The corner from which the eave runs on.
                let x = if step > 0 { column } else { column + 1 };
                let corners = [(x, up), (x + step, up), (x + step, up + 1), (x, up + 1)];
                let corners = corners.map(|(x, up)| {
                    let place = self.on_slope(x, up, from[2]);
                    let v = slope * (1.0 - f64::from(up) / f64::from(self.house.depth));
                    (place, [if step < 0 { -place[0] } else { place[0] }, v])
                });
                mesh.fan(*material, normal, &corners);
            }
        }
    }

    /// Adds a gable over its base, which runs from one eave to the other.
    fn gable(&self, mesh: &mut Mesh<'_>, base: &[[i32; 3]], normal: [f32; 3]) {
        let wall = self.house.materials[1];
        let corner = |[x, y, z]: [f64; 3]| ([x, y, z], [z, -y]);
        let [first, last] = [base[0], base[base.len() - 1]];
        // The slopes' tiles have corners on its sides.
        let rows = if self.tiles.is_some() {
            self.house.depth
        } else {
            1
        };
        let at = |end: [i32; 3], row: i32| {
            let up = if row == rows { self.house.depth } else { row };
            corner(self.on_slope(first[0], up, end[2]))
        };
        let mut fan = vec![at(first, 1)];
        fan.extend(base.iter().map(|point| corner(steps::place(*point))));
        if rows > 1 {
            fan.push(at(last, 1));
        }
        mesh.fan(wall, normal, &fan);
        for row in 1..rows {
            let mut quad = vec![at(first, row), at(last, row), at(last, row + 1)];
            if row + 1 < rows {
                quad.push(at(first, row + 1));
            }
            mesh.fan(wall, normal, &quad);
        }
    }
}
