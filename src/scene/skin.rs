//! One skinned mesh in the place of a mesh a node (figure.md, glTF), for engines that want that.

use std::fmt;

use glam::{DQuat, DVec3, Vec3};

use super::{Mesh, Node, Piece, Primitive, Scene, Surface};

/// The most joints of a skin: corners name them in 16 bits.
pub const MOST_JOINTS: usize = 1 << 16;

/// A mesh that follows the nodes: every node of the scene is a joint, in the order of the nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    /// Index of the mesh; its corners stand in the world's frame, as the nodes rest.
    pub mesh: usize,
    /// Per node its place in the world at rest.
    pub rest: Vec<Pose>,
}

/// A turn and a move: carries a point to `rotation · point + translation`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// How things are turned.
    pub rotation: DQuat,
    /// How far they are moved then, metres.
    pub translation: DVec3,
}

impl Pose {
    const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// The pose of a node in the frame that its parent is in.
    fn of(node: &Node) -> Self {
        Self {
            rotation: node.rotation,
            translation: node.translation,
        }
    }

    /// Where a point goes.
    fn place(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// This pose after `inner`.
    fn after(&self, inner: &Self) -> Self {
        Self {
            rotation: (self.rotation * inner.rotation).normalize(),
            translation: self.place(inner.translation),
        }
    }

    /// The way back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self {
            rotation,
            translation: rotation * -self.translation,
        }
    }
}

/// A piece in the world, which follows a joint with all its weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Posed {
    /// The piece in the joint's frame.
    pub piece: Piece,
    /// From there to the world at rest.
    pub pose: Pose,
    /// Index of the joint.
    pub joint: u16,
}

impl Posed {
    /// Its triangles.
    pub(super) fn surface(&self) -> Surface {
        let mut surface = self.piece.surface().into_owned();
        let turn = self.pose.rotation.as_quat();
        for position in &mut surface.positions {
            let place = self.pose.place(Vec3::from(*position).as_dvec3());
            *position = place.as_vec3().to_array();
        }
        for normal in &mut surface.normals {
            *normal = (turn * Vec3::from(*normal)).normalize_or_zero().to_array();
        }
        surface.joints = vec![self.joint; surface.positions.len()];
        surface
    }
}

/// A scene has more nodes than a skin can have joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooManyJoints {
    /// How many there are.
    pub joints: usize,
}

impl fmt::Display for TooManyJoints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let joints = self.joints;
        write!(
            f,
            "the model has {joints} joints, but a skin holds at most {MOST_JOINTS}; build it without --skin"
        )
    }
}

impl std::error::Error for TooManyJoints {}

impl Scene {
    /// The same model with one skinned mesh, a primitive a material; the nodes become its joints.
    ///
    /// Nodes that follow the viewer and those below them keep meshes of their own: a skin's corners know no viewer.
    ///
    /// # Errors
    /// More nodes than [`MOST_JOINTS`].
    pub fn skinned(mut self) -> Result<Self, TooManyJoints> {
        let joints = self.nodes.len();
        if joints > MOST_JOINTS {
            return Err(TooManyJoints { joints });
        }
        let rest = rest(&self.nodes);
        let kept = below_view_dependent(&self.nodes);
        let mut by_material: Vec<Vec<Piece>> = vec![Vec::new(); self.materials.len()];
        for (joint, node) in self.nodes.iter_mut().enumerate() {
            if kept[joint] {
                continue;
            }
            let Some(mesh) = node.mesh.take() else {
                continue;
            };
            for primitive in &self.meshes[mesh].primitives {
                let posed = primitive.pieces.iter().map(|piece| {
                    Piece::Posed(Box::new(Posed {
                        piece: piece.clone(),
                        pose: rest[joint],
                        joint: joint as u16,
                    }))
                });
                by_material[primitive.material].extend(posed);
            }
        }
        let primitives: Vec<Primitive> = by_material
            .into_iter()
            .enumerate()
            .filter(|(_, pieces)| !pieces.is_empty())
            .map(|(material, pieces)| Primitive { pieces, material })
            .collect();
        self.keep_used_meshes();
        if !primitives.is_empty() {
            let mesh = self.meshes.len();
            self.meshes.push(Mesh { primitives });
            self.skin = Some(Skin { mesh, rest });
        }
        Ok(self)
    }

    /// Leaves out the meshes that no node shows.
    fn keep_used_meshes(&mut self) {
        let mut kept = vec![None; self.meshes.len()];
        for mesh in self.nodes.iter().filter_map(|node| node.mesh) {
            kept[mesh] = Some(0);
        }
        let mut numbers = 0..;
        for kept in kept.iter_mut().flatten() {
            *kept = numbers.next().unwrap_or_default();
        }
        for node in &mut self.nodes {
            node.mesh = node.mesh.and_then(|mesh| kept[mesh]);
        }
        let mut kept = kept.into_iter();
        self.meshes.retain(|_| kept.next().flatten().is_some());
    }
}

/// Which nodes follow the viewer, by themselves or with a node above them; a child stands behind its parent.
fn below_view_dependent(nodes: &[Node]) -> Vec<bool> {
    let mut found = vec![false; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        found[index] |= node.view_dependent.is_some();
        for child in &node.children {
            found[*child] = found[index];
        }
    }
    found
}

/// Where nodes stand in the world; a child stands behind its parent.
fn rest(nodes: &[Node]) -> Vec<Pose> {
    let mut outer = vec![Pose::IDENTITY; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        outer[index] = outer[index].after(&Pose::of(node));
        for child in &node.children {
            outer[*child] = outer[index];
        }
    }
    outer
}
