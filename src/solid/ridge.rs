//! Outlines that can be collapsed to a line without gaps.
//!
//! If every line in the direction of the collapse cuts the outline only once, its two sides collapse onto the same
//! line. They need the same points there, so each side is given the points of the other.

use glam::DVec2;

use super::rings::Rings;
use crate::geometry::{Outline, bounds_of};

/// Points whose positions along the line differ by less than this, relative to the extent, share a station.
const SAME: f64 = 1e-5;

/// Which scale goes to 0.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Collapse {
    /// x, across the axis: the line is the axis.
    Across,
    /// y, along the axis.
    Along,
}

/// A ring whose two sides both have a point at every station of the line.
pub(super) struct Matched {
    pub(super) rings: Rings,
    /// The station of every point, numbered along the line.
    pub(super) stations: Vec<u32>,
    /// The number of stations.
    pub(super) count: usize,
    /// The points as (collapsing coordinate, position along the line), rotated, not mirrored.
    turned: Vec<DVec2>,
}

/// The ring of an outline with matched sides; `None` if a line cuts it more than once.
pub(super) fn matched(outline: &Outline, collapse: Collapse) -> Option<Matched> {
    let [polygon] = &outline.polygons[..] else {
        return None;
    };
    let [ring] = &polygon.rings[..] else {
        return None;
    };
    let turn = |p: DVec2| match collapse {
        Collapse::Across => p,
        Collapse::Along => -p.perp(),
    };
    let back = |p: DVec2| match collapse {
        Collapse::Across => p,
        Collapse::Along => p.perp(),
    };
    let ring: Vec<DVec2> = ring.iter().map(|p| turn(*p)).collect();
    let (low, high) = bounds_of(ring.iter().copied()).unwrap_or_default();
    let same = SAME * (high - low).max_element();

    let mut places: Vec<f64> = ring.iter().map(|p| p.y).collect();
    places.sort_unstable_by(f64::total_cmp);
    let mut last = f64::NEG_INFINITY;
    places.retain(|&place| {
        let new = place - last > same;
        last = if new { place } else { last };
        new
    });
    let count = places.len();
    let top = (count - 1) as u32;
    if top == 0 {
        return None;
    }
    let station = |p: &DVec2| places.partition_point(|place| *place <= p.y) as u32 - 1;
    let old: Vec<u32> = ring.iter().map(station).collect();
    let n = ring.len();
    let start = (0..n).find(|&i| old[i] == 0 && old[(i + 1) % n] > 0)?;

    let mut turned: Vec<DVec2> = Vec::with_capacity(2 * n);
    let mut stations: Vec<u32> = Vec::with_capacity(2 * n);
    let mut falling = false;
    for k in 0..n {
        let (i, j) = ((start + k) % n, (start + k + 1) % n);
        let (from, to) = (old[i], old[j]);
        let here = DVec2::new(ring[i].x, places[from as usize]);
        turned.push(here);
        stations.push(from);
        falling |= from == top;
        if (falling && to > from) || (!falling && to < from) {
            return None;
        }
        let there = DVec2::new(ring[j].x, places[to as usize]);
        let mut between = |s: u32| {
            let y = places[s as usize];
            let x = here.x + (there.x - here.x) * ((y - here.y) / (there.y - here.y));
            turned.push(DVec2::new(x, y));
            stations.push(s);
        };
        if to > from {
            (from + 1..to).for_each(&mut between);
        } else {
            (to + 1..from).rev().for_each(&mut between);
        }
    }
    let matched = Matched {
        rings: Rings::of_one(turned.iter().map(|p| back(*p))),
        stations,
        count,
        turned,
    };
    matched.is_open(same).then_some(matched)
}

/// The points of one side at one station: the end of the step from below and the start of the step upwards.
#[derive(Clone, Copy)]
struct Side {
    below: u32,
    above: u32,
}

impl Matched {
    /// For every station its left and its right side.
    fn sides(&self) -> Vec<[Side; 2]> {
        let none = Side { below: 0, above: 0 };
        let mut sides = vec![[none; 2]; self.count];
        for (i, (j, s)) in self.rings.next.iter().zip(&self.stations).enumerate() {
            let (from, to) = (*s as usize, self.stations[*j as usize] as usize);
            if to > from {
                sides[from][1].above = i as u32;
                sides[to][1].below = *j;
            } else if to < from {
                sides[from][0].below = i as u32;
                sides[to][0].above = *j;
            }
        }
        sides[0] = sides[0].map(|Side { above, .. }| Side {
            below: above,
            above,
        });
        let top = &mut sides[self.count - 1];
        *top = top.map(|Side { below, .. }| Side {
            below,
            above: below,
        });
        sides
    }

    /// Whether both sides are apart between the ends and no step folds back.
    fn is_open(&self, same: f64) -> bool {
        let n = self.turned.len();
        let step = |i: usize| {
            let j = self.rings.next[i] as usize;
            (self.stations[i] == self.stations[j]).then(|| self.turned[j].x - self.turned[i].x)
        };
        let straight = (0..n).all(|i| match (step(i), step(self.rings.next[i] as usize)) {
            (Some(a), Some(b)) => a * b > 0.0,
            (Some(a), None) => a.abs() > same,
            _ => true,
        });
        let sides = self.sides();
        let x = |i: u32| self.turned[i as usize].x;
        straight
            && (1..self.count - 1).all(|s| {
                let [left, right] = sides[s];
                x(left.below).max(x(left.above)) + same < x(right.below).min(x(right.above))
            })
            && x(sides[0][0].above) <= x(sides[0][1].above)
            && x(sides[self.count - 1][0].below) <= x(sides[self.count - 1][1].below)
    }

    /// Triangles between neighbouring stations, counter-clockwise.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); self.count];
        for (i, s) in self.stations.iter().enumerate() {
            rows[*s as usize].push(i as u32);
        }
        let x = |i: u32| self.turned[i as usize].x;
        for row in &mut rows {
            row.sort_unstable_by(|a, b| x(*a).total_cmp(&x(*b)));
        }
        let sides = self.sides();
        let between = |row: &[u32], left: u32, right: u32| -> Vec<u32> {
            let inside = |i: &u32| x(left) <= x(*i) && x(*i) <= x(right);
            row.iter().copied().filter(inside).collect()
        };
        let mut triangles = Vec::with_capacity(self.turned.len());
        for s in 1..self.count {
            let low = between(&rows[s - 1], sides[s - 1][0].above, sides[s - 1][1].above);
            let high = between(&rows[s], sides[s][0].below, sides[s][1].below);
            let (mut i, mut j) = (0, 0);
            while i + 1 < low.len() || j + 1 < high.len() {
                let lower = j + 1 == high.len()
                    || (i + 1 < low.len()
                        && x(low[i]) + x(low[i + 1]) <= x(high[j]) + x(high[j + 1]));
                if lower {
                    triangles.push([low[i], low[i + 1], high[j]]);
                    i += 1;
                } else {
                    triangles.push([low[i], high[j + 1], high[j]]);
                    j += 1;
                }
            }
        }
        triangles
    }
}
