//! What lies between the views of a character.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::region::Direction;
use crate::scene::{Turn, ViewId};

/// More views than this are joined in their order only.
const MOST_TRIANGULATED: usize = 32;

/// The views, and the sets between which their weights are linear: the Delaunay triangles of (theta, phi), or the neighbours
/// along a line.
pub(super) fn between(views: &TiSlice<ViewId, Direction>) -> Turn {
    let directions: TiVec<ViewId, [f64; 2]> =
        views.iter().map(|view| [view.theta, view.phi]).collect();
    let places: Vec<DVec2> = directions.iter().copied().map(DVec2::from).collect();
    let count = places.len();
    let mut between = Vec::new();
    if count <= MOST_TRIANGULATED {
        for i in 0..count {
            for j in i + 1..count {
                for k in j + 1..count {
                    if is_delaunay(&places, [i, j, k]) {
                        between.push([i, j, k].map(ViewId::from).to_vec());
                    }
                }
            }
        }
    }
    if between.is_empty() {
        // All on a line: neighbours along it.
        let mut order: Vec<usize> = (0..count).collect();
        if count <= MOST_TRIANGULATED {
            order.sort_by(|a, b| {
                let key = |i: &usize| (places[*i].x, places[*i].y);
                key(a)
                    .partial_cmp(&key(b))
                    .unwrap_or(std::cmp::Ordering::Equal)
            });
        }
        let neighbors = order.windows(2);
        between.extend(neighbors.map(|pair| pair.iter().copied().map(ViewId::from).collect()));
    }
    Turn {
        views: directions,
        between,
    }
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
