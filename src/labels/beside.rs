//! Arms that lie beside the body without touching it, as those of paper dolls and simple robots do.

use glam::DVec2;

use super::figure::Drafts;
use super::part_tree::PartTree;
use super::{Class, FigurePartId};

/// How far from the body such an arm may be, as a share of the figure's height.
const GAP: f64 = 0.08;
/// It is at least this share of the figure's height long, and this much higher than wide.
const LENGTH: f64 = 0.1;
const SLENDER: f64 = 1.3;
/// Both are of one size within this share of the larger one, and begin at heights that differ by at most this share of the figure's height.
const ALIKE: f64 = 0.7;
const LEVEL: f64 = 0.08;

/// Makes arms of two loose parts of one size at both sides of the trunk, the nearest ones, if no other part is an arm.
pub(super) fn arms(tree: &PartTree<'_>, drafts: &mut Drafts, trunk: [DVec2; 2]) {
    if drafts.iter().any(|draft| draft.class == Some(Class::Arm)) {
        return;
    }
    let middle = trunk[0].midpoint(trunk[1]);
    let gap_of = |part: FigurePartId| {
        let [low, high] = tree.around(std::iter::once(part));
        (low.x - trunk[1].x).max(trunk[0].x - high.x)
    };
    let is_beside = |part: &FigurePartId| {
        let size = tree.size(*part);
        let [low, high] = tree.around(std::iter::once(*part));
        tree.loose[*part]
            && drafts[*part].class.is_none()
            && (0.0..=GAP * tree.height).contains(&gap_of(*part))
            && size.y >= LENGTH * tree.height
            && size.y >= SLENDER * size.x
            && high.y > middle.y
            && high.y <= trunk[1].y + LEVEL * tree.height
            && low.y > tree.above_ground(LEVEL)
    };
    let nearest = |is_left: bool| {
        let parts = tree.order.iter().copied().filter(is_beside);
        let here = parts.filter(|part| (tree.middle(*part).x < middle.x) == is_left);
        here.min_by(|a, b| gap_of(*a).total_cmp(&gap_of(*b)))
    };
    let (Some(left), Some(right)) = (nearest(true), nearest(false)) else {
        return;
    };
    let both = [left, right];
    let [one, other] = both.map(|part| tree.size(part));
    let [top, other_top] = both.map(|part| tree.around(std::iter::once(part))[1].y);
    let are_alike = one.min(other).cmpge(one.max(other) * ALIKE).all()
        && (top - other_top).abs() <= LEVEL * tree.height;
    for part in both.into_iter().filter(|_| are_alike) {
        let why = format!(
            "`{}` lies beside the body like another one at its other side, so it is an arm",
            tree.name(part)
        );
        drafts[part].detail = false;
        drafts[part].set(Class::Arm, why);
    }
}
