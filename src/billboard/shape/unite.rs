//! The same points on a contour in all views.

use glam::DVec2;

use super::contour::{Contour, Ends};
use super::correspondence::correspond;

/// Vertices of two contours whose places differ by less are one point.
const SAME_PLACE: f64 = 1e-7;

/// The vertices of all contours, carried to the others through the maps between the first one and each. `cuts` are the places
/// of points that belong together, one per view, in the order of all views. In views without a contour all points are at the
/// view's spot.
pub(super) fn unite(
    contours: &[Option<Contour>],
    cuts: &[Vec<f64>],
    spots: &[DVec2],
) -> Vec<Vec<DVec2>> {
    let drawn = |view: usize| contours[view].as_ref().map(|contour| (view, contour));
    let Some((home, first)) = (0..contours.len()).find_map(drawn) else {
        return spots.iter().map(|spot| vec![*spot; 3]).collect();
    };
    let maps: Vec<_> = (contours.iter().enumerate())
        .map(|(view, contour)| {
            let contour = contour.as_ref().filter(|_| view != home)?;
            let cuts: Vec<[f64; 2]> = cuts.iter().map(|cut| [cut[home], cut[view]]).collect();
            Some(correspond(first, contour, &cuts))
        })
        .collect();

    let mut places = first.vertices().to_vec();
    for (contour, map) in contours.iter().zip(&maps) {
        if let (Some(contour), Some(map)) = (contour, map) {
            places.extend(contour.vertices().iter().map(|place| map.back(*place)));
        }
    }
    places.extend(cuts.iter().map(|cut| cut[home]));
    places.sort_by(f64::total_cmp);
    places.dedup_by(|b, a| *b - *a < SAME_PLACE);
    if first.ends == Ends::Joined
        && let [start, .., end] = places[..]
        && start + 1.0 - end < SAME_PLACE
    {
        places.pop();
    }

    let each = contours.iter().zip(&maps).zip(spots);
    each.map(|((contour, map), spot)| match (contour, map) {
        (Some(contour), Some(map)) => {
            let at = |place: &f64| contour.point(map.forth(*place));
            places.iter().map(at).collect()
        }
        (Some(contour), None) => places.iter().map(|place| contour.point(*place)).collect(),
        (None, _) => vec![*spot; places.len()],
    })
    .collect()
}
