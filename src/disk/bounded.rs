//! Files that may not grow beyond what the user allows (`ulimit -f`), and pipes that nobody reads: the system would end the program
//! without a message, or make it wait for ever.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::Duration;

/// How long a program that is to read a pipe may take to start.
pub(super) const PATIENCE: Duration = Duration::from_secs(10);
/// How often it is looked for.
#[cfg(unix)]
const LOOK: Duration = Duration::from_millis(20);

/// A file that is written from its start. What passes the largest size that the user may give files is an error.
pub(super) struct Bounded<'a> {
    file: &'a mut File,
    at: u64,
    most: u64,
}

impl<'a> Bounded<'a> {
    pub(super) fn new(file: &'a mut File) -> Self {
        Self {
            file,
            at: 0,
            most: most(),
        }
    }
}

/// The largest size of a file, in bytes.
fn most() -> u64 {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, getrlimit};
        getrlimit(Resource::Fsize).current.unwrap_or(u64::MAX)
    }
    #[cfg(not(unix))]
    u64::MAX
}

impl Read for Bounded<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(bytes)?;
        self.at += read as u64;
        Ok(read)
    }
}

impl Seek for Bounded<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.at = self.file.seek(to)?;
        Ok(self.at)
    }
}

impl Write for Bounded<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.at.saturating_add(bytes.len() as u64) > self.most {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        let written = self.file.write(bytes)?;
        self.at += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Opens a device or a pipe for writing. Opening a pipe waits for a program that reads it, this long.
///
/// # Errors
/// If it cannot be opened, or nobody reads it.
pub(super) fn open_device(path: &Path, patience: Duration) -> io::Result<File> {
    #[cfg(unix)]
    let _reached = reach(path, patience)?;
    #[cfg(not(unix))]
    let _ = patience;
    File::options().write(true).open(path)
}

/// Opens what can be written at once: a pipe only if a program reads it.
#[cfg(unix)]
fn reach(path: &Path, patience: Duration) -> io::Result<File> {
    use rustix::fs::OFlags;
    use rustix::io::Errno;
    use std::os::unix::fs::OpenOptionsExt as _;
    let begun = std::time::Instant::now();
    let flags = OFlags::NONBLOCK.bits().cast_signed();
    loop {
        let opened = File::options().write(true).custom_flags(flags).open(path);
        match opened {
            Err(error) if error.raw_os_error() == Some(Errno::NXIO.raw_os_error()) => {
                if begun.elapsed() >= patience {
                    let message = "nobody reads this pipe; start the program that reads it first";
                    return Err(io::Error::other(message));
                }
                std::thread::sleep(LOOK);
            }
            opened => return opened,
        }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_pipe_that_nobody_reads_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.unwrap().success());
        let error = open_device(&path, Duration::from_millis(50)).unwrap_err();
        assert!(error.to_string().contains("nobody reads"), "{error}");
        let reader = std::thread::spawn({
            let path = path.clone();
            move || std::fs::read(path).unwrap()
        });
        let mut pipe = open_device(&path, crate::patience::PATIENCE).unwrap();
        pipe.write_all(b"model").unwrap();
        drop(pipe);
        assert_eq!(reader.join().unwrap(), b"model");
    }
}
