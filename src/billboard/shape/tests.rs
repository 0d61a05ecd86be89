//! Laws of shapes over generated regions.

mod generated;
mod lines;
mod several;

use glam::DVec2;

use self::generated::{Random, outline, pair};
use super::*;
use crate::geometry::{FillRule, Outline, Ring, area, bounds, intersect, resolve_overlaps};

const PAIRS: u64 = 320;
const BLENDS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// The points of a mesh with a weight for each view.
pub(super) fn blend(morph: &Morph, weights: &[f64]) -> Vec<DVec2> {
    let count = morph.points.first().map_or(0, Vec::len);
    let at = |i: usize| {
        let each = morph.points.iter().zip(weights);
        each.map(|(points, weight)| points[i] * *weight).sum()
    };
    (0..count).map(at).collect()
}

/// Positive if counter-clockwise with y up.
pub(super) fn signed_area(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let each = ring.iter().zip(next);
    each.map(|(a, b)| (*b - ring[0]).perp_dot(*a - ring[0]))
        .sum::<f64>()
        / 2.0
}

pub(super) fn rings_at(morph: &Morph, weights: &[f64]) -> Vec<Ring> {
    let points = blend(morph, weights);
    let ring = |ring: &Vec<u32>| ring.iter().map(|i| points[*i as usize]).collect();
    morph.rings.iter().map(ring).collect()
}

pub(super) fn ring_area(morph: &Morph, weights: &[f64]) -> f64 {
    rings_at(morph, weights)
        .iter()
        .map(|ring| signed_area(ring))
        .sum()
}

/// How far the areas of the triangles, signed and absolute, are from that of the rings, relative to it.
pub(super) fn coverage_error(morph: &Morph, weights: &[f64]) -> f64 {
    let points = blend(morph, weights);
    let (mut signed, mut absolute) = (0.0, 0.0);
    for triangle in &morph.triangles {
        let area = signed_area(&triangle.map(|i| points[i as usize]));
        signed += area;
        absolute += area.abs();
    }
    let area = ring_area(morph, weights);
    f64::max((signed - area).abs(), (absolute - area).abs()) / area.abs()
}

/// The weights of one view.
pub(super) fn only(view: usize, views: usize) -> Vec<f64> {
    (0..views)
        .map(|i| if i == view { 1.0 } else { 0.0 })
        .collect()
}

fn distance_to_border(outline: &Outline, point: DVec2) -> f64 {
    let rings = outline.rings();
    let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let distances = edges.map(|(a, b)| {
        let along = (point - *a).dot(*b - *a) / (*b - *a).length_squared();
        a.lerp(*b, along.clamp(0.0, 1.0)).distance(point)
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// Borders within 0.1 % of the extent and areas within 0.2 %, in every view.
#[track_caller]
pub(super) fn assert_reproduced(morph: &Morph, outlines: &[Outline], name: &str) {
    for (view, drawn) in outlines.iter().enumerate() {
        let made = resolve_overlaps(
            rings_at(morph, &only(view, outlines.len())),
            FillRule::NonZero,
        );
        let (low, high) = bounds(drawn).unwrap();
        let extent = (high - low).max_element();
        for (a, b) in [(&made, drawn), (drawn, &made)] {
            let points = a.polygons.iter().flat_map(|p| p.rings.iter().flatten());
            for point in points {
                let distance = distance_to_border(b, *point) / extent;
                assert!(distance < 1e-3, "{name}, view {view}: {distance}");
            }
        }
        let common = area(&intersect(&made, drawn));
        let ratio = common / (area(&made) + area(drawn) - common);
        assert!(ratio >= 0.998, "{name}, view {view}: {ratio}");
    }
}

#[track_caller]
pub(super) fn assert_valid(morph: &Morph, views: usize) {
    assert_eq!(morph.points.len(), views);
    let count = morph.points.first().map_or(0, Vec::len);
    for points in &morph.points {
        assert_eq!(points.len(), count);
        assert!(points.iter().all(|p| p.is_finite()), "{points:?}");
    }
    let indices = morph
        .triangles
        .iter()
        .flatten()
        .chain(morph.rings.iter().flatten());
    assert!(indices.into_iter().all(|i| (*i as usize) < count));
}

#[test]
fn drawn_views_are_reproduced() {
    for index in 0..PAIRS {
        let pair = pair(index);
        let morph = morph(&pair.outlines, &[]);
        assert_valid(&morph, 2);
        assert_reproduced(&morph, &pair.outlines, pair.name);
    }
}

#[test]
fn triangles_cover_the_shape_between_views() {
    for index in 0..PAIRS {
        let pair = pair(index);
        let morph = morph(&pair.outlines, &[]);
        for t in BLENDS {
            let error = coverage_error(&morph, &[1.0 - t, t]);
            assert!(error < 0.01, "{} {index} at {t}: {error}", pair.name);
        }
    }
}

#[test]
fn areas_between_views_are_between_theirs() {
    let mut outside = 0;
    for index in 0..PAIRS {
        let pair = pair(index);
        let morph = morph(&pair.outlines, &[]);
        let [first, last] = [0, 1].map(|view| area(&pair.outlines[view]));
        let is_outside = BLENDS.iter().any(|t| {
            let area = ring_area(&morph, &[1.0 - t, *t]);
            area < 0.95 * first.min(last) || area > 1.05 * first.max(last)
        });
        assert!(!(pair.is_convex && is_outside), "{} {index}", pair.name);
        outside += u64::from(is_outside);
    }
    assert!(outside * 100 <= PAIRS * 3, "{outside}");
}

#[test]
fn corners_belong_to_corners() {
    let mut count = 0;
    for index in 0..PAIRS {
        let pair = pair(index);
        if !["box", "arrow"].contains(&pair.name) {
            continue;
        }
        let morph = morph(&pair.outlines, &[]);
        let extent = bounds(&pair.outlines[1]).map(|(low, high)| (high - low).max_element());
        for (a, b) in morph.points.raw[0].iter().zip(&morph.points.raw[1]) {
            let distance = pair.map.transform_point2(*a).distance(*b);
            assert!(distance < 1e-3 * extent.unwrap(), "{} {index}", pair.name);
            count += 1;
        }
    }
    assert!(count >= 400, "{count}");
}

#[test]
fn a_view_that_is_the_same_changes_nothing() {
    for index in 0..40 {
        let [one, _] = pair(index).outlines;
        let morph = morph(&[one.clone(), one], &[]);
        for (a, b) in morph.points.raw[0].iter().zip(&morph.points.raw[1]) {
            assert!(a.distance(*b) < 1e-6, "{index}: {a} {b}");
        }
    }
}

#[test]
fn many_points_are_split_into_parts() {
    let wheel = |points: usize, phase: f64| {
        let radius = |angle: f64| 100.0 + 12.0 * (20.0 * angle + phase).sin();
        outline(vec![generated::curve(points, |angle| {
            DVec2::from_angle(angle) * radius(angle)
        })])
    };
    let outlines = [wheel(900, 0.0), wheel(700, 0.4)];
    let morph = morph(&outlines, &[]);
    assert!(
        morph.points.raw[0].len() > 300,
        "{}",
        morph.points.raw[0].len()
    );
    assert_reproduced(&morph, &outlines, "wheel");
    for t in BLENDS {
        let error = coverage_error(&morph, &[1.0 - t, t]);
        assert!(error < 0.01, "at {t}: {error}");
    }
}

#[test]
fn parts_do_not_reach_across_gaps() {
    // The ends of the horseshoe are nearer to each other than its sides.
    let horseshoe = |width: f64| {
        let at =
            |angle: f64, radius: f64| DVec2::from_angle(-angle) * DVec2::new(width, 1.0) * radius;
        let angle = |i: i32| 0.1 + (std::f64::consts::TAU - 0.2) * f64::from(i) / 400.0;
        let outer = (0..=400).map(|i| at(angle(i), 100.0 + 5.0 * (40.0 * angle(i)).sin()));
        let inner = (0..=400)
            .rev()
            .map(|i| at(angle(i), 60.0 + 5.0 * (40.0 * angle(i)).sin()));
        outline(vec![outer.chain(inner).collect()])
    };
    let outlines = [horseshoe(1.0), horseshoe(0.8)];
    let morph = morph(&outlines, &[]);
    assert!(
        morph.points.raw[0].len() > 260,
        "{}",
        morph.points.raw[0].len()
    );
    for t in BLENDS {
        let error = coverage_error(&morph, &[1.0 - t, t]);
        assert!(error < 1e-3, "at {t}: {error}");
    }
}

#[test]
fn smooth_contours_share_points() {
    let disc = |points| {
        outline(vec![generated::ellipse(
            points,
            DVec2::ZERO,
            DVec2::new(90.0, 70.0),
        )])
    };
    let morph = morph(&[disc(500), disc(431)], &[]);
    assert!(
        morph.points.raw[0].len() <= 128,
        "{}",
        morph.points.raw[0].len()
    );
}

#[test]
fn hostile_outlines_do_no_harm() {
    let mut random = Random(5);
    let odd = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e308,
        -1e308,
        1e-308,
        0.0,
        1e200,
    ];
    for case in 0..400 {
        let views = random.count(0, 4);
        let outlines: Vec<Outline> = (0..views)
            .map(|_| Outline {
                polygons: (0..random.count(0, 3))
                    .map(|_| crate::geometry::Polygon {
                        rings: (0..random.count(0, 3))
                            .map(|_| hostile_ring(&mut random, &odd))
                            .collect(),
                    })
                    .collect(),
            })
            .collect();
        let features: Vec<Vec<(String, DVec2)>> = (0..random.count(0, 4))
            .map(|_| {
                let each = hostile_ring(&mut random, &odd).into_iter().take(6);
                let names = each.map(|point| (random.count(0, 4).to_string(), point));
                names.collect()
            })
            .collect();
        let made = morph(&outlines, &features);
        assert_valid(&made, views);
        let again = morph(&outlines, &features);
        assert_eq!(made, again, "{case}");
    }
}

/// Crossing, repeated, flat, tiny, huge, and with numbers that are none.
pub(super) fn hostile_ring(random: &mut Random, odd: &[f64]) -> Ring {
    let count = random.count(0, 40);
    let kind = random.count(0, 5);
    let scale = [1.0, 1e-40, 1e50, 1e-300][random.count(0, 3)];
    let mut ring: Ring = (0..count)
        .map(|i| match kind {
            0 => DVec2::splat(i as f64),
            1 => DVec2::splat((i / 7) as f64),
            2 => DVec2::new((i % 3) as f64, (i % 2) as f64),
            _ => DVec2::new(random.within(-1.0, 1.0), random.within(-1.0, 1.0)),
        })
        .map(|p| p * scale)
        .collect();
    if kind == 4 && count > 0 {
        for _ in 0..3 {
            let at = random.count(0, count - 1);
            ring[at].x = odd[random.count(0, odd.len() - 1)];
        }
    }
    ring
}
