//! Decides what an output may replace.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use super::scratch::Scratch;
use super::write::{WriteError, scratch_for, write_atomic};
use super::{is_drawing, is_standard_stream};
use crate::export::Output;

/// What the formats that okoshi writes have near their beginning, and files from other programs do not.
const MARKS: [&[u8]; 5] = [
    br#""generator":"okoshi "#,
    b"Software\0okoshi ",
    b"<!-- Chart of a motion, written by okoshi ",
    b"<!-- Puppet to cut out, written by okoshi ",
    br#""format": "okoshi track""#,
];

/// How much of a file is searched for a mark, in bytes.
const MARK_RANGE: u64 = 4 << 10;

/// How an output got its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Naming {
    /// A person named this very file.
    Given,
    /// It follows from the name of the drawing.
    Derived,
}

impl Naming {
    /// How `output` was named, where the user named `named` or nothing.
    pub(crate) fn of(named: Option<&Path>, output: &Path) -> Self {
        match named {
            Some(named) if named == output => Self::Given,
            _ => Self::Derived,
        }
    }
}

/// What a file that must not be replaced is to the command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Read,
    Linked,
    Written,
}

/// The files that a command reads, and those that it wrote. None of its outputs may replace one of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Inputs(Vec<(PathBuf, Role)>);

impl Inputs {
    /// The file that the command was called with.
    pub(crate) fn of(file: &Path) -> Self {
        Self(vec![(file.to_owned(), Role::Read)])
    }

    /// Adds another file that it reads.
    #[must_use]
    pub(crate) fn reading(mut self, file: &Path) -> Self {
        self.0.push((file.to_owned(), Role::Read));
        self
    }

    /// Adds files that it links to, whether they exist or not.
    #[must_use]
    pub(crate) fn linking(mut self, files: impl IntoIterator<Item = PathBuf>) -> Self {
        let linked = files.into_iter().map(|file| (file, Role::Linked));
        self.0.extend(linked);
        self
    }

    /// Adds another output of the command.
    #[must_use]
    pub(crate) fn writing(mut self, file: &Path) -> Self {
        self.0.push((file.to_owned(), Role::Written));
        self
    }

    /// The output at `path`, if it may be written: standard output, a new file, or one that is no loss.
    ///
    /// # Errors
    /// If it is an input under any name, or a drawing; if its name is derived, also if another program wrote it.
    pub(crate) fn target(&self, path: &Path, naming: Naming) -> Result<Target, WriteError> {
        if !is_standard_stream(path) {
            self.check(path, naming)?;
        }
        Ok(Target(path.to_owned()))
    }

    fn check(&self, path: &Path, naming: Naming) -> Result<(), WriteError> {
        let refused = |why| WriteError::Loss {
            path: path.to_owned(),
            why,
            other: free_name(path),
        };
        let input = self.0.iter().find(|(input, _)| is_same_place(input, path));
        match input {
            Some((_, Role::Read)) => return Err(refused("is the file that is read")),
            Some((_, Role::Linked)) => return Err(refused("is linked by what is read")),
            Some((_, Role::Written)) => return Err(refused("is another output")),
            None => {}
        }
        // What is no plain file is not replaced, and what does not exist cannot be lost.
        let is_file = fs::metadata(path).is_ok_and(|found| found.is_file());
        if !is_file || is_own(path) {
            return Ok(());
        }
        if is_drawing(path) {
            return Err(refused("is a drawing"));
        }
        match naming {
            Naming::Given => Ok(()),
            Naming::Derived => Err(WriteError::Foreign {
                path: path.to_owned(),
                other: free_name(path),
            }),
        }
    }
}

/// A file that may be written, or standard output.
#[derive(Debug, Clone)]
pub(crate) struct Target(PathBuf);

impl Target {
    /// Writes the file through `fill`, completely or not at all.
    ///
    /// # Errors
    /// If the file cannot be written, or `fill` fails.
    pub(crate) fn write<T>(
        &self,
        fill: impl FnOnce(&mut dyn Output) -> io::Result<T>,
    ) -> Result<T, WriteError> {
        write_atomic(&self.0, fill)
    }

    /// A file beside it for what another program makes of it.
    ///
    /// # Errors
    /// If no file can be created there.
    pub(crate) fn scratch(&self) -> Result<Scratch, WriteError> {
        scratch_for(&self.0)
    }
}

/// Writes a new version of a file over the file itself, as commands do that edit it.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn rewrite(path: &Path, content: &[u8]) -> Result<(), WriteError> {
    write_atomic(path, |out| out.write_all(content))
}

/// Whether two paths lead to the same file, by links of any kind, or would if it existed.
fn is_same_place(one: &Path, other: &Path) -> bool {
    one == other
        || same_file::is_same_file(one, other).unwrap_or(false)
        || place(one).is_some_and(|one| Some(one) == place(other))
}

/// The canonical path of a file that need not exist.
fn place(path: &Path) -> Option<PathBuf> {
    let name = path.file_name()?;
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let folder = fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
    Some(folder.join(name))
}

/// Whether a file was written by okoshi, or is empty.
fn is_own(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(MARK_RANGE).read_to_end(&mut head));
    let has = |mark: &[u8]| memchr::memmem::find(&head, mark).is_some();
    read.is_ok() && (head.is_empty() || MARKS.iter().any(|mark| has(mark)))
}

/// A name for the output under which there is no file yet: `cat-2.png`.
fn free_name(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default();
    let numbered = |number: u32| {
        let mut name = stem.to_owned();
        name.push(format!("-{number}"));
        if let Some(ending) = path.extension() {
            name.push(".");
            name.push(ending);
        }
        path.with_file_name(name)
    };
    let mut names = (2..100).map(numbered);
    let free = names.find(|name| fs::symlink_metadata(name).is_err());
    free.unwrap_or_else(|| numbered(100))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(inputs: &Inputs, path: &Path, naming: Naming) -> Option<String> {
        let folder = path.parent().unwrap().display().to_string();
        let refused = inputs.target(path, naming).err()?;
        Some(refused.to_string().replace(&format!("{folder}/"), ""))
    }

    #[test]
    fn inputs_are_no_outputs() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("cat.svg"), "<svg/>").unwrap();
        fs::write(path("cat.png"), "photo").unwrap();
        fs::write(path("cat-2.png"), "other").unwrap();
        let inputs = Inputs::of(&path("cat.svg")).linking([path("cat.png"), path("later.png")]);
        for naming in [Naming::Given, Naming::Derived] {
            assert_eq!(
                message(&inputs, &path("cat.svg"), naming).unwrap(),
                "`cat.svg` is the file that is read, which would be lost; choose another name, `cat-2.svg` for example"
            );
            assert_eq!(
                message(&inputs, &path("cat.png"), naming).unwrap(),
                "`cat.png` is linked by what is read, which would be lost; choose another name, `cat-3.png` for example"
            );
            assert!(message(&inputs, &path("later.png"), naming).is_some());
            assert_eq!(message(&inputs, &path("new.png"), naming), None);
        }
        fs::create_dir(path("inner")).unwrap();
        assert!(
            inputs
                .target(&path("inner/../cat.png"), Naming::Given)
                .is_err()
        );
    }

    #[cfg(unix)]
    #[test]
    fn links_do_not_hide_an_input() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("cat.svg"), "<svg/>").unwrap();
        std::os::unix::fs::symlink("cat.svg", path("soft.glb")).unwrap();
        fs::hard_link(path("cat.svg"), path("hard.glb")).unwrap();
        let inputs = Inputs::of(&path("cat.svg"));
        for name in ["soft.glb", "hard.glb", "../x/cat.svg"] {
            let name = name.replace(
                "../x",
                &format!(
                    "../{}",
                    folder.path().file_name().unwrap().to_str().unwrap()
                ),
            );
            assert!(
                inputs.target(&path(&name), Naming::Given).is_err(),
                "{name}"
            );
        }
    }

    #[test]
    fn files_of_others_are_replaced_when_they_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let inputs = Inputs::of(&path("cat.svg"));
        for (name, content, given, derived) in [
            ("photo.png", "\u{89}PNG photo", true, false),
            ("empty.png", "", true, true),
            (
                "own.png",
                "\u{89}PNG tEXtSoftware\0okoshi 0.1.0",
                true,
                true,
            ),
            (
                "own.glb",
                r#"glTF {"asset":{"generator":"okoshi 0.1.0"#,
                true,
                true,
            ),
            (
                "foreign.glb",
                r#"glTF {"asset":{"generator":"Blender"#,
                true,
                false,
            ),
            ("dog.svg", "<svg/>", false, false),
            (
                "chart.svg",
                "<svg><!-- Chart of a motion, written by okoshi 0.1.0 -->",
                true,
                true,
            ),
            (
                "puppet.svg",
                "<svg><!-- Puppet to cut out, written by okoshi 0.1.0 -->",
                true,
                true,
            ),
        ] {
            fs::write(path(name), content).unwrap();
            let may = |naming| inputs.target(&path(name), naming).is_ok();
            assert_eq!(may(Naming::Given), given, "{name}");
            assert_eq!(may(Naming::Derived), derived, "{name}");
        }
        assert_eq!(
            message(&inputs, &path("photo.png"), Naming::Derived).unwrap(),
            "`photo.png` was not written by okoshi; rename it, or choose another name with -o, `photo-2.png` for example"
        );
    }
}
