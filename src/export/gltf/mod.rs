//! glTF 2.0.
//!
//! The file has one scene with the virtual node `Root` and under it the scene's nodes (node `i` of the scene is node `i`
//! of the file, `Root` comes last), one mesh a part with a primitive a material, the animations with exactly the keys
//! that they have, and one buffer, which holds images and keys too.

mod animations;
mod buffer;
mod document;
mod json;
mod materials;
mod primitives;
#[cfg(test)]
mod tests;

use std::io;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;

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
        let packed = Packed::new(scene, memo, &mut |bytes| out.set_aside(bytes))?;
        let mut json = document::describe(scene, &packed)?;
        let length = packed.layout.length;
        if length > 0 {
            json.push(format!(r#","buffers":[{{"byteLength":{length}}}]"#));
        }
        json.push("}");
        // Chunks begin at multiples of four.
        json.push(&"   "[..(json.len().next_multiple_of(4) - json.len()) as usize]);
        write_headers(out, json.len(), length)?;
        json.write_to(out)?;
        if length > 0 {
            out.write_all(&(length as u32).to_le_bytes())?;
            out.write_all(b"BIN\0")?;
            out.append_set_aside()?;
        }
        Ok(packed.written())
    }
}

/// The header of the file and that of its JSON chunk.
fn write_headers(out: &mut dyn Output, json: u64, data: u64) -> io::Result<()> {
    const FILE_HEADER: u64 = 12;
    const CHUNK_HEADER: u64 = 8;
    let data = if data == 0 { 0 } else { CHUNK_HEADER + data };
    let total = FILE_HEADER + CHUNK_HEADER + json + data;
    let total = u32::try_from(total).map_err(|_| {
        invalid(format!(
            "the model takes {total} bytes, but a .glb file ends at 4 GiB; write .gltf instead"
        ))
    })?;
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&total.to_le_bytes())?;
    out.write_all(&(json as u32).to_le_bytes())?;
    out.write_all(b"JSON")
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
        // Base64 holds three bytes in four characters, so pieces of any other length wait for the rest.
        let mut rest = Vec::new();
        let packed = Packed::new(scene, memo, &mut |bytes| {
            rest.extend_from_slice(bytes);
            let whole = rest.len() / 3 * 3;
            out.set_aside(BASE64.encode(&rest[..whole]).as_bytes())?;
            rest.drain(..whole);
            Ok(())
        })?;
        out.set_aside(BASE64.encode(&rest).as_bytes())?;
        let mut json = document::describe(scene, &packed)?;
        let length = packed.layout.length;
        if length == 0 {
            json.push("}");
            json.write_to(out)?;
        } else {
            json.push(format!(
                r#","buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,"#
            ));
            json.write_to(out)?;
            out.append_set_aside()?;
            out.write_all(br#""}]}"#)?;
        }
        Ok(packed.written())
    }
}
