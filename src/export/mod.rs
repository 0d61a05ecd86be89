//! Writes a [`Scene`] as a file that other programs read. Knows nothing of drawings.
//!
//! Each format is an [`Exporter`], listed once in [`EXPORTERS`]; every command looks it up there. The same scene gives the
//! same bytes. Surfaces that a scene makes on demand are made while they are written, so that a large model is never in
//! memory as a whole.

mod check;
mod gltf;
mod obj;
mod output;
mod size;
mod surfaces;

use std::path::Path;
use std::{fmt, io};

use crate::crash;
use crate::memo::Memo;
use crate::scene::{Scene, Size};
use crate::threads;

pub use gltf::{GLB, GLTF, ROOT, SKINNED, VIEW_DEPENDENT};
pub use obj::OBJ;
pub use output::{Output, SeekableOutput};

/// All formats, in the order in which messages list them.
pub const EXPORTERS: &[&dyn Exporter] = &[&GLB, &GLTF, &OBJ];

/// A file format for models.
pub trait Exporter: Sync {
    /// The file extension, in lower case and without its dot.
    fn extension(&self) -> &'static str;

    /// What the file holds, in a few words, for help and messages.
    fn description(&self) -> &'static str;

    /// Whether the format holds animations.
    fn is_animated(&self) -> bool;

    /// Writes a scene that is valid; [`write()`] has checked that.
    ///
    /// # Errors
    /// The errors of `out`; [`io::ErrorKind::InvalidInput`] for an invalid surface, or a scene that the format cannot hold.
    fn write(&self, scene: &Scene, out: &mut dyn Output, memo: &Memo) -> io::Result<Written>;
}

impl PartialEq for dyn Exporter {
    fn eq(&self, other: &Self) -> bool {
        self.extension() == other.extension()
    }
}

impl fmt::Debug for dyn Exporter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.extension())
    }
}

/// How much was written.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Written {
    /// Vertices, shared ones once.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Bytes of geometry, images and animation keys; their description is not counted.
    pub bytes: u64,
    /// The size of the model; `None` without triangles.
    pub size: Option<Size>,
}

/// A model as a file in memory.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Model {
    /// The file.
    pub bytes: Vec<u8>,
    /// How much that is.
    pub written: Written,
}

/// The exporter for a file's extension, in upper or lower case.
pub fn by_extension(path: &Path) -> Option<&'static dyn Exporter> {
    let extension = path.extension()?.to_str()?;
    let mut exporters = EXPORTERS.iter().copied();
    exporters.find(|exporter| exporter.extension().eq_ignore_ascii_case(extension))
}

/// The extensions of some exporters for a message: `.glb, .gltf or .obj`.
pub fn extensions(wanted: impl Fn(&dyn Exporter) -> bool) -> String {
    let wanted = EXPORTERS.iter().filter(|exporter| wanted(**exporter));
    let names: Vec<String> = wanted.map(|e| format!(".{}", e.extension())).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// Writes `scene` to `out`, which is empty. Surfaces that `memo` holds are not made again; afterwards it holds those of `scene`
/// and no others.
///
/// Primitives without triangles are left out, and meshes without primitives.
///
/// # Errors
/// The errors of `out`; [`io::ErrorKind::InvalidInput`] for a scene that breaks its own rules (a vertex that is not a
/// number, an index out of range) or that the format cannot hold.
pub fn write(
    exporter: &dyn Exporter,
    scene: &Scene,
    out: &mut dyn Output,
    memo: Option<&mut Memo>,
) -> io::Result<Written> {
    check::check(scene)?;
    let mut run = |memo: &Memo| making_surfaces(|| exporter.write(scene, out, memo));
    let Some(memo) = memo else {
        return run(&Memo::none());
    };
    let written = run(memo)?;
    memo.next_generation();
    Ok(written)
}

/// Writes `scene` to memory as [`write()`] does.
///
/// # Errors
/// Those of [`write()`].
pub fn to_memory(
    exporter: &dyn Exporter,
    scene: &Scene,
    memo: Option<&mut Memo>,
) -> io::Result<Model> {
    let mut out = SeekableOutput::new(io::Cursor::new(Vec::new()));
    let written = write(exporter, scene, &mut out, memo)?;
    Ok(Model {
        bytes: out.finish()?.into_inner(),
        written,
    })
}

/// The size of a scene that is not written; `None` without triangles. It takes as long as its surfaces take to make.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a scene that breaks its own rules.
pub(crate) fn size(scene: &Scene) -> io::Result<Option<Size>> {
    check::check(scene)?;
    making_surfaces(|| size::measured(scene))
}

/// Runs work that makes surfaces, on threads with enough space for them; a crash is an error.
fn making_surfaces<R: Send>(work: impl FnOnce() -> io::Result<R> + Send) -> io::Result<R> {
    let done = threads::run(work);
    done.unwrap_or_else(|crash| Err(io::Error::other(format!("{crash}; {}", crash::HELP))))
}

fn invalid(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message.into())
}
