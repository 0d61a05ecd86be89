//! A model, read as far as models are compared.

use std::collections::BTreeMap;

use gltf::binary::Glb;
use serde::Deserialize;
use serde_json::value::RawValue;

use super::Fields;

/// Fields of the file that are compared by what they hold, not by their text.
const COMPARED: [&str; 8] = [
    "accessors",
    "animations",
    "bufferViews",
    "buffers",
    "materials",
    "meshes",
    "nodes",
    "skins",
];
/// Fields of files in which the look of a node depends on more than its mesh, its materials and its transform.
const DEPENDENT: [&str; 2] = ["images", "textures"];

/// A model, read as far as it is compared.
pub(super) struct File<'a> {
    pub(super) fields: Fields<'a>,
    pub(super) nodes: Vec<Fields<'a>>,
    meshes: Vec<&'a RawValue>,
    pub(super) materials: Vec<&'a RawValue>,
    accessors: Vec<&'a RawValue>,
    views: Vec<View>,
    animations: Vec<Fields<'a>>,
    skins: Vec<Fields<'a>>,
    data: &'a [u8],
}

/// A buffer view. Lengths in bytes.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
struct View {
    #[serde(default)]
    byte_offset: usize,
    byte_stride: Option<usize>,
}

/// Where the numbers of an accessor are.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor<'a> {
    buffer_view: usize,
    #[serde(default)]
    byte_offset: usize,
    pub(super) component_type: u32,
    pub(super) count: usize,
    #[serde(default)]
    pub(super) normalized: bool,
    #[serde(rename = "type")]
    shape: &'a str,
    #[serde(borrow)]
    sparse: Option<&'a RawValue>,
    #[serde(borrow)]
    pub(super) min: Option<&'a RawValue>,
    #[serde(borrow)]
    pub(super) max: Option<&'a RawValue>,
}

/// The numbers of an accessor.
pub(super) struct Numbers<'a> {
    pub(super) accessor: Accessor<'a>,
    pub(super) components: usize,
    /// From the beginning of a row to that of the next one, in bytes.
    stride: usize,
    /// The size of a row in bytes.
    size: usize,
    bytes: &'a [u8],
}

impl<'a> Numbers<'a> {
    /// The bytes, if nothing is between the rows.
    pub(super) fn tight(&self) -> Option<&'a [u8]> {
        (self.stride == self.size).then_some(self.bytes)
    }

    fn is_same(&self, other: &Self) -> bool {
        let [one, two] = [self.accessor, other.accessor];
        one.component_type == two.component_type
            && one.count == two.count
            && one.normalized == two.normalized
            && one.shape == two.shape
            && self.stride == other.stride
            && self.bytes == other.bytes
    }
}

impl<'a> File<'a> {
    pub(super) fn read(glb: &'a Glb<'a>) -> Option<Self> {
        let fields: Fields = serde_json::from_slice(&glb.json).ok()?;
        Some(Self {
            nodes: list(&fields, "nodes")?,
            meshes: list(&fields, "meshes")?,
            materials: list(&fields, "materials")?,
            accessors: list(&fields, "accessors")?,
            views: list(&fields, "bufferViews")?,
            animations: list(&fields, "animations")?,
            skins: list(&fields, "skins")?,
            data: glb.bin.as_deref().unwrap_or_default(),
            fields,
        })
    }

    /// Whether everything but nodes and meshes is the same, and a delta can hold these.
    pub(super) fn has_same_outline(&self, other: &Self) -> Option<bool> {
        let is_plain = |file: &Self| {
            let depends = DEPENDENT.iter().any(|name| file.fields.contains_key(name));
            !depends
                && !file
                    .nodes
                    .iter()
                    .any(|node| node.contains_key("extensions"))
        };
        let same = same_fields(&self.fields, &other.fields, |name| {
            !COMPARED.contains(&name)
        }) && self.nodes.len() == other.nodes.len()
            && self.animations.len() == other.animations.len()
            && self.skins.len() == other.skins.len();
        if !(same && is_plain(self) && is_plain(other)) {
            return Some(false);
        }
        const MATRICES: &str = "inverseBindMatrices";
        for (old, new) in self.skins.iter().zip(&other.skins) {
            let [one, two] = [number(old, MATRICES)?, number(new, MATRICES)?];
            let same_joints = same_fields(old, new, |name| name != MATRICES);
            if !same_joints || !self.numbers(one)?.is_same(&other.numbers(two)?) {
                return Some(false);
            }
        }
        for (old, new) in self.animations.iter().zip(&other.animations) {
            if !same_fields(old, new, |name| name != "samplers") {
                return Some(false);
            }
            let [old, new]: [Vec<Fields>; 2] = [list(old, "samplers")?, list(new, "samplers")?];
            if old.len() != new.len() {
                return Some(false);
            }
            for (old, new) in old.iter().zip(&new) {
                let keys = |name: &str| name == "input" || name == "output";
                if !same_fields(old, new, |name| !keys(name)) {
                    return Some(false);
                }
                for key in ["input", "output"] {
                    let [old, new] = [number(old, key)?, number(new, key)?];
                    if !self.numbers(old)?.is_same(&other.numbers(new)?) {
                        return Some(false);
                    }
                }
            }
        }
        Some(true)
    }

    /// The mesh of a node; `Some(None)` if it has none.
    pub(super) fn mesh(&self, node: &Fields<'_>) -> Option<Option<Mesh<'a>>> {
        if !node.contains_key("mesh") {
            return Some(None);
        }
        let fields: Fields = read(self.meshes.get(number(node, "mesh")?)?)?;
        let primitives: Vec<Fields> = list(&fields, "primitives")?;
        let primitives = primitives.into_iter().map(|fields| {
            Some(Primitive {
                attributes: read(fields.get("attributes")?)?,
                fields,
            })
        });
        Some(Some(Mesh {
            primitives: primitives.collect::<Option<_>>()?,
            fields,
        }))
    }

    fn accessor(&self, index: usize) -> Option<&'a RawValue> {
        self.accessors.get(index).copied()
    }

    pub(super) fn numbers(&self, accessor: usize) -> Option<Numbers<'a>> {
        let accessor: Accessor = read(self.accessor(accessor)?)?;
        if accessor.sparse.is_some() {
            return None;
        }
        let view = *self.views.get(accessor.buffer_view)?;
        let components = match accessor.shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => return None,
        };
        let size = components
            * match accessor.component_type {
                5120 | 5121 => 1,
                5122 | 5123 => 2,
                5125 | 5126 => 4,
                _ => return None,
            };
        let stride = view.byte_stride.unwrap_or(size);
        let length = stride.checked_mul(accessor.count.checked_sub(1)?)? + size;
        let start = view.byte_offset + accessor.byte_offset;
        Some(Numbers {
            accessor,
            components,
            stride,
            size,
            bytes: self.data.get(start..)?.get(..length)?,
        })
    }
}

/// The mesh of a node.
pub(super) struct Mesh<'a> {
    pub(super) fields: Fields<'a>,
    pub(super) primitives: Vec<Primitive<'a>>,
}

pub(super) struct Primitive<'a> {
    pub(super) fields: Fields<'a>,
    /// Accessors by the names of attributes.
    pub(super) attributes: BTreeMap<&'a str, usize>,
}

impl Mesh<'_> {
    /// Whether a page can show the other mesh in place of this one.
    pub(super) fn is_replaceable_by(&self, other: &Self) -> bool {
        let morphs = |mesh: &Self| {
            let mut primitives = mesh.primitives.iter();
            primitives.any(|primitive| primitive.fields.contains_key("targets"))
        };
        same_fields(&self.fields, &other.fields, |name| name != "primitives")
            && self.primitives.len() == other.primitives.len()
            && !morphs(self)
            && !morphs(other)
    }

    /// Whether a mesh of a file looks like one of another file.
    pub(super) fn is_same(
        &self,
        file: &File<'_>,
        other: &Self,
        other_file: &File<'_>,
    ) -> Option<bool> {
        const COMPARED: [&str; 3] = ["attributes", "indices", "material"];
        for (old, new) in self.primitives.iter().zip(&other.primitives) {
            let same = same_fields(&old.fields, &new.fields, |name| !COMPARED.contains(&name))
                && old.attributes.keys().eq(new.attributes.keys())
                && file.material(old)? == other_file.material(new)?;
            let [indices, other_indices] = [old.indices(), new.indices()];
            if !same || indices.is_some() != other_indices.is_some() {
                return Some(false);
            }
            let old = old.attributes.values().copied().chain(indices);
            let new = new.attributes.values().copied().chain(other_indices);
            for (old, new) in old.zip(new) {
                if !file.numbers(old)?.is_same(&other_file.numbers(new)?) {
                    return Some(false);
                }
            }
        }
        Some(true)
    }
}

impl Primitive<'_> {
    pub(super) fn indices(&self) -> Option<usize> {
        number(&self.fields, "indices")
    }
}

impl File<'_> {
    /// The description of the material of a primitive; `Some(None)` if it has none.
    fn material(&self, primitive: &Primitive<'_>) -> Option<Option<&str>> {
        match number(&primitive.fields, "material") {
            None => Some(None),
            Some(index) => Some(Some(self.materials.get(index)?.get())),
        }
    }
}

pub(super) fn read<'a, T: Deserialize<'a>>(value: &'a RawValue) -> Option<T> {
    serde_json::from_str(value.get()).ok()
}

/// A list that may be missing.
fn list<'a, T: Deserialize<'a>>(fields: &Fields<'a>, name: &str) -> Option<Vec<T>> {
    match fields.get(name) {
        None => Some(vec![]),
        Some(value) => read(value),
    }
}

pub(super) fn number(fields: &Fields<'_>, name: &str) -> Option<usize> {
    read(fields.get(name)?)
}

/// Whether those fields with wanted names are the same.
pub(super) fn same_fields(
    old: &Fields<'_>,
    new: &Fields<'_>,
    wanted: impl Fn(&str) -> bool,
) -> bool {
    let old = old.iter().filter(|(name, _)| wanted(name));
    let new = new.iter().filter(|(name, _)| wanted(name));
    old.map(|(name, value)| (name, value.get()))
        .eq(new.map(|(name, value)| (name, value.get())))
}
