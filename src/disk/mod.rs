//! File access. No other module opens, reads, writes or renames files.

mod cache;
mod folder;
mod poll;
mod read;
mod search;
mod sniff;
mod text;
mod watch;
mod write;

pub use cache::write_cached;
pub use folder::{FolderResolver, LINK_LIMIT};
pub use read::{
    DRAWING_LIMIT, ReadError, UNPACKED_LIMIT, is_packed, open_stream, read_drawing, read_file,
};
pub use search::{Below, Stamp, below, is_drawing, stamp};
pub use sniff::NotADrawing;
pub use text::{Decode, decode};
pub use watch::{ChangeDetection, Changed, FolderWatch, WatchError, event_path, event_paths};
pub use write::{WriteError, make_folder, write_atomic, write_new};

use std::path::Path;

/// The path that stands for stdin and stdout.
const STANDARD_STREAM: &str = "-";

/// Whether two paths refer to the same existing file.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| std::fs::canonicalize(path).ok();
    one == other || place(one).is_some_and(|one| place(other) == Some(one))
}

/// Whether a path stands for stdin or stdout.
pub fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == STANDARD_STREAM
}
