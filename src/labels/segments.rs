//! The limbs of a figure, and which segment of its limb each part is.

use typed_index_collections::{TiVec, ti_vec};

use super::figure::Drafts;
use super::part_tree::PartTree;
use super::{Class, FigurePartId, LimbSegment};
use crate::anatomy::Term;

/// A limb of a figure.
#[derive(Debug)]
pub(super) struct Limb {
    pub(super) class: Class,
    /// Its parts, parents before children, each with the number of parts between it and the trunk.
    pub(super) parts: Vec<(FigurePartId, usize)>,
}

impl Limb {
    /// The part that is attached to the trunk.
    pub(super) fn root(&self) -> FigurePartId {
        self.parts[0].0
    }
}

/// The limbs of a figure, in its order. A part continues its parent's limb if it has the same class and no other side.
pub(super) fn limbs(tree: &PartTree<'_>, drafts: &Drafts) -> Vec<Limb> {
    let mut limbs: Vec<Limb> = Vec::new();
    // Per part its limb and its depth in it.
    let mut places: TiVec<FigurePartId, Option<(usize, usize)>> = ti_vec![None; drafts.len()];
    for part in tree.order.iter().copied() {
        let Some(class) = drafts[part].class.filter(|class| class.is_limb()) else {
            continue;
        };
        let above = tree.parents[part].and_then(|parent| {
            let same_side = drafts[part].side.is_none()
                || drafts[part].side == drafts[parent].side
                || drafts[parent].side.is_none();
            places[parent].filter(|(limb, _)| limbs[*limb].class == class && same_side)
        });
        let (limb, depth) = match above {
            Some((limb, depth)) => (limb, depth + 1),
            None => {
                limbs.push(Limb {
                    class,
                    parts: Vec::new(),
                });
                (limbs.len() - 1, 0)
            }
        };
        limbs[limb].parts.push((part, depth));
        places[part] = Some((limb, depth));
    }
    limbs
}

/// Per part whether it belongs to a limb that the figure spreads: a wing or a tentacle that does not hang down, a leg where
/// there are three pairs or more, or a foot that is attached to the trunk.
pub(super) fn splayed(
    tree: &PartTree<'_>,
    limbs: &[Limb],
    drafts: &Drafts,
) -> TiVec<FigurePartId, bool> {
    /// The index of the third pair.
    const THIRD: usize = 2;
    let mut splayed = ti_vec![false; drafts.len()];
    let mut legs = limbs.iter().filter(|limb| limb.class == Class::Leg);
    let many_legs = legs.any(|leg| drafts[leg.root()].pair >= THIRD);
    for limb in limbs {
        let root = limb.root();
        let way = tree.tip(root) - tree.joint(root);
        let hangs = -way.y > way.x.abs();
        let mut parts = limb.parts.iter().map(|(part, _)| *part);
        let is_spread = match limb.class {
            Class::Leg => many_legs || limb.parts.len() == 1 && tree.is_foot_on_ground(root),
            _ => !hangs && parts.any(|part| drafts[part].says(&[Term::Wing])),
        };
        if is_spread {
            for (part, _) in &limb.parts {
                splayed[*part] = true;
            }
        }
    }
    splayed
}

/// Sets which segment of its limb each part is. Parts that are hands or feet by name stay so: an arm with a hand is a whole arm
/// and a hand, not an upper arm and a forearm. A shoulder that carries an arm is the collar bone.
pub(super) fn name(tree: &PartTree<'_>, limbs: &[Limb], drafts: &mut Drafts) {
    for limb in limbs {
        let root = limb.root();
        let arm = [Term::Arm, Term::UpperArm];
        let collar = drafts[root].says(&[Term::Shoulder, Term::Collar])
            && !drafts[root].says(&arm)
            && limb
                .parts
                .iter()
                .any(|(part, depth)| *depth == 1 && drafts[*part].says(&arm));
        let first = usize::from(collar);
        let deepest = limb
            .parts
            .iter()
            .map(|(_, depth)| *depth)
            .max()
            .unwrap_or(0);
        let end = limb
            .parts
            .iter()
            .filter(|(part, depth)| *depth > first && is_end(tree, drafts, *part))
            .map(|(_, depth)| *depth)
            .min();
        for (part, depth) in &limb.parts {
            drafts[*part].segment = Some(if *depth < first {
                LimbSegment::Collar
            } else {
                segment(*depth - first, deepest - first, end.map(|end| end - first))
            });
        }
    }
}

fn segment(depth: usize, deepest: usize, end: Option<usize>) -> LimbSegment {
    match (depth, end) {
        (0, Some(1)) => LimbSegment::Whole,
        (0, None) if deepest == 0 => LimbSegment::Whole,
        (0, _) => LimbSegment::Upper,
        (depth, Some(end)) if depth == end => LimbSegment::End,
        (1, Some(2..) | None) => LimbSegment::Lower,
        (2, None) => LimbSegment::End,
        _ => LimbSegment::Beyond,
    }
}

fn is_end(tree: &PartTree<'_>, drafts: &Drafts, part: FigurePartId) -> bool {
    let draft = &drafts[part];
    let on_a_leg = || {
        tree.parents[part].is_some_and(|parent| {
            drafts[parent].says(&[Term::Leg, Term::Shin])
                && !drafts[parent].says(&[Term::LegOrFoot])
        })
    };
    draft.says(&[Term::Hand, Term::Foot]) || draft.says(&[Term::LegOrFoot]) && on_a_leg()
}
