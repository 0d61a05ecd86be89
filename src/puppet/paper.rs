//! The paper of a piece, in millimetres: what is cut out around what is drawn, with room for holes and for the mark.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, Vec2Swizzles as _};

use super::pieces::PaperPiece;
use crate::geometry::{
    FillRule, Outline, Polygon, Ring, bounds, bounds_of, centroid, distance_squared,
    edge_distance_squared, edges, offset, resolve_overlaps, simplify, subtract, union,
};
use crate::math;

/// The paper around what is drawn.
const MARGIN: f64 = 2.0;
/// Round corners have chords, so that it is a little less.
pub(super) const LEAST_MARGIN: f64 = 0.9 * MARGIN;
/// Notches narrower than twice this are not cut.
const NOTCH: f64 = 2.0;
/// The line to cut follows what is drawn to within this, which no scissors do …
const DETAIL: f64 = 0.05;
/// … or, if it has more edges than this, to within more …
const MANY_EDGES: usize = 1 << 10;
/// … but this at most.
const MOST_DETAIL: f64 = 0.4 * MARGIN;
/// The radius of a joint's hole.
pub(super) const HOLE: f64 = 1.5;
/// The least radius of the paper around a hole's middle.
const RING: f64 = 5.0;
/// The radius of a mark: 14 mm across are some 15 pixels of a film that shows the whole puppet.
pub(super) const MARK: f64 = 7.0;
/// The paper around a mark.
const MARK_EDGE: f64 = 1.5;
/// Half the width of a bridge of paper between what lies apart.
const BRIDGE: f64 = 4.0;
/// What lies between a mark and the middle of a hole beyond the mark's radius: a pin's head.
const PIN: f64 = 5.0;
/// The number of corners of a disc.
const CORNERS: usize = 32;
/// A piece is turned if that makes its box smaller than this share of the box as drawn.
const WORTH_TURNING: f64 = 0.85;

/// The paper of a piece at a certain scale. Points are in millimetres, the drawing's axes and corner.
#[derive(Debug, Clone)]
pub(super) struct Paper {
    /// The line to cut: one border without holes.
    pub(super) outline: Outline,
    /// The holes of joints: first the piece's own, if it is carried, then those of the pieces that it carries.
    pub(super) holes: Vec<DVec2>,
    /// The middle of its mark.
    pub(super) mark: Option<DVec2>,
    /// How far the piece is turned on the sheet to take less room: radians, from the right to below.
    pub(super) turn: f64,
}

/// Whether a piece carries a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Marked {
    Yes,
    No,
}

/// What a piece is cut out of. Points are in drawing units.
#[derive(Clone, Copy)]
pub(super) struct Template<'a> {
    pub(super) piece: &'a PaperPiece,
    /// What is drawn on it without holes.
    pub(super) silhouette: &'a Outline,
    /// The boxes around that.
    pub(super) boxes: &'a [TurnedBox],
    /// The holes of joints that it has, its own first.
    pub(super) holes: &'a [DVec2],
    pub(super) marked: Marked,
}

impl Template<'_> {
    fn holes_at(&self, scale: f64) -> Vec<DVec2> {
        self.holes.iter().map(|hole| *hole * scale).collect()
    }

    /// What is drawn on it in millimetres.
    fn drawn_at(&self, scale: f64) -> Outline {
        scaled(&self.piece.outline, scale)
    }

    /// The middle of its mark in millimetres, given what is drawn and the holes.
    fn mark_at(&self, scale: f64, drawn: &Outline, holes: &[DVec2]) -> DVec2 {
        let joint = self.piece.joint.map(|joint| joint.at * scale);
        mark_place(drawn, joint, holes)
    }
}

fn scaled(outline: &Outline, scale: f64) -> Outline {
    outline.map_rings(|ring| ring.iter().map(|p| *p * scale).collect())
}

/// Cuts out a piece at `scale` millimetres a drawing unit.
pub(super) fn cut_out(template: &Template<'_>, scale: f64) -> Paper {
    let drawn = template.drawn_at(scale);
    let holes = template.holes_at(scale);
    let around = offset(&coarse(&scaled(template.silhouette, scale)), MARGIN + NOTCH);
    let mut all = vec![offset(&without_holes(&around), -NOTCH)];
    let mut add = |at: DVec2, radius: f64| {
        all.push(disc(at, radius));
        // A disc off what is drawn would hang on its own margin only.
        let near = nearest(&drawn, at);
        if near.distance_squared(at) > 0.0 {
            all.push(bridge(near, at));
        }
    };
    for hole in &holes {
        add(*hole, RING);
    }
    let mark = match template.marked {
        Marked::Yes => Some(template.mark_at(scale, &drawn, &holes)),
        Marked::No => None,
    };
    if let Some(mark) = mark {
        add(mark, MARK + MARK_EDGE);
    }
    let outline = in_one_piece(without_holes(&union(&all)));
    Paper {
        turn: smallest(boxes_turned(&outline).iter().map(TurnedBox::sized)).0,
        outline,
        holes,
        mark,
    }
}

/// The size of the box on the sheet around a piece at `scale` millimetres a drawing unit, upright if it is wider than `widest`: right but
/// for bridges that are wider than the paper around what they join.
pub(super) fn rough_box(template: &Template<'_>, scale: f64, widest: f64) -> DVec2 {
    let holes = template.holes_at(scale);
    let mut discs: Vec<(DVec2, f64)> = holes.iter().map(|hole| (*hole, RING)).collect();
    if template.marked == Marked::Yes {
        let mark = template.mark_at(scale, &template.drawn_at(scale), &holes);
        discs.push((mark, MARK + MARK_EDGE));
    }
    let sizes = template.boxes.iter().map(|TurnedBox { turn, low, high }| {
        let way = math::direction(*turn);
        let drawn = (*low * scale - MARGIN, *high * scale + MARGIN);
        let (low, high) = discs.iter().fold(drawn, |(low, high), (at, radius)| {
            let at = way.rotate(*at);
            (low.min(at - *radius), high.max(at + *radius))
        });
        (*turn, high - low)
    });
    let (_, size) = smallest(sizes);
    if size.x > widest { size.yx() } else { size }
}

impl Paper {
    /// The same paper, turned by a right angle if it is wider than that.
    pub(super) fn upright_if_wider(mut self, width: f64) -> Self {
        let (low, high) = self.bounds();
        if high.x - low.x > width {
            self.turn += PI / 2.0;
        }
        self
    }

    /// A point of the piece, turned as on the sheet.
    pub(super) fn turned(&self, point: DVec2) -> DVec2 {
        math::direction(self.turn).rotate(point)
    }

    /// The lower and the upper corner of its box on the sheet, before it is moved to its place.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        bounds_turned(&self.outline, self.turn)
    }
}

/// The middle of the mark: at the far end from the joint, as much on what is drawn as possible, and clear of all holes.
fn mark_place(drawn: &Outline, joint: Option<DVec2>, holes: &[DVec2]) -> DVec2 {
    let middle = bounds(drawn).map_or(DVec2::ZERO, |(low, high)| (low + high) / 2.0);
    let from = joint.unwrap_or(middle);
    let corners = drawn.rings();
    let far = corners.flatten().copied().max_by(|a, b| {
        let length = |point: &DVec2| point.distance_squared(from);
        length(a).total_cmp(&length(b))
    });
    let length = far.unwrap_or(from).distance(from);
    // The far end may be a corner: the mark goes to the middle of all that is as far away.
    let near = disc(from, (length - 2.0 * MARK).max(0.0));
    let end = centroid(&subtract(drawn, &near)).unwrap_or(from);
    let way = end - from;
    let (wished, along) = (way.length(), way.normalize_or(DVec2::Y));
    let is_clear = |at: DVec2| {
        let mut holes = holes.iter();
        holes.all(|hole| hole.distance(at) >= MARK + PIN)
    };
    let inwards = (0..=wished as usize).map(|step| wished - step as f64);
    let outwards = (1..200).map(|step| wished + f64::from(step));
    let mut places = inwards.chain(outwards).map(|step| from + along * step);
    places.find(|at| is_clear(*at)).unwrap_or(end)
}

/// What is drawn as finely as matters to the line to cut. Each edge meets all those that are no farther away than the paper around them
/// reaches, so that there must not be very many.
fn coarse(drawn: &Outline) -> Outline {
    let mut detail = DETAIL;
    loop {
        let coarse = drawn.map_rings(|ring| simplified(ring, detail));
        if edges(&coarse).count() <= MANY_EDGES || detail >= MOST_DETAIL {
            return coarse;
        }
        detail *= 2.0;
    }
}

/// Where a ring has more points than this, those that matter are looked for in stretches of so many points: of a comb, each point that is
/// found halves nothing, and all the others are looked at again.
const STRETCH: usize = 512;

/// The ring with the points that matter if it may be off by `detail`: three at least, because paper is left around dots, too.
pub(super) fn simplified(ring: &Ring, detail: f64) -> Ring {
    let farthest = |from: DVec2| {
        let far = |i: &usize| ring[*i].distance_squared(from);
        (0..ring.len()).max_by(|a, b| far(a).total_cmp(&far(b)))
    };
    // Two points that are far from each other are kept.
    let Some(start) = ring.first().and_then(|first| farthest(*first)) else {
        return Ring::new();
    };
    let turned: Ring = (0..=ring.len())
        .map(|i| ring[(start + i) % ring.len()])
        .collect();
    let off = |index: usize, [from, to]: [usize; 2]| {
        let edge = [turned[from], turned[to]];
        if from == 0 && to == ring.len() {
            turned[index].distance_squared(edge[0])
        } else {
            edge_distance_squared(edge, turned[index])
        }
    };
    let farthest = |from: usize, to: usize| {
        let far = |index: &usize| off(*index, [from, to]);
        let middle = (from + 1..to).max_by(|a, b| far(a).total_cmp(&far(b)))?;
        let is_whole = from == 0 && to == ring.len();
        (is_whole || far(&middle) > detail * detail).then_some(middle)
    };
    let mut kept = Vec::new();
    for start in (0..ring.len()).step_by(STRETCH) {
        let end = (start + STRETCH).min(ring.len());
        let of_stretch = simplify(end - start + 1, |from, to| {
            farthest(start + from, start + to).map(|index| index - start)
        });
        // Its end begins the next stretch, or is the point that the ring begins with.
        let own = of_stretch.into_iter().map(|index| start + index);
        kept.extend(own.take_while(|index| *index < end));
    }
    if kept.len() == 2 {
        let ends = [kept[0], kept[1]];
        let far =
            |index: &usize| edge_distance_squared(ends.map(|end| turned[end]), turned[*index]);
        kept.extend((0..ring.len()).max_by(|a, b| far(a).total_cmp(&far(b))));
        kept.sort_unstable();
    }
    kept.into_iter().map(|index| turned[index]).collect()
}

/// The area with all its holes filled.
pub(super) fn without_holes(outline: &Outline) -> Outline {
    let borders = outline
        .polygons
        .iter()
        .flat_map(|polygon| polygon.rings.first());
    // What lies in a hole is inside now.
    resolve_overlaps(borders.cloned().collect(), FillRule::NonZero)
}

/// The outline with bridges between its polygons.
fn in_one_piece(mut outline: Outline) -> Outline {
    // Each bridge joins at least two polygons.
    for _ in 1..outline.polygons.len() {
        let [first, others @ ..] = outline.polygons.as_slice() else {
            break;
        };
        let one = |polygon: &Polygon| Outline {
            polygons: vec![polygon.clone()],
        };
        let first = one(first);
        let gaps = others.iter().flat_map(|other| {
            let points = other.rings.iter().flatten();
            points.map(|point| (nearest(&first, *point), *point))
        });
        let length = |gap: &(DVec2, DVec2)| gap.0.distance_squared(gap.1);
        let Some((from, to)) = gaps.min_by(|a, b| length(a).total_cmp(&length(b))) else {
            break;
        };
        let joined = union(&[std::mem::take(&mut outline), bridge(from, to)]);
        outline = without_holes(&joined);
    }
    outline
}

/// The point of an area that is nearest to a point.
fn nearest(outline: &Outline, point: DVec2) -> DVec2 {
    if distance_squared(outline, point) == 0.0 {
        return point;
    }
    let rings = outline.rings();
    let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let on_edge = |(a, b): (&DVec2, &DVec2)| {
        let way = *b - *a;
        let t = (point - *a).dot(way) / way.length_squared();
        *a + way * t.clamp(0.0, 1.0)
    };
    let length = |at: &DVec2| at.distance_squared(point);
    let nearest = edges
        .map(on_edge)
        .min_by(|a, b| length(a).total_cmp(&length(b)));
    nearest.unwrap_or(point)
}

fn disc(at: DVec2, radius: f64) -> Outline {
    // The corners lie outside, so that the disc is nowhere narrower than it should be.
    let radius = radius / math::cos(PI / CORNERS as f64);
    let angle = |corner: usize| TAU * corner as f64 / CORNERS as f64;
    let ring: Ring = (0..CORNERS)
        .map(|corner| at + math::direction(angle(corner)) * radius)
        .collect();
    resolve_overlaps(vec![ring], FillRule::NonZero)
}

/// A strip of paper with round ends.
fn bridge(from: DVec2, to: DVec2) -> Outline {
    let Some(along) = (to - from).try_normalize() else {
        return disc(to, BRIDGE);
    };
    let across = along.perp() * BRIDGE;
    let strip = vec![from + across, to + across, to - across, from - across];
    let strip = resolve_overlaps(vec![strip], FillRule::NonZero);
    union(&[strip, disc(from, BRIDGE), disc(to, BRIDGE)])
}

fn bounds_turned(outline: &Outline, turn: f64) -> (DVec2, DVec2) {
    let way = math::direction(turn);
    let rings = outline.rings();
    let points = rings.flatten().map(|point| way.rotate(*point));
    bounds_of(points).unwrap_or((DVec2::INFINITY, DVec2::NEG_INFINITY))
}

/// The box around an outline that is turned.
#[derive(Debug, Clone, Copy)]
pub(super) struct TurnedBox {
    /// Radians, from the right to below.
    turn: f64,
    low: DVec2,
    high: DVec2,
}

impl TurnedBox {
    pub(super) fn size(&self) -> DVec2 {
        self.high - self.low
    }

    /// How far it is turned, and its size.
    fn sized(&self) -> (f64, DVec2) {
        (self.turn, self.size())
    }
}

/// The boxes around an outline for each way in which a piece may be turned on the sheet.
pub(super) fn boxes_turned(outline: &Outline) -> Vec<TurnedBox> {
    let turns = (-17..=18).map(|step| f64::from(step) * PI / 36.0);
    let boxes = turns.map(|turn| {
        let (low, high) = bounds_turned(outline, turn);
        TurnedBox { turn, low, high }
    });
    boxes.collect()
}

/// The smallest of the boxes around a piece, each with how far the piece is turned: that of the piece as it is drawn where turning it gains
/// little.
fn smallest(boxes: impl Iterator<Item = (f64, DVec2)>) -> (f64, DVec2) {
    let area = |(_, size): &(f64, DVec2)| size.element_product();
    let boxes: Vec<(f64, DVec2)> = boxes.collect();
    let as_drawn = boxes.iter().find(|(turn, _)| *turn == 0.0);
    let as_drawn = as_drawn.copied().unwrap_or_default();
    let best = boxes.into_iter().min_by(|a, b| area(a).total_cmp(&area(b)));
    let best = best.filter(|best| area(best) < WORTH_TURNING * area(&as_drawn));
    best.unwrap_or(as_drawn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().copied().map(DVec2::from).collect()
    }

    /// The largest distance of points from the border of a ring.
    fn farthest_from(kept: &Ring, points: &Ring) -> f64 {
        let gap = |point: &DVec2| {
            let edges = kept.iter().zip(kept.iter().cycle().skip(1));
            let gaps = edges.map(|(a, b)| edge_distance_squared([*a, *b], *point));
            gaps.fold(f64::INFINITY, f64::min).sqrt()
        };
        points.iter().map(gap).fold(0.0, f64::max)
    }

    #[test]
    fn long_rings_are_simplified_in_stretches() {
        let circle: Ring = (0..3 * STRETCH)
            .map(|i| DVec2::from_angle(TAU * i as f64 / (3 * STRETCH) as f64) * 50.0)
            .collect();
        let kept = simplified(&circle, DETAIL);
        assert!(kept.len() < 100, "{} points", kept.len());
        assert!(farthest_from(&kept, &circle) <= DETAIL);
        // All corners of a comb matter.
        let comb: Ring = (0..2 * STRETCH)
            .map(|i| DVec2::new(i as f64, if i % 2 == 0 { 0.0 } else { 99.0 }))
            .collect();
        assert_eq!(simplified(&comb, DETAIL).len(), comb.len());
    }

    #[test]
    fn dots_and_lines_keep_three_points() {
        let dot: Ring = (0..20)
            .map(|i| DVec2::from_angle(f64::from(i) * 0.3) * 0.01)
            .collect();
        assert_eq!(simplified(&dot, DETAIL).len(), 3);
        let line = ring(&[[0.0, 0.0], [5.0, 0.01], [9.0, 0.0], [5.0, -0.01]]);
        assert_eq!(simplified(&line, DETAIL).len(), 3);
        assert!(simplified(&Ring::new(), DETAIL).is_empty());
        let square = ring(&[[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [2.0, 5.0], [0.0, 5.0]]);
        assert_eq!(simplified(&square, DETAIL).len(), 4);
    }

    proptest! {
        #[test]
        fn simplified_rings_are_near(
            radii in prop::collection::vec(1.0..9.0f64, 3..60),
        ) {
            let angle = |i: usize| TAU * i as f64 / radii.len() as f64;
            let place = |(i, radius): (usize, &f64)| DVec2::from_angle(angle(i)) * *radius;
            let ring: Ring = radii.iter().enumerate().map(place).collect();
            prop_assert!(farthest_from(&simplified(&ring, DETAIL), &ring) <= DETAIL);
        }
    }
}
