use std::mem::discriminant;

use glam::{DVec2, DVec3, Vec3};

use super::check::{closed, volume};
use super::*;
use crate::geometry::{FillRule, Ring, bounds, resolve_overlaps};
use crate::lang::keyword::kinds::KINDS;

pub(super) fn options(segments: u32) -> Options {
    Options {
        segments,
        crease: 30.0,
        placement: Placement::default(),
    }
}

/// A kind with its numbers; plates are 2 thick.
pub(super) fn profile(name: &str, numbers: &[f64]) -> Profile {
    Profile::new(name, numbers, 1.0).unwrap()
}

/// A clean outline in its part's frame from rings in any order, y up.
pub(super) fn outline(rings: Vec<Ring>) -> Outline {
    let down = rings
        .into_iter()
        .map(|r| r.into_iter().map(|p| DVec2::new(p.x, -p.y)).collect());
    let mut outline = resolve_overlaps(down.collect(), FillRule::EvenOdd);
    if let Some((low, high)) = bounds(&outline) {
        let center = low.midpoint(high);
        for p in outline
            .polygons
            .iter_mut()
            .flat_map(|p| p.rings.iter_mut().flatten())
        {
            *p = DVec2::new(p.x - center.x, center.y - p.y);
        }
    }
    outline
}

fn ring(points: &[(f64, f64)]) -> Ring {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

pub(super) fn rectangle(w: f64, h: f64) -> Outline {
    outline(vec![ring(&[(0., 0.), (w, 0.), (w, h), (0., h)])])
}

pub(super) fn circle(r: f64, n: usize) -> Outline {
    let angle = |i: usize| (i as f64 + 0.5) / n as f64 * std::f64::consts::TAU;
    outline(vec![
        (0..n).map(|i| r * DVec2::from_angle(angle(i))).collect(),
    ])
}

fn made(outline: &Outline, kind: Profile, options: &Options) -> Surface {
    let surface = build(outline, &kind, options);
    closed(&surface).unwrap_or_else(|e| panic!("{kind:?}: {e}"));
    assert!(volume(&surface) > 0.0);
    surface
}

/// Distinct positions, rounded to thousandths.
fn positions(surface: &Surface) -> Vec<[i32; 3]> {
    let round = |p: &[f32; 3]| p.map(|x| (x * 1000.0).round() as i32);
    let mut all: Vec<_> = surface.positions.iter().map(round).collect();
    all.sort();
    all.dedup();
    all
}

/// Distinct directions of triangles.
fn directions(surface: &Surface) -> usize {
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| Vec3::from(surface.positions[i as usize]));
        (b - a)
            .cross(c - a)
            .normalize()
            .to_array()
            .map(|x| (x * 100.0).round() as i32)
    };
    let mut all: Vec<_> = surface.triangles.iter().map(normal).collect();
    all.sort();
    all.dedup();
    all.len()
}

#[test]
fn the_papers_octagonal_prism() {
    let surface = made(
        &rectangle(20., 60.),
        profile("roundv", &[-90., 90.]),
        &options(4),
    );
    let mut expected = Vec::new();
    for y in [-30000, 30000] {
        for (x, z) in [(0, -10000), (0, 10000), (10000, 0), (-10000, 0)] {
            expected.push([x, y, z]);
        }
        for (x, z) in [(7071, -7071), (7071, 7071), (-7071, 7071), (-7071, -7071)] {
            expected.push([x, y, z]);
        }
    }
    expected.sort();
    assert_eq!(positions(&surface), expected);
    assert_eq!(directions(&surface), 10);
    // Eight quads around, two octagons.
    assert_eq!(surface.triangles.len(), 8 * 2 + 2 * 6);
    let area = 10.0 * 10.0 * 2.0 * 2f64.sqrt();
    assert!((volume(&surface) - area * 60.0).abs() < 1.0);
    let lying = made(
        &rectangle(60., 20.),
        profile("roundh", &[-90., 90.]),
        &options(4),
    );
    assert_eq!((positions(&lying).len(), directions(&lying)), (16, 10));
    assert!((volume(&lying) - area * 60.0).abs() < 1.0);
}

#[test]
fn cylinders_have_their_radius() {
    let surface = made(
        &rectangle(20., 60.),
        profile("roundv", &[-90., 90.]),
        &options(16),
    );
    for [x, y, z] in &surface.positions {
        assert!((x.hypot(*z) - 10.0).abs() < 1e-4 && y.abs() == 30.0);
    }
    // Normals of the wall point away from the axis; each corner occurs once for the wall and
    // once for the end.
    assert_eq!(surface.positions.len(), 4 * 32);
    for (p, n) in surface.positions.iter().zip(&surface.normals) {
        let outward = Vec3::new(p[0], 0.0, p[2]).normalize().dot(Vec3::from(*n));
        assert!(n[1].abs() > 0.999 || outward > 0.999, "{p:?} {n:?}");
    }
}

#[test]
fn ellipsoids_have_their_volume() {
    let sphere = made(
        &circle(10., 96),
        profile("round", &[-90., 90.]),
        &options(48),
    );
    let whole = 4.0 / 3.0 * std::f64::consts::PI * 1000.0;
    assert!((volume(&sphere) / whole - 1.0).abs() < 0.01);
    // One corner a point: everything is smooth, the poles too.
    assert_eq!(sphere.positions.len(), 47 * 96 + 2);
    let half = made(
        &circle(10., 96),
        profile("round", &[0., 90., 20.]),
        &options(48),
    );
    assert!((volume(&half) / whole - 1.0).abs() < 0.01);
}

#[test]
fn cones_wedges_and_partial_angles() {
    let square = rectangle(10., 10.);
    let near = |surface: &Surface, expected: f64| {
        let found = volume(surface);
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    };
    let o = options(16);
    let pyramid = made(&square, profile("cone", &[0., 30., 0.]), &o);
    near(&pyramid, 1000.0);
    assert_eq!((positions(&pyramid).len(), pyramid.triangles.len()), (5, 6));
    near(&made(&square, profile("cone", &[30., 0., 0.]), &o), 1000.0);
    let frustum = made(&square, profile("cone", &[0., 30., 0.5]), &o);
    near(&frustum, 30.0 / 3.0 * (100.0 + 50.0 + 25.0));
    assert_eq!(positions(&frustum).len(), 8);
    for roof in [
        profile("conev", &[0., 6., 0.]),
        profile("coneh", &[0., 6., 0.]),
    ] {
        let roof = made(&square, roof, &o);
        near(&roof, 300.0);
        assert_eq!((positions(&roof).len(), directions(&roof)), (6, 5));
    }
    near(&made(&square, profile("conev", &[0., 6., 0.5]), &o), 450.0);
    let half = made(
        &rectangle(20., 60.),
        profile("roundv", &[0., 90.]),
        &options(4),
    );
    near(&half, 100.0 * 2f64.sqrt() * 60.0);
    let slice = made(
        &circle(10., 48),
        profile("roundv", &[-30., 45.]),
        &options(16),
    );
    assert!(
        slice
            .positions
            .iter()
            .all(|p| p[2] > -5.001 && p[2] < 7.072)
    );
    near(&made(&square, profile("default", &[4., -1.]), &o), 500.0);
}

#[test]
fn a_circle_prism_is_small() {
    let surface = made(&circle(10., 48), profile("default", &[]), &options(16));
    assert_eq!(
        (surface.positions.len(), surface.triangles.len()),
        (4 * 48, 4 * 48 - 4)
    );
    let sharp = Options {
        crease: 0.0,
        ..options(16)
    };
    let sharp = made(&circle(10., 48), profile("default", &[]), &sharp);
    assert_eq!(sharp.positions.len(), 6 * 48);
    let soft = Options {
        crease: 180.0,
        ..options(16)
    };
    assert_eq!(
        made(&circle(10., 48), profile("default", &[]), &soft)
            .positions
            .len(),
        2 * 48
    );
}

#[test]
fn every_kind_on_awkward_outlines() {
    let star = |n: usize, step: usize| -> Ring {
        let angle = |i: usize| (i * step % n) as f64 / n as f64 * std::f64::consts::TAU;
        (0..n).map(|i| 9.0 * DVec2::from_angle(angle(i))).collect()
    };
    let square = |x: f64, y: f64, s: f64| ring(&[(x, y), (x + s, y), (x + s, y + s), (x, y + s)]);
    let outlines = [
        vec![ring(&[
            (0., 0.),
            (3., 0.),
            (3., 1.),
            (1., 1.),
            (1., 3.),
            (0., 3.),
        ])],
        vec![square(0., 0., 9.), square(2., 2., 5.)],
        vec![square(0., 0., 9.), square(2., 2., 5.), square(3., 3., 2.)],
        vec![star(5, 2)],
        vec![star(48, 1), star(48, 1).iter().map(|p| p * 0.6).collect()],
        vec![ring(&[(0., 0.), (10., 10.), (10., 0.), (0., 10.)])],
        vec![square(0., 0., 1.), square(1., 1., 1.)],
        vec![square(0., 0., 9.), ring(&[(0., 4.), (3., 2.), (3., 6.)])],
        vec![ring(&[
            (0., 0.),
            (5., 3.),
            (9., 0.),
            (7., 5.),
            (9., 9.),
            (0., 9.),
            (3., 5.),
        ])],
        vec![ring(&[
            (0., 0.),
            (4., 0.),
            (4., 2.),
            (6., 2.),
            (6., 5.),
            (1., 5.),
            (1., 2.),
            (0., 2.),
        ])],
    ];
    for rings in outlines {
        let outline = outline(rings);
        for kind in kinds_with(&[]) {
            for crease in [0.0, 30.0, 180.0] {
                made(
                    &outline,
                    kind.clone(),
                    &Options {
                        crease,
                        ..options(7)
                    },
                );
            }
        }
    }
}

/// All closed kinds, plates with these numbers. Those that are not listed here have the numbers of the language's table.
pub(super) fn kinds_with(plate: &[f64]) -> Vec<Profile> {
    let mut kinds = vec![
        profile("default", plate),
        profile("inflate", &[]),
        profile("lathe", &[360.0]),
        profile("lathe", &[100.0]),
    ];
    for angles in [
        [-90., 90.],
        [0., 90.],
        [-90., 20.],
        [-40., 60.],
        [89.99, -80.],
        [30., 30.],
    ] {
        kinds.extend([
            profile("roundv", &angles),
            profile("roundh", &angles),
            profile("round", &angles),
        ]);
        kinds.push(profile("round", &[angles[0], angles[1], 0.5]));
    }
    for cone in [
        [0., 2., 0.],
        [3., -1., 0.],
        [0., 2., 0.5],
        [0., 2., 3.],
        [0., 1., 0.002],
        [1., 1., 0.],
    ] {
        kinds.extend([
            profile("cone", &cone),
            profile("conev", &cone),
            profile("coneh", &cone),
        ]);
    }
    // A linked model is only a plate here.
    for kind in KINDS.iter().filter(|kind| kind.name != "model") {
        let profile = Profile::new(kind.name, kind.numbers, 1.0);
        let new = profile.filter(|new| {
            let is_new = |known: &Profile| discriminant(known) != discriminant(new);
            !new.is_open() && kinds.iter().all(is_new)
        });
        kinds.extend(new);
    }
    kinds
}

#[test]
fn flat_none_and_empty() {
    let o = options(16);
    let flat = build(&rectangle(2., 2.), &profile("flat", &[3.0]), &o);
    assert_eq!((flat.positions.len(), flat.triangles.len()), (4, 2));
    assert!(flat.positions.iter().all(|p| p[2] == 3.0) && flat.normals.iter().all(|n| n[2] == 1.0));
    assert_eq!(Profile::new("none", &[], 1.0), None);
    for kind in kinds_with(&[]) {
        assert_eq!(build(&Outline::default(), &kind, &o), Surface::default());
    }
}

#[test]
fn placement_and_mirror() {
    let placement = Placement {
        rotation: std::f64::consts::FRAC_PI_2,
        translation: DVec3::new(0.0, 30.0, 5.0),
        scale: 0.01,
    };
    let o = Options {
        placement,
        ..options(16)
    };
    let surface = made(&rectangle(20., 60.), profile("default", &[]), &o);
    let far = surface
        .positions
        .iter()
        .fold([0f32; 3], |m, p| [0, 1, 2].map(|i| m[i].max(p[i])));
    assert_eq!(far, [0.3, 0.4, 0.06]);
    let mirrored = surface.mirrored();
    closed(&mirrored).unwrap();
    assert!(volume(&mirrored) > 0.0 && mirrored.positions.iter().all(|p| p[2] < 0.0));
}

#[test]
fn wild_parameters_do_no_harm() {
    for x in [f64::NAN, f64::INFINITY, 1e300, -1e300, 1e-300, 0.0] {
        for kind in [
            profile("default", &[x, 0.0]),
            profile("roundv", &[x, -x]),
            profile("round", &[0.0, x, x]),
            profile("cone", &[x, 1.0, x]),
            profile("coneh", &[0.0, x, 1.0]),
            profile("flat", &[x]),
        ] {
            for segments in [0, 1, u32::MAX] {
                let o = Options {
                    crease: x,
                    ..options(segments)
                };
                build(&rectangle(1.0, 1.0), &kind, &o);
            }
        }
    }
}
