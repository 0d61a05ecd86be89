//! Printable puppets: the figures of a drawing as a sheet of pieces to cut out, pin together and film.
//!
//! `pieces` says which parts are a piece of paper, in drawing units; `paper` cuts it out at a scale, and `layout` finds the
//! scale and the places, both in millimetres, x to the right, y down; `instructions` says what to do with the sheet, and `sheet`
//! writes it. A joint's hole lies on paper in both pieces that it joins.

mod instructions;
mod layout;
mod marks;
mod paper;
mod pieces;
mod sheet;

use glam::DVec2;
use rayon::prelude::*;

use crate::bind::Bindings;
use crate::compile::Compiled;
use crate::crash::Crash;
use crate::geometry::{Outline, bounds};
use crate::lang::looks_like_string;
use crate::resolver::Resolver;
use crate::svg::{Excerpts, excerpts};
use crate::threads;

use instructions::Texts;
use layout::{EDGE, GAP, Layout, Task};
pub use marks::MarkOrigin;
pub(crate) use marks::{PieceMark, marks};
use paper::{boxes_turned, without_holes};
pub use pieces::{PaperPiece, pieces};
use sheet::Printed;

/// The most pieces of a sheet; nobody pins more.
const MAX_PIECES: usize = 300;
/// The letters of joints, without those that look like digits. If there are more joints, they have numbers.
const LETTERS: &str = "ABCDEFGHJKLMNPQRSTUVWXYZ";
/// Holes that are nearer than this are one, in millimetres.
const SAME_HOLE: f64 = 1.0;

/// A page that most printers have, width and height in millimetres.
pub(crate) const A4: DVec2 = DVec2::new(210.0, 297.0);

/// How a sheet is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Width and height of a page, millimetres.
    pub page: DVec2,
    /// Millimetres on paper for a drawing unit; `None` for as many as fit.
    pub scale: Option<f64>,
}

/// A sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The SVG.
    pub svg: String,
    /// How many pieces it has.
    pub pieces: usize,
    /// How many pages it has.
    pub pages: usize,
    /// Millimetres on paper for a drawing unit.
    pub scale: f64,
    /// The larger side of the largest figure, millimetres.
    pub size: f64,
    /// The marks, in paint order.
    pub marks: Vec<PieceMark>,
}

/// Why there is no sheet. Messages go behind the drawing's name.
#[derive(Debug, thiserror::Error)]
pub enum PuppetError {
    /// No part can be cut out.
    #[error(
        "has no figure to cut out: no shape is a part of one; write a name beside each part, for example `Arm@Body`"
    )]
    NoFigure,
    /// It has too many pieces.
    #[error(
        "has more than {MAX_PIECES} pieces, too many for a sheet; give only the parts that move a name"
    )]
    TooMany,
    /// A piece is larger than the page at the scale that was asked for.
    #[error("is too large for the page at this scale; the largest is `--scale {0}`")]
    TooLarge(String),
    /// The pieces do not fit on the page at any scale.
    #[error(
        "does not fit on a page of this size, however small its pieces are; choose a larger page"
    )]
    NoRoom,
    /// The drawing cannot be read again.
    #[error("cannot be drawn")]
    Drawing,
    /// The program failed.
    #[error("{0}")]
    Crash(Crash),
}

/// Makes the sheet of a drawing called `title`, which was compiled from `text`.
///
/// # Errors
/// If the drawing has no figure, or its pieces do not fit.
pub fn sheet(
    compiled: &Compiled,
    text: &str,
    title: &str,
    resolver: &dyn Resolver,
    options: &Options,
) -> Result<Sheet, PuppetError> {
    let made = threads::run(|| Puppet::new(compiled)?.sheet(text, title, resolver, options));
    made.unwrap_or_else(|crash| Err(PuppetError::Crash(crash)))
}

/// The figures of a drawing, ready to be laid out.
struct Puppet<'a> {
    bindings: &'a Bindings,
    pieces: Vec<PaperPiece>,
    marks: Vec<Option<PieceMark>>,
    /// Per piece the holes of what it carries: the pieces whose joints they are.
    carried: Vec<Vec<usize>>,
}

impl<'a> Puppet<'a> {
    fn new(compiled: &'a Compiled) -> Result<Self, PuppetError> {
        let Compiled {
            bindings, drawing, ..
        } = compiled;
        let pieces = pieces(drawing, bindings)?;
        if pieces.is_empty() {
            return Err(PuppetError::NoFigure);
        }
        let mut carried = vec![Vec::new(); pieces.len()];
        for (index, piece) in pieces.iter().enumerate() {
            if let Some(joint) = piece.joint {
                carried[joint.parent].push(index);
            }
        }
        Ok(Self {
            bindings,
            marks: marks(drawing, bindings, &pieces),
            carried,
            pieces,
        })
    }

    fn sheet(
        &self,
        text: &str,
        title: &str,
        resolver: &dyn Resolver,
        options: &Options,
    ) -> Result<Sheet, PuppetError> {
        let texts = self.texts(title, options.page);
        let silhouettes: Vec<Outline> = self
            .pieces
            .par_iter()
            .map(|piece| without_holes(&piece.outline))
            .collect();
        let task = Task {
            pieces: &self.pieces,
            boxes: silhouettes.iter().map(boxes_turned).collect(),
            silhouettes,
            marks: &self.marks,
            holes: (0..self.pieces.len())
                .map(|piece| self.holes(piece))
                .collect(),
            names: (0..self.pieces.len())
                .map(|piece| instructions::text_width(&self.caption(piece, options.page)))
                .collect(),
            page: options.page,
            text: texts.height(),
            extent: self.extent(),
        };
        let layout = match options.scale {
            None => task.fit().ok_or(PuppetError::NoRoom)?,
            Some(scale) => match task.at(scale, usize::MAX) {
                Some(layout) => layout,
                None => {
                    let largest = task.largest(scale, usize::MAX).ok_or(PuppetError::NoRoom)?;
                    // Rounded down, so that what the message says does fit.
                    let largest = (largest.scale * 1e3).floor() / 1e3;
                    return Err(PuppetError::TooLarge(largest.to_string()));
                }
            },
        };
        let excerpts = self.drawn(text, resolver).ok_or(PuppetError::Drawing)?;
        let printed: Vec<Printed<'_>> = (0..self.pieces.len())
            .map(|index| self.printed(index, &layout, options.page))
            .collect();
        Ok(Sheet {
            svg: sheet::write(options.page, &layout, &printed, &excerpts, &texts),
            pieces: self.pieces.len(),
            pages: layout.pages,
            scale: layout.scale,
            size: layout.scale * task.extent,
            marks: self.marks.iter().flatten().cloned().collect(),
        })
    }

    /// What is drawn on each piece.
    fn drawn(&self, text: &str, resolver: &dyn Resolver) -> Option<Excerpts> {
        let mut piece_of = std::collections::BTreeMap::new();
        for (index, piece) in self.pieces.iter().enumerate() {
            piece_of.extend(piece.leaves.iter().map(|leaf| (*leaf, index)));
        }
        excerpts(text, resolver, self.pieces.len(), |leaf| {
            piece_of.get(&leaf).copied()
        })
    }

    /// The larger side of the largest figure, drawing units.
    fn extent(&self) -> f64 {
        let mut boxes: Vec<Option<(DVec2, DVec2)>> = vec![None; self.pieces.len()];
        for (index, piece) in self.pieces.iter().enumerate() {
            let Some((low, high)) = bounds(&piece.outline) else {
                continue;
            };
            let all = &mut boxes[self.root(index)];
            *all = Some(match all {
                None => (low, high),
                Some((from, to)) => (from.min(low), to.max(high)),
            });
        }
        let sides = boxes
            .iter()
            .flatten()
            .map(|(low, high)| (*high - *low).max_element());
        sides.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// The piece that carries the whole figure of a piece.
    fn root(&self, mut piece: usize) -> usize {
        while let Some(joint) = self.pieces[piece].joint {
            piece = joint.parent;
        }
        piece
    }

    /// The pieces whose joints make holes in a piece: its own first.
    fn joints(&self, piece: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.pieces[piece].joint.map(|_| piece);
        own.into_iter().chain(self.carried[piece].iter().copied())
    }

    fn holes(&self, piece: usize) -> Vec<DVec2> {
        let joints = self
            .joints(piece)
            .filter_map(|joint| self.pieces[joint].joint);
        joints.map(|joint| joint.at).collect()
    }

    /// The letter of the joint at which a piece is carried.
    fn letter(&self, piece: usize) -> String {
        let is_joint = |index: &usize| self.pieces[*index].joint.is_some();
        let count = (0..self.pieces.len()).filter(is_joint).count();
        let number = (0..piece).filter(is_joint).count();
        match LETTERS.chars().nth(number) {
            Some(letter) if count <= LETTERS.len() => letter.to_string(),
            _ => (number + 1).to_string(),
        }
    }

    fn name(&self, piece: usize) -> &str {
        &self.bindings.parts[self.pieces[piece].part].name
    }

    /// What stands below a piece: its name, and where it lies, as far as the page has room for it.
    fn caption(&self, piece: usize, page: DVec2) -> String {
        let name = plain(self.name(piece));
        let caption = match self.pieces[piece].joint {
            Some(joint) if self.pieces[piece].is_behind(&self.pieces[joint.parent]) => {
                format!("{name}, behind {}", plain(self.name(joint.parent)))
            }
            _ => name,
        };
        instructions::shortened(&caption, page.x - 2.0 * EDGE - GAP)
    }

    fn printed<'b>(&'b self, index: usize, layout: &'b Layout, page: DVec2) -> Printed<'b> {
        let placed = &layout.placed[index];
        let holes = &placed.paper.holes;
        let mut letters: Vec<Vec<String>> = vec![Vec::new(); holes.len()];
        for (hole, joint) in self.joints(index).enumerate() {
            let is_same = |other: &DVec2| other.distance(holes[hole]) < SAME_HOLE;
            let first = holes[..hole].iter().position(is_same);
            letters[first.unwrap_or(hole)].push(self.letter(joint));
        }
        Printed {
            placed,
            mark: self.marks[index].as_ref(),
            name: self.name(index).to_owned(),
            caption: self.caption(index, page),
            letters,
        }
    }

    fn texts(&self, title: &str, page: DVec2) -> Texts {
        let marks = self.marks.iter().flatten();
        let marks = marks.map(|mark| (mark, plain(&self.bindings.parts[mark.part].name)));
        Texts::new(
            &plain(title),
            &marks.collect::<Vec<_>>(),
            page.x - 2.0 * EDGE,
        )
    }
}

/// A name as a text that is not taken for a string, if the sheet is opened as a drawing.
fn plain(name: &str) -> String {
    if looks_like_string(name) || name.starts_with(['#', '^']) {
        name.replace(['$', '@', '%', '*', '#', '^'], " ")
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_is_taken_for_a_string() {
        for (name, text) in [
            ("Arm", "Arm"),
            ("右腕", "右腕"),
            ("Arm@Body", "Arm Body"),
            ("a$b", "a b"),
            ("# 1", "  1"),
            ("50 %", "50 %"),
        ] {
            assert_eq!(plain(name), text);
            assert!(!looks_like_string(&plain(name)));
        }
    }
}
