//! The model: nodes, meshes, materials. No drawing, no glTF.
//!
//! Conventions, stated once: right-handed axes, +Y up, metres, counter-clockwise front faces seen
//! from outside, quaternions `x y z w`, colours linear RGBA.

use std::borrow::Cow;

use glam::{DQuat, DVec3};

use crate::solid::Solid;

/// A model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    /// All nodes; a child stands behind its parent.
    pub nodes: Vec<Node>,
    /// Indices of the nodes without a parent.
    pub roots: Vec<usize>,
    /// The meshes that nodes point at.
    pub meshes: Vec<Mesh>,
    /// The materials that primitives point at.
    pub materials: Vec<Material>,
}

/// A node of the hierarchy: a joint, with or without a solid.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Node {
    /// The part's name.
    pub name: String,
    /// Indices of the children.
    pub children: Vec<usize>,
    /// Where the node stands in its parent's frame, metres.
    pub translation: DVec3,
    /// How it is turned there.
    pub rotation: DQuat,
    /// Its solid.
    pub mesh: Option<usize>,
    /// Where it comes from.
    pub provenance: Option<Provenance>,
}

/// Where a node comes from; glTF carries it as `extras.okoshi`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Provenance {
    /// The `id` of the source element, if it has one.
    pub element: Option<String>,
    /// The string that describes the part.
    pub string: Option<String>,
}

/// A mesh: one primitive a material.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Its primitives, never empty.
    pub primitives: Vec<Primitive>,
}

/// Triangles of one material.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Primitive {
    /// What they are made of.
    pub pieces: Vec<Piece>,
    /// Index of the material.
    pub material: usize,
}

/// A piece of a primitive.
#[derive(Debug, Clone, PartialEq)]
pub enum Piece {
    /// Triangles.
    Surface(Surface),
    /// A solid, whose triangles are made when they are asked for: most who look at a scene never do, and a
    /// large one would fill the memory.
    Solid(Solid),
}

impl Piece {
    /// Its triangles.
    pub fn surface(&self) -> Cow<'_, Surface> {
        match self {
            Self::Surface(surface) => Cow::Borrowed(surface),
            Self::Solid(solid) => Cow::Owned(solid.surface()),
        }
    }
}

impl Primitive {
    /// The triangles of all its pieces.
    pub fn surface(&self) -> Cow<'_, Surface> {
        match self.pieces.as_slice() {
            [piece] => piece.surface(),
            pieces => Cow::Owned(pieces.iter().fold(Surface::default(), |mut all, piece| {
                all.append(&piece.surface());
                all
            })),
        }
    }
}

/// Triangles with shared corners. All lists of corners have one length; `uvs` may be empty.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    /// Positions, in the node's frame, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, origin at the image's top left.
    pub uvs: Vec<[f32; 2]>,
    /// Three corners a triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Appends another surface.
    pub fn append(&mut self, other: &Surface) {
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.uvs.extend_from_slice(&other.uvs);
        self.triangles.extend(
            other
                .triangles
                .iter()
                .map(|t| t.map(|corner| corner + base)),
        );
    }
}

/// A glTF metallic-roughness material.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Base colour, linear RGB and alpha, each 0 to 1.
    pub base_color: [f32; 4],
    /// 0 to 1.
    pub metallic: f32,
    /// 0 to 1.
    pub roughness: f32,
    /// Linear RGB, each 0 to 1.
    pub emissive: [f32; 3],
    /// Seen from both sides: surfaces without thickness.
    pub double_sided: bool,
}
