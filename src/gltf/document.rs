//! The JSON, written element by element from small borrowed structs: no tree of it is ever built.

use std::io::{self, Write};

use serde::{Serialize, Serializer};

use super::animations;
use super::lists::list;
use super::looks::{Images, Materials, Samplers, Textures};
use super::packing::{Entry, IndexType, JointType, Kind, Packed, Run, View};
use super::{ROOT, SKINNED, VIEW_DEPENDENT};
use crate::scene::{self, Scene};

/// What stands before the lists.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    asset: Asset,
    #[serde(skip_serializing_if = "Option::is_none")]
    extensions_used: Option<[&'static str; 1]>,
    scene: usize,
    scenes: [Stage; 1],
}

/// What stands between the long lists.
#[derive(Serialize)]
struct Looks<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    materials: Option<Materials<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    textures: Option<Textures<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    images: Option<Images<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    samplers: Option<Samplers>,
    #[serde(skip_serializing_if = "Option::is_none")]
    skins: Option<[Skin; 1]>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Skin {
    inverse_bind_matrices: usize,
    skeleton: usize,
    joints: Vec<usize>,
}

/// Writes the JSON up to the list of buffers, which comes last: whoever knows where the data is goes on.
pub(super) fn write(
    scene: &Scene,
    packed: &Packed,
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    let head = Head {
        asset: Asset {
            version: "2.0",
            generator: concat!("okoshi ", env!("CARGO_PKG_VERSION")),
        },
        extensions_used: scene
            .nodes
            .iter()
            .any(|node| node.view_dependent.is_some())
            .then_some([VIEW_DEPENDENT]),
        scene: 0,
        scenes: [Stage {
            // A skinned mesh follows its joints alone, so it hangs on nothing.
            nodes: match packed.bind_matrices {
                None => vec![scene.nodes.len()],
                Some(_) => vec![scene.nodes.len(), scene.nodes.len() + 1],
            },
        }],
    };
    let mut head = serde_json::to_vec(&head)?;
    // The lists belong into the same braces.
    head.pop();
    out.write_all(&head)?;
    nodes(scene, packed, out)?;
    // glTF has no empty arrays.
    let solid = packed.entries.iter().any(Option::is_some);
    let numbers = numbers(packed);
    if solid {
        meshes(scene, packed, &numbers, out)?;
    }
    let textured = !scene.textures.is_empty();
    let looks = serde_json::to_vec(&Looks {
        materials: (!scene.materials.is_empty()).then_some(Materials(scene)),
        textures: textured.then(|| Textures::new(scene, packed)),
        images: (!packed.images.is_empty()).then_some(Images(scene, packed)),
        samplers: textured.then(|| Samplers::new(scene)),
        skins: packed.bind_matrices.map(|_| {
            [Skin {
                inverse_bind_matrices: numbers[packed.entries.len()] as usize,
                skeleton: scene.nodes.len(),
                joints: (0..scene.nodes.len()).collect(),
            }]
        }),
    })?;
    if let [b'{', looks @ .., b'}'] = &looks[..]
        && !looks.is_empty()
    {
        out.write_all(b",")?;
        out.write_all(looks)?;
    }
    let first_key =
        numbers[packed.entries.len()] as usize + usize::from(packed.bind_matrices.is_some());
    animations::write(scene, packed, first_key, out)?;
    if solid || packed.keys.accessors() > 0 {
        accessors(scene, packed, out)?;
    }
    if packed.length > 0 {
        views(packed, out)?;
    }
    Ok(())
}

/// The number of each primitive's first accessor, and behind them that of the next one.
fn numbers(packed: &Packed) -> Vec<u32> {
    let mut next = 0;
    let mut numbers = Vec::with_capacity(packed.entries.len() + 1);
    for entry in &packed.entries {
        numbers.push(next);
        let runs = entry.iter().flat_map(|entry| &entry.runs);
        next += runs.flatten().count() as u32;
    }
    numbers.push(next);
    numbers
}

#[derive(Serialize)]
struct Asset {
    version: &'static str,
    generator: &'static str,
}

#[derive(Serialize)]
struct Stage {
    nodes: Vec<usize>,
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

fn nodes(scene: &Scene, packed: &Packed, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mesh_numbers = mesh_numbers(scene, packed);
    let root: Node<'_> = Node {
        name: ROOT,
        children: &scene.roots,
        mesh: None,
        skin: None,
        translation: None,
        rotation: None,
        extensions: None,
        extras: None,
    };
    let skin = scene
        .skin
        .as_ref()
        .filter(|_| packed.bind_matrices.is_some());
    let skinned = skin.map(|skin| Node {
        name: SKINNED,
        children: &[],
        mesh: mesh_numbers[skin.mesh],
        skin: Some(0),
        ..root
    });
    let count = scene.nodes.len() + 1 + usize::from(skinned.is_some());
    list(out, "nodes", count, |range, elements| {
        for index in range {
            match (scene.nodes.get(index), &skinned) {
                (Some(node), _) => elements.push(&Node::new(node, &mesh_numbers))?,
                (None, Some(skinned)) if index > scene.nodes.len() => elements.push(skinned)?,
                (None, _) => elements.push(&root)?,
            }
        }
        Ok(())
    })
}

#[derive(Serialize, Clone, Copy)]
pub(super) struct Node<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(super) name: &'a str,
    #[serde(skip_serializing_if = "<[usize]>::is_empty")]
    pub(super) children: &'a [usize],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mesh: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) skin: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) translation: Option<[Number; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rotation: Option<[Number; 4]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<Extensions>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Option<Extras<'a>>,
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
            skin: None,
            translation: moved.then(|| translation.map(Number)),
            rotation: turned.then(|| rotation.map(Number)),
            extensions: node.view_dependent.map(Extensions::new),
            extras: provenance.and_then(Extras::new),
        }
    }
}

#[derive(Serialize, Clone, Copy)]
pub(super) struct Extensions {
    #[serde(rename = "OKOSHI_view_dependent")]
    view_dependent: ViewDependent,
}

/// One object for each way of following the viewer, so that files of today and later ones are told apart by their keys.
#[derive(Serialize, Clone, Copy)]
struct ViewDependent {
    bend: Bend,
}

#[derive(Serialize, Clone, Copy)]
struct Bend {}

impl Extensions {
    pub(super) fn new(view_dependent: scene::ViewDependent) -> Self {
        Self {
            view_dependent: match view_dependent {
                scene::ViewDependent::Bend => ViewDependent { bend: Bend {} },
            },
        }
    }
}

#[derive(Serialize, Clone, Copy)]
pub(super) struct Extras<'a> {
    pub(super) okoshi: Provenance<'a>,
}

#[derive(Serialize, Clone, Copy)]
pub(super) struct Provenance<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) element: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) string: Option<&'a str>,
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

fn meshes(
    scene: &Scene,
    packed: &Packed,
    numbers: &[u32],
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    // A mesh is named after the first node that shows it.
    let mut names = vec![""; scene.meshes.len()];
    for node in scene.nodes.iter().rev() {
        if let Some(mesh) = node.mesh {
            names[mesh] = &node.name;
        }
    }
    let mut next = 0;
    let first = |mesh: &scene::Mesh| {
        let first = next;
        next += mesh.primitives.len();
        first
    };
    let firsts: Vec<usize> = scene.meshes.iter().map(first).collect();
    list(out, "meshes", scene.meshes.len(), |range, elements| {
        for index in range {
            let primitives = scene.meshes[index].primitives.iter();
            let primitives: Vec<Primitive> = primitives
                .zip(firsts[index]..)
                .filter_map(|(primitive, place)| {
                    let entry = packed.entries[place].as_ref()?;
                    Some(Primitive::new(primitive, entry, numbers[place] as usize))
                })
                .collect();
            if !primitives.is_empty() {
                let name = names[index];
                elements.push(&Mesh { name, primitives })?;
            }
        }
        Ok(())
    })
}

#[derive(Serialize)]
struct Mesh<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    primitives: Vec<Primitive>,
}

#[derive(Serialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: usize,
    pub(super) material: usize,
}

#[derive(Serialize, Default)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(super) struct Attributes {
    pub(super) position: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) normal: Option<usize>,
    #[serde(rename = "TEXCOORD_0", skip_serializing_if = "Option::is_none")]
    pub(super) uv: Option<usize>,
    #[serde(rename = "JOINTS_0", skip_serializing_if = "Option::is_none")]
    pub(super) joints: Option<usize>,
    #[serde(rename = "WEIGHTS_0", skip_serializing_if = "Option::is_none")]
    pub(super) weights: Option<usize>,
}

impl Primitive {
    /// A primitive whose first accessor is `accessor`; the others follow it.
    fn new(primitive: &scene::Primitive, entry: &Entry, mut accessor: usize) -> Self {
        let mut attributes = Attributes::default();
        let mut indices = 0;
        for run in entry.runs.iter().flatten() {
            match run.kind {
                Kind::Positions => attributes.position = accessor,
                Kind::Normals => attributes.normal = Some(accessor),
                Kind::Uvs => attributes.uv = Some(accessor),
                Kind::Joints(_) => attributes.joints = Some(accessor),
                Kind::Weights => attributes.weights = Some(accessor),
                Kind::Indices(_) => indices = accessor,
            }
            accessor += 1;
        }
        Self {
            attributes,
            indices,
            material: primitive.material,
        }
    }
}

fn accessors(scene: &Scene, packed: &Packed, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    // Behind those of the primitives stand the one of the inverse bind matrices and those of keys.
    let matrices = packed.bind_matrices.map(|view| Accessor {
        buffer_view: view,
        component_type: FLOAT,
        count: scene.nodes.len(),
        element: "MAT4",
        ..Accessor::default()
    });
    let entries = packed.entries.len();
    let count = entries + 1 + packed.keys.accessors();
    list(out, "accessors", count, |range, elements| {
        for index in range {
            match packed.entries.get(index) {
                None if index > entries => {
                    elements.push(&packed.keys.accessor(index - entries - 1))?
                }
                Some(entry) => {
                    for (entry, run) in entry.iter().flat_map(Entry::with_runs) {
                        elements.push(&Accessor::new(entry, run))?;
                    }
                }
                None => matrices
                    .iter()
                    .try_for_each(|matrices| elements.push(matrices))?,
            }
        }
        Ok(())
    })
}

const UNSIGNED_BYTE: u16 = 5121;
const UNSIGNED_SHORT: u16 = 5123;
const UNSIGNED_INT: u16 = 5125;
pub(super) const FLOAT: u16 = 5126;

#[derive(Serialize, Default)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: usize,
    #[serde(skip_serializing_if = "is_zero")]
    pub(super) byte_offset: u64,
    pub(super) component_type: u16,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) normalized: bool,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) element: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) min: Option<Bounds>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max: Option<Bounds>,
}

/// The least or the greatest of a list, component by component.
#[derive(Serialize, Clone, Copy)]
#[serde(untagged)]
pub(super) enum Bounds {
    /// Of moments.
    Moment([Number; 1]),
    /// Of corners.
    Corner([Number; 3]),
}

impl Accessor {
    fn new(entry: &Entry, run: &Run) -> Self {
        let (component_type, element) = match run.kind {
            Kind::Positions | Kind::Normals => (FLOAT, "VEC3"),
            Kind::Uvs => (FLOAT, "VEC2"),
            Kind::Joints(JointType::U8) | Kind::Weights => (UNSIGNED_BYTE, "VEC4"),
            Kind::Joints(JointType::U16) => (UNSIGNED_SHORT, "VEC4"),
            Kind::Indices(IndexType::U8) => (UNSIGNED_BYTE, "SCALAR"),
            Kind::Indices(IndexType::U16) => (UNSIGNED_SHORT, "SCALAR"),
            Kind::Indices(IndexType::U32) => (UNSIGNED_INT, "SCALAR"),
        };
        let bounds = (run.kind == Kind::Positions).then_some(entry.bounds);
        Self {
            buffer_view: run.view,
            byte_offset: run.offset,
            component_type,
            normalized: run.kind == Kind::Weights,
            count: run.count,
            element,
            min: bounds.map(|[min, _]| Bounds::Corner(min.map(Number))),
            max: bounds.map(|[_, max]| Bounds::Corner(max.map(Number))),
        }
    }
}

fn views(packed: &Packed, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    list(out, "bufferViews", packed.views.len(), |range, elements| {
        let mut views = packed.views[range].iter().map(BufferView::new);
        views.try_for_each(|view| elements.push(&view))
    })
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(skip_serializing_if = "is_zero")]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) byte_stride: Option<u8>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) target: Option<u16>,
}

impl BufferView {
    fn new(view: &View) -> Self {
        const ARRAY_BUFFER: u16 = 34962;
        const ELEMENT_ARRAY_BUFFER: u16 = 34963;

        // Accessors that share a view need its stride stated.
        let (byte_stride, target) = match view.kind {
            Some(Kind::Positions | Kind::Normals) => (Some(12), Some(ARRAY_BUFFER)),
            Some(Kind::Uvs | Kind::Joints(JointType::U16)) => (Some(8), Some(ARRAY_BUFFER)),
            Some(Kind::Joints(JointType::U8) | Kind::Weights) => (Some(4), Some(ARRAY_BUFFER)),
            Some(Kind::Indices(_)) => (None, Some(ELEMENT_ARRAY_BUFFER)),
            None => (None, None),
        };
        Self {
            buffer: 0,
            byte_offset: view.offset,
            byte_length: view.length,
            byte_stride,
            target,
        }
    }
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde passes fields by reference"
)]
fn is_zero(number: &u64) -> bool {
    *number == 0
}
