//! Files without their final name: they get it when they are complete.
//!
//! On Linux such a file has no name at all, so that nothing is left of it if the program is killed. Elsewhere it has a
//! temporary name: a signal removes it, and what another end of the program leaves is removed by the next write into the
//! folder. A lock tells such a leftover from a file that is being written.

use std::collections::BTreeSet;
use std::fs::{self, File, Permissions};
use std::io::{self, Read as _, Seek as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, Once, PoisonError};
use std::time::Duration;

use tempfile::NamedTempFile;

const PREFIX: &str = ".okoshi-";
const SUFFIX: &str = ".tmp";

/// How old a leftover must be to be removed: a new file may not be locked yet.
const STALE: Duration = Duration::from_secs(60);

/// The exit status after Ctrl-C, as shells define it.
const INTERRUPTED: i32 = 130;

/// The temporary files that have names, for the handler of signals.
static NAMED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A file that is being written.
#[derive(Debug)]
pub(super) struct Temporary {
    folder: PathBuf,
    file: Handle,
}

#[derive(Debug)]
enum Handle {
    Unnamed(File),
    Named(Listed),
}

/// A named temporary file, which a signal removes.
#[derive(Debug)]
struct Listed(Option<NamedTempFile>);

impl Temporary {
    /// An empty file in a folder.
    ///
    /// # Errors
    /// If it cannot be created there.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        sweep_once(folder);
        let file = match unnamed(folder) {
            Some(file) => Handle::Unnamed(file),
            None => Handle::Named(Listed::new(folder)?),
        };
        Ok(Self {
            folder: folder.to_owned(),
            file,
        })
    }

    pub(super) fn file(&mut self) -> &mut File {
        match &mut self.file {
            Handle::Unnamed(file) => file,
            Handle::Named(file) => file.file(),
        }
    }

    /// A path by which other programs can open the file while this program runs.
    pub(super) fn path(&self) -> PathBuf {
        match &self.file {
            Handle::Unnamed(file) => open_path(file, std::process::id()),
            Handle::Named(file) => file.path(),
        }
    }

    /// Gives the file its name, in place of the file that has it.
    ///
    /// # Errors
    /// If it cannot be renamed.
    pub(super) fn replace(self, target: &Path) -> io::Result<()> {
        let named = self.named()?;
        named.persist(target).map_err(|error| error.error)?;
        Ok(())
    }

    /// Gives the file its name, in place of the file that has it, if that one holds these bytes. What another program has written there
    /// in between keeps its name, or gets it back: then the answer is `false`.
    ///
    /// # Errors
    /// If it cannot be renamed.
    pub(super) fn replace_if(mut self, target: &Path, expected: &[u8]) -> io::Result<bool> {
        let holds = |path: &Path, bytes: &[u8]| fs::read(path).is_ok_and(|found| found == bytes);
        if !holds(target, expected) {
            return Ok(false);
        }
        let mut content = vec![];
        self.file().rewind()?;
        self.file().read_to_end(&mut content)?;
        let named = self.named()?;
        if exchange(named.path(), target).is_err() {
            // There is a moment between looking and renaming here.
            if !holds(target, expected) {
                return Ok(false);
            }
            named.persist(target).map_err(|error| error.error)?;
            return Ok(true);
        }
        // Now the old file has the temporary name, and nobody else can find it.
        if holds(named.path(), expected) {
            return Ok(true);
        }
        exchange(named.path(), target)?;
        if !holds(named.path(), &content) {
            // It was saved once more meanwhile; the newest one stays.
            exchange(named.path(), target)?;
        }
        Ok(false)
    }

    /// Gives the file its name, unless there is a file that has it.
    ///
    /// # Errors
    /// If there is one, or it cannot be renamed.
    pub(super) fn create(self, target: &Path) -> io::Result<()> {
        let named = self.named()?;
        let created = named.persist_noclobber(target);
        created.map_err(|error| error.error)?;
        Ok(())
    }

    /// The file under a temporary name, which it has for a moment only.
    fn named(self) -> io::Result<NamedTempFile> {
        let mut file = match self.file {
            Handle::Unnamed(file) => file,
            Handle::Named(mut listed) => return Ok(listed.take()),
        };
        if let Ok(named) = builder().make_in(&self.folder, |name| {
            link(&file, name)?;
            file.try_clone()
        }) {
            return Ok(named);
        }
        // Some file systems have files without names, but no way to name them.
        let mut named = Listed::new(&self.folder)?;
        named
            .file()
            .set_permissions(file.metadata()?.permissions())?;
        file.rewind()?;
        io::copy(&mut file, named.file())?;
        Ok(named.take())
    }
}

impl Listed {
    fn new(folder: &Path) -> io::Result<Self> {
        remove_on_signals();
        let file = builder().tempfile_in(folder)?;
        let mut names = NAMED.lock().unwrap_or_else(PoisonError::into_inner);
        names.insert(file.path().to_owned());
        // Where files cannot be locked, none is taken for a leftover.
        let _ = file.as_file().try_lock();
        Ok(Self(Some(file)))
    }

    fn file(&mut self) -> &mut File {
        match &mut self.0 {
            Some(file) => file.as_file_mut(),
            None => unreachable!("it is taken last"),
        }
    }

    fn path(&self) -> PathBuf {
        let file = self.0.as_ref();
        file.map(|file| file.path().to_owned()).unwrap_or_default()
    }

    fn take(&mut self) -> NamedTempFile {
        self.unlist();
        match self.0.take() {
            Some(file) => file,
            None => unreachable!("it is taken once"),
        }
    }

    fn unlist(&self) {
        if let Some(file) = &self.0 {
            let mut names = NAMED.lock().unwrap_or_else(PoisonError::into_inner);
            names.remove(file.path());
        }
    }
}

impl Drop for Listed {
    fn drop(&mut self) {
        self.unlist();
    }
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    if let Some(permissions) = new_file_permissions() {
        builder.permissions(permissions);
    }
    builder
}

/// The permissions with which programs create files; the system subtracts the user's umask.
#[cfg(unix)]
fn new_file_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt as _;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn new_file_permissions() -> Option<Permissions> {
    None
}

/// A file without a name; `None` if the system or the file system has no such files.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags};
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    let file = rustix::fs::open(folder, flags, Mode::from_raw_mode(0o666)).ok()?;
    Some(File::from(file))
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

/// The path of an open file of a process, whether it has a name or not.
#[cfg(target_os = "linux")]
fn open_path(file: &File, process: impl std::fmt::Display) -> PathBuf {
    use std::os::fd::AsRawFd as _;
    PathBuf::from(format!("/proc/{process}/fd/{}", file.as_raw_fd()))
}

#[cfg(not(target_os = "linux"))]
fn open_path(_: &File, _: impl std::fmt::Display) -> PathBuf {
    PathBuf::new()
}

/// Gives a file without a name a name.
#[cfg(target_os = "linux")]
fn link(file: &File, name: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD};
    Ok(rustix::fs::linkat(
        CWD,
        open_path(file, "self"),
        CWD,
        name,
        AtFlags::SYMLINK_FOLLOW,
    )?)
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Swaps the names of two files in one step.
#[cfg(target_os = "linux")]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags};
    let flags = RenameFlags::EXCHANGE;
    Ok(rustix::fs::renameat_with(CWD, one, CWD, other, flags)?)
}

#[cfg(not(target_os = "linux"))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// From now on, Ctrl-C and the signals that end a program remove the named temporary files first.
fn remove_on_signals() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // Without a handler the next write into the folder removes them.
        let _ = ctrlc::try_set_handler(|| {
            let names = NAMED.lock().unwrap_or_else(PoisonError::into_inner);
            for name in names.iter() {
                let _ = fs::remove_file(name);
            }
            std::process::exit(INTERRUPTED);
        });
    });
}

/// Removes the leftovers in a folder, at the first write into it.
fn sweep_once(folder: &Path) {
    static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let mut swept = SWEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if swept.insert(folder.to_owned()) {
        drop(swept);
        sweep(folder);
    }
}

fn sweep(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(PREFIX) && name.ends_with(SUFFIX) && is_leftover(&entry.path()) {
            // Whoever may not remove it leaves it to others.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Whether a temporary file is old, and nobody is writing it.
fn is_leftover(path: &Path) -> bool {
    let old = |metadata: fs::Metadata| {
        let age = metadata
            .modified()
            .ok()
            .and_then(|time| time.elapsed().ok());
        metadata.is_file() && age.is_some_and(|age| age > STALE)
    };
    // Not followed: a link is not okoshi's.
    fs::symlink_metadata(path).is_ok_and(old)
        && File::options()
            .write(true)
            .open(path)
            .is_ok_and(|file| file.try_lock().is_ok())
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;
    use std::time::SystemTime;

    use super::*;
    use crate::patience::{PATIENCE, wait_until};

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn named(folder: &Path) -> Temporary {
        Temporary {
            folder: folder.to_owned(),
            file: Handle::Named(Listed::new(folder).unwrap()),
        }
    }

    #[test]
    fn files_get_their_name_when_they_are_complete() {
        for make in [|folder: &Path| Temporary::new(folder).unwrap(), named] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a");
            for content in ["old", "new"] {
                let mut file = make(folder.path());
                file.file().write_all(content.as_bytes()).unwrap();
                file.replace(&path).unwrap();
                assert_eq!(fs::read_to_string(&path).unwrap(), content);
            }
            let error = make(folder.path()).create(&path).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
            make(folder.path())
                .create(&folder.path().join("b"))
                .unwrap();
            drop(make(folder.path()));
            assert_eq!(names(folder.path()), ["a", "b"]);
        }
    }

    #[test]
    fn a_file_is_replaced_only_if_it_is_what_was_read() {
        for make in [|folder: &Path| Temporary::new(folder).unwrap(), named] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a");
            let replace = |expected: &str| {
                let mut file = make(folder.path());
                file.file().write_all(b"new").unwrap();
                file.replace_if(&path, expected.as_bytes()).unwrap()
            };
            assert!(!replace("old"), "there is none");
            fs::write(&path, "other").unwrap();
            assert!(!replace("old"));
            assert_eq!(fs::read_to_string(&path).unwrap(), "other");
            assert!(replace("other"));
            assert_eq!(fs::read_to_string(&path).unwrap(), "new");
            assert_eq!(names(folder.path()), ["a"]);
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    #[allow(clippy::print_stdout, reason = "it says when it is skipped")]
    fn a_file_has_no_name_before() {
        let folder = tempfile::tempdir().unwrap();
        let file = Temporary::new(folder.path()).unwrap();
        // Some file systems have no such files.
        if matches!(file.file, Handle::Unnamed(_)) {
            assert_eq!(names(folder.path()), [""; 0]);
        } else {
            println!("skipped: the file system for temporary files has no files without names");
        }
    }

    #[test]
    fn leftovers_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let old = SystemTime::now() - 2 * STALE;
        for name in [
            ".okoshi-1.tmp",
            ".okoshi-2.tmp",
            ".okoshi-3",
            "okoshi-4.tmp",
        ] {
            let file = File::create(path(name)).unwrap();
            file.set_modified(old).unwrap();
        }
        let held = File::options()
            .write(true)
            .open(path(".okoshi-2.tmp"))
            .unwrap();
        held.try_lock().unwrap();
        fs::write(path(".okoshi-5.tmp"), "new").unwrap();
        drop(Temporary::new(folder.path()).unwrap());
        let kept = [
            ".okoshi-2.tmp",
            ".okoshi-3",
            ".okoshi-5.tmp",
            "okoshi-4.tmp",
        ];
        assert_eq!(names(folder.path()), kept);
    }

    const VICTIM: &str = "OKOSHI_TEST_INTERRUPTED";

    /// Not a test: the program that `an_interrupt_removes_named_files` interrupts.
    #[test]
    fn victim() {
        let Some(folder) = std::env::var_os(VICTIM) else {
            return;
        };
        let _file = named(Path::new(&folder));
        std::thread::sleep(PATIENCE);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn an_interrupt_removes_named_files() {
        use rustix::process::{Pid, Signal, kill_process};
        for signal in [Signal::INT, Signal::TERM, Signal::HUP] {
            let folder = tempfile::tempdir().unwrap();
            // Jobs in the background of a shell ignore Ctrl-C, and their children do too.
            let mut child = std::process::Command::new("env")
                .arg("--default-signal=INT,TERM,HUP")
                .arg(std::env::current_exe().unwrap())
                .args(["disk::temporary::tests::victim", "--exact"])
                .env(VICTIM, folder.path())
                .stdout(std::process::Stdio::null())
                .spawn()
                .unwrap();
            wait_until("its file", || {
                assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
                !names(folder.path()).is_empty()
            });
            kill_process(Pid::from_child(&child), signal).unwrap();
            assert_eq!(child.wait().unwrap().code(), Some(INTERRUPTED));
            assert_eq!(names(folder.path()), [""; 0]);
        }
    }
}
