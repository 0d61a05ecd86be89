//! A figure that is performed with any track keeps the law of [`drawing`].

use okoshi::internals::mark_tracks::MarkTracks;

use super::{drawing, track};

/// A figure with two marks: performed as a whole, without effects in place of a camera, and from one mark at a moment.
const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200">
<rect x="40" y="40" width="20" height="50" id="body"/><text x="50" y="65" font-size="4">Body</text>
<rect x="42" y="18" width="16" height="21" id="head"/><text x="50" y="28" font-size="4">Head@Body</text>
<rect x="12" y="44" width="30" height="8" id="rarm"/><text x="27" y="48" font-size="4">Rarm@Body$Mark red</text>
<rect x="58" y="44" width="30" height="8" id="larm"/><text x="73" y="48" font-size="4">Larm@Body$Mark left-hand</text>
<rect x="40" y="91" width="8" height="54" id="rleg"/><text x="44" y="118" font-size="4">Rleg@Body</text>
<rect x="52" y="91" width="8" height="54" id="lleg"/><text x="56" y="118" font-size="4">Lleg@Body</text>
<text x="5" y="10" font-size="5">%Motion "walk.bvh" Perform "take.csv" Motion "walk.bvh" Perform -tec "take.csv"</text>
<text x="5" y="20" font-size="5">%Motion "walk.bvh" Perform -r "take.csv" red 30 8 Limited 2 12</text></svg>"##;

pub(super) fn check(bytes: &[u8]) -> bool {
    let resolver = drawing::linked().with("take.csv", bytes);
    drawing::check_compiled(DRAWING, &resolver);
    MarkTracks::from_bytes(bytes).is_ok()
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    track::seeds()
}
