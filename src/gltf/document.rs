//! The JSON, written element by element from small borrowed structs: no tree of it is ever built.

use serde::{Serialize, Serializer};

use super::looks::{Images, Materials, Samplers, Textures};
use super::packing::{Entry, IndexType, Kind, Packed};
use super::{Container, ROOT, looks};
use crate::scene::{self, Scene};

/// All of the JSON; in a `.gltf` the buffer is written behind it.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document<'a> {
    asset: Asset,
    scene: usize,
    scenes: [Stage; 1],
    nodes: Nodes<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    meshes: Option<Meshes<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    materials: Option<Materials<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    textures: Option<Textures<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    images: Option<Images<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    samplers: Option<Samplers>,
    #[serde(skip_serializing_if = "Option::is_none")]
    accessors: Option<Accessors<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    buffer_views: Option<BufferViews<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    buffers: Option<[Buffer; 1]>,
}

impl<'a> Document<'a> {
    pub(super) fn new(scene: &'a Scene, packed: &'a Packed, container: Container) -> Self {
        // glTF has no empty arrays.
        let solid = packed.entries.iter().any(Option::is_some);
        let textured = !scene.textures.is_empty();
        Self {
            asset: Asset {
                version: "2.0",
                generator: concat!("okoshi ", env!("CARGO_PKG_VERSION")),
            },
            scene: 0,
            scenes: [Stage {
                nodes: [scene.nodes.len()],
            }],
            nodes: Nodes {
                scene,
                mesh_numbers: mesh_numbers(scene, packed),
            },
            meshes: solid.then_some(Meshes(scene, packed)),
            materials: (!scene.materials.is_empty()).then_some(Materials(scene)),
            textures: textured.then(|| Textures::new(scene, packed)),
            images: (!packed.images.is_empty()).then_some(Images(scene, packed)),
            samplers: textured.then(|| Samplers::new(scene)),
            accessors: solid.then_some(Accessors(packed)),
            buffer_views: (packed.length > 0).then_some(BufferViews(packed)),
            buffers: (packed.length > 0 && container == Container::Glb).then_some([Buffer {
                byte_length: packed.length,
            }]),
        }
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    byte_length: u64,
}

#[derive(Serialize)]
struct Asset {
    version: &'static str,
    generator: &'static str,
}

#[derive(Serialize)]
struct Stage {
    nodes: [usize; 1],
}

/// A number in its shortest form that reads back as the same `f32`, without a fraction when whole.
#[derive(Clone, Copy)]
pub(super) struct Number(pub(super) f32);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(number) = *self;
        if number.fract() == 0.0 && number.abs() < 1e6 {
            serializer.serialize_i32(number as i32)
        } else {
            serializer.serialize_f32(number)
        }
    }
}

/// The number in the file of each mesh of the scene; none for one without triangles.
fn mesh_numbers(scene: &Scene, packed: &Packed) -> Vec<Option<usize>> {
    let mut entries = packed.entries.iter();
    let mut numbers = 0..;
    let written = |mesh: &scene::Mesh| {
        entries
            .by_ref()
            .take(mesh.primitives.len())
            .flatten()
            .count()
            > 0
    };
    scene
        .meshes
        .iter()
        .map(written)
        .map(|written| if written { numbers.next() } else { None })
        .collect()
}

/// How many bytes a text takes, escaped.
pub(super) fn text(text: &str) -> usize {
    text.bytes()
        .map(|byte| {
            if byte < 0x20 {
                6
            } else if matches!(byte, b'"' | b'\\') {
                2
            } else {
                1
            }
        })
        .sum()
}

/// More bytes than the JSON of a scene takes, reckoned before its solids are made.
pub(super) fn room(scene: &Scene) -> u64 {
    const HEAD: usize = 4096;
    const NODE: usize = 240;
    const MESH: usize = 64;
    /// Up to four accessors and what refers to them, every number of the greatest length.
    const PRIMITIVE: usize = 640;
    /// One view a kind for each window, of which there is at least one.
    const VIEWS: usize = 6 * 160;

    let nodes = scene.nodes.iter().map(|node| {
        let provenance = node
            .provenance
            .iter()
            .flat_map(|provenance| [&provenance.element, &provenance.string]);
        let provenance = provenance.flatten().map(|word| text(word)).sum::<usize>();
        // The name may stand a second time, as its mesh's.
        NODE + 2 * text(&node.name) + provenance + node.children.len() * 12
    });
    let primitives: usize = scene.meshes.iter().map(|mesh| mesh.primitives.len()).sum();
    let views = (primitives / super::packing::WINDOW + 1) * VIEWS;
    let rest =
        HEAD + scene.roots.len() * 12 + scene.meshes.len() * MESH + primitives * PRIMITIVE + views;
    (nodes.sum::<usize>() + looks::room(scene) + rest) as u64
}

struct Nodes<'a> {
    scene: &'a Scene,
    mesh_numbers: Vec<Option<usize>>,
}

impl Serialize for Nodes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self {
            scene,
            mesh_numbers,
        } = self;
        let root = Node {
            name: ROOT,
            children: &scene.roots,
            mesh: None,
            translation: None,
            rotation: None,
            extras: None,
        };
        let nodes = scene.nodes.iter().map(|node| Node::new(node, mesh_numbers));
        serializer.collect_seq(nodes.chain([root]))
    }
}

#[derive(Serialize)]
struct Node<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    #[serde(skip_serializing_if = "<[usize]>::is_empty")]
    children: &'a [usize],
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    translation: Option<[Number; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<[Number; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    extras: Option<Extras<'a>>,
}

impl<'a> Node<'a> {
    fn new(node: &'a scene::Node, mesh_numbers: &[Option<usize>]) -> Self {
        let translation = node.translation.as_vec3().to_array();
        let rotation = node.rotation.as_quat().to_array();
        let moved = translation != [0.0; 3];
        // The identity and its twin are the same turn.
        let turned = rotation.map(f32::abs) != [0.0, 0.0, 0.0, 1.0];
        let provenance = node.provenance.as_ref();
        Self {
            name: &node.name,
            children: &node.children,
            mesh: node.mesh.and_then(|mesh| mesh_numbers[mesh]),
            translation: moved.then(|| translation.map(Number)),
            rotation: turned.then(|| rotation.map(Number)),
            extras: provenance.and_then(Extras::new),
        }
    }
}

#[derive(Serialize)]
struct Extras<'a> {
    okoshi: Provenance<'a>,
}

#[derive(Serialize)]
struct Provenance<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    element: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    string: Option<&'a str>,
}

impl<'a> Extras<'a> {
    fn new(provenance: &'a scene::Provenance) -> Option<Self> {
        let okoshi = Provenance {
            element: provenance.element.as_deref(),
            string: provenance.string.as_deref(),
        };
        (okoshi.element.is_some() || okoshi.string.is_some()).then_some(Self { okoshi })
    }
}

struct Meshes<'a>(&'a Scene, &'a Packed);

impl Serialize for Meshes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(scene, packed) = *self;
        // A mesh is named after the first node that shows it.
        let mut names = vec![""; scene.meshes.len()];
        for node in scene.nodes.iter().rev() {
            if let Some(mesh) = node.mesh {
                names[mesh] = &node.name;
            }
        }
        let mut accessor = 0;
        let mut entries = packed.entries.iter();
        serializer.collect_seq(scene.meshes.iter().zip(names).filter_map(|(mesh, name)| {
            let entries = entries.by_ref().take(mesh.primitives.len());
            let primitives: Vec<Primitive> = mesh
                .primitives
                .iter()
                .zip(entries)
                .filter_map(|(primitive, entry)| {
                    Some(Primitive::new(primitive, entry.as_ref()?, &mut accessor))
                })
                .collect();
            (!primitives.is_empty()).then_some(Mesh { name, primitives })
        }))
    }
}

#[derive(Serialize)]
struct Mesh<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    primitives: Vec<Primitive>,
}

#[derive(Serialize)]
struct Primitive {
    attributes: Attributes,
    indices: usize,
    material: usize,
}

#[derive(Serialize, Default)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
struct Attributes {
    position: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    normal: Option<usize>,
    #[serde(rename = "TEXCOORD_0", skip_serializing_if = "Option::is_none")]
    uv: Option<usize>,
}

impl Primitive {
    /// Takes the primitive's accessors, the next ones in the order of the file.
    fn new(primitive: &scene::Primitive, entry: &Entry, accessor: &mut usize) -> Self {
        let mut attributes = Attributes::default();
        let mut indices = 0;
        for run in entry.runs.iter().flatten() {
            match run.kind {
                Kind::Positions => attributes.position = *accessor,
                Kind::Normals => attributes.normal = Some(*accessor),
                Kind::Uvs => attributes.uv = Some(*accessor),
                Kind::Indices(_) => indices = *accessor,
            }
            *accessor += 1;
        }
        Self {
            attributes,
            indices,
            material: primitive.material,
        }
    }
}

struct Accessors<'a>(&'a Packed);

impl Serialize for Accessors<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        const UNSIGNED_BYTE: u16 = 5121;
        const UNSIGNED_SHORT: u16 = 5123;
        const UNSIGNED_INT: u16 = 5125;
        const FLOAT: u16 = 5126;

        let runs = self
            .0
            .entries
            .iter()
            .flatten()
            .flat_map(|entry| entry.runs.iter().flatten().map(move |run| (entry, run)));
        serializer.collect_seq(runs.map(|(entry, run)| {
            let (component_type, element) = match run.kind {
                Kind::Positions | Kind::Normals => (FLOAT, "VEC3"),
                Kind::Uvs => (FLOAT, "VEC2"),
                Kind::Indices(IndexType::U8) => (UNSIGNED_BYTE, "SCALAR"),
                Kind::Indices(IndexType::U16) => (UNSIGNED_SHORT, "SCALAR"),
                Kind::Indices(IndexType::U32) => (UNSIGNED_INT, "SCALAR"),
            };
            let bounds = (run.kind == Kind::Positions).then_some(entry.bounds);
            Accessor {
                buffer_view: run.view,
                byte_offset: run.offset,
                component_type,
                count: run.count,
                element,
                min: bounds.map(|[min, _]| min.map(Number)),
                max: bounds.map(|[_, max]| max.map(Number)),
            }
        }))
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: usize,
    #[serde(skip_serializing_if = "is_zero")]
    byte_offset: u64,
    component_type: u16,
    count: usize,
    #[serde(rename = "type")]
    element: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<[Number; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<[Number; 3]>,
}

struct BufferViews<'a>(&'a Packed);

impl Serialize for BufferViews<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        const ARRAY_BUFFER: u16 = 34962;
        const ELEMENT_ARRAY_BUFFER: u16 = 34963;

        serializer.collect_seq(self.0.views.iter().map(|view| {
            // Accessors that share a view need its stride stated.
            let (byte_stride, target) = match view.kind {
                Some(Kind::Positions | Kind::Normals) => (Some(12), Some(ARRAY_BUFFER)),
                Some(Kind::Uvs) => (Some(8), Some(ARRAY_BUFFER)),
                Some(Kind::Indices(_)) => (None, Some(ELEMENT_ARRAY_BUFFER)),
                None => (None, None),
            };
            BufferView {
                buffer: 0,
                byte_offset: view.offset,
                byte_length: view.length,
                byte_stride,
                target,
            }
        }))
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct BufferView {
    buffer: usize,
    #[serde(skip_serializing_if = "is_zero")]
    byte_offset: u64,
    byte_length: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    byte_stride: Option<u8>,
    #[serde(skip_serializing_if = "Option::is_none")]
    target: Option<u16>,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes fields by reference"
)]
fn is_zero(number: &u64) -> bool {
    *number == 0
}
