//! Regions with holes, of several polygons, in more than two views, and with feature points.

use glam::DVec2;

use super::generated::{ellipse, outline, pair};
use super::*;
use crate::geometry::Polygon;

fn hole(points: usize, middle: DVec2, half: DVec2) -> Ring {
    let mut ring = ellipse(points, middle, half);
    ring.reverse();
    ring
}

/// A disc with holes around its middle.
fn sieve(holes: usize, width: f64) -> Outline {
    let size = DVec2::new(width, 1.0);
    let mut rings = vec![ellipse(60, DVec2::ZERO, size * 100.0)];
    for i in 0..holes {
        let angle = 0.3 + 1.1 * i as f64;
        rings.push(hole(
            16,
            DVec2::from_angle(angle) * 60.0 * size,
            size * 15.0,
        ));
    }
    outline(rings)
}

#[track_caller]
fn assert_covered(morph: &Morph, views: usize) {
    let mut weights: Vec<Vec<f64>> = (0..views).map(|view| only(view, views)).collect();
    for b in 1..views {
        for a in 0..b {
            for t in [0.25, 0.5, 0.75] {
                let mut blend = vec![0.0; views];
                (blend[a], blend[b]) = (1.0 - t, t);
                weights.push(blend);
            }
        }
    }
    for weights in weights {
        let error = coverage_error(morph, &weights);
        assert!(error < 0.01, "{weights:?}: {error}");
    }
}

#[test]
fn holes_stay_holes() {
    let outlines = [sieve(5, 1.0), sieve(5, 0.7)];
    let morph = morph(&outlines, &[]);
    assert_valid(&morph, 2);
    assert_eq!(morph.rings.len(), 6);
    assert_reproduced(&morph, &outlines, "sieve");
    assert_covered(&morph, 2);
    // Each hole keeps its place.
    for ring in &morph.rings[1..] {
        let middle = |view: usize| {
            let points = ring.iter().map(|i| morph.points.raw[view][*i as usize]);
            points.sum::<DVec2>() / ring.len() as f64
        };
        let moved = (middle(0) * DVec2::new(0.7, 1.0)).distance(middle(1));
        assert!(moved < 3.0, "{moved}");
    }
}

#[test]
fn bridges_go_around_other_holes() {
    // The corner of the border that is nearest to the small hole is behind a slit.
    let plate = |width: f64| {
        let ring = |points: &[(f64, f64)]| -> Ring {
            let each = points.iter();
            each.map(|(x, y)| DVec2::new(x * width, *y)).collect()
        };
        outline(vec![
            ring(&[
                (0.0, 0.0),
                (0.0, 100.0),
                (100.0, 100.0),
                (100.0, 0.0),
                (50.0, 4.0),
            ]),
            ring(&[(10.0, 10.0), (90.0, 10.0), (90.0, 12.0), (10.0, 12.0)]),
            ring(&[(48.0, 18.0), (52.0, 18.0), (50.0, 22.0)]),
        ])
    };
    let outlines = [plate(1.0), plate(0.8)];
    let morph = morph(&outlines, &[]);
    assert_eq!(morph.rings.len(), 3);
    assert_reproduced(&morph, &outlines, "plate");
    for t in BLENDS {
        assert!(coverage_error(&morph, &[1.0 - t, t]) < 1e-6);
    }
}

#[test]
fn holes_without_a_partner_shrink_to_a_point_inside() {
    for outlines in [
        [sieve(5, 1.0), sieve(3, 0.7)],
        [sieve(0, 1.0), sieve(2, 0.8)],
    ] {
        let morph = morph(&outlines, &[]);
        assert_valid(&morph, 2);
        assert_reproduced(&morph, &outlines, "sieve");
        assert_covered(&morph, 2);
        let shrunk = morph.rings.iter().filter_map(|ring| {
            let view = (0..2).find(|view| {
                let points = &morph.points.raw[*view];
                ring.iter()
                    .all(|i| points[*i as usize] == points[ring[0] as usize])
            })?;
            Some((view, morph.points.raw[view][ring[0] as usize]))
        });
        let shrunk: Vec<(usize, DVec2)> = shrunk.collect();
        assert_eq!(shrunk.len(), 2);
        for (view, point) in shrunk {
            assert!(crate::geometry::contains(&outlines[view], point), "{point}");
        }
    }
}

#[test]
fn polygons_are_paired_by_place_and_size() {
    let row = |middles: &[(f64, f64)]| Outline {
        polygons: (middles.iter())
            .map(|(x, size)| Polygon {
                rings: vec![ellipse(
                    20,
                    DVec2::new(*x, 0.0),
                    DVec2::new(*size, 2.0 * *size),
                )],
            })
            .collect(),
    };
    // In another order, one missing.
    let outlines = [
        row(&[(0.0, 20.0), (60.0, 25.0), (120.0, 30.0)]),
        row(&[(100.0, 29.0), (0.0, 19.0)]),
    ];
    let morph = morph(&outlines, &[]);
    assert_valid(&morph, 2);
    assert_reproduced(&morph, &outlines, "row");
    assert_covered(&morph, 2);
    let middle = |ring: &Vec<u32>, view: usize| {
        let points = ring.iter().map(|i| morph.points.raw[view][*i as usize]);
        points.sum::<DVec2>() / ring.len() as f64
    };
    let moves: Vec<f64> = (morph.rings.iter())
        .map(|ring| middle(ring, 1).x - middle(ring, 0).x)
        .collect();
    assert_eq!(moves.len(), 3);
    assert!(
        moves[0].abs() < 1.0 && (moves[2] + 20.0).abs() < 1.0,
        "{moves:?}"
    );
    let point = middle(&morph.rings[1], 1);
    assert!(crate::geometry::contains(&outlines[1], point), "{point}");
}

#[test]
fn polygons_far_apart_are_no_pair() {
    let discs = |x: f64, y: f64| Outline {
        polygons: [(0.0, 0.0, 60.0), (x, y, 12.0)]
            .map(|(x, y, radius)| Polygon {
                rings: vec![ellipse(24, DVec2::new(x, y), DVec2::splat(radius))],
            })
            .to_vec(),
    };
    let outlines = [discs(-80.0, -80.0), discs(80.0, 80.0)];
    let morph = morph(&outlines, &[]);
    assert_eq!(morph.rings.len(), 3);
    assert_reproduced(&morph, &outlines, "discs");
}

#[test]
fn three_views_have_one_triangle_list() {
    for index in 0..64 {
        let [first, second] = pair(index).outlines;
        let third =
            first.map_rings(|ring| ring.iter().map(|p| DVec2::new(0.7 * p.x, p.y)).collect());
        let outlines = [first, second, third];
        let morph = morph(&outlines, &[]);
        assert_valid(&morph, 3);
        assert_reproduced(&morph, &outlines, "three views");
        assert_covered(&morph, 3);
    }
}

#[test]
fn a_view_without_the_region_has_a_point() {
    let [first, second] = pair(5).outlines;
    let outlines = [Outline::default(), first.clone(), second.clone()];
    let morph = morph(&outlines, &[]);
    assert_valid(&morph, 3);
    assert_reproduced(
        &Morph {
            points: morph.points.raw[1..].to_vec().into(),
            ..morph.clone()
        },
        &[first, second],
        "two of three",
    );
    assert!(
        morph.points.raw[0]
            .iter()
            .all(|p| *p == morph.points.raw[0][0])
    );
}

fn named(points: &[(&str, f64, f64)]) -> Vec<(String, DVec2)> {
    let each = points.iter();
    each.map(|(name, x, y)| ((*name).to_string(), DVec2::new(*x, *y)))
        .collect()
}

/// Where the point of the first view that is nearest to `from` is in the second.
fn carried(morph: &Morph, from: DVec2) -> (f64, DVec2) {
    let each = morph.points.raw[0].iter().zip(&morph.points.raw[1]);
    let distances = each.map(|(a, b)| (a.distance(from), *b));
    distances.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

#[test]
fn features_of_all_views_belong_together() {
    let disc = |points| outline(vec![ellipse(points, DVec2::ZERO, DVec2::splat(100.0))]);
    let outlines = [disc(60), disc(50)];
    // A quarter turn; `lost` is in one view only, and `twisted` is where no order allows it.
    let features = [
        named(&[
            ("a", 120.0, 0.0),
            ("b", 0.0, 110.0),
            ("lost", -90.0, 1.0),
            ("c", -100.0, 5.0),
            ("twisted", 80.0, 80.0),
        ]),
        named(&[
            ("c", -5.0, -100.0),
            ("b", -90.0, 0.0),
            ("a", 0.0, 80.0),
            ("twisted", 100.0, -100.0),
        ]),
    ];
    let morph = morph(&outlines, &features);
    assert_reproduced(&morph, &outlines, "turned disc");
    assert_covered(&morph, 2);
    for (from, to) in [((100.0, 0.0), (0.0, 100.0)), ((0.0, 100.0), (-100.0, 0.0))] {
        let (found, other) = carried(&morph, DVec2::from(from));
        assert!(found < 1.0, "{found}");
        assert!(other.distance(DVec2::from(to)) < 3.0, "{other}");
    }
    // Without them nothing turns.
    let morph = super::morph(&outlines, &[]);
    let (_, other) = carried(&morph, DVec2::new(100.0, 0.0));
    assert!(other.distance(DVec2::new(100.0, 0.0)) < 10.0, "{other}");
}

#[test]
fn features_improve_smooth_contours() {
    // The places that belong together are known; with four of them named, the others are nearer.
    let error = |named: usize| {
        let (mut sum, mut count) = (0.0, 0.0);
        for index in 0..PAIRS {
            let pair = pair(index);
            if pair.name != "blob" && pair.name != "ellipse" {
                continue;
            }
            let ring = &pair.outlines[0].polygons[0].rings[0];
            let at = |i: usize| ring[i * ring.len() / named.max(1)];
            let first = (0..named).map(|i| (i.to_string(), at(i)));
            let second = (0..named).map(|i| (i.to_string(), pair.map.transform_point2(at(i))));
            let morph = morph(&pair.outlines, &[first.collect(), second.collect()]);
            let extent = bounds(&pair.outlines[1]).map(|(low, high)| (high - low).max_element());
            for (a, b) in morph.points.raw[0].iter().zip(&morph.points.raw[1]) {
                sum += pair.map.transform_point2(*a).distance(*b) / extent.unwrap();
                count += 1.0;
            }
        }
        assert!(count > 1000.0);
        sum / count
    };
    let [without, with] = [error(0), error(4)];
    assert!(with < 0.02 && with < without / 2.0, "{without} {with}");
}
