//! Landscapes: a node for each tile layer (terrain.md).

use glam::DQuat;

use super::Model;
use super::assemble::Stage;
use super::frame::{Frame, up};
use super::materials::Grounds;
use crate::scene::{Mesh, Node, Piece, Primitive, Provenance, Scene, ViewDependent};
use crate::terrain::Layer;

/// Adds a node for each landscape to a scene that has those of the figures. `node_of_part` tells of each part the
/// node that shows it, if one does.
pub(super) fn add(
    model: &Model<'_>,
    layers: &[Layer],
    grounds: &Grounds,
    stage: &Stage,
    frames: &[Frame],
    node_of_part: &[Option<usize>],
    scene: &mut Scene,
) {
    for (index, layer) in layers.iter().enumerate() {
        let [low, high] = layer.bounds();
        let middle = up((low + high) / 2.0);
        let parent = layer
            .parent
            .and_then(|part| Some((part, node_of_part[part]?)));
        let (place, rotation) = match parent {
            // It stays level, however the part is turned that it hangs on.
            Some((part, _)) => (
                frames[part].to_local(middle).extend(0.0),
                DQuat::from_rotation_z(-frames[part].angle),
            ),
            None => stage.lay((low + high) / 2.0),
        };
        let node = scene.nodes.len();
        scene.nodes.push(Node {
            name: layer.name.clone(),
            children: vec![],
            translation: place * model.scale,
            rotation,
            mesh: Some(scene.meshes.len()),
            provenance: Some(Provenance {
                element: model.drawing.groups[layer.group].element.id.clone(),
                string: Some(
                    model.bindings.strings[layer.string]
                        .text
                        .as_str()
                        .to_owned(),
                ),
            }),
            view_dependent: Some(ViewDependent::Bend),
        });
        match parent {
            Some((_, parent)) => scene.nodes[parent].children.push(node),
            None => scene.roots.push(node),
        }
        match mesh(layer, layer.size * model.scale, |look| {
            grounds.of(index, look)
        }) {
            Some(mesh) => scene.meshes.push(mesh),
            None => scene.nodes[node].mesh = None,
        }
    }
}

/// The mesh of a landscape; `tile` is the side of a tile in metres.
fn mesh(layer: &Layer, tile: f64, material_of: impl Fn(u8) -> Option<usize>) -> Option<Mesh> {
    let mut primitives: Vec<Primitive> = Vec::new();
    for (look, mut surfaces) in layer.land.surface(layer.roof, layer.bevel) {
        let Some(material) = material_of(look) else {
            continue;
        };
        for position in surfaces
            .iter_mut()
            .flat_map(|surface| &mut surface.positions)
        {
            *position = position.map(|at| (f64::from(at) * tile) as f32);
        }
        let pieces = surfaces.into_iter().map(Piece::from);
        let mut same = primitives.iter_mut();
        match same.find(|primitive| primitive.material == material) {
            Some(primitive) => primitive.pieces.extend(pieces),
            None => primitives.push(Primitive {
                pieces: pieces.collect(),
                material,
            }),
        }
    }
    (!primitives.is_empty()).then_some(Mesh { primitives })
}
