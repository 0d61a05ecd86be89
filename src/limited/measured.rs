//! The points by which the speed of a motion is measured, and which frames repeat the one before.

use glam::DVec3;

use super::Poses;

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
    /// Its poses.
    pub fn poses(&self) -> Poses<'_> {
        Poses::new(&self.points, self.per_frame).repeating(&self.repeats)
    }
}
