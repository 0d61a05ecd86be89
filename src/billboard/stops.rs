//! Directions between the views at which morph targets change their course, so that what only some views show fades close to them.
//!
//! Weights are linear between the views of a set, so that a region which shrinks towards a view that does not show it would still be
//! seen far away from where it was drawn. A stop is one more view for all programs that read the model: there, what all views around
//! it show is where it was anyway, and everything else has no area.

use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use crate::scene::{Turn, ViewId, view_axes};

/// How far from the views that show them regions without a partner are seen, degrees; at most half of the way to another view, and
/// all of that way to a view from behind: there, a face goes out of sight as on something round.
const FADE: f64 = 15.0;

/// A share of views; together the shares of a stop are 1.
type Share = (ViewId, f64);

/// The stops from one view to another, and how often the way goes around more than the difference of their angles.
type Known = FxHashMap<(ViewId, ViewId, i64), Vec<ViewId>>;

/// The views of a character, followed by its stops.
#[derive(Debug)]
pub(super) struct Stops {
    /// The directions of both, and what lies between them.
    pub(super) turn: Turn,
    /// Of what each is mixed. A view is all its own.
    shares: TiVec<ViewId, Vec<Share>>,
    /// The views from behind.
    behind: Vec<ViewId>,
}

impl Stops {
    /// The stops of a character; none if all views show everything, or if with them the model would have more views than programs
    /// have to read. `behind` are the views from behind that nobody drew.
    pub(super) fn new(turn: &Turn, all_show_everything: bool, behind: Vec<ViewId>) -> Self {
        let only_views = Self {
            turn: turn.clone(),
            shares: turn.views.keys().map(|view| vec![(view, 1.0)]).collect(),
            behind,
        };
        if all_show_everything {
            return only_views;
        }
        let mut stops = Self {
            turn: Turn {
                views: turn.views.clone(),
                between: Vec::new(),
            },
            shares: only_views.shares.clone(),
            behind: only_views.behind.clone(),
        };
        let mut known = Known::default();
        for set in &turn.between {
            match (turn.corners(set), &set[..]) {
                (Some(corners), [a, b]) => {
                    let along = stops.along(&mut known, [(*a, corners[0]), (*b, corners[1])]);
                    let all: Vec<ViewId> = [*a].into_iter().chain(along).chain([*b]).collect();
                    let pairs = all.windows(2).map(<[ViewId]>::to_vec);
                    stops.turn.between.extend(pairs);
                }
                (Some(corners), [a, b, c]) => {
                    let corners = [(*a, corners[0]), (*b, corners[1]), (*c, corners[2])];
                    stops.divide(&mut known, corners);
                }
                _ => stops.turn.between.push(set.clone()),
            }
        }
        if stops.turn.views.len() > Turn::MOST_VIEWS {
            return only_views;
        }
        stops
    }

    /// The stops between two views, from the first to the second.
    fn along(
        &mut self,
        known: &mut Known,
        [(a, from), (b, to)]: [(ViewId, DVec2); 2],
    ) -> Vec<ViewId> {
        let angle = self.turn.views[b][0] - self.turn.views[a][0];
        let turns = ((to.x - from.x - angle) / 360.0).round() as i64;
        if let Some(found) = known.get(&(a, b, turns)) {
            return found.clone();
        }
        let [a_behind, b_behind] = [a, b].map(|view| self.behind.contains(&view));
        let near = if a_behind == b_behind {
            FADE / (to - from).length()
        } else {
            0.5
        };
        let places = if near < 0.5 {
            vec![near, 1.0 - near]
        } else {
            vec![0.5]
        };
        let stop = |share: f64| self.add(from.lerp(to, share), vec![(a, 1.0 - share), (b, share)]);
        let found: Vec<ViewId> = places.into_iter().map(stop).collect();
        known.insert((b, a, -turns), found.iter().rev().copied().collect());
        known.insert((a, b, turns), found.clone());
        found
    }

    /// Divides the triangle of three views: one triangle at each view, and those around a stop in the middle.
    fn divide(&mut self, known: &mut Known, corners: [(ViewId, DVec2); 3]) {
        let mut around: Vec<ViewId> = Vec::new();
        let mut sides = Vec::new();
        for side in 0..3 {
            let along = self.along(known, [corners[side], corners[(side + 1) % 3]]);
            around.extend(&along);
            sides.push(along);
        }
        let third = 1.0 / 3.0;
        let middle = corners.iter().map(|(_, at)| *at * third).sum();
        let middle = self.add(middle, corners.map(|(view, _)| (view, third)).to_vec());
        for (side, (view, _)) in corners.into_iter().enumerate() {
            if let (Some(next), Some(last)) = (sides[side].first(), sides[(side + 2) % 3].last()) {
                self.turn.between.push(vec![view, *next, *last]);
            }
        }
        let next = around.iter().cycle().skip(1);
        let pairs = around.iter().zip(next);
        let triangles = pairs.map(|(from, to)| vec![middle, *from, *to]);
        self.turn.between.extend(triangles);
    }

    fn add(&mut self, direction: DVec2, shares: Vec<Share>) -> ViewId {
        self.turn.views.push(direction.to_array());
        self.shares.push_and_get_key(shares)
    }

    /// What the width and the height of a region are multiplied by at each view and stop: it has an area if all views that a stop is
    /// mixed of show it. On the way to a view from behind only its width goes away, as that of a face which turns out of sight.
    pub(super) fn sizes(&self, is_shown: impl Fn(ViewId) -> bool) -> TiVec<ViewId, DVec2> {
        let size = |shares: &Vec<Share>| {
            let shown = shares.iter().filter(|(view, _)| is_shown(*view));
            let shown: Vec<f64> = shown.map(|(_, share)| *share).collect();
            let turns_away = shares.iter().any(|(view, _)| self.behind.contains(view));
            if shown.len() == shares.len() {
                DVec2::ONE
            } else if turns_away && !shown.is_empty() {
                // The other views have it as a point.
                DVec2::new(0.0, 1.0 / shown.iter().sum::<f64>())
            } else {
                DVec2::ZERO
            }
        };
        self.shares.iter().map(size).collect()
    }

    /// The places of a region at all views and stops from those in the views: where it would be without stops, as deep.
    pub(super) fn places(&self, in_views: &TiSlice<ViewId, DVec3>) -> TiVec<ViewId, DVec3> {
        let towards = |view: ViewId| view_axes(self.turn.views[view])[2];
        let place = |(at, shares): (ViewId, &Vec<Share>)| {
            if let [(view, _)] = shares[..] {
                return in_views[view];
            }
            let place = self.mixed(at, |view| in_views[view]);
            let depth = shares.iter();
            let depth = depth.map(|(view, share)| share * in_views[*view].dot(towards(*view)));
            let towards = towards(at);
            place + towards * (depth.sum::<f64>() - place.dot(towards))
        };
        self.shares.iter_enumerated().map(place).collect()
    }

    /// What a view or a stop has of what the views have.
    pub(super) fn mixed(&self, at: ViewId, of: impl Fn(ViewId) -> DVec3) -> DVec3 {
        let shares = self.shares[at].iter();
        shares.map(|(view, share)| of(*view) * *share).sum()
    }

    /// The stops on the way from one view to another, as shares of it in ascending order.
    pub(super) fn between(&self, from: ViewId, to: ViewId) -> Vec<f64> {
        let on_way = self.shares.iter().filter_map(|shares| match shares[..] {
            [(a, share), (b, _)] if (a, b) == (to, from) => Some(share),
            [(a, _), (b, share)] if (a, b) == (from, to) => Some(share),
            _ => None,
        });
        let mut all: Vec<f64> = on_way.collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::super::region::Direction;
    use super::super::tests::generated::random::Random;
    use super::super::turn::between;
    use super::*;

    /// Two to six views.
    fn turn(random: &mut Random) -> Turn {
        let count = 2 + random.below(5);
        let view = |_| Direction {
            theta: random.between(-85.0, 85.0),
            phi: random.between(-45.0, 60.0),
        };
        between(&(0..count).map(view).collect::<TiVec<_, _>>())
    }

    #[test]
    fn stops_change_neither_shapes_nor_where_they_are() {
        let mut farthest: f64 = 0.0;
        for seed in 0..200 {
            let mut random = Random::new(seed);
            let turn = turn(&mut random);
            let stops = Stops::new(&turn, false, Vec::new());
            let point =
                |random: &mut Random| DVec3::from([(); 3].map(|()| random.between(-0.5, 0.5)));
            let places = TiVec::from(vec![point(&mut random); turn.views.len()]);
            let with_stops = stops.places(&places);
            for _ in 0..50 {
                let direction = [random.between(-150.0, 150.0), random.between(-60.0, 80.0)];
                let plain = turn.weights(direction);
                let weights = stops.turn.weights(direction);
                let mut sums: TiVec<ViewId, f64> = vec![0.0; turn.views.len()].into();
                for (shares, weight) in stops.shares.iter().zip(&weights) {
                    for (view, share) in shares {
                        sums[*view] += share * weight;
                    }
                }
                for (sum, plain) in sums.iter().zip(&plain) {
                    assert!(
                        (sum - plain).abs() < 1e-6,
                        "seed {seed}: {sum} {plain} from {direction:?}"
                    );
                }
                let at = turn.position(&plain, &places);
                let moved = stops.turn.position(&weights, &with_stops) - at;
                assert!(moved.z.abs() < 1e-6, "seed {seed}: {moved}");
                farthest = farthest.max(moved.length());
            }
        }
        assert!(farthest < 0.1, "{farthest}");
    }

    #[test]
    fn views_have_no_weight_farther_away() {
        let mut near = 0;
        for seed in 0..200 {
            let mut random = Random::new(seed);
            let turn = turn(&mut random);
            let stops = Stops::new(&turn, false, Vec::new());
            for _ in 0..50 {
                let direction = [random.between(-150.0, 150.0), random.between(-60.0, 80.0)];
                let plain = turn.weights(direction);
                let views = turn.views.iter().zip(&plain);
                let at: DVec2 = views
                    .map(|(view, weight)| DVec2::from(*view) * *weight)
                    .sum();
                let weights = stops.turn.weights(direction);
                for (view, place) in turn.views.iter_enumerated() {
                    let distance = at.distance(DVec2::from(*place));
                    assert!(
                        distance <= FADE + 1e-6 || weights[view] < 1e-9,
                        "seed {seed}, {view:?} from {direction:?}: {weights:?}"
                    );
                    near += usize::from(weights[view] > 0.0);
                }
            }
        }
        assert!(near > 1000, "{near}");
    }
}
