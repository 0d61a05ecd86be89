//! What lies in a folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// How many files are looked at in all, and how deep folders are entered: enough for any project of drawings, and
/// quickly done in a folder that is none.
const MOST_FILES: usize = 20_000;
const DEEPEST: usize = 8;

/// Folders that hold no work of people.
const PASSED_OVER: &[&str] = &["node_modules", "target"];

/// What lies below a folder.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Below {
    /// The files, in the order of their names, those of inner folders last.
    pub files: Vec<PathBuf>,
    /// The folders, itself the first.
    pub folders: Vec<PathBuf>,
}

/// The files and folders below a folder. Hidden ones and links are passed over.
pub fn below(folder: &Path) -> Below {
    let mut found = Below::default();
    let mut folders = vec![(folder.to_owned(), 0)];
    let mut seen = 0;
    while let Some((folder, depth)) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        let mut entries: Vec<_> = entries.flatten().take(MOST_FILES - seen).collect();
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
            if name.starts_with('.') || PASSED_OVER.contains(&&*name) {
                continue;
            }
            if kind.is_file() {
                found.files.push(entry.path());
            } else if kind.is_dir() && depth < DEEPEST {
                inner.push((entry.path(), depth + 1));
            }
        }
        folders.extend(inner.into_iter().rev());
    }
    found
}

/// Whether a file is taken for a drawing, by its name.
pub fn is_drawing(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    let hidden = name.is_none_or(|name| name.starts_with('.'));
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    !hidden && ending.is_some_and(|ending| ending == "svg" || ending == "svgz")
}

/// What tells that a file is the one that it was: its length and when it was written.
pub type Stamp = (u64, SystemTime);

/// The stamp of a file that is there.
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
