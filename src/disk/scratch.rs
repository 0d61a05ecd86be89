//! Files that another program writes, of which nothing remains.

use std::io::{self, Seek as _, Write};
use std::path::{Path, PathBuf};

use super::temporary::Temporary;

/// A file for the output of another program. It vanishes with this value, or with the program.
#[derive(Debug)]
pub(crate) struct Scratch(Temporary);

impl Scratch {
    /// An empty file in a folder.
    ///
    /// # Errors
    /// If it cannot be created there.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        Temporary::new(folder).map(Self)
    }

    /// A path by which other programs can open it while this program runs.
    pub(crate) fn path(&self) -> PathBuf {
        self.0.path()
    }

    /// Copies what the other program wrote.
    ///
    /// # Errors
    /// If it cannot be read, or `out` cannot be written.
    pub(crate) fn copy_to(&mut self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        let file = self.0.file();
        file.rewind()?;
        io::copy(file, out).map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn another_program_writes_it_and_nothing_remains() {
        let folder = tempfile::tempdir().unwrap();
        let mut scratch = Scratch::new(folder.path()).unwrap();
        fs::write(scratch.path(), b"a longer text").unwrap();
        fs::write(scratch.path(), b"a text").unwrap();
        let mut out = Vec::new();
        scratch.copy_to(&mut out).unwrap();
        assert_eq!(out, b"a text");
        drop(scratch);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
