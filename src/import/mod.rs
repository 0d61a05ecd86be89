//! Reads glTF 2.0 files made by other programs: for pictures of them, and for models that drawings link to.
//!
//! It reads the node hierarchy, triangles (lists, strips, fans), normals, one set of texture coordinates, vertex
//! colours, morph targets of positions, skins, clips, cameras, and how nodes follow the viewer; [`StaticModel`] adds materials and
//! images.

mod animations;
mod buffers;
mod cameras;
mod meshes;
mod pictures;
mod pose;
mod static_model;
mod travel;
mod view_dependent;

use ::gltf::{Document, Gltf};
use glam::DMat4;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use crate::resolver::{LinkError, Resolver};
pub(crate) use crate::scene::{CameraProjection, NodeId};

pub use animations::Clip;
pub(crate) use animations::MAX_KEYS;
pub(crate) use animations::read as read_clips;
pub(crate) use buffers::Buffers;
pub use cameras::ModelCamera;
pub(crate) use cameras::{CameraPose, read as read_cameras};
pub(crate) use pictures::decode;
pub use pose::Pose;
pub(crate) use pose::{Geometry, TriangleSoup};
use pose::{Node, Skin};
pub(crate) use static_model::StaticModel;
pub use static_model::read_static_model;
pub(crate) use travel::Travellers;

/// The largest number of triangles in a file; those of a mesh count once for each node that uses it.
pub const MAX_TRIANGLES: usize = 32 << 20;

/// How much memory the vertices of all primitives may need beyond the length of the file's data, bytes. Accessors can give the
/// same data many times over, or zeros without any data.
pub(crate) const MAX_REPEATED: usize = 256 << 20;

/// Why a file cannot be read. Messages follow the name of the file.
#[derive(Debug, Clone, thiserror::Error)]
pub enum ImportError {
    /// The bytes are not glTF, or violate the specification.
    #[error(
        "is not a readable glTF file: {0}; export it again, or check it with the Khronos glTF validator"
    )]
    Malformed(String),
    /// It requires an extension that is not supported.
    #[error(
        "needs the glTF extension `{0}`, which okoshi does not support; export it without that extension"
    )]
    Extension(String),
    /// A file that it links to cannot be read.
    #[error("links to `{link}`, which {error}")]
    Link {
        /// The link as written in the file.
        link: String,
        /// Why it cannot be read.
        error: LinkError,
    },
    /// An image cannot be decoded.
    #[error("has an image that cannot be read ({0}); use PNG or JPEG")]
    Image(String),
    /// There is no visible triangle.
    #[error("has no triangles: there is nothing to see")]
    Empty,
    /// More than [`MAX_TRIANGLES`] triangles.
    #[error("has {0} triangles, more than the limit of {MAX_TRIANGLES}")]
    TooManyTriangles(usize),
    /// Vertices that repeat the file's data by more than [`MAX_REPEATED`].
    #[error(
        "repeats vertices so often that they need {0} MiB, more than the limit of {limit} MiB beyond its data; export each \
         mesh with vertices of its own",
        limit = MAX_REPEATED >> 20
    )]
    TooManyVertices(usize),
    /// More than [`MAX_KEYS`] keys.
    #[error("has clips with {0} keys, more than the limit of {MAX_KEYS}")]
    TooManyKeys(usize),
}

/// The content of a file.
pub(crate) struct ParsedFile {
    pub(crate) document: Document,
    pub(crate) buffers: Buffers,
    pub(crate) geometry: Geometry,
}

/// Reads a `.glb` or `.gltf`; what it links to comes from `resolver`.
///
/// # Errors
/// Bytes that are not glTF, that violate the specification or require an unsupported extension; broken links.
pub(crate) fn read(bytes: &[u8], resolver: &dyn Resolver) -> Result<ParsedFile, ImportError> {
    let Gltf { document, blob } = parse(bytes)?;
    let buffers = Buffers::read(&document, blob, resolver)?;
    let nodes = nodes(&document)?;
    meshes::check_size(&document, &buffers)?;
    let geometry = Geometry {
        order: order(&document, &nodes)?,
        visible: visible(&document, &nodes),
        meshes: document
            .meshes()
            .map(|mesh| meshes::read(&mesh, &buffers))
            .collect::<Result<_, _>>()?,
        skins: document
            .skins()
            .map(|skin| self::skin(&skin, &buffers))
            .collect::<Result<_, _>>()?,
        nodes,
    };
    Ok(ParsedFile {
        document,
        buffers,
        geometry,
    })
}

/// The length of the header of a binary file, bytes.
const GLB_HEADER: usize = 12;

/// The file as JSON and binary data, validated.
fn parse(bytes: &[u8]) -> Result<Gltf, ImportError> {
    let unreadable = |error: ::gltf::Error| malformed(error.to_string());
    if let Some((header, _)) = bytes.split_first_chunk::<GLB_HEADER>()
        && let [b'g', b'l', b'T', b'F', _, _, _, _, length @ ..] = *header
        && (u32::from_le_bytes(length) as usize) < GLB_HEADER
    {
        // The `gltf` crate subtracts the one from the other.
        return Err(malformed("it says that it is shorter than its header"));
    }
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(unreadable)?;
    let json = document.into_json();
    // The validation of the `gltf` crate takes the accessors of positions for present.
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut named = primitives
        .flat_map(|primitive| primitive.attributes.values())
        .map(|accessor| accessor.value());
    if let Some(missing) = named.find(|accessor| *accessor >= json.accessors.len()) {
        return Err(malformed(format!(
            "a mesh uses accessor {missing}, which is not there"
        )));
    }
    let unknown = json
        .extensions_required
        .iter()
        .find(|name| !SUPPORTED_EXTENSIONS.contains(&name.as_str()));
    let unknown = unknown.cloned();
    match (Document::from_json(json), unknown) {
        (Ok(document), _) => Ok(Gltf { document, blob }),
        (Err(_), Some(unknown)) => Err(ImportError::Extension(unknown)),
        (Err(error), None) => Err(unreadable(error)),
    }
}

/// The extensions that a file may require.
const SUPPORTED_EXTENSIONS: &[&str] = &[
    "KHR_texture_transform",
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
];

pub(crate) fn malformed(message: impl Into<String>) -> ImportError {
    ImportError::Malformed(message.into())
}

fn nodes(document: &Document) -> Result<TiVec<NodeId, Node>, ImportError> {
    let matrix = |node: &::gltf::Node<'_>| {
        DMat4::from_cols_array_2d(
            &node
                .transform()
                .matrix()
                .map(|column| column.map(f64::from)),
        )
    };
    let mut nodes: TiVec<NodeId, Node> = document
        .nodes()
        .map(|node| {
            Ok(Node {
                parent: None,
                local: matrix(&node),
                mesh: node.mesh().map(|mesh| mesh.index().into()),
                skin: node.skin().map(|skin| skin.index().into()),
                weights: weights(&node),
                view_dependent: view_dependent::read(&node)?,
            })
        })
        .collect::<Result<_, ImportError>>()?;
    for node in document.nodes() {
        for child in node.children() {
            let parent = &mut nodes[id(&child)].parent;
            if parent.replace(id(&node)).is_some() {
                return Err(malformed(format!("node {} has two parents", child.index())));
            }
        }
    }
    Ok(nodes)
}

/// The id of a node.
fn id(node: &::gltf::Node<'_>) -> NodeId {
    node.index().into()
}

/// The weights of morph targets at rest: the node's, or those of its mesh.
fn weights(node: &::gltf::Node<'_>) -> Vec<f32> {
    let own = node.weights().map(<[f32]>::to_vec);
    let of_mesh = || Some(node.mesh()?.weights()?.to_vec());
    own.or_else(of_mesh).unwrap_or_default()
}

/// All nodes, parents before children.
fn order(document: &Document, nodes: &TiSlice<NodeId, Node>) -> Result<Vec<NodeId>, ImportError> {
    let mut order: Vec<NodeId> = nodes
        .keys()
        .filter(|node| nodes[*node].parent.is_none())
        .collect();
    let children: TiVec<NodeId, Vec<NodeId>> = document
        .nodes()
        .map(|node| node.children().map(|child| id(&child)).collect())
        .collect();
    let mut next = 0;
    while let Some(node) = order.get(next).copied() {
        order.extend(&children[node]);
        next += 1;
    }
    if order.len() == nodes.len() {
        Ok(order)
    } else {
        Err(malformed("a node is its own ancestor"))
    }
}

/// Which nodes belong to the file's scene; all of them if there is no scene.
fn visible(document: &Document, nodes: &TiSlice<NodeId, Node>) -> TiVec<NodeId, bool> {
    let Some(scene) = document
        .default_scene()
        .or_else(|| document.scenes().next())
    else {
        return ti_vec![true; nodes.len()];
    };
    let mut visible: TiVec<NodeId, bool> = ti_vec![false; nodes.len()];
    let mut stack: Vec<::gltf::Node<'_>> = scene.nodes().collect();
    while let Some(node) = stack.pop() {
        // A scene may name a node twice, but shows it once.
        if !std::mem::replace(&mut visible[id(&node)], true) {
            stack.extend(node.children());
        }
    }
    visible
}

fn skin(skin: &::gltf::Skin<'_>, buffers: &Buffers) -> Result<Skin, ImportError> {
    let joints: Vec<NodeId> = skin.joints().map(|joint| id(&joint)).collect();
    let inverse = match skin.inverse_bind_matrices() {
        None => vec![DMat4::IDENTITY; joints.len()],
        Some(accessor) => buffers
            .list::<[[f32; 4]; 4]>(&accessor, &[(buffers::F32, buffers::MAT4)])?
            .map(|matrix| DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))))
            .collect(),
    };
    if inverse.len() >= joints.len() {
        Ok(Skin { joints, inverse })
    } else {
        Err(malformed("a skin has more joints than matrices"))
    }
}
