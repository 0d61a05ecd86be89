//! glTF 2.0.
//!
//! The file has one scene with the virtual node `Root` and under it the scene's nodes (node `i` of the scene is node `i`
//! of the file, `Root` comes last), one mesh a part with a primitive a material, the animations with exactly the keys
//! that they have, the cameras, and one buffer, which holds images and keys too.

mod animations;
mod buffer;
mod cameras;
mod document;
mod json;
mod materials;
mod primitives;
#[cfg(test)]
mod tests;

use std::io::{self, Read as _, Write as _};

use base64::engine::general_purpose::STANDARD as BASE64;
use base64::write::EncoderWriter;

use super::{Exporter, Output, Written, invalid};
use crate::memo::Memo;
use crate::scene::Scene;
use primitives::Packed;

/// The name of the virtual node that holds the parts without a parent.
pub const ROOT: &str = "Root";

/// The name of the node that shows a skinned mesh.
pub const SKINNED: &str = "Figure";

/// The extension by which nodes follow the viewer (docs/view-dependent.md).
pub const VIEW_DEPENDENT: &str = "OKOSHI_view_dependent";

/// Binary glTF, `.glb`.
pub const GLB: Glb = Glb;

/// glTF as text, `.gltf`.
pub const GLTF: Gltf = Gltf;

/// Binary glTF: JSON and binary data in one file.
#[derive(Debug, Clone, Copy)]
pub struct Glb;

/// glTF as JSON, with the binary data in it as base64.
#[derive(Debug, Clone, Copy)]
pub struct Gltf;

impl Exporter for Glb {
    fn extension(&self) -> &'static str {
        "glb"
    }

    fn description(&self) -> &'static str {
        "binary glTF: the whole model in one compact file"
    }

    fn is_animated(&self) -> bool {
        true
    }

    fn write(&self, scene: &Scene, out: &mut dyn Output, memo: &Memo) -> io::Result<Written> {
        const FILE_HEADER: u64 = 12;
        const CHUNK_HEADER: u64 = 8;
        out.reserve_head(document::estimate_length(scene).next_multiple_of(4));
        let packed = Packed::new(scene, memo, &mut |bytes| out.write_all(bytes))?;
        let mut json = document::describe(scene, &packed)?;
        let data = packed.layout.length;
        let mut headers = FILE_HEADER + CHUNK_HEADER;
        if data > 0 {
            json.push(format!(r#","buffers":[{{"byteLength":{data}}}]"#));
            headers += CHUNK_HEADER;
        }
        json.push("}");
        // Chunks begin at multiples of four.
        let head = out.start_head((headers + json.len()).next_multiple_of(4))?;
        let total = head + data;
        let total = u32::try_from(total).map_err(|_| {
            invalid(format!(
                "the model takes {total} bytes, but a .glb file ends at 4 GiB; write .gltf instead"
            ))
        })?;
        out.write_all(b"glTF")?;
        out.write_all(&2_u32.to_le_bytes())?;
        out.write_all(&total.to_le_bytes())?;
        out.write_all(&((head - headers) as u32).to_le_bytes())?;
        out.write_all(b"JSON")?;
        json.write_to(out)?;
        io::copy(&mut io::repeat(b' ').take(head - headers - json.len()), out)?;
        if data > 0 {
            out.write_all(&(data as u32).to_le_bytes())?;
            out.write_all(b"BIN\0")?;
        }
        Ok(packed.written())
    }
}

impl Exporter for Gltf {
    fn extension(&self) -> &'static str {
        "gltf"
    }

    fn description(&self) -> &'static str {
        "glTF as text: JSON with its binary data inside"
    }

    fn is_animated(&self) -> bool {
        true
    }

    fn write(&self, scene: &Scene, out: &mut dyn Output, memo: &Memo) -> io::Result<Written> {
        out.reserve_head(document::estimate_length(scene));
        let mut base64 = EncoderWriter::new(&mut *out, &BASE64);
        let packed = Packed::new(scene, memo, &mut |bytes| base64.write_all(bytes))?;
        base64.finish()?;
        drop(base64);
        let json = document::describe(scene, &packed)?;
        let length = packed.layout.length;
        let buffers = format!(
            r#","buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,"#
        );
        let (buffers, end) = match length {
            0 => ("", "}"),
            _ => (&*buffers, r#""}]}"#),
        };
        out.write_all(end.as_bytes())?;
        let length = json.len() + buffers.len() as u64;
        let head = out.start_head(length)?;
        json.write_to(out)?;
        io::copy(&mut io::repeat(b' ').take(head - length), out)?;
        out.write_all(buffers.as_bytes())?;
        Ok(packed.written())
    }
}
