//! Lists the files below a folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::diagnostic::nearest_word;

/// The limits of a listing: enough for any project with drawings, and fast in a folder that is something else.
const MAX_FILES: usize = 20_000;
const MAX_DEPTH: usize = 8;

/// Folders that contain only generated files.
const SKIPPED: &[&str] = &["node_modules", "target"];

/// The contents of a folder and its subfolders.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Below {
    /// The files, sorted by name, those in subfolders last.
    pub files: Vec<PathBuf>,
    /// The folders; the folder itself comes first.
    pub folders: Vec<PathBuf>,
}

/// The files and folders below a folder, without hidden ones and symbolic links.
pub(crate) fn below(folder: &Path) -> Below {
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

/// The files below a folder as drawings name them: by their paths from there, with `/` between names. What is not Unicode has no such name.
pub(crate) fn names_below(folder: &Path) -> Vec<String> {
    let files = below(folder).files.into_iter();
    let names = files.filter_map(|file| {
        let names = file.strip_prefix(folder).ok()?.iter();
        let names: Option<Vec<&str>> = names.map(|name| name.to_str()).collect();
        Some(names?.join("/"))
    });
    names.collect()
}

/// Whether a file is a drawing, judged by its name.
pub(crate) fn is_drawing(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy());
    let hidden = name.is_none_or(|name| name.starts_with('.'));
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    !hidden && ending.is_some_and(|ending| ending == "svg" || ending == "svgz")
}

/// The drawings in a folder, sorted by name.
pub(super) fn drawings(folder: &Path) -> Vec<PathBuf> {
    files(folder, is_drawing)
}

/// The names of the motion files in a folder, sorted, as far as a drawing can name them.
pub(crate) fn motions(folder: &Path) -> Vec<String> {
    let is_motion = |file: &Path| {
        let ending = file.extension().map(|ending| ending.to_ascii_lowercase());
        ending.is_some_and(|ending| ending == "bvh")
    };
    let files = files(folder, is_motion).into_iter();
    let names = files.filter_map(|file| Some(file.file_name()?.to_str()?.to_owned()));
    names.filter(|name| !name.contains('"')).collect()
}

/// The plain and other files in a folder that are wanted, sorted by name. The folder of a bare file name is the current one.
pub(crate) fn files(folder: &Path, wanted: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let folder = match folder {
        bare if bare == Path::new("") => Path::new("."),
        folder => folder,
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.take(MAX_FILES).map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.filter(|file| wanted(file)).collect();
    files.sort();
    files
}

/// The file in the folder of `path` that has the most similar name, if one has a similar name: a file of the same kind, or
/// else a drawing.
pub(super) fn similar(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let ending = |path: &Path| path.extension().map(|ending| ending.to_ascii_lowercase());
    let stem = |path: &Path| Some(path.file_stem()?.to_string_lossy().into_owned());
    let asked = stem(path)?;
    let nearest = |files: Vec<PathBuf>| {
        let stems: Vec<String> = files.iter().filter_map(|path| stem(path)).collect();
        let nearest = nearest_word(&asked, stems.iter().map(String::as_str))?;
        let mut files = files.iter();
        let found = files.find(|path| stem(path).as_deref() == Some(nearest))?;
        Some(path.with_file_name(found.file_name()?))
    };
    let same_kind = files(folder, |file| {
        ending(file).is_some() && ending(file) == ending(path)
    });
    let is_motion = ending(path).is_some_and(|ending| ending == "bvh");
    nearest(same_kind).or_else(|| nearest(drawings(folder)).filter(|_| !is_motion))
}

/// The length and modification time of a file; if they are equal, the file counts as unchanged.
pub(crate) type Stamp = (u64, SystemTime);

/// The stamp of a file; `None` if it does not exist.
pub(crate) fn stamp(path: &Path) -> Option<Stamp> {
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
