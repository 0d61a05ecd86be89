//! Nodes, meshes and skins, and their positions in a pose.

use glam::{DMat3, DMat4, DVec3, Vec2, Vec3, Vec4};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::view_dependent::{bend_matrix, facing};
use super::{ImportError, MAX_REPEATED, MAX_TRIANGLES};
use crate::index::index_type;
use crate::scene::{MeshId, NodeId, Turn, ViewDependent, ViewId};

index_type!(
    /// Counts the skins of a file.
    pub(super) SkinId
);

/// A character that turns, and the weights of its views.
type Seen<'a> = (&'a Turn, TiVec<ViewId, f64>);

/// The geometry of a file, not yet posed.
#[derive(Debug)]
pub(crate) struct Geometry {
    pub(super) nodes: TiVec<NodeId, Node>,
    /// All nodes, parents before children.
    pub(super) order: Vec<NodeId>,
    /// Which nodes are visible.
    pub(super) visible: TiVec<NodeId, bool>,
    pub(super) meshes: TiVec<MeshId, Vec<Primitive>>,
    pub(super) skins: TiVec<SkinId, Skin>,
}

/// Posed triangles in world space. Lists of vertex attributes are as long as `positions`, or empty.
#[derive(Debug, Default)]
pub(crate) struct TriangleSoup {
    pub(crate) positions: Vec<DVec3>,
    /// Unit vectors; zero if the file has none.
    pub(crate) normals: Vec<Vec3>,
    pub(crate) uvs: Vec<Vec2>,
    pub(crate) colors: Vec<Vec4>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The material of each triangle, if it has one.
    pub(crate) materials: Vec<Option<u32>>,
}

#[derive(Debug)]
pub(super) struct Node {
    pub(super) parent: Option<NodeId>,
    /// From the node's frame into its parent's, at rest.
    pub(super) local: DMat4,
    pub(super) mesh: Option<MeshId>,
    pub(super) skin: Option<SkinId>,
    /// The weights of the mesh's morph targets, at rest.
    pub(super) weights: Vec<f32>,
    /// How it follows the viewer.
    pub(super) view_dependent: Option<ViewDependent>,
}

#[derive(Debug)]
pub(super) struct Skin {
    /// Nodes.
    pub(super) joints: Vec<NodeId>,
    /// Inverse bind matrices: from the mesh's frame into each joint's.
    pub(super) inverse: Vec<DMat4>,
}

/// Triangles of one material. Lists of vertex attributes are as long as `positions`, or empty.
#[derive(Debug)]
pub(super) struct Primitive {
    pub(super) positions: Vec<[f32; 3]>,
    /// Morph targets: displacements of the positions.
    pub(super) targets: Vec<Vec<[f32; 3]>>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) colors: Vec<Vec4>,
    /// Sets of four joints and their weights, per vertex.
    pub(super) influences: Vec<Vec<([u16; 4], [f32; 4])>>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) material: Option<usize>,
}

/// The transform of every node in its parent's frame, and the direction of the viewer.
#[derive(Debug, Clone, PartialEq)]
pub struct Pose {
    pub(super) locals: TiVec<NodeId, DMat4>,
    /// Per node the weights of its mesh's morph targets.
    pub(super) weights: TiVec<NodeId, Vec<f32>>,
    /// Per node whether a clip sets them: then a region is where the clip says, too, whatever the viewer's direction.
    pub(super) is_shaped: TiVec<NodeId, bool>,
    /// Towards the viewer in the world; if `None`, nothing follows the viewer.
    towards: Option<DVec3>,
}

impl Pose {
    /// The same pose for a viewer in the direction `towards`, in the world.
    #[must_use]
    pub(crate) fn seen_from(&self, towards: Option<DVec3>) -> Self {
        Self {
            towards,
            ..self.clone()
        }
    }
}

impl Geometry {
    /// The pose in which the file stores the model.
    pub(crate) fn rest(&self) -> Pose {
        Pose {
            locals: self.nodes.iter().map(|node| node.local).collect(),
            weights: self.nodes.iter().map(|node| node.weights.clone()).collect(),
            is_shaped: ti_vec![false; self.nodes.len()],
            towards: None,
        }
    }

    /// Whether any node follows the viewer.
    pub(crate) fn is_view_dependent(&self) -> bool {
        self.nodes.iter().any(|node| node.view_dependent.is_some())
    }

    /// The pose with each character turned to the viewer: where its regions are, and the weights of their morph targets, unless a
    /// clip sets them.
    fn turned(&self, pose: &Pose, towards: DVec3) -> Pose {
        let mut pose = pose.clone();
        let mut globals: TiVec<NodeId, DMat4> = ti_vec![DMat4::IDENTITY; self.nodes.len()];
        // Per node the character that it is a part of, and the weights of the views.
        let mut characters: TiVec<NodeId, Option<Seen<'_>>> = ti_vec![None; self.nodes.len()];
        for id in &self.order {
            let node = &self.nodes[*id];
            let above = node.parent.and_then(|parent| characters[parent].clone());
            let outer = node
                .parent
                .map_or(DMat4::IDENTITY, |parent| globals[parent]);
            match (&node.view_dependent, above) {
                (Some(ViewDependent::Turn(turn)), None) => {
                    let local = pose.locals[*id];
                    let seen = facing(outer * local, towards);
                    pose.locals[*id] = local * seen.rotation;
                    characters[*id] = Some((turn, turn.weights(seen.direction)));
                }
                (Some(ViewDependent::Region(places)), Some((turn, weights)))
                    if !pose.is_shaped[*id] =>
                {
                    let place = turn.position(&weights, places);
                    pose.locals[*id] = DMat4::from_translation(place);
                    pose.weights[*id] = weights.iter().skip(1).map(|w| *w as f32).collect();
                    characters[*id] = Some((turn, weights));
                }
                (_, above) => characters[*id] = above,
            }
            globals[*id] = outer * pose.locals[*id];
        }
        pose
    }

    /// The world transform of each node.
    fn globals(&self, pose: &Pose) -> TiVec<NodeId, DMat4> {
        let mut globals: TiVec<NodeId, DMat4> = ti_vec![DMat4::IDENTITY; self.nodes.len()];
        // A node below a bent one is not bent a second time.
        let mut bends: TiVec<NodeId, bool> = ti_vec![false; self.nodes.len()];
        for id in &self.order {
            let node = &self.nodes[*id];
            let local = pose.locals[*id];
            let (mut global, within) = match node.parent {
                Some(parent) => (globals[parent] * local, bends[parent]),
                None => (local, false),
            };
            let is_bent = node.view_dependent == Some(ViewDependent::Bend);
            if let Some(towards) = pose.towards.filter(|_| is_bent && !within) {
                global *= bend_matrix(global, towards);
            }
            globals[*id] = global;
            bends[*id] = within || is_bent;
        }
        globals
    }

    /// The transform from a node's frame to the world in a pose.
    pub(crate) fn to_world(&self, pose: &Pose, node: NodeId) -> DMat4 {
        self.globals(pose)[node]
    }

    /// The places of some nodes in a pose, in the world.
    pub(crate) fn places(&self, pose: &Pose, nodes: &[NodeId]) -> Vec<DVec3> {
        let globals = self.globals(pose);
        let place = |node: &NodeId| globals[*node].w_axis.truncate();
        nodes.iter().map(place).collect()
    }

    /// All triangles in a pose.
    ///
    /// # Errors
    /// No triangles, or too many.
    pub(crate) fn triangles(&self, pose: &Pose) -> Result<TriangleSoup, ImportError> {
        self.triangles_of(pose, &self.visible)
    }

    /// The triangles of the nodes that are marked, in a pose.
    ///
    /// # Errors
    /// No triangles, or too many.
    pub(crate) fn triangles_of(
        &self,
        pose: &Pose,
        marked: &TiSlice<NodeId, bool>,
    ) -> Result<TriangleSoup, ImportError> {
        let turned = pose.towards.map(|towards| self.turned(pose, towards));
        let pose = turned.as_ref().unwrap_or(pose);
        let globals = self.globals(pose);
        let seen = || {
            let nodes = self.nodes.iter_enumerated().filter(|(id, _)| marked[*id]);
            nodes.filter_map(|(id, node)| Some((id, node, &self.meshes[node.mesh?])))
        };
        let triangles =
            |mesh: &Vec<Primitive>| mesh.iter().map(|one| one.triangles.len()).sum::<usize>();
        let count = seen().fold(0_usize, |sum, (_, _, mesh)| {
            sum.saturating_add(triangles(mesh))
        });
        if count > MAX_TRIANGLES {
            return Err(ImportError::TooManyTriangles(count));
        }
        let vertices =
            |mesh: &Vec<Primitive>| mesh.iter().map(|one| one.positions.len()).sum::<usize>();
        let repeated = seen().fold(0_usize, |sum, (_, _, mesh)| {
            sum.saturating_add(vertices(mesh))
        });
        // Corners of triangles are limited already; what can be more are vertices that no triangle uses.
        let own = self.meshes.iter().map(vertices).sum::<usize>();
        let size = size_of::<[f32; 3]>();
        if repeated > own + 3 * count + MAX_REPEATED / size {
            return Err(ImportError::TooManyVertices(
                repeated.saturating_mul(size) >> 20,
            ));
        }
        let mut out = TriangleSoup::default();
        for (id, node, mesh) in seen() {
            // A skinned mesh follows its joints only, not its node.
            let skin = node
                .skin
                .map(|skin| self.joints(&self.skins[skin], &globals));
            for primitive in mesh {
                let skin = skin.as_deref().filter(|_| !primitive.influences.is_empty());
                append(primitive, globals[id], skin, &pose.weights[id], &mut out);
            }
        }
        if out.triangles.is_empty() {
            Err(ImportError::Empty)
        } else {
            Ok(out)
        }
    }

    /// The matrix of each joint that takes bound vertices into the world.
    fn joints(&self, skin: &Skin, globals: &TiSlice<NodeId, DMat4>) -> Vec<DMat4> {
        let pairs = skin.joints.iter().zip(&skin.inverse);
        pairs
            .map(|(joint, inverse)| globals[*joint] * *inverse)
            .collect()
    }
}

/// Appends a primitive, transformed by its node or its joints.
fn append(
    primitive: &Primitive,
    global: DMat4,
    skin: Option<&[DMat4]>,
    weights: &[f32],
    out: &mut TriangleSoup,
) {
    let morphs = primitive.targets.iter().zip(weights);
    let morphs: Vec<(&Vec<[f32; 3]>, f64)> = morphs
        .filter(|(_, weight)| **weight != 0.0)
        .map(|(target, weight)| (target, f64::from(*weight)))
        .collect();
    let first = out.positions.len() as u32;
    let material = primitive.material.map(|material| material as u32);
    let blended = skin.map(|joints| {
        (0..primitive.positions.len())
            .map(|corner| blended_joint_matrix(&primitive.influences, corner, joints))
            .collect::<Vec<_>>()
    });
    let matrix = |corner: usize| blended.as_ref().map_or(global, |matrices| matrices[corner]);
    let normals = normal_matrix(global);
    for (corner, position) in primitive.positions.iter().enumerate() {
        let vector = |v: [f32; 3]| Vec3::from(v).as_dvec3();
        let mut place = vector(*position);
        for (target, weight) in &morphs {
            place += *weight * vector(target[corner]);
        }
        out.positions.push(matrix(corner).transform_point3(place));
        let normal = primitive.normals.get(corner).map_or(DVec3::ZERO, |normal| {
            let turn = blended
                .as_ref()
                .map_or(normals, |matrices| normal_matrix(matrices[corner]));
            (turn * vector(*normal)).normalize_or_zero()
        });
        out.normals.push(normal.as_vec3());
    }
    let corners = out.positions.len();
    if primitive.uvs.is_empty() {
        out.uvs.resize(corners, Vec2::ZERO)
    } else {
        out.uvs.extend(&primitive.uvs)
    }
    if !primitive.colors.is_empty() || !out.colors.is_empty() {
        // Few models have vertex colours: the list stays empty until the first primitive that has them.
        out.colors.resize(first as usize, Vec4::ONE);
        out.colors.extend(&primitive.colors);
        out.colors.resize(corners, Vec4::ONE);
    }
    // glTF reverses the winding of triangles under a mirrored node.
    let mirrored = skin.is_none() && global.determinant() < 0.0;
    out.triangles.extend(primitive.triangles.iter().map(|t| {
        let [a, b, c] = t.map(|corner| corner + first);
        if mirrored { [a, c, b] } else { [a, b, c] }
    }));
    out.materials.resize(out.triangles.len(), material);
}

/// The matrix for normals: the inverse transpose, up to a positive factor, as the matrix of cofactors.
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

/// The weighted mean of a vertex's joint matrices (linear blend skinning); weights are normalised.
fn blended_joint_matrix(
    influences: &[Vec<([u16; 4], [f32; 4])>],
    corner: usize,
    joints: &[DMat4],
) -> DMat4 {
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
