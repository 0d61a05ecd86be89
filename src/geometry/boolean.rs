//! Boolean operations on outlines: valid polygons from rings that may cross, touch, overlap or repeat themselves.
//!
//! Input and output have y down, so borders have a negative shoelace sum (the module's convention: counter-clockwise
//! where y is up). Rings that are valid already keep their points (`disjoint.rs`). All others are rounded to a grid of
//! about 1/4,000,000 of their extent, where `i_overlay` finds crossings with integers; that is fine enough for the
//! `f32` that the model is written in.

use std::cell::RefCell;

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule as GridRule;
use i_overlay::core::overlay::{ContourDirection, IntOverlayOptions, Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

use super::query::{bounds, bounds_of, shoelace};
use super::tangled::{Crossings, MAX_CROSSINGS, MAX_PICTURED, crossings, pictured};
use super::touching::{separate, touches};
use super::{FillRule, Outline, Polygon, Ring, disjoint};
use crate::budget::{self, Step};
use crate::math;

/// Grid steps per extent of an outline. The finest grid cannot always separate rings that touch from rings that nearly
/// touch in the same place; then the next coarser one is tried.
const GRID_STEPS: [f64; 3] = [
    (1u32 << 22) as f64,
    (1u32 << 17) as f64,
    (1u32 << 13) as f64,
];
/// Points closer than this to the line between their neighbours are dropped, relative to the extent.
const COLLINEAR: f64 = 5e-7;
/// Edges at this distance from each other cannot meet on the finest grid, relative to the extent.
const MIN_CLEARANCE: f64 = 1e-6;
/// How many crossings the picture of an area that has too many takes as long as.
const TANGLED: usize = 50_000;
/// Rings with a smaller average width are dropped, relative to the extent.
const SLIVER: f64 = 1e-6;
/// Extents outside of this range are not drawn geometry: their squares would overflow or vanish.
const VALID_EXTENTS: std::ops::Range<f64> = 1e-60..1e60;

/// The area that rings enclose by a fill rule, as valid polygons. If they cross more than 20,000 times, it is exact to
/// within about 1/2,000 of their extent, or less where it has very many pieces.
pub fn resolve_overlaps(rings: Vec<Ring>, rule: FillRule) -> Outline {
    resolve_crossings(rings, rule, MAX_PICTURED).0
}

/// The same, and how often the rings cross, which the time grows with. More than 20,000 times count as 50,000; then the area has about
/// so many points at most.
pub(crate) fn resolve_crossings(rings: Vec<Ring>, rule: FillRule, most: usize) -> (Outline, usize) {
    resolve(rings, rule, false).unwrap_or_else(|tangled| {
        // What is left crosses where rings touch only, unless it is all dots.
        let area = resolve(pictured(&tangled, rule, most), FillRule::EvenOdd, true);
        (area.unwrap_or_default().0, TANGLED)
    })
}

/// The area and how often the rings cross, or the rings without repetitions if they cross too often, or lie in one another too densely
/// although they are not from a picture.
fn resolve(
    mut rings: Vec<Ring>,
    rule: FillRule,
    is_pictured: bool,
) -> Result<(Outline, usize), Vec<Ring>> {
    for ring in &mut rings {
        if !ring.iter().all(|p| p.is_finite()) {
            ring.retain(|p| p.is_finite());
        }
    }
    rings.retain(|ring| ring.len() > 2);
    let Some(mut grid) = Grid::over(rings.iter().flatten(), GRID_STEPS[0]) else {
        return Ok((Outline::default(), 0));
    };
    let flat = COLLINEAR * grid.extent;
    for ring in &mut rings {
        remove_collinear(ring, flat);
    }
    rings.retain(|ring| ring.len() > 2);
    let mut simple = match &rings[..] {
        [ring] if is_convex(ring) => true,
        rings => disjoint::are_disjoint(rings, MIN_CLEARANCE * grid.extent),
    };
    let mut crossed = 0;
    if !simple {
        let Crossings {
            count,
            is_dense,
            is_better_along_y,
        } = crossings(&rings);
        if count > MAX_CROSSINGS || (is_dense && !is_pictured) {
            return Err(rings);
        }
        grid.is_turned = is_better_along_y;
        if count == 0 {
            simple = is_simple(&rings, &grid);
        }
        crossed = count;
    }
    if simple && rings.len() <= disjoint::MAX_NESTED_RINGS {
        rings.retain(|ring| !is_sliver(ring, grid.extent));
        return Ok((disjoint::nest(rings, rule), 0));
    }
    budget::count(Step::Point, rings.iter().map(Vec::len).sum());
    let rule = match rule {
        FillRule::NonZero => GridRule::NonZero,
        FillRule::EvenOdd => GridRule::EvenOdd,
    };
    let mut outline = Outline::default();
    for steps in GRID_STEPS {
        let Some(mut coarse) = Grid::over(rings.iter().flatten(), steps) else {
            break;
        };
        coarse.is_turned = grid.is_turned;
        let shapes = overlay(rings.iter(), &coarse, rule);
        let touches;
        (outline, touches) = finish(shapes, &coarse);
        if !touches || is_disjoint(&outline, &grid) {
            break;
        }
    }
    Ok((outline, crossed))
}

fn overlay<'a>(rings: impl Iterator<Item = &'a Ring>, grid: &Grid, rule: GridRule) -> GridShapes {
    let shapes = OVERLAY.with_borrow_mut(|overlay| {
        overlay.clear();
        for ring in rings {
            let path = ring.iter().map(|p| grid.point(*p));
            overlay.add_path_iter(path, ShapeType::Subject);
        }
        overlay.overlay(OverlayRule::Subject, rule)
    });
    widen(shapes)
}

/// Whether no rings of an outline cross or touch.
fn is_disjoint(outline: &Outline, grid: &Grid) -> bool {
    let rings = || outline.rings();
    let shapes = overlay(rings(), grid, GridRule::NonZero);
    let count = |rings: usize, points: usize| (rings, points);
    let found = shapes.iter().flatten();
    count(rings().count(), rings().map(Vec::len).sum())
        == count(found.clone().count(), found.map(Vec::len).sum())
        && !touches(&shapes)
}

/// The area that two outlines have in common.
pub fn intersect(a: &Outline, b: &Outline) -> Outline {
    let (Some((a_low, a_high)), Some((b_low, b_high))) = (bounds(a), bounds(b)) else {
        return Outline::default();
    };
    if !(a_low.max(b_low).cmplt(a_high.min(b_high))).all() {
        return Outline::default();
    }
    if is_box_around(b, a_low, a_high) {
        return a.clone();
    }
    if is_box_around(a, b_low, b_high) {
        return b.clone();
    }
    combine(&[a], &[b], OverlayRule::Intersect)
}

/// The area that the first of two outlines covers, and the second does not.
pub(crate) fn subtract(a: &Outline, b: &Outline) -> Outline {
    if a.polygons.is_empty() || b.polygons.is_empty() {
        return a.clone();
    }
    combine(&[a], &[b], OverlayRule::Difference)
}

/// The area that at least one of some outlines covers.
pub(crate) fn union(outlines: &[Outline]) -> Outline {
    let filled: Vec<_> = outlines.iter().filter(|o| !o.polygons.is_empty()).collect();
    match filled[..] {
        [] => Outline::default(),
        [one] => one.clone(),
        _ => combine(&filled, &[], OverlayRule::Subject),
    }
}

fn combine(subjects: &[&Outline], clips: &[&Outline], rule: OverlayRule) -> Outline {
    let points = |outlines: &[&Outline]| -> Vec<DVec2> {
        let polygons = outlines.iter().flat_map(|o| &o.polygons);
        polygons
            .flat_map(|p| p.rings.iter().flatten())
            .copied()
            .collect()
    };
    let (subject, clip) = (points(subjects), points(clips));
    budget::count(Step::Point, subject.len() + clip.len());
    // The finer grid is used: a small part under a large clip must keep its shape.
    let grids = [&subject, &clip].map(|points| Grid::over(points.iter(), GRID_STEPS[0]));
    let finer = grids
        .into_iter()
        .flatten()
        .min_by(|a, b| a.extent.total_cmp(&b.extent));
    let Some(grid) = finer else {
        return Outline::default();
    };
    let shapes = FAR_OVERLAY.with_borrow_mut(|overlay| {
        overlay.clear();
        for (outlines, kind) in [(subjects, ShapeType::Subject), (clips, ShapeType::Clip)] {
            for ring in outlines.iter().flat_map(|outline| outline.rings()) {
                overlay.add_path_iter(ring.iter().map(|p| grid.far_point(*p)), kind);
            }
        }
        overlay.overlay(rule, GridRule::NonZero)
    });
    let shapes = shapes.into_iter().map(|shape| {
        let rings = shape
            .into_iter()
            .map(|ring| ring.into_iter().map(|p| [p.x, p.y]).collect());
        rings.collect()
    });
    let (outline, touches) = finish(shapes.collect(), &grid);
    if touches {
        let rings = outline.polygons.into_iter().flat_map(|p| p.rings);
        return resolve_overlaps(rings.collect(), FillRule::NonZero);
    }
    outline
}

fn is_box_around(outline: &Outline, low: DVec2, high: DVec2) -> bool {
    let [Polygon { rings }] = &outline.polygons[..] else {
        return false;
    };
    let [ring] = &rings[..] else { return false };
    ring.len() == 4
        && (0..4).all(|i| {
            let edge = ring[(i + 1) % 4] - ring[i];
            edge.x == 0.0 || edge.y == 0.0
        })
        && bounds(outline).is_some_and(|(l, h)| l.cmple(low).all() && h.cmpge(high).all())
}

thread_local! {
    static OVERLAY: RefCell<Overlay<i32>> =
        RefCell::new(Overlay::new_custom(64, options(), Default::default()));
    static FAR_OVERLAY: RefCell<Overlay<i64>> =
        RefCell::new(Overlay::new_custom(64, options(), Default::default()));
}

fn options<U: i_overlay::i_float::int::number::uint::UIntNumber>() -> IntOverlayOptions<U> {
    IntOverlayOptions {
        output_direction: ContourDirection::Clockwise,
        // A point where another ring touches an edge has to stay, or the touch would not be found.
        preserve_output_collinear: true,
        ..Default::default()
    }
}

/// Points of rings of polygons, in grid steps.
pub(super) type GridShapes = Vec<Vec<Vec<[i64; 2]>>>;

fn widen(shapes: Vec<Vec<Vec<IntPoint<i32>>>>) -> GridShapes {
    let ring = |ring: Vec<IntPoint<i32>>| ring.iter().map(|p| [p.x.into(), p.y.into()]).collect();
    let shape = |shape: Vec<Vec<_>>| shape.into_iter().map(ring).collect();
    shapes.into_iter().map(shape).collect()
}

/// The outline of shapes on a grid, and whether any of them touched and had to be separated.
fn finish(shapes: GridShapes, grid: &Grid) -> (Outline, bool) {
    let mut polygons: Vec<Polygon> = shapes
        .iter()
        .map(|shape| Polygon {
            rings: shape
                .iter()
                .map(|ring| ring.iter().map(|p| grid.back(*p)).collect())
                .collect(),
        })
        .collect();
    let touches = separate(&shapes, &mut polygons, grid.extent);
    for polygon in &mut polygons {
        for ring in &mut polygon.rings {
            remove_collinear(ring, COLLINEAR * grid.extent);
            if is_sliver(ring, grid.extent) {
                ring.clear();
            }
        }
        if polygon.rings.first().is_some_and(Vec::is_empty) {
            polygon.rings.clear();
        }
        polygon.rings.retain(|ring| !ring.is_empty());
    }
    polygons.retain(|polygon| !polygon.rings.is_empty());
    (Outline { polygons }, touches)
}

/// Drops points that lie within `flat` of the line through their neighbours: repeated points, points on straight edges
/// and the tips of spikes.
pub(crate) fn remove_collinear(ring: &mut Ring, flat: f64) {
    loop {
        let n = ring.len();
        if n < 3 {
            ring.clear();
            return;
        }
        if (0..n).all(|i| {
            let (a, c) = (ring[(i + n - 1) % n], ring[(i + 1) % n]);
            is_corner(a, ring[i], c, flat)
        }) {
            return;
        }
        let mut kept: Ring = Vec::with_capacity(n);
        for i in 0..n {
            let p = ring[i];
            // Of two points that are close together one has to stay, also where the ring begins.
            let next = match ring.get(i + 1) {
                Some(next) => *next,
                None => kept.first().copied().unwrap_or(ring[0]),
            };
            let before = kept.last().copied().unwrap_or(ring[n - 1]);
            if is_corner(before, p, next, flat) {
                kept.push(p);
            }
        }
        *ring = kept;
    }
}

fn is_corner(a: DVec2, b: DVec2, c: DVec2, flat: f64) -> bool {
    let (ab, bc) = (b - a, c - b);
    let (near, far) = (ab.length_squared(), bc.length_squared());
    let cross = ab.perp_dot(bc);
    near.min(far) > flat * flat && cross * cross > flat * flat * near.max(far)
}

/// Whether a ring is convex: it turns the same way at every point, once around.
pub(crate) fn is_convex(ring: &[DVec2]) -> bool {
    let n = ring.len();
    let mut before = ring[n - 1] - ring[n - 2];
    let mut start = ring[n - 1];
    let way = before.perp_dot(ring[0] - start);
    let mut turns = 0;
    for &p in ring {
        let edge = p - start;
        let turn = before.perp_dot(edge) * way;
        if turn <= 0.0 || turn.is_nan() {
            return false;
        }
        turns += usize::from((before.x >= 0.0) != (edge.x >= 0.0));
        (before, start) = (edge, p);
    }
    turns <= 2
}

/// Whether a single ring does not cross or touch itself on the grid.
fn is_simple(rings: &[Ring], grid: &Grid) -> bool {
    let [ring] = rings else { return false };
    let path: Vec<_> = ring.iter().map(|p| grid.point(*p)).collect();
    OVERLAY.with_borrow_mut(|overlay| overlay.simplify_contour(&path, GridRule::NonZero).is_none())
}

fn is_sliver(ring: &Ring, extent: f64) -> bool {
    let mut around = 0.0;
    let mut before = ring.last().copied().unwrap_or_default();
    for &p in ring {
        around += (p - before).length();
        before = p;
    }
    shoelace(ring).abs() <= SLIVER * extent * around / 2.0
}

/// A square grid over an area.
struct Grid {
    origin: DVec2,
    step: f64,
    /// The larger extent of the area.
    extent: f64,
    /// Whether points are turned by a right angle on the grid, which is swept along x.
    is_turned: bool,
}

impl Grid {
    /// `None` if the extent is not a usable number.
    fn over<'a>(points: impl Iterator<Item = &'a DVec2>, steps: f64) -> Option<Grid> {
        let (low, high) = bounds_of(points.copied())?;
        let extent = (high - low).max_element();
        if !VALID_EXTENTS.contains(&extent) {
            return None;
        }
        // A power of two, so that round coordinates survive the rounding unchanged.
        let step = math::exp2(math::log2(extent / steps).ceil());
        let origin = (low.midpoint(high) / step).round() * step;
        origin.is_finite().then_some(Grid {
            origin,
            step,
            extent,
            is_turned: false,
        })
    }

    fn steps(&self, p: DVec2) -> DVec2 {
        let p = ((p - self.origin) / self.step).round();
        if self.is_turned { p.perp() } else { p }
    }

    fn point(&self, p: DVec2) -> IntPoint<i32> {
        let p = self.steps(p);
        IntPoint::new(p.x as i32, p.y as i32)
    }

    /// Points of other outlines may lie far off the grid; they are clamped.
    fn far_point(&self, p: DVec2) -> IntPoint<i64> {
        let far = DVec2::splat((1u64 << 60) as f64);
        let p = self.steps(p).clamp(-far, far);
        IntPoint::new(p.x as i64, p.y as i64)
    }

    fn back(&self, [x, y]: [i64; 2]) -> DVec2 {
        let p = DVec2::new(x as f64, y as f64);
        let p = if self.is_turned { -p.perp() } else { p };
        self.origin + p * self.step
    }
}

#[cfg(test)]
#[path = "boolean_tests.rs"]
mod tests;
