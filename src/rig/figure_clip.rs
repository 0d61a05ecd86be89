//! A clip that a figure plays, as reports and editors see it.

use std::sync::Arc;

use typed_index_collections::{TiSlice, TiVec};

use crate::bind::PartId;
use crate::labels::{FigurePartId, Label, Tip};
use crate::limited::{Chosen, Cut, Exposure, KeyTimes, Measured};
use crate::mocap::{JointId, Skeleton};
use crate::performance::Filmed;
use crate::prepare::PreparedClip;
use crate::retarget::{Follow, Matching, RetargetedClip, Rig, joints_named};
use crate::scene::{Animation, Node, Scene};
use crate::source::Span;

use super::performed::Performed;
use super::tracks::{self, AnimatedNodes, Shifts};

/// A clip that a figure plays.
#[derive(Debug)]
pub struct FigureClip {
    /// The animation's name; figures that play at the same time share it.
    pub name: String,
    /// The file or the word, as the string names it. Of several motions that play in turn, that of the first one with joints; so are
    /// `parts` and `motion`.
    pub file: String,
    /// The motions that play in turn.
    pub turns: Vec<FigureTurn>,
    /// Whether it is made of key poses.
    pub is_posed: bool,
    /// Where a string asks for the clip.
    pub requested_at: Span,
    /// The root of the figure.
    pub root: PartId,
    /// What drives which part: all parts of the figure that are in the hierarchy, in drawing order.
    pub parts: Vec<PartDrive>,
    /// The motion of the file, with all its frames.
    pub motion: Arc<PreparedClip>,
    /// The omissions and holds of limited animation; `None` for full animation.
    pub cut: Option<Arc<Cut>>,
    /// Where a string limits the clip.
    pub limited_at: Option<Span>,
    /// The drawings that are chosen by hand, in order.
    pub(crate) chosen: Vec<Chosen>,
    /// Where a string chooses them.
    pub held_at: Option<Span>,
    /// The performance that the clip follows.
    pub performed: Option<Performed>,
    /// How the performance is filmed.
    pub filmed: Filmed,
    /// The parts in the order of `retargeted`, each with the number of its node: 0 is its own one, others bend it.
    pub(super) order: TiVec<FigurePartId, (PartId, usize)>,
    pub(super) retargeted: Arc<RetargetedClip>,
    pub(super) rig: Arc<Rig>,
    pub(super) animated: Arc<AnimatedNodes>,
}

/// One of the motions that play in turn in a clip.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureTurn {
    /// The file or the word.
    pub file: String,
    /// The frame of the clip with which it begins, before it is limited.
    pub first: usize,
    /// How many steps from frame to frame it takes.
    pub steps: usize,
    /// How often it is repeated in them.
    pub cycles: usize,
}

/// A part of a figure, and the joint that drives it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartDrive {
    /// The part.
    pub part: PartId,
    /// The joint; `None` for a part that follows its parent.
    pub joint: Option<JointId>,
    /// The far end of the bone or chain that it points along; `None` for a part that turns with its joint.
    pub tip: Option<Tip>,
    /// Why, for people to read.
    pub why: String,
}

impl FigureClip {
    /// The skeleton of the motion.
    pub fn skeleton(&self) -> &Skeleton {
        &self.motion.clip.skeleton
    }

    /// Seconds from one frame to the next.
    pub fn frame_time(&self) -> f64 {
        self.motion.clip.frame_time
    }

    /// How many frames the clip has before anything is omitted: those of the motion, or those of its performance.
    pub fn source_frames(&self) -> usize {
        self.retargeted.grounded.len()
    }

    /// By how much a part is turned about its joint in a frame of the source, from how it is drawn: degrees, counter-clockwise.
    #[cfg(test)]
    pub(crate) fn turn_in(
        &self,
        bindings: &crate::bind::Bindings,
        name: &str,
        frame: usize,
    ) -> f64 {
        let named = |index: &FigurePartId| {
            let (part, bone) = self.order[*index];
            bindings.parts[part].name == name && bone == 0
        };
        let index = self.rig.parts.keys().find(named).expect(name);
        let part = &self.rig.parts[index];
        let carrier = part.parent.expect("what it hangs on");
        let drawn = self.rig.parts[carrier].node.rotation.inverse() * part.node.rotation;
        let turned = self.retargeted.rotations[index].as_ref();
        let turned = turned.map_or(drawn, |turns| turns[frame]) * drawn.inverse();
        2.0 * turned.z.atan2(turned.w).to_degrees()
    }

    /// How many frames are shown.
    pub fn frames(&self) -> usize {
        match &self.cut {
            Some(cut) => cut.exposure.len(),
            None => self.source_frames(),
        }
    }

    /// How many different poses are shown.
    pub fn drawings(&self) -> usize {
        match &self.cut {
            Some(cut) => cut.exposure.drawings().count(),
            None => self.source_frames(),
        }
    }

    /// The motions that play in turn, in words, in the order in which they play: `walk 2.00 s (2 cycles)`; nothing for a single one that
    /// plays once. Limited animation keeps these times.
    pub fn turns_in_words(&self) -> Vec<String> {
        let is_single = matches!(self.turns.as_slice(), [only] if only.cycles == 1);
        let turns = self.turns.iter().filter(|_| !is_single);
        let words = turns.map(|turn| {
            let seconds = turn.steps as f64 * self.frame_time();
            match turn.cycles {
                1 => format!("{} {seconds:.2} s", turn.file),
                cycles => format!("{} {seconds:.2} s ({cycles} cycles)", turn.file),
            }
        });
        words.collect()
    }

    /// How long it is.
    pub fn seconds(&self) -> f64 {
        match &self.cut {
            Some(cut) => cut.exposure.len() as f64 * self.frame_time(),
            None => self.source_frames().saturating_sub(1) as f64 * self.frame_time(),
        }
    }

    /// Per frame of the motion whether a foot is in contact with the ground.
    pub fn grounded(&self) -> &[bool] {
        &self.retargeted.grounded
    }

    /// By how much a part is turned in a frame to make room for an arm or a foot, degrees.
    pub fn turned(&self, part: PartId, frame: usize) -> f64 {
        let index = self.order.iter().position(|own| *own == (part, 0));
        let turned = index.and_then(|index| self.retargeted.turned.raw.get(index)?.as_ref());
        turned.map_or(0.0, |turned| turned[frame].to_degrees())
    }

    /// The speed of every frame of the motion: the SSD of the points by which it is limited, in the square of drawing units.
    pub fn speeds(&self) -> Vec<f64> {
        let measured = Measured::of_figure(&self.rig, &self.retargeted);
        measured.poses().speeds()
    }

    /// What drives a part of the figure, or why nothing does; `None` for parts of other figures.
    pub fn part_drive(&self, part: PartId) -> Option<&PartDrive> {
        let index = self.parts.binary_search_by_key(&part, |drive| drive.part);
        index.ok().map(|index| &self.parts[index])
    }

    /// What happens to a part that no joint drives, and why, for people.
    pub fn undriven(&self, drive: &PartDrive) -> String {
        if drive.part == self.root {
            format!("no joint drives it: {}", drive.why)
        } else {
            format!("follows its parent: {}", drive.why)
        }
    }

    /// The frames that were omitted, and those that are covered by holding the pose before, in order.
    pub fn cut_frames(&self) -> (Vec<u32>, Vec<u32>) {
        let Some(cut) = &self.cut else {
            return (Vec::new(), Vec::new());
        };
        let mut omitted: Vec<u32> = cut.omitted.to_vec();
        let mut held: Vec<u32> = cut.held.iter().map(|hold| hold.covered).collect();
        omitted.sort_unstable();
        held.sort_unstable();
        (omitted, held)
    }

    /// The name of a joint.
    pub fn joint_name(&self, joint: JointId) -> &str {
        &self.skeleton().joints[joint].name
    }

    /// The label of a joint; `None` for helpers, fingers and faces.
    pub fn label(&self, joint: JointId) -> Option<&Label> {
        self.motion.anatomy.labels.get(joint)?.as_ref()
    }

    /// The joint that `Bone` means by a name; of several the first.
    pub fn joint_named(&self, name: &str) -> Option<JointId> {
        joints_named(self.skeleton(), name).first().copied()
    }

    /// The animation with a key for every frame of the motion, whether the clip is limited or not.
    pub fn full_animation(&self) -> Animation {
        self.animation(&self.retargeted)
    }

    /// The animation of the motion as it was before it was performed and limited; `None` for a clip that is neither.
    fn original(&self) -> Option<Animation> {
        match &self.performed {
            Some(performed) => Some(self.animation(&performed.before)),
            None => self.cut.as_ref().map(|_| self.full_animation()),
        }
    }

    /// The animation of what is shown, with its camera if it has one.
    pub(super) fn add_to(&self, scene: &mut Scene) {
        let frame_time = self.frame_time();
        let (sheet, frames) = (self.exposure(), self.source_frames());
        let keys = KeyTimes::new(sheet, frames, frame_time);
        let every = KeyTimes::of_shown(sheet, frames, frame_time);
        let shown = self.shown_frames();
        let shifts = self.filmed.shifts().map(|ways| Shifts {
            keys: &every,
            shown: &shown,
            ways,
        });
        let mut animation = self.animated.animation(
            &self.name,
            &self.order,
            &self.retargeted,
            &keys,
            shifts.as_ref(),
        );
        self.filmed
            .add_camera(&self.animated.world, &every, &mut animation, scene);
        tracks::add(&mut scene.animations, animation);
    }

    /// Per shown frame the frame of the clip.
    fn shown_frames(&self) -> Vec<usize> {
        Exposure::shown(self.exposure(), self.source_frames())
    }

    fn exposure(&self) -> Option<&Exposure> {
        self.cut.as_ref().map(|cut| &cut.exposure)
    }

    /// The animation of a motion of the figure with a key for each of its frames.
    fn animation(&self, motion: &RetargetedClip) -> Animation {
        let keys = KeyTimes::full(motion.grounded.len(), self.frame_time());
        self.animated
            .animation(&self.name, &self.order, motion, &keys, None)
    }
}

/// The nodes of a scene without their meshes, and the animations of clips before they were performed and limited, under the names that
/// they have in the scene. `None` if no clip is either.
pub(crate) fn originals(scene: &Scene, clips: &[FigureClip]) -> Option<Scene> {
    let mut animations = Vec::new();
    for original in clips.iter().filter_map(FigureClip::original) {
        tracks::add(&mut animations, original);
    }
    if animations.is_empty() {
        return None;
    }
    let bare = |node: &Node| Node {
        mesh: None,
        camera: None,
        provenance: None,
        ..node.clone()
    };
    Some(Scene {
        nodes: scene.nodes.iter().map(bare).collect(),
        roots: scene.roots.clone(),
        animations,
        ..Scene::default()
    })
}

/// What drives these parts of the drawing, which are those of the matched figure, in the same order; and which of them swing.
pub(super) fn part_drives(
    parts: &TiSlice<FigurePartId, PartId>,
    matching: &Matching,
    swings: impl Fn(PartId) -> bool,
) -> Vec<PartDrive> {
    let drives = parts.iter().zip(&matching.parts);
    let drives = drives.map(|(part, matched)| PartDrive {
        part: *part,
        joint: matched.drive.map(|drive| drive.joint),
        // The far end of the whole part, if it bends.
        tip: matched.end_drive().and_then(|drive| match drive.follow {
            Follow::Direction => drive.tip,
            Follow::Change | Follow::Trunk { .. } | Follow::Sole => None,
        }),
        why: if swings(*part) {
            format!("{}; it swings", matched.why)
        } else {
            matched.why.clone()
        },
    });
    let mut drives: Vec<PartDrive> = drives.collect();
    drives.sort_by_key(|drive| drive.part);
    drives
}

/// A clip's name by the files and words of the motions that play in turn: `walk-wave-idle`. A long list is cut off.
pub(super) fn name_of<'a>(links: impl Iterator<Item = &'a str>) -> String {
    const MAX_NAMES: usize = 4;
    let stems: Vec<&str> = links.take(MAX_NAMES).map(stem).collect();
    stems.join("-")
}

/// A clip's name by its file: the text between the last slash and the last dot.
pub(super) fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}

/// A name that no clip of the figure has yet: the wanted one, followed by a number if necessary.
pub(super) fn free_name(clips: &[FigureClip], root: PartId, wanted: &str) -> String {
    let is_free = |name: &str| {
        !clips
            .iter()
            .any(|clip| clip.root == root && clip.name == name)
    };
    if is_free(wanted) {
        return wanted.to_owned();
    }
    let numbered = (2..).map(|number| format!("{wanted}-{number}"));
    let mut free = numbered.filter(|name| is_free(name));
    free.next().unwrap_or_default()
}
