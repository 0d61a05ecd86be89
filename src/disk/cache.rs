//! Files for other programs, in the user's cache folder. They may be deleted at any time.

use std::fs;
use std::io;
use std::path::PathBuf;

use etcetera::BaseStrategy as _;

use super::write::write_atomic;
use crate::export::Output;

/// Writes a file into okoshi's folder in the user's cache, atomically, and returns its path; `None` if the user has no
/// cache folder.
pub(crate) fn write_cached(
    name: &str,
    fill: impl FnOnce(&mut dyn Output) -> io::Result<()>,
) -> Option<PathBuf> {
    let folder = etcetera::choose_base_strategy()
        .ok()?
        .cache_dir()
        .join("okoshi");
    fs::create_dir_all(&folder).ok()?;
    let path = folder.join(name);
    write_atomic(&path, fill).ok()?;
    Some(path)
}
