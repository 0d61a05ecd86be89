//! What a clip of a figure is, for reports.

use std::sync::Arc;

use crate::motion::labels::{Anatomy, Label};
use crate::motion::limited::Cut;
use crate::motion::matching::{Matching, joints_named};
use crate::motion::skeleton::Skeleton;
use crate::scene::{Animation, Node, Scene};
use crate::source::Span;

use super::tracks;

/// A clip that a figure plays.
#[derive(Debug)]
pub struct Shot {
    /// The animation's name; figures that play at once share it.
    pub name: String,
    /// The file, as the string names it.
    pub file: String,
    /// Where a string asks for it.
    pub asked: Span,
    /// The part that all others of the figure hang on, an index into the bindings' parts.
    pub root: usize,
    /// What drives which part; all parts of the figure that are in the hierarchy, in drawing order.
    pub parts: Vec<Driven>,
    /// What the file moves.
    pub skeleton: Arc<Skeleton>,
    /// What its joints are.
    pub anatomy: Arc<Anatomy>,
    /// Seconds from a frame to the next.
    pub frame_time: f64,
    /// Per frame of the clip, before anything was cut, how fast it is: the sum of the squares of the joints' steps from the
    /// frame before, squares of the file's unit.
    pub speeds: Arc<[f64]>,
    /// How it was cut; `None` for full animation.
    pub cut: Option<Arc<Cut>>,
    /// Where a string says how it is cut; `None` for full animation.
    pub limited: Option<Span>,
    /// The animation as it was before it was cut.
    pub full: Option<Animation>,
}

/// A part of a figure, and what drives it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Driven {
    /// Index of the part.
    pub part: usize,
    /// Index of the joint; `None` for a part that follows its parent.
    pub joint: Option<usize>,
    /// Why.
    pub why: String,
}

impl Shot {
    /// How many frames are shown.
    pub fn frames(&self) -> usize {
        match &self.cut {
            Some(cut) => cut.exposure.len(),
            None => self.speeds.len(),
        }
    }

    /// How many poses are shown.
    pub fn drawings(&self) -> usize {
        match &self.cut {
            Some(cut) => cut.exposure.drawings().count(),
            None => self.speeds.len(),
        }
    }

    /// How long it is.
    pub fn seconds(&self) -> f64 {
        match &self.cut {
            Some(cut) => cut.exposure.len() as f64 * self.frame_time,
            None => self.speeds.len().saturating_sub(1) as f64 * self.frame_time,
        }
    }

    /// What drives a part of the figure, or why nothing does; `None` for parts that are not of it.
    pub fn driven(&self, part: usize) -> Option<&Driven> {
        let place = self.parts.binary_search_by_key(&part, |driven| driven.part);
        place.ok().map(|place| &self.parts[place])
    }

    /// The name of a joint.
    pub fn joint_name(&self, joint: usize) -> &str {
        &self.skeleton.joints[joint].name
    }

    /// What a joint is; `None` for helpers, fingers and faces.
    pub fn label(&self, joint: usize) -> Option<&Label> {
        self.anatomy.labels.get(joint)?.as_ref()
    }

    /// The joint that `Bone` means by a name; of several the first.
    pub fn joint_named(&self, name: &str) -> Option<usize> {
        joints_named(&self.skeleton, name).first().copied()
    }
}

/// The nodes of a scene without what they show, and the clips of limited animation as they were before they were cut, under the
/// names that they have in the scene. `None` if no clip was cut.
pub fn originals(scene: &Scene, shots: &[Shot]) -> Option<Scene> {
    let mut animations = Vec::new();
    for full in shots.iter().filter_map(|shot| shot.full.as_ref()) {
        tracks::add(&mut animations, full.clone());
    }
    if animations.is_empty() {
        return None;
    }
    let bare = |node: &Node| Node {
        mesh: None,
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

/// What drives these parts of the drawing, which are those of the figure that was matched.
pub(super) fn driven(parts: &[usize], matching: &Matching) -> Vec<Driven> {
    let driven = parts.iter().enumerate().map(|(index, part)| {
        let drive = matching.drives[index].as_ref();
        Driven {
            part: *part,
            joint: drive.map(|drive| drive.joint),
            why: drive.map_or_else(
                || matching.follows[index].clone(),
                |drive| drive.why.clone(),
            ),
        }
    });
    let mut driven: Vec<Driven> = driven.collect();
    driven.sort_by_key(|driven| driven.part);
    driven
}

/// The name that a clip has by its file: what stands between the last slash and the last dot.
pub(super) fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    match name.rsplit_once('.') {
        Some((stem, _)) if !stem.is_empty() => stem,
        _ => name,
    }
}

/// A name that no clip of the figure has yet: the wanted one, with a number behind it if need be.
pub(super) fn free_name(shots: &[Shot], root: usize, wanted: &str) -> String {
    let is_free = |name: &str| {
        !shots
            .iter()
            .any(|shot| shot.root == root && shot.name == name)
    };
    if is_free(wanted) {
        return wanted.to_owned();
    }
    let numbered = (2..).map(|number| format!("{wanted}-{number}"));
    let mut free = numbered.filter(|name| is_free(name));
    free.next().unwrap_or_default()
}
