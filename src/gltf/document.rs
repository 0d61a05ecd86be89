//! The JSON, written element by element from small borrowed structs: no tree of it is ever built.

use std::io::{self, Write};

use serde::{Serialize, Serializer};

use super::lists::list;
use super::looks::{Images, Materials, Samplers, Textures};
use super::packing::{Entry, IndexType, Kind, Packed, Run, View, WINDOW};
use super::{ROOT, looks};
use crate::scene::{self, Scene};

/// What stands before the lists.
#[derive(Serialize)]
struct Head {
    asset: Asset,
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
        scene: 0,
        scenes: [Stage {
            nodes: [scene.nodes.len()],
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
    })?;
    if let [b'{', looks @ .., b'}'] = &looks[..]
        && !looks.is_empty()
    {
        out.write_all(b",")?;
        out.write_all(looks)?;
    }
    if solid {
        accessors(packed, out)?;
    }
    if packed.length > 0 {
        views(packed, out)?;
    }
    Ok(())
}

/// The number of each primitive's first accessor.
fn numbers(packed: &Packed) -> Vec<u32> {
    let mut next = 0;
    let number = |entry: &Option<Entry>| {
        let number = next;
        let runs = entry.iter().flat_map(|entry| &entry.runs);
        next += runs.flatten().count() as u32;
        number
    };
    packed.entries.iter().map(number).collect()
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

/// More bytes than the JSON of a scene takes, reckoned before its solids are made: texts are counted, and numbers
/// taken at their longest.
pub(super) fn room(scene: &Scene) -> io::Result<u64> {
    const HEAD: usize = 4096;
    /// No `f32` that is written takes more characters.
    const LONGEST: Number = Number(-1.234_567_8e-5);

    let length = |element: serde_json::Result<Vec<u8>>| Ok::<_, io::Error>(element?.len() + 1);
    let primitives: usize = scene.meshes.iter().map(|mesh| mesh.primitives.len()).sum();
    let views = 6 * (primitives / WINDOW + 1) + scene.images.len();
    let children = digits(scene.nodes.len()) + 1;

    let node = length(serde_json::to_vec(&Node {
        name: "",
        children: &[],
        mesh: Some(scene.meshes.len()),
        translation: Some([LONGEST; 3]),
        rotation: Some([LONGEST; 4]),
        extras: Some(Extras {
            okoshi: Provenance {
                element: Some(""),
                string: Some(""),
            },
        }),
    }))? + r#""name":"","children":[],"#.len();
    let nodes: usize = scene
        .nodes
        .iter()
        .map(|scene_node| {
            let words = scene_node
                .provenance
                .iter()
                .flat_map(|provenance| [&provenance.element, &provenance.string]);
            let words: usize = words.flatten().map(|word| text(word)).sum();
            // The name may stand a second time, as its mesh's.
            node + 2 * text(&scene_node.name) + words + scene_node.children.len() * children
        })
        .sum();

    let mesh = r#"{"name":"","primitives":[]},"#.len();
    let primitive = length(serde_json::to_vec(&Primitive {
        attributes: Attributes {
            position: 4 * primitives,
            normal: Some(4 * primitives),
            uv: Some(4 * primitives),
        },
        indices: 4 * primitives,
        material: scene.materials.len(),
    }))?;
    let accessor = |element, bounds: Option<[Number; 3]>| {
        length(serde_json::to_vec(&Accessor {
            buffer_view: views,
            byte_offset: u64::from(u32::MAX),
            component_type: u16::MAX,
            count: u32::MAX as usize,
            element,
            min: bounds,
            max: bounds,
        }))
    };
    let accessors =
        accessor("VEC3", Some([LONGEST; 3]))? + accessor("VEC3", None)? + accessor("SCALAR", None)?;
    let mut pieces = scene
        .meshes
        .iter()
        .flat_map(|mesh| &mesh.primitives)
        .flat_map(|p| &p.pieces);
    let mapped = |piece: &scene::Piece| matches!(piece, scene::Piece::Surface(surface) if !surface.uvs.is_empty());
    let uvs = match !scene.textures.is_empty() || pieces.any(mapped) {
        true => accessor("VEC2", None)?,
        false => 0,
    };
    let view = length(serde_json::to_vec(&BufferView {
        buffer: 0,
        byte_offset: u64::from(u32::MAX),
        byte_length: u64::from(u32::MAX),
        byte_stride: Some(u8::MAX),
        target: Some(u16::MAX),
    }))?;

    let total = HEAD
        + nodes
        + scene.roots.len() * children
        + scene.meshes.len() * mesh
        + primitives * (primitive + accessors + uvs)
        + views * view
        + looks::room(scene);
    Ok(total as u64)
}

/// How many digits the numbers up to `greatest` have.
fn digits(greatest: usize) -> usize {
    greatest.max(1).ilog10() as usize + 1
}

fn nodes(scene: &Scene, packed: &Packed, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mesh_numbers = mesh_numbers(scene, packed);
    let root = Node {
        name: ROOT,
        children: &scene.roots,
        mesh: None,
        translation: None,
        rotation: None,
        extras: None,
    };
    list(out, "nodes", scene.nodes.len() + 1, |range, elements| {
        for index in range {
            match scene.nodes.get(index) {
                Some(node) => elements.push(&Node::new(node, &mesh_numbers))?,
                None => elements.push(&root)?,
            }
        }
        Ok(())
    })
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
    /// A primitive whose first accessor is `accessor`; the others follow it.
    fn new(primitive: &scene::Primitive, entry: &Entry, mut accessor: usize) -> Self {
        let mut attributes = Attributes::default();
        let mut indices = 0;
        for run in entry.runs.iter().flatten() {
            match run.kind {
                Kind::Positions => attributes.position = accessor,
                Kind::Normals => attributes.normal = Some(accessor),
                Kind::Uvs => attributes.uv = Some(accessor),
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

fn accessors(packed: &Packed, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    list(out, "accessors", packed.entries.len(), |range, elements| {
        for entry in packed.entries[range].iter().flatten() {
            for run in entry.runs.iter().flatten() {
                elements.push(&Accessor::new(entry, run))?;
            }
        }
        Ok(())
    })
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

impl Accessor {
    fn new(entry: &Entry, run: &Run) -> Self {
        const UNSIGNED_BYTE: u16 = 5121;
        const UNSIGNED_SHORT: u16 = 5123;
        const UNSIGNED_INT: u16 = 5125;
        const FLOAT: u16 = 5126;

        let (component_type, element) = match run.kind {
            Kind::Positions | Kind::Normals => (FLOAT, "VEC3"),
            Kind::Uvs => (FLOAT, "VEC2"),
            Kind::Indices(IndexType::U8) => (UNSIGNED_BYTE, "SCALAR"),
            Kind::Indices(IndexType::U16) => (UNSIGNED_SHORT, "SCALAR"),
            Kind::Indices(IndexType::U32) => (UNSIGNED_INT, "SCALAR"),
        };
        let bounds = (run.kind == Kind::Positions).then_some(entry.bounds);
        Self {
            buffer_view: run.view,
            byte_offset: run.offset,
            component_type,
            count: run.count,
            element,
            min: bounds.map(|[min, _]| min.map(Number)),
            max: bounds.map(|[_, max]| max.map(Number)),
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

impl BufferView {
    fn new(view: &View) -> Self {
        const ARRAY_BUFFER: u16 = 34962;
        const ELEMENT_ARRAY_BUFFER: u16 = 34963;

        // Accessors that share a view need its stride stated.
        let (byte_stride, target) = match view.kind {
            Some(Kind::Positions | Kind::Normals) => (Some(12), Some(ARRAY_BUFFER)),
            Some(Kind::Uvs) => (Some(8), Some(ARRAY_BUFFER)),
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
