use super::super::query::{area, contains, distance_squared};
use super::super::tangled::sweeps_better_along_y;
use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn ring(points: &[(f64, f64)]) -> Ring {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn square(x: f64, y: f64, size: f64) -> Ring {
    ring(&[(x, y), (x + size, y), (x + size, y + size), (x, y + size)])
}

fn star(points: usize, step: usize) -> Ring {
    let at = |i: usize| DVec2::from_angle((i * step % points) as f64 / points as f64 * TAU);
    (0..points).map(at).collect()
}

/// Rings per polygon.
fn shape(outline: &Outline) -> Vec<usize> {
    let mut rings: Vec<_> = outline.polygons.iter().map(|p| p.rings.len()).collect();
    rings.sort();
    rings
}

/// Checks the module's conventions, except for crossings.
fn check(outline: &Outline) {
    let mut seen: Vec<[u64; 2]> = Vec::new();
    for polygon in &outline.polygons {
        assert!(!polygon.rings.is_empty());
        for (i, ring) in polygon.rings.iter().enumerate() {
            assert!(ring.len() > 2);
            assert_eq!(shoelace(ring) < 0.0, i == 0, "{ring:?}");
            seen.extend(ring.iter().map(|p| [p.x.to_bits(), p.y.to_bits()]));
        }
    }
    let count = seen.len();
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), count, "points coincide: {outline:?}");
}

fn checked(rings: Vec<Ring>, rule: FillRule) -> Outline {
    let outline = resolve_overlaps(rings, rule);
    check(&outline);
    outline
}

fn assert_area(rings: &[Ring], nonzero: f64, even_odd: f64) {
    for (rule, expected) in [(FillRule::NonZero, nonzero), (FillRule::EvenOdd, even_odd)] {
        let found = area(&checked(rings.to_vec(), rule));
        assert!(
            (found - expected).abs() <= 1e-3 * expected,
            "{rule:?} {found} {expected}"
        );
    }
}

#[test]
fn simple_rings_keep_their_points() {
    let l = ring(&[
        (0.1, 0.),
        (0.1, 3.),
        (1., 3.),
        (1., 1.),
        (2.7, 1.),
        (2.7, 0.),
    ]);
    for points in [square(0.1, 0.3, 7.7), l] {
        for reversed in [points.clone(), points.iter().rev().copied().collect()] {
            let outline = checked(vec![reversed], FillRule::NonZero);
            let mut found = outline.polygons[0].rings[0].clone();
            let mut expected = points.clone();
            found.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            expected.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
            assert_eq!(found, expected);
        }
    }
}

#[test]
fn crossing_rings_follow_the_fill_rule() {
    let (outer, inner) = (1.0, (TAU / 20.0).sin() / (3.0 * TAU / 20.0).sin());
    let whole = 5.0 * outer * inner * (TAU / 10.0).sin();
    let core = 2.5 * inner * inner * (TAU / 5.0).sin();
    assert_area(&[star(5, 2)], whole, whole - core);
    assert_area(
        &[ring(&[(0., 0.), (10., 10.), (10., 0.), (0., 10.)])],
        50.0,
        50.0,
    );
    assert_area(&[square(0., 0., 10.), square(5., 5., 10.)], 175.0, 150.0);
}

#[test]
fn superfluous_points_are_dropped() {
    let rough = ring(&[
        (0., 0.),
        (5., 0.),
        (5., 0.),
        (10., 0.),
        (10., 10.),
        (10., 10.),
        (0., 10.),
        (0., 5.),
    ]);
    let spike = ring(&[
        (0., 0.),
        (10., 0.),
        (10., 5.),
        (20., 5.),
        (10., 5.),
        (10., 10.),
        (0., 10.),
    ]);
    // Programs close a path close to its first point, but not exactly there.
    let nearly_closed = ring(&[(0., 1e-6), (10., 0.), (10., 10.), (0., 10.), (0., 0.)]);
    for mut rough in [rough, spike, nearly_closed] {
        for _ in 0..rough.len() {
            rough.rotate_left(1);
            for reversed in [rough.clone(), rough.iter().rev().copied().collect()] {
                let outline = checked(vec![reversed], FillRule::NonZero);
                assert_eq!(outline.polygons[0].rings[0].len(), 4);
                assert!((area(&outline) - 100.0).abs() < 1e-3);
            }
        }
    }
}

#[test]
fn holes_and_islands() {
    let nested = [square(0., 0., 9.), square(1., 1., 7.), square(2., 2., 5.)];
    let outline = checked(nested.to_vec(), FillRule::EvenOdd);
    assert_eq!(shape(&outline), [1, 2]);
    assert!((area(&outline) - (81.0 - 49.0 + 25.0)).abs() < 1e-3);
    let at = |x| contains(&outline, DVec2::new(x, 4.5));
    assert_eq!([0.5, 1.5, 4.0].map(at), [true, false, true]);
    assert!((distance_squared(&outline, DVec2::new(1.75, 4.5)) - 0.0625).abs() < 1e-6);
    assert_eq!(distance_squared(&outline, DVec2::new(4.0, 4.5)), 0.0);
    assert_eq!(bounds(&outline), Some((DVec2::ZERO, DVec2::splat(9.0))));
    assert_eq!(
        shape(&resolve_overlaps(nested.to_vec(), FillRule::NonZero)),
        [1]
    );
}

#[test]
fn touching_rings_are_separated() {
    let corners = checked(
        vec![square(0., 0., 1.), square(1., 1., 1.)],
        FillRule::NonZero,
    );
    assert_eq!(shape(&corners), [1, 1]);
    let tip = ring(&[(0., 4.), (3., 2.), (3., 6.)]);
    let on_edge = checked(vec![square(0., 0., 9.), tip], FillRule::EvenOdd);
    assert!((area(&on_edge) - 75.0).abs() < 0.01);
    let on_corner = ring(&[(0., 0.), (5., 2.), (2., 5.)]);
    let on_corner = checked(vec![square(0., 0., 9.), on_corner], FillRule::EvenOdd);
    assert!((area(&on_corner) - (81.0 - 10.5)).abs() < 0.01);
    let checks = (0..16).filter(|i| (i / 4 + i) % 2 == 0);
    let checks: Vec<_> = checks
        .map(|i| square((i % 4) as f64, (i / 4) as f64, 1.))
        .collect();
    assert!((area(&checked(checks, FillRule::EvenOdd)) - 8.0).abs() < 0.01);
}

#[test]
fn empty_input_gives_empty_outlines() {
    let line = ring(&[(0., 0.), (5., 5.), (9., 9.)]);
    let thin = ring(&[(0., 0.), (100., 0.), (100., 1e-6), (0., 1e-6)]);
    let nan = vec![DVec2::NAN; 5];
    for rings in [
        vec![],
        vec![vec![]],
        vec![line.clone()],
        vec![line.clone(), line],
        vec![thin],
        vec![nan],
    ] {
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            assert_eq!(
                checked(rings.clone(), rule),
                Outline::default(),
                "{rings:?}"
            );
        }
    }
    assert_eq!(union(&[]), Outline::default());
    assert_eq!(bounds(&Outline::default()), None);
    assert_eq!(
        distance_squared(&Outline::default(), DVec2::ZERO),
        f64::INFINITY
    );
}

#[test]
fn results_scale_with_the_input() {
    for size in [1e-30, 1e-9, 1e-3, 1e4, 1e30] {
        for rings in [
            vec![star(7, 1)],
            vec![star(7, 3)],
            vec![square(-1., -1., 2.), star(7, 1)],
        ] {
            let scaled: Vec<Ring> = rings
                .iter()
                .map(|r| r.iter().map(|p| p * size).collect())
                .collect();
            let (a, b) = (
                checked(rings, FillRule::EvenOdd),
                checked(scaled, FillRule::EvenOdd),
            );
            assert!((area(&b) / (size * size) / area(&a) - 1.0).abs() < 1e-3);
        }
    }
    for size in [1e-300, 1e100, 1e300] {
        let scaled = star(7, 3).iter().map(|p| p * size).collect();
        resolve_overlaps(vec![scaled], FillRule::NonZero);
    }
    let far = star(7, 3).iter().map(|p| 1e30 + p).collect();
    assert_eq!(
        resolve_overlaps(vec![far], FillRule::NonZero),
        Outline::default()
    );
    let mixed = ring(&[
        (0., 0.),
        (1., 0.),
        (1., 1.),
        (1e30, 1e30),
        (-1e30, 4e29),
        (0., 2.),
    ]);
    checked(vec![mixed], FillRule::NonZero);
}

#[test]
fn clips_and_unions() {
    let one = |points: Ring| resolve_overlaps(vec![points], FillRule::NonZero);
    let (a, b) = (one(square(0., 0., 10.)), one(square(5., 5., 10.)));
    for (outline, expected) in [(intersect(&a, &b), 25.0), (union(&[a.clone(), b]), 175.0)] {
        check(&outline);
        assert!((area(&outline) - expected).abs() < 1e-3);
    }
    assert_eq!(intersect(&a, &one(square(-1., -1., 20.))), a);
    assert_eq!(intersect(&one(square(-1., -1., 20.)), &a), a);
    assert_eq!(intersect(&a, &one(square(10., 0., 4.))), Outline::default());
    let large = ring(&[(-1e9, 0.), (0., 1e9), (1e9, 0.), (0., -1e9)]);
    let small = intersect(&one(star(9, 2)), &one(large));
    assert!((area(&small) / area(&one(star(9, 2))) - 1.0).abs() < 1e-6);
}

proptest! {
    #[test]
    fn any_rings_become_valid(
        rings in proptest::collection::vec(
            proptest::collection::vec((-9i32..9, -9i32..9), 0..12), 0..5),
        size in -3f64..4.0, turn in -3f64..3.0,
    ) {
        let turn = DVec2::from_angle(turn) * 10f64.powf(size);
        let point = |&(x, y): &(i32, i32)| turn.rotate(DVec2::new(x.into(), y.into()));
        let rings: Vec<Ring> = rings.iter().map(|r| r.iter().map(point).collect()).collect();
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let outline = checked(rings.clone(), rule);
            // Valid outlines do not change.
            let again = outline.polygons.iter().flat_map(|p| p.rings.clone()).collect();
            let again = checked(again, rule);
            prop_assert!((area(&again) - area(&outline)).abs() <= 1e-3 * area(&outline));
        }
    }
}

/// Disjoint rings give the same result as through the overlay, whatever their direction and nesting.
#[test]
fn nested_rings_need_no_overlay() {
    let ways = |rings: &[Ring], reversed: usize| -> Vec<Ring> {
        let turn = |(i, ring): (usize, &Ring)| match reversed >> i & 1 {
            0 => ring.clone(),
            _ => ring.iter().rev().copied().collect(),
        };
        rings.iter().enumerate().map(turn).collect()
    };
    let rings = [
        square(0.0, 0.0, 10.0),
        square(1.0, 1.0, 7.0),
        square(2.0, 2.0, 2.0),
        square(5.0, 5.0, 2.0),
        square(20.0, 0.0, 3.0),
    ];
    for reversed in 0..1 << rings.len() {
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let rings = ways(&rings, reversed);
            let plain = checked(rings.clone(), rule);
            // A ring that crosses itself sends all of them through the overlay.
            let mut crossed = rings;
            crossed.push(ring(&[(40., 0.), (42., 2.), (42., 0.), (40., 2.)]));
            let overlaid = checked(crossed, rule);
            let bow_tie = 2.0;
            assert!(
                (area(&plain) + bow_tie - area(&overlaid)).abs() < 1e-3,
                "{reversed} {rule:?}"
            );
            let mut expected = shape(&overlaid);
            expected.drain(..2);
            assert_eq!(shape(&plain), expected, "{reversed} {rule:?}");
        }
    }
}

#[test]
fn shared_points_are_touches() {
    let bow = ring(&[(0., 0.), (2., 2.), (4., 0.), (4., 4.), (2., 2.), (0., 4.)]);
    let squares = vec![square(0., 0., 2.), square(2., 2., 2.)];
    for rings in [vec![bow], squares] {
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            assert_eq!(shape(&checked(rings.clone(), rule)), [1, 1]);
        }
    }
}

#[test]
fn combs_are_the_same_upright_and_lying() {
    // The last tooth crosses the comb, so that it is resolved on the grid.
    let tooth = |i: u32| {
        let (x, bottom) = (f64::from(i), if i == 1499 { -5.0 } else { 5.0 });
        [(x, bottom), (x, 1e3), (x + 0.5, 1e3), (x + 0.5, bottom)]
    };
    let mut upright: Ring = (0..1500).flat_map(tooth).map(DVec2::from).collect();
    upright.extend(ring(&[(1500.0, 5.0), (1500.0, 0.0), (0.0, 0.0)]));
    let lying: Ring = upright.iter().map(|p| -p.perp()).collect();
    let along_y = [&upright, &lying].map(|ring| sweeps_better_along_y([&ring[..]].into_iter()));
    assert_eq!(along_y, [false, true]);
    let [upright, lying] = [upright, lying].map(|ring| checked(vec![ring], FillRule::NonZero));
    assert_eq!(shape(&upright), shape(&lying));
    assert!((area(&upright) / area(&lying) - 1.0).abs() < 1e-6);
    let turned = lying.map_rings(|ring| ring.iter().map(|p| p.perp()).collect());
    for point in upright.rings().flatten() {
        assert!(distance_squared(&turned, *point) < 1e-6);
    }
}
