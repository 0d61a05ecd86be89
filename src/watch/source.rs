//! The file that a drawing is read from: its own, or a copy with changes that are not saved yet.

use std::path::{Path, PathBuf};

use crate::disk::{Stamp, stamp};

/// A drawing's file, and the copy that an editor writes of what is on its canvas, if there is one. The one that was written
/// last is read. Modification times of the two are not compared with each other, as their file systems may have different clocks.
#[derive(Debug)]
pub(super) struct Source {
    /// The drawing's own file.
    pub(super) saved: PathBuf,
    unsaved: Option<PathBuf>,
    /// The state of both files when the drawing was last read.
    seen: Option<[Option<Stamp>; 2]>,
    reads_unsaved: bool,
}

impl Source {
    /// The source of a drawing that was not read yet. It begins with the copy.
    pub(super) fn new(saved: &Path, unsaved: Option<&Path>) -> Self {
        Self {
            saved: saved.to_owned(),
            unsaved: unsaved.map(Path::to_owned),
            seen: None,
            reads_unsaved: unsaved.is_some(),
        }
    }

    /// All files that may be read.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        [Some(&self.saved), self.unsaved.as_ref()]
            .into_iter()
            .flatten()
            .map(PathBuf::as_path)
    }

    /// The file to read now.
    pub(super) fn newest(&mut self) -> &Path {
        let Some(unsaved) = &self.unsaved else {
            return &self.saved;
        };
        let now = [stamp(&self.saved), stamp(unsaved)];
        let [saved, copied] = self
            .seen
            .map_or([false, true], |seen| [seen[0] != now[0], seen[1] != now[1]]);
        self.seen = Some(now);
        // A copy that is gone has nothing to show.
        self.reads_unsaved = now[1].is_some() && (copied || (self.reads_unsaved && !saved));
        if self.reads_unsaved {
            unsaved
        } else {
            &self.saved
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_was_written_last_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let [saved, copy] = ["saved.svg", "copy.svg"].map(|name| folder.path().join(name));
        let write = |path: &Path, text: &str| fs::write(path, text).unwrap();
        write(&copy, "on the canvas");
        write(&saved, "saved before, but written later");
        let mut source = Source::new(&saved, Some(&copy));
        for _ in 0..2 {
            assert_eq!(source.newest(), copy);
        }
        write(&saved, "saved");
        for _ in 0..2 {
            assert_eq!(source.newest(), saved);
        }
        write(&copy, "another canvas");
        assert_eq!(source.newest(), copy);
        fs::remove_file(&copy).unwrap();
        assert_eq!(source.newest(), saved);
        assert_eq!(Source::new(&saved, Some(&copy)).newest(), saved);
        assert_eq!(Source::new(&saved, None).newest(), saved);
    }
}
