//! File access. No other module opens, reads, writes or renames files.

mod bounded;
mod cache;
mod folder;
mod poll;
mod read;
mod scratch;
mod search;
mod sniff;
mod target;
mod temporary;
mod text;
mod watch;
mod write;

pub(crate) use cache::write_cached;
pub use folder::FolderResolver;
pub(crate) use read::{ReadError, is_packed, open_stream, read_drawing, read_file};
pub(crate) use scratch::Scratch;
pub(crate) use search::{Stamp, below, files, is_drawing, motions, names_below, stamp};
pub(crate) use target::{Inputs, Naming, Target, rewrite};
pub use text::decode;
pub(crate) use watch::{
    ChangeDetection, Changed, FolderWatch, WatchError, event_path, event_paths, is_concerned,
};
pub(crate) use write::{WriteError, make_folder, rewrite_if, write_new};

use std::path::Path;

/// The path that stands for stdin and stdout.
const STANDARD_STREAM: &str = "-";

/// Whether a path stands for stdin or stdout.
pub(crate) fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == STANDARD_STREAM
}
