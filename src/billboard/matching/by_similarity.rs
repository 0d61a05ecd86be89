//! The thesis' own method, to compare with.

use typed_index_collections::TiVec;

use super::cost::{Features, Turn, features};
use crate::billboard::place::Frame;
use crate::billboard::region::{RegionId, View};

/// For each region of the first view, the region of the second that is most similar by equations 4.1 and 4.2. Several may get
/// the same; `None` where no colour fits.
pub(in crate::billboard) fn most_similar(
    views: [&View; 2],
    frames: [&Frame; 2],
) -> TiVec<RegionId, Option<RegionId>> {
    let turn = Turn::new(views[0].direction, views[1].direction);
    let [first, second] = [0, 1].map(|i| features(views[i], frames[i]));
    let best = |a: &Features| {
        let similar = second.iter_enumerated();
        let similar = similar.map(|(id, b)| (id, turn.similarity(a, b)));
        let similar = similar.filter(|(_, s)| *s > 0.0);
        // The first of equals.
        similar.reduce(|best, s| if s.1 > best.1 { s } else { best })
    };
    first.iter().map(|a| best(a).map(|(i, _)| i)).collect()
}
