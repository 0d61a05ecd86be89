//! Laws of parts that bend: at rest they are as drawn, and bent they keep their width and volume.
#![allow(clippy::print_stdout, reason = "what was measured is told")]

mod clip_art;
mod measured;

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::{Bend, Centerline};
use crate::geometry::{Outline, Polygon, y_up};
use measured::{Bent, Measured, at_rest, bent, volume};

/// Half the thickness of plates.
const PLATE: f64 = 10.0;

/// A limb as a person would draw it, hanging from the origin: its length, and its width along it.
fn limb(length: f64, width: impl Fn(f64) -> f64, bow: f64) -> Outline {
    const STEPS: usize = 40;
    let middle = |share: f64| DVec2::new(bow * length * (PI * share).sin(), share * length);
    let side = |sign: f64| {
        (0..=STEPS).map(move |step| {
            let share = step as f64 / STEPS as f64;
            (share, sign)
        })
    };
    let point = |(share, sign): (f64, f64)| {
        let way = middle(share + 1e-4) - middle(share - 1e-4);
        middle(share) + sign * width(share) / 2.0 * way.perp().normalize()
    };
    // Counter-clockwise as seen on the page.
    let ring: Vec<DVec2> = side(1.0).chain(side(-1.0).rev()).map(point).collect();
    Outline {
        polygons: vec![Polygon { rings: vec![ring] }],
    }
}

/// The bend of a limb of a kind.
fn limb_bend(kind: &str) -> impl Fn(Centerline) -> Bend + use<> {
    let depth = depth(kind, PLATE);
    move |line| Bend::limb(line, depth)
}

/// How far a part of a kind reaches from its plane: what is inflated is as deep as its width allows.
fn depth(kind: &str, plate: f64) -> f64 {
    if kind == "inflate" {
        f64::INFINITY
    } else {
        plate
    }
}

/// By how much joints are turned, degrees; the least width as a share of that at rest; the largest share of triangles that are turned
/// over.
const LIMITS: [(f64, f64, f64); 4] = [
    (30.0, 0.90, 0.0),
    (60.0, 0.90, 0.0005),
    (90.0, 0.85, 0.0005),
    (120.0, 0.70, 0.002),
];

/// By how much the volume may change.
const MOST_VOLUME: f64 = 0.08;

/// Limbs of all kinds: straight and bowed, tapered and even.
fn limbs() -> Vec<Outline> {
    let mut random = fastrand::Rng::with_seed(5);
    let mut limbs = Vec::new();
    for _ in 0..200 {
        let length = 80.0 + 120.0 * random.f64();
        let wide = length / (2.6 + 5.0 * random.f64());
        let taper = 0.4 * random.f64();
        let bow = 0.3 * (random.f64() - 0.5);
        limbs.push(limb(length, |share| wide * (1.0 - taper * share), bow));
    }
    limbs
}

#[test]
fn at_rest_a_part_is_as_drawn() {
    for outline in limbs() {
        for kind in ["inflate", "default"] {
            let bent = bent(&outline, kind, limb_bend(kind));
            let [rest, drawn] = [&bent.surface, &bent.rigid].map(at_rest);
            let [rest_volume, drawn_volume] = [
                volume(&rest, &bent.surface.triangles),
                volume(&drawn, &bent.rigid.triangles),
            ];
            assert!((rest_volume / drawn_volume - 1.0).abs() < 1e-5);
            // No corner is lost, and none moves.
            assert_eq!(rest[..drawn.len()], drawn);
            let moved = bent.posed(DVec3::Z, 0.0);
            let farthest = moved.iter().zip(&rest).map(|(a, b)| a.distance(*b));
            assert!(farthest.fold(0.0, f64::max) < 1e-4);
        }
    }
}

#[test]
fn every_edge_has_two_triangles_after_cutting() {
    use rustc_hash::FxHashMap;
    for outline in limbs().iter().take(20) {
        for kind in ["inflate", "default"] {
            let bent = bent(outline, kind, limb_bend(kind));
            let place = |corner: u32| bent.surface.positions[corner as usize].map(f32::to_bits);
            let mut edges: FxHashMap<_, i32> = FxHashMap::default();
            for triangle in &bent.surface.triangles {
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let [a, b] = [triangle[a], triangle[b]].map(place);
                    *edges
                        .entry(if a < b { (a, b) } else { (b, a) })
                        .or_default() += if a < b { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|sum| *sum == 0));
        }
    }
}

#[test]
fn a_bent_limb_keeps_its_width_and_volume() {
    let limbs: Vec<[Bent; 2]> = limbs()
        .iter()
        .map(|outline| ["inflate", "default"].map(|kind| bent(outline, kind, limb_bend(kind))))
        .collect();
    check(limbs.iter().flatten(), 0.0);
}

/// Measures limbs and compares them with the limits, and the share of triangles that are turned over with this one, if it is larger.
fn check<'a>(limbs: impl Iterator<Item = &'a Bent> + Clone, most_folded: f64) {
    let worst = LIMITS.map(|(degrees, ..)| {
        let measured: Vec<Measured> = limbs
            .clone()
            .map(|bent| Measured::of(bent, degrees))
            .collect();
        let worst = Measured::worst(measured.iter());
        println!(
            "{degrees}°: {:.3} of the width, {:.5} turned over ({} limbs), {:.3} of the volume",
            worst.narrowest,
            worst.share_folded(),
            measured.iter().filter(|one| one.folded[0] > 0).count(),
            worst.volume
        );
        worst
    });
    for (worst, (degrees, least, most)) in worst.iter().zip(LIMITS) {
        assert!(
            worst.narrowest >= least && worst.share_folded() <= most.max(most_folded),
            "{degrees}°: {worst:?}"
        );
        assert!(worst.volume < MOST_VOLUME, "{degrees}°: {worst:?}");
    }
}

#[test]
fn an_elbow_is_where_the_drawing_bends() {
    let straight = limb(100.0, |_| 20.0, 0.0);
    let bend = limb_bend("default")(Centerline::new(&straight, DVec2::ZERO).unwrap());
    let middle = bend.middle(0).unwrap();
    assert!(middle.distance(DVec2::new(0.0, -50.0)) < 3.0, "{middle}");
    let points = [
        (0., 0.),
        (20., 0.),
        (20., 55.),
        (80., 55.),
        (80., 75.),
        (0., 75.),
    ];
    let ring = points.map(|(x, y)| DVec2::new(x, y)).to_vec();
    let bent = Outline {
        polygons: vec![Polygon { rings: vec![ring] }],
    };
    let bend = limb_bend("default")(Centerline::new(&bent, y_up(DVec2::new(10.0, 5.0))).unwrap());
    let elbow = bend.middle(0).unwrap();
    assert!(elbow.distance(DVec2::new(14.0, -61.0)) < 8.0, "{elbow}");
}

#[test]
fn a_chain_has_bones_of_one_length() {
    let outline = limb(200.0, |_| 16.0, 0.25);
    let bend = Bend::chain(Centerline::new(&outline, DVec2::ZERO).unwrap(), 4);
    assert_eq!(bend.nodes.len(), 4);
    let names: Vec<String> = bend.names("Tail").collect();
    assert_eq!(names, ["Tail.2", "Tail.3", "Tail.4", "Tail.5"]);
    let places: Vec<f64> = bend.nodes.iter().map(|node| node.at).collect();
    for pair in places.windows(2) {
        assert!((pair[1] - pair[0] - places[0]).abs() < 1e-9);
    }
    // As many as there is room for.
    let short = limb(60.0, |_| 20.0, 0.0);
    let bend = Bend::chain(Centerline::new(&short, DVec2::ZERO).unwrap(), 4);
    assert_eq!(bend.nodes.len(), 2);
}

/// An outline of one ring.
fn ring(points: &[(f64, f64)]) -> Outline {
    let ring = points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
    Outline {
        polygons: vec![Polygon { rings: vec![ring] }],
    }
}

#[test]
fn what_branches_at_its_end_bends_up_to_there() {
    // A feeler with a bar across its end, and an arm with three fingers.
    let feeler = [
        (-1.5, 0.),
        (-1.5, 27.),
        (-8., 27.),
        (-8., 30.),
        (8., 30.),
        (8., 27.),
        (1.5, 27.),
        (1.5, 0.),
    ];
    let hand = [
        (-10., 0.),
        (-10., 100.),
        (-40., 120.),
        (-36., 126.),
        (-4., 112.),
        (-4., 146.),
        (4., 146.),
        (4., 112.),
        (36., 126.),
        (40., 120.),
        (10., 100.),
        (10., 0.),
    ];
    for (points, [least, most]) in [(&feeler[..], [20.0, 29.0]), (&hand, [85.0, 115.0])] {
        let line = Centerline::new(&ring(points), DVec2::ZERO).unwrap();
        assert!(line.is_slender(), "{points:?}");
        let length = line.length();
        assert!(least < length && length < most, "{length}");
        let tip = line.at(length);
        assert!(tip.x.abs() < 2.0, "{tip}");
    }
    // A cross branches in its middle.
    let cross = [
        (-2., 0.),
        (-2., 18.),
        (-20., 18.),
        (-20., 22.),
        (-2., 22.),
        (-2., 40.),
        (2., 40.),
        (2., 22.),
        (20., 22.),
        (20., 18.),
        (2., 18.),
        (2., 0.),
    ];
    let line = Centerline::new(&ring(&cross), DVec2::ZERO);
    assert!(line.is_none_or(|line| !line.is_slender()));
}

#[test]
fn round_shapes_have_no_middle_line() {
    let ball: Vec<DVec2> = (0..40)
        .map(|step| 20.0 * DVec2::from_angle(PI * f64::from(step) / 20.0))
        .collect();
    let ball = Outline {
        polygons: vec![Polygon { rings: vec![ball] }],
    };
    let line = Centerline::new(&ball, DVec2::new(0.0, 20.0));
    assert!(line.is_none_or(|line| line.length() < 2.0 * line.width()));
    assert!(Centerline::new(&Outline::default(), DVec2::ZERO).is_none());
    // A frame so thin that of its grid a single cell is left.
    let thin = |inset: f64| {
        [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)].map(|(x, y): (f64, f64)| {
            DVec2::new(x.clamp(inset, 100.0 - inset), y.clamp(inset, 100.0 - inset))
        })
    };
    let frame = Outline {
        polygons: vec![Polygon {
            rings: vec![thin(0.0).to_vec(), thin(0.05).into_iter().rev().collect()],
        }],
    };
    assert!(Centerline::new(&frame, DVec2::ZERO).is_none());
}
