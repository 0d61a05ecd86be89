//! The points by which limited animation measures how fast a motion is, and which frames repeat the one before.

use glam::DVec3;
use rayon::prelude::*;

use super::labels::{Anatomy, Class, Tip};
use super::limited::Poses;
use super::retarget::{RetargetedClip, Rig};
use super::skeleton::{Clip, Transform};

/// Frames that a thread processes at once.
const GRAIN: usize = 256;

/// At which points of a skeleton the speed of its motion is measured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum PointChoice {
    /// Where it is seen: the joints of trunk, neck, head, limbs and tail, and the far ends of head, hands and feet. Fingers, faces
    /// and twist joints would outweigh all others, and a turn of the head moves no joint.
    #[default]
    Seen,
    /// All joints, as in the thesis (5.2.1).
    All,
}

/// A motion as limited animation sees it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measured {
    /// The points, `frames × per_frame`, frame by frame.
    pub points: Vec<DVec3>,
    /// The number of points per frame.
    pub per_frame: usize,
    /// Per frame whether nothing has changed since the one before.
    pub repeats: Vec<bool>,
}

impl Measured {
    /// A clip, whose joints are at these positions (`frames × joints`, in the file's unit).
    pub fn of_clip(
        clip: &Clip,
        positions: &[DVec3],
        anatomy: &Anatomy,
        choice: PointChoice,
    ) -> Self {
        let joints = clip.skeleton.joints.len();
        let repeat = |frame: usize| frame > 0 && clip.row(frame) == clip.row(frame - 1);
        let repeats = (0..clip.frames()).map(repeat).collect();
        let tips = match choice {
            PointChoice::Seen => seen(clip, anatomy),
            PointChoice::All => Vec::new(),
        };
        if tips.is_empty() {
            return Self {
                points: positions.to_vec(),
                per_frame: joints,
                repeats,
            };
        }
        let ends = tips.iter().any(|tip| matches!(tip, Tip::End { .. }));
        let mut points = vec![DVec3::ZERO; clip.frames() * tips.len()];
        points
            .par_chunks_mut(GRAIN * tips.len())
            .enumerate()
            .for_each(|(chunk, points)| {
                let mut pose = Vec::with_capacity(joints);
                for (frame, points) in points.chunks_mut(tips.len()).enumerate() {
                    let frame = chunk * GRAIN + frame;
                    if ends {
                        clip.pose_into(frame, &mut pose);
                    }
                    for (point, tip) in points.iter_mut().zip(&tips) {
                        *point = match tip {
                            Tip::Joint(joint) => positions[frame * joints + joint],
                            Tip::End { .. } => tip.place(&clip.skeleton, &pose),
                        };
                    }
                }
            });
        Self {
            points,
            per_frame: tips.len(),
            repeats,
        }
    }

    /// A figure that plays a clip: the joints and the far ends of its driven parts, in the drawing's axes and unit.
    pub fn of_figure(rig: &Rig, clip: &RetargetedClip) -> Self {
        let frames = clip.grounded.len();
        let driven = rig.parts.iter().enumerate();
        let driven: Vec<usize> = driven
            .filter(|(_, part)| part.drive.is_some())
            .map(|(index, _)| index)
            .collect();
        let mut points = Vec::with_capacity(frames * driven.len() * 2);
        let order = rig.order();
        let mut placed: Vec<Transform> = rig.parts.iter().map(|part| part.node).collect();
        for frame in 0..frames {
            for index in &order {
                placed[*index] = clip.node(rig, *index, frame, &placed);
            }
            for index in &driven {
                let part = &rig.parts[*index];
                for point in [part.joint, part.tip] {
                    points.push(placed[*index].apply(part.node.to_local(point)));
                }
            }
        }
        let same = |frame: usize| {
            let turns = clip.rotations.iter().flatten();
            let moves = clip.translations.iter().flatten();
            frame > 0
                && turns.clone().all(|turns| turns[frame] == turns[frame - 1])
                && moves.clone().all(|moves| moves[frame] == moves[frame - 1])
        };
        Self {
            points,
            per_frame: driven.len() * 2,
            repeats: (0..frames).map(same).collect(),
        }
    }

    /// Its poses.
    pub fn poses(&self) -> Poses<'_> {
        Poses::new(&self.points, self.per_frame).repeating(&self.repeats)
    }
}

/// The joints that have a label, and the far ends of head, hands and feet.
fn seen(clip: &Clip, anatomy: &Anatomy) -> Vec<Tip> {
    let mut tips: Vec<Tip> = anatomy.labelled().map(Tip::Joint).collect();
    let head = anatomy.head.iter().flat_map(|head| {
        let ends = 0..clip.skeleton.joints[*head].ends.len();
        ends.map(|end| Tip::End { joint: *head, end })
    });
    let limbs = anatomy.limbs.iter();
    let limbs = limbs.filter(|limb| matches!(limb.class, Class::Arm | Class::Leg));
    let ends: Vec<Tip> = head.chain(limbs.filter_map(|limb| limb.tip)).collect();
    for end in ends {
        if !tips.contains(&end) {
            tips.push(end);
        }
    }
    tips
}
