//! Drawn lines.

use glam::DVec2;

use super::generated::{ellipse, outline, pair};
use super::*;

fn mouth(points: usize, smile: f64) -> Vec<DVec2> {
    let each = (0..points).map(|i| i as f64 / (points - 1) as f64);
    each.map(|t| DVec2::new(100.0 * t, smile * (1.0 - (2.0 * t - 1.0).powi(2))))
        .collect()
}

/// The distances of a mesh's points on both sides from a line in the middle, the round ends left out.
fn half_widths(points: &[DVec2], line: &[DVec2]) -> Vec<f64> {
    let distance = |point: DVec2| {
        let edges = line.windows(2).map(|edge| {
            let along =
                (point - edge[0]).dot(edge[1] - edge[0]) / (edge[1] - edge[0]).length_squared();
            edge[0].lerp(edge[1], along.clamp(0.0, 1.0)).distance(point)
        });
        edges.fold(f64::INFINITY, f64::min)
    };
    points.iter().map(|point| distance(*point)).collect()
}

#[test]
fn lines_keep_their_width() {
    let disc = |half: DVec2| outline(vec![ellipse(80, DVec2::ZERO, half)]);
    let outlines = [disc(DVec2::new(100.0, 80.0)), disc(DVec2::new(70.0, 85.0))];
    let morph = morph(&outlines, &[]);
    let points: Vec<Vec<DVec2>> = (morph.points.iter())
        .map(|points| morph.rings[0].iter().map(|i| points[*i as usize]).collect())
        .collect();
    let mesh = line_mesh(&points, &[4.0, 6.0], Ends::Joined);
    assert_valid(&mesh, 2);
    for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let weights = [1.0 - t, t];
        let each = points[0].iter().zip(&points[1]);
        let mut line: Vec<DVec2> = each.map(|(a, b)| a.lerp(*b, t)).collect();
        line.push(line[0]);
        let half = 2.0 + t;
        for width in half_widths(&blend(&mesh, &weights), &line) {
            assert!((width / half - 1.0).abs() < 0.02, "at {t}: {width}");
        }
        let length: f64 = line.windows(2).map(|edge| edge[0].distance(edge[1])).sum();
        let area = ring_area(&mesh, &weights);
        assert!((area / (2.0 * half * length) - 1.0).abs() < 0.02, "{area}");
        assert!(coverage_error(&mesh, &weights) < 1e-6);
    }
}

#[test]
fn every_outline_can_be_drawn() {
    for index in 0..PAIRS {
        let pair = pair(index);
        let morph = morph(&pair.outlines, &[]);
        for ring in &morph.rings {
            let points: Vec<Vec<DVec2>> = (morph.points.iter())
                .map(|points| ring.iter().map(|i| points[*i as usize]).collect())
                .collect();
            let mesh = line_mesh(&points, &[2.0, 2.0], Ends::Joined);
            assert_valid(&mesh, 2);
            for (view, line) in points.iter().enumerate() {
                let line = [&line[..], &line[..1]].concat();
                for width in half_widths(&mesh.points.raw[view], &line) {
                    assert!(width < 1.06, "{} {index}: {width}", pair.name);
                }
                // At corners the edges overlap on the inner side, and the outer one is round.
                let length: f64 = line.windows(2).map(|e| e[0].distance(e[1])).sum();
                let mut corners = 0.0;
                let mut before = line[line.len() - 1] - line[line.len() - 2];
                for edge in line.windows(2).map(|edge| edge[1] - edge[0]) {
                    let half_turn = edge.angle_to(before).abs() / 2.0;
                    corners += half_turn.tan().min(10.0) - half_turn;
                    before = edge;
                }
                let area = ring_area(&mesh, &only(view, 2)) / (2.0 * length - corners);
                assert!((area - 1.0).abs() < 0.05, "{} {index}: {area}", pair.name);
            }
        }
    }
}

#[test]
fn inner_lines_correspond_from_end_to_end() {
    let mut turned = mouth(23, 20.0);
    turned.reverse();
    for second in [mouth(23, 20.0), turned] {
        let matched = match_lines(&[mouth(17, -30.0), second]);
        let [first, second] = &matched[..] else {
            panic!("two views");
        };
        assert_eq!(first.len(), second.len());
        let ends = [
            first[0],
            first[first.len() - 1],
            second[0],
            second[second.len() - 1],
        ];
        let expected = [0.0, 100.0, 0.0, 100.0].map(|x| DVec2::new(x, 0.0));
        for (end, expected) in ends.iter().zip(expected) {
            assert!(end.distance(expected) < 1e-9, "{end}");
        }
        // Both sag the same way along.
        for (a, b) in first.iter().zip(second) {
            assert!((a.x - b.x).abs() < 8.0, "{a} {b}");
        }
        for (line, drawn) in [(first, mouth(17, -30.0)), (second, mouth(23, 20.0))] {
            let away = half_widths(&drawn, line).into_iter().fold(0.0, f64::max);
            assert!(away < 0.05, "{away}");
        }
    }
}

#[test]
fn inner_lines_have_round_ends() {
    let straight = vec![DVec2::ZERO, DVec2::new(100.0, 0.0)];
    let matched = match_lines(&[straight.clone(), straight]);
    let mesh = line_mesh(&matched, &[10.0, 0.0], Ends::Free);
    assert_valid(&mesh, 2);
    let (low, high) = mesh.points.raw[0]
        .iter()
        .fold((DVec2::MAX, DVec2::MIN), |(low, high), p| {
            (low.min(*p), high.max(*p))
        });
    assert!(
        low.distance(DVec2::new(-5.0, -5.0)) < 1e-9 && high.distance(DVec2::new(105.0, 5.0)) < 1e-9
    );
    let area = ring_area(&mesh, &[1.0, 0.0]);
    let disc = std::f64::consts::PI * 25.0;
    assert!((area - 1000.0 - disc).abs() < 0.1 * disc, "{area}");
    assert!(coverage_error(&mesh, &[1.0, 0.0]) < 1e-9);
    assert!(ring_area(&mesh, &[0.0, 1.0]).abs() < 1e-9);
}

#[test]
fn a_corner_keeps_its_points_where_it_is_straight() {
    let bent = vec![DVec2::ZERO, DVec2::new(50.0, 0.0), DVec2::new(50.0, 50.0)];
    let straight = vec![DVec2::ZERO, DVec2::new(50.0, 0.0), DVec2::new(100.0, 0.0)];
    let points = [bent, straight];
    let mesh = line_mesh(&points, &[8.0, 8.0], Ends::Free);
    assert_valid(&mesh, 2);
    for (view, line) in points.iter().enumerate() {
        for width in half_widths(&mesh.points.raw[view], line) {
            assert!(width < 4.0 * 1.42, "{width}");
        }
        let area = ring_area(&mesh, &only(view, 2));
        assert!((area - 800.0 - 50.0).abs() < 15.0, "{area}");
        assert!(coverage_error(&mesh, &only(view, 2)) < 1e-9);
    }
    // The outer side of the corner is an arc.
    let corner = DVec2::new(50.0, 0.0);
    let on_arc = mesh.points.raw[0]
        .iter()
        .filter(|p| (p.distance(corner) - 4.0).abs() < 1e-9);
    assert!(on_arc.count() >= 4);
}

#[test]
fn hostile_lines_do_no_harm() {
    let mut random = Random(11);
    let odd = [f64::NAN, f64::INFINITY, 1e308, -1e308, 1e-308, 0.0];
    let mut drawn = 0;
    for _ in 0..300 {
        let views: Vec<Vec<DVec2>> = (0..random.count(0, 4))
            .map(|_| hostile_ring(&mut random, &odd))
            .collect();
        let matched = match_lines(&views);
        assert_eq!(matched.len(), views.len());
        assert!(matched.iter().all(|line| line.len() == matched[0].len()));
        for ends in [Ends::Free, Ends::Joined] {
            for points in [&views, &matched] {
                let mesh = line_mesh(points, &[1.0, f64::NAN, -3.0], ends);
                assert_valid(&mesh, views.len());
                drawn += usize::from(!mesh.triangles.is_empty());
            }
        }
    }
    assert!(drawn > 200, "{drawn}");
}
