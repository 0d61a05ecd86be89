//! Drawings of which it is known by hand where everything is.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;

fn square(at: [f64; 2], half: f64, container: Option<usize>) -> Region {
    let corner = |x: f64, y: f64| DVec2::new(at[0] + half * x, at[1] + half * y);
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    Region {
        name: None,
        outline: Arc::new(Outline {
            polygons: vec![Polygon {
                rings: vec![corners.map(|(x, y)| corner(x, y)).to_vec()],
            }],
        }),
        color: [0.5, 0.5, 0.5, 1.0],
        container: container.map(RegionId::from),
        is_line: false,
    }
}

fn view(theta: f64, regions: Vec<Region>) -> View {
    View {
        direction: direction(theta, 0.0),
        regions: regions.into(),
    }
}

fn track(regions: impl IntoIterator<Item = Option<usize>>) -> Track {
    let regions = regions.into_iter();
    Track {
        regions: regions.map(|region| region.map(RegionId::from)).collect(),
    }
}

const UNIT: Frame = Frame {
    center: DVec2::ZERO,
    height: 1.0,
};

/// The depth of each track in a view.
fn depths(placed: &[TrackPosition], view: usize) -> Vec<f64> {
    placed
        .iter()
        .map(|p| p.depths[ViewId::from(view)])
        .collect()
}

#[test]
fn a_region_of_one_view_lies_on_its_container() {
    // The container's x of 0 and −0.4 at 45° tells its depth.
    let z = 0.4 / 45f64.to_radians().sin();
    let views = [
        view(
            0.0,
            vec![
                square([0.0, 0.0], 0.3, None),
                square([0.1, 0.1], 0.1, Some(0)),
            ],
        ),
        view(
            45.0,
            vec![
                square([-0.4, 0.0], 0.3, None),
                square([0.8, 0.0], 0.1, None),
            ],
        ),
    ];
    let tracks = [
        track([Some(0), Some(0)]),
        track([Some(1), None]),
        track([None, Some(1)]),
    ];
    let placed = place(&views, &[UNIT; 2], &tracks, &[]);
    assert!(placed[0].point.distance(DVec3::new(0.0, 0.0, z)) < 1e-12);
    assert!(placed[1].point.distance(DVec3::new(0.1, -0.1, z)) < 1e-12);
    assert!((depths(&placed, 0)[1] - (z + 0.002)).abs() < 1e-8);
    assert!((depths(&placed, 1)[2] - depths(&placed, 1)[0]).abs() < 1e-8);
}

#[test]
fn overlapping_shapes_keep_each_drawings_own_order() {
    // The first drawing paints 0, 1, 2; the second 2, 1, 0; and 3 lies over 2 in the second only.
    let at = |x: f64| square([x, 0.0], 0.1, None);
    let views = [
        view(
            0.0,
            vec![at(0.0), at(0.05), at(0.1), square([-0.9, 0.0], 0.1, None)],
        ),
        view(30.0, vec![at(0.0), at(0.05), at(0.1), at(0.02)]),
    ];
    let tracks = [
        track([Some(0), Some(2)]),
        track([Some(1), Some(1)]),
        track([Some(2), Some(0)]),
        track([Some(3), Some(3)]),
    ];
    let placed = place(&views, &[UNIT; 2], &tracks, &[]);
    let [first, second] = [0, 1].map(|v| depths(&placed, v));
    let over = |z: &[f64], upper: usize, lower: usize| z[upper] - z[lower] > 0.002 - 1e-8;
    assert!(over(&first, 1, 0) && over(&first, 2, 1), "{first:?}");
    assert!(over(&second, 1, 2) && over(&second, 0, 1), "{second:?}");
    assert!(
        over(&second, 3, 2) && over(&first, 3, 2),
        "{first:?} {second:?}"
    );
}

#[test]
fn a_set_depth_is_kept() {
    let inner = |x: f64| square([x, 0.0], 0.1, Some(0));
    let views = [
        view(0.0, vec![square([0.0, 0.0], 0.3, None), inner(0.1)]),
        view(45.0, vec![square([0.0, 0.0], 0.3, None), inner(0.1)]),
    ];
    let tracks = [track([Some(0), Some(0)]), track([Some(1), Some(1)])];
    let frames = [
        UNIT,
        Frame {
            height: 2.0,
            ..UNIT
        },
    ];
    // Behind its container, although it is painted over it.
    let placed = place(&views, &frames, &tracks, &[vec![], vec![None, Some(-0.5)]]);
    assert!((depths(&placed, 1)[1] + 0.25).abs() < 1e-12);
    let seen = on_ray(views[1].direction, DVec2::new(0.05, 0.0), -0.25);
    assert!(placed[1].point.distance(seen) < 1e-12);
    let both = [vec![None, Some(0.7)], vec![None, Some(-0.5)]];
    let placed = place(&views, &frames, &tracks, &both);
    assert!((depths(&placed, 0)[1] - 0.7).abs() < 1e-8);
    assert!((depths(&placed, 1)[1] + 0.25).abs() < 1e-8);
    let between = pose(
        &placed,
        &views.each_ref().map(|v| v.direction),
        direction(22.5, 0.0),
    );
    assert!((between[1].depth - (0.7 - 0.25) / 2.0).abs() < 1e-8);
}

#[test]
fn equal_depths_are_exactly_equal() {
    // Points of one plane across the first view, as the second one sees them.
    let at = |i: usize| DVec3::new(0.1 * i as f64 - 0.4, 0.07 * i as f64, 0.3);
    let shown = |theta: f64| {
        let [right, up, _] = direction(theta, 0.0).axes();
        let square = |i| square([at(i).dot(right), -at(i).dot(up)], 0.01, None);
        view(theta, (0..8).map(square).collect())
    };
    let views = [shown(0.0), shown(37.0)];
    let tracks: Vec<_> = (0..8).map(|i| track([Some(i), Some(i)])).collect();
    let placed = place(&views, &[UNIT; 2], &tracks, &[]);
    let depths = depths(&placed, 0);
    assert!(depths.iter().all(|d| *d == depths[0]), "{depths:?}");
}

#[test]
fn a_track_that_a_view_does_not_show_follows_its_container() {
    // The drawings contradict each other by 0.1 in y.
    let views = [
        view(
            0.0,
            vec![
                square([0.0, 0.0], 0.3, None),
                square([0.1, 0.0], 0.1, Some(0)),
            ],
        ),
        view(90.0, vec![square([0.0, 0.1], 0.3, None)]),
    ];
    let tracks = [track([Some(0), Some(0)]), track([Some(1), None])];
    let placed = place(&views, &[UNIT; 2], &tracks, &[]);
    let [outer, inner] = [0, 1].map(|t| placed[t].in_views[ViewId::SECOND]);
    assert!(((inner - outer).y - (placed[1].point - placed[0].point).y).abs() < 1e-12);
    assert!(((inner - placed[1].point).y + 0.05).abs() < 1e-12);
}

#[test]
fn lengths_beyond_all_drawings_do_not_overflow() {
    let far = [1e300, -1e300, 1e20, f64::INFINITY, f64::NAN];
    for length in far {
        let views = [
            view(0.0, vec![square([length, 0.0], 1.0, None)]),
            view(90.0, vec![square([0.0, length], 1.0, None)]),
        ];
        let set = vec![vec![Some(length)], vec![Some(length)]];
        for depths in [set.as_slice(), &[]] {
            let placed = place(&views, &[UNIT; 2], &[track([Some(0), Some(0)])], depths);
            assert!(placed[0].point.is_finite());
            assert!(placed[0].in_views.iter().all(|place| place.is_finite()));
        }
    }
}

#[test]
fn parallel_rays_have_no_nearest_point() {
    for other in [
        direction(0.3, 0.0),
        direction(180.0, 0.0),
        FRONT,
        direction(360.0, 0.2),
    ] {
        assert_eq!(
            nearest_to_rays(&[(FRONT, DVec2::ZERO), (other, DVec2::ONE)]),
            None
        );
    }
    assert_eq!(nearest_to_rays(&[]), None);
    assert_eq!(nearest_to_rays(&[(FRONT, DVec2::ONE)]), None);
}

#[test]
fn level_views_of_different_sizes_are_equally_high() {
    let views = [
        view(0.0, vec![square([5.0, 5.0], 1.0, None)]),
        view(45.0, vec![square([-50.0, 5.0], 10.0, None)]),
    ];
    let frames = frames(&views);
    assert_eq!([frames[0].height, frames[1].height], [2.0, 20.0]);
    assert_eq!(
        frames[1].on_screen(DVec2::new(-40.0, -5.0)),
        DVec2::new(0.5, 0.5)
    );
    assert_eq!(
        frames[1].in_drawing(DVec2::new(0.5, 0.5)),
        DVec2::new(-40.0, -5.0)
    );
}

#[test]
fn the_nearest_point_is_where_algorithm_1_ends() {
    let inputs = prop::collection::vec((-80.0..80.0, -60.0..60.0, -1.0..1.0, -1.0..1.0), 2..5);
    // 99 % are.
    law::check(law::config(256), 90, inputs, |rays| {
        let rays: Vec<_> = rays
            .iter()
            .map(|(t, p, x, y)| (direction(*t, *p), DVec2::new(*x, *y)))
            .collect();
        let apart = rays
            .iter()
            .map(|r| angle(rays[0].0, r.0))
            .fold(0.0, f64::max);
        if apart <= 20.0 {
            return Ok(false);
        }
        let found = nearest_to_rays(&rays).unwrap();
        let mut point = DVec3::ZERO;
        for _ in 0..3000 {
            let projected = rays.iter().map(|(d, at)| {
                let toward = d.axes()[2];
                on_ray(*d, *at, point.dot(toward))
            });
            point = projected.sum::<DVec3>() / rays.len() as f64;
        }
        prop_assert!(point.distance(found) < 1e-6, "{point} {found}");
        Ok(true)
    });
}

proptest! {
    #[test]
    fn any_input_gives_places(
        numbers in prop::collection::vec(prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e300), -9.0..9.0], 40),
        containers in prop::collection::vec(prop::option::of(0usize..7), 12),
        tracks in prop::collection::vec(prop::collection::vec(prop::option::of(0usize..6), 0..4), 0..6),
        counts in prop::collection::vec(0usize..5, 0..4),
    ) {
        let mut numbers = numbers.into_iter().cycle();
        let mut containers = containers.into_iter().cycle();
        let mut views = Vec::new();
        for count in counts {
            let mut next = || numbers.next().unwrap();
            let regions = (0..count).map(|_| square([next(), next()], next(), containers.next().unwrap())).collect();
            views.push(view(views.len() as f64 * 20.0, regions));
        }
        let tracks: Vec<_> = tracks.into_iter().map(track).collect();
        let set = vec![vec![numbers.next(), None, numbers.next()]; 2];
        let placed = place(&views, &frames(&views), &tracks, &set);
        prop_assert_eq!(placed.len(), tracks.len());
        for placed in placed {
            prop_assert!(placed.point.is_finite() && placed.in_views.iter().all(|p| p.is_finite()));
        }
    }
}
