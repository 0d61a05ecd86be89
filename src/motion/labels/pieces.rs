//! Limbs of a figure, and which piece of them a part is.

use super::figure::Draft;
use super::shape::Shape;
use super::words::Term;
use super::{Class, Piece};

/// A limb of a figure.
#[derive(Debug)]
pub(super) struct Limb {
    pub(super) class: Class,
    /// Its parts, each behind the one that it hangs on, with the number of parts between it and the trunk.
    pub(super) parts: Vec<(usize, usize)>,
}

impl Limb {
    /// The part that hangs on the trunk.
    pub(super) fn root(&self) -> usize {
        self.parts[0].0
    }
}

/// The limbs of a figure, in its order. A part of the same class and no other side goes on with the limb that it hangs on.
pub(super) fn limbs(shape: &Shape<'_>, drafts: &[Draft]) -> Vec<Limb> {
    let mut limbs: Vec<Limb> = Vec::new();
    // Per part its limb and its place there.
    let mut places: Vec<Option<(usize, usize)>> = vec![None; drafts.len()];
    for part in shape.order.iter().copied() {
        let Some(class) = drafts[part].class.filter(|class| class.is_limb()) else {
            continue;
        };
        let above = shape.parents[part].and_then(|parent| {
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

/// Says which piece each part of a limb is. Hands and feet by name stay what they are: arm and hand are the whole arm and a hand,
/// not upper arm and forearm. A shoulder that carries an arm is the collar bone.
pub(super) fn name(shape: &Shape<'_>, limbs: &[Limb], drafts: &mut [Draft]) {
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
            .filter(|(part, depth)| *depth > first && is_end(shape, drafts, *part))
            .map(|(_, depth)| *depth)
            .min();
        for (part, depth) in &limb.parts {
            drafts[*part].piece = Some(if *depth < first {
                Piece::Collar
            } else {
                piece(*depth - first, deepest - first, end.map(|end| end - first))
            });
        }
    }
}

fn piece(depth: usize, deepest: usize, end: Option<usize>) -> Piece {
    match (depth, end) {
        (0, Some(1)) => Piece::Whole,
        (0, None) if deepest == 0 => Piece::Whole,
        (0, _) => Piece::Upper,
        (depth, Some(end)) if depth == end => Piece::End,
        (1, Some(2..) | None) => Piece::Lower,
        (2, None) => Piece::End,
        _ => Piece::Beyond,
    }
}

fn is_end(shape: &Shape<'_>, drafts: &[Draft], part: usize) -> bool {
    let draft = &drafts[part];
    let on_a_leg = || {
        shape.parents[part].is_some_and(|parent| {
            drafts[parent].says(&[Term::Leg, Term::Shin])
                && !drafts[parent].says(&[Term::LegOrFoot])
        })
    };
    draft.says(&[Term::Hand, Term::Foot]) || draft.says(&[Term::LegOrFoot]) && on_a_leg()
}
