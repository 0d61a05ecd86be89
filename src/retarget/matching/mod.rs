//! Which joint of a skeleton drives which part of a figure (docs/motion.md, "Which joint drives which part").

mod elbows;
mod names;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use glam::DVec3;
use typed_index_collections::{TiSlice, TiVec};

use crate::labels::{
    Anatomy, Carry, Class, Figure, FigurePartId, FoundFacing, Label, LabeledFigure, Limb,
    LimbSegment, Side, Tip, label_drawn,
};
use crate::mocap::{JointId, Skeleton, Transform};
pub(crate) use elbows::bent_arms;
use names::Names;

/// A figure matched with a skeleton.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Matching {
    /// The parts, in the figure's order.
    pub parts: TiVec<FigurePartId, MatchedPart>,
    /// The direction that the figure faces, and why.
    pub facing: FoundFacing,
    /// What was wrong or missing.
    pub problems: Vec<Problem>,
}

/// A part of a figure, matched with a joint.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct MatchedPart {
    /// What the part is; `None` if neither its name nor its place tells.
    pub label: Option<Label>,
    /// Whether it belongs to a limb that the figure spreads: a wing or a tentacle that does not hang down, a leg where there are
    /// three pairs or more, or a foot that is attached to the trunk.
    pub splayed: bool,
    /// What drives it; a part without a drive follows its parent. If it bends, this is what drives its first bone.
    pub drive: Option<Drive>,
    /// What drives its further bones, if it bends; one without a drive follows the one before.
    pub bones: Vec<Option<Drive>>,
    /// Why that drive, or why none, for people to read.
    pub why: String,
}

impl MatchedPart {
    /// What drives its far end: its last bone that something drives, if it bends.
    pub(crate) fn end_drive(&self) -> Option<Drive> {
        self.bones
            .iter()
            .rev()
            .flatten()
            .next()
            .copied()
            .or(self.drive)
    }
}

/// How a joint drives a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Drive {
    /// The joint.
    pub joint: JointId,
    /// The far end of the bone or chain that begins at the joint; always present if the part follows a direction.
    pub tip: Option<Tip>,
    /// What the part takes over from it.
    pub follow: Follow,
}

/// What a part takes over from its joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Follow {
    /// Its axis points like the bone or chain, from the joint to the tip: limbs.
    Direction,
    /// It turns by as much as the joint has turned from its rest, starting from the drawn pose: trunk, neck, head. If there is a
    /// tip, as for a limb that is splayed, it turns like the chain from the joint to the tip, from where that is on average.
    Change,
    /// Like a change, but it leans by as much as the line from the hips to the middle of the shoulders: a trunk of one segment.
    Trunk {
        /// The joint of the hips.
        hips: JointId,
        /// The joints where the arms begin.
        shoulders: [JointId; 2],
    },
    /// It turns with the joint, from where the foot of the motion stands flat on the ground, and its toes point where the motion's do:
    /// feet. While the motion's foot stands flat, the drawn sole is flat, and only turns about the vertical.
    Sole,
}

impl Drive {
    /// The direction of the chain that the part follows in a pose; `None` if there is none, or where it has no length.
    pub(crate) fn direction(
        &self,
        skeleton: &Skeleton,
        pose: &TiSlice<JointId, Transform>,
    ) -> Option<DVec3> {
        let place = |joint: JointId| pose[joint].position;
        let chain = match self.follow {
            Follow::Trunk {
                hips,
                shoulders: [left, right],
            } => (place(left) + place(right)) / 2.0 - place(hips),
            Follow::Sole => return None,
            Follow::Direction | Follow::Change => {
                self.tip?.place(skeleton, pose) - place(self.joint)
            }
        };
        chain.try_normalize()
    }
}

/// A problem that was found while matching.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Problem {
    /// A part's string names a joint that the skeleton does not have. The part is matched as if it named none.
    UnknownBone {
        /// The part.
        part: FigurePartId,
        /// The name as written.
        name: String,
        /// Joint names with a similar spelling, the most similar first.
        nearest: Vec<String>,
    },
    /// A part's string names a joint, and several joints have that name. The first one is used.
    AmbiguousBone {
        /// The part.
        part: FigurePartId,
        /// The name as written.
        name: String,
        /// The joints that have it.
        joints: Vec<JointId>,
    },
    /// A part's string names two joints, and the second is not a descendant of the first. The part is matched as if it named
    /// none.
    NotAChain {
        /// The part.
        part: FigurePartId,
        /// The first joint.
        from: JointId,
        /// The second joint.
        to: JointId,
    },
    /// A part's string names more than two joints. Those after the second are ignored.
    TooManyBones {
        /// The part.
        part: FigurePartId,
    },
    /// The figure has a limb that the skeleton does not have.
    NoSuchLimb {
        /// Arm or leg.
        class: Class,
        /// The side of the skeleton that lacks it.
        side: Side,
        /// The parts that it would drive.
        parts: Vec<FigurePartId>,
    },
    /// An arm is drawn in one segment, and the motion bends its elbow so much that the arm's end is far from where it should be.
    BentArm {
        /// The part.
        part: FigurePartId,
        /// How far, in the median, as a share of the arm's length.
        error: f64,
    },
    /// No joint drives any part.
    NothingMatched,
}

/// Matches a figure with a skeleton: parts and joints with equal labels belong together; `Bone` overrides.
///
/// A limb of one segment follows the whole chain, shoulder to wrist or hip to ankle, and takes a hand or foot along. Of two
/// segments one follows the upper and one the lower bone; a third is the hand or foot. Pairs of legs are counted from the hind end.
/// If the skeleton has one pair, every second pair follows the other side's leg; if it has more, each pair follows its own, and
/// those beyond follow the other side's legs, beginning with the hind ones again. Arms never swap sides. A trunk of one segment
/// turns with the chest, to which head and arms are attached, and leans with the line from the hips to the shoulders; several
/// segments are spread over the spine, the topmost on the chest. Hips follow the hips. Splayed limbs keep their drawn pose and
/// follow only the change, unless `Carry` says otherwise. `anatomy` belongs to the skeleton.
pub(crate) fn match_figure(figure: &Figure, skeleton: &Skeleton, anatomy: &Anatomy) -> Matching {
    let LabeledFigure {
        labels,
        splayed,
        facing,
        held,
        ..
    } = label_drawn(figure);
    let mut problems = Vec::new();
    let names = Names::new(skeleton);
    let mut parts = TiVec::with_capacity(labels.len());
    let mut lacking = Vec::new();
    let ground = standing_height(figure);
    let matcher = Matcher::new(skeleton, anatomy, figure, &labels);
    for ((part, label), splayed) in labels.into_iter_enumerated().zip(splayed) {
        let bones = &figure.parts[part].bones;
        let class = label.as_ref().map(|label| label.class);
        let by_bone = names.bones(part, bones, class, anatomy, &mut problems);
        let is_bone = by_bone.is_some();
        let found = match by_bone {
            Some(drive) => Ok(drive),
            None => match &label {
                Some(label) => matcher.drive(part, label, &mut lacking),
                None => Err(held[part]
                    .clone()
                    .unwrap_or_else(|| "no limb, head or trunk by its name or place".to_owned())),
            },
        };
        let (drive, why) = match found {
            Ok((drive, mut why)) => {
                let carry = figure.parts[part].carry;
                let stands = figure.parts[part].bounds[0].y <= ground;
                let (drive, how) = carried(drive, carry, splayed, stands);
                why += how;
                if !is_bone {
                    why += &matcher.way(&drive);
                }
                (Some(drive), why)
            }
            Err(why) => (None, why),
        };
        let bones = match &label {
            Some(label) if !is_bone && drive.is_some() => matcher.bones(part, label),
            _ => Vec::new(),
        };
        let carry = figure.parts[part].carry;
        let bones: Vec<Option<Drive>> = bones
            .into_iter()
            .map(|drive| Some(carried(drive?, carry, splayed, false).0))
            .collect();
        let why = match bones.iter().flatten().next() {
            Some(drive) => {
                why + &matcher
                    .way(drive)
                    .replacen("; it", "; beyond its joint it", 1)
            }
            None => why,
        };
        parts.push(MatchedPart {
            label,
            splayed,
            drive,
            bones,
            why,
        });
    }
    problems.append(&mut lacking);
    if parts.iter().all(|part| part.drive.is_none()) {
        problems.push(Problem::NothingMatched);
    }
    Matching {
        parts,
        facing,
        problems,
    }
}

/// Up to which height the lowest point of a foot is on the ground: legs on the far side are drawn higher.
fn standing_height(figure: &Figure) -> f64 {
    /// The share of the figure's height.
    const STANDS: f64 = 0.08;

    let (low, high) = figure
        .parts
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), part| {
            (low.min(part.bounds[0].y), high.max(part.bounds[1].y))
        });
    low + STANDS * (high - low)
}

/// The drive of a part with what it takes over from its joint, and the reason if that is unusual. Only what points along a bone
/// has a choice: it does what `Carry` says, else it takes over the change if it is splayed.
fn carried(
    drive: Drive,
    carry: Option<Carry>,
    splayed: bool,
    stands: bool,
) -> (Drive, &'static str) {
    let as_if = |follow: Follow| Drive { follow, ..drive };
    let change = as_if(Follow::Change);
    match (drive.follow, carry, splayed) {
        (Follow::Direction, Some(Carry::Change), _) => (
            change,
            "; its string says `Carry change`, so it keeps its drawn pose",
        ),
        (Follow::Direction | Follow::Sole, None, true) => {
            (change, "; it is splayed, so it keeps its drawn pose")
        }
        (Follow::Sole, Some(Carry::Change), _) => (
            change,
            "; its string says `Carry change`, so it keeps its drawn pose",
        ),
        (Follow::Sole, None, false) if !stands && drive.tip.is_some() => (
            as_if(Follow::Direction),
            "; it does not stand in the drawing",
        ),
        (Follow::Sole, Some(Carry::Direction), _) if drive.tip.is_some() => (
            as_if(Follow::Direction),
            "; its string says `Carry direction`",
        ),
        (Follow::Direction, Some(Carry::Direction), true) => {
            (drive, "; its string says `Carry direction`")
        }
        _ => (drive, ""),
    }
}

/// The joints that `Bone` can mean by a name: an exact match, else one that ignores case, else one that also ignores the
/// prefixes that most joints share.
pub(crate) fn joints_named(skeleton: &Skeleton, name: &str) -> Vec<JointId> {
    Names::new(skeleton).joints(name).to_vec()
}

/// Both sides of the match.
struct Matcher<'a> {
    skeleton: &'a Skeleton,
    anatomy: &'a Anatomy,
    /// How many segments the figure's trunk, neck and tail have.
    segments: [usize; 3],
    /// The limbs of one rigid segment: class, side and pair.
    whole: BTreeSet<(Class, Option<Side>, usize)>,
    /// Per part how many bones it has inside.
    bends: TiVec<FigurePartId, usize>,
}

impl<'a> Matcher<'a> {
    fn new(
        skeleton: &'a Skeleton,
        anatomy: &'a Anatomy,
        figure: &Figure,
        labels: &TiSlice<FigurePartId, Option<Label>>,
    ) -> Self {
        let bends: TiVec<_, _> = figure.parts.iter().map(|part| part.bends.max(1)).collect();
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
            segments: [Class::Body, Class::Neck, Class::Tail].map(count),
            whole: labels
                .iter()
                .zip(&bends)
                .filter(|(_, bones)| **bones == 1)
                .filter_map(|(label, _)| label.as_ref())
                .filter(|label| label.class.is_limb() && label.segment == LimbSegment::Whole)
                .map(|label| (label.class, label.side, label.pair))
                .collect(),
            bends,
        }
    }

    fn drive(
        &self,
        part: FigurePartId,
        label: &Label,
        lacking: &mut Vec<Problem>,
    ) -> Result<(Drive, String), String> {
        let anatomy = self.anatomy;
        let [body, neck, tail] = self.segments;
        let joint = match label.class {
            Class::Arm | Class::Leg => return self.limb(part, label, lacking),
            Class::Head => anatomy.head.or(anatomy.neck.last().copied()),
            Class::Neck => self.spread(&anatomy.neck, part, label.pair, neck, 0),
            Class::Tail => self.spread(&anatomy.tail, part, label.pair, tail, 0),
            Class::Hips => anatomy.hips,
            Class::Body => spread(&anatomy.spine, label.pair, body).or(anatomy.hips),
        };
        let name = label.class.name();
        let joint = joint.ok_or_else(|| format!("{}; the motion has no {name}", label.why))?;
        let follow = match (label.class, body, anatomy.hips, self.shoulders()) {
            (Class::Body, 1, Some(hips), Some(shoulders)) => Follow::Trunk { hips, shoulders },
            _ => Follow::Change,
        };
        let drive = Drive {
            joint,
            tip: None,
            follow,
        };
        Ok((drive, label.why.clone()))
    }

    /// The joint of a chain that drives a bone of one of several segments.
    fn spread(
        &self,
        chain: &[JointId],
        part: FigurePartId,
        segment: usize,
        segments: usize,
        bone: usize,
    ) -> Option<JointId> {
        let bones = self.bends[part];
        spread(chain, segment * bones + bone, segments * bones)
    }

    /// What drives the bones of a part that bends, but the first.
    fn bones(&self, part: FigurePartId, label: &Label) -> Vec<Option<Drive>> {
        let [_, neck, tail] = self.segments;
        let count = self.bends[part];
        let bone = |bone: usize| {
            let chain = match label.class {
                Class::Arm | Class::Leg => {
                    let segment = half(label, bone, count);
                    let label = Label {
                        segment,
                        ..label.clone()
                    };
                    let found = self.limb(part, &label, &mut Vec::new());
                    return found.ok().map(|(drive, _)| drive);
                }
                Class::Neck => self.spread(&self.anatomy.neck, part, label.pair, neck, bone),
                Class::Tail => self.spread(&self.anatomy.tail, part, label.pair, tail, bone),
                Class::Head | Class::Body | Class::Hips => None,
            };
            Some(Drive {
                joint: chain?,
                tip: None,
                follow: Follow::Change,
            })
        };
        (1..count).map(bone).collect()
    }

    fn shoulders(&self) -> Option<[JointId; 2]> {
        let [left, right] = Side::BOTH.map(|side| self.anatomy.limb(Class::Arm, side));
        Some([left?.upper, right?.upper])
    }

    fn limb(
        &self,
        part: FigurePartId,
        label: &Label,
        lacking: &mut Vec<Problem>,
    ) -> Result<(Drive, String), String> {
        let why = &label.why;
        let own = label.side.ok_or_else(|| why.clone())?;
        let is_foot = (label.class, label.segment) == (Class::Leg, LimbSegment::End);
        let is_last = matches!(label.segment, LimbSegment::End | LimbSegment::Beyond);
        if is_last && !is_foot && self.whole.contains(&(label.class, label.side, label.pair)) {
            return Err(format!("{why}; it follows a limb of one piece"));
        }
        // The pairs of the skeleton from the hind end on, and again and again for further pairs, with their sides swapped.
        let pairs = self.anatomy.leg_pairs().max(1);
        let (pair, crossed) = match label.class {
            Class::Leg => (label.pair % pairs, label.pair / pairs % 2 == 1),
            _ => (0, false),
        };
        let side = if crossed { own.other() } else { own };
        let Some(limb) = self.anatomy.limb_of_pair(label.class, side, pair) else {
            lacks(lacking, label.class, side, part);
            return Err(format!(
                "{why}; the motion has no {} {}",
                side.name(),
                label.class.name()
            ));
        };
        let segment = half(label, 0, self.bends[part]);
        let (joint, tip) = bone(limb, segment).ok_or_else(|| {
            format!(
                "{why}; the motion has no {}",
                label.segment.name(label.class)
            )
        })?;
        let mut why = why.clone();
        if crossed {
            why += match pairs {
                1 => "; every second pair of legs follows the other side's leg",
                _ => "; the motion has fewer pairs of legs, so it follows a leg of the other side",
            };
        }
        let follow = match tip {
            _ if is_foot => Follow::Sole,
            Some(_) => Follow::Direction,
            None => Follow::Change,
        };
        Ok((Drive { joint, tip, follow }, why))
    }

    /// How a joint drives a part, for people to read.
    fn way(&self, drive: &Drive) -> String {
        let name = self.name(drive.joint);
        match (drive.follow, drive.tip) {
            (Follow::Direction, Some(tip)) => {
                format!("; it points from `{name}` to {}", self.tip(tip))
            }
            (Follow::Change, Some(tip)) => {
                format!(
                    "; it turns like the line from `{name}` to {}",
                    self.tip(tip)
                )
            }
            (Follow::Sole, _) => {
                format!("; its sole turns with `{name}`, flat where that stands flat")
            }
            (Follow::Trunk { .. }, _) => format!(
                "; it turns with `{name}` and leans with the line from the hips to the shoulders"
            ),
            _ => format!("; it turns with `{name}`"),
        }
    }

    fn name(&self, joint: JointId) -> &str {
        &self.skeleton.joints[joint].name
    }

    fn tip(&self, tip: Tip) -> String {
        match tip {
            Tip::Joint(joint) => format!("`{}`", self.name(joint)),
            Tip::End { joint, .. } => format!("the end of `{}`", self.name(joint)),
        }
    }
}

/// Which half of a limb a bone of it is in, if the limb is one part and bends.
fn half(label: &Label, bone: usize, bones: usize) -> LimbSegment {
    match label.segment {
        LimbSegment::Whole if bones > 1 && 2 * bone < bones => LimbSegment::Upper,
        LimbSegment::Whole if bones > 1 => LimbSegment::Lower,
        segment => segment,
    }
}

/// The joint of a chain that drives one of several segments; the last segment gets the last joint.
fn spread(chain: &[JointId], segment: usize, segments: usize) -> Option<JointId> {
    let place = ((segment + 1) * chain.len()).div_ceil(segments.max(1));
    chain.get(place.checked_sub(1)?).copied()
}

/// Where the bone or chain that drives a segment begins and ends. Toes, and a hand or foot without a bone, turn with their joint.
fn bone(limb: &Limb, segment: LimbSegment) -> Option<(JointId, Option<Tip>)> {
    let [lower, end] = [limb.lower, limb.end].map(|joint| joint.map(Tip::Joint));
    let pointing = |joint: Option<JointId>, tip: Option<Tip>| Some((joint?, Some(tip?)));
    match segment {
        LimbSegment::Collar => pointing(limb.collar, Some(Tip::Joint(limb.upper))),
        LimbSegment::Whole => pointing(Some(limb.upper), end.or(limb.tip)),
        LimbSegment::Upper => pointing(Some(limb.upper), lower.or(end).or(limb.tip)),
        LimbSegment::Lower => pointing(limb.lower, end.or(limb.tip)),
        LimbSegment::End => Some((limb.end?, limb.tip)),
        LimbSegment::Beyond => Some((limb.toe?, None)),
    }
}

fn lacks(problems: &mut Vec<Problem>, lacking: Class, at: Side, part: FigurePartId) {
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
