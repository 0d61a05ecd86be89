//! Nodes and meshes put together, in the world's axes.

use glam::{DMat3, DQuat, DVec2, DVec3};
use rayon::prelude::*;

use super::Model;
use super::tree::{Branch, Tree};
use crate::bind::{Bindings, Part, PartKind};
use crate::lang::keyword::Keyword;
use crate::lang::value::{Ground, Value};
use crate::scene::{Mesh, Node, Piece, Primitive, Provenance, Scene};
use crate::terrain::Layer;
use crate::threads::GRAIN;

/// The rotation from the drawing's right, its up and the viewer's direction to the world (`Axes`), which is
/// right-handed: other axes are refused where they are read.
fn axes(bindings: &Bindings) -> DQuat {
    let Some(Value::Axes(axes)) = bindings.drawing_value(Keyword::Axes) else {
        return DQuat::IDENTITY;
    };
    let [right, up, front] = axes.map(|axis| {
        let mut vector = [0.0; 3];
        vector[axis.axis] = if axis.negative { -1.0 } else { 1.0 };
        DVec3::from(vector)
    });
    DQuat::from_mat3(&DMat3::from_cols(right, up, front))
}

/// How the drawing lies in the world.
pub(super) struct Stage {
    /// The point of the drawing that lies at the world's origin.
    ground: DVec2,
    /// From the drawing's axes to the world's.
    turn: DQuat,
}

impl Stage {
    pub(super) fn of(model: &Model<'_>, layers: &[Layer]) -> Self {
        Self {
            ground: ground(model, layers),
            turn: axes(model.bindings),
        }
    }

    /// Where a landscape lies whose middle is at a point of the drawing, y down: on the world's ground, so that all landscapes of
    /// a drawing share it; what is lower on the page is nearer.
    pub(super) fn lay(&self, middle: DVec2) -> (DVec3, DQuat) {
        let place = middle - self.ground;
        (self.turn * DVec3::new(place.x, 0.0, place.y), self.turn)
    }

    /// A turn in the drawing's axes, in the world's.
    pub(super) fn turned(&self, turn: DQuat) -> DQuat {
        self.turn * turn
    }

    /// Where something stands that hangs on nothing and is turned by an angle about the viewer's axis; `place` in
    /// drawing units, y up.
    pub(super) fn set(&self, place: DVec3, angle: f64) -> (DVec3, DQuat) {
        let place = place - DVec3::new(self.ground.x, -self.ground.y, 0.0);
        let rotation = self.turn * DQuat::from_rotation_z(angle);
        (self.turn * place, rotation)
    }
}

/// Puts nodes and meshes together; with each part the node that shows it, the first one if there are copies.
pub(super) fn assemble(
    model: &Model<'_>,
    tree: Tree,
    meshes: Vec<Option<Mesh>>,
    stage: &Stage,
    mut scene: Scene,
) -> (Scene, Vec<Option<usize>>) {
    let links: Vec<(usize, Option<usize>, bool)> = tree
        .branches
        .iter()
        .map(|branch| (branch.part, branch.parent, branch.mirrored))
        .collect();
    let node = |branch: Branch| {
        let (translation, rotation) = match branch.parent {
            Some(_) => (branch.place, DQuat::from_rotation_z(branch.angle)),
            None => stage.set(branch.place, branch.angle),
        };
        let part = &model.bindings.parts[branch.part];
        let string = part
            .string
            .map(|string| &model.bindings.strings[string].text);
        Node {
            name: branch.name,
            children: vec![],
            translation: translation * model.scale,
            rotation,
            mesh: None,
            view_dependent: None,
            provenance: Some(Provenance {
                element: model.drawing.shapes[part.shape].element.id.clone(),
                string: string.map(|text| text.as_str().to_owned()),
            }),
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
    for (index, (part, parent, mirrored)) in links.into_iter().enumerate() {
        node_of_part[part].get_or_insert(index);
        match parent {
            Some(parent) => scene.nodes[parent].children.push(index),
            None => scene.roots.push(index),
        }
        scene.nodes[index].mesh = meshes.of(part, mirrored, &mut scene.meshes);
    }
    (scene, node_of_part)
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

/// The point of the drawing that lies at the world's origin.
fn ground(model: &Model<'_>, layers: &[Layer]) -> DVec2 {
    match model.bindings.drawing_value(Keyword::Ground) {
        Some(Value::Ground(Ground::Page)) => model.drawing.page.0,
        Some(Value::Ground(Ground::Point([x, y]))) => DVec2::new(*x, *y),
        _ => {
            let is_built = |part: &&Part| matches!(part.kind, PartKind::Main | PartKind::Sub);
            let built = model
                .bindings
                .parts
                .par_iter()
                .with_min_len(GRAIN)
                .filter(is_built);
            let boxes = built.map(|part| part.measure.bounds);
            let both = |one: (DVec2, DVec2), other: (DVec2, DVec2)| {
                (one.0.min(other.0), one.1.max(other.1))
            };
            let landscapes = layers.iter().map(Layer::bounds);
            let landscapes = landscapes.map(|[low, high]| (low, high)).reduce(both);
            let all = boxes.reduce_with(both);
            let all = all.into_iter().chain(landscapes).reduce(both);
            all.map_or(DVec2::ZERO, |(low, high)| {
                DVec2::new((low.x + high.x) / 2.0, high.y)
            })
        }
    }
}
