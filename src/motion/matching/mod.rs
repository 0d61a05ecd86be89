//! Which joint of a skeleton drives which part of a figure (motion.md, "Which joint drives which part").

mod names;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use super::figure::Figure;
use super::labels::{Anatomy, Class, Facing, Label, Limb, Piece, Side, Tip, label_facing};
use super::skeleton::Skeleton;
use names::Names;

/// A figure joined with a skeleton.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Matching {
    /// Per part what it is.
    pub labels: Vec<Option<Label>>,
    /// Per part the joint that drives it; a part without follows the part that it hangs on.
    pub drives: Vec<Option<Drive>>,
    /// Per part that no joint drives why that is so; empty for the others.
    pub follows: Vec<String>,
    /// The way that the figure faces.
    pub facing: Facing,
    /// What stood in the way.
    pub problems: Vec<Problem>,
}

/// The joint that drives a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// The joint.
    pub joint: usize,
    /// The far end of the bone or chain that begins at the joint; always there where the part follows a direction.
    pub tip: Option<Tip>,
    /// What the part takes from it.
    pub follow: Follow,
    /// Why, for people to read.
    pub why: String,
}

/// What a part takes from its joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Follow {
    /// Its axis points as the bone or chain does, from the joint to the tip: limbs.
    Direction,
    /// It turns by as much as the joint has turned from its rest, its drawn pose kept: trunk, neck, head.
    Change,
}

/// What stands in the way of a match.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Problem {
    /// A part's string names a joint that the skeleton has not. The part is matched as if it named none.
    UnknownBone {
        /// The part.
        part: usize,
        /// The name as written.
        name: String,
        /// Names of joints that are spelled nearly so, the nearest first.
        nearest: Vec<String>,
    },
    /// A part's string names a joint, and several have that name. The first is taken.
    AmbiguousBone {
        /// The part.
        part: usize,
        /// The name as written.
        name: String,
        /// The joints that have it.
        joints: Vec<usize>,
    },
    /// A part's string names two joints, and the second does not hang on the first. The part is matched as if it named none.
    NotAChain {
        /// The part.
        part: usize,
        /// The first joint.
        from: usize,
        /// The second joint.
        to: usize,
    },
    /// A part's string names more than two joints. Those after the second are left out.
    TooManyBones {
        /// The part.
        part: usize,
    },
    /// The figure has a limb that the skeleton has not.
    NoSuchLimb {
        /// Arm or leg.
        class: Class,
        /// The skeleton's side that lacks it.
        side: Side,
        /// The parts that would follow it.
        parts: Vec<usize>,
    },
    /// No joint drives any part.
    NothingMatched,
}

/// Joins a figure with a skeleton on their labels; `Bone` overrides.
///
/// A limb of one piece follows the whole chain, shoulder to wrist or hip to ankle, and takes a hand or foot along; of two, upper and
/// lower bone; a third is hand or foot. Legs of odd pairs, counted from the hind, take the other side's leg; arms never swap. A single trunk follows the
/// chest, since head and arms hang there; several pieces are spread over the spine, the topmost on the chest; hips follow the
/// hips. `anatomy` belongs to the skeleton.
pub fn match_figure(figure: &Figure, skeleton: &Skeleton, anatomy: &Anatomy) -> Matching {
    let (labels, facing) = label_facing(figure);
    let mut problems = Vec::new();
    let names = Names::new(skeleton);
    let mut drives = Vec::with_capacity(labels.len());
    let mut follows = Vec::with_capacity(labels.len());
    let mut lacking = Vec::new();
    let joining = Joining::new(skeleton, anatomy, &labels);
    for (part, label) in labels.iter().enumerate() {
        let bones = &figure.parts[part].bones;
        let class = label.as_ref().map(|label| label.class);
        let found = match names.bones(part, bones, class, anatomy, &mut problems) {
            Some(drive) => Ok(drive),
            None => match label {
                Some(label) => joining.drive(part, label, &mut lacking),
                None => Err("no limb, head or trunk by its name or place".to_owned()),
            },
        };
        match found {
            Ok(drive) => {
                drives.push(Some(drive));
                follows.push(String::new());
            }
            Err(why) => {
                drives.push(None);
                follows.push(why);
            }
        }
    }
    problems.append(&mut lacking);
    if drives.iter().all(Option::is_none) {
        problems.push(Problem::NothingMatched);
    }
    Matching {
        labels,
        drives,
        follows,
        facing,
        problems,
    }
}

/// The joints that `Bone` can mean by a name: compared exactly, else without regard to case, else without the prefixes that most
/// joints share.
pub fn joints_named(skeleton: &Skeleton, name: &str) -> Vec<usize> {
    Names::new(skeleton).joints(name).to_vec()
}

/// Both sides of the join.
struct Joining<'a> {
    skeleton: &'a Skeleton,
    anatomy: &'a Anatomy,
    /// How many pieces trunk, neck and tail of the figure have.
    pieces: [usize; 3],
    /// The limbs of one piece: class, side and pair.
    whole: BTreeSet<(Class, Option<Side>, usize)>,
}

impl<'a> Joining<'a> {
    fn new(skeleton: &'a Skeleton, anatomy: &'a Anatomy, labels: &[Option<Label>]) -> Self {
        let count = |class| {
            labels
                .iter()
                .flatten()
                .filter(|label| label.class == class)
                .count()
        };
        Self {
            skeleton,
            anatomy,
            pieces: [Class::Body, Class::Neck, Class::Tail].map(count),
            whole: labels
                .iter()
                .flatten()
                .filter(|label| label.class.is_limb() && label.piece == Piece::Whole)
                .map(|label| (label.class, label.side, label.pair))
                .collect(),
        }
    }

    fn drive(
        &self,
        part: usize,
        label: &Label,
        lacking: &mut Vec<Problem>,
    ) -> Result<Drive, String> {
        let anatomy = self.anatomy;
        let [body, neck, tail] = self.pieces;
        let joint = match label.class {
            Class::Arm | Class::Leg => return self.limb(part, label, lacking),
            Class::Head => anatomy.head.or(anatomy.neck.last().copied()),
            Class::Neck => spread(&anatomy.neck, label.pair, neck),
            Class::Tail => spread(&anatomy.tail, label.pair, tail),
            Class::Hips => anatomy.hips,
            Class::Body => spread(&anatomy.spine, label.pair, body).or(anatomy.hips),
        };
        let name = label.class.name();
        let joint = joint.ok_or_else(|| format!("{}; the motion has no {name}", label.why))?;
        let why = format!("{}; it turns with `{}`", label.why, self.name(joint));
        Ok(Drive {
            joint,
            tip: None,
            follow: Follow::Change,
            why,
        })
    }

    fn limb(
        &self,
        part: usize,
        label: &Label,
        lacking: &mut Vec<Problem>,
    ) -> Result<Drive, String> {
        let why = &label.why;
        let own = label.side.ok_or_else(|| why.clone())?;
        let is_last = matches!(label.piece, Piece::End | Piece::Beyond);
        if is_last && self.whole.contains(&(label.class, label.side, label.pair)) {
            return Err(format!("{why}; a limb of one piece takes it along"));
        }
        let crossed = label.class == Class::Leg && label.pair % 2 == 1;
        let side = if crossed { own.other() } else { own };
        let Some(limb) = self.anatomy.limb(label.class, side) else {
            lacks(lacking, label.class, side, part);
            return Err(format!(
                "{why}; the motion has no {} {}",
                side.name(),
                label.class.name()
            ));
        };
        let (joint, tip) = bone(limb, label.piece)
            .ok_or_else(|| format!("{why}; the motion has no {}", label.piece.name(label.class)))?;
        let mut why = why.clone();
        if crossed {
            why += "; an odd pair from the hind takes the other side's leg";
        }
        let (follow, way) = match tip {
            Some(tip) => (
                Follow::Direction,
                format!(
                    "; it points from `{}` to {}",
                    self.name(joint),
                    self.tip(tip)
                ),
            ),
            None => (
                Follow::Change,
                format!("; it turns with `{}`", self.name(joint)),
            ),
        };
        Ok(Drive {
            joint,
            tip,
            follow,
            why: why + &way,
        })
    }

    fn name(&self, joint: usize) -> &str {
        &self.skeleton.joints[joint].name
    }

    fn tip(&self, tip: Tip) -> String {
        match tip {
            Tip::Joint(joint) => format!("`{}`", self.name(joint)),
            Tip::End { joint, .. } => format!("the end of `{}`", self.name(joint)),
        }
    }
}

/// The joint of a chain for a piece of several; the last piece has the last joint.
fn spread(chain: &[usize], piece: usize, pieces: usize) -> Option<usize> {
    let place = ((piece + 1) * chain.len()).div_ceil(pieces.max(1));
    chain.get(place.checked_sub(1)?).copied()
}

/// Where the bone or chain of a piece begins and ends. Hand and foot without a bone, and toes, turn with their joint.
fn bone(limb: &Limb, piece: Piece) -> Option<(usize, Option<Tip>)> {
    let [lower, end] = [limb.lower, limb.end].map(|joint| joint.map(Tip::Joint));
    let pointing = |joint: Option<usize>, tip: Option<Tip>| Some((joint?, Some(tip?)));
    match piece {
        Piece::Collar => pointing(limb.collar, Some(Tip::Joint(limb.upper))),
        Piece::Whole => pointing(Some(limb.upper), end.or(limb.tip)),
        Piece::Upper => pointing(Some(limb.upper), lower.or(end).or(limb.tip)),
        Piece::Lower => pointing(limb.lower, end.or(limb.tip)),
        Piece::End => Some((limb.end?, limb.tip)),
        Piece::Beyond => Some((limb.toe?, None)),
    }
}

fn lacks(problems: &mut Vec<Problem>, lacking: Class, at: Side, part: usize) {
    for problem in problems.iter_mut() {
        if let Problem::NoSuchLimb { class, side, parts } = problem
            && (*class, *side) == (lacking, at)
        {
            parts.push(part);
            return;
        }
    }
    problems.push(Problem::NoSuchLimb {
        class: lacking,
        side: at,
        parts: vec![part],
    });
}
