//! Clips: keyframe animations of nodes.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::NodeId;

/// A clip: nodes that turn and move in time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Animation {
    /// Its name.
    pub name: String,
    /// Its tracks; a node has at most one of each kind.
    pub tracks: Vec<Track>,
}

impl Animation {
    /// Its duration in seconds: the time of its last key, because readers of glTF files know no other.
    pub fn seconds(&self) -> f64 {
        let ends = self
            .tracks
            .iter()
            .filter_map(|track| track.timing.times.last());
        ends.copied().fold(0.0, f32::max).into()
    }
}

/// The rotations, the translations or the weights of a node.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The node.
    pub node: NodeId,
    /// The times of the keys, shared by the tracks of a figure.
    pub timing: Arc<Timing>,
    /// The values at the keys.
    pub values: Values,
}

/// The times of keys, and the interpolation between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Seconds, ascending, never empty.
    pub times: Vec<f32>,
    /// The interpolation between keys.
    pub interpolation: Interpolation,
}

/// The interpolation between two keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolation {
    /// Linear; spherical for rotations.
    Linear,
    /// The value of the first key is held.
    Step,
}

/// The values of a node at each key, in its parent's frame.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Values {
    /// Rotations as unit quaternions, each in the same hemisphere as the one before.
    Rotations(Arc<Vec<DQuat>>),
    /// Translations, metres.
    Translations(Vec<DVec3>),
    /// Per key the weight of each morph target of the node's mesh.
    Weights(Vec<Vec<f32>>),
}

impl Values {
    /// The number of keys.
    pub fn len(&self) -> usize {
        match self {
            Self::Rotations(rotations) => rotations.len(),
            Self::Translations(translations) => translations.len(),
            Self::Weights(weights) => weights.len(),
        }
    }

    /// Whether there are no keys.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
