use std::f64::consts::{PI, TAU};

use glam::{DVec2, Vec3};
use proptest::prelude::*;

use super::super::check::{closed, volume};
use super::super::laws;
use super::super::stack::PlacementTransform;
use super::super::tests::{circle, options, outline, profile, rectangle};
use super::super::{Options, Placement, build};
use super::{Points, mesh};
use crate::geometry::{Outline, bounds, contains};
use crate::law;
use crate::scene::Surface;

fn at(surface: &Surface, corner: u32) -> Vec3 {
    Vec3::from(surface.positions[corner as usize])
}

/// What holds of every inflated outline, in the frame the outline is in; its highest point has the height `h`, or,
/// where none was `given`, at most that.
fn lawful(surface: &Surface, outline: &Outline, h: f64, given: bool) -> Result<(), String> {
    closed(surface)?;
    if volume(surface) <= 0.0 {
        return Err("wound inward".to_owned());
    }
    let (low, high) = bounds(outline).ok_or("no outline")?;
    let slack = 1e-5 * (high - low).max_element();
    let mut highest = 0.0f64;
    for (p, n) in surface.positions.iter().zip(&surface.normals) {
        let [x, y, z] = p.map(f64::from);
        let inside = DVec2::new(x, y).clamp(low - slack, high + slack) == DVec2::new(x, y);
        let length = Vec3::from(*n).length();
        if !inside || z.abs() > h * 1.000_01 || (length - 1.0).abs() > 1e-4 {
            return Err(format!("point {p:?} with normal {n:?}"));
        }
        highest = highest.max(z.abs());
    }
    if given && (highest / h - 1.0).abs() > 1e-3 || highest <= 0.0 {
        return Err(format!("highest at {highest}, not {h}"));
    }
    for triangle in &surface.triangles {
        let [a, b, c] = triangle.map(|i| at(surface, i).as_dvec3());
        let face = (b - a).cross(c - a);
        let front = a.z + b.z + c.z > 0.0;
        if face.z == 0.0 || (face.z > 0.0) != front {
            return Err(format!("triangle {a} {b} {c} turns over"));
        }
        for i in triangle {
            let normal = Vec3::from(surface.normals[*i as usize]).as_dvec3();
            if normal.dot(face.normalize()) < -1e-6 {
                return Err(format!("normal {normal} against {a} {b} {c}"));
            }
        }
        // On the drawing plane is the border and nothing else.
        let middle = ((a + b + c) / 3.0).truncate();
        let flat = [a, b, c].iter().filter(|p| p.z == 0.0).count();
        let area = face.z.abs() / (high - low).max_element().powi(2);
        if flat == 3 || (area > 1e-6 && !contains(outline, middle)) {
            return Err(format!("triangle {a} {b} {c} is not in the outline"));
        }
    }
    Ok(())
}

fn inflated(outline: &Outline, given: Option<f64>, segments: u32) -> Surface {
    build(
        outline,
        &profile("inflate", given.as_slice()),
        &options(segments),
    )
}

/// The greatest distance of a surface from the sphere about the origin, relative to its radius.
fn off_sphere(surface: &Surface, radius: f64) -> f64 {
    let off = |p: &[f32; 3]| (Vec3::from(*p).as_dvec3().length() / radius - 1.0).abs();
    surface.positions.iter().map(off).fold(0.0, f64::max)
}

#[test]
fn a_disc_becomes_a_ball() {
    for (points, segments) in [(40, 16), (64, 16), (96, 16), (96, 8), (300, 32)] {
        let disc = circle(10.0, points);
        let ball = inflated(&disc, None, segments);
        let (low, high) = bounds(&disc).unwrap();
        lawful(&ball, &disc, (high - low).min_element() / 2.0, true).unwrap();
        let off = off_sphere(&ball, 10.0);
        // Few layers are too coarse for more.
        let most = if segments < 16 { 0.02 } else { 0.01 };
        assert!(off < most, "{points} {segments}: {off}");
        let rounded = build(&disc, &profile("round", &[-90., 90.]), &options(segments));
        assert!(off_sphere(&rounded, 10.0) < 0.01);
        assert!(ball.triangles.len() < 2 * rounded.triangles.len());
        // Smooth all over: one corner a point, its normal that of the ball.
        for (p, n) in ball.positions.iter().zip(&ball.normals) {
            let cosine = Vec3::from(*p).normalize().dot(Vec3::from(*n));
            assert!(cosine > 0.98, "{p:?} {n:?} {cosine}");
        }
    }
    let lens = inflated(&circle(10.0, 96), Some(4.0), 16);
    let whole = 4.0 / 3.0 * PI * 400.0;
    assert!((volume(&lens) / whole - 1.0).abs() < 0.02);
}

#[test]
fn a_bar_is_round_inside() {
    let bar = rectangle(20.0, 100.0);
    let surface = inflated(&bar, None, 16);
    lawful(&surface, &bar, 10.0, true).unwrap();
    let middle = surface.positions.iter().filter(|p| p[1].abs() < 15.0);
    let mut count = 0;
    for [x, _, z] in middle {
        assert!((x.hypot(*z) / 10.0 - 1.0).abs() < 0.02, "{x} {z}");
        count += 1;
    }
    assert!(count > 60, "{count}");
}

#[test]
fn thin_limbs_are_thinner() {
    let points = [
        (-20, -20),
        (20, -20),
        (20, -3),
        (80, -3),
        (80, 3),
        (20, 3),
        (20, 20),
        (-20, 20),
    ];
    let ring = points.map(|(x, y)| DVec2::new(x.into(), y.into()));
    let body = outline(vec![ring.to_vec()]);
    let surface = inflated(&body, None, 16);
    lawful(&surface, &body, 20.0, false).unwrap();
    let limb = surface
        .positions
        .iter()
        .filter(|p| (20.0..40.0).contains(&p[0]));
    let highest = limb.map(|p| p[2]).fold(0.0, f32::max);
    assert!((2.0..5.0).contains(&highest), "{highest}");
}

#[test]
fn many_points_and_many_segments_stay_small() {
    let angle = |i: usize| i as f64 / 5000.0 * TAU;
    let ring: Vec<DVec2> = (0..5000)
        .map(|i| (10.0 + (40.0 * angle(i)).sin()) * DVec2::from_angle(angle(i)))
        .collect();
    let wavy = outline(vec![ring]);
    for segments in [2, 16, 512] {
        let surface = inflated(&wavy, Some(3.0), segments);
        lawful(&surface, &wavy, 3.0, true).unwrap();
        assert!(
            surface.triangles.len() < 400_000,
            "{}",
            surface.triangles.len()
        );
    }
}

#[test]
fn without_height_there_is_a_little() {
    for given in [0.0, f64::NAN, 1e-300] {
        let surface = inflated(&rectangle(20.0, 30.0), Some(given), 16);
        closed(&surface).unwrap();
        assert!(volume(&surface) > 0.0);
    }
}

#[test]
fn far_from_the_joint() {
    let placement = Placement {
        translation: glam::DVec3::new(900.0, -300.0, 700.0),
        ..Placement::default()
    };
    let o = Options {
        placement,
        ..options(16)
    };
    let surface = build(&circle(0.5, 40), &profile("inflate", &[]), &o);
    closed(&surface).unwrap();
    assert!((volume(&surface) / (PI / 6.0) - 1.0).abs() < 0.05);
}

#[test]
fn inflated_outlines_are_lawful() {
    let inputs = (laws::rings(), 2u32..24, prop::option::of(0.05..1.0f64));
    // Hardly any outline is empty.
    law::check(laws::config(), 90, inputs, |(rings, segments, given)| {
        let outline = outline(rings);
        if outline.polygons.is_empty() {
            return Ok(false);
        }
        let (low, high) = bounds(&outline).unwrap();
        let h = given.unwrap_or((high - low).min_element() / 2.0);
        let surface = inflated(&outline, given, segments);
        if let Err(error) = lawful(&surface, &outline, h, given.is_some()) {
            return Err(TestCaseError::fail(error));
        }
        Ok(true)
    });
}

/// What is thin everywhere stays thin, whatever its box.
#[test]
fn rings_and_bars_are_as_thick_as_their_strokes() {
    let highest = |outline: &Outline| {
        let surface = build(outline, &profile("inflate", &[]), &options(16));
        let heights = surface.positions.iter().map(|p| f64::from(p[2]));
        heights.fold(0.0, f64::max)
    };
    let circle = |r: f64| -> Vec<DVec2> {
        let at = |i: u32| r * DVec2::from_angle(f64::from(i) / 120.0 * TAU);
        (0..120).map(at).collect()
    };
    let ring = outline(vec![circle(10.0), circle(8.0)]);
    // A straight bar of the same width has 2√(w²/8).
    let expected = 2.0_f64.sqrt();
    assert!(
        (highest(&ring) / expected - 1.0).abs() < 0.03,
        "{}",
        highest(&ring)
    );
    // The middle of a bar may not be higher than half its width.
    let bar = rectangle(2.0, 40.0);
    assert!((highest(&bar) - 1.0).abs() < 1e-3, "{}", highest(&bar));
}

/// Long edges between short ones are in each other's way in the triangulation before they are part of the border.
#[test]
fn borders_are_kept() {
    let mut random = fastrand::Rng::with_seed(1);
    for count in (3..120).chain([1000]) {
        let mut ring: Vec<DVec2> = (0..count)
            .map(|i| {
                let radius = if random.bool() { 1.0 } else { random.f64() };
                DVec2::from_angle(f64::from(i) / f64::from(count) * TAU) * radius.max(0.01)
            })
            .collect();
        let edges = (0..ring.len()).map(|i| [i, (i + 1) % ring.len()]).collect();
        let exact = |points: &[DVec2]| {
            let next = points.iter().cycle().skip(1);
            let sum: f64 = points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
            sum / 2.0
        };
        let expected = exact(&ring);
        let inner = (0..count).map(|_| DVec2::new(random.f64(), random.f64()) * 2.0 - 1.0);
        ring.extend(inner);
        let points = Points {
            points: ring,
            edges,
        };
        let mesh = mesh(&points, &PlacementTransform::new(&options(16)));
        let at = |i: u32| Vec3::new(mesh.points[i as usize][0], mesh.points[i as usize][1], 0.0);
        let area = |triangle: &[u32; 3]| {
            let corners = triangle.map(|i| at(i).as_dvec3().truncate());
            let area = exact(&corners);
            assert!(area > 0.0, "{corners:?}");
            area
        };
        let found: f64 = mesh.triangles.iter().map(area).sum();
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{count}: {found} {expected}"
        );
    }
}

/// In a drawing 1000 wide, where nobody sees deviations of less than 0.05.
#[test]
fn outlines_that_are_small_beside_the_drawing_have_fewer_layers() {
    let segments = |radius: f64, given: Option<f64>, crease: f64| {
        let profile = profile("inflate", given.as_slice());
        profile.segments(DVec2::new(radius, 2.0 * radius), crease, 0.05)
    };
    let of_radii = [100.0, 10.0, 6.0, 3.0, 0.0].map(|radius| segments(radius, None, 30.0));
    assert_eq!(of_radii, [16, 16, 12, 8, 8]);
    assert_eq!(segments(3.0, Some(50.0), 30.0), 16, "it is high");
    let of_creases = [0.0, 10.0, 15.0, 180.0, f64::NAN].map(|crease| segments(3.0, None, crease));
    assert_eq!(of_creases, [16, 16, 13, 8, 8], "no edges show");
    assert_eq!(
        profile("round", &[-90.0, 90.0]).segments(DVec2::ONE, 30.0, 0.05),
        16
    );
}

/// The stroke of a line through these points, and the tube that it becomes.
fn tube(path: &[DVec2], width: f64, is_closed: bool) -> (Outline, Surface) {
    let mut builder = usvg::tiny_skia_path::PathBuilder::new();
    let [first, rest @ ..] = path else {
        panic!("a line has points");
    };
    builder.move_to(first.x as f32, first.y as f32);
    for point in rest {
        builder.line_to(point.x as f32, point.y as f32);
    }
    if is_closed {
        builder.close();
    }
    let stroke = usvg::tiny_skia_path::Stroke {
        width: width as f32,
        line_join: usvg::tiny_skia_path::LineJoin::Round,
        ..Default::default()
    };
    let line = builder.finish().expect("a line");
    let stroke = line.stroke(&stroke, 100.0).expect("a stroke");
    let mut rings: Vec<Vec<DVec2>> = Vec::new();
    stroke_rings(&stroke, &mut rings);
    let outline = crate::geometry::resolve_overlaps(rings, crate::geometry::FillRule::NonZero);
    // Borders of drawings run the other way round, as their y is down.
    let outline = outline.map_rings(|ring| ring.iter().rev().copied().collect());
    let profile = profile("inflate", &[]).of_line(width);
    let surface = build(&outline, &profile, &options(8));
    (outline, surface)
}

fn stroke_rings(path: &usvg::tiny_skia_path::Path, rings: &mut Vec<Vec<DVec2>>) {
    use usvg::tiny_skia_path::{PathSegment, Point};
    let at = |p: Point| DVec2::new(p.x.into(), p.y.into());
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => rings.push(vec![at(p)]),
            PathSegment::LineTo(p) | PathSegment::QuadTo(_, p) | PathSegment::CubicTo(_, _, p) => {
                if let Some(ring) = rings.last_mut() {
                    ring.push(at(p));
                }
            }
            PathSegment::Close => {}
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any line becomes a closed tube, half as high as the line is wide, with few triangles.
    #[test]
    fn lines_become_tubes(
        path in prop::collection::vec((-50.0..50.0f64, -50.0..50.0f64), 2..6),
        width in 1.0..12.0f64,
        is_closed: bool,
    ) {
        let path: Vec<DVec2> = path.into_iter().map(DVec2::from).collect();
        let length: f64 = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        prop_assume!(length > 4.0 * width);
        let (_, surface) = tube(&path, width, is_closed);
        closed(&surface).map_err(TestCaseError::fail)?;
        prop_assert!(volume(&surface) > 0.0);
        let heights = surface.positions.iter().map(|[_, _, z]| f64::from(z.abs()));
        let highest = heights.fold(0.0, f64::max);
        prop_assert!((highest / (width / 2.0) - 1.0).abs() < 0.02, "{highest} of {width}");
        prop_assert!(surface.triangles.len() < 4000, "{}", surface.triangles.len());
    }
}

#[test]
fn a_straight_tube_is_a_cylinder() {
    let (_, surface) = tube(&[DVec2::new(-60.0, 0.0), DVec2::new(60.0, 0.0)], 8.0, false);
    assert!(surface.triangles.len() < 600, "{}", surface.triangles.len());
    let middle = surface.positions.iter().filter(|[x, ..]| x.abs() < 50.0);
    let mut count = 0;
    for [_, y, z] in middle {
        let radius = f64::from(*y).hypot((*z).into());
        assert!((radius - 4.0).abs() < 0.05, "{y} {z}");
        count += 1;
    }
    assert!(count > 12, "{count}");
    let exact = PI * 4.0 * 4.0 * 120.0;
    let share = volume(&surface) / exact;
    assert!((0.9..1.0).contains(&share), "{share}");
}
