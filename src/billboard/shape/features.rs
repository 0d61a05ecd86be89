//! Feature points: places of a contour that a name ties together in all views (thesis, 4.2.5).

use glam::DVec2;

use super::contour::Contour;

/// More feature points than this are not looked at.
const MAX_FEATURES: usize = 256;

/// The feature points that are named in all views: for each, its point in every view. Of points with the same name in a view
/// the first counts.
pub(super) fn common(features: &[Vec<(String, DVec2)>]) -> Vec<Vec<DVec2>> {
    let Some((first, others)) = features.split_first() else {
        return Vec::new();
    };
    let mut common: Vec<Vec<DVec2>> = Vec::new();
    for (index, (name, point)) in first.iter().take(MAX_FEATURES).enumerate() {
        if first[..index].iter().any(|(other, _)| other == name) {
            continue;
        }
        let in_view = |view: &Vec<(String, DVec2)>| {
            let found = view.iter().find(|(other, _)| other == name);
            found.map(|(_, point)| *point)
        };
        let points: Option<Vec<DVec2>> = others.iter().map(in_view).collect();
        if let Some(points) = points {
            let points = [&[*point], &points[..]].concat();
            if points.iter().all(|p| p.is_finite()) {
                common.push(points);
            }
        }
    }
    common
}

/// The places of feature points on a ring's contours, one row for each point: the longest choice that has the same order in all
/// views, beginning with the first point in that order.
pub(super) fn cuts(contours: &[Option<Contour>], points: &[&Vec<DVec2>]) -> Vec<Vec<f64>> {
    let mut places: Vec<Vec<f64>> = (points.iter())
        .map(|point| {
            let each = contours.iter().zip(*point);
            each.map(|(contour, p)| contour.as_ref().map_or(0.0, |c| c.nearest(*p).0))
                .collect()
        })
        .collect();
    let Some(first) = places.first().cloned() else {
        return places;
    };
    let is_used: Vec<bool> = contours.iter().map(Option::is_some).collect();
    // Counted from the first point on, so that the order is one from 0 to 1.
    let after = |place: &Vec<f64>| -> Vec<f64> {
        let each = place.iter().zip(&first);
        each.map(|(place, first)| (place - first).rem_euclid(1.0))
            .collect()
    };
    let mut others: Vec<(Vec<f64>, Vec<f64>)> = places
        .drain(1..)
        .map(|place| (after(&place), place))
        .collect();
    let key = is_used.iter().position(|used| *used).unwrap_or(0);
    others.sort_by(|a, b| a.0[key].total_cmp(&b.0[key]));
    let precedes = |a: &[f64], b: &[f64]| {
        let mut each = a.iter().zip(b).zip(&is_used);
        each.all(|((a, b), used)| !used || b - a > 1e-6)
    };
    let start = vec![0.0; first.len()];
    let mut chains: Vec<(usize, Option<usize>)> = Vec::new();
    for (place, _) in &others {
        let mut chain = (0, None);
        if precedes(&start, place) {
            chain.0 = 1;
            for (before, other) in chains.iter().enumerate() {
                if other.0 > 0 && precedes(&others[before].0, place) && other.0 + 1 > chain.0 {
                    chain = (other.0 + 1, Some(before));
                }
            }
        }
        chains.push(chain);
    }
    let mut longest: Option<usize> = None;
    for (index, chain) in chains.iter().enumerate() {
        if chain.0 > longest.map_or(0, |longest| chains[longest].0) {
            longest = Some(index);
        }
    }
    let mut kept = Vec::new();
    while let Some(index) = longest {
        kept.push(others[index].1.clone());
        longest = chains[index].1;
    }
    kept.push(first);
    kept.reverse();
    kept
}
