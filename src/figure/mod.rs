//! The articulated figure: from the sheet to nodes, joints and solids (figure.md).
//!
//! Invariant: a node's mesh is described in the part's own frame, +Y along its axis away from the joint,
//! +Z towards the viewer; turning the node turns the limb about its joint.

mod assemble;
mod frame;
mod materials;
mod relief;
mod tree;

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::bind::{Part, PartKind, Sheet};
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::{area, contains, intersect};
use crate::lang::keyword::Keyword;
use crate::lang::value::{ShapeKind, Value};
use crate::scene::{Mesh, Piece, Primitive, Scene};
use crate::solid::{self, Placement, Sides, Solid};
use crate::svg::Drawing;

use frame::Frame;
use materials::Materials;
use relief::Relief;
use tree::Tree;

/// Metres in a centimetre: one drawing unit is `Scale` centimetres.
const CENTIMETRE: f64 = 0.01;
/// How far the faces of `default` lie from the drawing plane, as a share of the page's diagonal.
const DEFAULT_DEPTH: f64 = 0.025;

/// Builds the figures of a drawing.
pub fn build(drawing: &Drawing, sheet: &Sheet, diagnostics: &mut Vec<Diagnostic>) -> Scene {
    let model = Model::new(drawing, sheet);
    let (relief, (materials, frames, members, tree, found)) = rayon::join(
        || Relief::measure(&model),
        || {
            let mut found = Vec::new();
            let materials = Materials::collect(drawing, sheet, &mut found);
            let frames: Vec<Frame> = sheet.parts.par_iter().map(Frame::of).collect();
            let tree = Tree::grow(&model, &frames, &mut found);
            (materials, frames, members(sheet), tree, found)
        },
    );
    diagnostics.extend(found);
    let copies = (0..sheet.parts.len()).into_par_iter();
    diagnostics.par_extend(copies.filter_map(|part| model.check_copies(part)));
    let meshes: Vec<Option<Mesh>> = members
        .par_iter()
        .enumerate()
        .map(|(main, parts)| model.mesh(main, parts, &frames, &relief, &materials))
        .collect();
    assemble::assemble(&model, tree, meshes, materials)
}

/// Per main part the parts whose solids are in its node.
fn members(sheet: &Sheet) -> Vec<Vec<usize>> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); sheet.parts.len()];
    for (index, part) in sheet.parts.iter().enumerate() {
        if matches!(part.kind, PartKind::Main | PartKind::Sub) {
            members[part.main].push(index);
        }
    }
    members
}

/// What building needs to know of the whole drawing.
struct Model<'a> {
    drawing: &'a Drawing,
    sheet: &'a Sheet,
    /// Metres a drawing unit.
    scale: f64,
    /// The depths of `default` without parameters, drawing units.
    depth: [f64; 2],
}

impl<'a> Model<'a> {
    fn new(drawing: &'a Drawing, sheet: &'a Sheet) -> Self {
        let scale = match sheet.drawing_value(Keyword::Scale) {
            Some(Value::Number(scale)) => *scale,
            _ => 1.0,
        };
        let depth = drawing.page.1.length() * DEFAULT_DEPTH;
        Self {
            drawing,
            sheet,
            scale: scale * CENTIMETRE,
            depth: [-depth, depth],
        }
    }

    /// How far a part's solid, or its node, is moved along the viewer axis, drawing units.
    fn offset(&self, part: usize) -> f64 {
        let source = self.sheet.setting(part, Keyword::Offset);
        let main = self.sheet.parts[part].main == part;
        match source.map(|source| (&source.setting.value, source.from)) {
            // What `%` says has moved the sub-part's node already.
            Some((_, crate::bind::SetBy::Default)) if !main => 0.0,
            Some((Value::Number(offset), _)) => *offset,
            _ => 0.0,
        }
    }

    /// The kind of a part with its depths filled in.
    fn kind(&self, part: usize) -> ShapeKind {
        match self.sheet.shape(part).kind {
            ShapeKind::Default(None) => ShapeKind::Default(Some(self.depth)),
            kind => kind,
        }
    }

    /// Warns of copies that lie where their original lies.
    fn check_copies(&self, part: usize) -> Option<Diagnostic> {
        let shape = self.sheet.shape(part);
        let built = matches!(self.sheet.parts[part].kind, PartKind::Main | PartKind::Sub);
        if !built || !(shape.mirrored || shape.doubled) || shape.kind == ShapeKind::None {
            return None;
        }
        let measure = &self.sheet.parts[part].measure;
        let kind = self.kind(part);
        let [low, high] = solid::depths(
            &kind,
            measure.half_across,
            measure.half_along,
            &self.options(part),
        )?;
        let offset = self.offset(part);
        if (low + high + 2.0 * offset).abs() > 1e-9 * (high - low).abs().max(1e-12) {
            return None;
        }
        let source = self.sheet.setting(part, Keyword::Shape);
        let span = source.map_or(
            self.drawing.shapes[self.sheet.parts[part].shape]
                .element
                .span,
            |source| {
                self.sheet.strings[source.string]
                    .text
                    .span(source.setting.range.clone())
            },
        );
        let flag = if shape.doubled { "-d" } else { "-s" };
        let name = self.sheet.describe(self.drawing, part);
        Some(
            Diagnostic::new(
                Code::CopiesCoincide,
                span,
                format!("the copy that `{flag}` makes of {name} lies exactly where {name} lies"),
            )
            .help("give both sides a distance with `Offset`, or depths on one side only, as in `default 45 50`"),
        )
    }

    fn options(&self, part: usize) -> solid::Options {
        solid::Options {
            segments: self.sheet.number(part, Keyword::Segments).unwrap_or(16.0) as u32,
            crease: self.sheet.number(part, Keyword::Smooth).unwrap_or(30.0),
            thickness: self.depth,
            placement: Placement {
                rotation: 0.0,
                translation: DVec3::ZERO,
                scale: self.scale,
            },
        }
    }

    /// The solids of a main part and its sub-parts, in the main part's frame.
    fn mesh(
        &self,
        main: usize,
        parts: &[usize],
        frames: &[Frame],
        relief: &Relief,
        materials: &Materials,
    ) -> Option<Mesh> {
        let mut primitives: Vec<Primitive> = Vec::new();
        for &part in parts {
            let Some(material) = materials.of(part) else {
                continue;
            };
            let Some(solid) = self.solid(main, part, frames, relief) else {
                continue;
            };
            let piece = Piece::Solid(solid);
            match primitives
                .iter_mut()
                .find(|primitive| primitive.material == material)
            {
                Some(primitive) => primitive.pieces.push(piece),
                None => primitives.push(Primitive {
                    pieces: vec![piece],
                    material,
                }),
            }
        }
        (!primitives.is_empty()).then_some(Mesh { primitives })
    }

    fn solid(&self, main: usize, part: usize, frames: &[Frame], relief: &Relief) -> Option<Solid> {
        let kind = relief.raised(part, self.kind(part));
        if kind == ShapeKind::None {
            return None;
        }
        let shape = self.sheet.shape(part);
        // The node of a main part is moved already, but with `-s` its two solids are.
        let moved = part != main || shape.mirrored;
        let depth = if moved { self.offset(part) } else { 0.0 };
        let (own, node) = (&frames[part], &frames[main]);
        let mut options = self.options(part);
        options.placement.rotation = own.angle - node.angle;
        options.placement.translation = node.to_local(own.center).extend(depth);
        // A sub-part has no node of its own that could be doubled.
        let both = shape.mirrored || (shape.doubled && part != main);
        Some(Solid {
            outline: Arc::clone(&self.sheet.parts[part].outline),
            to_frame: own.placing(),
            kind,
            options,
            sides: if both { Sides::Both } else { Sides::Front },
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
