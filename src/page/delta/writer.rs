//! Writes a delta.

use std::collections::BTreeMap;

use gltf::binary::{Glb, Header};
use serde::Serialize;
use serde_json::value::{RawValue, to_raw_value};

use super::file::{File, Mesh, View, number, read};
use super::{Fields, OWN};

/// A node whose own fields changed.
#[derive(Serialize)]
struct Moved<'a> {
    node: usize,
    #[serde(flatten)]
    own: BTreeMap<&'a str, &'a RawValue>,
}

/// A node of a delta, with the number of the model's node that gets its mesh.
#[derive(Serialize)]
struct Changed {
    mesh: usize,
    extras: Target,
}

#[derive(Serialize)]
struct Target {
    node: usize,
}

/// A delta that is being written.
pub(super) struct Writer<'a> {
    file: &'a File<'a>,
    moved: Vec<Moved<'a>>,
    nodes: Vec<Changed>,
    meshes: Vec<BTreeMap<&'a str, Box<RawValue>>>,
    materials: Vec<&'a RawValue>,
    /// The numbers of the model's materials in the delta.
    numbers_of_materials: BTreeMap<usize, usize>,
    accessors: Vec<BTreeMap<&'a str, Box<RawValue>>>,
    numbers_of_accessors: BTreeMap<usize, usize>,
    views: Vec<View>,
    data: Vec<u8>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(file: &'a File<'a>) -> Self {
        Self {
            file,
            moved: vec![],
            nodes: vec![],
            meshes: vec![],
            materials: vec![],
            numbers_of_materials: BTreeMap::new(),
            accessors: vec![],
            numbers_of_accessors: BTreeMap::new(),
            views: vec![],
            data: vec![],
        }
    }

    /// Adds the fields of a node that may change.
    pub(super) fn add_fields(&mut self, node: usize, fields: &Fields<'a>) {
        let own = fields.iter().filter(|(name, _)| OWN.contains(name));
        let own = own.map(|(name, value)| (*name, *value)).collect();
        self.moved.push(Moved { node, own });
    }

    /// Adds the mesh of a node.
    pub(super) fn add_mesh(&mut self, node: usize, mesh: Mesh<'a>) -> Option<()> {
        let mut primitives = Vec::with_capacity(mesh.primitives.len());
        for primitive in mesh.primitives {
            let mut fields = owned(&primitive.fields);
            if let Some(material) = number(&primitive.fields, "material") {
                fields.insert("material", raw(&self.material(material)?)?);
            }
            if let Some(indices) = primitive.indices() {
                fields.insert("indices", raw(&self.accessor(indices)?)?);
            }
            let mut attributes = BTreeMap::new();
            for (name, accessor) in primitive.attributes {
                attributes.insert(name, self.accessor(accessor)?);
            }
            fields.insert("attributes", raw(&attributes)?);
            primitives.push(fields);
        }
        let mut fields = owned(&mesh.fields);
        fields.insert("primitives", raw(&primitives)?);
        self.nodes.push(Changed {
            mesh: self.meshes.len(),
            extras: Target { node },
        });
        self.meshes.push(fields);
        Some(())
    }

    /// The number in the delta of a material of the model.
    fn material(&mut self, index: usize) -> Option<usize> {
        let material = *self.file.materials.get(index)?;
        let next = self.materials.len();
        let number = *self.numbers_of_materials.entry(index).or_insert(next);
        if number == next {
            self.materials.push(material);
        }
        Some(number)
    }

    /// The number in the delta of an accessor of the model.
    fn accessor(&mut self, index: usize) -> Option<usize> {
        if let Some(number) = self.numbers_of_accessors.get(&index) {
            return Some(*number);
        }
        let numbers = self.file.numbers(index)?;
        let mut fields = owned(&read::<Fields>(self.file.accessor(index)?)?);
        fields.remove("byteOffset");
        fields.insert("bufferView", raw(&self.views.len())?);
        self.views.push(View {
            buffer: 0,
            byte_offset: self.data.len(),
            byte_length: numbers.bytes.len(),
            ..numbers.view
        });
        self.data.extend_from_slice(numbers.bytes);
        // Numbers begin at multiples of their size.
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        self.numbers_of_accessors
            .insert(index, self.accessors.len());
        self.accessors.push(fields);
        Some(self.accessors.len() - 1)
    }

    /// The file.
    pub(super) fn write(self, since: u64) -> Option<Vec<u8>> {
        let kept = ["asset", "extensionsUsed", "extensionsRequired"];
        let fields = self.file.fields.iter();
        let mut fields: BTreeMap<&str, Box<RawValue>> = fields
            .filter(|(name, _)| kept.contains(name))
            .map(|(name, value)| (*name, (*value).to_owned()))
            .collect();
        // glTF has no empty lists.
        if !self.nodes.is_empty() {
            let changed: Vec<usize> = (0..self.nodes.len()).collect();
            fields.insert("scene", raw(&0)?);
            fields.insert("scenes", raw(&[BTreeMap::from([("nodes", changed)])])?);
            fields.insert("nodes", raw(&self.nodes)?);
            fields.insert("meshes", raw(&self.meshes)?);
            fields.insert("accessors", raw(&self.accessors)?);
            fields.insert("bufferViews", raw(&self.views)?);
            let length = self.data.len();
            fields.insert("buffers", raw(&[BTreeMap::from([("byteLength", length)])])?);
        }
        if !self.materials.is_empty() {
            fields.insert("materials", raw(&self.materials)?);
        }
        let own = BTreeMap::from([("since", raw(&since)?), ("nodes", raw(&self.moved)?)]);
        fields.insert("extras", raw(&BTreeMap::from([("okoshi", own)]))?);
        let glb = Glb {
            header: Header {
                magic: *b"glTF",
                version: 2,
                // Computed when it is written.
                length: 0,
            },
            json: serde_json::to_vec(&fields).ok()?.into(),
            bin: (!self.data.is_empty()).then(|| self.data.into()),
        };
        glb.to_vec().ok()
    }
}

fn raw(value: &impl Serialize) -> Option<Box<RawValue>> {
    to_raw_value(value).ok()
}

fn owned<'a>(fields: &Fields<'a>) -> BTreeMap<&'a str, Box<RawValue>> {
    let fields = fields.iter();
    fields
        .map(|(name, value)| (*name, (*value).to_owned()))
        .collect()
}
