//! The borders of labelled pixels.
//!
//! A border crosses the line between the centres of two neighbouring pixels, where their colours say. Between two nodes, the
//! places where more than two labels meet, it is simplified once for both of its sides, so that neighbours share it exactly.

use glam::DVec2;

use super::canvas::PAD;
use super::simplify::{simplified_arc, simplified_loop};
use crate::geometry::Ring;
use crate::regions::{Side, follow};

/// Borders may deviate by so much, pixels: those of small regions, and those between large ones.
const TOLERANCES: [f64; 2] = [0.3, 0.5];
/// The area of a large region, pixels.
const LARGE: usize = 2000;

/// Labelled pixels whose borders are wanted.
pub(super) struct Map<'a> {
    labels: &'a [u16],
    width: usize,
    /// By label, its pixels; the background counts as large.
    areas: Vec<usize>,
    /// By label, the pixels that have another label than the pixel to their right, one of both being the label.
    starts: Vec<Vec<u32>>,
    /// By pixel, the last trace that went down or up to its right.
    visited: Vec<u32>,
    traces: u32,
}

/// The borders of an area of one or more labels.
#[derive(Debug, Default)]
pub(super) struct Borders {
    /// In pixels of the picture, with the area on their right.
    pub(super) rings: Vec<Ring>,
    /// The borders' points before they are simplified.
    pub(super) dense: Vec<DVec2>,
    /// The pixels beside each of those points: one of the area, the other outside.
    pub(super) crossings: Vec<[usize; 2]>,
}

impl<'a> Map<'a> {
    pub(super) fn new(labels: &'a [u16], width: usize, count: usize) -> Self {
        let mut areas = vec![0; count];
        let mut starts = vec![Vec::new(); count];
        for (at, pair) in labels.windows(2).enumerate() {
            areas[usize::from(pair[0])] += 1;
            if pair[0] != pair[1] {
                starts[usize::from(pair[0])].push(at as u32);
                starts[usize::from(pair[1])].push(at as u32);
            }
        }
        if let Some(background) = areas.first_mut() {
            *background = usize::MAX;
        }
        Self {
            labels,
            width,
            areas,
            starts,
            visited: vec![0; labels.len()],
            traces: 0,
        }
    }

    pub(super) fn area(&self, label: u16) -> usize {
        self.areas[usize::from(label)]
    }

    /// The borders of the area of some labels. `crossing` is how far from the first pixel's centre to the second's the border
    /// between them runs, from 0 to 1, and must not depend on their order otherwise.
    pub(super) fn borders(
        &mut self,
        labels: &[u16],
        crossing: &impl Fn(usize, usize) -> f64,
    ) -> Borders {
        self.traces += 1;
        let mut is_inside = vec![false; self.areas.len()];
        for label in labels {
            is_inside[usize::from(*label)] = true;
        }
        let mut borders = Borders::default();
        for label in labels {
            let starts = std::mem::take(&mut self.starts[usize::from(*label)]);
            for &start in &starts {
                let (left, right) = (start as usize, start as usize + 1);
                let is_in = [left, right].map(|at| is_inside[usize::from(self.labels[at])]);
                let (inner, outer) = match is_in {
                    [true, false] => (left, right),
                    [false, true] => (right, left),
                    _ => continue,
                };
                if self.visited[left] != self.traces {
                    let start = Side { inner, outer };
                    let ring = self.trace(start, &is_inside, crossing, &mut borders);
                    borders.rings.extend((ring.len() > 2).then_some(ring));
                }
            }
            self.starts[usize::from(*label)] = starts;
        }
        borders
    }

    /// Follows a border until it closes.
    fn trace(
        &mut self,
        start: Side,
        is_inside: &[bool],
        crossing: &impl Fn(usize, usize) -> f64,
        borders: &mut Borders,
    ) -> Ring {
        let mut arcs = Arcs::default();
        let mut visited = std::mem::take(&mut self.visited);
        let is_in = |at: usize| is_inside[usize::from(self.labels[at])];
        follow(start, self.width, is_in, |side| {
            let Side { inner, outer } = side;
            if inner.abs_diff(outer) == 1 {
                visited[inner.min(outer)] = self.traces;
            }
            let point = self.point(inner, outer, crossing);
            borders.crossings.push([inner, outer]);
            borders.dense.push(point);
            arcs.push(point, self.tolerance(inner, outer));
            let ahead = side.ahead(self.width);
            let [next_outer, next_inner] = [outer, inner].map(|at| at.wrapping_add_signed(ahead));
            if let Some(node) = self.node([inner, outer, next_outer, next_inner], crossing) {
                arcs.push_node(node);
            }
        });
        self.visited = visited;
        arcs.ring()
    }

    fn tolerance(&self, a: usize, b: usize) -> f64 {
        let smaller = self.area(self.labels[a]).min(self.area(self.labels[b]));
        TOLERANCES[usize::from(smaller > LARGE)]
    }

    fn point(&self, a: usize, b: usize, crossing: &impl Fn(usize, usize) -> f64) -> DVec2 {
        // Both directions give the same point to the last bit.
        let (a, b) = (a.min(b), a.max(b));
        self.center(a).lerp(self.center(b), crossing(a, b))
    }

    fn center(&self, at: usize) -> DVec2 {
        let place = DVec2::new((at % self.width) as f64, (at / self.width) as f64);
        place + 0.5 - PAD as f64
    }

    /// Where the borders in a cell of four pixels meet, if it has more than one border.
    fn node(&self, cell: [usize; 4], crossing: &impl Fn(usize, usize) -> f64) -> Option<DVec2> {
        let changes = |i: usize| self.labels[cell[i]] != self.labels[cell[(i + 1) % 4]];
        if (0..4).filter(|i| changes(*i)).count() < 3 {
            return None;
        }
        let mut sorted = cell;
        sorted.sort_unstable();
        let [first, second, third, fourth] = sorted;
        let sides = [
            (first, second),
            (first, third),
            (second, fourth),
            (third, fourth),
        ];
        let mut sum = DVec2::ZERO;
        let mut count = 0.0;
        for (a, b) in sides {
            if self.labels[a] != self.labels[b] {
                sum += self.point(a, b, crossing);
                count += 1.0;
            }
        }
        Some(sum / count)
    }
}

/// A closed border as arcs between nodes.
#[derive(Debug, Default)]
struct Arcs {
    points: Vec<DVec2>,
    /// By point; infinite for nodes.
    tolerances: Vec<f64>,
}

impl Arcs {
    fn push(&mut self, point: DVec2, tolerance: f64) {
        self.points.push(point);
        self.tolerances.push(tolerance);
    }

    fn push_node(&mut self, point: DVec2) {
        self.push(point, f64::INFINITY);
    }

    /// The border, simplified between its nodes.
    fn ring(mut self) -> Ring {
        let first_node = self.tolerances.iter().position(|t| t.is_infinite());
        let Some(first_node) = first_node else {
            let tolerance = self.tolerances.first().copied().unwrap_or_default();
            return simplified_loop(&self.points, tolerance);
        };
        self.points.rotate_left(first_node);
        self.tolerances.rotate_left(first_node);
        self.points.push(self.points[0]);
        let mut ring = Ring::new();
        let mut from = 0;
        for to in 1..self.points.len() {
            let is_node = self.tolerances.get(to).is_none_or(|t| t.is_infinite());
            if is_node {
                let tolerance = self.tolerances[(from + 1).min(to - 1)];
                let arc = simplified_arc(&self.points[from..=to], tolerance);
                ring.extend_from_slice(&arc[..arc.len() - 1]);
                from = to;
            }
        }
        ring.dedup();
        ring
    }
}
