//! Cuts triangles across a limb, so that they can follow a bend.

use std::cmp::Ordering;
use std::ops::Range;

use glam::{Vec2, Vec3};
use rustc_hash::FxHashMap;

use crate::scene::Surface;

/// The most steps of the search for the place at which an edge crosses a level.
const STEPS: usize = 6;
/// The search ends where the value is as near to the level as this, as a share of the change along the shortest edge that is cut.
const NEAR: f64 = 1e-3;
/// A cut is at least this share of an edge away from its ends.
const LEAST: f64 = 1e-3;

/// Cuts the triangles of a surface along these levels of a value, which are ascending. Edges along which it changes by no more than
/// `least` are short enough, and are not cut. `value` gives that of a point. Edges that triangles share stay shared, and the surface
/// stays what it is. Returns the values of all corners.
pub(super) fn cut(
    surface: &mut Surface,
    value: impl Fn([f32; 3]) -> f64,
    least: f64,
    levels: impl Iterator<Item = f64>,
) -> Vec<f64> {
    let values = surface.positions.iter().map(|at| value(*at)).collect();
    let triangles = std::mem::take(&mut surface.triangles);
    let mut cutter = Cutter {
        surface,
        value,
        values,
        least,
        levels: levels.collect(),
        crossings: FxHashMap::default(),
    };
    let mut cut = Vec::with_capacity(2 * triangles.len());
    for triangle in triangles {
        cutter.cut(triangle, &mut cut);
    }
    cutter.surface.triangles = cut;
    cutter.values
}

struct Cutter<'a, Value> {
    surface: &'a mut Surface,
    value: Value,
    /// Per corner its value.
    values: Vec<f64>,
    least: f64,
    levels: Vec<f64>,
    /// By the ends of an edge, ascending: the corners in which it crosses levels, in the order of these.
    crossings: FxHashMap<[u32; 2], Vec<u32>>,
}

impl<Value: Fn([f32; 3]) -> f64> Cutter<'_, Value> {
    /// Cuts a triangle into the strips between the levels that cross it.
    fn cut(&mut self, triangle: [u32; 3], cut: &mut Vec<[u32; 3]>) {
        let mut ascending = triangle;
        ascending.sort_by(|a, b| self.value_of(*a).total_cmp(&self.value_of(*b)));
        let [lowest, middle, highest] = ascending;
        let levels = self.levels_between(lowest, highest);
        if levels.is_empty() {
            cut.push(triangle);
            return;
        }
        // Each level leads from the edge between the lowest and the highest corner to one of the two others, or, where that is too
        // short to be cut, to the corner between these.
        let near = self.crossings(levels.clone(), [lowest, highest]);
        let mut far = vec![middle; near.len()];
        for edge in [[lowest, middle], [middle, highest]] {
            let crossed = self.levels_between(edge[0], edge[1]);
            let first = crossed.start.wrapping_sub(levels.start);
            for (number, corner) in self.crossings(crossed, edge).into_iter().enumerate() {
                far[first + number] = corner;
            }
        }
        let below_middle =
            self.levels[levels].partition_point(|level| *level < self.value_of(middle));
        let next = |corner: u32| {
            (0..3)
                .find(|at| triangle[*at] == corner)
                .map(|at| triangle[(at + 1) % 3])
        };
        let is_turned = next(lowest) != Some(middle);
        let mut around: Vec<u32> = Vec::with_capacity(5);
        for strip in 0..=near.len() {
            around.clear();
            match strip.checked_sub(1) {
                Some(before) => around.extend([near[before], far[before]]),
                None => around.push(lowest),
            }
            if strip == below_middle {
                around.push(middle);
            }
            match near.get(strip) {
                Some(corner) => around.extend([far[strip], *corner]),
                None => around.push(highest),
            }
            around.dedup();
            let start = self.fan_start(&around, middle);
            around.rotate_left(start);
            for pair in around.get(1..).unwrap_or_default().windows(2) {
                let [a, b, c] = [around[0], pair[0], pair[1]];
                cut.push(if is_turned { [a, c, b] } else { [a, b, c] });
            }
        }
    }

    /// The corner of a convex polygon with up to five from which its triangles spread: of a quadrangle an end of its shorter diagonal,
    /// otherwise this one.
    fn fan_start(&self, around: &[u32], corner: u32) -> usize {
        let place = |number: usize| Vec3::from(self.surface.positions[around[number] as usize]);
        if around.len() == 4 {
            let diagonal = |number: usize| place(number).distance_squared(place(number + 2));
            return usize::from(diagonal(1) < diagonal(0));
        }
        around
            .iter()
            .position(|other| *other == corner)
            .unwrap_or(0)
    }

    fn value_of(&self, corner: u32) -> f64 {
        self.values[corner as usize]
    }

    /// The levels that are to cut an edge, which rises from the first corner to the second.
    fn levels_between(&self, from: u32, to: u32) -> Range<usize> {
        let [low, high] = [from, to].map(|corner| self.value_of(corner));
        let first = self.levels.partition_point(|level| *level <= low);
        if high - low > self.least {
            first
                ..self
                    .levels
                    .partition_point(|level| *level < high)
                    .max(first)
        } else {
            first..first
        }
    }

    /// The corners in which an edge crosses these levels, which are all that are to cut it.
    fn crossings(&mut self, levels: Range<usize>, [a, b]: [u32; 2]) -> Vec<u32> {
        if levels.is_empty() {
            return Vec::new();
        }
        let edge = [a.min(b), a.max(b)];
        if let Some(corners) = self.crossings.get(&edge) {
            return corners.clone();
        }
        // Corners that are in one place may have several numbers: from the lower place on, all their edges are cut in one place.
        let place = |corner: u32| self.surface.positions[corner as usize];
        let order = place(a)
            .iter()
            .zip(&place(b))
            .map(|(a, b)| a.total_cmp(b))
            .find(|order| order.is_ne());
        let ends = match order {
            Some(Ordering::Greater) => [b, a],
            _ => [a, b],
        };
        let falls = self.value_of(ends[0]) > self.value_of(ends[1]);
        let mut numbers: Vec<usize> = levels.collect();
        if falls {
            numbers.reverse();
        }
        let mut corners = Vec::with_capacity(numbers.len());
        let mut before = (0.0, self.value_of(ends[0]));
        for level in numbers.into_iter().map(|number| self.levels[number]) {
            let share = self.share(ends, before, level);
            before = (share, level);
            corners.push(self.values.len() as u32);
            add_between(self.surface, ends.map(|end| end as usize), share as f32);
            self.values.push(level);
        }
        if falls {
            corners.reverse();
        }
        self.crossings.insert(edge, corners.clone());
        corners
    }

    /// The share of an edge after which it crosses a level; `before` is a share before that, and the value there.
    fn share(&self, ends: [u32; 2], before: (f64, f64), level: f64) -> f64 {
        let [a, b] = ends.map(|end| Vec3::from(self.surface.positions[end as usize]));
        let [mut low, mut high] = [before.0, 1.0];
        let [mut at_low, mut at_high] =
            [before.1, self.value_of(ends[1])].map(|value| value - level);
        let mut share = low;
        for _ in 0..STEPS {
            share = low + (high - low) * at_low / (at_low - at_high);
            let off = (self.value)(a.lerp(b, share as f32).to_array()) - level;
            if off.abs() <= NEAR * self.least {
                break;
            }
            if (off < 0.0) == (at_low < 0.0) {
                (low, at_low) = (share, off);
            } else {
                (high, at_high) = (share, off);
            }
        }
        share.clamp(LEAST, 1.0 - LEAST)
    }
}

/// Adds a corner on an edge of a surface.
fn add_between(surface: &mut Surface, [a, b]: [usize; 2], share: f32) {
    let between = |list: &mut Vec<[f32; 3]>, is_unit: bool| {
        if let (Some(a), Some(b)) = (list.get(a), list.get(b)) {
            let between = Vec3::from(*a).lerp(Vec3::from(*b), share);
            list.push(if is_unit {
                between.normalize_or_zero().to_array()
            } else {
                between.to_array()
            });
        }
    };
    between(&mut surface.positions, false);
    between(&mut surface.normals, true);
    let targets = surface.targets.iter_mut();
    targets.for_each(|target| between(target, false));
    if let (Some(a), Some(b)) = (surface.uvs.get(a), surface.uvs.get(b)) {
        let uv = Vec2::from(*a).lerp(Vec2::from(*b), share);
        surface.uvs.push(uv.to_array());
    }
}
