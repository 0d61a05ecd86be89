use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::billboard::matching::{Matching, match_regions};
use crate::billboard::region::Direction;
use crate::billboard::region::Region;
use crate::billboard::tests::generated::{
    Character, Drawn, FITTED, HELD_BACK, character, directions,
};
use crate::billboard::turn::between as turn_between;
use crate::geometry::{Outline, Polygon};
use crate::law;

const FRONT: Direction = Direction {
    theta: 0.0,
    phi: 0.0,
};

fn direction(theta: f64, phi: f64) -> Direction {
    Direction { theta, phi }
}

/// [`super::place`] with plain lists.
fn place(
    views: &[View],
    frames: &[Frame],
    tracks: &[Track],
    depths: &[Vec<Option<f64>>],
) -> Vec<TrackPosition> {
    let depths: TiVec<_, _> = depths.iter().cloned().map(TiVec::from).collect();
    super::place(
        TiSlice::from_ref(views),
        TiSlice::from_ref(frames),
        TiSlice::from_ref(tracks),
        &depths,
    )
    .raw
}

/// [`super::frames`] with plain lists.
fn frames(views: &[View]) -> Vec<Frame> {
    super::frames(TiSlice::from_ref(views)).raw
}

/// A track as seen from some direction.
struct Pose {
    at: DVec2,
    depth: f64,
}

/// The tracks as seen from a direction, as the model shows them.
fn pose(
    placed: &[TrackPosition],
    views: &[Direction],
    Direction { theta, phi }: Direction,
) -> Vec<Pose> {
    let turn = turn_between(TiSlice::from_ref(views));
    let weights = turn.weights([theta, phi]);
    let pose = |placed: &TrackPosition| Pose {
        at: turn.position(&weights, &placed.in_views).truncate(),
        depth: placed
            .depths
            .iter()
            .zip(&weights)
            .map(|(depth, w)| depth * w)
            .sum(),
    };
    placed.iter().map(pose).collect()
}

/// The order in which tracks are painted, back-most first. Equally deep ones keep their order.
fn paint_order(poses: &[Pose]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..poses.len()).collect();
    order.sort_by(|a, b| poses[*a].depth.total_cmp(&poses[*b].depth));
    order
}

/// A generated character, what was found of it, and where.
struct Found {
    character: Character,
    drawn: Vec<Drawn>,
    views: Vec<View>,
    /// The origin of the drawings is known.
    frames: Vec<Frame>,
    matching: Matching,
    placed: Vec<TrackPosition>,
}

fn found(seed: u64, directions: &[Direction]) -> Found {
    let character = character(seed);
    let drawn: Vec<_> = directions.iter().map(|d| character.true_view(*d)).collect();
    let views: Vec<_> = drawn.iter().map(|d| d.view.clone()).collect();
    let matching = match_regions(
        TiSlice::from_ref(&views),
        TiSlice::from_ref(&frames(&views)),
    );
    let known = Frame {
        center: DVec2::ZERO,
        height: character.scale,
    };
    let frames = vec![known; views.len()];
    let placed = place(&views, &frames, &matching.tracks.raw, &[]);
    Found {
        character,
        drawn,
        views,
        frames,
        matching,
        placed,
    }
}

impl Found {
    /// The tracks whose regions of the first two views show the same item: the track, the item, and the larger hidden share.
    fn right(&self) -> Vec<(usize, usize, f64)> {
        let right = |(t, track): (usize, &Track)| {
            let (a, b) = (
                track.regions[ViewId::FIRST]?,
                track.regions[ViewId::SECOND]?,
            );
            let item = self.drawn[0].items[a];
            let hidden = self.drawn[0].hidden[a].max(self.drawn[1].hidden[b]);
            (self.drawn[1].items[b] == item).then_some((t, item, hidden))
        };
        self.matching
            .tracks
            .iter()
            .enumerate()
            .filter_map(right)
            .collect()
    }

    fn directions(&self) -> Vec<Direction> {
        self.views.iter().map(|v| v.direction).collect()
    }

    fn center(&self, view: usize, region: RegionId) -> DVec2 {
        let (low, high) = bounds(&self.views[view].regions[region].outline).unwrap();
        self.frames[view].on_screen((low + high) / 2.0)
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn the_places_of_200_characters_are_known_to_a_percent() {
    assert_places_are_known(FITTED);
}

#[test]
fn the_places_of_200_characters_that_were_held_back_are_known_to_a_percent() {
    assert_places_are_known(HELD_BACK);
}

fn assert_places_are_known(seeds: Range<u64>) {
    let (mut all, mut clear) = (Vec::new(), Vec::new());
    for seed in seeds {
        let directions = directions(seed);
        let found = found(seed, &directions);
        for (track, item, hidden) in found.right() {
            let error = found.placed[track]
                .point
                .distance(found.character.center(item));
            if directions[1].theta.abs() == 45.0 {
                all.push(error);
            }
            if hidden < 0.05 {
                clear.push(error);
            }
        }
    }
    assert!(
        all.len() > 2500 && clear.len() > 3000,
        "{} {}",
        all.len(),
        clear.len()
    );
    assert!(mean(&all) < 0.01, "{} of the height", mean(&all));
    assert!(mean(&clear) < 0.002, "{} of the height", mean(&clear));
}

#[test]
fn found_frames_give_the_same_places_but_for_a_common_shift() {
    let mut errors = Vec::new();
    for seed in (0..100).filter(|s| s % 12 < 10) {
        let found = found(seed, &directions(seed));
        let placed = place(
            &found.views,
            &frames(&found.views),
            &found.matching.tracks.raw,
            &[],
        );
        let shifts: Vec<_> = placed
            .iter()
            .zip(&found.placed)
            .map(|(a, b)| a.point - b.point)
            .collect();
        let right = found.right();
        let [first, ..] = right[..] else {
            panic!("nothing matched");
        };
        let shift = shifts[first.0];
        errors.extend(
            right
                .iter()
                .map(|(track, ..)| shifts[*track].distance(shift)),
        );
    }
    assert!(errors.len() > 1500);
    assert!(mean(&errors) < 0.001, "{}", mean(&errors));
}

#[test]
fn drawn_views_are_reproduced() {
    let mut count = 0;
    for seed in 0..24 {
        let found = found(seed, &directions(seed));
        let directions = found.directions();
        for view in 0..2 {
            let poses = pose(&found.placed, &directions, directions[view]);
            for (track, pose) in found.matching.tracks.iter().zip(poses) {
                if let Some(region) = track.regions[ViewId::from(view)] {
                    assert!(pose.at.distance(found.center(view, region)) < 1e-12);
                    count += 1;
                }
            }
        }
    }
    assert!(count > 1000);
}

#[test]
fn contents_lie_in_front_of_their_containers_in_all_views() {
    let (mut count, mut contrary) = (0, 0);
    for seed in 0..100 {
        let found = found(seed, &directions(seed));
        let tracks = &found.matching.tracks;
        let track = |view: usize, region| {
            let is_there = |t: &Track| t.regions[ViewId::from(view)] == Some(region);
            tracks.iter().position(is_there)
        };
        for drawn in 0..2 {
            for (inner, region) in found.views[drawn].regions.iter_enumerated() {
                let Some(outer) = region.container else {
                    continue;
                };
                let [inner, outer] = [inner, outer].map(|r| track(drawn, r).unwrap());
                for seen in 0..2 {
                    let [z, below] =
                        [inner, outer].map(|t| found.placed[t].depths[ViewId::from(seen)]);
                    count += 1;
                    if z < below + 0.002 - 1e-8 {
                        // Only the other drawing's own order may say the opposite.
                        assert_ne!(drawn, seen, "seed {seed}");
                        contrary += 1;
                    }
                }
            }
        }
    }
    assert!(count > 4000, "{count} pairs");
    assert!(contrary * 100 < count, "{contrary} of {count}");
}

#[test]
fn two_tracks_change_their_order_at_most_once_between_two_views() {
    let (mut pairs, mut changing) = (0, 0);
    for seed in 0..12 {
        let found = found(seed, &directions(seed));
        let directions = found.directions();
        let ranks: Vec<Vec<usize>> = (0..=32)
            .map(|step| {
                let share = f64::from(step) / 32.0;
                let [from, to] = [directions[0], directions[1]];
                let between = direction(
                    from.theta + (to.theta - from.theta) * share,
                    from.phi + (to.phi - from.phi) * share,
                );
                let order = paint_order(&pose(&found.placed, &directions, between));
                let mut ranks = vec![0; order.len()];
                for (rank, track) in order.into_iter().enumerate() {
                    ranks[track] = rank;
                }
                ranks
            })
            .collect();
        for a in 0..found.placed.len() {
            for b in 0..a {
                let over: Vec<_> = ranks.iter().map(|r| r[a] > r[b]).collect();
                let changes = over.windows(2).filter(|w| w[0] != w[1]).count();
                // Equally deep ones are ordered by their index at one end only.
                assert!(
                    changes <= 1,
                    "seed {seed}: {a} and {b} change {changes} times"
                );
                pairs += 1;
                changing += changes;
            }
        }
    }
    assert!(pairs > 3000 && changing > 300, "{pairs} {changing}");
}

#[test]
fn between_the_views_regions_are_where_they_truly_are() {
    assert_regions_are_where_they_are(FITTED.start..FITTED.start + 40);
    assert_regions_are_where_they_are(HELD_BACK.start..HELD_BACK.start + 40);
}

fn assert_regions_are_where_they_are(seeds: Range<u64>) {
    let mut errors: Vec<f64> = Vec::new();
    let mut worst = (0.0, "", 0);
    for seed in seeds {
        let directions = [FRONT, direction(45.0, 0.0)];
        let found = found(seed, &directions);
        let between = direction(22.5, 0.0);
        let poses = pose(&found.placed, &directions, between);
        let [right, up, _] = between.axes();
        for (track, item, hidden) in found.right() {
            if hidden < 0.05 {
                let center = found.character.center(item);
                let truth = DVec2::new(center.dot(right), center.dot(up));
                let error = poses[track].at.distance(truth);
                errors.push(error);
                let kind = found.character.items[item].kind;
                worst = if error > worst.0 {
                    (error, kind, seed)
                } else {
                    worst
                };
            }
        }
    }
    assert!(errors.len() > 500, "{}", errors.len());
    assert!(mean(&errors) < 0.002, "{}, worst {worst:?}", mean(&errors));
}

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
