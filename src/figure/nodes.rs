//! The nodes of figures, with their meshes, in the world's axes.

use glam::DQuat;
use rayon::prelude::*;

use super::FigureContext;
use super::tree::{Branch, Tree};
use crate::scene::{Mesh, Node, Piece, Primitive, Provenance, Scene, WorldTransform};
use crate::threads::GRAIN;

/// A node that shows a part, and how it lies in the hierarchy.
#[derive(Debug, Clone, Copy)]
pub struct PartNode {
    /// Index of the part.
    pub part: usize,
    /// Index of the parent node; `None` for a root.
    pub parent: Option<usize>,
    /// Whether the node is mirrored in the drawing plane.
    pub is_mirrored: bool,
    /// How far it lies in front of the drawing plane, drawing units.
    pub depth: f64,
}

/// Adds nodes and meshes to a scene without nodes. Returns the part of each node, and the first node of each part.
pub(super) fn add(
    context: &FigureContext<'_>,
    tree: Tree,
    meshes: Vec<Option<Mesh>>,
    world: &WorldTransform,
    scene: &mut Scene,
) -> (Vec<PartNode>, Vec<Option<usize>>) {
    let mut nodes: Vec<PartNode> = Vec::with_capacity(tree.branches.len());
    for branch in &tree.branches {
        let above = branch.parent.map_or(0.0, |parent| nodes[parent].depth);
        nodes.push(PartNode {
            part: branch.part,
            parent: branch.parent,
            is_mirrored: branch.mirrored,
            depth: above + branch.place.z,
        });
    }
    let node = |branch: Branch| {
        let rotation = DQuat::from_rotation_z(branch.angle);
        let (translation, rotation) = match branch.parent {
            Some(_) => (branch.place * world.scale, rotation),
            None => (world.point(branch.place), world.rotate(rotation)),
        };
        let part = &context.bindings.parts[branch.part];
        let string = part
            .string
            .map(|string| &context.bindings.strings[string].text);
        Node {
            name: branch.name,
            translation,
            rotation,
            provenance: Some(Provenance {
                element: context.drawing.shapes[part.shape].element.id.clone(),
                string: string.map(|text| text.as_str().to_owned()),
            }),
            ..Node::default()
        }
    };
    scene.nodes = tree
        .branches
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(node)
        .collect();
    let mut meshes = Meshes {
        placed: vec![[None; 2]; meshes.len()],
        made: meshes,
    };
    let mut node_of_part = vec![None; meshes.made.len()];
    for (index, node) in nodes.iter().enumerate() {
        node_of_part[node.part].get_or_insert(index);
        match node.parent {
            Some(parent) => scene.nodes[parent].children.push(index),
            None => scene.roots.push(index),
        }
        scene.nodes[index].mesh = meshes.of(node.part, node.is_mirrored, &mut scene.meshes);
    }
    (nodes, node_of_part)
}

/// The meshes of parts on their way into the scene.
struct Meshes {
    made: Vec<Option<Mesh>>,
    /// Per part the scene's mesh as described, and mirrored.
    placed: Vec<[Option<usize>; 2]>,
}

impl Meshes {
    /// The mesh that shows a part on one side, made from its twin where that is in the scene already.
    fn of(&mut self, part: usize, turned: bool, scene: &mut Vec<Mesh>) -> Option<usize> {
        let side = usize::from(turned);
        let placed = self.placed[part];
        if placed[side].is_none() {
            let mesh = match (self.made[part].take(), placed[1 - side]) {
                (Some(mesh), _) if turned => mirrored(&mesh),
                (Some(mesh), _) => mesh,
                (None, Some(twin)) => mirrored(&scene[twin]),
                (None, None) => return None,
            };
            scene.push(mesh);
            self.placed[part][side] = Some(scene.len() - 1);
        }
        self.placed[part][side]
    }
}

/// A mesh mirrored in the drawing plane.
fn mirrored(mesh: &Mesh) -> Mesh {
    let primitive = |primitive: &Primitive| Primitive {
        pieces: primitive.pieces.iter().map(Piece::mirrored).collect(),
        material: primitive.material,
    };
    Mesh {
        primitives: mesh.primitives.iter().map(primitive).collect(),
    }
}
