//! Resolves the links of a drawing in its folder.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::read::read_limited;
use super::search::files;
use crate::resolver::{LinkError, Resolver, first_spelling, folder_and_ending, inside, relative};

/// The largest linked file that is read, in bytes.
pub(crate) const LINK_LIMIT: u64 = 256 << 20;

/// Reads the links of the drawings in one folder: files below it, or below another folder that a person allowed, and
/// nothing outside of both, symbolic links included.
#[derive(Debug, Clone)]
pub struct FolderResolver {
    /// Where links start.
    base: PathBuf,
    /// The folder that links may lead to besides the base.
    allowed: Option<PathBuf>,
}

impl FolderResolver {
    /// A resolver for the links of drawings in the folder `base`.
    pub fn new(base: impl Into<PathBuf>) -> Self {
        Self {
            base: named_folder(base.into()),
            allowed: None,
        }
    }

    /// Also allows links to files below the folder `root`, if there is one. Links still start at the base.
    #[must_use]
    pub fn allowing(self, root: Option<&Path>) -> Self {
        let allowed = root.map(|root| named_folder(root.to_owned()));
        Self { allowed, ..self }
    }

    /// The path of the linked file, whether it exists or not, for a watcher. It is relative if the folder is, so that
    /// moving a drawing does not change the result.
    ///
    /// # Errors
    /// If the link is absolute, remote or leads to a place that is not allowed.
    pub fn place(&self, link: &str) -> Result<PathBuf, LinkError> {
        match first_spelling(link, self.rule(), |path| self.locate(path)) {
            Err(LinkError::Missing) => self.rule()(link).map(|path| self.base.join(path)),
            Ok(place) => {
                let mut folders = self.folders();
                let named = folders.find_map(|folder| {
                    let inner = place.strip_prefix(fs::canonicalize(folder).ok()?).ok()?;
                    Some(folder.join(inner))
                });
                Ok(named.unwrap_or(place))
            }
            answer => answer,
        }
        .map(|place| match place.strip_prefix(".") {
            Ok(short) => short.to_owned(),
            Err(_) => place,
        })
    }

    /// The folders that links may lead to.
    fn folders(&self) -> impl Iterator<Item = &Path> {
        std::iter::once(&self.base)
            .chain(&self.allowed)
            .map(PathBuf::as_path)
    }

    /// What is required of the text of a link.
    fn rule(&self) -> fn(&str) -> Result<String, LinkError> {
        match self.allowed {
            None => inside,
            // Whether the place is allowed is decided when it is known.
            Some(_) => relative,
        }
    }

    /// The canonical path of an existing file.
    fn locate(&self, path: &str) -> Result<PathBuf, LinkError> {
        let base = fs::canonicalize(&self.base).map_err(failure)?;
        let place = fs::canonicalize(base.join(path));
        let inside = |place: &Path| {
            self.folders().any(|folder| {
                fs::canonicalize(folder).is_ok_and(|folder| place.starts_with(folder))
            })
        };
        match place {
            Ok(place) if inside(&place) => Ok(place),
            // Whether there is a file outside is nobody's business.
            Err(error) if !path.starts_with("..") || self.names_allowed(&base, path) => {
                Err(failure(error))
            }
            _ => Err(LinkError::Outside),
        }
    }

    /// Whether the text of a path that leads out of the base leads to the allowed folder.
    fn names_allowed(&self, base: &Path, path: &str) -> bool {
        let mut place = base.to_owned();
        for part in path.split('/') {
            match part {
                ".." => drop(place.pop()),
                part => place.push(part),
            }
        }
        let allowed = self
            .allowed
            .as_ref()
            .and_then(|allowed| fs::canonicalize(allowed).ok());
        allowed.is_some_and(|allowed| place.starts_with(allowed))
    }
}

/// The folder that an empty path stands for is the working directory.
fn named_folder(folder: PathBuf) -> PathBuf {
    if folder.as_os_str().is_empty() {
        PathBuf::from(".")
    } else {
        folder
    }
}

impl Resolver for FolderResolver {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let place = first_spelling(link, self.rule(), |path| self.locate(path))?;
        read_file(&place, LINK_LIMIT)
    }

    fn siblings(&self, link: &str) -> Vec<String> {
        let Ok(path) = self.rule()(link) else {
            return Vec::new();
        };
        let (folder, ending) = folder_and_ending(&path);
        // The base itself has no name in a link.
        let named = if folder.is_empty() { "." } else { folder };
        let Ok(place) = self.locate(named) else {
            return Vec::new();
        };
        let names = files(&place, |_| true).into_iter();
        let names = names.filter_map(|file| Some(file.file_name()?.to_str()?.to_owned()));
        names
            .filter(|name| folder_and_ending(name).1 == ending)
            .map(|name| format!("{folder}{name}"))
            .collect()
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
    fn siblings_are_listed_below_the_folder_only() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("base")).unwrap();
        for name in ["out.bvh", "base/b.bvh", "base/a.bvh", "base/a.png"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let files = FolderResolver::new(folder.path().join("base"));
        assert_eq!(files.siblings("none.bvh"), ["a.bvh", "b.bvh"]);
        assert!(files.siblings("../none.bvh").is_empty());
        assert!(files.siblings("none/none.bvh").is_empty());
        let files = FolderResolver::new(folder.path());
        assert_eq!(files.siblings("base/x.png"), ["base/a.png"]);
    }

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
    fn an_allowed_folder_widens_what_links_may_lead_to() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in [
            "all/figures",
            "all/textures",
            "all/figures/textures",
            "other",
        ] {
            fs::create_dir_all(path(name)).unwrap();
        }
        fs::write(path("all/textures/wood"), "outer").unwrap();
        fs::write(path("all/figures/textures/wood"), "inner").unwrap();
        fs::write(path("other/secret"), "secret").unwrap();
        let narrow = FolderResolver::new(path("all/figures"));
        assert_eq!(narrow.read("../textures/wood"), Err(LinkError::Outside));
        let wide = narrow.allowing(Some(&path("all")));
        assert_eq!(*wide.read("textures/wood").unwrap(), *b"inner");
        assert_eq!(*wide.read("../textures/wood").unwrap(), *b"outer");
        assert_eq!(*wide.read("%2e%2e/textures/wood").unwrap(), *b"outer");
        assert_eq!(wide.read("../textures/none"), Err(LinkError::Missing));
        for link in ["../../other/secret", "../../other/none", "../../../none"] {
            assert_eq!(wide.read(link), Err(LinkError::Outside), "{link}");
        }
        assert_eq!(
            wide.place("../textures/wood").unwrap(),
            path("all/textures/wood")
        );
        // A folder that is elsewhere takes nothing away.
        let elsewhere = FolderResolver::new(path("all/figures")).allowing(Some(&path("other")));
        assert_eq!(*elsewhere.read("textures/wood").unwrap(), *b"inner");
        assert_eq!(*elsewhere.read("../../other/secret").unwrap(), *b"secret");
        assert_eq!(elsewhere.read("../textures/wood"), Err(LinkError::Outside));
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
