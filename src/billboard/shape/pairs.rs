//! Which polygons and which holes of a region belong together in its views.

use glam::DVec2;

use crate::assignment::most_gainful;

/// Pairs that cost more are not the same polygon.
const MAX_COST: f64 = 1.2;
/// The cost of the distance between centres, relative to the boxes.
const DISTANCE: f64 = 2.0;
/// What a common feature point is worth.
const FEATURE: f64 = 10.0;
/// At most so many rings are paired in a view, the largest.
const MAX_RINGS: usize = 64;

/// A polygon or a hole.
#[derive(Debug, Clone, Default)]
pub(super) struct Item {
    /// Relative to the box of what it belongs to, from 0 to 1.
    pub(super) center: DVec2,
    /// Relative to the area of the box of what it belongs to.
    pub(super) area: f64,
    /// The feature points on it.
    pub(super) features: Vec<usize>,
}

/// Groups of items that belong together: for every group, the index of its item in each view, if it has one there. Every view
/// is paired with the first that has any.
pub(super) fn pair(views: &[Vec<Item>]) -> Vec<Vec<Option<usize>>> {
    let Some(reference) = views.iter().position(|items| !items.is_empty()) else {
        return Vec::new();
    };
    let mut groups: Vec<Vec<Option<usize>>> = (0..views[reference].len())
        .map(|item| {
            let mut group = vec![None; views.len()];
            group[reference] = Some(item);
            group
        })
        .collect();
    for view in reference + 1..views.len() {
        let partners = assign(&views[reference], &views[view]);
        for (item, partner) in partners.into_iter().enumerate() {
            if let Some(group) = partner.and_then(|partner| groups.get_mut(partner)) {
                group[view] = Some(item);
            } else {
                let mut group = vec![None; views.len()];
                group[view] = Some(item);
                groups.push(group);
            }
        }
    }
    groups
}

/// For every item of the second list, its partner in the first.
fn assign(a: &[Item], b: &[Item]) -> Vec<Option<usize>> {
    let mut partners = vec![None; b.len()];
    if a.len() == 1 && b.len() == 1 {
        partners[0] = Some(0);
        return partners;
    }
    let [large_a, large_b] = [a, b].map(largest);
    let gain =
        |row: usize, column: usize| Some(MAX_COST - cost(&a[large_a[row]], &b[large_b[column]]));
    let columns = most_gainful(large_a.len(), large_b.len(), gain);
    for (row, column) in columns.into_iter().enumerate() {
        if let Some(column) = column {
            partners[large_b[column]] = Some(large_a[row]);
        }
    }
    partners
}

fn cost(a: &Item, b: &Item) -> f64 {
    let mean = f64::midpoint(a.area, b.area);
    let size = if mean > 0.0 {
        (a.area - b.area).abs() / mean
    } else {
        0.0
    };
    let common = a.features.iter().filter(|f| b.features.contains(f)).count();
    let cost = DISTANCE * a.center.distance(b.center) + size - FEATURE * common as f64;
    if cost.is_finite() { cost } else { MAX_COST }
}

fn largest(items: &[Item]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..items.len()).collect();
    order.sort_by(|a, b| items[*b].area.total_cmp(&items[*a].area));
    order.truncate(MAX_RINGS);
    order
}
