//! File access. No other module opens, reads, writes or renames files.

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

pub use cache::write_cached;
pub use folder::FolderResolver;
pub use read::{ReadError, is_packed, open_stream, read_drawing, read_file};
pub use scratch::Scratch;
pub use search::{Stamp, below, files, is_drawing, stamp};
pub use target::{Inputs, Naming, Target, rewrite};
pub use text::decode;
pub use watch::{ChangeDetection, Changed, FolderWatch, WatchError, event_path, event_paths};
pub use write::{WriteError, make_folder, write_new};

use std::path::Path;

/// The path that stands for stdin and stdout.
const STANDARD_STREAM: &str = "-";

/// Whether a path stands for stdin or stdout.
pub fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == STANDARD_STREAM
}
