//! Where the speed of a clip is measured.

use glam::DVec3;
use rayon::prelude::*;

use crate::labels::{Anatomy, Class, Tip};
use crate::limited::Measured;
use crate::mocap::{Clip, Pose};

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
        let repeats = (0..clip.frames).map(repeat).collect();
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
        let mut points = vec![DVec3::ZERO; clip.frames * tips.len()];
        points
            .par_chunks_mut(GRAIN * tips.len())
            .enumerate()
            .for_each(|(chunk, points)| {
                let mut pose = Pose::with_capacity(joints);
                for (frame, points) in points.chunks_mut(tips.len()).enumerate() {
                    let frame = chunk * GRAIN + frame;
                    if ends {
                        clip.pose_into(frame, &mut pose);
                    }
                    for (point, tip) in points.iter_mut().zip(&tips) {
                        *point = match tip {
                            Tip::Joint(joint) => positions[frame * joints + usize::from(*joint)],
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
}

/// The joints that have a label, and the far ends of head, hands and feet.
fn seen(clip: &Clip, anatomy: &Anatomy) -> Vec<Tip> {
    let mut tips: Vec<Tip> = anatomy.labeled().map(Tip::Joint).collect();
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
