//! The scene of a drawing: what the systems (figures, landscapes, characters that turn, motion on figures) make, put together.
//!
//! Invariant: this is the only module that knows more than one system. Each gets plain data of the others: rest frames of parts, the
//! node of each part, materials, the world transform.

mod materials;
mod objects;
mod props;
mod textures;
mod world;

use std::sync::Arc;

use typed_index_collections::{TiVec, ti_vec};

use crate::bend::Bend;
use crate::billboard::{self, Character, RegionMaterials};
use crate::bind::{Bindings, PartId};
use crate::diagnostic::Diagnostic;
use crate::figure::{Behind, FigureNodes, Figures, FormInFigure, LinkedModels, NodeDepth};
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::rig::{self, FigureClip, FigureFacing, RestNode};
use crate::scene::{MaterialId, NodeId, PartMaterial, Scene, WorldTransform};
use crate::svg::Drawing;
use crate::terrain::{self, LandscapeId, Layer};
use materials::{LookMaterials, Materials, Sharing};

pub(crate) use props::StandingProp;
pub use world::world_transform;

/// A drawing's scene, and what is in it.
#[derive(Debug, Default)]
pub(crate) struct Assembled {
    /// The model.
    pub scene: Scene,
    /// The tile maps.
    pub layers: TiVec<LandscapeId, Layer>,
    /// The characters that turn.
    pub characters: Vec<Character>,
    /// The clips that figures play.
    pub clips: Vec<FigureClip>,
    /// Per part that has a node, how far in front of the drawing plane it lies.
    pub depths: TiVec<PartId, Option<NodeDepth>>,
    /// What parts show from behind beside their own backs.
    pub behind: Vec<(PartId, Behind)>,
    /// What figures do to the forms of parts.
    pub forms: Vec<(PartId, FormInFigure)>,
    /// Where figures look.
    pub facings: Vec<FigureFacing>,
    /// Per prop of the bindings where it stands; empty without landscapes.
    pub props: Vec<StandingProp>,
}

/// What a surface of a scene is made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Owner {
    /// A part.
    Part(PartId),
    /// The landscape of a tile layer.
    Landscape(LandscapeId),
}

/// A scene in which no two parts, and no two tile layers, have a material in common: the material of a surface says what it is
/// made from. It has no clips.
#[derive(Debug, Default)]
pub(crate) struct Apart {
    /// The model.
    pub scene: Scene,
    /// Per material of the scene what it belongs to; `None` for the materials of linked models and of regions of pictures.
    pub owners: TiVec<MaterialId, Option<Owner>>,
}

/// Builds the scene of a drawing.
pub(crate) fn assemble(
    drawing: &Drawing,
    bindings: &Bindings,
    resolver: &dyn Resolver,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Assembled {
    let characters = billboard::read(drawing, bindings, memo, diagnostics);
    let Built {
        mut scene,
        layers,
        world,
        figures,
        facings,
        bends,
        of_part,
        props,
        ..
    } = build(
        drawing,
        bindings,
        &parts_of(&characters),
        Sharing::Alike,
        resolver,
        memo,
        diagnostics,
    );
    let nodes = figures.nodes.iter().map(|node| RestNode {
        part: node.part,
        bone: node.bone,
        is_rooted: node.parent.is_none(),
        is_mirrored: node.is_mirrored,
        depth: node.depth,
    });
    let nodes = nodes.collect();
    let context = rig::Context {
        drawing,
        bindings,
        world: &world,
        frames: &figures.frames,
        parts_of_node: &figures.parts_of_node,
        bends: &bends,
        thicknesses: &figures.thicknesses,
    };
    let mut materials = RegionMaterials::new(&of_part, false);
    for character in &characters {
        billboard::add(
            character,
            drawing,
            bindings,
            &world,
            &mut materials,
            &mut scene,
        );
    }
    let clips = rig::add_clips(&context, nodes, resolver, memo, &mut scene, diagnostics);
    Assembled {
        scene,
        layers,
        characters,
        clips,
        depths: figures.depths,
        behind: figures.behind,
        forms: figures.forms,
        facings,
        props,
    }
}

/// The parts that say what the regions of characters look like.
fn parts_of(characters: &[Character]) -> Vec<PartId> {
    let regions = characters.iter().flat_map(|character| &character.regions);
    let paints = regions.flat_map(|region| &region.paints().list);
    paints.filter_map(|paint| paint.part).collect()
}

/// Builds the scene of a drawing so that its materials say what each surface is made from: a region of a character from its part in
/// the first view that shows it. `characters` are those of the drawing.
pub(crate) fn assemble_apart(
    drawing: &Drawing,
    bindings: &Bindings,
    characters: &[Character],
    resolver: &dyn Resolver,
) -> Apart {
    let mut built = build(
        drawing,
        bindings,
        &parts_of(characters),
        Sharing::Apart,
        resolver,
        &Memo::none(),
        &mut Vec::new(),
    );
    let mut materials = RegionMaterials::new(&built.of_part, true);
    let (world, scene) = (&built.world, &mut built.scene);
    for character in characters {
        billboard::add(character, drawing, bindings, world, &mut materials, scene);
    }
    let mut owners: TiVec<MaterialId, _> = ti_vec![None; built.scene.materials.len()];
    // Each material has one owner: their order does not matter.
    let flat = materials.flat.iter();
    flat.for_each(|((part, _), material)| owners[*material] = part.map(Owner::Part));
    for (part, material) in built.of_part.iter_enumerated() {
        if let Some((material, _)) = material {
            owners[*material] = Some(Owner::Part(part));
        }
    }
    // A paint of another view belongs to the part in the first one.
    for region in characters.iter().flat_map(|character| &character.regions) {
        for paint in &region.paints().list {
            if let Some((material, _)) = paint.part.and_then(|part| built.of_part[part]) {
                owners[material] = region.part.map(Owner::Part);
            }
        }
    }
    let veils = materials.veils.iter();
    let veils = veils.map(|((material, _), veil)| (*veil, owners[*material]));
    for (veil, owner) in veils.collect::<Vec<_>>() {
        owners[veil] = owner;
    }
    for (layer, materials) in built.of_looks.0.iter_enumerated() {
        for material in materials.iter().flatten() {
            owners[*material] = Some(Owner::Landscape(layer));
        }
    }
    Apart {
        scene: built.scene,
        owners,
    }
}

/// A scene without clips, and what clips need to know.
struct Built {
    scene: Scene,
    layers: TiVec<LandscapeId, Layer>,
    world: WorldTransform,
    figures: FigureNodes,
    facings: Vec<FigureFacing>,
    /// Per main part how it bends.
    bends: TiVec<PartId, Option<Arc<Bend>>>,
    /// Per part its material.
    of_part: TiVec<PartId, PartMaterial>,
    of_looks: LookMaterials,
    /// Per prop where it stands.
    props: Vec<StandingProp>,
}

/// Builds the figures and landscapes of a drawing, and the materials of some parts that are regions of characters.
fn build(
    drawing: &Drawing,
    bindings: &Bindings,
    regions: &[PartId],
    sharing: Sharing,
    resolver: &dyn Resolver,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Built {
    let layers = terrain::read(drawing, bindings, resolver, memo, diagnostics);
    let world = world::world_transform(bindings, &layers);
    let mut models = LinkedModels::read(bindings, resolver, memo, diagnostics);
    let mut found = Vec::new();
    let ((figures, facings, bends), materials) = rayon::join(
        || {
            let facings = rig::facings(drawing, bindings);
            let seen = rig::seen(bindings, &facings);
            let bends = rig::bends(drawing, bindings, &facings);
            found.extend(rig::idle_bends(drawing, bindings, &bends));
            let bent = bends.clone();
            let figures = Figures::lay_out(drawing, bindings, seen, bent, &world, memo, &mut found);
            (figures, facings, bends)
        },
        || {
            Materials::collect(
                drawing,
                bindings,
                &models,
                &layers,
                regions,
                sharing,
                resolver,
                memo,
                diagnostics,
            )
        },
    );
    diagnostics.extend(found);
    let (mut scene, of_part, of_looks) = materials.into_scene();
    models.add_materials(&mut scene);
    let mut figures = figures.build(&models, &of_part, &world, &mut scene);
    let mut landscapes: TiVec<LandscapeId, NodeId> = TiVec::with_capacity(layers.len());
    for (index, layer) in layers.iter_enumerated() {
        let parent = layer
            .parent
            .and_then(|part| Some((figures.node_of_part[part]?, &figures.frames[part])));
        let material_of = |look| of_looks.of(index, look);
        landscapes.push(scene.add(terrain::node(
            layer,
            drawing,
            bindings,
            &world,
            parent,
            material_of,
        )));
    }
    objects::report(bindings, &layers, diagnostics);
    objects::add(
        bindings,
        &layers,
        &landscapes,
        &of_looks,
        world.scale,
        &mut scene,
    );
    let mut props = props::places(bindings, &layers);
    props::report(drawing, bindings, &layers, &props, diagnostics);
    props::add(
        drawing,
        bindings,
        &layers,
        &landscapes,
        &mut props,
        &mut figures,
        world.scale,
        sharing == Sharing::Apart,
        &mut scene,
    );
    Built {
        scene,
        layers,
        world,
        figures,
        facings,
        bends,
        of_part,
        of_looks,
        props,
    }
}
