//! The messages between a recording page and the program, as JSON.

use serde::{Deserialize, Serialize};

/// A message from a page. Places are pixels of the frame: the middle of its top left pixel is (0, 0), y down.
#[derive(Debug, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum FromCamera {
    /// A person pointed at a mark in the last frame.
    Pick { x: f64, y: f64 },
    /// A mark gets another name. Marks are counted from 0.
    Name { mark: usize, name: String },
    /// A mark is no longer tracked.
    Remove { mark: usize },
    /// The frames from here on are recorded.
    Record {},
    /// The recording ends.
    Stop {},
}

/// A message to a page.
#[derive(Debug, Serialize, PartialEq)]
#[serde(tag = "type", rename_all = "lowercase")]
pub(super) enum ToCamera {
    /// A frame was tracked.
    Seen {
        /// The number of the frame.
        sequence: u32,
        /// For each mark x, y and the radius in pixels; `None` where it is lost.
        marks: Vec<Option<[f64; 3]>>,
        /// How many frames are recorded.
        recorded: usize,
    },
    /// The marks have changed.
    Marks { marks: Vec<MarkFacts> },
    /// The track of a recording.
    Track {
        /// The file, as `okoshi track` writes it.
        file: String,
    },
    /// A message was refused.
    Error {
        /// Why.
        message: String,
        /// Whether it was a frame.
        #[serde(rename = "isFrame")]
        is_frame: bool,
    },
}

/// A mark, for the page.
#[derive(Debug, Serialize, PartialEq)]
pub(super) struct MarkFacts {
    pub(super) name: String,
    /// As `#rrggbb`; the key is that of track files.
    #[serde(rename = "colour")]
    pub(super) color: String,
}
