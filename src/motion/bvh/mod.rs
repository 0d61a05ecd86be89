//! BVH, the text format that motion capture is exchanged in: read as it is found in the wild, and written plainly.
//!
//! Source: the Biovision hierarchy as described by Meredith and Maddock, *Motion Capture File Formats Explained* (2001). The
//! text is never whole in memory: it passes by in blocks of whole lines, whose numbers are read in parallel.

mod error;
mod fields;
mod header;
mod number;
mod read;
mod rows;
mod source;
mod timing;
mod words;
mod write;

#[cfg(test)]
mod damaged;
#[cfg(test)]
mod malformed;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod written;

pub use error::{Error, Note};
pub use read::{Reading, read, read_bytes};
pub use timing::DEFAULT_FRAME_TIME;
pub use write::{Decimals, write, write_shown};

/// How many joints a skeleton may have; bones' ends are counted by themselves, to the same limit.
pub const MOST_JOINTS: usize = 1 << 16;

/// How many numbers a frame may have.
pub const MOST_CHANNELS: usize = 1 << 20;

/// How many numbers a clip may have, all frames together.
pub const MOST_NUMBERS: usize = 1 << 28;

/// How long a line may be, bytes. Lines as long as a block of reading (4 MiB) are read whatever this says.
pub const LONGEST_LINE: usize = 16 << 20;

/// How long a joint's name may be, bytes.
pub const LONGEST_NAME: usize = 1024;

/// The largest number that may stand in a file, in either direction: squares of it, summed over a clip, stay finite.
pub const LARGEST: f64 = 1e12;

/// How many notes a reading has at most. One more tells how many were left out.
pub const MOST_NOTES: usize = 100;
