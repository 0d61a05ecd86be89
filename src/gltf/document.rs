//! The JSON, written element by element from small borrowed structs: no tree of it is ever built.

use serde::{Serialize, Serializer};

use super::ROOT;
use super::layout::{IndexType, Kind, Layout, is_written, kinds};
use crate::scene::{self, Scene};

/// All of the JSON but the buffer.
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
    accessors: Option<Accessors<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    buffer_views: Option<BufferViews<'a>>,
}

impl<'a> Document<'a> {
    pub(super) fn new(scene: &'a Scene, layout: &'a Layout) -> Self {
        // glTF has no empty arrays.
        let solid = !layout.views.is_empty();
        Self {
            asset: Asset {
                version: "2.0",
                generator: concat!("okoshi ", env!("CARGO_PKG_VERSION")),
            },
            scene: 0,
            scenes: [Stage {
                nodes: [scene.nodes.len()],
            }],
            nodes: Nodes(scene, layout),
            meshes: solid.then_some(Meshes(scene, layout)),
            materials: (!scene.materials.is_empty()).then_some(Materials(scene)),
            accessors: solid.then_some(Accessors(scene, layout)),
            buffer_views: solid.then_some(BufferViews(layout)),
        }
    }
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
struct Number(f32);

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

struct Nodes<'a>(&'a Scene, &'a Layout);

impl Serialize for Nodes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(scene, layout) = *self;
        let root = Node {
            name: ROOT,
            children: &scene.roots,
            mesh: None,
            translation: None,
            rotation: None,
            extras: None,
        };
        let nodes = scene.nodes.iter().map(|node| Node::new(node, layout));
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
    fn new(node: &'a scene::Node, layout: &Layout) -> Self {
        let translation = node.translation.as_vec3().to_array();
        let rotation = node.rotation.as_quat().to_array();
        let moved = translation != [0.0; 3];
        // The identity and its twin are the same turn.
        let turned = rotation.map(f32::abs) != [0.0, 0.0, 0.0, 1.0];
        let provenance = node.provenance.as_ref();
        Self {
            name: &node.name,
            children: &node.children,
            mesh: node.mesh.and_then(|mesh| layout.mesh_numbers[mesh]),
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

struct Meshes<'a>(&'a Scene, &'a Layout);

impl Serialize for Meshes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(scene, layout) = *self;
        // A mesh is named after the first node that shows it.
        let mut names = vec![""; scene.meshes.len()];
        for node in scene.nodes.iter().rev() {
            if let Some(mesh) = node.mesh {
                names[mesh] = &node.name;
            }
        }
        let mut accessor = 0;
        let meshes = scene.meshes.iter().zip(names).zip(&layout.mesh_numbers);
        serializer.collect_seq(meshes.filter_map(|((mesh, name), number)| {
            number.as_ref()?;
            let primitives = mesh.primitives.iter().filter(|part| is_written(part));
            let primitives = primitives
                .map(|part| Primitive::new(part, &mut accessor))
                .collect();
            Some(Mesh { name, primitives })
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
    /// Takes the primitive's accessors, the next ones in the order of [`Layout::runs`].
    fn new(primitive: &scene::Primitive, accessor: &mut usize) -> Self {
        let mut attributes = Attributes::default();
        let mut indices = 0;
        for kind in kinds(&primitive.surface).into_iter().flatten() {
            match kind {
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

struct Materials<'a>(&'a Scene);

impl Serialize for Materials<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.materials.iter().map(|material| Material {
            name: &material.name,
            pbr_metallic_roughness: MetallicRoughness {
                base_color_factor: material.base_color.map(Number),
                metallic_factor: Number(material.metallic),
                roughness_factor: Number(material.roughness),
            },
            emissive_factor: (material.emissive != [0.0; 3]).then(|| material.emissive.map(Number)),
            alpha_mode: (material.base_color[3] < 1.0).then_some("BLEND"),
            double_sided: material.double_sided.then_some(true),
        }))
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Material<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    pbr_metallic_roughness: MetallicRoughness,
    #[serde(skip_serializing_if = "Option::is_none")]
    emissive_factor: Option<[Number; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alpha_mode: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    double_sided: Option<bool>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct MetallicRoughness {
    base_color_factor: [Number; 4],
    metallic_factor: Number,
    roughness_factor: Number,
}

struct Accessors<'a>(&'a Scene, &'a Layout);

impl Serialize for Accessors<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        const UNSIGNED_BYTE: u16 = 5121;
        const UNSIGNED_SHORT: u16 = 5123;
        const UNSIGNED_INT: u16 = 5125;
        const FLOAT: u16 = 5126;

        let Self(scene, layout) = *self;
        serializer.collect_seq(layout.runs(scene).map(|(primitive, run)| {
            let (component_type, element) = match run.kind {
                Kind::Positions | Kind::Normals => (FLOAT, "VEC3"),
                Kind::Uvs => (FLOAT, "VEC2"),
                Kind::Indices(IndexType::U8) => (UNSIGNED_BYTE, "SCALAR"),
                Kind::Indices(IndexType::U16) => (UNSIGNED_SHORT, "SCALAR"),
                Kind::Indices(IndexType::U32) => (UNSIGNED_INT, "SCALAR"),
            };
            let bounds = (run.kind == Kind::Positions).then(|| layout.bounds[primitive]);
            Accessor {
                buffer_view: run.view,
                byte_offset: run.offset,
                component_type,
                count: run.count,
                element,
                min: bounds.map(|bounds| bounds.min.map(Number)),
                max: bounds.map(|bounds| bounds.max.map(Number)),
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

struct BufferViews<'a>(&'a Layout);

impl Serialize for BufferViews<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        const ARRAY_BUFFER: u16 = 34962;
        const ELEMENT_ARRAY_BUFFER: u16 = 34963;

        serializer.collect_seq(self.0.views.iter().map(|view| {
            // Accessors that share a view need its stride stated.
            let (byte_stride, target) = match view.kind {
                Kind::Positions | Kind::Normals => (Some(12), ARRAY_BUFFER),
                Kind::Uvs => (Some(8), ARRAY_BUFFER),
                Kind::Indices(_) => (None, ELEMENT_ARRAY_BUFFER),
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
    target: u16,
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes fields by reference"
)]
fn is_zero(number: &u64) -> bool {
    *number == 0
}
