//! Characters as they are drawn: each of their views at its place on the page.

use glam::{DQuat, DVec3};

use crate::billboard::{Character, ViewId};
use crate::compile::Compiled;
use crate::scene::{
    Mesh, NewNode, Node, NodeId, Primitive, Scene, Surface, SurfacePatch, ViewDependent,
    WorldTransform,
};

/// Replaces each character that turns by its views, side by side as on the page.
pub(super) fn show_views(compiled: &Compiled, world: &WorldTransform, scene: &mut Scene) {
    let turns = |node: &NodeId| {
        matches!(
            scene.nodes[*node].view_dependent,
            Some(ViewDependent::Turn(_))
        )
    };
    let turning: Vec<NodeId> = scene.nodes.keys().filter(turns).collect();
    for (root, character) in turning.into_iter().zip(&compiled.characters) {
        let regions = std::mem::take(&mut scene.nodes[root].children);
        for view in character.layers.keys() {
            add_view(character, view, &regions, world, scene);
        }
        for region in regions {
            scene.nodes[region].mesh = None;
        }
    }
}

/// Adds a view of a character whose regions have these nodes.
fn add_view(
    character: &Character,
    view: ViewId,
    regions: &[NodeId],
    world: &WorldTransform,
    scene: &mut Scene,
) {
    let weights = character.turn.weights(character.turn.views[view]);
    let frame = &character.frames[view];
    let center = DVec3::new(frame.center.x, -frame.center.y, 0.0);
    let root = scene.add(NewNode {
        node: Node {
            name: format!("{} {}", character.name, usize::from(view) + 1),
            translation: world.point(center),
            rotation: world.rotation,
            ..Node::default()
        },
        ..NewNode::default()
    });
    // Meshes are as large as in the first view.
    let larger = frame.height / character.frames[ViewId::FIRST].height;
    for (region, node) in character.regions.iter().zip(regions) {
        let Some(mesh) = scene.nodes[*node].mesh else {
            continue;
        };
        let mesh = still(&scene.meshes[mesh], view, larger);
        let place = character.turn.position(&weights, &region.positions);
        scene.add(NewNode {
            node: Node {
                name: region.name.clone(),
                translation: place * frame.height * world.scale,
                rotation: DQuat::IDENTITY,
                ..Node::default()
            },
            mesh: Some(mesh),
            parent: Some(root),
        });
    }
}

/// A mesh as it is in a view, without morph targets.
fn still(mesh: &Mesh, view: ViewId, larger: f64) -> Mesh {
    let patch = |patch: &SurfacePatch| {
        let surface = patch.surface();
        let target = usize::from(view)
            .checked_sub(1)
            .and_then(|target| surface.targets.get(target));
        let place = |(corner, at): (usize, &[f32; 3])| {
            let offset = target.map_or([0.0; 3], |target| target[corner]);
            [0, 1, 2].map(|axis| ((f64::from(at[axis]) + f64::from(offset[axis])) * larger) as f32)
        };
        SurfacePatch::from(Surface {
            positions: surface.positions.iter().enumerate().map(place).collect(),
            targets: Vec::new(),
            ..surface.into_owned()
        })
    };
    let primitives = mesh.primitives.iter().map(|primitive| Primitive {
        patches: primitive.patches.iter().map(patch).collect(),
        material: primitive.material,
    });
    Mesh {
        primitives: primitives.collect(),
    }
}
