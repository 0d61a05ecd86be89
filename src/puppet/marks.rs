//! The colour marks of a puppet: those that strings give, else suggested ones.

use glam::DVec2;

use super::pieces::PaperPiece;
use crate::anatomy::{self, Role};
use crate::bind::{Bindings, PartId};
use crate::geometry::bounds;
use crate::svg::Drawing;

/// The colours of suggested marks, the easiest to find in a film first.
const PALETTE: [(&str, [u8; 3]); 6] = [
    ("red", [255, 0, 0]),
    ("blue", [0, 0, 255]),
    ("lime", [0, 255, 0]),
    ("magenta", [255, 0, 255]),
    ("cyan", [0, 255, 255]),
    ("yellow", [255, 255, 0]),
];
/// A colour whose hue is nearer than this to one of the figure's is suggested last, degrees.
const SIMILAR: f64 = 30.0;
/// Colours with a smaller difference between their channels have no hue that counts.
const VIVID: u8 = 90;
/// With fewer marks than this, nothing is emphasised over something else.
const FEWEST: usize = 2;

/// The mark on a piece.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PieceMark {
    /// The colour as a string writes it: `red`, `#ff8000`.
    pub word: String,
    /// Red, green, blue, sRGB.
    pub color: [u8; 3],
    /// The part that has it.
    pub part: PartId,
    /// Whether a string gives it, or the sheet suggests it.
    pub origin: MarkOrigin,
}

/// Where a mark comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkOrigin {
    /// A string.
    Given,
    /// The program.
    Suggested,
}

/// Per piece its mark. If no string gives one, the ends of the arms get marks; if these are fewer than two, also those of the
/// legs, and else what is farthest from the piece that carries the others.
pub(crate) fn marks(
    drawing: &Drawing,
    bindings: &Bindings,
    pieces: &[PaperPiece],
) -> Vec<Option<PieceMark>> {
    let given: Vec<Option<PieceMark>> = pieces.iter().map(|piece| given(bindings, piece)).collect();
    if given.iter().any(Option::is_some) {
        return given;
    }
    let mut marks = vec![None; pieces.len()];
    let colors = palette(drawing, pieces);
    for (piece, (word, color)) in ends(bindings, pieces).into_iter().zip(colors) {
        marks[piece] = Some(PieceMark {
            word: word.to_owned(),
            color,
            part: pieces[piece].part,
            origin: MarkOrigin::Suggested,
        });
    }
    marks
}

fn given(bindings: &Bindings, piece: &PaperPiece) -> Option<PieceMark> {
    let mut parts = std::iter::once(&piece.part).chain(&piece.details);
    parts.find_map(|part| {
        let mark = bindings.mark(*part)?;
        Some(PieceMark {
            word: mark.word.to_owned(),
            color: mark.color,
            part: *part,
            origin: MarkOrigin::Given,
        })
    })
}

/// The pieces that show a movement best.
fn ends(bindings: &Bindings, pieces: &[PaperPiece]) -> Vec<usize> {
    use Role::{Foot, Hand, LowerArm, Shin, Thigh, Toe, UpperArm};
    let role = |piece: &PaperPiece| Role::of(&anatomy::terms(&bindings.parts[piece.part].name));
    let mut ends: Vec<usize> = Vec::new();
    for limb in [&[UpperArm, LowerArm, Hand][..], &[Thigh, Shin, Foot, Toe]] {
        let is_limb = |piece: &PaperPiece| role(piece).is_some_and(|role| limb.contains(&role));
        let carries_more = |index: usize| {
            let mut limbs = pieces.iter().filter(|piece| is_limb(piece));
            limbs.any(|piece| piece.joint.is_some_and(|joint| joint.parent == index))
        };
        let limbs = (0..pieces.len()).filter(|index| is_limb(&pieces[*index]));
        ends.extend(limbs.filter(|index| !carries_more(*index)));
        if ends.len() >= FEWEST {
            return ends;
        }
    }
    let middle =
        |piece: &PaperPiece| bounds(&piece.outline).map_or(DVec2::ZERO, |(a, b)| (a + b) / 2.0);
    let root = pieces.iter().find(|piece| piece.joint.is_none());
    let center = root.map_or(DVec2::ZERO, middle);
    let mut others: Vec<usize> = (0..pieces.len())
        .filter(|index| pieces[*index].joint.is_some() && !ends.contains(index))
        .collect();
    let distance = |index: &usize| middle(&pieces[*index]).distance_squared(center);
    others.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
    ends.extend(others);
    ends.truncate(FEWEST);
    ends
}

/// The colours for marks, those that differ from all vivid colours of the pieces first.
fn palette(drawing: &Drawing, pieces: &[PaperPiece]) -> Vec<(&'static str, [u8; 3])> {
    let is_shown = |leaf: usize| pieces.iter().any(|piece| piece.leaves.contains(&leaf));
    let shapes = drawing.shapes.iter().filter(|shape| is_shown(shape.leaf));
    let hues: Vec<f64> = shapes.filter_map(|shape| hue(shape.paint.color)).collect();
    let is_similar = |color: [u8; 3]| {
        let own = hue(color).unwrap_or_default();
        hues.iter().any(|hue| {
            let apart = (hue - own).rem_euclid(360.0);
            apart.min(360.0 - apart) < SIMILAR
        })
    };
    let mut palette = PALETTE.to_vec();
    palette.sort_by_key(|(_, color)| is_similar(*color));
    palette
}

/// The hue of a vivid colour, degrees.
fn hue([r, g, b]: [u8; 3]) -> Option<f64> {
    let (high, low) = (r.max(g).max(b), r.min(g).min(b));
    if high - low < VIVID {
        return None;
    }
    let [red, green, blue] = [r, g, b].map(f64::from);
    let range = f64::from(high - low);
    Some(match high {
        _ if high == r => 60.0 * ((green - blue) / range).rem_euclid(6.0),
        _ if high == g => 60.0 * ((blue - red) / range + 2.0),
        _ => 60.0 * ((red - green) / range + 4.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_are_those_of_the_color_wheel() {
        for (color, expected) in [
            ([255, 0, 0], Some(0.0)),
            ([255, 255, 0], Some(60.0)),
            ([0, 200, 0], Some(120.0)),
            ([0, 0, 128], Some(240.0)),
            ([255, 0, 255], Some(300.0)),
            ([120, 100, 110], None),
        ] {
            assert_eq!(hue(color), expected, "{color:?}");
        }
    }
}
