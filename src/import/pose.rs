//! Nodes, meshes and skins, and where they are in a pose.

use glam::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};

use super::bend::bend;
use super::{ImportError, TRIANGLE_LIMIT};

/// What a file shows, not yet posed.
#[derive(Debug)]
pub(crate) struct Geometry {
    pub(super) nodes: Vec<Node>,
    /// All nodes, parents before children.
    pub(super) order: Vec<usize>,
    /// Which nodes are to be seen.
    pub(super) drawn: Vec<bool>,
    pub(super) meshes: Vec<Vec<Primitive>>,
    pub(super) skins: Vec<Skin>,
}

/// Posed triangles in one frame, the world's. Lists of corners are as long as `positions`, or empty.
#[derive(Debug, Default)]
pub(crate) struct Soup {
    pub(crate) positions: Vec<DVec3>,
    /// Unit vectors; zero where the file has none.
    pub(crate) normals: Vec<Vec3>,
    pub(crate) uvs: Vec<Vec2>,
    pub(crate) colours: Vec<Vec4>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The material of each triangle; none for those that have none.
    pub(crate) materials: Vec<Option<u32>>,
}

#[derive(Debug)]
pub(super) struct Node {
    pub(super) parent: Option<usize>,
    /// From the node's frame into its parent's, at rest.
    pub(super) local: DMat4,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    /// What it shows is bent with the view.
    pub(super) bent: bool,
}

#[derive(Debug)]
pub(super) struct Skin {
    /// Nodes.
    pub(super) joints: Vec<usize>,
    /// From the mesh's frame into each joint's, as bound.
    pub(super) inverse: Vec<DMat4>,
}

/// Triangles of one material. A list of corners is as long as `positions`, or empty.
#[derive(Debug)]
pub(super) struct Primitive {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) colours: Vec<Vec4>,
    /// Sets of four joints and their weights.
    pub(super) influences: Vec<Vec<([u16; 4], [f32; 4])>>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) material: Option<usize>,
}

/// Where every node stands in its parent's frame, and from where it is seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    pub(super) locals: Vec<DMat4>,
    /// Towards the viewer, in the world; without one, nothing follows the viewer.
    towards: Option<DVec3>,
}

impl Pose {
    /// The same pose, with what follows the viewer as it is seen from a direction: the vector towards the viewer, in the
    /// world.
    #[must_use]
    pub(crate) fn seen_from(&self, towards: Option<DVec3>) -> Self {
        Self {
            locals: self.locals.clone(),
            towards,
        }
    }
}

impl Geometry {
    /// The pose that the file is in.
    pub(crate) fn rest(&self) -> Pose {
        Pose {
            locals: self.nodes.iter().map(|node| node.local).collect(),
            towards: None,
        }
    }

    /// Whether anything looks otherwise from elsewhere.
    pub(crate) fn follows_viewer(&self) -> bool {
        self.nodes.iter().any(|node| node.bent)
    }

    /// From each node's frame into the world.
    fn globals(&self, pose: &Pose) -> Vec<DMat4> {
        let mut globals = vec![DMat4::IDENTITY; self.nodes.len()];
        // Below a node that is bent nothing is bent again.
        let mut bent = vec![false; self.nodes.len()];
        for index in &self.order {
            let node = &self.nodes[*index];
            let local = pose.locals[*index];
            let (mut global, within) = match node.parent {
                Some(parent) => (globals[parent] * local, bent[parent]),
                None => (local, false),
            };
            if let Some(towards) = pose.towards.filter(|_| node.bent && !within) {
                global *= bend(global, towards);
            }
            globals[*index] = global;
            bent[*index] = within || node.bent;
        }
        globals
    }

    /// All triangles in a pose.
    ///
    /// # Errors
    /// No triangle, or too many.
    pub(crate) fn triangles(&self, pose: &Pose) -> Result<Soup, ImportError> {
        let globals = self.globals(pose);
        let seen = || {
            let nodes = self
                .nodes
                .iter()
                .enumerate()
                .filter(|(index, _)| self.drawn[*index]);
            nodes.filter_map(|(index, node)| Some((index, node, &self.meshes[node.mesh?])))
        };
        let triangles =
            |mesh: &Vec<Primitive>| mesh.iter().map(|one| one.triangles.len()).sum::<usize>();
        let count = seen().fold(0_usize, |sum, (_, _, mesh)| {
            sum.saturating_add(triangles(mesh))
        });
        if count > TRIANGLE_LIMIT {
            return Err(ImportError::TooManyTriangles(count));
        }
        let mut out = Soup::default();
        for (index, node, mesh) in seen() {
            // The node of a skinned mesh does not move it: its joints do.
            let skin = node
                .skin
                .map(|skin| self.joints(&self.skins[skin], &globals));
            for primitive in mesh {
                let skin = skin.as_deref().filter(|_| !primitive.influences.is_empty());
                append(primitive, globals[index], skin, &mut out);
            }
        }
        match out.triangles.is_empty() {
            true => Err(ImportError::Empty),
            false => Ok(out),
        }
    }

    /// From the mesh's frame as bound into the world, for each joint.
    fn joints(&self, skin: &Skin, globals: &[DMat4]) -> Vec<DMat4> {
        let pairs = skin.joints.iter().zip(&skin.inverse);
        pairs
            .map(|(joint, inverse)| globals[*joint] * *inverse)
            .collect()
    }
}

/// Appends a primitive where its node or its joints take it.
fn append(primitive: &Primitive, global: DMat4, skin: Option<&[DMat4]>, out: &mut Soup) {
    let first = out.positions.len() as u32;
    let material = primitive.material.map(|material| material as u32);
    let blended = skin.map(|joints| {
        (0..primitive.positions.len())
            .map(|corner| blend(&primitive.influences, corner, joints))
            .collect::<Vec<_>>()
    });
    let matrix = |corner: usize| blended.as_ref().map_or(global, |matrices| matrices[corner]);
    let normals = normal_matrix(global);
    for (corner, position) in primitive.positions.iter().enumerate() {
        let vector = |v: [f32; 3]| Vec3::from(v).as_dvec3();
        out.positions
            .push(matrix(corner).transform_point3(vector(*position)));
        let normal = primitive.normals.get(corner).map_or(DVec3::ZERO, |normal| {
            let turn = blended
                .as_ref()
                .map_or(normals, |matrices| normal_matrix(matrices[corner]));
            (turn * vector(*normal)).normalize_or_zero()
        });
        out.normals.push(normal.as_vec3());
    }
    let corners = out.positions.len();
    match primitive.uvs.is_empty() {
        true => out.uvs.resize(corners, Vec2::ZERO),
        false => out.uvs.extend(&primitive.uvs),
    }
    if !primitive.colours.is_empty() || !out.colours.is_empty() {
        // Most models have no colours at corners: the list begins with the first primitive that has.
        out.colours.resize(first as usize, Vec4::ONE);
        out.colours.extend(&primitive.colours);
        out.colours.resize(corners, Vec4::ONE);
    }
    // A mirrored node turns its triangles inside out, and glTF turns them back.
    let mirrored = skin.is_none() && global.determinant() < 0.0;
    out.triangles.extend(primitive.triangles.iter().map(|t| {
        let [a, b, c] = t.map(|corner| corner + first);
        if mirrored { [a, c, b] } else { [a, b, c] }
    }));
    out.materials.resize(out.triangles.len(), material);
}

/// The matrix that turns normals: the inverse transpose, up to a factor that is never zero.
fn normal_matrix(matrix: DMat4) -> DMat3 {
    let m = DMat3::from_mat4(matrix);
    let cofactors = DMat3::from_cols(
        m.y_axis.cross(m.z_axis),
        m.z_axis.cross(m.x_axis),
        m.x_axis.cross(m.y_axis),
    );
    if m.determinant() < 0.0 {
        -cofactors
    } else {
        cofactors
    }
}

/// The weighted mean of a corner's joints; weights that do not add up to one are made to.
fn blend(influences: &[Vec<([u16; 4], [f32; 4])>], corner: usize, joints: &[DMat4]) -> DMat4 {
    let mut sum = DMat4::ZERO;
    let mut total = 0.0;
    for set in influences {
        let (numbers, weights) = set[corner];
        for (number, weight) in numbers.into_iter().zip(weights) {
            let Some(joint) = joints.get(usize::from(number)).filter(|_| weight > 0.0) else {
                continue;
            };
            sum += *joint * f64::from(weight);
            total += f64::from(weight);
        }
    }
    if total > 0.0 {
        sum * (1.0 / total)
    } else {
        DMat4::IDENTITY
    }
}
