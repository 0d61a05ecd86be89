//! The nodes of figures, with their meshes, in the world's axes.

use crate::math;
use rayon::prelude::*;
use typed_index_collections::{TiVec, ti_vec};

use super::FigureContext;
use super::tree::FigureNode;
use crate::bind::PartId;
use crate::scene::{
    Mesh, MeshId, Node, NodeId, Primitive, Provenance, Scene, SurfacePatch, WorldTransform,
};
use crate::threads::GRAIN;

/// A node that shows a part, and how it lies in the hierarchy.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PartNode {
    /// The part.
    pub part: PartId,
    /// Which node of the part it is: 0 is its own one, others bend it.
    pub bone: usize,
    /// The parent node; `None` for a root.
    pub parent: Option<NodeId>,
    /// Whether the node is mirrored in the drawing plane.
    pub is_mirrored: bool,
    /// How far it lies in front of the drawing plane, drawing units.
    pub depth: f64,
}

/// Adds nodes and meshes to a scene without nodes. Returns the part of each node, and the first node of each part.
pub(super) fn add(
    context: &FigureContext<'_>,
    tree: TiVec<NodeId, FigureNode>,
    meshes: TiVec<PartId, Option<Mesh>>,
    world: &WorldTransform,
    scene: &mut Scene,
) -> (TiVec<NodeId, PartNode>, TiVec<PartId, Option<NodeId>>) {
    let mut nodes: TiVec<NodeId, PartNode> = TiVec::with_capacity(tree.len());
    for node in &tree {
        let above = node.parent.map_or(0.0, |parent| nodes[parent].depth);
        nodes.push(PartNode {
            part: node.part,
            bone: node.bone,
            parent: node.parent,
            is_mirrored: node.is_mirrored,
            depth: above + node.position.z,
        });
    }
    let bones: TiVec<NodeId, usize> = tree.iter().map(|node| node.bone).collect();
    let to_scene = |node: FigureNode| {
        let rotation = math::rotation_z(node.angle);
        let (translation, rotation) = match node.parent {
            Some(_) => (node.position * world.scale, rotation),
            None => (world.point(node.position), world.rotate(rotation)),
        };
        let part = &context.bindings.parts[node.part];
        let string = part
            .string
            .map(|string| &context.bindings.strings[string].text);
        Node {
            name: node.name,
            translation,
            rotation,
            shares: node.shares,
            // Bones belong to the part that their first node shows.
            provenance: (node.bone == 0).then(|| Provenance {
                element: context.drawing.shapes[part.shape].element.id.clone(),
                string: string.map(|text| text.as_str().to_owned()),
            }),
            ..Node::default()
        }
    };
    let in_scene = tree.raw.into_par_iter().with_min_len(GRAIN);
    scene.nodes = in_scene.map(to_scene).collect::<Vec<Node>>().into();
    let mut meshes = Meshes {
        placed: ti_vec![[None; 2]; meshes.len()],
        made: meshes,
    };
    let mut node_of_part = ti_vec![None; meshes.made.len()];
    for (id, node) in nodes.iter_enumerated() {
        node_of_part[node.part].get_or_insert(id);
        match node.parent {
            Some(parent) => scene.nodes[parent].children.push(id),
            None => scene.roots.push(id),
        }
        if bones[id] == 0 {
            scene.nodes[id].mesh = meshes.place(node.part, node.is_mirrored, &mut scene.meshes);
            let bend = context.bends[node.part].as_deref();
            let of = match node.parent {
                Some(wearer) if bend.is_some_and(|bend| bend.is_worn) => wearer,
                _ => id,
            };
            let after = (usize::from(of) + 1..).map(NodeId::from);
            let own = after.take_while(|next| bones.get(*next).is_some_and(|bone| *bone > 0));
            scene.nodes[id].bones = own.collect();
        }
    }
    (nodes, node_of_part)
}

/// Moves the meshes of parts into the scene.
struct Meshes {
    /// Per part its mesh, until it is in the scene.
    made: TiVec<PartId, Option<Mesh>>,
    /// Per part its mesh and the mirrored mesh in the scene.
    placed: TiVec<PartId, [Option<MeshId>; 2]>,
}

impl Meshes {
    /// The mesh of a part, mirrored for a mirrored node. If only the other one is in the scene, it is made from that.
    fn place(
        &mut self,
        part: PartId,
        is_mirrored: bool,
        scene: &mut TiVec<MeshId, Mesh>,
    ) -> Option<MeshId> {
        let side = usize::from(is_mirrored);
        let placed = self.placed[part];
        if placed[side].is_none() {
            let mesh = match (self.made[part].take(), placed[1 - side]) {
                (Some(mesh), _) if is_mirrored => mirrored(&mesh),
                (Some(mesh), _) => mesh,
                (None, Some(twin)) => mirrored(&scene[twin]),
                (None, None) => return None,
            };
            self.placed[part][side] = Some(scene.push_and_get_key(mesh));
        }
        self.placed[part][side]
    }
}

/// A mesh mirrored in the drawing plane.
fn mirrored(mesh: &Mesh) -> Mesh {
    let primitive = |primitive: &Primitive| Primitive {
        patches: primitive
            .patches
            .iter()
            .map(SurfacePatch::mirrored)
            .collect(),
        material: primitive.material,
    };
    Mesh {
        primitives: mesh.primitives.iter().map(primitive).collect(),
    }
}
