//! Vehicles: what stands on wheels by their names.

use glam::DVec2;

use super::figure::Drafts;
use super::part_tree::PartTree;
use super::{Class, FigurePartId};
use crate::anatomy::{self, Thing};

type Bounds = [DVec2; 2];

/// A wheel that is seen from its side is at most this much longer than wide.
const ROUND: f64 = 1.4;
/// A wheel stands at most this share of the figure's height above its ground.
const LOW: f64 = 0.2;
/// A wheel is at least this share of the largest one high.
const ALIKE: f64 = 0.4;
/// Two boxes that share this much of the narrower one's width are the same wheel, such as tyre and rim.
const SAME: f64 = 0.5;
/// From the first wheel to the last is at least this share of the vehicle's width.
const ROW: f64 = 0.4;
/// A vehicle in profile, with its rider, is at least this much as wide as high.
const WIDE: f64 = 0.6;
/// The most wheels that touch each other in one piece, and how far such a piece may be from as many times as wide as high.
const MOST_TOUCHING: f64 = 8.0;
const TOUCHING: f64 = 0.1;
/// The most wheels that are looked at.
const MAX_WHEELS: usize = 64;

/// The round wheels in a row at the bottom of a wide figure, which show it from its side, from left to right. Empty if there are
/// fewer than two.
pub(super) fn wheels(tree: &PartTree<'_>) -> Vec<Bounds> {
    let is_wheel = |name: &str| anatomy::thing(name) == Some(Thing::Wheel);
    let parts = tree.parts.iter_enumerated();
    let own = parts.clone().filter(|(_, part)| is_wheel(&part.name));
    let own = own.flat_map(|(index, _)| boxes(tree, index));
    let details = parts.flat_map(|(_, part)| &part.details);
    let details = details.filter(|detail| is_wheel(&detail.name));
    let details = details.flat_map(|detail| detail.boxes().to_vec());
    let found = own.chain(details).flat_map(side_by_side);
    let found: Vec<Bounds> = found.take(MAX_WHEELS).collect();
    if found.len() < 2 {
        return Vec::new();
    }
    let size = |[low, high]: &Bounds| *high - *low;
    let highest = found.iter().map(|wheel| size(wheel).y).fold(0.0, f64::max);
    let stands = |wheel: &Bounds| {
        let own = size(wheel);
        own.min_element() > 0.0
            && own.max_element() <= ROUND * own.min_element()
            && own.y >= ALIKE * highest
            && wheel[0].y <= tree.above_ground(LOW)
    };
    let mut row: Vec<Bounds> = found.into_iter().filter(stands).collect();
    row.sort_by(|a, b| (a[0].x + a[1].x).total_cmp(&(b[0].x + b[1].x)));
    row.dedup_by(|next, before| {
        let shared = next[1].x.min(before[1].x) - next[0].x.max(before[0].x);
        shared >= SAME * size(next).x.min(size(before).x)
    });
    let [low, high] = tree.around(tree.parts.keys());
    let whole = high - low;
    match row.as_slice() {
        [first, .., last]
            if last[0].x + last[1].x > 2.0 * first[1].x
                && last[1].x - first[0].x >= ROW * whole.x
                && whole.x >= WIDE * whole.y =>
        {
            row
        }
        _ => Vec::new(),
    }
}

/// The boxes of wheels that touch each other in one piece.
fn side_by_side([low, high]: Bounds) -> Vec<Bounds> {
    let size = high - low;
    let count = (size.x / size.y).round();
    let is_row = (2.0..=MOST_TOUCHING).contains(&count)
        && (size.x / size.y - count).abs() <= TOUCHING * count;
    if !is_row {
        return vec![[low, high]];
    }
    let step = size.x / count;
    let wheel = |place: usize| {
        let from = low.x + step * place as f64;
        [DVec2::new(from, low.y), DVec2::new(from + step, high.y)]
    };
    (0..count as usize).map(wheel).collect()
}

/// The bounding boxes of a part: those of the pieces of its main shape, if that has several.
pub(super) fn boxes(tree: &PartTree<'_>, part: FigurePartId) -> Vec<Bounds> {
    let drawn = &tree.parts[part];
    let [low, high] = drawn.main_shape;
    match drawn.pieces.as_slice() {
        [] if high.x > low.x => vec![drawn.main_shape],
        [] => vec![drawn.bounds],
        pieces => pieces.to_vec(),
    }
}

/// Whether a figure is a vehicle without a name of a head or of a limb: none of its parts is one.
pub(super) fn is_alone(tree: &PartTree<'_>, drafts: &Drafts) -> bool {
    is_lifeless(drafts) && !wheels(tree).is_empty()
}

/// Whether no part of a figure has a name of a head or of a limb.
pub(super) fn is_lifeless(drafts: &Drafts) -> bool {
    let is_alive = |class: Option<Class>| {
        class.is_some_and(|class| class.is_limb() || matches!(class, Class::Head | Class::Neck))
    };
    !drafts
        .iter()
        .any(|draft| draft.named && is_alive(draft.class))
}
