//! Lists the files below a folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The limits of a listing: enough for any project with drawings, and fast in a folder that is something else.
const MAX_FILES: usize = 20_000;
const MAX_DEPTH: usize = 8;

/// Folders that contain only generated files.
const SKIPPED: &[&str] = &["node_modules", "target"];

/// The contents of a folder and its subfolders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Below {
    /// The files, sorted by name, those in subfolders last.
    pub files: Vec<PathBuf>,
    /// The folders; the folder itself comes first.
    pub folders: Vec<PathBuf>,
}

/// The files and folders below a folder, without hidden ones and symbolic links.
pub fn below(folder: &Path) -> Below {
    let mut found = Below::default();
    let mut folders = vec![(folder.to_owned(), 0)];
    let mut seen = 0;
    while let Some((folder, depth)) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        let mut entries: Vec<_> = entries.flatten().take(MAX_FILES - seen).collect();
        entries.sort_by_key(fs::DirEntry::file_name);
        seen += entries.len();
        found.folders.push(folder);
        let mut inner = vec![];
        for entry in entries {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            let Ok(kind) = entry.file_type() else {
                continue;
            };
            if name.starts_with('.') || SKIPPED.contains(&&*name) {
                continue;
            }
            if kind.is_file() {
                found.files.push(entry.path());
            } else if kind.is_dir() && depth < MAX_DEPTH {
                inner.push((entry.path(), depth + 1));
            }
        }
        folders.extend(inner.into_iter().rev());
    }
    found
}

/// Whether a file is a drawing, judged by its name.
pub fn is_drawing(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    let hidden = name.is_none_or(|name| name.starts_with('.'));
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    !hidden && ending.is_some_and(|ending| ending == "svg" || ending == "svgz")
}

/// The length and modification time of a file; if they are equal, the file counts as unchanged.
pub type Stamp = (u64, SystemTime);

/// The stamp of a file; `None` if it does not exist.
pub fn stamp(path: &Path) -> Option<Stamp> {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_in_order() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "b.svg",
            "a/c.png",
            "a/d/e.svg",
            ".hidden/f.svg",
            "node_modules/g.svg",
        ] {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let below_it = below(folder.path());
        assert_eq!(below_it.folders.len(), 3);
        let found: Vec<_> = below_it
            .files
            .iter()
            .map(|path| {
                path.strip_prefix(folder.path())
                    .unwrap()
                    .display()
                    .to_string()
                    .replace('\\', "/")
            })
            .collect();
        assert_eq!(found, ["b.svg", "a/c.png", "a/d/e.svg"]);
        assert_eq!(below(&folder.path().join("nowhere")), Below::default());
    }
}
