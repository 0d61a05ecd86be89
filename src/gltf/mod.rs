//! Writes a [`Scene`] as glTF 2.0. Knows nothing of drawings.
//!
//! The same scene gives the same bytes. What is written: one glTF scene with the virtual node `Root`,
//! under it the scene's nodes (node `i` of the scene is node `i` of the file, `Root` comes last), one
//! mesh a part with a primitive a material, and one buffer with one view for each kind of data, so
//! that the JSON stays small. Nothing is copied on the way: the arrays of the scene are packed through
//! one small buffer.

mod document;
mod layout;
mod packing;
#[cfg(test)]
mod tests;

use std::io::{self, Write};

use crate::scene::Scene;
use document::Document;
use layout::Layout;

/// The name of the virtual node that holds the parts without a parent.
pub const ROOT: &str = "Root";

/// How the JSON and the binary data are put into one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// Binary glTF, `.glb`.
    Glb,
    /// JSON with the binary data inside it as base64, `.gltf`.
    Gltf,
}

/// Writes `scene`.
///
/// Primitives without triangles are left out, and meshes without primitives. A scene that breaks its
/// own rules (a corner that is no number, an index out of range) or that does not fit into the
/// container is an [`io::ErrorKind::InvalidInput`], seen before the first byte is written.
pub fn write(
    scene: &Scene,
    container: Container,
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    let layout = Layout::new(scene)?;
    match container {
        Container::Glb => write_glb(scene, &layout, out),
        Container::Gltf => write_gltf(scene, &layout, out),
    }
}

fn write_glb(scene: &Scene, layout: &Layout, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    const HEADER: u64 = 12;
    const CHUNK_HEADER: u64 = 8;

    let mut json = json_without_buffer(scene, layout)?;
    let length = layout.byte_length();
    if length > 0 {
        write!(json, r#","buffers":[{{"byteLength":{length}}}]"#)?;
    }
    json.push(b'}');
    json.resize(json.len().next_multiple_of(4), b' ');

    let data = length.next_multiple_of(4);
    let data_chunk = if data == 0 { 0 } else { CHUNK_HEADER + data };
    let total = HEADER + CHUNK_HEADER + json.len() as u64 + data_chunk;
    let total = u32::try_from(total).map_err(|_| {
        invalid(format!(
            "the model takes {total} bytes, but a .glb file ends at 4 GiB; write .gltf instead"
        ))
    })?;

    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&total.to_le_bytes())?;
    out.write_all(&(json.len() as u32).to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(&json)?;
    drop(json);
    if data > 0 {
        out.write_all(&(data as u32).to_le_bytes())?;
        out.write_all(b"BIN\0")?;
        packing::pack(scene, out)?;
        out.write_all(&[0; 3][..(data - length) as usize])?;
    }
    Ok(())
}

fn write_gltf(scene: &Scene, layout: &Layout, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    out.write_all(&json_without_buffer(scene, layout)?)?;
    let length = layout.byte_length();
    if length > 0 {
        write!(
            out,
            r#","buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,"#
        )?;
        let base64 = &base64::engine::general_purpose::STANDARD;
        let mut encoder = base64::write::EncoderWriter::new(&mut *out, base64);
        packing::pack(scene, &mut encoder)?;
        encoder.finish()?;
        drop(encoder);
        out.write_all(br#""}]"#)?;
    }
    out.write_all(b"}")
}

/// The JSON up to the buffer, which comes last in the file because it may hold all the data: the
/// closing brace is missing.
fn json_without_buffer(scene: &Scene, layout: &Layout) -> io::Result<Vec<u8>> {
    // Room for nearly all of it, so that it is not copied while it grows.
    let room = 1024 + scene.nodes.len() * 320 + scene.meshes.len() * 480;
    let mut json = Vec::with_capacity(room);
    serde_json::to_writer(&mut json, &Document::new(scene, layout))?;
    json.pop();
    Ok(json)
}

fn invalid(message: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message.into())
}
