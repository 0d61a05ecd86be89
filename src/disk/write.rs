//! Writes outputs completely or not at all.
//!
//! An output keeps its permissions and symbolic links, and can be a device or a pipe, which crates for atomic writes do
//! not cover.

use std::fs;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

use super::bounded::{self, Bounded};
use super::scratch::Scratch;
use super::temporary::Temporary;
use crate::export::{Output, SeekableOutput};

/// Why an output cannot be written. Each message names the file and says how to fix it.
#[derive(Debug, thiserror::Error)]
pub(crate) enum WriteError {
    /// A folder instead of a file.
    #[error("`{}` is a folder; name a file in it", .0.display())]
    Folder(PathBuf),
    /// The file's folder does not exist.
    #[error("the folder `{}` is not there; create it or choose another with -o", .0.display())]
    NoFolder(PathBuf),
    /// No permission to write in the folder.
    #[error("no permission to write in the folder `{}`; choose another with -o", .0.display())]
    FolderDenied(PathBuf),
    /// The file exists and is write-protected.
    #[error("`{}` is write-protected; change that or choose another file with -o", .0.display())]
    Protected(PathBuf),
    /// The file exists and must not be replaced.
    #[error("`{}` exists; choose another name", .0.display())]
    Exists(PathBuf),
    /// It is an input, is linked by one, or is a drawing.
    #[error(
        "`{}` {why}, which would be lost; choose another name, `{}` for example",
        .path.display(), .other.display()
    )]
    Loss {
        /// The file.
        path: PathBuf,
        /// What it is.
        why: &'static str,
        /// A name that is free.
        other: PathBuf,
    },
    /// Another program wrote it, and nobody named it.
    #[error(
        "`{}` was not written by okoshi; rename it, or choose another name with -o, `{}` for example",
        .path.display(), .other.display()
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// A name that is free.
        other: PathBuf,
    },
    /// There is no space for it, or the user may not write so much.
    #[error(
        "there is no space for `{}` ({source}); free some, or write to another place",
        .path.display()
    )]
    Full {
        /// The file.
        path: PathBuf,
        /// The error.
        source: io::Error,
    },
    /// The operating system cannot write it, or its content cannot be generated.
    #[error("`{}` cannot be written: {source}", .path.display())]
    Failed {
        /// The file.
        path: PathBuf,
        /// The error.
        source: io::Error,
    },
}

/// Writes a file through `fill`; `-` is stdout.
///
/// The file is replaced atomically: the content goes to a [`Temporary`] file in the same folder, which then gets the name.
/// If the program is killed, or `fill` fails, the old file stays. The permissions of an existing file are kept; a symbolic
/// link stays a link, and its target is replaced. Devices and pipes are written to directly.
///
/// # Errors
///
/// If the file cannot be written, or `fill` fails.
pub(super) fn write_atomic<T>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Output) -> io::Result<T>,
) -> Result<T, WriteError> {
    let failed = |source| failure(path, source);
    if super::is_standard_stream(path) {
        return fill_stream(io::stdout().lock(), fill).map_err(failed);
    }
    let target = follow_links(path).map_err(failed)?;
    let existing = match fs::metadata(&target) {
        Ok(metadata) if metadata.is_dir() => return Err(WriteError::Folder(path.to_owned())),
        Ok(metadata) if !metadata.is_file() => {
            // A file must not replace the null device or a pipe.
            let device = bounded::open_device(&target, bounded::PATIENCE).map_err(failed)?;
            return fill_stream(device, fill).map_err(failed);
        }
        Ok(metadata) if metadata.permissions().readonly() => {
            return Err(WriteError::Protected(path.to_owned()));
        }
        Ok(metadata) => Some(metadata.permissions()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(folder_failure(&target, path, error)),
    };
    if target.file_name().is_none() || ends_with_separator(path) {
        return Err(WriteError::Folder(path.to_owned()));
    }

    let mut temporary =
        Temporary::new(folder_of(&target)).map_err(|error| folder_failure(&target, path, error))?;
    let mut out = SeekableOutput::new(Bounded::new(temporary.file()));
    let answer = fill(&mut out)
        .and_then(|answer| out.finish().map(|_| answer))
        .map_err(failed)?;
    if let Some(permissions) = existing {
        let written = temporary.file().set_permissions(permissions);
        written.map_err(failed)?;
    }
    // Does not wait for the disk: outputs can be built again, and common file systems write the data
    // before the rename.
    temporary.replace(&target).map_err(failed)?;
    Ok(answer)
}

/// Writes a new version of a file that other programs write, too: completely or not at all, and only if it still holds what was read.
/// Its permissions are kept, and symbolic links stay. `false` if it holds something else by now.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn rewrite_if(path: &Path, read: &[u8], content: &[u8]) -> Result<bool, WriteError> {
    let failed = |source| failure(path, source);
    let target = follow_links(path).map_err(failed)?;
    let permissions = match fs::metadata(&target) {
        Ok(metadata) if metadata.is_dir() => return Err(WriteError::Folder(path.to_owned())),
        Ok(metadata) if !metadata.is_file() => {
            return Err(failed(io::Error::other("it is no plain file")));
        }
        Ok(metadata) if metadata.permissions().readonly() => {
            return Err(WriteError::Protected(path.to_owned()));
        }
        Ok(metadata) => metadata.permissions(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
        Err(error) => return Err(folder_failure(&target, path, error)),
    };
    let mut temporary =
        Temporary::new(folder_of(&target)).map_err(|error| folder_failure(&target, path, error))?;
    let mut file = Bounded::new(temporary.file());
    file.write_all(content).map_err(failed)?;
    let written = temporary.file().set_permissions(permissions);
    written.map_err(failed)?;
    temporary.replace_if(&target, read).map_err(failed)
}

/// A file in the folder of an output.
///
/// # Errors
/// If it cannot be created there.
pub(super) fn scratch_for(path: &Path) -> Result<Scratch, WriteError> {
    let target = follow_links(path).map_err(|source| failure(path, source))?;
    Scratch::new(folder_of(&target)).map_err(|error| folder_failure(&target, path, error))
}

/// Creates a folder and its parents.
///
/// # Errors
/// If the system cannot create one of them.
pub(crate) fn make_folder(path: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(path).map_err(|source| failure(path, source))
}

/// Writes a new file, completely or not at all. An existing file, or a dangling link, is left unchanged.
///
/// # Errors
/// If something with this name exists, or the file cannot be written.
pub(crate) fn write_new(path: &Path, content: &[u8]) -> Result<(), WriteError> {
    if ends_with_separator(path) {
        return Err(WriteError::Folder(path.to_owned()));
    }
    match fs::symlink_metadata(path) {
        Ok(_) => return Err(WriteError::Exists(path.to_owned())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(folder_failure(path, path, error)),
    }
    let failed = |source| failure(path, source);
    let mut temporary =
        Temporary::new(folder_of(path)).map_err(|error| folder_failure(path, path, error))?;
    let mut file = Bounded::new(temporary.file());
    file.write_all(content).map_err(failed)?;
    temporary.create(path).map_err(|error| match error.kind() {
        // Another program created the file meanwhile.
        io::ErrorKind::AlreadyExists => WriteError::Exists(path.to_owned()),
        _ => failed(error),
    })
}

/// Fills a stream, which gets the complete output or, if `fill` fails, nothing.
fn fill_stream<T>(
    mut out: impl Write,
    fill: impl FnOnce(&mut dyn Output) -> io::Result<T>,
) -> io::Result<T> {
    let mut content = SeekableOutput::new(Cursor::new(Vec::new()));
    let answer = fill(&mut content)?;
    out.write_all(content.finish()?.get_ref())?;
    out.flush()?;
    Ok(answer)
}

/// The target of a chain of symbolic links. It need not exist.
fn follow_links(path: &Path) -> io::Result<PathBuf> {
    const MAX_LINKS: usize = 40;

    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_symlink() => {
                path = folder_of(&path).join(fs::read_link(&path)?);
            }
            _ => return Ok(path),
        }
    }
    Err(io::Error::other("its symbolic links go in a circle"))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn ends_with_separator(path: &Path) -> bool {
    let bytes = path.as_os_str().as_encoded_bytes();
    bytes
        .last()
        .is_some_and(|byte| std::path::is_separator(char::from(*byte)))
}

fn folder_failure(target: &Path, path: &Path, source: io::Error) -> WriteError {
    let folder = folder_of(target).to_owned();
    match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => WriteError::NoFolder(folder),
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            WriteError::FolderDenied(folder)
        }
        _ => failure(path, source),
    }
}

fn failure(path: &Path, source: io::Error) -> WriteError {
    let path = path.to_owned();
    match source.kind() {
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            WriteError::Full { path, source }
        }
        _ => WriteError::Failed { path, source },
    }
}

#[cfg(test)]
mod tests {
    use std::io::BufRead as _;

    #[cfg(unix)]
    use std::fs::Permissions;

    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_written_and_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.glb");
        for content in [&b"old"[..], b"new"] {
            write_atomic(&path, |out| out.write_all(content)).unwrap();
            assert_eq!(fs::read(&path).unwrap(), content);
        }
        assert_eq!(names(folder.path()), ["a.glb"]);
    }

    /// Writes `data` behind a head of at least `length` bytes for which `estimate` bytes are reserved, to a file and to a
    /// stream, and returns the length that the head has.
    fn written_head(estimate: u64, length: u64, data: &[u8]) -> u64 {
        let fill = |out: &mut dyn Output| {
            out.reserve_head(estimate);
            let mut pieces = data.chunks(100_000);
            pieces.try_for_each(|piece| out.write_all(piece))?;
            let head = out.start_head(length)?;
            out.write_all(&vec![b'h'; head as usize])?;
            Ok(head)
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.glb");
        let head = write_atomic(&path, fill).unwrap();
        let expected = [&vec![b'h'; head as usize], data].concat();
        assert!(fs::read(&path).unwrap() == expected);
        assert_eq!(names(folder.path()), ["a.glb"]);

        let mut stream = Vec::new();
        assert_eq!(fill_stream(&mut stream, fill).unwrap(), head);
        assert!(stream == expected, "a stream gets the bytes of a file");
        head
    }

    /// More data than stays in memory, in blocks that differ.
    fn much_data() -> Vec<u8> {
        (0..700_000_u32).flat_map(u32::to_le_bytes).collect()
    }

    #[test]
    fn a_head_that_fits_takes_the_reserved_space() {
        let data = much_data();
        for (estimate, length) in [(1000, 1000), (1000, 1), (1000, 0), (0, 0)] {
            assert_eq!(written_head(estimate, length, &data), estimate);
        }
    }

    #[test]
    fn data_gives_way_to_a_head_that_does_not_fit() {
        let data = much_data();
        for (estimate, length) in [(0, 1), (1000, 1001), (5, 70_000), (10, 5_000_000)] {
            assert_eq!(written_head(estimate, length, &data), length);
        }
    }

    #[test]
    fn the_head_of_little_data_has_its_own_length() {
        let data = &much_data()[..1 << 20];
        for data in [&data[..0], &data[..10], data] {
            for (estimate, length) in [(1000, 10), (10, 1000), (0, 0)] {
                assert_eq!(written_head(estimate, length, data), length);
            }
        }
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.glb");
        fs::write(&path, "old").unwrap();
        let error = write_atomic(&path, |out| {
            out.write_all(b"half")?;
            Err::<(), _>(io::Error::other("out of ideas"))
        })
        .unwrap_err();
        assert!(
            error
                .to_string()
                .ends_with("cannot be written: out of ideas")
        );
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["a.glb"]);
    }

    #[test]
    fn what_is_no_place_for_a_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let write = |path: &Path| write_atomic(path, |out| out.write_all(b"x")).unwrap_err();
        fs::write(path("file"), "").unwrap();
        assert!(matches!(write(folder.path()), WriteError::Folder(_)));
        assert!(matches!(write(&path("none/a")), WriteError::NoFolder(_)));
        assert!(matches!(write(&path("file/a")), WriteError::NoFolder(_)));
        assert!(matches!(
            write(&path("new/")),
            WriteError::Folder(_) | WriteError::NoFolder(_)
        ));
        let mut permissions = fs::metadata(path("file")).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(path("file"), permissions).unwrap();
        assert!(matches!(write(&path("file")), WriteError::Protected(_)));
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[test]
    fn a_new_file_takes_nothings_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        write_new(&path("a"), b"first").unwrap();
        fs::create_dir(path("folder")).unwrap();
        for name in ["a", "folder"] {
            let error = write_new(&path(name), b"second").unwrap_err();
            assert!(matches!(error, WriteError::Exists(_)), "{error}");
        }
        assert_eq!(fs::read(path("a")).unwrap(), b"first");
        for name in ["none/b", "a/b"] {
            let error = write_new(&path(name), b"x").unwrap_err();
            assert!(matches!(error, WriteError::NoFolder(_)), "{error}");
        }
        assert_eq!(names(folder.path()), ["a", "folder"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_dangling_link_is_in_the_way_of_a_new_file() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink("nowhere", &link).unwrap();
        let error = write_new(&link, b"x").unwrap_err();
        assert!(matches!(error, WriteError::Exists(_)), "{error}");
        assert_eq!(names(folder.path()), ["link"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_a_new_files_or_the_old_files() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name| {
            let path = folder.path().join(name);
            fs::metadata(path).unwrap().permissions().mode() & 0o7777
        };
        let write = |name| {
            write_atomic(&folder.path().join(name), |out| out.write_all(b"x")).unwrap();
        };
        fs::write(folder.path().join("plain"), "").unwrap();
        write("new");
        assert_eq!(mode("new"), mode("plain"));
        fs::set_permissions(folder.path().join("new"), Permissions::from_mode(0o640)).unwrap();
        write("new");
        assert_eq!(mode("new"), 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        use std::os::unix::fs::{FileTypeExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("sub")).unwrap();
        symlink("sub/link", path("link")).unwrap();
        symlink("../real", path("sub/link")).unwrap();
        for content in ["new", "newer"] {
            write_atomic(&path("link"), |out| out.write_all(content.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(path("real")).unwrap(), content);
            assert!(fs::symlink_metadata(path("link")).unwrap().is_symlink());
        }
        symlink("round", path("round")).unwrap();
        let error = write_atomic(&path("round"), |_| Ok(())).unwrap_err();
        assert!(error.to_string().ends_with("go in a circle"), "{error}");

        let null = Path::new("/dev/null");
        write_atomic(null, |out| out.write_all(b"x")).unwrap();
        assert!(fs::metadata(null).unwrap().file_type().is_char_device());
    }

    const VICTIM: &str = "OKOSHI_TEST_VICTIM";

    /// Not a test: the program that `a_kill_leaves_the_old_file` kills.
    #[test]
    #[allow(clippy::print_stdout, reason = "it says when it is writing")]
    fn victim() {
        let Some(path) = std::env::var_os(VICTIM) else {
            return;
        };
        write_atomic(Path::new(&path), |out| {
            out.write_all(&[0; 1 << 20])?;
            println!("writing");
            std::thread::sleep(crate::patience::PATIENCE);
            Ok(())
        })
        .unwrap();
    }

    #[test]
    fn a_kill_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.glb");
        fs::write(&path, "old").unwrap();
        let mut child = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["disk::write::tests::victim", "--exact", "--nocapture"])
            .env(VICTIM, &path)
            .stdout(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = io::BufReader::new(child.stdout.take().unwrap()).lines();
        assert!(lines.any(|line| line.unwrap().contains("writing")));
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        #[cfg(target_os = "linux")]
        assert_eq!(names(folder.path()), ["a.glb"]);
        write_atomic(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }
}
