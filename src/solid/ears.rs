//! Ear clipping that keeps every point of the rings and never fails.
//!
//! Holes are first joined to the border by bridges (Eberly, "Triangulation by Ear Clipping").
//! This is for small polygons, and for those that the sweep cannot triangulate. However bad the rings, the
//! triangles' outer edges are the rings' edges.

use std::ops::Range;

use glam::DVec2;

use super::border::Border;
use super::cells::Cells;
use crate::geometry::bounds_of;

/// Polygons with more corners than this have a grid, in which those near an ear are found.
const FEW: usize = 256;

/// A corner of the remaining ring, a node of a linked list.
#[derive(Clone, Copy)]
struct Corner {
    point: u32,
    next: u32,
    before: u32,
}

/// The requirements on an ear, from the strictest.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Care {
    /// It has area, and no other corner is in it or on its border.
    Clean,
    /// It has area, and no other corner is strictly in it.
    Empty,
    /// It has area.
    Convex,
    /// None.
    Any,
}

struct Clip<'a> {
    points: &'a [DVec2],
    corners: Vec<Corner>,
    /// Twice the area below which a triangle counts as degenerate.
    nothing: f64,
}

/// Triangulates a polygon: a border and holes, given as ranges of a list of points. With n points and
/// h holes, that gives n + 2h − 2 triangles.
pub(super) fn clip(points: &[DVec2], rings: &[Range<usize>], triangles: &mut Vec<[u32; 3]>) {
    let Some(border) = rings.first() else { return };
    let Some((low, high)) = bounds_of(points[border.clone()].iter().copied()) else {
        return;
    };
    let extent = (high - low).max_element();
    let mut clip = Clip {
        points,
        corners: Vec::with_capacity(border.len() + 2 * rings.len()),
        nothing: 1e-13 * extent * extent,
    };
    clip.add(border);
    let mut holes: Vec<(usize, &Range<usize>)> = Vec::new();
    for ring in &rings[1..] {
        let leftmost = ring
            .clone()
            .min_by(|a, b| points[*a].x.total_cmp(&points[*b].x));
        holes.extend(leftmost.map(|i| (i, ring)));
    }
    holes.sort_unstable_by(|a, b| points[a.0].x.total_cmp(&points[b.0].x));
    clip.join(&holes, rings);
    clip.cut([low, high], triangles);
}

impl Clip<'_> {
    fn add(&mut self, ring: &Range<usize>) {
        let base = self.corners.len();
        let n = ring.len();
        self.corners
            .extend(ring.clone().enumerate().map(|(i, point)| Corner {
                point: point as u32,
                next: (base + (i + 1) % n) as u32,
                before: (base + (i + n - 1) % n) as u32,
            }));
    }

    fn at(&self, corner: u32) -> DVec2 {
        self.points[self.corners[corner as usize].point as usize]
    }

    fn next(&self, corner: u32) -> u32 {
        self.corners[corner as usize].next
    }

    fn before(&self, corner: u32) -> u32 {
        self.corners[corner as usize].before
    }

    fn edge(&self, corner: u32) -> [DVec2; 2] {
        [self.at(corner), self.at(self.next(corner))]
    }

    /// Joins holes to the border. Each is given with its leftmost point, from the left to the right.
    fn join(&mut self, holes: &[(usize, &Range<usize>)], rings: &[Range<usize>]) {
        if holes.is_empty() {
            return;
        }
        let all = || rings.iter().flat_map(|ring| &self.points[ring.clone()]);
        let (low, high) = bounds_of(all().copied()).unwrap_or_default();
        let mut border = Border::new([low, high], all().count() + 2 * holes.len());
        for corner in 0..self.corners.len() as u32 {
            border.add(self.edge(corner));
        }
        for (leftmost, ring) in holes {
            self.join_hole(&mut border, *leftmost, ring);
        }
    }

    /// Joins a hole to the border, from the hole's leftmost point to the left.
    fn join_hole(&mut self, border: &mut Border, leftmost: usize, ring: &Range<usize>) {
        let bridge = self.bridge(border, self.points[leftmost]);
        let base = self.corners.len() as u32;
        self.add(ring);
        let entry = base + (leftmost - ring.start) as u32;
        // Both ends of the bridge occur twice: once on the way in, once on the way out.
        let (out, back) = (self.corners.len() as u32, self.corners.len() as u32 + 1);
        let after = self.next(bridge);
        let last = self.before(entry);
        self.corners.push(Corner {
            point: leftmost as u32,
            next: back,
            before: last,
        });
        let point = self.corners[bridge as usize].point;
        self.corners.push(Corner {
            point,
            next: after,
            before: out,
        });
        self.corners[last as usize].next = out;
        self.corners[after as usize].before = back;
        self.corners[bridge as usize].next = entry;
        self.corners[entry as usize].before = bridge;
        for corner in base..back {
            border.add(self.edge(corner));
        }
        border.split(bridge, self.edge(bridge));
    }

    /// The corner of the border to which a hole is joined from its leftmost point.
    fn bridge(&self, border: &Border, hole: DVec2) -> u32 {
        // The nearest edge to the left, and where the line meets it; the earliest of several.
        let mut nearest: Option<(f64, u32)> = None;
        border.leftward(hole, |corner| {
            let [p, q] = self.edge(corner);
            if (p.y > hole.y) == (q.y > hole.y) {
                return None;
            }
            let x = p.x + (q.x - p.x) * ((hole.y - p.y) / (q.y - p.y));
            if x > hole.x {
                return None;
            }
            if nearest.is_none_or(|(most, first)| x > most || (x == most && corner < first)) {
                nearest = Some((x, corner));
            }
            Some(x)
        });
        match nearest {
            Some((x, corner)) => {
                let [p, q] = self.edge(corner);
                let end = if p.x < q.x { corner } else { self.next(corner) };
                self.visible(border, hole, DVec2::new(x, hole.y), end)
            }
            // Only damaged rings have holes that nothing is to the left of.
            None => (0..self.corners.len() as u32)
                .min_by(|a, b| {
                    let far = |c: u32| self.at(c).distance_squared(hole);
                    far(*a).total_cmp(&far(*b))
                })
                .unwrap_or(0),
        }
    }

    /// The corner that is visible from a hole's point: the end of the edge it meets, unless others are in
    /// between; then the one of those nearest to the line.
    fn visible(&self, border: &Border, hole: DVec2, meets: DVec2, end: u32) -> u32 {
        let mut best = end;
        let tip = self.at(end);
        let slope = |p: DVec2| (p.y - hole.y).abs() / (hole.x - p.x).max(f64::MIN_POSITIVE);
        let mut least = (slope(tip), hole.x - tip.x);
        let wound = if tip.y > hole.y {
            [hole, tip, meets]
        } else {
            [hole, meets, tip]
        };
        for corner in border.corners_near(wound) {
            let p = self.at(corner);
            if corner == end || p.x > hole.x || !self.faces(corner, hole) {
                continue;
            }
            let rank = (slope(p), hole.x - p.x);
            if within(wound, p, 0.0) && (rank < least || (p == tip && !self.faces(best, hole))) {
                (best, least) = (corner, rank);
            }
        }
        best
    }

    /// Whether a point is in the inner angle of a corner.
    fn faces(&self, corner: u32, p: DVec2) -> bool {
        let (a, b, c) = (
            self.at(self.before(corner)),
            self.at(corner),
            self.at(self.next(corner)),
        );
        let (from, to, way) = (c - b, a - b, p - b);
        if from.perp_dot(to) > 0.0 {
            from.perp_dot(way) >= 0.0 && way.perp_dot(to) >= 0.0
        } else {
            !(to.perp_dot(way) > 0.0 && way.perp_dot(from) > 0.0)
        }
    }

    /// Cuts off the ears of the ring, which has this box.
    fn cut(&mut self, bounds: [DVec2; 2], triangles: &mut Vec<[u32; 3]>) {
        let mut left = self.corners.len();
        let mut reflex = Reflex::new(bounds, left);
        for corner in (0..left as u32).filter(|corner| self.is_reflex(*corner)) {
            reflex.add(corner, self.corners[corner as usize].point, self.at(corner));
        }
        let mut care = Care::Clean;
        let mut corner = 0;
        let mut tried = 0;
        while left > 3 {
            if self.is_ear(corner, &reflex, care) {
                let (before, next) = (self.before(corner), self.next(corner));
                triangles.push([before, corner, next].map(|c| self.corners[c as usize].point));
                self.corners[before as usize].next = next;
                self.corners[next as usize].before = before;
                left -= 1;
                reflex.remove(corner, self.at(corner));
                for neighbor in [before, next] {
                    if !self.is_reflex(neighbor) {
                        reflex.remove(neighbor, self.at(neighbor));
                    }
                }
                // Skipping one makes fewer slivers than a fan does.
                corner = self.next(next);
                (care, tried) = (Care::Clean, 0);
            } else {
                corner = self.next(corner);
                tried += 1;
                if tried > left {
                    tried = 0;
                    care = match care {
                        Care::Clean => Care::Empty,
                        Care::Empty => Care::Convex,
                        Care::Convex | Care::Any => Care::Any,
                    };
                }
            }
        }
        let (before, next) = (self.before(corner), self.next(corner));
        triangles.push([before, corner, next].map(|c| self.corners[c as usize].point));
    }

    fn is_reflex(&self, corner: u32) -> bool {
        let (a, b, c) = (
            self.at(self.before(corner)),
            self.at(corner),
            self.at(self.next(corner)),
        );
        (b - a).perp_dot(c - b) <= self.nothing
    }

    fn is_ear(&self, corner: u32, reflex: &Reflex, care: Care) -> bool {
        let ends = [self.before(corner), corner, self.next(corner)];
        let ear = ends.map(|c| self.at(c));
        let area = (ear[1] - ear[0]).perp_dot(ear[2] - ear[1]);
        if care == Care::Any {
            return true;
        }
        if area <= self.nothing {
            return false;
        }
        if care == Care::Convex {
            return true;
        }
        let margin = if care == Care::Clean {
            -self.nothing
        } else {
            self.nothing
        };
        let points = ends.map(|c| self.corners[c as usize].point);
        !reflex.any_near(ear, |other| {
            within(ear, other.place, margin) && !points.contains(&other.point)
        })
    }
}

/// The reflex corners: only they can be in an ear. Their positions are stored contiguously, because most of the time is
/// spent on reading them.
struct Reflex {
    cells: Cells,
    /// Per cell.
    lists: Vec<Vec<Other>>,
    /// Per corner its index in the list of its cell.
    numbers: Vec<u32>,
}

struct Other {
    place: DVec2,
    point: u32,
    corner: u32,
}

impl Reflex {
    const NONE: u32 = u32::MAX;

    /// None yet, of a ring with this box and so many corners.
    fn new(bounds: [DVec2; 2], corners: usize) -> Self {
        let is_small = corners <= FEW;
        let cells = Cells::over(bounds, if is_small { 1.0 } else { corners as f64 });
        let mut lists: Vec<Vec<Other>> = Vec::new();
        lists.resize_with(cells.count(), Vec::new);
        Self {
            cells,
            lists,
            numbers: vec![Self::NONE; corners],
        }
    }

    fn add(&mut self, corner: u32, point: u32, place: DVec2) {
        let list = &mut self.lists[self.cells.nearest(place)];
        self.numbers[corner as usize] = list.len() as u32;
        list.push(Other {
            place,
            point,
            corner,
        });
    }

    /// Removes a corner at this place, if it is there.
    fn remove(&mut self, corner: u32, place: DVec2) {
        let number = std::mem::replace(&mut self.numbers[corner as usize], Self::NONE);
        if number != Self::NONE {
            let list = &mut self.lists[self.cells.nearest(place)];
            list.swap_remove(number as usize);
            if let Some(moved) = list.get(number as usize) {
                self.numbers[moved.corner as usize] = number;
            }
        }
    }

    /// Whether this is true of any that may be in a triangle.
    fn any_near(&self, triangle: [DVec2; 3], is: impl Fn(&Other) -> bool) -> bool {
        if let [all] = &self.lists[..] {
            return all.iter().any(is);
        }
        self.cells
            .any_of_triangle(triangle, |cell| self.lists[cell].iter().any(&is))
    }
}

fn within([a, b, c]: [DVec2; 3], p: DVec2, margin: f64) -> bool {
    (b - a).perp_dot(p - a) >= margin
        && (c - b).perp_dot(p - b) >= margin
        && (a - c).perp_dot(p - c) >= margin
}
