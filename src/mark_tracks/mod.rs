//! Tracks of coloured marks: where the marks of a puppet are in a clip, frame by frame (docs/tracking.md, Files).
//!
//! Knows files of tracks (CSV, JSON), no pictures: `tracking` makes tracks, `performance` and `rig` read them.
//!
//! Positions are pixels from the top left corner of the picture, x to the right, y down; times are seconds.

mod bridge;
mod check;
mod color;
mod csv;
mod error;
mod json;
mod write;

#[cfg(test)]
mod tests;

use glam::DVec2;
use typed_index_collections::TiVec;

use crate::index::index_type;
use check::ticks;
use write::TICKS;

pub(crate) use bridge::bridge;
pub(crate) use check::{MAX_FRAMES, MAX_MARKS, MAX_NAME, is_name, repeated_name};
pub(crate) use color::{Hsv, hex, hue_difference, named_color, parse_hex};
pub(crate) use error::Error;
pub use error::ErrorLocation;

/// The largest file that is read, in bytes.
pub(crate) const MAX_BYTES: usize = 256 << 20;

index_type!(
    /// A mark among those of a clip.
    pub MarkId
);

/// The tracks of all marks of a clip.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MarkTracks {
    /// Width and height of the pictures, pixels.
    pub size: [u32; 2],
    /// The time of each frame in seconds, ascending, from 0.
    pub times: Vec<f64>,
    /// The marks.
    pub marks: TiVec<MarkId, MarkTrack>,
}

/// The track of one mark.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MarkTrack {
    /// Its name, distinct from the others'.
    pub name: String,
    /// Its colour: red, green, blue, sRGB.
    pub color: [u8; 3],
    /// Per frame the middle of the mark; where it was lost, a place between those where it was seen.
    pub points: Vec<DVec2>,
    /// Per frame whether it was lost.
    pub is_lost: Vec<bool>,
    /// Per frame whether it was lost because it may be in several places.
    pub is_ambiguous: Vec<bool>,
}

impl MarkTracks {
    /// The mark of this name, in small or capital letters.
    pub fn mark_named(&self, name: &str) -> Option<MarkId> {
        self.marks.position(|mark| same_name(&mark.name, name))
    }

    /// The tracks in a file of either format: JSON if its first character is a brace, otherwise CSV.
    ///
    /// The result has at least one frame and one mark, names without spaces that are distinct, as many points as frames, finite numbers,
    /// and times that ascend from 0.
    ///
    /// # Errors
    /// If the file is neither, or is not such a track.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        if bytes.len() > MAX_BYTES {
            return Err(Error::whole(
                format!("the file is larger than {} MB", MAX_BYTES >> 20),
                "track a shorter clip",
            ));
        }
        let text = std::str::from_utf8(bytes).map_err(|_| {
            Error::whole(
                "this is no track: the file is not text in UTF-8",
                "`okoshi track` makes a track of a clip; from a spreadsheet, export CSV in UTF-8",
            )
        })?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut tracks = if text.trim_start().starts_with('{') {
            json::read(text)?
        } else {
            csv::read(text)?
        };
        // Rounded as they are written: times that are told apart here stay so in every copy of the file.
        let first = tracks.times.first().copied().map_or(0.0, ticks);
        for time in &mut tracks.times {
            *time = (ticks(*time) - first) / TICKS;
        }
        Ok(tracks)
    }
}

/// Whether two names of marks are the same, but for small and capital letters.
pub(crate) fn same_name(a: &str, b: &str) -> bool {
    a.to_lowercase() == b.to_lowercase()
}
