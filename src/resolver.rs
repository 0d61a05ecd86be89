//! Links of a drawing, resolved to the bytes of files.
//!
//! The compiler never opens files: it asks a [`Resolver`]. A link is a relative path that starts at the drawing's folder.
//! It stays there, by the rule of [`inside`], unless a person allows a larger folder.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

use percent_encoding::percent_decode_str;

/// Reads the files that a drawing links to.
pub trait Resolver: Sync {
    /// Reads the file that `link`, written as in the drawing, leads to.
    ///
    /// # Errors
    /// If the link leads out of the drawing's folder, or its file cannot be read.
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError>;

    /// The links to all files in the folder of `link` that have its ending, sorted, whether it is there or not: what could be meant
    /// by a link to nothing. Empty where files cannot be listed.
    fn siblings(&self, link: &str) -> Vec<String> {
        let _ = link;
        Vec::new()
    }
}

/// Why a link cannot be followed. Messages go behind the link's name: ``link `a.png` `` …
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LinkError {
    /// No such file.
    #[error("is not there")]
    Missing,
    /// It leaves the drawing's folder, by `..` or by a symbolic link.
    #[error("is outside the drawing's folder")]
    Outside,
    /// It names a place on one machine.
    #[error("is an absolute path")]
    Absolute,
    /// It is a web address, or has another scheme that is not a file's.
    #[error("is a web address, not a file beside the drawing")]
    Remote,
    /// It is there but cannot be read, with the reason.
    #[error("cannot be read: {0}")]
    Unreadable(String),
    /// It is longer than okoshi reads.
    #[error("is larger than the limit of {} MiB", limit >> 20)]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
}

/// The relative path of `link`, with `/` between its parts and no `.` or `..` left, if it stays inside
/// the folder that it starts from.
///
/// # Errors
/// Those of [`relative`], and if the link leaves the folder.
pub fn inside(link: &str) -> Result<String, LinkError> {
    let path = relative(link)?;
    if path == ".." || path.starts_with("../") {
        Err(LinkError::Outside)
    } else {
        Ok(path)
    }
}

/// The relative path of `link`, with `/` between its parts, without `.`, and with `..` only at its beginning.
///
/// A backslash separates like a slash, so that a drawing means the same on every system.
///
/// # Errors
/// If the link is not a relative path, or is empty.
pub fn relative(link: &str) -> Result<String, LinkError> {
    let link = link.replace('\\', "/");
    if link.starts_with("//") {
        return Err(LinkError::Remote);
    }
    if link.starts_with('/') {
        return Err(LinkError::Absolute);
    }
    match scheme(&link) {
        None => {}
        // A drive letter.
        Some(scheme) if scheme.len() == 1 || scheme.eq_ignore_ascii_case("file") => {
            return Err(LinkError::Absolute);
        }
        Some(_) => return Err(LinkError::Remote),
    }
    if link.contains('\0') {
        return Err(LinkError::Missing);
    }
    let mut parts = vec![];
    for part in link.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    if parts.is_empty() {
        Err(LinkError::Missing)
    } else {
        Ok(parts.join("/"))
    }
}

/// The spellings under which `link` is looked for: as it is written, then percent-decoded (`%20`), as links in XML are
/// encoded.
pub fn spellings(link: &str) -> impl Iterator<Item = String> {
    // `%` without two hexadecimal digits stands for itself; bytes that are no text are no spelling.
    let decoded = percent_decode_str(link).decode_utf8().ok();
    let decoded = decoded.filter(|decoded| decoded != link);
    std::iter::once(link.to_owned()).chain(decoded.map(Cow::into_owned))
}

/// The first answer of `read` over the spellings of a link that is not [`LinkError::Missing`].
///
/// Each spelling is normalised by `rule`, [`inside`] or [`relative`], so that an encoded `..` is judged like a plain one.
///
/// # Errors
/// If no spelling leads anywhere.
pub fn first_spelling<T>(
    link: &str,
    rule: fn(&str) -> Result<String, LinkError>,
    read: impl Fn(&str) -> Result<T, LinkError>,
) -> Result<T, LinkError> {
    spellings(link)
        .map(|spelling| rule(&spelling).and_then(|path| read(&path)))
        .find(|answer| !matches!(answer, Err(LinkError::Missing)))
        .unwrap_or(Err(LinkError::Missing))
}

fn scheme(link: &str) -> Option<&str> {
    let (scheme, _) = link.split_once(':')?;
    let letter = scheme.starts_with(|c: char| c.is_ascii_alphabetic());
    let rest = |c: char| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.');
    (letter && scheme.chars().all(rest)).then_some(scheme)
}

/// The bytes of a linked file, or why there are none.
pub type LinkContent = Result<Arc<[u8]>, LinkError>;

/// A resolver that records what is read through it.
pub struct Recorder<'a> {
    inner: &'a dyn Resolver,
    read: Mutex<BTreeMap<String, LinkContent>>,
}

/// A link that was read, and what it led to.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Dependency {
    /// The link as it was written.
    pub link: String,
    /// Its content.
    pub content: LinkContent,
}

impl Dependency {
    /// Whether the link still leads to the same bytes, or to the same error.
    pub fn is_unchanged(&self, resolver: &dyn Resolver) -> bool {
        resolver.read(&self.link) == self.content
    }
}

impl<'a> Recorder<'a> {
    /// Records what is read from `inner`.
    pub fn new(inner: &'a dyn Resolver) -> Self {
        Self {
            inner,
            read: Mutex::default(),
        }
    }

    /// All links that were read, in alphabetical order, each with what it led to the first time.
    pub fn into_dependencies(self) -> Vec<Dependency> {
        let read = self.read.into_inner();
        let read = read.unwrap_or_else(PoisonError::into_inner).into_iter();
        read.map(|(link, content)| Dependency { link, content })
            .collect()
    }
}

/// A resolver that records which links are read through it, and holds on to none of what they lead to.
pub(crate) struct LinkList<'a> {
    inner: &'a dyn Resolver,
    links: Mutex<BTreeSet<String>>,
}

impl<'a> LinkList<'a> {
    /// Records what is read from `inner`.
    pub(crate) fn new(inner: &'a dyn Resolver) -> Self {
        Self {
            inner,
            links: Mutex::default(),
        }
    }

    /// All links that were read, as they were written, each once.
    pub(crate) fn into_links(self) -> BTreeSet<String> {
        let links = self.links.into_inner();
        links.unwrap_or_else(PoisonError::into_inner)
    }
}

impl Resolver for LinkList<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let mut links = self.links.lock().unwrap_or_else(PoisonError::into_inner);
        links.insert(link.to_owned());
        drop(links);
        self.inner.read(link)
    }

    fn siblings(&self, link: &str) -> Vec<String> {
        self.inner.siblings(link)
    }
}

impl Resolver for Recorder<'_> {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        let content = self.inner.read(link);
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let first = read.entry(link.to_owned());
        first.or_insert_with(|| content.clone());
        content
    }

    fn siblings(&self, link: &str) -> Vec<String> {
        self.inner.siblings(link)
    }
}

/// Files held in memory: for tests, and for drawings that come without a folder (then it is empty).
#[derive(Debug, Clone, Default)]
pub struct MemoryResolver {
    files: BTreeMap<String, Arc<[u8]>>,
}

impl MemoryResolver {
    /// Adds a file under its relative path.
    #[must_use]
    pub fn with(mut self, path: &str, bytes: impl Into<Arc<[u8]>>) -> Self {
        self.files.insert(path.to_owned(), bytes.into());
        self
    }

    /// Without the file of a relative path, if there is one.
    #[must_use]
    pub fn without(mut self, path: &str) -> Self {
        self.files.remove(path);
        self
    }

    /// The paths of all files, in alphabetical order.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// The file of exactly this path.
    ///
    /// # Errors
    /// If it is not there.
    pub(crate) fn file(&self, path: &str) -> LinkContent {
        self.files.get(path).cloned().ok_or(LinkError::Missing)
    }
}

impl Resolver for MemoryResolver {
    fn read(&self, link: &str) -> Result<Arc<[u8]>, LinkError> {
        first_spelling(link, inside, |path| self.file(path))
    }

    fn siblings(&self, link: &str) -> Vec<String> {
        let Ok(path) = inside(link) else {
            return Vec::new();
        };
        let (folder, ending) = folder_and_ending(&path);
        let files = self.files.keys();
        let siblings = files.filter(|file| folder_and_ending(file) == (folder, ending));
        siblings.cloned().collect()
    }
}

/// The folder of a path, with its slash, and the name in it; each may be empty.
pub(crate) fn folder_and_name(path: &str) -> (&str, &str) {
    path.split_at(path.rfind('/').map_or(0, |slash| slash + 1))
}

/// The folder of a path, with its slash, and the ending of its name, with its dot; each may be empty.
pub(crate) fn folder_and_ending(path: &str) -> (&str, &str) {
    let (folder, name) = folder_and_name(path);
    (folder, name.rfind('.').map_or("", |dot| &name[dot..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_stay_inside() {
        for (link, expected) in [
            ("a.png", Ok("a.png")),
            ("./a/./b.png", Ok("a/b.png")),
            ("a//b.png", Ok("a/b.png")),
            ("a/../b.png", Ok("b.png")),
            (r"a\b.png", Ok("a/b.png")),
            ("腕 1.png", Ok("腕 1.png")),
            ("..a", Ok("..a")),
            ("../a.png", Err(LinkError::Outside)),
            ("a/../../b.png", Err(LinkError::Outside)),
            (r"..\a.png", Err(LinkError::Outside)),
            ("/etc/passwd", Err(LinkError::Absolute)),
            (r"\a", Err(LinkError::Absolute)),
            ("file:///a.png", Err(LinkError::Absolute)),
            ("File:a.png", Err(LinkError::Absolute)),
            (r"C:\a.png", Err(LinkError::Absolute)),
            ("c:a.png", Err(LinkError::Absolute)),
            ("//server/a.png", Err(LinkError::Remote)),
            (r"\\server\a.png", Err(LinkError::Remote)),
            ("https://a.example/b.png", Err(LinkError::Remote)),
            ("data:image/png;base64,AAAA", Err(LinkError::Remote)),
            ("", Err(LinkError::Missing)),
            ("a/..", Err(LinkError::Missing)),
            ("a\0b", Err(LinkError::Missing)),
        ] {
            assert_eq!(inside(link), expected.map(str::to_owned), "{link}");
        }
    }

    #[test]
    fn links_that_leave_begin_with_two_dots() {
        for (link, expected) in [
            ("../a.png", Ok("../a.png")),
            (r"..\..\a\.\b.png", Ok("../../a/b.png")),
            ("a/../../b/../c.png", Ok("../c.png")),
            ("a/b/../../c", Ok("c")),
            ("..", Ok("..")),
            ("/a/../b", Err(LinkError::Absolute)),
        ] {
            assert_eq!(relative(link), expected.map(str::to_owned), "{link}");
        }
        assert_eq!(inside(".."), Err(LinkError::Outside));
    }

    #[test]
    fn siblings_are_in_the_same_folder_and_of_the_same_kind() {
        let files = MemoryResolver::default()
            .with("b.bvh", *b"")
            .with("a.bvh", *b"")
            .with("a.png", *b"")
            .with("in/c.bvh", *b"")
            .with("bvh", *b"");
        for (link, expected) in [
            ("x.bvh", &["a.bvh", "b.bvh"][..]),
            ("./in/x.bvh", &["in/c.bvh"]),
            ("x", &["bvh"]),
            ("../x.bvh", &[]),
        ] {
            assert_eq!(files.siblings(link), expected, "{link}");
        }
    }

    #[test]
    fn percent_signs_are_read_both_ways() {
        let files = MemoryResolver::default()
            .with("a b.png", *b"space")
            .with("100%.png", *b"percent")
            .with("c%20d.png", *b"literal")
            .with("c d.png", *b"decoded");
        let read = |link| files.read(link).map(|bytes| bytes.to_vec());
        assert_eq!(read("a%20b.png"), Ok(b"space".to_vec()));
        assert_eq!(read("100%.png"), Ok(b"percent".to_vec()));
        assert_eq!(read("100%25.png"), Ok(b"percent".to_vec()));
        assert_eq!(read("c%20d.png"), Ok(b"literal".to_vec()));
        assert_eq!(read("%2e%2e/a.png"), Err(LinkError::Outside));
        assert_eq!(read("%2Fetc/passwd"), Err(LinkError::Absolute));
        assert_eq!(read("%ff.png"), Err(LinkError::Missing));
        assert_eq!(read("none.png"), Err(LinkError::Missing));
    }
}
