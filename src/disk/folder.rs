//! Resolves the links of a drawing in its folder.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::read::read_limited;
use crate::resolver::{LinkError, Resolver, first_spelling, inside};

/// The largest linked file that is read, in bytes.
pub const LINK_LIMIT: u64 = 256 << 20;

/// Reads links below one folder and nothing outside it, symbolic links included.
#[derive(Debug, Clone)]
pub struct FolderResolver {
    root: PathBuf,
}

impl FolderResolver {
    /// A resolver for the links of drawings in `root`.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        let root = root.into();
        let here = root.as_os_str().is_empty();
        Self {
            root: if here { PathBuf::from(".") } else { root },
        }
    }

    /// The path of the linked file, whether it exists or not, for a watcher. It is relative if the root is, so that
    /// moving a drawing does not change the result.
    ///
    /// # Errors
    /// If the link is absolute, remote or leads out of the folder.
    pub fn place(&self, link: &str) -> Result<PathBuf, LinkError> {
        match first_spelling(link, |path| self.locate(path)) {
            Err(LinkError::Missing) => inside(link).map(|path| self.named(Path::new(&path))),
            Ok(place) => {
                let root = fs::canonicalize(&self.root).map_err(failure)?;
                Ok(place
                    .strip_prefix(root)
                    .map_or(place.clone(), |path| self.named(path)))
            }
            answer => answer,
        }
    }

    /// The path of a file in the root, relative to the working directory if the root is.
    fn named(&self, path: &Path) -> PathBuf {
        if self.root == Path::new(".") {
            path.to_owned()
        } else {
            self.root.join(path)
        }
    }

    /// The canonical path of an existing file.
    fn locate(&self, path: &str) -> Result<PathBuf, LinkError> {
        let root = fs::canonicalize(&self.root).map_err(failure)?;
        let place = fs::canonicalize(root.join(path)).map_err(failure)?;
        match place.starts_with(&root) {
            true => Ok(place),
            false => Err(LinkError::Outside),
        }
    }
}

impl Resolver for FolderResolver {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let place = first_spelling(link, |path| self.locate(path))?;
        read_file(&place, LINK_LIMIT)
    }
}

fn read_file(place: &Path, limit: u64) -> Result<Arc<[u8]>, LinkError> {
    // Checked before opening: opening a pipe would wait for its other end.
    let metadata = fs::metadata(place).map_err(failure)?;
    if metadata.is_dir() {
        return Err(LinkError::Unreadable("it is a folder".to_owned()));
    }
    if !metadata.is_file() {
        return Err(LinkError::Unreadable("it is not a plain file".to_owned()));
    }
    if metadata.len() > limit {
        return Err(LinkError::TooLarge { limit });
    }
    let file = File::open(place).map_err(failure)?;
    let bytes = read_limited(file, limit, 0).map_err(failure)?;
    bytes.map(Arc::from).ok_or(LinkError::TooLarge { limit })
}

fn failure(error: io::Error) -> LinkError {
    match error.kind() {
        // A name that is invalid on this system counts as a missing file.
        io::ErrorKind::NotFound
        | io::ErrorKind::NotADirectory
        | io::ErrorKind::InvalidFilename
        | io::ErrorKind::InvalidInput => LinkError::Missing,
        io::ErrorKind::PermissionDenied => LinkError::Unreadable("permission denied".to_owned()),
        _ => LinkError::Unreadable(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_below_the_folder_are_read() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        fs::write(folder.path().join("sub/a b.png"), "picture").unwrap();
        let files = FolderResolver::new(folder.path());
        for link in [
            "sub/a b.png",
            "sub/a%20b.png",
            r"sub\a b.png",
            "./sub/../sub/a b.png",
        ] {
            assert_eq!(*files.read(link).unwrap(), *b"picture", "{link}");
        }
        let name = "a".repeat(300);
        for link in ["b.png", "sub/a b.png/c", "none/../none/b.png", &name] {
            assert_eq!(files.read(link), Err(LinkError::Missing), "{link}");
        }
        assert!(matches!(files.read("sub"), Err(LinkError::Unreadable(_))));
        assert_eq!(files.place("b.png").unwrap(), folder.path().join("b.png"));
        assert_eq!(files.place("../b.png"), Err(LinkError::Outside));
    }

    #[cfg(unix)]
    #[test]
    fn links_out_of_the_folder_are_refused() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("root");
        fs::create_dir(&root).unwrap();
        fs::write(folder.path().join("secret"), "secret").unwrap();
        fs::write(root.join("own"), "own").unwrap();
        symlink("../secret", root.join("file")).unwrap();
        symlink("..", root.join("up")).unwrap();
        symlink("own", root.join("alias")).unwrap();
        // A sibling folder whose name starts with the root's name is outside, too.
        fs::create_dir(folder.path().join("root2")).unwrap();
        fs::write(folder.path().join("root2/a"), "").unwrap();
        symlink("../root2/a", root.join("sibling")).unwrap();
        let files = FolderResolver::new(&root);
        for link in ["file", "up/secret", "sibling", "../secret", "%2e%2e/secret"] {
            assert_eq!(files.read(link), Err(LinkError::Outside), "{link}");
        }
        assert_eq!(*files.read("alias").unwrap(), *b"own");
        let absolute = folder.path().join("secret");
        let absolute = absolute.to_str().unwrap();
        assert_eq!(files.read(absolute), Err(LinkError::Absolute));
    }

    #[test]
    fn large_files_are_refused_by_their_length() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a"), "12345").unwrap();
        let read = |limit| read_file(&folder.path().join("a"), limit);
        assert_eq!(read(4), Err(LinkError::TooLarge { limit: 4 }));
        assert!(read(5).is_ok());
    }
}
