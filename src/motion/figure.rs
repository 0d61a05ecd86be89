//! What motion has to know of a figure: its parts, as they are drawn.

use glam::DVec2;

/// A figure: parts that hang together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figure {
    /// The parts, in any order.
    pub parts: Vec<Part>,
}

/// A part of a figure. Points in the drawing's plane, x to the drawing's right, y up, in any one unit; the figure faces the
/// viewer.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Index of the part it hangs on. Several parts may hang on nothing.
    pub parent: Option<usize>,
    /// Where it turns.
    pub joint: DVec2,
    /// The far end along its axis.
    pub tip: DVec2,
    /// The lower left and the upper right corner of its box.
    pub bounds: [DVec2; 2],
    /// Its place in the drawing order: what is greater was drawn later and lies nearer.
    pub drawn: usize,
    /// The joints that drive it, as its string says (`Bone`); empty where it says nothing.
    pub bones: Vec<String>,
}
