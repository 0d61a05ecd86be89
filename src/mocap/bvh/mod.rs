//! BVH, the text format in which motion capture is exchanged: reads what real programs write, and writes it plainly.
//!
//! Source: the Biovision hierarchy as described by Meredith and Maddock, *Motion Capture File Formats Explained* (2001). The
//! text is never in memory as a whole: it is read in blocks of complete lines, whose numbers are parsed in parallel.

mod error;
mod fields;
mod frames;
mod hierarchy;
mod line_reader;
mod motion_header;
mod number;
mod read;
mod tokens;
mod write;

#[cfg(test)]
mod corrupted_tests;
#[cfg(test)]
mod malformed_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod write_tests;

pub(crate) use error::Error;
pub use read::{Reading, read, read_bytes};
pub(crate) use write::write_frames;
pub use write::{Decimals, write};

/// The most joints of a skeleton; end sites are counted separately, with the same limit.
pub(crate) const MAX_JOINTS: usize = 1 << 16;

/// The most channels of a skeleton, that is, numbers in a frame.
pub(crate) const MAX_CHANNELS: usize = 1 << 20;

/// The most numbers of a clip, all frames together.
pub(crate) const MAX_NUMBERS: usize = 1 << 28;

/// The longest line, bytes. A line that fits into one read (4 MiB) is accepted regardless.
pub(crate) const MAX_LINE_BYTES: usize = 16 << 20;

/// The longest name of a joint, bytes.
pub(crate) const MAX_NAME_BYTES: usize = 1024;

/// The largest magnitude of a number in a file: sums of squares over a clip stay finite.
pub const MAX_MAGNITUDE: f64 = 1e12;

/// The most notes of a reading. One more says how many were left out.
pub(crate) const MAX_NOTES: usize = 100;
