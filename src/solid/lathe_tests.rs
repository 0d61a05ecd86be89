use std::f64::consts::PI;

use glam::{DVec2, Vec3};
use proptest::prelude::*;

use super::super::build;
use super::super::check::{closed, volume};
use super::super::laws;
use super::super::tests::{circle, options, outline, profile, rectangle};
use super::*;
use crate::geometry::area;
use crate::law;

fn turned(outline: &Outline, degrees: f64, segments: u32) -> Surface {
    let surface = build(outline, &profile("lathe", &[degrees]), &options(segments));
    closed(&surface).unwrap_or_else(|e| panic!("{degrees}: {e}"));
    surface
}

/// What a turn in so many steps has of the volume of a smooth one.
fn of_smooth(degrees: f64, segments: u32) -> f64 {
    let steps = (degrees / 180.0 * f64::from(segments)).ceil();
    let step = degrees.to_radians() / steps;
    step.sin() / step
}

fn near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn a_bar_becomes_a_cylinder() {
    for degrees in [360.0, 180.0, 270.0, 45.0, 1.0] {
        let surface = turned(&rectangle(20.0, 60.0), degrees, 16);
        let whole = PI * 100.0 * 60.0 * degrees / 360.0;
        near(volume(&surface), whole * of_smooth(degrees, 16));
        for [x, y, z] in &surface.positions {
            let radius = x.hypot(*z);
            assert!(radius < 0.01 || (radius - 10.0).abs() < 1e-4);
            assert_eq!(y.abs(), 30.0);
        }
    }
    let half = turned(&rectangle(20.0, 60.0), 180.0, 16);
    assert!(
        half.positions.iter().all(|p| p[2] > -1e-4),
        "the viewer's half"
    );
    // Round about, normals point away from the axis.
    let whole = turned(&rectangle(20.0, 60.0), 360.0, 16);
    assert_eq!(whole.positions.len(), 4 * 32 + 2);
    for (p, n) in whole.positions.iter().zip(&whole.normals) {
        let outward = Vec3::new(p[0], 0.0, p[2])
            .normalize_or_zero()
            .dot(Vec3::from(*n));
        assert!(n[1].abs() > 0.999 || outward > 0.999, "{p:?} {n:?}");
    }
}

#[test]
fn a_disc_becomes_a_ball() {
    let surface = turned(&circle(10.0, 96), 360.0, 48);
    near(
        volume(&surface),
        4.0 / 3.0 * PI * 1000.0 * of_smooth(360.0, 48) * 0.9989,
    );
    for (p, n) in surface.positions.iter().zip(&surface.normals) {
        assert!((Vec3::from(*p).length() - 10.0).abs() < 0.01);
        assert!(Vec3::from(*p).normalize().dot(Vec3::from(*n)) > 0.998);
    }
}

#[test]
fn rings_off_the_axis_and_holes() {
    let square = |x: f64, y: f64, w: f64, h: f64| {
        [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec()
    };
    // A drawn ring is a ball with a ball left out: here a drum with a hollow.
    let hollow = outline(vec![
        square(-5.0, -5.0, 10.0, 10.0),
        square(-2.0, -2.0, 4.0, 4.0),
    ]);
    near(
        volume(&turned(&hollow, 360.0, 32)),
        PI * (250.0 - 16.0) * of_smooth(360.0, 32),
    );
    // Two bars beside the axis are a tube; a hole in both is a hollow in its wall.
    let bars = |hole: bool| {
        let mut rings = vec![square(-9.0, 0.0, 4.0, 8.0), square(5.0, 0.0, 4.0, 8.0)];
        if hole {
            rings.extend([square(-8.0, 2.0, 2.0, 4.0), square(6.0, 2.0, 2.0, 4.0)]);
        }
        outline(rings)
    };
    let tube = PI * (81.0 - 25.0) * 8.0;
    for degrees in [360.0, 120.0] {
        let part = of_smooth(degrees, 32) * degrees / 360.0;
        near(volume(&turned(&bars(false), degrees, 32)), tube * part);
        let hollow = PI * (64.0 - 36.0) * 4.0;
        near(
            volume(&turned(&bars(true), degrees, 32)),
            (tube - hollow) * part,
        );
    }
    // What stands out on one side only goes all the way round.
    let cup = outline(vec![
        square(-5.0, 0.0, 10.0, 20.0),
        square(5.0, 8.0, 3.0, 4.0),
        square(-8.0, 0.0, 3.0, 2.0),
    ]);
    let expected = PI * (25.0 * 20.0 + (64.0 - 25.0) * 6.0);
    near(
        volume(&turned(&cup, 360.0, 32)),
        expected * of_smooth(360.0, 32),
    );
}

#[test]
fn steps_are_seen_where_they_are_coarse() {
    let smooth = turned(&rectangle(20.0, 60.0), 360.0, 16);
    let coarse = turned(&rectangle(20.0, 60.0), 360.0, 4);
    assert_eq!((smooth.positions.len() - 2) / 32, 4);
    // Eight walls of four corners, two ends of nine.
    assert_eq!(coarse.positions.len(), 8 * 4 + 2 * 9);
}

#[test]
fn turned_outlines_are_lawful() {
    let inputs = (
        laws::rings(),
        2u32..24,
        prop_oneof![Just(360.0), 1.0..360.0f64],
    );
    // Hardly any outline is empty.
    law::check(laws::config(), 90, inputs, |(rings, segments, degrees)| {
        let drawn = outline(rings);
        if drawn.polygons.is_empty() {
            return Ok(false);
        }
        let surface = build(&drawn, &profile("lathe", &[degrees]), &options(segments));
        if let Err(error) = laws::lawful(&surface) {
            return Err(TestCaseError::fail(error));
        }
        // Pappus: the area times the way of its centroid.
        let (low, high) = bounds(&drawn).unwrap();
        let extent = (high - low).max_element();
        let sides = [1.0, -1.0].map(|x| half(&drawn, DVec2::new(x, -1.0), [0.0, extent]));
        let profile = union(&sides);
        let moment: f64 = profile
            .rings()
            .map(|ring| {
                let n = ring.len();
                (0..n)
                    .map(|i| {
                        let (p, q) = (ring[i], ring[(i + 1) % n]);
                        -p.perp_dot(q) * (p.x + q.x) / 6.0
                    })
                    .sum::<f64>()
            })
            .sum();
        let expected = moment * degrees.to_radians() * of_smooth(degrees, segments);
        let found = volume(&surface);
        prop_assert!(
            (found - expected).abs() < 1e-3 * expected + 1e-4 * area(&drawn) * extent,
            "{} {}",
            found,
            expected
        );
        Ok(true)
    });
}
