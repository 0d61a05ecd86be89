//! One skinned mesh instead of a mesh for each node, for engines that need that.

use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::{MaterialId, Mesh, MeshId, Node, NodeId, Primitive, Scene, Surface, SurfacePatch};

/// The largest number of joints of a skin: corners refer to them by 16 bits.
pub const MAX_JOINTS: usize = 1 << 16;

/// The joints that move a corner of a surface, at most four.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Influence {
    /// Indices of the joints: of a skin, or of a node with bones, where 0 is the node itself and others are its bones, from 1.
    pub joints: [u16; 4],
    /// Their weights, whose sum is 1. No joint with a weight is there twice.
    pub weights: [f32; 4],
}

impl Influence {
    /// That of one joint with its full weight.
    pub fn whole(joint: u16) -> Self {
        Self {
            joints: [joint, 0, 0, 0],
            weights: [1.0, 0.0, 0.0, 0.0],
        }
    }

    /// The weights as bytes whose sum is 255; a joint without weight has number 0, as glTF wants it.
    pub(crate) fn quantized(&self) -> [(u16, u8); 4] {
        // Rounded sums of weights differ by whole bytes, so that nothing is left over.
        let (mut sum, mut before) = (0.0, 0_u8);
        let mut quantized = [(0, 0); 4];
        for (at, own) in quantized.iter_mut().enumerate() {
            sum += self.weights[at].max(0.0);
            let after = (sum.min(1.0) * 255.0).round() as u8;
            let weight = after - before;
            before = after;
            *own = (if weight == 0 { 0 } else { self.joints[at] }, weight);
        }
        quantized
    }
}

/// A mesh that is bound to the nodes: every node of the scene is a joint, except those of cameras.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    /// The mesh; its corners are in the world's frame, in the rest pose.
    pub mesh: MeshId,
    /// The nodes that are joints, ascending.
    pub joints: Vec<NodeId>,
    /// Per joint its transform to the world in the rest pose.
    pub rest: Vec<RigidTransform>,
}

/// A rotation and a translation: maps a point to `rotation · point + translation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidTransform {
    /// Applied first.
    pub rotation: DQuat,
    /// Applied after the rotation, metres.
    pub translation: DVec3,
}

impl RigidTransform {
    pub(crate) const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// The transform from a node's frame to its parent's.
    fn of(node: &Node) -> Self {
        Self {
            rotation: node.rotation,
            translation: node.translation,
        }
    }

    /// The image of a point.
    pub(crate) fn place(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// The composition: `inner` first.
    pub(crate) fn after(&self, inner: &Self) -> Self {
        Self {
            rotation: (self.rotation * inner.rotation).normalize(),
            translation: self.place(inner.translation),
        }
    }

    /// The inverse transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self {
            rotation,
            translation: rotation * -self.translation,
        }
    }
}

/// A patch in the world's frame that is bound to the joints of a node.
#[derive(Debug, Clone, PartialEq)]
pub struct SkinnedPatch {
    /// The patch in the node's frame.
    pub patch: SurfacePatch,
    /// From the node's frame to the world in the rest pose.
    pub pose: RigidTransform,
    /// Indices in the skin of the node and of its bones.
    pub joints: Arc<[u16]>,
}

impl SkinnedPatch {
    /// Its triangles.
    pub(super) fn surface(&self) -> Surface {
        let mut surface = self.patch.surface().into_owned();
        let turn = self.pose.rotation.as_quat();
        for position in &mut surface.positions {
            let place = self.pose.place(Vec3::from(*position).as_dvec3());
            *position = place.as_vec3().to_array();
        }
        for normal in &mut surface.normals {
            *normal = (turn * Vec3::from(*normal)).normalize_or_zero().to_array();
        }
        let joint = |joint: u16| self.joints.get(usize::from(joint)).copied();
        if surface.influences.is_empty() {
            let own = Influence::whole(joint(0).unwrap_or_default());
            surface.influences = vec![own; surface.positions.len()];
        } else {
            for influence in &mut surface.influences {
                influence.joints = influence.joints.map(|own| joint(own).unwrap_or_default());
            }
        }
        surface
    }
}

/// A scene has more parts than a skin can have joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the model has {joints} joints, but a skin holds at most {}; build it without --skin",
    MAX_JOINTS
)]
pub struct TooManyJoints {
    /// The number of joints.
    pub joints: usize,
}

impl Scene {
    /// The same model with one skinned mesh, with a primitive for each material. The nodes become its joints, except those of
    /// cameras.
    ///
    /// View-dependent nodes and their descendants keep their own meshes, because corners of a skin cannot depend on the viewer.
    ///
    /// # Errors
    /// More joints than [`MAX_JOINTS`].
    pub fn skinned(mut self) -> Result<Self, TooManyJoints> {
        let joints: Vec<NodeId> = self
            .nodes
            .keys()
            .filter(|node| self.nodes[*node].camera.is_none())
            .collect();
        if joints.len() > MAX_JOINTS {
            return Err(TooManyJoints {
                joints: joints.len(),
            });
        }
        let to_world = self.rest();
        let rest: Vec<RigidTransform> = joints.iter().map(|node| to_world[*node]).collect();
        let kept = below_view_dependent(&self.nodes);
        let mut by_material: TiVec<MaterialId, Vec<SurfacePatch>> =
            ti_vec![Vec::new(); self.materials.len()];
        let mut numbers: TiVec<NodeId, u16> = ti_vec![0; self.nodes.len()];
        for (joint, node) in joints.iter().enumerate() {
            numbers[*node] = joint as u16;
        }
        for (joint, node) in joints.iter().enumerate() {
            if kept[*node] {
                continue;
            }
            let Some(mesh) = self.nodes[*node].mesh.take() else {
                continue;
            };
            let bones = std::mem::take(&mut self.nodes[*node].bones);
            let of_node = std::iter::once(*node).chain(bones);
            let of_node: Arc<[u16]> = of_node.map(|bone| numbers[bone]).collect();
            for primitive in &self.meshes[mesh].primitives {
                let skinned = primitive.patches.iter().map(|patch| {
                    SurfacePatch::Skinned(Box::new(SkinnedPatch {
                        patch: patch.clone(),
                        pose: rest[joint],
                        joints: Arc::clone(&of_node),
                    }))
                });
                by_material[primitive.material].extend(skinned);
            }
        }
        let primitives: Vec<Primitive> = by_material
            .into_iter_enumerated()
            .filter(|(_, patches)| !patches.is_empty())
            .map(|(material, patches)| Primitive { patches, material })
            .collect();
        self.keep_used_meshes();
        if !primitives.is_empty() {
            let mesh = self.meshes.push_and_get_key(Mesh { primitives });
            self.skin = Some(Skin { mesh, joints, rest });
        }
        Ok(self)
    }

    /// The transforms of the nodes to the world in the rest pose.
    pub(crate) fn rest(&self) -> TiVec<NodeId, RigidTransform> {
        let mut outer: TiVec<NodeId, RigidTransform> =
            ti_vec![RigidTransform::IDENTITY; self.nodes.len()];
        // A child comes after its parent.
        for (id, node) in self.nodes.iter_enumerated() {
            outer[id] = outer[id].after(&RigidTransform::of(node));
            for child in &node.children {
                outer[*child] = outer[id];
            }
        }
        outer
    }

    /// Removes the meshes that no node uses.
    fn keep_used_meshes(&mut self) {
        let mut is_used: TiVec<MeshId, bool> = ti_vec![false; self.meshes.len()];
        for mesh in self.nodes.iter().filter_map(|node| node.mesh) {
            is_used[mesh] = true;
        }
        let mut kept = TiVec::with_capacity(self.meshes.len());
        let meshes = std::mem::take(&mut self.meshes).into_iter_enumerated();
        let numbers: TiVec<MeshId, Option<MeshId>> = meshes
            .map(|(mesh, content)| is_used[mesh].then(|| kept.push_and_get_key(content)))
            .collect();
        self.meshes = kept;
        for node in &mut self.nodes {
            node.mesh = node.mesh.and_then(|mesh| numbers[mesh]);
        }
    }
}

/// Per node whether it or an ancestor is view-dependent; a child comes after its parent.
fn below_view_dependent(nodes: &TiSlice<NodeId, Node>) -> TiVec<NodeId, bool> {
    let mut found: TiVec<NodeId, bool> = ti_vec![false; nodes.len()];
    for (id, node) in nodes.iter_enumerated() {
        found[id] |= node.view_dependent.is_some();
        for child in &node.children {
            found[*child] = found[id];
        }
    }
    found
}
