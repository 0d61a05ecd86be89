//! Sides and pairs of a figure's limbs, by where they are drawn.

use glam::DVec2;
use typed_index_collections::ti_vec;

use super::figure::{Drafts, PartDraft, is_trunk};
use super::part_tree::PartTree;
use super::segments::Limb;
use super::{Class, Facing, FigurePartId, Side};
use crate::anatomy::Term;

/// Two legs in profile whose joints are at most this share of the trunk's width apart are a pair.
const SAME_PAIR: f64 = 0.25;

/// The direction that a figure faces, and the middle of its trunk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Front {
    /// Towards the viewer, or away.
    Viewer {
        /// The middle of its trunk.
        axis: DVec2,
        /// −1 if its head is drawn below the trunk, as that of a spider that hangs, else 1.
        up: f64,
        /// Whether the viewer sees its back, so that its left is drawn left.
        is_away: bool,
        /// Whether the viewer sees it from above.
        is_from_above: bool,
    },
    /// To one side of the drawing.
    Beside {
        /// The middle of its trunk.
        axis: DVec2,
        /// The width of its trunk.
        length: f64,
        /// −1 for the drawing's left, 1 for its right.
        toward: f64,
    },
}

impl Front {
    /// The front of a figure that faces in a direction.
    pub(super) fn of(tree: &PartTree<'_>, drafts: &Drafts, facing: Facing) -> Self {
        let all = |wanted: &dyn Fn(&PartDraft) -> bool| {
            let parts = tree
                .order
                .iter()
                .copied()
                .filter(|part| wanted(&drafts[*part]));
            tree.around(parts)
        };
        let [low, high] = all(&|draft| is_trunk(draft.class));
        let axis = low.midpoint(high);
        let beside = |toward| Self::Beside {
            axis,
            length: high.x - low.x,
            toward,
        };
        match facing {
            Facing::Left => beside(-1.0),
            Facing::Right => beside(1.0),
            Facing::Viewer | Facing::Away | Facing::Up | Facing::UpHeadDown => {
                let is_head = |draft: &PartDraft| draft.class == Some(Class::Head);
                let has_trunk = drafts.iter().any(|draft| is_trunk(draft.class));
                let known = has_trunk && drafts.iter().any(is_head);
                let is_below = known && all(&is_head)[1].y < axis.y;
                Self::Viewer {
                    axis,
                    up: if is_below { -1.0 } else { 1.0 },
                    is_away: matches!(facing, Facing::Away | Facing::Up),
                    is_from_above: facing.is_from_above(),
                }
            }
        }
    }

    /// The position of a limb along the way from the figure's hind end to its head.
    fn place_of(self, tree: &PartTree<'_>, part: FigurePartId) -> f64 {
        match self {
            Self::Viewer { up, .. } => tree.joint(part).y * up,
            Self::Beside { toward, .. } => tree.joint(part).x * toward,
        }
    }
}

/// What a limb's name says about its place between hind end and head.
fn rank(draft: &PartDraft) -> u8 {
    if draft.says(&[Term::Hind, Term::Back]) {
        0
    } else if draft.says(&[Term::Fore]) {
        2
    } else {
        1
    }
}

fn sorted_from_hind(
    tree: &PartTree<'_>,
    facing: &Front,
    drafts: &Drafts,
    roots: &mut [FigurePartId],
) {
    roots.sort_by(|a, b| {
        let place = |part: FigurePartId| facing.place_of(tree, part);
        rank(&drafts[*a])
            .cmp(&rank(&drafts[*b]))
            .then(place(*a).total_cmp(&place(*b)))
            .then(a.cmp(b))
    });
}

/// Sets the sides of limbs: by the name of one of their parts, else by place.
pub(super) fn sides(tree: &PartTree<'_>, facing: &Front, limbs: &[Limb], drafts: &mut Drafts) {
    for class in [Class::Arm, Class::Leg] {
        let limbs: Vec<&Limb> = limbs.iter().filter(|limb| limb.class == class).collect();
        let mut open = Vec::new();
        for limb in &limbs {
            let named = limb.parts.iter().find_map(|(part, _)| drafts[*part].side);
            match named {
                Some(side) => {
                    let why = if drafts[limb.root()].named {
                        format!(", and its side is {}", side.name())
                    } else {
                        format!("; it is the {} one by its name", side.name())
                    };
                    give(drafts, limb, side, &why);
                }
                None => open.push(*limb),
            }
        }
        let others: Vec<Side> = limbs
            .iter()
            .filter_map(|limb| drafts[limb.root()].side)
            .collect();
        match (open.as_slice(), others.as_slice(), facing) {
            ([limb], [side], _) => {
                let side = side.other();
                give(
                    drafts,
                    limb,
                    side,
                    &format!(
                        "; the other one is the {}, so it is the {}",
                        side.other().name(),
                        side.name()
                    ),
                );
            }
            (
                _,
                _,
                Front::Viewer {
                    axis,
                    is_away,
                    is_from_above,
                    ..
                },
            ) => {
                let since = match (is_away, is_from_above) {
                    (_, true) => "is seen from above",
                    (true, _) => "turns its back to us",
                    (false, _) => "faces us",
                };
                from_front(tree, axis.x, (*is_away, since), &open, drafts);
            }
            (_, _, Front::Beside { toward, length, .. }) => {
                from_side(tree, facing, [*toward, *length], &open, drafts);
            }
        }
    }
}

fn give(drafts: &mut Drafts, limb: &Limb, side: Side, why: &str) {
    for (part, _) in &limb.parts {
        drafts[*part].side = Some(side);
        drafts[*part].why[1] = why.to_owned();
    }
}

/// The drawn left is the figure's right, unless it is seen from behind. Of two limbs the further left one, wherever the middle of the trunk is.
fn from_front(
    tree: &PartTree<'_>,
    axis: f64,
    (is_away, since): (bool, &str),
    open: &[&Limb],
    drafts: &mut Drafts,
) {
    let place = |limb: &Limb| tree.joint(limb.root()).midpoint(tree.tip(limb.root())).x;
    let axis = match open {
        [a, b] if place(a) != place(b) => f64::midpoint(place(a), place(b)),
        _ => axis,
    };
    for limb in open {
        let (drawn, side) = if place(limb) < axis {
            ("left", Side::Right)
        } else {
            ("right", Side::Left)
        };
        let side = if is_away { side.other() } else { side };
        let why = format!(
            "; drawn on the {drawn}, so it is the {} one, since the figure {since}",
            side.name()
        );
        give(drafts, limb, side, &why);
    }
}

/// In profile, neighbours counted from the hind end are pairs, and the limb drawn later is on the near side: the left one if
/// the figure faces the drawing's left. An odd number of limbs without words for fore and hind is taken as the legs of one
/// side. Of two that are close to each other, as a bird's legs are, such words say which is nearer.
fn from_side(
    tree: &PartTree<'_>,
    facing: &Front,
    [toward, length]: [f64; 2],
    open: &[&Limb],
    drafts: &mut Drafts,
) {
    let near = if toward < 0.0 {
        Side::Left
    } else {
        Side::Right
    };
    let way = if toward < 0.0 { "left" } else { "right" };
    let mut roots: Vec<FigurePartId> = open.iter().map(|limb| limb.root()).collect();
    sorted_from_hind(tree, facing, drafts, &mut roots);
    let is_one_pair = match roots.as_slice() {
        [a, b] => (tree.joint(*a).x - tree.joint(*b).x).abs() <= SAME_PAIR * length,
        _ => false,
    };
    let rank = |root: &FigurePartId| if is_one_pair { 1 } else { rank(&drafts[*root]) };
    let ranks: Vec<u8> = roots.iter().map(rank).collect();
    let ranked = ranks.iter().any(|rank| *rank != 1);
    let pair = if ranked || roots.len().is_multiple_of(2) {
        2
    } else {
        1
    };
    let mut far = ti_vec![false; drafts.len()];
    let mut start = 0;
    for group in ranks.chunk_by(|a, b| a == b) {
        for pair in roots[start..start + group.len()].chunks(pair) {
            if let [a, b] = pair {
                let later = |part: FigurePartId| (tree.parts[part].drawing_order, part);
                far[if later(*a) < later(*b) { *a } else { *b }] = true;
            }
        }
        start += group.len();
    }
    for limb in open {
        let (side, drawn) = if far[limb.root()] {
            (near.other(), "first, so on the far side")
        } else {
            (near, "last, so on the near side")
        };
        let why = format!(
            "; the figure faces the drawing's {way} and it was drawn {drawn}: the {} one",
            side.name()
        );
        give(drafts, limb, side, &why);
    }
}

/// Numbers the limbs of each class and side from the hind end, the segments of the trunk from the hips, those of neck and tail
/// from the trunk.
pub(super) fn pairs(tree: &PartTree<'_>, facing: &Front, limbs: &[Limb], drafts: &mut Drafts) {
    let mut segments: Vec<FigurePartId> = tree.order.clone();
    let height = |draft: &PartDraft| match draft.class {
        Some(Class::Body) if draft.says(&[Term::Belly]) => 0,
        Some(Class::Body) if draft.says(&[Term::Chest]) => 2,
        _ => 1,
    };
    let middle = |part: FigurePartId| match (drafts[part].class, facing) {
        (Some(Class::Body), Front::Viewer { .. }) => tree.middle(part).y,
        (Some(Class::Body), Front::Beside { toward, .. }) => tree.middle(part).x * toward,
        // What is attached to the trunk is already sorted, parents first.
        _ => 0.0,
    };
    segments.sort_by(|a, b| {
        let heights = height(&drafts[*a]).cmp(&height(&drafts[*b]));
        heights.then(middle(*a).total_cmp(&middle(*b)))
    });
    for class in [Class::Body, Class::Neck, Class::Tail] {
        let of_class = segments
            .iter()
            .filter(|part| drafts[**part].class == Some(class));
        let found: Vec<FigurePartId> = of_class.copied().collect();
        for (place, part) in found.into_iter().enumerate() {
            drafts[part].pair = place;
        }
    }
    for class in [Class::Arm, Class::Leg] {
        count_limbs(tree, facing, limbs, class, drafts);
    }
}

/// Numbers the limbs of a class from the hind end. If one side has fewer, each of its limbs joins the nearest pair.
fn count_limbs(
    tree: &PartTree<'_>,
    facing: &Front,
    limbs: &[Limb],
    class: Class,
    drafts: &mut Drafts,
) {
    let mut sides = Side::BOTH.map(|side| {
        let of_side = |limb: &&Limb| limb.class == class && drafts[limb.root()].side == Some(side);
        let mut roots: Vec<FigurePartId> = limbs.iter().filter(of_side).map(Limb::root).collect();
        sorted_from_hind(tree, facing, drafts, &mut roots);
        roots
    });
    sides.sort_by_key(|roots| std::cmp::Reverse(roots.len()));
    let [more, fewer] = sides;
    let mut pair_of = ti_vec![0; drafts.len()];
    for (pair, root) in more.iter().enumerate() {
        pair_of[*root] = pair;
    }
    let place = |root: FigurePartId| facing.place_of(tree, root);
    let mut by_place: Vec<(f64, usize)> = more
        .iter()
        .map(|root| (place(*root), pair_of[*root]))
        .collect();
    by_place.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (pair, root) in fewer.iter().enumerate() {
        let here = place(*root);
        let next = by_place.partition_point(|(place, _)| *place < here);
        let around = &by_place[next.saturating_sub(1)..by_place.len().min(next + 1)];
        let nearest = around
            .iter()
            .min_by(|a, b| (a.0 - here).abs().total_cmp(&(b.0 - here).abs()));
        pair_of[*root] = match nearest {
            Some((_, nearest)) if fewer.len() < more.len() => *nearest,
            _ => pair,
        };
    }
    for limb in limbs.iter().filter(|limb| limb.class == class) {
        for (part, _) in &limb.parts {
            drafts[*part].pair = pair_of[limb.root()];
        }
    }
}
