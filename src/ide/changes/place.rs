//! Where a part is in the model, so that it can be taken hold of there.

use glam::{DQuat, DVec3};
use serde::Serialize;

use super::Analysis;
use crate::bind::{PartId, PartKind};

/// Where a part is. Directions are those in the frame of its node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlaceForm {
    /// Metres in a drawing unit.
    pub meters: f64,
    /// The direction that is right in the drawing.
    pub right: [f64; 3],
    /// The one that is up.
    pub up: [f64; 3],
    /// The one towards the viewer.
    pub front: [f64; 3],
    /// The joint, drawing units.
    pub joint: [f64; 2],
    /// The points that `Origin` has words for.
    pub points: Vec<Point>,
}

/// A point that `Origin` has a word for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// The word.
    pub word: &'static str,
    /// Where it is, drawing units.
    pub at: [f64; 2],
}

impl Analysis {
    /// Where a part is in the model; `None` for one that has no node of its own.
    pub(super) fn place_form(&self, index: PartId) -> Option<PlaceForm> {
        let bindings = self.bindings();
        let part = &bindings.parts[index];
        if part.kind != PartKind::Main {
            return None;
        }
        let turn = self.rotation_of(&part.name)?;
        let world = bindings.settings.axes;
        let seen = |way: DVec3| (turn.inverse() * (world * way)).to_array();
        let measure = part.node_measure();
        let parent = part
            .parent
            .map(|parent| bindings.parts[parent].node_measure().center);
        let [start, end] = measure.sorted_ends(parent);
        let points = [("center", measure.center), ("start", start), ("end", end)];
        Some(PlaceForm {
            meters: bindings.settings.meters(),
            right: seen(DVec3::X),
            up: seen(DVec3::Y),
            front: seen(DVec3::Z),
            joint: part.origin.to_array(),
            points: points
                .map(|(word, at)| Point {
                    word,
                    at: at.to_array(),
                })
                .to_vec(),
        })
    }

    /// How the node of a part is turned in the world, at rest.
    fn rotation_of(&self, name: &str) -> Option<DQuat> {
        let nodes = &self.compiled.scene.nodes;
        let mut at = nodes
            .iter_enumerated()
            .find(|(_, node)| node.name == name)?
            .0;
        let mut turn = nodes[at].rotation;
        // A child comes after its parent.
        while let Some((above, node)) = nodes
            .iter_enumerated()
            .find(|(above, node)| *above < at && node.children.contains(&at))
        {
            turn = node.rotation * turn;
            at = above;
        }
        Some(turn)
    }
}
