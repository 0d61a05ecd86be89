//! Bevelled corners (ours: the thesis names rounded ground as its open problem).
//!
//! Every face is inset along the sides where the surface turns. Strips join the inset faces along those sides, and patches join
//! the strips at corners. Vertices keep the normals of their original faces, so that the bevel is shaded smoothly. A face between two such
//! sides keeps at least its middle half, and a strip is half of either material, so that one-tile walls and the rims of plates
//! stay what they are.

use glam::Vec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::super::constraints::STRIPE;
use super::super::houses::House;
use super::greedy::{Facing, Rect};
use super::mesh::Mesh;
use super::steps;

/// A wider bevel would turn thin walls inside out.
const WIDEST: f64 = 0.49;
/// The largest share of a square that a bevel takes at each of two opposite sides.
const OF_TWO: f64 = 0.25;

/// The axis of heights, which are in steps.
const UP: usize = 1;

type Point = [i32; 3];

/// The grid that faces are split along: whole tiles, and the undersides of plates where a face ends there. All faces have
/// the same lines, so that squares beside each other share whole sides.
#[derive(Debug, Default)]
pub(super) struct Lines {
    undersides: FxHashSet<i32>,
}

impl Lines {
    pub(super) fn new<'a>(rects: impl Iterator<Item = &'a Rect>) -> Self {
        let steps = rects.flat_map(|rect| match rect.facing.axes() {
            [_, UP, _] => rect.along,
            _ => [rect.plane; 2],
        });
        Self {
            undersides: steps.filter(|step| step % 2 != 0).collect(),
        }
    }

    /// The next line after one on an axis.
    fn after(&self, axis: usize, at: i32) -> i32 {
        if axis == UP && at % 2 == 0 && !self.undersides.contains(&(at + 1)) {
            at + 2
        } else {
            at + 1
        }
    }

    /// The last line before one on an axis.
    fn before(&self, axis: usize, at: i32) -> i32 {
        if axis == UP && at % 2 == 0 && !self.undersides.contains(&(at - 1)) {
            at - 2
        } else {
            at - 1
        }
    }

    /// The point on the next line along an axis.
    fn next(&self, mut point: Point, axis: usize) -> Point {
        point[axis] = self.after(axis, point[axis]);
        point
    }
}

/// Splits a rectangle into the squares of the grid along its border, which may be bevelled, and the rest.
pub(super) fn ring(rect: &Rect, lines: &Lines, squares: &mut Vec<Rect>, rest: &mut Vec<Rect>) {
    let [across, along] = [rect.across, rect.along];
    let [_, axis, _] = rect.facing.axes();
    let mut square = |a: i32, b: i32| {
        squares.push(Rect {
            across: [a, a + 1],
            along: [b, lines.after(axis, b)],
            ..*rect
        });
    };
    let inner = [lines.after(axis, along[0]), lines.before(axis, along[1])];
    for a in across[0]..across[1] {
        let side = a == across[0] || a + 1 == across[1];
        if side {
            let mut b = along[0];
            while b < along[1] {
                square(a, b);
                b = lines.after(axis, b);
            }
        } else {
            square(a, along[0]);
            if inner[0] < along[1] {
                square(a, inner[1]);
            }
        }
    }
    if across[1] - across[0] > 2 && inner[0] < inner[1] {
        rest.push(Rect {
            across: [across[0] + 1, across[1] - 1],
            along: inner,
            ..*rect
        });
    }
}

/// Of the four squares of a plane around a point, those that are connected through sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Fan {
    facing: Facing,
    /// A bit for each square: bit 0 of its number is its side across the runs, bit 1 its side along them.
    squares: u8,
}

/// A corner of a fan of faces, to be inset.
#[derive(Debug, Clone, Copy)]
struct Corner {
    fan: Fan,
    point: Point,
    material: u8,
    /// Column and row of its square, if that is a top.
    cell: [i32; 2],
}

/// The squares of a stripe and its neighbours, and how they meet.
pub(super) struct Bevel<'a> {
    radius: f64,
    lines: &'a Lines,
    /// The squares that may be bevelled.
    squares: FxHashMap<(Facing, Point), u8>,
    /// The faces at each side of a square, up to four. A side is its smaller point and its axis.
    sides: FxHashMap<(Point, usize), Vec<(Facing, Point)>>,
    /// Per point how far it is inset at most, tiles.
    reach: FxHashMap<Point, f64>,
    /// Points that are not inset: at houses, and where the surface folds back onto itself.
    fixed: FxHashSet<Point>,
    houses: Vec<&'a House>,
}

/// The smallest corner of a square of the grid, which identifies it together with its facing.
fn name(rect: &Rect) -> Point {
    let [across, along, up] = rect.facing.axes();
    let mut point = [0; 3];
    point[across] = rect.across[0];
    point[along] = rect.along[0];
    point[up] = rect.plane;
    point
}

impl<'a> Bevel<'a> {
    /// Collects the squares of a stripe and those of its neighbours that touch it.
    pub(super) fn new(
        radius: f64,
        lines: &'a Lines,
        squares: &mut dyn Iterator<Item = &Rect>,
        houses: Vec<&'a House>,
    ) -> Self {
        let mut bevel = Self {
            radius: radius.min(WIDEST),
            lines,
            squares: FxHashMap::default(),
            sides: FxHashMap::default(),
            reach: FxHashMap::default(),
            fixed: FxHashSet::default(),
            houses,
        };
        for square in squares {
            let (facing, point) = (square.facing, name(square));
            bevel.squares.insert((facing, point), square.material);
            let [across, along, _] = facing.axes();
            for (start, axis) in [
                (point, across),
                (lines.next(point, along), across),
                (point, along),
                (lines.next(point, across), along),
            ] {
                let faces = bevel.sides.entry((start, axis)).or_default();
                faces.push((facing, point));
            }
        }
        bevel.fix();
        bevel.find_reach();
        bevel
    }

    /// Finds how far points are inset at most: as far as the smallest square there allows, so that both sides of a strip are alike, and
    /// a plate's rim is not cut more across than down.
    fn find_reach(&mut self) {
        // Each face with each of its sides where the surface turns.
        let mut turns: FxHashSet<((Facing, Point), (Point, usize))> = FxHashSet::default();
        let mut reach: FxHashMap<Point, f64> = FxHashMap::default();
        #[expect(
            clippy::iter_over_hash_type,
            reason = "neither a set nor minima depend on the order"
        )]
        {
            for ((start, axis), faces) in &self.sides {
                for [one, other] in self.pairs(*start, *axis, faces).unwrap_or_default() {
                    if one.0 != other.0 {
                        turns.extend([one, other].map(|face| (face, (*start, *axis))));
                    }
                }
            }
            for (face, side) in &turns {
                let (length, opposite) = self.across(*face, *side);
                let share = match turns.contains(&(*face, opposite)) {
                    true => self.radius.min(OF_TWO),
                    false => self.radius,
                };
                let (start, axis) = *side;
                for point in [start, self.lines.next(start, axis)] {
                    let most = reach.entry(point).or_insert(self.radius);
                    *most = most.min(share * length);
                }
            }
        }
        self.reach = reach;
    }

    /// How far a square reaches from one of its sides, tiles, and the side there.
    fn across(
        &self,
        (facing, square): (Facing, Point),
        (start, axis): (Point, usize),
    ) -> (f64, (Point, usize)) {
        let [one, other, _] = facing.axes();
        let across = if one == axis { other } else { one };
        let far = self.lines.after(across, square[across]);
        let length = match across {
            UP => steps::height(far) - steps::height(square[UP]),
            _ => 1.0,
        };
        let mut opposite = start;
        opposite[across] = if start[across] == far {
            square[across]
        } else {
            far
        };
        (length, (opposite, axis))
    }

    /// Finds the points that must not be inset.
    fn fix(&mut self) {
        let mut fixed = FxHashSet::default();
        #[expect(
            clippy::iter_over_hash_type,
            reason = "a set does not depend on the order"
        )]
        for ((start, axis), faces) in &self.sides {
            let end = self.lines.next(*start, *axis);
            let whole = self.pairs(*start, *axis, faces).is_some_and(|pairs| {
                let folded = |pair: &[(Facing, Point); 2]| opposite(pair[0].0, pair[1].0);
                !pairs.iter().any(folded)
            });
            if !whole {
                fixed.extend([*start, end]);
            }
            for point in [*start, end] {
                if self.houses.iter().any(|house| touches(house, point)) {
                    fixed.insert(point);
                }
            }
        }
        self.fixed = fixed;
    }

    /// The faces that meet at a side, in pairs with only air between them; `None` if they cannot be paired.
    fn pairs(
        &self,
        start: Point,
        axis: usize,
        faces: &[(Facing, Point)],
    ) -> Option<Vec<[(Facing, Point); 2]>> {
        match faces {
            [one, other] => Some(vec![[*one, *other]]),
            [..] if faces.len() == 4 => {
                // Sorted around the side; each face has its air clockwise or counter-clockwise of it.
                let mut around: Vec<(u8, bool, (Facing, Point))> = faces
                    .iter()
                    .map(|face| {
                        let (angle, air_behind) = angle(*face, start, axis);
                        (angle, air_behind, *face)
                    })
                    .collect();
                // Of two at the same angle, the one whose air comes first goes first.
                around.sort_by_key(|(angle, air_behind, _)| (*angle, *air_behind));
                let pair = |at: usize| {
                    let [one, other] = [around[at], around[(at + 1) % 4]];
                    (one.1 && !other.1).then_some([one.2, other.2])
                };
                let first = (0..4).find_map(|at| Some((at, pair(at)?)))?;
                let second = pair((first.0 + 2) % 4)?;
                Some(vec![first.1, second])
            }
            _ => None,
        }
    }

    // A landscape with bevels calls this and the two below several times for every square.
    #[inline]
    fn fan(&self, facing: Facing, square: Point, point: Point) -> Fan {
        let [across, along, _] = facing.axes();
        let has = |is_after: [bool; 2]| {
            let mut name = point;
            for (axis, is_after) in [across, along].into_iter().zip(is_after) {
                if !is_after {
                    name[axis] = self.lines.before(axis, point[axis]);
                }
            }
            self.squares.contains_key(&(facing, name))
        };
        let there = [false, true].map(|a| [false, true].map(|b| has([a, b])));
        let own = [across, along].map(|axis| usize::from(square[axis] == point[axis]));
        let mut squares = 1 << (own[0] | own[1] << 1);
        let mut add = |a: usize, b: usize| {
            if there[a][b] {
                squares |= 1 << (a | b << 1);
            }
        };
        let [a, b] = own;
        add(1 - a, b);
        add(a, 1 - b);
        if there[1 - a][b] || there[a][1 - b] {
            add(1 - a, 1 - b);
        }
        Fan { facing, squares }
    }

    /// The position of a corner after insetting.
    #[inline]
    fn place(&self, corner: &Corner) -> [f64; 3] {
        let mut place = steps::place(corner.point);
        if self.fixed.contains(&corner.point) {
            return place;
        }
        let [across, along, _] = corner.fan.facing.axes();
        let has = |a: u8, b: u8| corner.fan.squares & (1 << (a | b << 1)) != 0;
        let count = corner.fan.squares.count_ones();
        let sum = |of: &dyn Fn(u8) -> [bool; 2]| {
            let count = |side: u8| of(side).iter().filter(|there| **there).count() as f64;
            count(1) - count(0)
        };
        let towards = [
            sum(&|a| [has(a, 0), has(a, 1)]),
            sum(&|b| [has(0, b), has(1, b)]),
        ];
        // With one square the corner moves into it, with two away from their side, with three away from the missing one, with four
        // not at all.
        if count < 4 {
            for (axis, towards) in [across, along].into_iter().zip(towards) {
                place[axis] += self.inset(corner.point, axis, towards);
            }
        }
        place
    }

    /// How far a point moves along an axis into the squares on one side of it: in proportion to their side.
    fn inset(&self, point: Point, axis: usize, towards: f64) -> f64 {
        if towards == 0.0 {
            return 0.0;
        }
        let side = match (axis == UP, towards > 0.0) {
            (false, _) => 1.0,
            (true, true) => {
                steps::height(self.lines.after(UP, point[UP])) - steps::height(point[UP])
            }
            (true, false) => {
                steps::height(point[UP]) - steps::height(self.lines.before(UP, point[UP]))
            }
        };
        let reach = self.reach.get(&point).copied();
        let reach = reach.unwrap_or(self.radius).min(self.radius * side);
        reach * towards.signum()
    }

    #[inline]
    fn corner(&self, (facing, square): (Facing, Point), point: Point) -> Corner {
        Corner {
            fan: self.fan(facing, square, point),
            point,
            material: self.squares[&(facing, square)],
            cell: [square[0], square[2]],
        }
    }

    /// Adds a stripe's own squares, inset, and the strips and patches that begin between `columns`.
    pub(super) fn add(&self, mesh: &mut Mesh<'_>, own: &[Rect], columns: std::ops::Range<i32>) {
        for square in own {
            let face = (square.facing, name(square));
            let ring = square.corners().map(|point| {
                let corner = self.corner(face, point);
                (self.place(&corner), square.facing.normal())
            });
            let [x, _, z] = face.1;
            mesh.smooth_polygon(square.material, square.facing, [x, z], &ring);
        }
        let mut ends: FxHashMap<Point, Vec<[Corner; 2]>> = FxHashMap::default();
        let mut sides: Vec<_> = self
            .sides
            .iter()
            .filter(|((start, _), _)| start[0] >= columns.start - 1 && start[0] <= columns.end)
            .collect();
        sides.sort_unstable_by_key(|(side, _)| **side);
        for ((start, axis), faces) in sides {
            for [one, other] in self.pairs(*start, *axis, faces).unwrap_or_default() {
                if one.0 == other.0 {
                    continue;
                }
                let end = self.lines.next(*start, *axis);
                // The face that runs along the side in its direction goes first.
                let forward = runs_forward(one, *start, *axis);
                let [f, g] = if forward { [one, other] } else { [other, one] };
                let [f0, f1] = [*start, end].map(|point| self.corner(f, point));
                let [g0, g1] = [*start, end].map(|point| self.corner(g, point));
                if columns.contains(&start[0]) {
                    let of = |corner: &Corner| (self.place(corner), corner.fan.facing.normal());
                    let [of_f1, of_f0, of_g0, of_g1] = [f1, f0, g0, g1].map(|corner| of(&corner));
                    if f0.material == g0.material {
                        let ring = [of_f1, of_f0, of_g0, of_g1];
                        mesh.smooth_polygon(f0.material, f.0, f0.cell, &ring);
                    } else {
                        let [m0, m1] = [[of_f0, of_g0], [of_f1, of_g1]].map(|ends| center(&ends));
                        let near_f = [of_f1, of_f0, m0, m1];
                        mesh.smooth_polygon(f0.material, f.0, f0.cell, &near_f);
                        let near_g = [m1, m0, of_g0, of_g1];
                        mesh.smooth_polygon(g0.material, g.0, g0.cell, &near_g);
                    }
                }
                ends.entry(*start).or_default().push([g0, f0]);
                ends.entry(end).or_default().push([f1, g1]);
            }
        }
        let mut points: Vec<_> = ends
            .into_iter()
            .filter(|(point, _)| columns.contains(&point[0]))
            .collect();
        points.sort_unstable_by_key(|(point, _)| *point);
        for (point, ends) in points {
            if !self.fixed.contains(&point) {
                self.patches(mesh, ends);
            }
        }
    }

    /// Closes the holes between the strips at a corner.
    fn patches(&self, mesh: &mut Mesh<'_>, mut ends: Vec<[Corner; 2]>) {
        let of = |corner: &Corner| (self.place(corner), corner.fan.facing.normal());
        while let Some([first, mut last]) = ends.pop() {
            let mut ring = vec![[first, last]];
            while last.fan != first.fan
                && let Some(next) = ends.iter().position(|[from, _]| from.fan == last.fan)
            {
                let end = ends.swap_remove(next);
                last = end[1];
                ring.push(end);
            }
            // A strip of two materials has a point in the middle of its end.
            let is_split = |[from, to]: &[Corner; 2]| from.material != to.material;
            let split = ring.iter().filter(|end| is_split(end)).count();
            // The ends of two strips that are alike meet.
            if ring.len() < 3 && split != 1 {
                continue;
            }
            // Each point, and the corner whose material begins there.
            let mut points = Vec::with_capacity(ring.len() + split);
            for end in &ring {
                points.push((of(&end[0]), end[0]));
                if is_split(end) {
                    points.push((center(&end.each_ref().map(of)), end[1]));
                }
            }
            let places: Vec<_> = points.iter().map(|(point, _)| *point).collect();
            if split == 0 || ring.len() < 3 {
                mesh.smooth_polygon(first.material, first.fan.facing, first.cell, &places);
                continue;
            }
            let center = center(&places);
            let next = places.iter().cycle().skip(1);
            for ((point, corner), next) in points.iter().zip(next) {
                let sector = [center, *point, *next];
                mesh.smooth_polygon(corner.material, corner.fan.facing, corner.cell, &sector);
            }
        }
    }
}

/// A place and a normal.
type Vertex = ([f64; 3], [f32; 3]);

/// The mean of some points, and of their normals.
fn center(points: &[Vertex]) -> Vertex {
    let count = points.len() as f64;
    let place = [0, 1, 2].map(|axis| points.iter().map(|(at, _)| at[axis]).sum::<f64>() / count);
    let normal: Vec3 = points.iter().map(|(_, normal)| Vec3::from(*normal)).sum();
    // Normals that cancel each other out are those of a fold.
    let usual = points
        .first()
        .map_or([0.0, 1.0, 0.0], |(_, normal)| *normal);
    (place, normal.normalize_or(usual.into()).into())
}

fn opposite(one: Facing, other: Facing) -> bool {
    one != other && one.axes()[2] == other.axes()[2]
}

/// Whether a point lies on a house or its roof.
fn touches(house: &House, [x, y, z]: Point) -> bool {
    let columns = house.roof.start.min(house.walls.start)..=house.roof.end.max(house.walls.end);
    columns.contains(&x)
        && (steps::step(house.base)..=steps::step(house.eaves())).contains(&y)
        && (house.back()..=house.front).contains(&z)
}

/// The quarter turn at which a face lies around a side, counter-clockwise about the axis, and whether air is counter-clockwise
/// of it.
fn angle((facing, square): (Facing, Point), start: Point, axis: usize) -> (u8, bool) {
    let [first, second] = [(axis + 1) % 3, (axis + 2) % 3];
    let stands_on = facing.axes()[2];
    let across = if stands_on == first { second } else { first };
    let ahead = square[across] == start[across];
    let quarter = match (across == first, ahead) {
        (true, true) => 0,
        (false, true) => 1,
        (true, false) => 2,
        (false, false) => 3,
    };
    let positive = facing.normal()[stands_on] > 0.0;
    // Counter-clockwise of the first axis is the second; counter-clockwise of the second is the negative first.
    let air = match quarter {
        0 | 3 => positive,
        _ => !positive,
    };
    (quarter, air)
}

/// Whether a face, seen from outside with its corners counter-clockwise, runs along a side in the axis' direction.
fn runs_forward((facing, square): (Facing, Point), start: Point, axis: usize) -> bool {
    let [across, along, up] = facing.axes();
    let other = if axis == across { along } else { across };
    let low_side = square[other] == start[other];
    // If the side is at the lower end of the square, the corners run forward if axis, other axis and normal are right-handed.
    let right_handed = (axis + 1) % 3 == other;
    let positive = facing.normal()[up] > 0.0;
    (right_handed == positive) == low_side
}

/// The columns in which the strips and patches of a stripe begin.
pub(super) fn columns(stripe: usize, stripes: usize) -> std::ops::Range<i32> {
    let start = (stripe * STRIPE) as i32;
    let end = if stripe + 1 == stripes {
        i32::MAX
    } else {
        start + STRIPE as i32
    };
    start..end
}
