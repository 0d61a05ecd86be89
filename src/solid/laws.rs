//! Laws over random outlines.

use glam::{DVec2, DVec3, Vec3};
use proptest::prelude::*;
use proptest::test_runner::FileFailurePersistence;

use super::check::{closed, volume};
use super::tests::{kinds_with, options, outline, profile};
use super::*;
use crate::geometry::{Ring, area, bounds};
use crate::law::{self, Tally};

fn point() -> impl Strategy<Value = DVec2> {
    (-1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y)| DVec2::new(x, y))
}

/// Points in order around the origin.
fn star() -> impl Strategy<Value = Ring> {
    proptest::collection::vec(0.2..1.0f64, 3..40).prop_map(|radii| {
        let step = std::f64::consts::TAU / radii.len() as f64;
        let at = |(i, r): (usize, f64)| r * DVec2::from_angle(i as f64 * step);
        radii.into_iter().enumerate().map(at).collect()
    })
}

/// Points of a coarse lattice: many touch and many lie on one line.
fn lattice() -> impl Strategy<Value = Ring> {
    proptest::collection::vec((-4i32..4, -4i32..4), 3..20).prop_map(|points| {
        let point = |(x, y): (i32, i32)| DVec2::new(x.into(), y.into()) / 4.0;
        points.into_iter().map(point).collect()
    })
}

pub(super) fn rings() -> impl Strategy<Value = Vec<Ring>> {
    let holed = (star(), star(), 0.05..0.6f64, point()).prop_map(|(a, b, size, at)| {
        let hole = b.iter().map(|p| *p * size + at * 0.3).collect();
        vec![a, hole]
    });
    let crossing = proptest::collection::vec(point(), 3..40);
    prop_oneof![
        star().prop_map(|r| vec![r]),
        crossing.prop_map(|r| vec![r]),
        proptest::collection::vec(lattice(), 1..4),
        holed,
    ]
}

/// Every law for one surface.
pub(super) fn lawful(surface: &Surface) -> Result<(), String> {
    closed(surface)?;
    if volume(surface) <= 0.0 {
        return Err(format!("volume {}", volume(surface)));
    }
    for n in &surface.normals {
        let length = Vec3::from(*n).length();
        if (length - 1.0).abs() > 1e-4 || length.is_nan() {
            return Err(format!("normal {n:?}"));
        }
    }
    let mut used = vec![false; surface.positions.len()];
    for t in &surface.triangles {
        let [a, b, c] = t.map(|i| Vec3::from(surface.positions[i as usize]).as_dvec3());
        if (b - a).cross(c - a) == DVec3::ZERO {
            return Err(format!("empty triangle {a} {b} {c}"));
        }
        t.iter().for_each(|i| used[*i as usize] = true);
    }
    if used.contains(&false) {
        return Err("a corner is not used".into());
    }
    Ok(())
}

pub(super) fn config() -> ProptestConfig {
    ProptestConfig {
        // Beside the tests, not at the top of the project.
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(
            "tests/regressions/solids.txt",
        ))),
        ..law::config(64)
    }
}

#[test]
fn solids_are_lawful() {
    let inputs = (
        rings(),
        -3.0..4.0f64,
        -3.2..3.2f64,
        prop_oneof![1u32..20, Just(64u32)],
        prop_oneof![Just(0.0), Just(30.0), Just(180.0)],
        (point(), -1.0..1.0f64),
    );
    let measured = Tally::default();
    // Hardly any outline is empty.
    law::check(
        config(),
        90,
        inputs,
        |(rings, size, turn, segments, crease, at)| {
            let size = 10f64.powf(size);
            let turned = DVec2::from_angle(turn) * size;
            let rings: Vec<Ring> = rings
                .iter()
                .map(|r| r.iter().map(|p| turned.rotate(*p)).collect())
                .collect();
            let outline = outline(rings);
            if outline.polygons.is_empty() {
                return Ok(false);
            }
            let placement = Placement {
                rotation: turn * 3.0,
                translation: at.0.extend(at.1) * size,
                scale: 0.01,
            };
            let o = Options {
                crease,
                placement,
                ..options(segments)
            };
            for kind in kinds_with(&[-0.1 * size, 0.2 * size]) {
                let surface = build(&outline, &kind, &o);
                if let Err(error) = lawful(&surface) {
                    return Err(TestCaseError::fail(format!("{kind:?}: {error}")));
                }
                let expected = expected_volume(&outline, &kind, &o);
                if matches!(
                    kind,
                    Profile::Default(_) | Profile::Round(_) | Profile::Cone(_)
                ) {
                    measured.count(expected.is_some());
                }
                if let Some(expected) = expected {
                    let found = volume(&surface);
                    prop_assert!(
                        (found / expected - 1.0).abs() < 1e-3,
                        "{:?}: {} {}",
                        kind,
                        found,
                        expected
                    );
                }
            }
            Ok(true)
        },
    );
    // It is of 60 %.
    measured.assert_share("solids whose volume is known", 40);
}

/// The volume of a stack whose copies are scaled evenly, cubic model units. A surface's volume sums signed tetrahedra, so one
/// triangle that is flipped, missing or duplicated is enough to miss it.
fn expected_volume(outline: &Outline, kind: &Profile, options: &Options) -> Option<f64> {
    if !matches!(
        kind,
        Profile::Default(_) | Profile::Round(_) | Profile::Cone(_)
    ) {
        return None;
    }
    let (low, high) = bounds(outline)?;
    let half = low.abs().max(high.abs());
    let stack = layers::with_thickness(kind.layers(half, options), half);
    // A very small thickness is mostly rounding.
    let thickness = stack.last()?.z - stack.first()?.z;
    if thickness < 1e-2 * half.max_element() {
        return None;
    }
    // A very small top is built as a point.
    if stack
        .iter()
        .any(|layer| (1e-9..1e-2).contains(&layer.along))
    {
        return None;
    }
    // A copy is built as a point, too, if some of its points would coincide in `f32`.
    let rings = outline.rings();
    let points: Vec<DVec2> = rings.flatten().copied().collect();
    let gaps = points.iter().enumerate();
    let gaps = gaps.flat_map(|(i, p)| points[..i].iter().map(|q| p.distance(*q)));
    let gap = gaps.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min);
    let smallest = stack.iter().map(|layer| layer.along);
    let smallest = smallest.filter(|along| *along > 0.0).fold(1.0, f64::min);
    let reach = half.max_element() + options.placement.translation.abs().max_element();
    if smallest < 1.0 && gap * smallest < 1e-6 * reach {
        return None;
    }
    let frustum = |pair: &[layers::Layer]| {
        let (a, b) = (pair[0].along, pair[1].along);
        (pair[1].z - pair[0].z) * (a * a + a * b + b * b) / 3.0
    };
    let sum: f64 = stack.windows(2).map(frustum).sum();
    Some(sum * area(outline) * options.placement.scale.powi(3))
}

/// The number of triangles of the front that face away from the viewer.
fn turned_over(surface: &Surface) -> usize {
    let at = |i: u32| Vec3::from(surface.positions[i as usize]).as_dvec3();
    let is_turned = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(at);
        let face = (b - a).cross(c - a).normalize_or_zero();
        let middle = (a.z + b.z + c.z) / 3.0;
        face.z * middle.signum() < -1e-3
    };
    surface.triangles.iter().filter(is_turned).count()
}

#[test]
fn where_round_turns_over() {
    let disc = |radius: f64, at: DVec2| -> Ring {
        let angle = |i: usize| f64::from(i as u32) / 48.0 * std::f64::consts::TAU;
        (0..48)
            .map(|i| at + radius * DVec2::from_angle(angle(i)))
            .collect()
    };
    let round = profile("round", &[-90., 90.]);
    let turned = |rings: Vec<Ring>| turned_over(&build(&outline(rings), &round, &options(16)));
    // Scaled copies of a star-shaped outline are nested, those of others are not.
    assert_eq!(turned(vec![disc(1.0, DVec2::ZERO)]), 0);
    assert!(turned(vec![disc(1.0, DVec2::ZERO), disc(0.4, DVec2::ZERO)]) > 0);
    assert!(
        turned(vec![
            disc(1.0, DVec2::ZERO),
            disc(0.2, DVec2::new(0.5, 0.0))
        ]) > 0
    );
}

/// Both sides of a collapsed wedge meet only in its tip, at either end.
#[test]
fn wedges_are_closed() {
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        let corner = |px: f64, py: f64| DVec2::new(x * px, y * py);
        let wedge = outline(vec![vec![corner(0., 0.), corner(0., 7.), corner(9., 0.)]]);
        for segments in [1, 2, 3, 16] {
            for kind in kinds_with(&[]) {
                let surface = build(&wedge, &kind, &options(segments));
                lawful(&surface).unwrap_or_else(|error| panic!("{kind:?} {segments}: {error}"));
            }
        }
    }
}
