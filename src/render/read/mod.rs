//! glTF 2.0, from bytes to a [`Model`].
//!
//! Read are the hierarchy, triangles (lists, strips, fans), normals, the texture coordinates of the base colour, vertex
//! colours, skins, and of materials base colour, metalness, roughness, light, alpha mode, sides, `unlit`. Normal and
//! occlusion maps, morph targets and animations are not.

mod data;
mod materials;
mod meshes;

use ::gltf::Gltf;
use glam::DMat4;

use super::RenderError;
use super::pose::{Model, Node, Skin};
use crate::resolver::Resolver;
use data::Buffers;

/// Reads a `.glb` or `.gltf`; what it links to comes from `resolver`.
///
/// # Errors
/// Bytes that are no glTF, that break its rules, or need what is not known; links that lead nowhere; images that
/// cannot be decoded.
pub fn read(bytes: &[u8], resolver: &dyn Resolver) -> Result<Model, RenderError> {
    let Gltf { document, blob } = Gltf::from_slice(bytes).map_err(|error| {
        let unknown = Gltf::from_slice_without_validation(bytes)
            .ok()
            .and_then(|file| {
                let mut needed = file.extensions_required();
                needed.find(|name| !KNOWN.contains(name)).map(str::to_owned)
            });
        unknown.map_or_else(|| malformed(error.to_string()), RenderError::Extension)
    })?;
    let buffers = Buffers::read(&document, blob, resolver)?;
    let nodes = nodes(&document)?;
    Ok(Model {
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
        materials: materials::read(&document),
        textures: materials::textures(&document, &buffers, resolver)?,
        nodes,
    })
}

/// The extensions that a file may need.
const KNOWN: &[&str] = &[
    "KHR_texture_transform",
    "KHR_materials_unlit",
    "KHR_materials_emissive_strength",
];

fn malformed(message: impl Into<String>) -> RenderError {
    RenderError::Malformed(message.into())
}

fn nodes(document: &::gltf::Document) -> Result<Vec<Node>, RenderError> {
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
        .map(|node| Node {
            parent: None,
            local: matrix(&node),
            mesh: node.mesh().map(|mesh| mesh.index()),
            skin: node.skin().map(|skin| skin.index()),
        })
        .collect();
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
fn order(document: &::gltf::Document, nodes: &[Node]) -> Result<Vec<usize>, RenderError> {
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
fn drawn(document: &::gltf::Document, nodes: &[Node]) -> Vec<bool> {
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

fn skin(skin: &::gltf::Skin<'_>, buffers: &Buffers) -> Result<Skin, RenderError> {
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
