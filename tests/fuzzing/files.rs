//! The repository's files that inputs are made from.

use std::fs;
use std::path::{Path, PathBuf};

/// The longest drawing that is an input, in bytes: longer ones take so long that little else is tried.
pub(super) const LONGEST: usize = 8 << 10;

/// The repository, for the tests and for the package in `fuzz/`.
pub(super) fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = here
        .ancestors()
        .find(|folder| folder.join("tests/cases").is_dir());
    root.expect("the cases are above or beside the package")
}

/// The files in a folder of the repository whose names end in `ending`, in order.
pub(super) fn ending(folder: &str, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).expect("a folder");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.to_string_lossy().ends_with(ending))
        .collect();
    files.sort();
    files
}

/// The bytes of a file of the repository.
pub(super) fn read(path: impl AsRef<Path>) -> Vec<u8> {
    let path = root().join(path);
    fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The folders of the cases.
pub(super) fn case_folders() -> Vec<PathBuf> {
    let mut folders = ending("tests/cases", "");
    folders.retain(|path| path.is_dir());
    folders
}

/// The drawings of the cases, without the long ones.
pub(super) fn cases() -> Vec<String> {
    let folders = case_folders().into_iter();
    let drawings = folders.map(|folder| read(folder.join("drawing.svg")));
    drawings
        .map(|bytes| String::from_utf8(bytes).expect("a case is text"))
        .filter(|text| text.len() <= LONGEST)
        .collect()
}

/// The drawings of the cases, each followed by one of these sequences of bytes in turn.
pub(super) fn cases_with(sequences: &[&[u8]]) -> Vec<Vec<u8>> {
    let cases = cases().into_iter().zip(sequences.iter().cycle());
    cases
        .map(|(case, sequence)| [case.as_bytes(), sequence].concat())
        .collect()
}
