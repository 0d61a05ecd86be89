//! Bounding boxes in spatial indices.

use std::sync::OnceLock;

use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A bounding box, with the index of what is in it.
pub(crate) type IndexedBox<I> = GeomWithData<Rectangle<[f64; 2]>, I>;

/// A spatial index of bounding boxes.
pub(crate) type BoxTree<I> = RTree<IndexedBox<I>>;

/// The bounding box from `low` to `high`, with an index.
pub(crate) fn indexed_box<I>((low, high): (DVec2, DVec2), index: I) -> IndexedBox<I> {
    let corners = Rectangle::from_corners(low.to_array(), high.to_array());
    GeomWithData::new(corners, index)
}

/// The area up to `reach` around the box from `low` to `high`, for questions to a [`BoxTree`].
pub(crate) fn area_around((low, high): (DVec2, DVec2), reach: f64) -> AABB<[f64; 2]> {
    AABB::from_corners((low - reach).to_array(), (high + reach).to_array())
}

/// Where more boxes than this meet, those that are last in the order are looked for first.
const FEW: usize = 64;

/// A box whose third coordinate is its place in an order.
type OrderedBox = GeomWithData<Rectangle<[f64; 3]>, usize>;

/// Bounding boxes in an order, to find those that are before a place in it.
#[derive(Debug)]
pub(crate) struct OrderedBoxes {
    boxes: Vec<(usize, (DVec2, DVec2))>,
    tree: BoxTree<usize>,
    /// Needed only where many boxes meet.
    ordered: OnceLock<RTree<OrderedBox>>,
}

impl OrderedBoxes {
    /// Boxes from their lower to their higher corners, each with its place in the order.
    pub(crate) fn new(boxes: impl Iterator<Item = (usize, (DVec2, DVec2))>) -> Self {
        let boxes: Vec<_> = boxes.collect();
        let indexed = boxes.iter();
        let indexed = indexed.map(|(place, corners)| indexed_box(*corners, *place));
        Self {
            tree: BoxTree::bulk_load(indexed.collect()),
            boxes,
            ordered: OnceLock::new(),
        }
    }

    /// The places of those that meet an area, in any order.
    pub(crate) fn meeting(&self, area: (DVec2, DVec2)) -> impl Iterator<Item = usize> {
        let found = self
            .tree
            .locate_in_envelope_intersecting(area_around(area, 0.0));
        found.map(|found| found.data)
    }

    /// Calls `each` with the places before `place` of those that meet an area, the last first, until it returns `false` or has been
    /// called `most` times. The time grows with the number of calls and little with that of the boxes that meet there.
    pub(crate) fn before(
        &self,
        place: usize,
        area: (DVec2, DVec2),
        most: usize,
        mut each: impl FnMut(usize) -> bool,
    ) {
        let near: Vec<usize> = self.meeting(area).take(FEW + 1).collect();
        let mut left = most;
        let mut visit = |mut near: Vec<usize>| {
            near.sort_unstable_by(|a, b| b.cmp(a));
            near.truncate(left);
            left -= near.len();
            near.into_iter().all(&mut each) && left > 0
        };
        if near.len() <= FEW {
            visit(near.into_iter().filter(|near| *near < place).collect());
            return;
        }
        // The pieces of the order grow, as of many boxes enough are usually in the first one.
        let (mut end, mut length) = (place, FEW);
        while end > 0 {
            let start = end.saturating_sub(length);
            let [low, high] = in_order(area, [start, end - 1]);
            let area = AABB::from_corners(low, high);
            let near = self.ordered().locate_in_envelope_intersecting(area);
            if !visit(near.map(|near| near.data).collect()) {
                return;
            }
            (end, length) = (start, 2 * length);
        }
    }

    fn ordered(&self) -> &RTree<OrderedBox> {
        self.ordered.get_or_init(|| {
            let boxes = self.boxes.iter().map(|(place, corners)| {
                let [low, high] = in_order(*corners, [*place; 2]);
                GeomWithData::new(Rectangle::from_corners(low, high), *place)
            });
            RTree::bulk_load(boxes.collect())
        })
    }
}

/// The corners of a box from the first to the last of these places in the order.
fn in_order((low, high): (DVec2, DVec2), [first, last]: [usize; 2]) -> [[f64; 3]; 2] {
    [[low.x, low.y, first as f64], [high.x, high.y, last as f64]]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

        #[test]
        fn boxes_before_another_are_found_the_last_first(
            places in prop::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.01..0.3f64), 1..1500),
            spread in 0.2..20.0f64, most in 1..400usize,
        ) {
            let corners = |(x, y, size): &(f64, f64, f64)| {
                let low = DVec2::new(*x, *y) * spread;
                (low, low + *size)
            };
            let boxes: Vec<(DVec2, DVec2)> = places.iter().map(corners).collect();
            let ordered = OrderedBoxes::new(boxes.iter().copied().enumerate());
            for index in (0..boxes.len()).rev().step_by(97) {
                let (low, high) = boxes[index];
                let meets = |other: &usize| {
                    let (other_low, other_high) = boxes[*other];
                    low.cmple(other_high).all() && other_low.cmple(high).all()
                };
                let expected: Vec<usize> = (0..index).rev().filter(meets).take(most).collect();
                let mut found = Vec::new();
                ordered.before(index, boxes[index], most, |other| { found.push(other); true });
                prop_assert_eq!(&found, &expected);
                found.clear();
                ordered.before(index, boxes[index], most, |other| { found.push(other); found.len() < 3 });
                prop_assert_eq!(&found[..], &expected[..expected.len().min(3)]);
            }
        }
    }
}
