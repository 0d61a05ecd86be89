//! Writes a [`Scene`] as glTF 2.0. Knows nothing of drawings.
//!
//! The same scene gives the same bytes. What is written: one glTF scene with the virtual node `Root`,
//! under it the scene's nodes (node `i` of the scene is node `i` of the file, `Root` comes last), one
//! mesh a part with a primitive a material, the animations with exactly the keys that they have, and one buffer, which holds
//! images and keys too. Solids are made while they are written, so
//! that a large model is never in memory as a whole.

mod animations;
mod check;
mod document;
mod lists;
mod looks;
mod memory;
mod packing;
mod room;
mod spool;
#[cfg(test)]
mod tests;

use std::io::{self, Seek, Write};

use crate::scene::Scene;
use crate::threads;
use memory::Used;
use spool::Spool;

pub use memory::Memory;

/// The name of the virtual node that holds the parts without a parent.
pub const ROOT: &str = "Root";

/// The name of the node that shows a skinned mesh.
pub const SKINNED: &str = "Figure";

/// The extension by which nodes follow the viewer (docs/view-dependent.md).
pub const VIEW_DEPENDENT: &str = "OKOSHI_view_dependent";

/// How the JSON and the binary data are put into one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// Binary glTF, `.glb`.
    Glb,
    /// JSON with the binary data inside it as base64, `.gltf`.
    Gltf,
}

/// How much was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Written {
    /// Corners of triangles, shared ones once.
    pub corners: usize,
    /// Triangles.
    pub triangles: usize,
    /// Bytes of binary data, JSON not counted.
    pub bytes: u64,
}

/// Writes `scene` at the place where `out` stands.
///
/// Primitives without triangles are left out, and meshes without primitives.
///
/// # Errors
/// What `out` answers; [`io::ErrorKind::InvalidInput`] for a scene that breaks its own rules (a corner that is
/// no number, an index out of range) or that does not fit into the container.
pub fn write(
    scene: &Scene,
    container: Container,
    out: &mut (impl Write + Seek + Send + ?Sized),
) -> io::Result<Written> {
    written(scene, container, out, None)
}

/// Writes `scene` as [`write()`] does; solids that are in `memory` are not made anew, and those of `scene` will be in it.
///
/// # Errors
/// Those of [`write()`]; `memory` is as it was then.
pub fn write_again(
    scene: &Scene,
    container: Container,
    out: &mut (impl Write + Seek + Send + ?Sized),
    memory: &mut Memory,
) -> io::Result<Written> {
    let mut used = Used::default();
    let written = written(scene, container, out, Some((memory, &mut used)))?;
    memory.keep(used);
    Ok(written)
}

/// What is remembered, and what of it is used.
type Again<'a> = Option<(&'a Memory, &'a mut Used)>;

fn written(
    scene: &Scene,
    container: Container,
    out: &mut (impl Write + Seek + Send + ?Sized),
    again: Again<'_>,
) -> io::Result<Written> {
    check::check(scene)?;
    let written = threads::run(|| match container {
        Container::Glb => {
            let mut spool = Spool::new(out, room::room(scene)?);
            let packed = packing::pack(scene, again, |bytes| spool.push(bytes))?;
            spool.finish(|out| {
                document::write(scene, &packed, out)?;
                if packed.length > 0 {
                    write!(out, r#","buffers":[{{"byteLength":{}}}]"#, packed.length)?;
                }
                out.write_all(b"}")
            })?;
            Ok(packed.total())
        }
        Container::Gltf => write_gltf(scene, out, again),
    });
    written.unwrap_or_else(|| {
        Err(io::Error::other(
            "a solid cannot be made: this should not happen, please tell us",
        ))
    })
}

fn write_gltf(
    scene: &Scene,
    out: &mut (impl Write + ?Sized),
    again: Again<'_>,
) -> io::Result<Written> {
    let mut data = Vec::new();
    let packed = packing::pack(scene, again, |bytes| {
        data.extend_from_slice(bytes);
        Ok(())
    })?;
    document::write(scene, &packed, out)?;
    if packed.length > 0 {
        let length = packed.length;
        write!(
            out,
            r#","buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,"#
        )?;
        let base64 = &base64::engine::general_purpose::STANDARD;
        let mut encoder = base64::write::EncoderWriter::new(&mut *out, base64);
        encoder.write_all(&data)?;
        encoder.finish()?;
        drop(encoder);
        out.write_all(br#""}]"#)?;
    }
    out.write_all(b"}")?;
    Ok(packed.total())
}

fn invalid(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message.into())
}
