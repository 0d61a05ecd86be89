//! The pieces of paper that a puppet is made of, in drawing units.

use std::collections::BTreeMap;

use glam::DVec2;
use rstar::RTree;
use rstar::primitives::Line;
use typed_index_collections::{TiVec, ti_vec};

use super::paper::simplified;
use super::{MAX_PIECES, PuppetError};
use crate::anatomy::{self, Role};
use crate::bind::{Bindings, PartId, PartKind};
use crate::geometry::{
    Bands, Outline, area, bounds, centroid, distance_squared, edges, intersect, offset, union,
};
use crate::lang::value::Origin;
use crate::rig::{FigureGroup, FigurePartId, find_figures};
use crate::svg::{Drawing, ShapeId};

/// A part stays on its parent's piece if at least this share of it is drawn there ...
const LIES_ON: f64 = 0.9;
/// ... and if its area is no larger than this share of the parent's.
const DETAIL: f64 = 0.25;
/// How far apart things are that touch, as a share of a piece's size.
const NEAR: f64 = 0.02;
/// How exact the outlines are that grow until they touch, as a share of how far they grow.
const COARSE: f64 = 0.05;

/// A piece of paper: a part with its details. Points are in drawing units from the page's top left corner.
#[derive(Debug, Clone, PartialEq)]
pub struct PaperPiece {
    /// The main part.
    pub part: PartId,
    /// The other main parts that are drawn on it.
    pub details: Vec<PartId>,
    /// Its shapes by [`Shape::leaf`](crate::svg::Shape::leaf), in paint order.
    pub leaves: Vec<usize>,
    /// The first shape of the main part, likewise.
    pub first: usize,
    /// What is drawn on it, strokes included.
    pub outline: Outline,
    /// Where it is pinned to another piece; `None` for the piece that carries all others.
    pub joint: Option<Joint>,
}

/// Where a piece is pinned to the piece that carries it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// The index of the piece that carries it.
    pub parent: usize,
    /// The pin.
    pub at: DVec2,
}

impl PaperPiece {
    /// Whether it is drawn before another one, and so lies behind it.
    pub fn is_behind(&self, other: &Self) -> bool {
        self.first < other.first
    }
}

/// The pieces of all figures of a drawing, in paint order.
///
/// # Errors
/// [`PuppetError::TooMany`] as soon as there are more than a sheet may have, since each is compared with what carries it.
pub fn pieces(drawing: &Drawing, bindings: &Bindings) -> Result<Vec<PaperPiece>, PuppetError> {
    let mut cut = Cutter {
        drawing,
        bindings,
        members: members(bindings),
        pieces: Vec::new(),
    };
    for figure in find_figures(bindings) {
        cut.figure(&figure)?;
    }
    Ok(in_paint_order(cut.pieces))
}

/// Per main part all parts in its node.
fn members(bindings: &Bindings) -> BTreeMap<PartId, Vec<PartId>> {
    let mut members: BTreeMap<PartId, Vec<PartId>> = BTreeMap::new();
    for (index, part) in bindings.parts.iter_enumerated() {
        if matches!(part.kind, PartKind::Main | PartKind::Sub) {
            members.entry(part.main).or_default().push(index);
        }
    }
    members
}

/// Cuts figures into pieces.
struct Cutter<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    members: BTreeMap<PartId, Vec<PartId>>,
    pieces: Vec<PaperPiece>,
}

impl Cutter<'_> {
    /// Adds the pieces of a figure.
    fn figure(&mut self, figure: &FigureGroup) -> Result<(), PuppetError> {
        // The piece that each part of the figure is on.
        let mut piece_of: TiVec<FigurePartId, Option<usize>> = ti_vec![None; figure.parts.len()];
        for index in carriers_first(figure) {
            let part = figure.parts[index];
            let parent = figure.parents[index];
            let carrier = parent.and_then(|parent| piece_of[parent]);
            let Some(mut piece) = self.piece(part) else {
                // `Shape none` is a joint without paper: what it carries is pinned to what carries it.
                piece_of[index] = carrier;
                continue;
            };
            if let Some(parent) = carrier {
                if self.is_detail(&piece, parent) {
                    self.merge(piece, parent);
                    piece_of[index] = carrier;
                    continue;
                }
                let at = self.pin(&piece, parent);
                piece.joint = Some(Joint { parent, at });
            }
            if self.pieces.len() == MAX_PIECES {
                return Err(PuppetError::TooMany);
            }
            piece_of[index] = Some(self.pieces.len());
            self.pieces.push(piece);
        }
        Ok(())
    }

    /// The piece of a part by itself; `None` if nothing of it is built.
    fn piece(&self, part: PartId) -> Option<PaperPiece> {
        let bindings = self.bindings;
        let is_built = |member: &&PartId| {
            let form = bindings.form(**member);
            bindings.attributes(form).shape().kind != "none"
        };
        let shapes: Vec<ShapeId> = self
            .members
            .get(&part)?
            .iter()
            .filter(is_built)
            .map(|member| bindings.parts[*member].shape)
            .collect();
        let drawn = shapes.iter().flat_map(|shape| {
            let shape = &self.drawing.shapes[*shape];
            let stroke = shape.stroke.as_ref().map(|stroke| stroke.outline());
            [Outline::clone(&shape.outline), stroke.unwrap_or_default()]
        });
        let drawn: Vec<Outline> = drawn.collect();
        let corner = self.drawing.page.0;
        let outline = union(&drawn);
        let outline = outline.map_rings(|ring| ring.iter().map(|p| *p - corner).collect());
        bounds(&outline)?;
        let mut leaves: Vec<usize> = shapes
            .iter()
            .map(|shape| self.drawing.shapes[*shape].leaf)
            .collect();
        leaves.sort_unstable();
        leaves.dedup();
        Some(PaperPiece {
            part,
            details: Vec::new(),
            first: *leaves.first()?,
            leaves,
            outline,
            joint: None,
        })
    }

    /// Where a piece is pinned to its carrier: at the part's joint; where the pieces touch if it has none, as of two roots, or if
    /// that is on neither of them, as of a bent leg in one piece.
    fn pin(&self, piece: &PaperPiece, carrier: usize) -> DVec2 {
        let carrier = &self.pieces[carrier].outline;
        let part = &self.bindings.parts[piece.part];
        let joint = part.origin - self.drawing.page.0;
        let size = bounds(&piece.outline).map_or(0.0, |(low, high)| (high - low).max_element());
        let is_on = |outline: &Outline| {
            let gap = distance_squared(outline, joint).sqrt();
            gap <= NEAR * size
        };
        let is_given = matches!(
            self.bindings.attributes(piece.part).origin(),
            Some(Origin::Point(_))
        );
        if part.parent.is_some() && (is_given || is_on(&piece.outline) || is_on(carrier)) {
            joint
        } else {
            contact(&piece.outline, carrier)
        }
    }

    /// Whether a piece stays on its carrier, rather than being cut out: an eye, a button, hair.
    fn is_detail(&self, piece: &PaperPiece, carrier: usize) -> bool {
        let carrier = &self.pieces[carrier];
        let attributes = self.bindings.attributes(piece.part);
        let moves = attributes.mark().is_some()
            || attributes.bones().is_some()
            || attributes.swing().is_some();
        if moves {
            return false;
        }
        let shared = || area(&intersect(&piece.outline, &carrier.outline));
        match (self.role(piece.part), self.role(carrier.part)) {
            // Hair does not turn about a pin in the middle of the face.
            (Some(Role::OfHead), Some(Role::Head | Role::OfHead)) => shared() > 0.0,
            (None | Some(Role::OfHead), _) => {
                let own = area(&piece.outline);
                !piece.is_behind(carrier)
                    && own <= DETAIL * area(&carrier.outline)
                    && shared() >= LIES_ON * own
            }
            _ => false,
        }
    }

    fn role(&self, part: PartId) -> Option<Role> {
        Role::of(&anatomy::terms(&self.bindings.parts[part].name))
    }

    fn merge(&mut self, detail: PaperPiece, carrier: usize) {
        let carrier = &mut self.pieces[carrier];
        carrier.details.push(detail.part);
        carrier.leaves.extend(detail.leaves);
        carrier.leaves.sort_unstable();
        carrier.outline = union(&[std::mem::take(&mut carrier.outline), detail.outline]);
    }
}

/// The parts of a figure, each after the one that carries it.
fn carriers_first(figure: &FigureGroup) -> Vec<FigurePartId> {
    let mut children = ti_vec![Vec::new(); figure.parts.len()];
    let mut order = Vec::new();
    for (index, parent) in figure.parents.iter_enumerated() {
        match parent {
            Some(parent) => children[*parent].push(index),
            None => order.push(index),
        }
    }
    let mut next = 0;
    while let Some(&at) = order.get(next) {
        next += 1;
        order.append(&mut children[at]);
    }
    order
}

/// Where two areas touch: the middle of the largest area that they share, if need be after both have grown a little.
fn contact(one: &Outline, other: &Outline) -> DVec2 {
    let size = bounds(one).map_or(0.0, |(low, high)| (high - low).max_element());
    let shared = intersect(one, other);
    if area(&shared) > (NEAR * size).powi(2) {
        return middle(shared).unwrap_or_default();
    }
    let inside = Bands::of(other);
    let border = edges(other).map(|ends| Line::new(ends[0].to_array(), ends[1].to_array()));
    let border = RTree::bulk_load(border.collect());
    let gap = |point: &DVec2| {
        if inside.contains(*point) {
            return 0.0;
        }
        let nearest = border.nearest_neighbor_with_distance_2(point.to_array());
        nearest.map_or(0.0, |(_, gap)| gap)
    };
    let nearest = one.rings().flatten().copied();
    let nearest = nearest.min_by(|a, b| gap(a).total_cmp(&gap(b)));
    let nearest = nearest.unwrap_or_default();
    let larger = NEAR * size + gap(&nearest).sqrt() / 2.0;
    // Of a finely drawn curve, the bands of many edges would lie over one another.
    let grown = |outline: &Outline| {
        let coarse = outline.map_rings(|ring| simplified(ring, COARSE * larger));
        offset(&coarse, larger)
    };
    let shared = intersect(&grown(one), &grown(other));
    middle(shared).unwrap_or(nearest)
}

/// The middle of the largest polygon.
fn middle(outline: Outline) -> Option<DVec2> {
    let polygons = outline.polygons.into_iter().map(|polygon| Outline {
        polygons: vec![polygon],
    });
    let largest = polygons.max_by(|a, b| area(a).total_cmp(&area(b)))?;
    centroid(&largest)
}

/// The pieces by their first shapes.
fn in_paint_order(pieces: Vec<PaperPiece>) -> Vec<PaperPiece> {
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|piece| pieces[*piece].first);
    let mut place = vec![0; pieces.len()];
    for (new, old) in order.iter().enumerate() {
        place[*old] = new;
    }
    let mut placed: Vec<(usize, PaperPiece)> = place.iter().copied().zip(pieces).collect();
    placed.sort_by_key(|(place, _)| *place);
    let moved = placed.into_iter().map(|(_, mut piece)| {
        if let Some(joint) = &mut piece.joint {
            joint.parent = place[joint.parent];
        }
        piece
    });
    moved.collect()
}
