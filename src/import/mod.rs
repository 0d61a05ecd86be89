//! glTF 2.0 that others made, taken apart: for pictures of it, and for models that drawings link to.
//!
//! Read are the hierarchy, triangles (lists, strips, fans), normals, one set of texture coordinates, vertex colours
//! and skins, which nodes bend with the view, and clips; materials and images are left to whoever wants them. Morph targets are
//! not read.

mod animations;
mod asset;
mod bend;
mod data;
mod meshes;
mod pose;

use ::gltf::{Document, Gltf};
use glam::DMat4;

use crate::resolver::{LinkError, Resolver};

pub(crate) use animations::read as read_clips;
pub use animations::{Clip, KEY_LIMIT};
pub use asset::{Asset, read_asset};
pub(crate) use data::{Buffers, fetch};
pub use pose::Pose;
pub(crate) use pose::{Geometry, Soup};
use pose::{Node, Skin};

/// The most triangles of a file, those of a mesh once for each node that has it.
pub const TRIANGLE_LIMIT: usize = 32 << 20;

/// Why a file cannot be read. Messages go behind the name of the file.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The bytes are no glTF, or break its rules.
    #[error(
        "is not a readable glTF file: {0}; export it again, or check it with the Khronos glTF validator"
    )]
    Malformed(String),
    /// It needs an extension of glTF that is not known here.
    #[error(
        "needs the glTF extension `{0}`, which okoshi does not support; export it without that extension"
    )]
    Extension(String),
    /// A file that it links to cannot be had.
    #[error("links to `{link}`, which {error}")]
    Link {
        /// As the file names it.
        link: String,
        /// What is wrong with it.
        error: LinkError,
    },
    /// An image cannot be decoded.
    #[error("has an image that cannot be read ({0}); use PNG or JPEG")]
    Image(String),
    /// No triangle to be seen.
    #[error("has no triangles: there is nothing to see")]
    Empty,
    /// More than [`TRIANGLE_LIMIT`] triangles.
    #[error("has {0} triangles, more than the limit of {TRIANGLE_LIMIT}")]
    TooManyTriangles(usize),
    /// More than [`KEY_LIMIT`] keys.
    #[error("has clips with {0} keys, more than the limit of {KEY_LIMIT}")]
    TooManyKeys(usize),
}

/// A file, taken apart.
pub(crate) struct File {
    pub(crate) document: Document,
    pub(crate) buffers: Buffers,
    pub(crate) geometry: Geometry,
}

/// Reads a `.glb` or `.gltf`; what it links to comes from `resolver`.
///
/// # Errors
/// Bytes that are no glTF, that break its rules, or need what is not known; links that lead nowhere.
pub(crate) fn read(bytes: &[u8], resolver: &dyn Resolver) -> Result<File, ImportError> {
    let Gltf { document, blob } = Gltf::from_slice(bytes).map_err(|error| {
        let unknown = Gltf::from_slice_without_validation(bytes)
            .ok()
            .and_then(|file| {
                let mut needed = file.extensions_required();
                needed.find(|name| !KNOWN.contains(name)).map(str::to_owned)
            });
        unknown.map_or_else(|| malformed(error.to_string()), ImportError::Extension)
    })?;
    let buffers = Buffers::read(&document, blob, resolver)?;
    let nodes = nodes(&document)?;
    let geometry = Geometry {
        order: order(&document, &nodes)?,
        drawn: drawn(&document, &nodes),
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
    Ok(File {
        document,
        buffers,
        geometry,
    })
}

/// The extensions that a file may need.
const KNOWN: &[&str] = &[
    "KHR_texture_transform",
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
];

pub(crate) fn malformed(message: impl Into<String>) -> ImportError {
    ImportError::Malformed(message.into())
}

fn nodes(document: &Document) -> Result<Vec<Node>, ImportError> {
    let matrix = |node: &::gltf::Node<'_>| {
        DMat4::from_cols_array_2d(
            &node
                .transform()
                .matrix()
                .map(|column| column.map(f64::from)),
        )
    };
    let mut nodes: Vec<Node> = document
        .nodes()
        .map(|node| {
            Ok(Node {
                parent: None,
                local: matrix(&node),
                mesh: node.mesh().map(|mesh| mesh.index()),
                skin: node.skin().map(|skin| skin.index()),
                bent: bend::asked(&node)?,
            })
        })
        .collect::<Result<_, ImportError>>()?;
    for node in document.nodes() {
        for child in node.children() {
            if nodes[child.index()].parent.replace(node.index()).is_some() {
                return Err(malformed(format!("node {} has two parents", child.index())));
            }
        }
    }
    Ok(nodes)
}

/// All nodes, parents before children.
fn order(document: &Document, nodes: &[Node]) -> Result<Vec<usize>, ImportError> {
    let mut order: Vec<usize> = (0..nodes.len())
        .filter(|node| nodes[*node].parent.is_none())
        .collect();
    let children: Vec<Vec<usize>> = document
        .nodes()
        .map(|node| node.children().map(|child| child.index()).collect())
        .collect();
    let mut next = 0;
    while let Some(node) = order.get(next).copied() {
        order.extend(&children[node]);
        next += 1;
    }
    match order.len() == nodes.len() {
        true => Ok(order),
        false => Err(malformed("a node is its own ancestor")),
    }
}

/// Which nodes the file's scene shows; all of them where there is no scene.
fn drawn(document: &Document, nodes: &[Node]) -> Vec<bool> {
    let Some(scene) = document
        .default_scene()
        .or_else(|| document.scenes().next())
    else {
        return vec![true; nodes.len()];
    };
    let mut drawn = vec![false; nodes.len()];
    let mut stack: Vec<::gltf::Node<'_>> = scene.nodes().collect();
    while let Some(node) = stack.pop() {
        // A scene may name a node twice, but shows it once.
        if !std::mem::replace(&mut drawn[node.index()], true) {
            stack.extend(node.children());
        }
    }
    drawn
}

fn skin(skin: &::gltf::Skin<'_>, buffers: &Buffers) -> Result<Skin, ImportError> {
    let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    let inverse = match skin.inverse_bind_matrices() {
        None => vec![DMat4::IDENTITY; joints.len()],
        Some(accessor) => buffers
            .list::<[[f32; 4]; 4]>(&accessor, &[(data::F32, data::MAT4)])?
            .map(|matrix| DMat4::from_cols_array_2d(&matrix.map(|column| column.map(f64::from))))
            .collect(),
    };
    match inverse.len() >= joints.len() {
        true => Ok(Skin { joints, inverse }),
        false => Err(malformed("a skin has more joints than matrices")),
    }
}
