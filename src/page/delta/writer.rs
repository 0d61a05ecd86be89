//! Writes a delta.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use serde::Serialize;
use serde_json::value::RawValue;

use super::file::{File, Mesh, Primitive, number};
use super::{Fields, MAGIC, OWN};

/// The text of a delta.
#[derive(Serialize)]
struct Text<'a> {
    /// The number of the model that it changes.
    since: u64,
    nodes: &'a [Moved<'a>],
    materials: BTreeMap<&'a str, Box<RawValue>>,
    layouts: &'a [Layout<'a>],
    primitives: &'a [Written<'a>],
    meshes: &'a [Changed],
}

/// A node whose own fields changed.
#[derive(Serialize)]
struct Moved<'a> {
    node: usize,
    #[serde(flatten)]
    own: BTreeMap<&'a str, &'a RawValue>,
}

/// What the arrays of a primitive hold: attributes by their names, each with the type and number of its components and whether they
/// are normalized, and the type of indices.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
struct Layout<'a> {
    attributes: Vec<(&'a str, u32, usize, bool)>,
    indices: Option<u32>,
}

/// A primitive: its material, its layout, how many vertices and indices it has, and the bounds of its vertices.
#[derive(Serialize)]
struct Written<'a>(
    usize,
    usize,
    usize,
    usize,
    Option<&'a RawValue>,
    Option<&'a RawValue>,
);

/// A node whose mesh changed, with the primitives that it has now.
#[derive(Serialize)]
struct Changed(usize, Vec<usize>);

/// A delta that is being written.
pub(super) struct Writer<'a> {
    file: &'a File<'a>,
    moved: Vec<Moved<'a>>,
    meshes: Vec<Changed>,
    materials: Numbered<usize>,
    layouts: Numbered<Layout<'a>>,
    /// What primitives are made of: a material, and the accessors of attributes and indices.
    sources: Numbered<(usize, Vec<usize>)>,
    primitives: Vec<Written<'a>>,
    data: Vec<u8>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(file: &'a File<'a>) -> Self {
        Self {
            file,
            moved: vec![],
            meshes: vec![],
            materials: Numbered::new(),
            layouts: Numbered::new(),
            sources: Numbered::new(),
            primitives: vec![],
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
    pub(super) fn add_mesh(&mut self, node: usize, mesh: &Mesh<'a>) -> Option<()> {
        let primitives = mesh.primitives.iter();
        let primitives = primitives.map(|primitive| self.primitive(primitive));
        let primitives = primitives.collect::<Option<_>>()?;
        self.meshes.push(Changed(node, primitives));
        Some(())
    }

    /// The number in the delta of a primitive of the model.
    fn primitive(&mut self, primitive: &Primitive<'a>) -> Option<usize> {
        let (material, _) = self
            .materials
            .number(number(&primitive.fields, "material")?);
        let indices = primitive.indices();
        let accessors = primitive.attributes.values().copied().chain(indices);
        let (at, is_new) = self.sources.number((material, accessors.collect()));
        if is_new {
            let written = self.write_primitive(primitive, material)?;
            self.primitives.push(written);
        }
        Some(at)
    }

    fn write_primitive(
        &mut self,
        primitive: &Primitive<'a>,
        material: usize,
    ) -> Option<Written<'a>> {
        let mut layout = Layout {
            attributes: Vec::with_capacity(primitive.attributes.len()),
            indices: None,
        };
        let [mut vertices, mut corners] = [0; 2];
        let mut bounds = [None; 2];
        for (name, accessor) in &primitive.attributes {
            let numbers = self.file.numbers(*accessor)?;
            let format = (name, numbers.accessor.component_type, numbers.components);
            let (name, kind, components) = format;
            let normalized = numbers.accessor.normalized;
            layout.attributes.push((name, kind, components, normalized));
            vertices = numbers.accessor.count;
            if *name == "POSITION" {
                bounds = [numbers.accessor.min, numbers.accessor.max];
            }
            self.put(numbers.tight()?);
        }
        if let Some(accessor) = primitive.indices() {
            let numbers = self.file.numbers(accessor)?;
            layout.indices = Some(numbers.accessor.component_type);
            corners = numbers.accessor.count;
            self.put(numbers.tight()?);
        }
        let (layout, _) = self.layouts.number(layout);
        let [min, max] = bounds;
        Some(Written(material, layout, vertices, corners, min, max))
    }

    /// Numbers begin at multiples of their size.
    fn put(&mut self, bytes: &[u8]) {
        self.data.extend_from_slice(bytes);
        self.data.resize(self.data.len().next_multiple_of(4), 0);
    }

    /// The file.
    pub(super) fn write(self, since: u64) -> Option<Vec<u8>> {
        let kept = ["asset", "extensionsUsed", "extensionsRequired"];
        let fields = self.file.fields.iter();
        let fields = fields.filter(|(name, _)| kept.contains(name));
        let mut materials: BTreeMap<_, _> = fields
            .map(|(name, value)| (*name, (*value).to_owned()))
            .collect();
        // glTF has no empty lists.
        if !self.materials.order.is_empty() {
            let list = self.materials.order.iter();
            let list: Option<Vec<_>> = list.map(|at| self.file.materials.get(*at)).collect();
            materials.insert("materials", serde_json::value::to_raw_value(&list?).ok()?);
        }
        let mut text = serde_json::to_vec(&Text {
            since,
            nodes: &self.moved,
            materials,
            layouts: &self.layouts.order,
            primitives: &self.primitives,
            meshes: &self.meshes,
        })
        .ok()?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = u32::try_from(text.len()).ok()?;
        Some([MAGIC, &length.to_le_bytes(), &text, &self.data].concat())
    }
}

/// Different values, numbered as they come.
struct Numbered<T> {
    order: Vec<T>,
    numbers: BTreeMap<T, usize>,
}

impl<T: Clone + Ord> Numbered<T> {
    fn new() -> Self {
        Self {
            order: vec![],
            numbers: BTreeMap::new(),
        }
    }

    /// The number of a value, and whether it is new.
    fn number(&mut self, value: T) -> (usize, bool) {
        match self.numbers.entry(value) {
            Entry::Occupied(known) => (*known.get(), false),
            Entry::Vacant(place) => {
                self.order.push(place.key().clone());
                (*place.insert(self.order.len() - 1), true)
            }
        }
    }
}
