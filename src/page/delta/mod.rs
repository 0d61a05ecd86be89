//! What changed between two models, as binary glTF: pages change the model that they have, instead of loading another.
//!
//! The file has a flat scene of the nodes whose meshes changed, each with its number in the model (`extras.node`). The
//! file's `extras.okoshi.nodes` lists the nodes whose own fields changed, such as transforms, with all of these fields.
//! Where more than that changed, such as the hierarchy or a clip, there is no delta.

mod file;
#[cfg(test)]
mod tests;
mod writer;

use std::collections::BTreeMap;

use gltf::binary::Glb;
use serde_json::value::RawValue;

use file::{File, same_fields};
use writer::Writer;

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
                    delta.add_mesh(index, next)?;
                }
            }
            _ => return None,
        }
    }
    delta.write(since)
}
