//! Ink: strokes without fill that are drawn on a shape belong to its part.
//!
//! A stroke is ink on the topmost earlier shape that holds nine tenths of it, else on the one that holds most of it, at least
//! half. A shape holds what lies in it, or beside it by less than three quarters of the stroke's width. The amounts are those
//! of points at equal distances along the stroke's centre line.

use std::sync::{Arc, OnceLock};

use glam::DVec2;
use rayon::prelude::*;
use rstar::primitives::Line;
use rstar::{AABB, PointDistance, RTree};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::areas;
use super::node_groups::PartSource;
use super::parts::MatchedPart;
use crate::bind::bindings::PartId;
use crate::geometry::{
    BoxTree, Outline, area_around, bounds, crosses, distance_squared, indexed_box,
};
use crate::index::par_keys;
use crate::memo::{Long, Memo, Same};
use crate::svg::{Drawing, Shape, ShapeId, StrokeSource};
use crate::threads::GRAIN;

/// How far beside a shape a point of a stroke may lie, in widths of the stroke.
const BESIDE: f64 = 0.75;
/// The share of a stroke on a shape from which on no lower shape is considered.
const WHOLE: f64 = 0.9;
/// The least share of a stroke on its shape.
const LEAST: f64 = 0.5;
/// The number of points along a stroke.
const SAMPLES: usize = 32;
/// The deviation of the centre line, as a share of the stroke's width.
const TOLERANCE: f64 = 0.1;
/// Limit of the shapes near a stroke that are looked at.
const MAX_NEAR: usize = 4096;
/// Limit of those whose outlines are compared with the stroke.
const MAX_COMPARED: usize = 64;
/// Outlines with more points are searched through an index.
const MANY_POINTS: usize = 256;

/// A drawing as far as ink depends on it: of each shape its area, its stroke, or neither of them.
#[derive(PartialEq, Eq, Hash)]
struct Question {
    shapes: Long<Role>,
}

/// What a shape may be.
#[derive(PartialEq, Eq, Hash)]
enum Role {
    Neither,
    /// Ink may lie on it.
    Host(Same<Outline>),
    /// It may be ink.
    Ink(Same<StrokeSource>),
}

/// Per shape, the shape on which it is ink. `is_free` says whether an unfilled shape may be ink, and `is_host` whether ink may lie
/// on a filled one.
pub(super) fn hosts(
    drawing: &Drawing,
    is_free: impl Fn(ShapeId) -> bool,
    is_host: impl Fn(ShapeId) -> bool,
    memo: &Memo,
) -> Arc<TiVec<ShapeId, Option<ShapeId>>> {
    let role = |(index, shape): (ShapeId, &Shape)| {
        let filled = !shape.outline.polygons.is_empty();
        match &shape.stroke {
            _ if filled && is_host(index) => Role::Host(Same(Arc::clone(&shape.outline))),
            Some(stroke) if !filled && is_free(index) => Role::Ink(Same(Arc::clone(stroke))),
            _ => Role::Neither,
        }
    };
    let shapes = drawing.shapes.iter_enumerated().map(role).collect();
    memo.get(Question { shapes }, Question::answer)
}

impl Question {
    fn answer(&self) -> Arc<TiVec<ShapeId, Option<ShapeId>>> {
        let roles: &TiSlice<ShapeId, Role> = TiSlice::from_ref(&self.shapes.0);
        if !roles.iter().any(|role| matches!(role, Role::Ink(_))) {
            return Arc::new(ti_vec![None; roles.len()]);
        }
        let area = |role: &Role| match role {
            Role::Host(outline) => Area::new(Arc::clone(&outline.0)),
            _ => None,
        };
        let areas: TiVec<ShapeId, Option<Area>> = roles.iter().map(area).collect();
        let boxes = areas.iter_enumerated().filter_map(|(index, area)| {
            let [low, high] = area.as_ref()?.bounds;
            Some(indexed_box((low, high), index))
        });
        let tree = BoxTree::bulk_load(boxes.collect());
        let host = |index: ShapeId| match &roles[index] {
            Role::Ink(stroke) => {
                let width = stroke.0.width();
                let points = along(&stroke.0, TOLERANCE * width);
                host(&points, BESIDE * width, index, &areas, &tree)
            }
            _ => None,
        };
        let hosts: Vec<_> = par_keys(roles).with_min_len(GRAIN).map(host).collect();
        Arc::new(hosts.into())
    }
}

/// Points at equal distances along a stroke's centre line.
pub(super) fn along(stroke: &StrokeSource, tolerance: f64) -> Vec<DVec2> {
    let mut segments: Vec<[DVec2; 2]> = Vec::new();
    stroke.middle_line(tolerance, |from, to| segments.push([from, to]));
    let total: f64 = segments.iter().map(|[from, to]| from.distance(*to)).sum();
    if !(total.is_finite() && total > 0.0) {
        // A dot.
        return segments
            .first()
            .map(|[from, _]| *from)
            .into_iter()
            .collect();
    }
    let mut points = Vec::with_capacity(SAMPLES);
    let mut passed = 0.0;
    for [from, to] in segments {
        let length = from.distance(to);
        while points.len() < SAMPLES {
            let rest = (points.len() as f64 + 0.5) / SAMPLES as f64 * total - passed;
            if rest > length {
                break;
            }
            points.push(from.lerp(to, rest / length));
        }
        passed += length;
    }
    points
}

/// The shape, of those before `before`, that holds a stroke.
fn host(
    points: &[DVec2],
    reach: f64,
    before: ShapeId,
    areas: &TiSlice<ShapeId, Option<Area>>,
    tree: &BoxTree<ShapeId>,
) -> Option<ShapeId> {
    let first = points.first()?;
    let (low, high) = points.iter().fold((*first, *first), |(low, high), point| {
        (low.min(*point), high.max(*point))
    });
    let near = area_around((low, high), reach);
    let count = |share: f64| (share * points.len() as f64).ceil() as usize;
    let is_large_enough = |index: &ShapeId| {
        let Some(area) = &areas[*index] else {
            return false;
        };
        let [low, high] = area.bounds;
        let around = |point: &&DVec2| {
            let close = point.clamp(low, high);
            close.distance_squared(**point) <= reach * reach
        };
        points.iter().filter(around).count() >= count(LEAST)
    };
    let mut found: Vec<ShapeId> = tree
        .locate_in_envelope_intersecting(near)
        .map(|area| area.data)
        .filter(|index| *index < before)
        .take(MAX_NEAR)
        .filter(is_large_enough)
        .collect();
    found.sort_unstable_by_key(|index| std::cmp::Reverse(*index));
    found.truncate(MAX_COMPARED);
    let mut best = None;
    for index in found {
        let most = best.map_or(count(LEAST), |(held, _)| held + 1);
        let area = areas[index].as_ref();
        let Some(held) = area.and_then(|area| area.holds(points, reach, most)) else {
            continue;
        };
        best = Some((held, index));
        if held >= count(WHOLE) {
            break;
        }
    }
    best.map(|(_, index)| index)
}

/// An area that ink may lie on.
struct Area {
    outline: Arc<Outline>,
    bounds: [DVec2; 2],
    has_many_points: bool,
    /// The edges of an outline with many points.
    edges: OnceLock<RTree<Line<[f64; 2]>>>,
}

impl Area {
    fn new(outline: Arc<Outline>) -> Option<Self> {
        let (low, high) = bounds(&outline)?;
        let has_many_points = outline.point_count() > MANY_POINTS;
        Some(Self {
            outline,
            bounds: [low, high],
            has_many_points,
            edges: OnceLock::new(),
        })
    }

    /// How many of the points it holds; `None` if they are fewer than `least`.
    fn holds(&self, points: &[DVec2], reach: f64, least: usize) -> Option<usize> {
        let mut missing = points.len().checked_sub(least)?;
        for point in points {
            if !self.is_near(*point, reach) {
                missing = missing.checked_sub(1)?;
            }
        }
        Some(least + missing)
    }

    /// Whether a point is in the area or at most `reach` away from it.
    fn is_near(&self, point: DVec2, reach: f64) -> bool {
        let [low, high] = self.bounds;
        let limit = reach * reach;
        if point.clamp(low, high).distance_squared(point) > limit {
            return false;
        }
        if !self.has_many_points {
            return distance_squared(&self.outline, point) <= limit;
        }
        let edges = self.edges.get_or_init(|| edges(&self.outline));
        let ray = AABB::from_corners(point.to_array(), [high.x.max(point.x), point.y]);
        let crossed = edges
            .locate_in_envelope_intersecting(ray)
            .filter(|edge| crosses([edge.from.into(), edge.to.into()], point));
        let nearest = || edges.nearest_neighbor(point.to_array());
        crossed.count() % 2 == 1
            || nearest().is_some_and(|edge| edge.distance_2(&point.to_array()) <= limit)
    }
}

fn edges(outline: &Outline) -> RTree<Line<[f64; 2]>> {
    let rings = outline.rings();
    let edges = rings.flat_map(|ring| {
        let next = ring.iter().cycle().skip(1);
        let pairs = ring.iter().zip(next);
        pairs.map(|(from, to)| Line::new(from.to_array(), to.to_array()))
    });
    RTree::bulk_load(edges.collect())
}

/// Gives ink its host: the part that is the fill of the shape on which it lies. Ink on what is no part is left out.
pub(super) fn attach(drawn: Vec<(PartSource, areas::Area)>) -> TiVec<PartId, MatchedPart> {
    let mut part_of_shape: FxHashMap<ShapeId, PartId> = FxHashMap::default();
    let mut attached: TiVec<PartId, MatchedPart> = TiVec::new();
    for (source, area) in drawn {
        let index = attached.next_key();
        let mut part = MatchedPart::new(index, &source, area);
        if let Some(host) = source.host {
            let Some(host) = part_of_shape.get(&host) else {
                continue;
            };
            part.host = Some(*host);
        } else if !part.is_stroke {
            part_of_shape.insert(part.shape, index);
        }
        attached.push(part);
    }
    attached
}
