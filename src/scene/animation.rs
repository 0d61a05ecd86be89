//! How nodes move.

use std::sync::Arc;

use glam::{DQuat, DVec3};

/// A clip: nodes that turn and move in time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Animation {
    /// Its name.
    pub name: String,
    /// How long it is. The last key may lie earlier: what it shows stands until the end.
    pub seconds: f64,
    /// What moves; a node has at most one track of each kind.
    pub tracks: Vec<Track>,
}

/// How one node turns, or where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Index of the node.
    pub node: usize,
    /// When; tracks of one figure share it.
    pub timing: Arc<Timing>,
    /// How it is then.
    pub values: Values,
}

/// The moments of keys, and what lies between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Timing {
    /// Seconds, ascending, never empty.
    pub times: Vec<f32>,
    /// What lies between keys.
    pub interpolation: Interpolation,
}

/// What lies between two keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The way from one to the other, at even speed.
    Linear,
    /// The first of the two, held.
    Step,
}

/// What a node has at each key, in its parent's frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// How it is turned: unit quaternions, each on the same side as the one before.
    Rotations(Vec<DQuat>),
    /// Where it stands, metres.
    Translations(Vec<DVec3>),
}
