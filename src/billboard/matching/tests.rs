use std::sync::Arc;

use glam::DVec2;
use proptest::prelude::*;

use super::by_similarity::compared::most_similar;
use super::exchange::{Sides, exchange};
use super::gains::Gains;
use super::*;
use crate::billboard::place::frames;
use crate::billboard::region::{Direction, Region};
use crate::billboard::tests::generated::{Drawn, character, directions};
use crate::geometry::{FillRule, Outline, Polygon, bounds, resolve_overlaps};

const FIRST: ViewId = ViewId::FIRST;
/// The view after the first.
const SECOND: ViewId = ViewId::SECOND;

/// How many of the regions that two drawings share got their right partner.
fn right(drawn: &[Drawn; 2], partners: &TiSlice<RegionId, Option<RegionId>>) -> (usize, usize) {
    let [a, b] = drawn.each_ref().map(|d| &d.items);
    let (mut count, mut right) = (0, 0);
    for (region, item) in a.iter_enumerated() {
        if let Some(other) = b.position(|i| i == item) {
            count += 1;
            right += usize::from(partners[region] == Some(other));
        }
    }
    (right, count)
}

fn drawn(seed: u64) -> [Drawn; 2] {
    let character = character(seed);
    directions(seed).map(|d| character.true_view(d))
}

fn views<const N: usize>(drawn: &[Drawn; N]) -> TiVec<ViewId, View> {
    drawn.iter().map(|d| d.view.clone()).collect()
}

/// The partners of the first view's regions in the second.
fn partners(matching: &Matching, regions: usize) -> TiVec<RegionId, Option<RegionId>> {
    let tracks = matching.tracks.iter();
    let mut partners = TiVec::from(vec![None; regions]);
    for track in tracks {
        if let Some(region) = track.regions[FIRST] {
            partners[region] = track.regions[SECOND];
        }
    }
    partners
}

fn is_behind(warning: &Warning) -> bool {
    matches!(warning, Warning::BehindContainers { .. })
}

#[test]
fn nearly_all_pairs_of_200_characters_are_right_and_none_has_fewer_than_by_similarity() {
    let (mut ours, mut thesis, mut all, mut wrong) = (0, 0, 0, 0);
    for seed in 0..200 {
        let drawn = drawn(seed);
        let views = views(&drawn);
        let frames = frames(&views);
        let matching = match_regions(&views, &frames);
        let partners = partners(&matching, views[FIRST].regions.len());
        let similar = most_similar(
            [FIRST, SECOND].map(|view| &views[view]),
            [FIRST, SECOND].map(|view| &frames[view]),
        );
        let (own, count) = right(&drawn, &partners);
        let (their, _) = right(&drawn, &similar);
        assert!(
            own >= their,
            "seed {seed}: {own} of {count}, by similarity {their}"
        );
        ours += own;
        thesis += their;
        all += count;
        let is_wrong = |p: &&Pair| drawn[0].items[p.first.id] != drawn[1].items[p.second.id];
        wrong += matching.pairs.iter().filter(is_wrong).count();
        assert!(!matching.warnings.iter().any(is_behind), "seed {seed}");
    }
    let share = |n| n as f64 / all as f64;
    assert!(all > 4000, "{all} pairs");
    assert!(share(ours) > 0.98, "{ours} of {all}");
    assert!(share(thesis) < 0.8, "{thesis} of {all}");
    assert!(share(wrong) < 0.01, "{wrong} of {all}");
}

#[test]
fn a_wrong_sign_of_theta_is_noticed() {
    let noticed = (0..100).filter(|seed| {
        let mut views = views(&drawn(*seed));
        for view in &mut views {
            view.direction.theta *= -1.0;
            view.direction.phi *= -1.0;
        }
        let matching = match_regions(&views, &frames(&views));
        matching.warnings.iter().any(is_behind)
    });
    assert!(noticed.count() > 95);
}

#[test]
fn tracks_go_through_three_views() {
    let (mut right, mut all) = (0, 0);
    for seed in 0..30 {
        let character = character(seed);
        let direction = |theta| Direction { theta, phi: 0.0 };
        // The second view is nearer to the third than the first is.
        let drawn = [0.0, 60.0, 30.0].map(|theta| character.true_view(direction(theta)));
        let views = views(&drawn);
        let matching = match_regions(&views, &frames(&views));
        assert_in_one_track(&views, &matching);
        for track in &matching.tracks {
            let items = track.regions.iter().zip(&drawn);
            let items: Vec<_> = items.filter_map(|(r, d)| Some(d.items[(*r)?])).collect();
            let count = |item| drawn.iter().filter(|d| d.items.contains(item)).count();
            all += 1;
            let same = items.iter().all(|i| *i == items[0]);
            right += usize::from(same && items.len() == count(&items[0]));
        }
    }
    assert!(all > 700, "{all} tracks");
    assert!(right as f64 > 0.95 * all as f64, "{right} of {all}");
}

fn assert_in_one_track(views: &TiSlice<ViewId, View>, matching: &Matching) {
    for (i, view) in views.iter_enumerated() {
        for region in view.regions.keys() {
            let tracks = matching.tracks.iter();
            let with = tracks.filter(|t| t.regions.get(i) == Some(&Some(region)));
            assert_eq!(with.count(), 1, "{region:?} of {i:?}");
        }
    }
}

#[test]
fn a_drawings_place_and_size_do_not_matter() {
    for seed in (0..60).filter(|s| s % 12 < 10) {
        let mut views = views(&drawn(seed));
        let before = match_regions(&views, &frames(&views));
        for region in &mut views[SECOND].regions {
            let moved = |p: &DVec2| *p * 3.0 + DVec2::new(900.0, -70.0);
            region.outline = region
                .outline
                .map_rings(|ring| ring.iter().map(moved).collect())
                .into();
        }
        let after = match_regions(&views, &frames(&views));
        assert_eq!(before.tracks, after.tracks, "seed {seed}");
    }
}

#[test]
fn names_decide() {
    let mut named = 0;
    for seed in 0..20 {
        let drawn = drawn(seed);
        let mut views = views(&drawn);
        // Two things that never look alike.
        let a = views[FIRST].regions.last_key().unwrap();
        let b = views[SECOND].regions.first_key().unwrap();
        for (view, region) in [(FIRST, a), (SECOND, b)] {
            views[view].regions[region].name = Some("thing".into());
        }
        let matching = match_regions(&views, &frames(&views));
        let pairs = matching.pairs.iter();
        let pair = pairs.clone().find(|p| p.first.id == a).unwrap();
        assert_eq!(pair.second.id, b);
        // Other names keep a good pair apart.
        let Some(good) = pairs.clone().find(|p| p.cost < 0.3 && p.first.id != a) else {
            continue;
        };
        named += 1;
        views[FIRST].regions[good.first.id].name = Some("one".into());
        views[SECOND].regions[good.second.id].name = Some("other".into());
        let apart = match_regions(&views, &frames(&views));
        let is_good = |p: &&Pair| (p.first, p.second) == (good.first, good.second);
        assert!(!apart.pairs.iter().any(|p| is_good(&p)));
        let unmatched = apart.unmatched.iter().find(|u| u.region == good.first);
        if let Some(unmatched) = unmatched {
            let candidate = unmatched
                .candidates
                .iter()
                .find(|c| c.region == good.second);
            assert_eq!(candidate.unwrap().reason, Reason::Names);
        }
    }
    assert!(named > 15);
}

fn square(at: [f64; 2], half: f64, color: [f64; 3]) -> Region {
    let corner = |x: f64, y: f64| DVec2::new(at[0] + half * x, at[1] + half * y);
    let ring = vec![
        corner(-1.0, -1.0),
        corner(-1.0, 1.0),
        corner(1.0, 1.0),
        corner(1.0, -1.0),
    ];
    Region {
        name: None,
        outline: Arc::new(Outline {
            polygons: vec![Polygon { rings: vec![ring] }],
        }),
        color: [color[0], color[1], color[2], 1.0],
        container: None,
        is_line: false,
    }
}

fn view(theta: f64, regions: Vec<Region>) -> View {
    View {
        direction: Direction { theta, phi: 0.0 },
        regions: regions.into(),
    }
}

const RED: [f64; 3] = [0.9, 0.1, 0.1];
const BLUE: [f64; 3] = [0.1, 0.1, 0.9];

#[test]
fn an_unmatched_region_comes_with_its_candidates_and_why_they_are_not_taken() {
    let body = || square([0.0, 0.0], 50.0, BLUE);
    let first = vec![
        body(),
        square([0.0, -20.0], 4.0, RED),
        square([3.0, -20.0], 4.0, RED),
    ];
    let second = vec![body(), square([1.0, -20.0], 4.0, RED)];
    let views = TiVec::from(vec![view(0.0, first), view(30.0, second)]);
    let matching = match_regions(&views, &frames(&views));
    let [unmatched] = &matching.unmatched[..] else {
        panic!("{:?}", matching.unmatched);
    };
    let at = |view: usize, id: usize| RegionInView {
        view: view.into(),
        id: id.into(),
    };
    let taken = 3 - usize::from(unmatched.region.id);
    let reasons: Vec<_> = unmatched
        .candidates
        .iter()
        .map(|c| (c.region, c.reason))
        .collect();
    assert_eq!(
        reasons,
        [
            (at(1, 1), Reason::Taken(at(0, taken))),
            (at(1, 0), Reason::Color)
        ]
    );
    assert!(unmatched.candidates[0].cost < unmatched.candidates[1].cost);
}

#[test]
fn far_apart_is_a_reason_of_its_own() {
    let body = || square([0.0, 0.0], 50.0, BLUE);
    let views = TiVec::from(vec![
        view(0.0, vec![body(), square([0.0, -48.0], 2.0, RED)]),
        view(30.0, vec![body(), square([0.0, 48.0], 2.0, RED)]),
    ]);
    let matching = match_regions(&views, &frames(&views));
    let reasons: Vec<_> = matching
        .unmatched
        .iter()
        .map(|u| u.candidates[0].reason)
        .collect();
    assert_eq!(reasons, [Reason::Cost, Reason::Cost]);
}

#[test]
fn lines_pair_with_lines_only() {
    let body = || square([0.0, 0.0], 50.0, BLUE);
    let detail = |is_line| Region {
        is_line,
        ..square([0.0, -20.0], 4.0, RED)
    };
    for (first, second) in [(false, false), (false, true), (true, false), (true, true)] {
        let views = TiVec::from(vec![
            view(0.0, vec![body(), detail(first)]),
            view(30.0, vec![body(), detail(second)]),
        ]);
        let matching = match_regions(&views, &frames(&views));
        assert_eq!(matching.pairs.len(), 1 + usize::from(first == second));
        for unmatched in &matching.unmatched {
            assert_eq!(unmatched.candidates[0].reason, Reason::Line);
        }
    }
}

#[test]
fn views_less_than_15_degrees_apart_are_warned_of() {
    for (theta, count) in [(14.0, 1), (16.0, 0), (-14.0, 1), (359.0, 1)] {
        let views = [0.0, theta].map(|theta| view(theta, vec![square([0.0, 0.0], 1.0, RED)]));
        let views = TiVec::from(views.to_vec());
        assert_eq!(match_regions(&views, &frames(&views)).warnings.len(), count);
    }
}

#[test]
fn like_neighbors_keep_their_order() {
    // Each alone would rather be the other one's partner.
    let gains = Gains {
        rows: 2,
        columns: 2,
        values: [2.6, 2.8, 2.8, 2.6].map(Some).to_vec(),
    };
    let mut partners = gains.assign();
    assert_eq!(partners, [Some(1), Some(0)]);
    let at = [DVec2::new(-0.1, 0.0), DVec2::new(0.1, 0.0)];
    let rows = at.map(|at| (FIRST, at));
    let sides = Sides {
        gains: &gains,
        rows: &rows,
        columns: &at,
    };
    exchange(&sides, &mut partners);
    assert_eq!(partners, [Some(0), Some(1)]);
}

fn total(gains: &Gains, partners: &[Option<usize>]) -> f64 {
    let pairs = partners.iter().enumerate();
    pairs.filter_map(|(row, p)| gains.get(row, (*p)?)).sum()
}

/// The best sum of gains by trying everything.
fn best(gains: &Gains, row: usize, taken: &mut Vec<bool>) -> f64 {
    if row == gains.rows {
        return 0.0;
    }
    let mut most = best(gains, row + 1, taken);
    for column in 0..gains.columns {
        if let (Some(gain), false) = (gains.get(row, column), taken[column]) {
            taken[column] = true;
            most = most.max(gain + best(gains, row + 1, taken));
            taken[column] = false;
        }
    }
    most
}

fn any_gains(most: usize) -> impl Strategy<Value = Gains> {
    (0..most, 0..most).prop_flat_map(|(rows, columns)| {
        let gain = prop::option::weighted(0.7, -2.0..3.0);
        let values = prop::collection::vec(gain, rows * columns);
        values.prop_map(move |values| Gains {
            rows,
            columns,
            values,
        })
    })
}

proptest! {
    #[test]
    fn no_assignment_gains_more(gains in any_gains(5)) {
        let partners = gains.assign();
        prop_assert_eq!(partners.len(), gains.rows);
        let most = best(&gains, 0, &mut vec![false; gains.columns]);
        prop_assert!((total(&gains, &partners) - most).abs() < 1e-5);
    }

    #[test]
    fn exchanges_keep_pairs_one_to_one_and_possible_and_never_lose(
        gains in any_gains(9),
        places in prop::collection::vec((-0.2..0.2, -0.2..0.2), 18),
    ) {
        let mut partners = gains.assign();
        let place = |i: usize| DVec2::new(places[i].0, places[i].1);
        let rows: Vec<_> = (0..gains.rows).map(|i| (ViewId::from(i % 2), place(i))).collect();
        let columns: Vec<_> = (0..gains.columns).map(|i| place(9 + i)).collect();
        let sides = Sides { gains: &gains, rows: &rows, columns: &columns };
        let worth = |partners: &[Option<usize>]| {
            let pairs: Vec<_> = partners.iter().enumerate().filter_map(|(r, c)| Some((r, (*c)?))).collect();
            let disorder = |i: usize| pairs[..i].iter().map(|p| sides.between(*p, pairs[i])).sum::<f64>();
            total(&gains, partners) - (0..pairs.len()).map(disorder).sum::<f64>()
        };
        let before = worth(&partners);
        exchange(&sides, &mut partners);
        prop_assert!(worth(&partners) >= before - 1e-9);
        let mut taken: Vec<_> = partners.iter().flatten().collect();
        taken.sort();
        let count = taken.len();
        taken.dedup();
        prop_assert_eq!(taken.len(), count);
        for (row, column) in partners.iter().enumerate() {
            prop_assert!(column.is_none_or(|c| gains.get(row, c).is_some()));
        }
    }

    #[test]
    fn any_input_gives_tracks(
        numbers in prop::collection::vec(prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(0.0), Just(1e300), -9.0..9.0], 60),
        containers in prop::collection::vec(prop::option::of(0usize..8), 12),
        counts in prop::collection::vec(0usize..5, 0..4),
    ) {
        let mut numbers = numbers.into_iter().cycle();
        let mut containers = containers.into_iter().cycle();
        let mut next = || numbers.next().unwrap();
        let mut region = || {
            let mut region = square([next(), next()], next(), [next(), next(), next()]);
            region.container = containers.next().unwrap().map(RegionId::from);
            region
        };
        let mut views: TiVec<ViewId, View> = TiVec::new();
        for count in counts {
            let regions = (0..count).map(|_| region()).collect();
            views.push(view(f64::from(views.len() as u32) * 20.0, regions));
        }
        if let Some(last) = views.last_mut() {
            last.direction.phi = f64::NAN;
        }
        let matching = match_regions(&views, &frames(&views));
        assert_in_one_track(&views, &matching);
        for pair in &matching.pairs {
            prop_assert!(pair.cost.is_finite() && (0.0..=1.0).contains(&pair.similarity));
        }
    }
}

/// A line along the border of a region: what lies between it and its copies that are a little larger and smaller.
fn stroke(region: &Region) -> Region {
    let (low, high) = bounds(&region.outline).expect("an area");
    let middle = (low + high) / 2.0;
    let scaled = |by: f64| {
        let point = |p: &DVec2| middle + (*p - middle) * by;
        region
            .outline
            .rings()
            .next()
            .map(|ring| ring.iter().map(point).collect())
    };
    let rings = [1.03, 0.97].into_iter().filter_map(scaled).collect();
    Region {
        outline: resolve_overlaps(rings, FillRule::EvenOdd).into(),
        color: [0.1, 0.1, 0.1, 1.0],
        container: None,
        is_line: true,
        name: None,
    }
}

#[test]
fn strokes_pair_with_those_of_their_regions_partners() {
    let (mut paired, mut of) = (0, 0);
    for seed in 0..60 {
        let mut drawn = drawn(seed);
        // Some regions have a line in one view, and some in both.
        let mut owners: [Vec<(RegionId, RegionId)>; 2] = Default::default();
        for (side, one) in drawn.iter_mut().enumerate() {
            for region in one.view.regions.keys().collect::<Vec<_>>() {
                if (usize::from(region) + seed as usize) % 4 != side {
                    let line = stroke(&one.view.regions[region]);
                    owners[side].push((one.view.regions.next_key(), region));
                    one.view.regions.push(line);
                }
            }
        }
        let views = views(&drawn);
        let matching = match_regions(&views, &frames(&views));
        let partners = partners(&matching, views[FIRST].regions.len());
        let owner = |side: usize, line: RegionId| {
            let own = owners[side].iter().find(|(own, _)| *own == line);
            own.map(|(_, region)| *region)
        };
        let found = [FIRST, SECOND].map(|view| strokes::owners(&views[view]));
        for (line, region) in &owners[0] {
            // Lines of parts that cover each other may be nearer to another one.
            if found[0][*line] != Some(*region) {
                continue;
            }
            let Some(partner) = partners[*region] else {
                assert_eq!(partners[*line], None, "seed {seed}");
                continue;
            };
            if let Some(other) = partners[*line] {
                assert_eq!(found[1][other], Some(partner), "seed {seed}");
            }
            let has_line = owners[1].iter().any(|(_, region)| *region == partner);
            if has_line {
                of += 1;
                let own = partners[*line].and_then(|other| owner(1, other));
                paired += usize::from(own == Some(partner));
            }
        }
    }
    assert!(of > 500 && paired * 10 > of * 9, "{paired} of {of}");
}
