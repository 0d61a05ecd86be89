//! What lies between the views of a character.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::region::Direction;
use crate::scene::{Turn, ViewId};

/// More views than this are joined in their order only.
const MOST_TRIANGULATED: usize = 32;
/// Views that are farther apart have nothing between them in which to turn, degrees: there are two ways from one to the other.
const MOST_GAP: f64 = 179.0;

/// The views, and the sets between which their weights are linear: the Delaunay triangles of (theta, phi), or the neighbours
/// along a line. Views that go around the character are joined all around.
pub(super) fn between(views: &TiSlice<ViewId, Direction>) -> Turn {
    let directions: TiVec<ViewId, [f64; 2]> =
        views.iter().map(|view| [view.theta, view.phi]).collect();
    let count = views.len();
    let mut places: Vec<DVec2> = directions.iter().copied().map(DVec2::from).collect();
    if count <= MOST_TRIANGULATED && goes_around(places.iter().map(|place| place.x)) {
        for turn in [360.0, -360.0] {
            let copies = directions.iter().copied().map(DVec2::from);
            places.extend(copies.map(|place| place + DVec2::new(turn, 0.0)));
        }
    }
    let mut between = Vec::new();
    if count <= MOST_TRIANGULATED {
        for i in 0..count {
            for j in i + 1..places.len() {
                for k in j + 1..places.len() {
                    if is_delaunay(&places, [i, j, k]) {
                        between.push(vec![i, j, k]);
                    }
                }
            }
        }
    }
    if between.is_empty() {
        // All on a line: neighbours along it.
        let mut order: Vec<usize> = (0..places.len()).collect();
        if count <= MOST_TRIANGULATED {
            order.sort_by(|a, b| {
                let key = |i: &usize| (places[*i].x, places[*i].y);
                key(a)
                    .partial_cmp(&key(b))
                    .unwrap_or(std::cmp::Ordering::Equal)
            });
        }
        between.extend(order.windows(2).map(<[usize]>::to_vec));
    }
    // Of a triangle through which the short ways do not go, those sides are left along which they do.
    let (wide, mut between): (Vec<_>, Vec<_>) =
        (between.into_iter()).partition(|set| set.len() == 3 && is_wide(&places, set));
    let sides = wide.iter().flat_map(|set| {
        let [a, b, c] = [set[0], set[1], set[2]];
        [vec![a, b], vec![b, c], vec![a, c]]
    });
    between.extend(sides.filter(|side| !is_wide(&places, side)));
    let mut sets: Vec<Vec<ViewId>> = Vec::new();
    for set in between {
        let is_copy = set.iter().all(|place| *place >= count);
        let set: Vec<ViewId> = set.iter().map(|place| (place % count).into()).collect();
        let of_same = |known: &Vec<ViewId>| set.iter().all(|view| known.contains(view));
        let is_flat = set
            .iter()
            .enumerate()
            .any(|(at, view)| set[..at].contains(view));
        if !is_copy && !is_flat && !sets.iter().any(of_same) {
            sets.push(set);
        }
    }
    for view in directions.keys() {
        if !sets.iter().any(|set| set.contains(&view)) {
            sets.push(vec![view]);
        }
    }
    Turn {
        views: directions,
        between: sets,
    }
}

/// Whether two of the places are so far apart that the short way between them is another one.
fn is_wide(places: &[DVec2], set: &[usize]) -> bool {
    let around = || set.iter().map(|place| places[*place].x);
    let (least, greatest) = (
        around().fold(f64::INFINITY, f64::min),
        around().fold(f64::NEG_INFINITY, f64::max),
    );
    greatest - least >= MOST_GAP
}

/// Whether neighbouring views at these angles around the upright axis are less than half a turn apart all around.
pub(super) fn goes_around(angles: impl Iterator<Item = f64>) -> bool {
    let mut around: Vec<f64> = angles.map(|angle| angle.rem_euclid(360.0)).collect();
    around.sort_by(f64::total_cmp);
    let first = around.first().map(|first| first + 360.0);
    let next = around.iter().copied().skip(1).chain(first);
    let mut gaps = around.iter().zip(next).map(|(from, to)| to - from);
    gaps.all(|gap| gap < MOST_GAP)
}

/// Whether no place is in the circle through three of them. Of places on a common circle, those with the smallest numbers win.
fn is_delaunay(places: &[DVec2], corners: [usize; 3]) -> bool {
    let [a, b, c] = corners.map(|i| places[i]);
    let area = (b - a).perp_dot(c - a);
    let size = (b - a).length_squared().max((c - a).length_squared());
    if area.abs() <= 1e-9 * size {
        return false;
    }
    let (b, c) = if area > 0.0 { (b, c) } else { (c, b) };
    let lifted = |i: usize, p: DVec2| p.length_squared() + 1e-4 * ((i + 1) * (i + 1)) as f64;
    let height = |i: usize| lifted(i, places[i]);
    let [ia, ib, ic] = if area > 0.0 {
        corners
    } else {
        [corners[0], corners[2], corners[1]]
    };
    places.iter().enumerate().all(|(i, p)| {
        if corners.contains(&i) {
            return true;
        }
        // The lower hull of the places on a paraboloid, slightly uneven so that no four are on one plane.
        let rows = [(ia, a), (ib, b), (ic, c)].map(|(j, q)| (q - *p, height(j) - height(i)));
        let [(u, hu), (v, hv), (w, hw)] = rows;
        u.perp_dot(v) * hw + v.perp_dot(w) * hu + w.perp_dot(u) * hv <= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets(views: &[(f64, f64)]) -> Vec<Vec<usize>> {
        let views = views.iter().map(|(theta, phi)| Direction {
            theta: *theta,
            phi: *phi,
        });
        let sets = between(&views.collect::<TiVec<_, _>>()).between.into_iter();
        sets.map(|set| set.into_iter().map(usize::from).collect())
            .collect()
    }

    #[test]
    fn views_on_a_line_are_joined_in_order() {
        assert_eq!(sets(&[(0.0, 0.0), (45.0, 0.0)]), [[0, 1]]);
        assert_eq!(
            sets(&[(45.0, 0.0), (-45.0, 0.0), (0.0, 0.0)]),
            [[1, 2], [2, 0]]
        );
    }

    #[test]
    fn views_all_around_are_joined_in_a_ring() {
        let ring = [(0.0, 0.0), (45.0, 0.0), (-45.0, 0.0), (180.0, 0.0)];
        let mut found = sets(&ring);
        for set in &mut found {
            set.sort_unstable();
        }
        found.sort();
        assert_eq!(found, [[0, 1], [0, 2], [1, 3], [2, 3]]);
        // A half turn may go both ways.
        assert_eq!(
            sets(&[(0.0, 0.0), (90.0, 0.0), (180.0, 0.0)]),
            [[0, 1], [1, 2]]
        );
        // From above as well: every direction up to there is in one triangle.
        let ring = [
            (0.0, 0.0),
            (120.0, 0.0),
            (240.0, 0.0),
            (0.0, 30.0),
            (120.0, 30.0),
            (240.0, 30.0),
        ];
        let turn = between(
            &ring
                .map(|(theta, phi)| Direction { theta, phi })
                .into_iter()
                .collect::<TiVec<_, _>>(),
        );
        for theta in (0..360).step_by(5) {
            let theta = f64::from(theta);
            let weights = turn.weights([theta, 1.0]);
            let around: f64 = (turn.views.iter().zip(&weights))
                .map(|(view, weight)| {
                    let way = (view[0] - theta + 180.0).rem_euclid(360.0) - 180.0;
                    way * weight
                })
                .sum();
            assert!(around.abs() < 1e-6, "{theta}: {weights:?}");
        }
    }

    #[test]
    fn no_triangle_is_so_wide_that_short_ways_leave_it() {
        // Over the front from the one to the other it is more than half of the way around: the short way is behind.
        assert_eq!(
            sets(&[(-100.0, 0.0), (100.0, 0.0), (0.0, 30.0)]),
            [[1, 2], [0, 2], [0, 1]]
        );
        let around = [
            (0.0, 0.0),
            (45.0, 0.0),
            (0.0, 30.0),
            (-45.0, 0.0),
            (180.0, 0.0),
            (-135.0, 0.0),
            (180.0, -30.0),
            (135.0, 0.0),
        ];
        for set in sets(&around) {
            let from = around[set[0]].0;
            let ways = set
                .iter()
                .map(|view| (around[*view].0 - from + 540.0) % 360.0 - 180.0);
            let [least, greatest] = [f64::min, f64::max].map(|f| ways.clone().fold(0.0, f));
            assert!(greatest - least < MOST_GAP, "{set:?}");
        }
        // None is lost.
        let alone = sets(&[(0.0, 0.0), (0.0, 30.0), (180.0, 0.0)]);
        assert_eq!(alone, [vec![0, 1], vec![2]]);
    }

    #[test]
    fn views_around_a_place_are_triangulated() {
        assert_eq!(sets(&[(0.0, 0.0), (45.0, 0.0), (0.0, 30.0)]), [[0, 1, 2]]);
        // Two triangles of a square and four of a square with its middle, which cover it once.
        let square = [(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)];
        let with_middle = [&square[..], &[(20.0, 20.0)]].concat();
        for (views, count) in [(&square[..], 2), (&with_middle, 4)] {
            let sets = sets(views);
            assert_eq!(sets.len(), count, "{sets:?}");
            let place = |view: usize| DVec2::from(views[view]);
            let area = |set: &Vec<usize>| {
                let [a, b, c] = [0, 1, 2].map(|i| place(set[i]));
                (b - a).perp_dot(c - a).abs() / 2.0
            };
            let covered: f64 = sets.iter().map(area).sum();
            assert!((covered - 1600.0).abs() < 1e-9, "{covered}");
        }
    }
}
