//! Bounding boxes in spatial indices.

use glam::DVec2;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A bounding box, with the index of what is in it.
pub(crate) type IndexedBox = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// A spatial index of bounding boxes.
pub(crate) type BoxTree = RTree<IndexedBox>;

/// The bounding box from `low` to `high`, with an index.
pub(crate) fn indexed_box((low, high): (DVec2, DVec2), index: usize) -> IndexedBox {
    let corners = Rectangle::from_corners(low.to_array(), high.to_array());
    GeomWithData::new(corners, index)
}

/// The area up to `reach` around the box from `low` to `high`, for questions to a [`BoxTree`].
pub(crate) fn area_around((low, high): (DVec2, DVec2), reach: f64) -> AABB<[f64; 2]> {
    AABB::from_corners((low - reach).to_array(), (high + reach).to_array())
}
