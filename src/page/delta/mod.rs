//! What changed between two models: pages change the model that they have, instead of loading another.
//!
//! A delta is four bytes, [`MAGIC`]; the length of its text in bytes, 32 bits with the lowest byte first; the text, JSON that is padded
//! with spaces to a multiple of four bytes; and numbers. The text has:
//!
//! - `since`: the number of the model before.
//! - `nodes`: the nodes whose own fields changed, such as transforms, by their numbers in the model (`node`), with all of these fields.
//! - `materials`: a glTF that has nothing but materials.
//! - `layouts`: `attributes`, lists of the name, the type of components (that of glTF's accessors), the number of components and whether they
//!   are normalized; and `indices`, their type or null.
//! - `primitives`: lists of the numbers of material and layout, how many vertices and indices there are, and the least and greatest coordinates
//!   of the vertices. The numbers of all primitives follow one another, of each attribute and then the indices, each padded to four bytes.
//! - `meshes`: lists of a node's number and those of the primitives of its new mesh.
//!
//! It is no glTF file, because a loader of those takes several times as long to read ten thousand small meshes. Where more than this changed,
//! such as the hierarchy or a clip, there is no delta.

mod file;
#[cfg(test)]
mod tests;
mod writer;

use std::collections::BTreeMap;

use gltf::binary::Glb;
use serde_json::value::RawValue;

use file::{File, same_fields};
use writer::Writer;

/// How a delta begins.
const MAGIC: &[u8] = b"okdl";

/// Fields by their names.
type Fields<'a> = BTreeMap<&'a str, &'a RawValue>;

/// Fields of a node that may change without changing the hierarchy.
const OWN: [&str; 5] = ["extras", "matrix", "rotation", "scale", "translation"];

/// The delta from one model to another, both in binary glTF; `None` if they differ in too much.
pub(super) fn delta(before: &[u8], after: &[u8], since: u64) -> Option<Vec<u8>> {
    let [before, after] = [Glb::from_slice(before).ok()?, Glb::from_slice(after).ok()?];
    let [before, after] = [File::read(&before)?, File::read(&after)?];
    if !before.has_same_outline(&after)? {
        return None;
    }
    let mut delta = Writer::new(&after);
    for (index, (old, new)) in before.nodes.iter().zip(&after.nodes).enumerate() {
        if !same_fields(old, new, |name| name != "mesh" && !OWN.contains(&name)) {
            return None;
        }
        if !same_fields(old, new, |name| OWN.contains(&name)) {
            delta.add_fields(index, new);
        }
        match (before.mesh(old)?, after.mesh(new)?) {
            (None, None) => {}
            (Some(mesh), Some(next)) if mesh.is_replaceable_by(&next) => {
                if !mesh.is_same(&before, &next, &after)? {
                    // Beside a camera, the mesh would be in another place of the loaded node.
                    (!new.contains_key("camera")).then_some(())?;
                    delta.add_mesh(index, &next)?;
                }
            }
            _ => return None,
        }
    }
    delta.write(since)
}
