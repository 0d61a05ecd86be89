//! The rings of an outline in one list of points.

use std::ops::Range;

use glam::DVec2;

use crate::geometry::Outline;

/// All points of an outline and how they follow each other.
#[derive(Default)]
pub(super) struct Rings {
    pub(super) points: Vec<DVec2>,
    pub(super) next: Vec<u32>,
    pub(super) before: Vec<u32>,
    /// Where the rings stand in the points.
    pub(super) rings: Vec<Range<usize>>,
    /// Where the polygons stand in the rings.
    pub(super) polygons: Vec<Range<usize>>,
}

impl Rings {
    pub(super) fn of(outline: &Outline) -> Rings {
        let count = outline
            .polygons
            .iter()
            .flat_map(|p| &p.rings)
            .map(Vec::len)
            .sum();
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
}
