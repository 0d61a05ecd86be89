//! A region's rings in all views, point for point.

use std::borrow::Borrow;

use glam::DVec2;

use super::contour::{Contour, Ends};
use super::features;
use super::pairs::{Item, pair};
use super::simplify::{Limits, simplify};
use super::unite::unite;
use crate::geometry::{Outline, Ring, bounds_of, shoelace};

/// Extents outside of this range are not drawn geometry: their squares would overflow or vanish.
const VALID_EXTENTS: std::ops::Range<f64> = 1e-60..1e60;
/// Rings with a smaller area relative to the squared extent are dropped.
const LEAST_AREA: f64 = 1e-9;
/// More holes of a polygon are filled, the smallest.
const MAX_HOLES: usize = 32;
/// What is dropped of a single contour before it is compared with others.
const OWN: Limits = Limits {
    fine: 1e-5,
    few: 1000,
    coarse: 2e-4,
    many: 2000,
};
/// The points of a polygon and its holes.
const JOINT: Limits = Limits {
    fine: 2e-5,
    few: 128,
    coarse: 4e-4,
    many: 1024,
};

/// The outlines in a common frame: y up, around the middle of each, relative to the largest extent.
#[derive(Debug)]
pub(super) struct Plane {
    /// For each view, its polygons: the border counter-clockwise, the holes clockwise.
    views: Vec<Vec<Vec<Ring>>>,
    middles: Vec<DVec2>,
    /// Relative to the scale.
    extents: Vec<f64>,
    scale: f64,
}

/// A polygon of a region with its holes.
#[derive(Debug)]
pub(super) struct MorphedPolygon {
    /// In each view, in the frame of [`Plane`].
    pub(super) points: Vec<Vec<DVec2>>,
    /// The border and the holes.
    pub(super) rings: Vec<Vec<u32>>,
}

impl Plane {
    /// `None` if no view has an area.
    pub(super) fn new(outlines: &[impl Borrow<Outline>]) -> Option<Self> {
        let mut views: Vec<Vec<Vec<Ring>>> = outlines
            .iter()
            .map(|outline| finite(outline.borrow()))
            .collect();
        let boxes: Vec<Option<(DVec2, DVec2)>> = views
            .iter()
            .map(|polygons| bounds(polygons.iter().filter_map(|rings| rings.first())))
            .collect();
        let extent = |bounds: &Option<(DVec2, DVec2)>| {
            let extent = bounds.map_or(0.0, |(low, high)| (high - low).max_element());
            if VALID_EXTENTS.contains(&extent) {
                extent
            } else {
                0.0
            }
        };
        let extents: Vec<f64> = boxes.iter().map(extent).collect();
        let scale = extents.iter().copied().fold(0.0, f64::max);
        if scale <= 0.0 {
            return None;
        }
        let first = extents.iter().position(|extent| *extent > 0.0)?;
        let middle = |bounds: &Option<(DVec2, DVec2)>| {
            bounds.map_or(DVec2::ZERO, |(low, high)| low.midpoint(high))
        };
        let mut middles: Vec<DVec2> = boxes.iter().map(middle).collect();
        for (view, extent) in extents.iter().enumerate() {
            if *extent <= 0.0 {
                views[view].clear();
                middles[view] = middles[first];
            }
        }
        let mut plane = Self {
            views: Vec::new(),
            extents: extents.iter().map(|extent| extent / scale).collect(),
            middles,
            scale,
        };
        for (view, polygons) in views.into_iter().enumerate() {
            let polygons = polygons.into_iter().filter_map(|rings| {
                let rings = rings.into_iter().enumerate();
                let ring = |(index, ring): (usize, Ring)| plane.ring(view, index, &ring);
                let mut rings = rings.map(ring);
                // Without a border there are no holes.
                let border = rings.next().flatten()?;
                let mut holes: Vec<Ring> = rings.flatten().collect();
                holes.sort_by(|a, b| shoelace(a).abs().total_cmp(&shoelace(b).abs()).reverse());
                holes.truncate(MAX_HOLES);
                Some([vec![border], holes].concat())
            });
            let polygons = polygons.collect();
            plane.views.push(polygons);
        }
        plane
            .views
            .iter()
            .any(|polygons| !polygons.is_empty())
            .then_some(plane)
    }

    /// A ring in this frame, without points that nobody sees.
    fn ring(&self, view: usize, index: usize, ring: &Ring) -> Option<Ring> {
        let extent = self.extents[view];
        let mut ring: Ring = ring.iter().map(|p| self.point(view, *p)).collect();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        let area = shoelace(&ring);
        let least = LEAST_AREA * extent * extent;
        if ring.len() < 3 || area.is_nan() || area.abs() <= least {
            return None;
        }
        if (area > 0.0) != (index == 0) {
            ring.reverse();
        }
        let rings = [vec![ring]];
        let kept = simplify(&rings, &[extent], OWN, Ends::Joined);
        let kept = kept.first()?.iter().map(|i| rings[0][0][*i]);
        Some(kept.collect())
    }

    fn point(&self, view: usize, point: DVec2) -> DVec2 {
        (point - self.middles[view]) / self.scale * DVec2::new(1.0, -1.0)
    }

    /// A point of each view.
    pub(super) fn to_frame(&self, points: &[DVec2]) -> Vec<DVec2> {
        let each = points.iter().enumerate();
        each.map(|(view, point)| self.point(view, *point)).collect()
    }

    /// Points of each view back to drawing units.
    pub(super) fn to_drawing(&self, views: &mut [Vec<DVec2>]) {
        for (view, middle) in views.iter_mut().zip(&self.middles) {
            for point in view {
                *point = *point * DVec2::new(self.scale, -self.scale) + *middle;
            }
        }
    }
}

/// A feature point in all views, in the frame of [`Plane`].
#[derive(Debug)]
struct Feature {
    points: Vec<DVec2>,
    /// In each view, the polygon and the ring of it that are nearest.
    on: Vec<[usize; 2]>,
}

/// The region's polygons, each with corresponding points in all views.
pub(super) fn polygons(plane: &Plane, features: Vec<Vec<DVec2>>) -> Vec<MorphedPolygon> {
    let features: Vec<Feature> = (features.into_iter())
        .map(|points| {
            let each = points.iter().zip(&plane.views);
            Feature {
                on: each
                    .map(|(point, polygons)| nearest(polygons, *point))
                    .collect(),
                points,
            }
        })
        .collect();
    let items: Vec<Vec<Item>> = (plane.views.iter().enumerate())
        .map(|(view, polygons)| {
            let frame = bounds(polygons.iter().filter_map(|rings| rings.first()));
            let each = polygons.iter().enumerate();
            each.map(|(index, rings)| {
                let on = features.iter().enumerate();
                let on = on.filter(|(_, feature)| feature.on[view][0] == index);
                item(&rings[0], frame, on.map(|(index, _)| index).collect())
            })
            .collect()
        })
        .collect();
    let groups = pair(&items);
    let each = groups.iter().map(|group| polygon(plane, group, &features));
    each.collect()
}

/// One polygon: `group` has its index in each view.
fn polygon(plane: &Plane, group: &[Option<usize>], features: &[Feature]) -> MorphedPolygon {
    let count = group.len();
    let borders: Vec<Option<&Ring>> = (0..count)
        .map(|view| group[view].map(|index| &plane.views[view][index][0]))
        .collect();
    let holes: Vec<&[Ring]> = (0..count)
        .map(|view| group[view].map_or(&[][..], |index| &plane.views[view][index][1..]))
        .collect();

    // In views without it, it is a point at the same place in the region's box.
    let home = borders.iter().position(Option::is_some).unwrap_or(0);
    let (low, high) = bounds(borders[home]).unwrap_or_default();
    let spots: Vec<DVec2> = (0..count)
        .map(|view| {
            let place = low.midpoint(high) / plane.extents[home] * plane.extents[view];
            inside(plane.views[view].iter().flatten(), place).unwrap_or_default()
        })
        .collect();
    let on = |view: usize, ring: usize| group[view].map(|polygon| [polygon, ring]);
    let each: Vec<_> = (0..count).map(|view| on(view, 0)).collect();
    let mut rings = vec![joined(&borders, &spots, &cut_by(&each, features))];

    let items: Vec<Vec<Item>> = (0..count)
        .map(|view| {
            let frame = bounds(borders[view]);
            let each = holes[view].iter().enumerate();
            each.map(|(index, hole)| {
                let on_it = features.iter().enumerate();
                let on_it = on_it.filter(|(_, f)| Some(f.on[view]) == on(view, index + 1));
                item(hole, frame, on_it.map(|(index, _)| index).collect())
            })
            .collect()
        })
        .collect();
    for group in pair(&items) {
        let ring: Vec<Option<&Ring>> = (0..count)
            .map(|view| group[view].map(|index| &holes[view][index]))
            .collect();
        let mut each = (0..count).filter_map(|view| Some(items[view][group[view]?].center));
        let center = each.next().unwrap_or_default();
        let spots: Vec<DVec2> = (0..count)
            .map(|view| {
                let Some((low, high)) = bounds(borders[view]) else {
                    return spots[view];
                };
                let within = borders[view].into_iter().chain(holes[view]);
                inside(within, low + (high - low) * center).unwrap_or(spots[view])
            })
            .collect();
        let each: Vec<_> = (0..count).map(|view| on(view, group[view]? + 1)).collect();
        rings.push(joined(&ring, &spots, &cut_by(&each, features)));
    }

    let kept = simplify(&rings, &plane.extents, JOINT, Ends::Joined);
    let mut points = vec![Vec::new(); count];
    let mut indices = Vec::new();
    let mut first = 0;
    for (ring, kept) in rings.iter().zip(&kept) {
        let end = first + kept.len() as u32;
        indices.push((first..end).collect());
        first = end;
        for (all, own) in points.iter_mut().zip(ring) {
            all.extend(kept.iter().map(|i| own[*i]));
        }
    }
    MorphedPolygon {
        points,
        rings: indices,
    }
}

/// The feature points that lie on a ring in all views that have it.
fn cut_by<'a>(on: &[Option<[usize; 2]>], features: &'a [Feature]) -> Vec<&'a Vec<DVec2>> {
    let lies_on = |feature: &&Feature| {
        let mut each = on.iter().zip(&feature.on);
        each.all(|(ring, on)| ring.is_none_or(|ring| ring == *on))
    };
    features
        .iter()
        .filter(lies_on)
        .map(|feature| &feature.points)
        .collect()
}

/// A ring's points in all views: the vertices of all of them. Where there is no ring they are all at the view's spot.
fn joined(rings: &[Option<&Ring>], spots: &[DVec2], features: &[&Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let contours: Vec<Option<Contour>> = (rings.iter())
        .map(|ring| ring.and_then(|ring| Contour::new(ring, Ends::Joined)))
        .collect();
    let cuts = features::cuts(&contours, features);
    unite(&contours, &cuts, spots)
}

fn item(ring: &Ring, frame: Option<(DVec2, DVec2)>, features: Vec<usize>) -> Item {
    let (low, high) = frame.unwrap_or_default();
    let size = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
    let (own_low, own_high) = bounds([ring]).unwrap_or_default();
    Item {
        center: (own_low.midpoint(own_high) - low) / size,
        area: shoelace(ring).abs() / (size.x * size.y),
        features,
    }
}

/// The polygon and the ring of it that are nearest to a point.
fn nearest(polygons: &[Vec<Ring>], point: DVec2) -> [usize; 2] {
    let mut nearest = (f64::INFINITY, [usize::MAX; 2]);
    for (polygon, rings) in polygons.iter().enumerate() {
        for (ring, points) in rings.iter().enumerate() {
            let contour = Contour::new(points, Ends::Joined);
            let distance = contour.map_or(f64::INFINITY, |c| c.nearest(point).1);
            if distance < nearest.0 {
                nearest = (distance, [polygon, ring]);
            }
        }
    }
    nearest.1
}

/// A point inside rings (even-odd) near a given one; `None` if they enclose nothing.
fn inside<'a>(rings: impl IntoIterator<Item = &'a Ring>, near: DVec2) -> Option<DVec2> {
    let rings: Vec<&Ring> = rings.into_iter().collect();
    let (low, high) = bounds(rings.iter().copied())?;
    let margin = (high.y - low.y) / 10.0;
    let y = near.y.clamp(low.y + margin, high.y - margin);
    let mut places: Vec<f64> = Vec::new();
    for ring in rings {
        let next = ring.iter().cycle().skip(1);
        for (a, b) in ring.iter().zip(next) {
            if (a.y > y) != (b.y > y) {
                places.push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
            }
        }
    }
    places.sort_by(f64::total_cmp);
    let spans = places.chunks_exact(2).map(|span| {
        let margin = (span[1] - span[0]) / 4.0;
        near.x
            .clamp(span[0] + margin, (span[1] - margin).max(span[0] + margin))
    });
    let nearest = spans.min_by(|a, b| (a - near.x).abs().total_cmp(&(b - near.x).abs()));
    nearest.map(|x| DVec2::new(x, y))
}

/// The polygons of an outline without points that are not finite.
fn finite(outline: &Outline) -> Vec<Vec<Ring>> {
    let ring = |ring: &Ring| ring.iter().copied().filter(|p| p.is_finite()).collect();
    let polygons = outline.polygons.iter();
    polygons
        .map(|polygon| polygon.rings.iter().map(ring).collect())
        .collect()
}

fn bounds<'a>(rings: impl IntoIterator<Item = &'a Ring>) -> Option<(DVec2, DVec2)> {
    bounds_of(rings.into_iter().flatten().copied())
}
