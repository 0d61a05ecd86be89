//! A figure as it is drawn: its parts, without what they look like.

use glam::DVec2;
use typed_index_collections::TiVec;

use super::Facing;
use crate::index::index_type;

index_type!(
    /// A part of a figure.
    pub FigurePartId
);

/// A figure: connected parts.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figure {
    /// The parts, in any order.
    pub parts: TiVec<FigurePartId, FigurePart>,
    /// The direction that it faces, if a string says so.
    pub facing: Option<Facing>,
}

/// A part of a figure. Points are in the drawing's plane, x to the drawing's right, y up, in any one unit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FigurePart {
    /// Its name.
    pub name: String,
    /// Whether nobody gave it that name: it hangs on whatever is nearest.
    pub is_automatic: bool,
    /// Its parent. Several parts may have none.
    pub parent: Option<FigurePartId>,
    /// Where it turns.
    pub joint: DVec2,
    /// The far end of its axis.
    pub tip: DVec2,
    /// The near end of its axis, if that is not its joint.
    pub near_end: Option<DVec2>,
    /// Its extent across its axis.
    pub width: f64,
    /// The lower left and the upper right corner of its bounding box.
    pub bounds: [DVec2; 2],
    /// The corners of the bounding box of its main shape.
    pub main_shape: [DVec2; 2],
    /// The bounding boxes of the pieces of its main shape, if that has several.
    pub pieces: Vec<[DVec2; 2]>,
    /// Its other shapes.
    pub details: Vec<Detail>,
    /// Its place in the drawing order: parts with a greater number were drawn later and lie nearer to the viewer.
    pub drawing_order: usize,
    /// The joints that its string names with `Bone`; empty if it names none.
    pub bones: Vec<String>,
    /// How many bones it has inside: 1 if it is rigid; 0 means the same.
    pub bends: usize,
    /// What its string says with `Carry`, if it is a limb; `None` if it says nothing.
    pub carry: Option<Carry>,
}

/// A shape of a part that is not its main one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Detail {
    /// Its name; empty if it has none.
    pub name: String,
    /// The lower left and the upper right corner of its bounding box.
    pub bounds: [DVec2; 2],
    /// Those of its pieces, if it has several.
    pub pieces: Vec<[DVec2; 2]>,
    /// Its colour, or the mean of its paint.
    pub color: [u8; 3],
}

impl Detail {
    /// The bounding boxes of its pieces.
    pub(super) fn boxes(&self) -> &[[DVec2; 2]] {
        match self.pieces.as_slice() {
            [] => std::slice::from_ref(&self.bounds),
            pieces => pieces,
        }
    }
}

/// What a limb takes over from a motion, as a string says with `Carry`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carry {
    /// The direction of its bone.
    Direction,
    /// How far its bone turns.
    Change,
}
