//! The rings of an outline in one list of points.

use std::ops::Range;

use glam::DVec2;

use crate::geometry::Outline;

/// All points of an outline, with each point's neighbours on its ring.
#[derive(Default)]
pub(super) struct Rings {
    pub(super) points: Vec<DVec2>,
    pub(super) next: Vec<u32>,
    pub(super) before: Vec<u32>,
    /// The range of points of each ring.
    pub(super) rings: Vec<Range<usize>>,
    /// The range of rings of each polygon.
    pub(super) polygons: Vec<Range<usize>>,
}

impl Rings {
    pub(super) fn of(outline: &Outline) -> Rings {
        let count = outline.point_count();
        let mut all = Rings {
            points: Vec::with_capacity(count),
            next: Vec::with_capacity(count),
            before: Vec::with_capacity(count),
            ..Rings::default()
        };
        for polygon in &outline.polygons {
            let start = all.rings.len();
            for ring in polygon.rings.iter().filter(|ring| ring.len() > 2) {
                all.push(ring.iter().copied());
            }
            all.polygons.push(start..all.rings.len());
        }
        all
    }

    /// One polygon of one ring.
    pub(super) fn of_one(ring: impl Iterator<Item = DVec2>) -> Rings {
        let mut all = Rings::default();
        all.push(ring);
        all.polygons.push(0..1);
        all
    }

    fn push(&mut self, ring: impl Iterator<Item = DVec2>) {
        let start = self.points.len();
        self.points.extend(ring);
        let end = self.points.len();
        self.next.extend((start..end).map(|i| i as u32 + 1));
        self.before
            .extend((start..end).map(|i| (i as u32).wrapping_sub(1)));
        self.next[end - 1] = start as u32;
        self.before[start] = end as u32 - 1;
        self.rings.push(start..end);
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The largest absolute coordinate.
    pub(super) fn extent(&self) -> f64 {
        self.points
            .iter()
            .fold(0.0, |most, p| p.abs().max_element().max(most))
    }

    /// Moves the point opposite to the longest edge of each triangle away from that edge.
    pub(super) fn widen(&mut self, triangles: &[[u32; 3]], by: f64) {
        for corners in triangles {
            let [a, b, c] = corners.map(|i| self.points[i as usize]);
            let longest = [(a, b, 2), (b, c, 0), (c, a, 1)]
                .into_iter()
                .max_by(|l, r| l.0.distance(l.1).total_cmp(&r.0.distance(r.1)));
            if let Some((from, to, tip)) = longest {
                self.points[corners[tip] as usize] += (to - from).perp().normalize_or_zero() * by;
            }
        }
    }
}
