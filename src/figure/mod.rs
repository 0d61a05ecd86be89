//! The articulated figure: from the bindings to nodes, joints and solids (figure.md).
//!
//! Invariant: a node's mesh is described in the part's own frame, +Y along its axis away from the joint,
//! +Z towards the viewer; turning the node turns the limb about its joint.

mod assemble;
mod copies;
mod frame;
mod land;
mod materials;
mod models;
mod motion;
mod relief;
mod textures;
mod tree;

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::bind::{Bindings, Part, PartKind};
use crate::diagnostic::Diagnostic;
use crate::geometry::{area, contains, intersect};
use crate::lang::keyword::Keyword;
use crate::lang::value::{ShapeKind, Value};
use crate::resolver::Resolver;
use crate::scene::{Mesh, Piece, Primitive, Scene};
use crate::solid::{self, Placement, Sides, Solid};
use crate::svg::Drawing;
use crate::terrain::Layer;
use crate::threads::GRAIN;

use assemble::Stage;
use frame::Frame;
use materials::{Materials, Painted};
use models::Models;
use relief::Relief;
use tree::Tree;

pub use motion::{Driven, Shot, originals};

/// Metres in a centimetre: one drawing unit is `Scale` centimetres.
const CENTIMETRE: f64 = 0.01;
/// How far the faces of `default` lie from the drawing plane, as a share of the page's diagonal.
const DEFAULT_DEPTH: f64 = 0.025;

/// What building remembers for the next time: things that take long to make, from what seldom changes. The next
/// time checks that it has not.
#[derive(Debug, Default)]
pub struct Memory {
    models: models::Memory,
    textures: textures::Memory,
    relief: relief::Memory,
    motion: motion::Memory,
}

/// Builds the figures and landscapes of a drawing, and tells of their clips. What it makes does not depend on what it remembers.
pub fn build(
    drawing: &Drawing,
    bindings: &Bindings,
    layers: &[Layer],
    resolver: &dyn Resolver,
    memory: &mut Memory,
    diagnostics: &mut Vec<Diagnostic>,
) -> (Scene, Vec<Shot>) {
    let model = Model::new(drawing, bindings);
    let known = &mut memory.relief;
    let (relief, (mut models, materials, frames, members, tree, found)) = rayon::join(
        || Relief::measure(&model, known),
        || {
            let mut found = Vec::new();
            let models = Models::collect(&model, resolver, &mut memory.models, &mut found);
            let looks = &mut memory.textures;
            let materials =
                Materials::collect(&model, &models, layers, resolver, looks, &mut found);
            let frames: Vec<Frame> = bindings
                .parts
                .par_iter()
                .with_min_len(GRAIN)
                .map(Frame::of)
                .collect();
            let tree = Tree::grow(&model, &frames, &mut found);
            (models, materials, frames, members(bindings), tree, found)
        },
    );
    diagnostics.extend(found);
    copies::check(&model, diagnostics);
    let (mut scene, painted, grounds) = materials.into_scene();
    models.add_looks(&mut scene);
    let stock = Stock {
        frames,
        relief,
        painted,
        models,
    };
    let meshes: Vec<Option<Mesh>> = members
        .par_iter()
        .enumerate()
        .with_min_len(GRAIN)
        .map(|(main, parts)| model.mesh(main, parts, &stock))
        .collect();
    let stage = Stage::of(&model, layers);
    let wishes = motion::wishes(&model);
    // The hierarchy is used up where it becomes the scene's.
    let puppets = match wishes.is_empty() {
        true => None,
        false => Some(motion::Nodes::new(&model, &stock.frames, &tree.branches)),
    };
    let (mut scene, nodes) = assemble::assemble(&model, tree, meshes, &stage, scene);
    land::add(
        &model,
        layers,
        &grounds,
        &stage,
        &stock.frames,
        &nodes,
        &mut scene,
    );
    let shots = match &puppets {
        Some(nodes) => {
            let ground = motion::Ground {
                stage: &stage,
                nodes,
                members: &members,
                scale: model.scale,
            };
            let known = &mut memory.motion;
            motion::perform(
                &model,
                &wishes,
                &ground,
                resolver,
                known,
                &mut scene,
                diagnostics,
            )
        }
        None => {
            memory.motion = motion::Memory::default();
            motion::without(&model, diagnostics);
            Vec::new()
        }
    };
    (scene, shots)
}

/// Per main part the parts whose solids are in its node.
fn members(bindings: &Bindings) -> Vec<Vec<usize>> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); bindings.parts.len()];
    for (index, part) in bindings.parts.iter().enumerate() {
        if matches!(part.kind, PartKind::Main | PartKind::Sub) {
            members[part.main].push(index);
        }
    }
    members
}

/// What meshes are made with.
struct Stock {
    frames: Vec<Frame>,
    relief: Relief,
    painted: Painted,
    models: Models,
}

/// What building needs to know of the whole drawing.
struct Model<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    /// Metres a drawing unit.
    scale: f64,
    /// The depths of `default` without parameters, drawing units.
    depth: [f64; 2],
}

impl<'a> Model<'a> {
    fn new(drawing: &'a Drawing, bindings: &'a Bindings) -> Self {
        let scale = match bindings.drawing_value(Keyword::Scale) {
            Some(Value::Number(scale)) => *scale,
            _ => 1.0,
        };
        let depth = drawing.page.1.length() * DEFAULT_DEPTH;
        Self {
            drawing,
            bindings,
            scale: scale * CENTIMETRE,
            depth: [-depth, depth],
        }
    }

    /// How far a part's solid, or its node, is moved along the viewer axis, drawing units.
    fn offset(&self, part: usize) -> f64 {
        let source = self.bindings.setting(part, Keyword::Offset);
        let main = self.bindings.parts[part].main == part;
        match source.map(|source| (&source.setting.value, source.from)) {
            // What `%` says has moved the sub-part's node already.
            Some((_, crate::bind::SetBy::Default)) if !main => 0.0,
            Some((Value::Number(offset), _)) => *offset,
            _ => 0.0,
        }
    }

    /// The kind of a part with its depths filled in.
    fn kind(&self, part: usize) -> ShapeKind {
        match self.bindings.shape(part).kind {
            ShapeKind::Default(None) => ShapeKind::Default(Some(self.depth)),
            kind => kind,
        }
    }

    fn options(&self, part: usize) -> solid::Options {
        solid::Options {
            segments: self
                .bindings
                .number(part, Keyword::Segments)
                .unwrap_or(16.0) as u32,
            crease: self.bindings.number(part, Keyword::Smooth).unwrap_or(30.0),
            thickness: self.depth,
            placement: Placement {
                rotation: 0.0,
                translation: DVec3::ZERO,
                scale: self.scale,
            },
        }
    }

    /// The solids of a main part and its sub-parts, in the main part's frame.
    fn mesh(&self, main: usize, parts: &[usize], stock: &Stock) -> Option<Mesh> {
        let mut primitives: Vec<Primitive> = Vec::new();
        let mut add = |material: usize, piece: Piece| {
            let mut same = primitives.iter_mut().filter(|p| p.material == material);
            match same.next() {
                Some(primitive) => primitive.pieces.push(piece),
                None => primitives.push(Primitive {
                    pieces: vec![piece],
                    material,
                }),
            }
        };
        for &part in parts {
            if stock.models.has(part) {
                let frames = [&stock.frames[part], &stock.frames[main]];
                let (depth, both) = self.stand(main, part);
                for (material, surface) in stock.models.surfaces(self, part, frames, depth, both) {
                    add(material, surface.into());
                }
            } else if let Some((material, texture)) = stock.painted.of(part)
                && let Some(mut solid) = self.solid(main, part, &stock.frames, &stock.relief)
            {
                solid.texture = texture;
                add(material, Piece::Deferred(Arc::new(solid)));
            }
        }
        (!primitives.is_empty()).then_some(Mesh { primitives })
    }

    /// How far a part's solid stands from the plane of its node, drawing units, and whether it stands on both sides.
    fn stand(&self, main: usize, part: usize) -> (f64, bool) {
        let shape = self.bindings.shape(part);
        // The node of a main part is moved already, but with `-s` its two solids are.
        let moved = part != main || shape.mirrored;
        let depth = if moved { self.offset(part) } else { 0.0 };
        // A sub-part has no node of its own that could be doubled.
        (depth, shape.mirrored || (shape.doubled && part != main))
    }

    fn solid(&self, main: usize, part: usize, frames: &[Frame], relief: &Relief) -> Option<Solid> {
        let kind = relief.raised(part, self.kind(part));
        if kind == ShapeKind::None {
            return None;
        }
        let (depth, both) = self.stand(main, part);
        let (own, node) = (&frames[part], &frames[main]);
        let mut options = self.options(part);
        options.placement.rotation = own.angle - node.angle;
        options.placement.translation = node.to_local(own.center).extend(depth);
        Some(Solid {
            outline: Arc::clone(&self.bindings.parts[part].outline),
            to_frame: own.placing(),
            kind,
            options,
            sides: if both { Sides::Both } else { Sides::Front },
            texture: None,
        })
    }
}

/// Whether two parts have area in common.
fn overlap(a: &Part, b: &Part) -> bool {
    // Mostly the middle of one lies in both, which is quick to see.
    let both = |point| contains(&a.outline, point) && contains(&b.outline, point);
    if both(a.measure.center) || both(b.measure.center) {
        return true;
    }
    let common = area(&intersect(&a.outline, &b.outline));
    common > 1e-6 * area(&a.outline).min(area(&b.outline))
}
