//! Tracks of coloured marks: where the marks of a puppet are in a clip, frame by frame (motion.md, Performance).
//!
//! Positions are pixels from the top left corner of the picture, x to the right, y down; times are seconds.

use glam::DVec2;

/// The tracks of all marks of a clip.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MarkTracks {
    /// Width and height of the pictures, pixels.
    pub size: [u32; 2],
    /// The time of each frame in seconds, ascending, from 0.
    pub times: Vec<f64>,
    /// The marks.
    pub marks: Vec<MarkTrack>,
}

/// The track of one mark.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MarkTrack {
    /// Its name, distinct from the others'.
    pub name: String,
    /// Its colour: red, green, blue, sRGB.
    pub colour: [u8; 3],
    /// Per frame the middle of the mark; where it was lost, a place between those where it was seen.
    pub points: Vec<DVec2>,
    /// Per frame whether it was lost.
    pub is_lost: Vec<bool>,
}

/// temporary
#[derive(Debug, Clone, PartialEq)]
pub struct Error;
impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "x")
    }
}
impl MarkTracks {
    /// temporary
    pub fn from_bytes(_: &[u8]) -> Result<Self, Error> {
        Err(Error)
    }
}
