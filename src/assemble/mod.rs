//! The scene of a drawing: what the systems (figures, landscapes, motion on figures) make, put together.
//!
//! Invariant: this is the only module that knows more than one system. Each gets plain data of the others: rest frames of parts, the
//! node of each part, materials, the world transform.

mod materials;
mod textures;
mod world;

use crate::bind::Bindings;
use crate::diagnostic::Diagnostic;
use crate::figure::{Figures, LinkedModels};
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::rig::{self, FigureClip, RestNode};
use crate::scene::Scene;
use crate::svg::Drawing;
use crate::terrain::{self, Layer};
use materials::Materials;

/// A drawing's scene, and what is in it.
#[derive(Debug, Default)]
pub struct Assembled {
    /// The model.
    pub scene: Scene,
    /// The tile maps.
    pub layers: Vec<Layer>,
    /// The clips that figures play.
    pub clips: Vec<FigureClip>,
}

/// Builds the scene of a drawing.
pub fn assemble(
    drawing: &Drawing,
    bindings: &Bindings,
    resolver: &dyn Resolver,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Assembled {
    let layers = terrain::read(drawing, bindings, diagnostics);
    let world = world::world_transform(bindings, &layers);
    let mut models = LinkedModels::read(bindings, resolver, memo, diagnostics);
    let mut found = Vec::new();
    let (figures, materials) = rayon::join(
        || Figures::lay_out(drawing, bindings, memo, &mut found),
        || {
            Materials::collect(
                drawing,
                bindings,
                &models,
                &layers,
                resolver,
                memo,
                diagnostics,
            )
        },
    );
    diagnostics.extend(found);
    let (mut scene, of_part, of_looks) = materials.into_scene();
    models.add_materials(&mut scene);
    let figures = figures.build(&models, &of_part, &world, &mut scene);
    for (index, layer) in layers.iter().enumerate() {
        let parent = layer
            .parent
            .and_then(|part| Some((figures.node_of_part[part]?, &figures.frames[part])));
        let material_of = |look| of_looks.of(index, look);
        scene.add(terrain::node(
            layer,
            drawing,
            bindings,
            &world,
            parent,
            material_of,
        ));
    }
    let nodes = figures.nodes.iter().map(|node| RestNode {
        part: node.part,
        is_rooted: node.parent.is_none(),
        is_mirrored: node.is_mirrored,
        depth: node.depth,
    });
    let context = rig::Context {
        drawing,
        bindings,
        world: &world,
        frames: &figures.frames,
        parts_of_node: &figures.parts_of_node,
    };
    let clips = rig::add_clips(&context, nodes, resolver, memo, &mut scene, diagnostics);
    Assembled {
        scene,
        layers,
        clips,
    }
}
