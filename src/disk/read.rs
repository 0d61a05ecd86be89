//! Reads the bytes of drawings.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use super::sniff::NotADrawing;
use super::{search, sniff};

/// The largest drawing that is read, in bytes.
pub(crate) const DRAWING_LIMIT: u64 = 1 << 30;

/// The largest size to which a compressed drawing (`.svgz`) may expand, in bytes. A small file can
/// expand to any size.
pub(crate) const UNPACKED_LIMIT: u64 = 256 << 20;

/// Why a drawing cannot be read. Each message names the file and says how to fix it.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ReadError {
    /// No such file.
    #[error("`{}` is not there; {}", .path.display(), way_to(.near.as_deref()))]
    Missing {
        /// The file.
        path: PathBuf,
        /// A drawing in the same folder with a similar name.
        near: Option<PathBuf>,
    },
    /// A folder instead of a drawing.
    #[error("`{}` is a folder; name a drawing in it{}", .path.display(), such_as(.drawing.as_deref()))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// A drawing in it.
        drawing: Option<PathBuf>,
    },
    /// A file of another kind, a picture for example.
    #[error("`{}` is {}, not a drawing: {}", .path.display(), .kind.what, .kind.way_out)]
    NotADrawing {
        /// The file.
        path: PathBuf,
        /// What it is.
        kind: NotADrawing,
    },
    /// No permission to read the file.
    #[error("`{}` cannot be read: permission denied; change its permissions", .0.display())]
    Denied(PathBuf),
    /// Larger than [`DRAWING_LIMIT`].
    #[error("`{}` is larger than the limit of {} MiB; split the drawing", .0.display(), DRAWING_LIMIT >> 20)]
    TooLarge(PathBuf),
    /// Larger than [`UNPACKED_LIMIT`] after decompression.
    #[error(
        "`{}` is packed and larger than the limit of {} MiB when unpacked; save it as plain SVG",
        .0.display(), UNPACKED_LIMIT >> 20
    )]
    TooLargeUnpacked(PathBuf),
    /// Compressed, and damaged.
    #[error("`{}` is compressed, but damaged ({source}); save the drawing again", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The error of the decompressor.
        source: io::Error,
    },
    /// The operating system cannot read it.
    #[error("`{}` cannot be read: {source}", .path.display())]
    Failed {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        source: io::Error,
    },
}

fn way_to(near: Option<&Path>) -> String {
    match near {
        Some(near) => format!("did you mean `{}`?", near.display()),
        None => "check the path".to_owned(),
    }
}

fn such_as(drawing: Option<&Path>) -> String {
    drawing.map_or_else(String::new, |drawing| {
        format!(", `{}` for example", drawing.display())
    })
}

impl ReadError {
    /// That there is no file at `path`.
    pub(crate) fn missing(path: &Path) -> Self {
        Self::Missing {
            path: path.to_owned(),
            near: search::similar(path),
        }
    }

    fn folder(path: &Path) -> Self {
        let drawing = search::drawings(path).into_iter().next();
        Self::Folder {
            path: path.to_owned(),
            drawing,
        }
    }
}

/// The bytes of the drawing at `path`, decompressed if they are gzip; `-` is stdin.
///
/// Compression is recognised by the first bytes, not by the file name.
///
/// # Errors
/// If the file cannot be read, is too large, cannot be decompressed, or is a file of another kind.
pub(crate) fn read_drawing(path: &Path) -> Result<Vec<u8>, ReadError> {
    let bytes = read_file(path)?;
    match sniff::not_a_drawing(&bytes) {
        Some(kind) => Err(ReadError::NotADrawing {
            path: path.to_owned(),
            kind,
        }),
        None => Ok(bytes),
    }
}

/// The bytes of the file at `path`, of any kind, decompressed if they are gzip; `-` is stdin.
///
/// # Errors
/// If the file cannot be read, is too large, or cannot be decompressed.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, ReadError> {
    let bytes = if super::is_standard_stream(path) {
        read_limited(io::stdin().lock(), DRAWING_LIMIT, 0)
    } else {
        open(path)?
    };
    let bytes = bytes
        .map_err(|source| failure(path, source))?
        .ok_or_else(|| ReadError::TooLarge(path.to_owned()))?;
    unpack(path, bytes)
}

/// A reader of the bytes of the file at `path`; `-` is stdin.
///
/// # Errors
/// If the file cannot be opened.
pub(crate) fn open_stream(path: &Path) -> Result<Box<dyn Read>, ReadError> {
    if super::is_standard_stream(path) {
        return Ok(Box::new(io::stdin().lock()));
    }
    let file = File::open(path).map_err(|source| failure(path, source))?;
    if file.metadata().is_ok_and(|metadata| metadata.is_dir()) {
        Err(ReadError::folder(path))
    } else {
        Ok(Box::new(file))
    }
}

fn open(path: &Path) -> Result<io::Result<Option<Vec<u8>>>, ReadError> {
    let file = File::open(path).map_err(|source| failure(path, source))?;
    let metadata = file.metadata();
    if metadata.as_ref().is_ok_and(Metadata::is_dir) {
        Err(ReadError::folder(path))
    } else {
        // Reserves the full size, because a growing buffer would need twice the memory.
        let size = metadata.map_or(0, |metadata| metadata.len().min(DRAWING_LIMIT));
        Ok(read_limited(file, DRAWING_LIMIT, size))
    }
}

/// The first bytes of a compressed file.
const GZIP: [u8; 2] = [0x1F, 0x8B];

/// Whether the file at `path` is compressed.
pub(crate) fn is_packed(path: &Path) -> bool {
    let mut first = [0; 2];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut first));
    read.is_ok() && first == GZIP
}

fn unpack(path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, ReadError> {
    if !bytes.starts_with(&GZIP) {
        return Ok(bytes);
    }
    read_limited(MultiGzDecoder::new(&*bytes), UNPACKED_LIMIT, 0)
        .map_err(|source| ReadError::Damaged {
            path: path.to_owned(),
            source,
        })?
        .ok_or_else(|| ReadError::TooLargeUnpacked(path.to_owned()))
}

/// All bytes of `source`, about `expected` of them; `None` if there are more than `limit`.
pub(super) fn read_limited(
    source: impl Read,
    limit: u64,
    expected: u64,
) -> io::Result<Option<Vec<u8>>> {
    // One byte more, to detect the end.
    let mut bytes = Vec::with_capacity(expected as usize + 1);
    source.take(limit + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}

fn failure(path: &Path, source: io::Error) -> ReadError {
    match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => return ReadError::missing(path),
        io::ErrorKind::IsADirectory => return ReadError::folder(path),
        _ => {}
    }
    let path = path.to_owned();
    match source.kind() {
        io::ErrorKind::PermissionDenied => ReadError::Denied(path),
        _ => ReadError::Failed { path, source },
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn gzip(pieces: &[&[u8]]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(vec![], Compression::fast());
        for piece in pieces {
            encoder.write_all(piece).unwrap();
        }
        encoder.finish().unwrap()
    }

    #[test]
    fn drawings_are_read_plain_and_packed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        for bytes in [b"<svg/>".to_vec(), gzip(&[b"<svg/>"]), {
            let mut members = gzip(&[b"<sv"]);
            members.extend(gzip(&[b"g/>"]));
            members
        }] {
            std::fs::write(&path, bytes).unwrap();
            assert_eq!(read_drawing(&path).unwrap(), b"<svg/>");
        }
        std::fs::write(&path, b"").unwrap();
        assert_eq!(read_drawing(&path).unwrap(), b"");
    }

    #[test]
    fn failures_say_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.svg");
        let message = |path: &Path| {
            let message = read_drawing(path).unwrap_err().to_string();
            message.replace(folder.path().to_str().unwrap(), "")
        };
        assert_eq!(message(&path), "`/a.svg` is not there; check the path");
        assert_eq!(
            message(folder.path()),
            "`` is a folder; name a drawing in it"
        );
        std::fs::write(folder.path().join("cat.svg"), "").unwrap();
        assert_eq!(
            message(folder.path()),
            "`` is a folder; name a drawing in it, `/cat.svg` for example"
        );
        for near in ["cat", "Cat.svg", "cta.svg", "cat.SVG", "cat.png"] {
            assert_eq!(
                message(&folder.path().join(near)),
                format!("`/{near}` is not there; did you mean `/cat.svg`?")
            );
        }
        std::fs::write(folder.path().join("a.png"), b"\x89PNG\r\n").unwrap();
        assert!(message(&folder.path().join("a.png")).starts_with("`/a.png` is a PNG picture"));
        let mut cut = gzip(&[b"<svg/>"]);
        cut.truncate(12);
        std::fs::write(&path, cut).unwrap();
        assert!(message(&path).starts_with("`/a.svg` is compressed, but damaged"));
        assert_eq!(
            message(&path.join("b.svg")),
            "`/a.svg/b.svg` is not there; check the path"
        );
    }

    #[test]
    fn a_bomb_is_not_unpacked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bomb.svgz");
        let zeros = vec![0; 1 << 20];
        let pieces = vec![&*zeros; (UNPACKED_LIMIT >> 20) as usize + 1];
        std::fs::write(&path, gzip(&pieces)).unwrap();
        let message = read_drawing(&path).unwrap_err().to_string();
        assert!(message.contains("limit of 256 MiB"), "{message}");
    }
}
