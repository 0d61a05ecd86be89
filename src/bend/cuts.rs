//! Cuts triangles across a limb, so that they can follow a bend.

use rustc_hash::FxHashMap;

use glam::{Vec2, Vec3};

use crate::scene::Surface;

/// Steps of the search for the place at which an edge crosses a level.
const STEPS: usize = 6;
/// A cut is at least this share of an edge away from its ends.
const LEAST: f64 = 1e-3;

/// Cuts the edges of a surface where a value crosses these levels, which are ascending, if it changes by more than `least` along the
/// edge: what is short enough need not be cut. `value` gives that of a point. Edges that
/// triangles share stay shared, and the surface stays what it is. Returns the values of all corners.
pub(super) fn cut(
    surface: &mut Surface,
    value: impl Fn([f32; 3]) -> f64,
    least: f64,
    levels: impl Iterator<Item = f64>,
) -> Vec<f64> {
    let values = surface.positions.iter().map(|at| value(*at)).collect();
    let mut cutter = Cutter {
        surface,
        value,
        values,
        least,
        cuts: FxHashMap::default(),
    };
    for level in levels {
        cutter.cut(level);
    }
    cutter.values
}

struct Cutter<'a, Value> {
    surface: &'a mut Surface,
    value: Value,
    /// Per corner its value.
    values: Vec<f64>,
    least: f64,
    /// The corners on the level by the edges that they cut, whose ends are ascending.
    cuts: FxHashMap<[u32; 2], u32>,
}

impl<Value: Fn([f32; 3]) -> f64> Cutter<'_, Value> {
    fn cut(&mut self, level: f64) {
        self.cuts.clear();
        let triangles = std::mem::take(&mut self.surface.triangles);
        let mut out = Vec::with_capacity(triangles.len());
        for triangle in triangles {
            let is_crossed = |corners: [u32; 2]| {
                let [a, b] = corners.map(|corner| self.values[corner as usize]);
                (a - b).abs() > self.least && ((a < level && b > level) || (a > level && b < level))
            };
            let [a, b, c] = triangle;
            let edges = [[a, b], [b, c], [c, a]];
            let crossed = edges.map(is_crossed);
            // Turned so that the edges that are cut come first.
            let turn = match crossed {
                [false, true, _] => 1,
                [false, false, true] | [true, false, true] => 2,
                _ => 0,
            };
            let at = |corner: usize| (corner + turn) % 3;
            let [a, b, c] = [0, 1, 2].map(|corner| triangle[at(corner)]);
            match [0, 1].map(|edge| crossed[at(edge)]) {
                [true, true] => {
                    let [ab, bc] = [[a, b], [b, c]].map(|edge| self.corner(edge, level));
                    out.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]);
                }
                [true, false] => {
                    let ab = self.corner([a, b], level);
                    out.extend([[a, ab, c], [ab, b, c]]);
                }
                _ => out.push(triangle),
            }
        }
        self.surface.triangles = out;
    }

    /// The corner in which an edge crosses a level.
    fn corner(&mut self, [a, b]: [u32; 2], level: f64) -> u32 {
        let edge = [a.min(b), a.max(b)];
        if let Some(corner) = self.cuts.get(&edge) {
            return *corner;
        }
        // Corners that are in one place may have several numbers: from the lower place on, all their edges are cut in one place.
        let place = |corner: u32| self.surface.positions[corner as usize];
        let order = place(a)
            .iter()
            .zip(&place(b))
            .map(|(a, b)| a.total_cmp(b))
            .find(|order| order.is_ne());
        let ends = match order {
            Some(std::cmp::Ordering::Greater) => [b, a],
            _ => [a, b],
        };
        let share = self.share(ends, level);
        let corner = self.values.len() as u32;
        add_between(self.surface, ends.map(|end| end as usize), share as f32);
        self.values.push(level);
        self.cuts.insert(edge, corner);
        corner
    }

    /// The share of an edge after which it crosses a level.
    fn share(&self, ends: [u32; 2], level: f64) -> f64 {
        let [a, b] = ends.map(|end| Vec3::from(self.surface.positions[end as usize]));
        let [mut low, mut high] = [0.0, 1.0];
        let [mut at_low, mut at_high] = ends.map(|end| self.values[end as usize] - level);
        let mut share = 0.5;
        for _ in 0..STEPS {
            share = low + (high - low) * at_low / (at_low - at_high);
            let off = (self.value)(a.lerp(b, share as f32).to_array()) - level;
            if off == 0.0 {
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
