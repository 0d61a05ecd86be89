//! Characters with known answers: bodies of ellipsoids and boxes with details on their surfaces, drawn from any direction as
//! flat drawings show them. For tests only.
//!
//! Axes and directions are those of characters. A character's height is 1 before it is drawn; drawings have y down and the
//! character's centre at their origin.

mod body;
pub(in crate::billboard) mod random;

use std::ops::Range;

use glam::{DMat3, DVec2, DVec3};
use typed_index_collections::{TiSlice, TiVec};

pub(in crate::billboard) use body::character;

use crate::billboard::region::{Direction, Region, RegionId, View};
use crate::geometry::{
    FillRule, Outline, Ring, area, bounds, convex_hull, intersect, resolve_overlaps, union,
};

/// The seeds of the characters that were looked at while the rules were written.
pub(in crate::billboard) const FITTED: Range<u64> = 0..200;
/// Those of as many others from the same directions, which no rule was fitted to: what is measured of them is what is claimed.
pub(in crate::billboard) const HELD_BACK: Range<u64> = 12_000..12_200;

/// Points around an ellipse.
const AROUND: usize = 32;
/// Points along an edge where a surface turns away from the viewer.
const ALONG_EDGE: usize = 8;
/// Visible pieces below this share of the squared height are not drawn.
const LEAST_AREA: f64 = 3e-5;
/// A region lies in another if this share of its area does.
const CONTAINED: f64 = 0.98;

/// A character in space.
#[derive(Debug, Clone)]
pub(in crate::billboard) struct Character {
    /// Drawing units per height.
    pub scale: f64,
    /// Its coloured surfaces. An index into them is a region's true identity.
    pub items: Vec<Item>,
    solids: Vec<Solid>,
}

/// A surface of one colour: a whole solid, or a detail upon it.
#[derive(Debug, Clone)]
pub(in crate::billboard) struct Item {
    /// What it stands for. The left and the right one of a pair share it.
    pub kind: &'static str,
    /// Its colour, sRGB with alpha, from 0 to 1.
    pub color: [f64; 4],
    solid: usize,
    /// The border of a detail in the solid's own frame, counter-clockwise seen from outside.
    detail: Option<Vec<DVec3>>,
}

#[derive(Debug, Clone)]
struct Solid {
    form: Form,
    center: DVec3,
    /// From the unit sphere or the cube from −1 to 1.
    axes: DMat3,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Ellipsoid,
    Box,
}

/// A drawing with its answers.
#[derive(Debug, Clone)]
pub(in crate::billboard) struct Drawn {
    /// The drawing.
    pub view: View,
    /// The item that each region shows.
    pub items: TiVec<RegionId, usize>,
    /// The share of each region's bounding box that is hidden: 1 − intersection over union of its box with that of the whole
    /// surface.
    pub hidden: TiVec<RegionId, f64>,
}

/// The two directions from which the character of a seed is drawn: 45° apart for about half of the seeds.
pub(in crate::billboard) fn directions(seed: u64) -> [Direction; 2] {
    let direction = |theta, phi| Direction { theta, phi };
    let front = direction(0.0, 0.0);
    match seed % 12 {
        6 => [front, direction(20.0, 0.0)],
        7 => [front, direction(30.0, 0.0)],
        8 => [front, direction(60.0, 0.0)],
        9 => [front, direction(-45.0, 0.0)],
        10 => [front, direction(0.0, 30.0)],
        11 => [direction(-15.0, 10.0), direction(30.0, 10.0)],
        _ => [front, direction(45.0, 0.0)],
    }
}

impl Character {
    /// The place of an item: a solid's centre, or the middle of a detail's border. Heights.
    pub(in crate::billboard) fn center(&self, item: usize) -> DVec3 {
        let item = &self.items[item];
        let solid = &self.solids[item.solid];
        item.detail.as_ref().map_or(solid.center, |ring| {
            let (low, high) = ring
                .iter()
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
                    (low.min(*p), high.max(*p))
                });
            solid.center + solid.axes * ((low + high) / 2.0)
        })
    }

    /// The drawing from a direction. Surfaces that are hidden are missing in it.
    pub(in crate::billboard) fn true_view(&self, direction: Direction) -> Drawn {
        let screen = Screen::new(direction, self.scale);
        let mut order: Vec<usize> = (0..self.solids.len()).collect();
        let depth = |i: usize| self.solids[i].center.dot(screen.axes[2]);
        order.sort_by(|a, b| depth(*a).total_cmp(&depth(*b)));
        let silhouettes: Vec<Outline> = self.solids.iter().map(|s| screen.solid(s)).collect();
        let mut drawn = Drawn {
            view: View {
                direction,
                regions: TiVec::new(),
            },
            items: TiVec::new(),
            hidden: TiVec::new(),
        };
        for (rank, &solid) in order.iter().enumerate() {
            let nearer: Vec<_> = order[rank + 1..].iter().map(|i| &silhouettes[*i]).collect();
            let items: Vec<_> = (0..self.items.len())
                .filter(|i| self.items[*i].solid == solid)
                .collect();
            let shape = |i: &usize| match &self.items[*i].detail {
                None => silhouettes[solid].clone(),
                Some(ring) => screen.detail(&self.solids[solid], ring),
            };
            let shapes: Vec<_> = items.iter().map(shape).collect();
            for (i, item) in items.iter().enumerate() {
                let cover = nearer.iter().copied().chain(&shapes[i + 1..]);
                let outline = filled(&minus(&shapes[i], cover), self.scale);
                let (Some(visible), Some(whole)) = (
                    bounds(&outline),
                    self.whole(&screen, *item, &silhouettes[solid]),
                ) else {
                    continue;
                };
                drawn.view.regions.push(Region {
                    name: None,
                    outline: outline.into(),
                    color: self.items[*item].color,
                    container: None,
                    is_line: false,
                });
                drawn.items.push(*item);
                drawn.hidden.push(1.0 - box_overlap(visible, whole));
            }
        }
        nest(&mut drawn.view.regions);
        drawn
    }

    /// The bounding box of an item as if nothing hid it.
    fn whole(&self, screen: &Screen, item: usize, solid: &Outline) -> Option<(DVec2, DVec2)> {
        let item = &self.items[item];
        let Some(ring) = &item.detail else {
            return bounds(solid);
        };
        let ring = ring
            .iter()
            .map(|p| screen.point(&self.solids[item.solid], *p));
        Some(
            ring.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| {
                (low.min(p), high.max(p))
            }),
        )
    }
}

struct Screen {
    axes: [DVec3; 3],
    scale: f64,
}

impl Screen {
    fn new(direction: Direction, scale: f64) -> Self {
        Self {
            axes: direction.axes(),
            scale,
        }
    }

    /// A point in a solid's own frame, on the drawing.
    fn point(&self, solid: &Solid, unit: DVec3) -> DVec2 {
        let p = solid.center + solid.axes * unit;
        DVec2::new(p.dot(self.axes[0]), -p.dot(self.axes[1])) * self.scale
    }

    fn solid(&self, solid: &Solid) -> Outline {
        let ring: Ring = match solid.form {
            Form::Ellipsoid => {
                let toward = self.toward(solid);
                let [a, b] = tangents(toward);
                let point = |i: usize| {
                    let (sin, cos) = turn(i, AROUND).sin_cos();
                    self.point(solid, a * cos + b * sin)
                };
                (0..AROUND).map(point).collect()
            }
            Form::Box => {
                let corner = |i: usize| {
                    let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
                    self.point(solid, DVec3::new(sign(1), sign(2), sign(4)))
                };
                convex_hull((0..8).map(corner).collect())
            }
        };
        resolve_overlaps(vec![ring], FillRule::NonZero)
    }

    /// In an ellipsoid's own frame, what faces the viewer lies on this side of its middle.
    fn toward(&self, solid: &Solid) -> DVec3 {
        (solid.axes.inverse() * self.axes[2]).normalize()
    }

    /// The part of a detail that faces the viewer.
    fn detail(&self, solid: &Solid, border: &[DVec3]) -> Outline {
        let toward = match solid.form {
            Form::Ellipsoid => self.toward(solid),
            Form::Box => {
                let facing = (solid.axes * DVec3::Z).dot(self.axes[2]);
                if facing <= 0.0 {
                    return Outline::default();
                }
                DVec3::ZERO
            }
        };
        let Some(first) = border.iter().position(|p| p.dot(toward) >= 0.0) else {
            return Outline::default();
        };
        let mut ring = Vec::new();
        let mut last = border[first];
        for i in 1..=border.len() {
            let p = border[(first + i) % border.len()];
            let (from, to) = (last.dot(toward), p.dot(toward));
            if (from < 0.0) != (to < 0.0) {
                let cut = last.lerp(p, from / (from - to)).normalize();
                // The edge where the surface turns away is a great circle.
                if from < 0.0
                    && let Some(&start) = ring.last()
                {
                    let start: DVec3 = start;
                    let step = |i: usize| start.lerp(cut, i as f64 / ALONG_EDGE as f64);
                    ring.extend((1..ALONG_EDGE).map(|i| step(i).normalize()));
                }
                ring.push(cut);
            }
            if to >= 0.0 {
                ring.push(p);
            }
            last = p;
        }
        let ring = ring.iter().map(|p| self.point(solid, *p)).collect();
        resolve_overlaps(vec![ring], FillRule::NonZero)
    }
}

fn minus<'a>(shape: &Outline, cover: impl Iterator<Item = &'a Outline>) -> Outline {
    let cut: Vec<_> = cover
        .map(|c| intersect(shape, c))
        .filter(|c| !c.polygons.is_empty())
        .collect();
    if cut.is_empty() {
        return shape.clone();
    }
    let cut = union(&cut);
    let polygons = shape.polygons.iter().chain(&cut.polygons);
    let rings = polygons.flat_map(|p| p.rings.iter().cloned()).collect();
    resolve_overlaps(rings, FillRule::EvenOdd)
}

/// The pieces without the holes that other regions make.
fn filled(outline: &Outline, scale: f64) -> Outline {
    let mut outline = outline.clone();
    for polygon in &mut outline.polygons {
        polygon.rings.truncate(1);
    }
    outline.polygons.retain(|p| {
        let one = Outline {
            polygons: vec![p.clone()],
        };
        area(&one) > LEAST_AREA * scale * scale
    });
    union(&[outline])
}

/// Finds each region's container.
fn nest(regions: &mut TiSlice<RegionId, Region>) {
    let boxes: TiVec<RegionId, _> = regions.iter().map(|r| bounds(&r.outline)).collect();
    let areas: TiVec<RegionId, _> = regions.iter().map(|r| area(&r.outline)).collect();
    for i in boxes.keys() {
        let Some((low, high)) = boxes[i] else {
            continue;
        };
        let margin = (high - low) * 0.05;
        let around = |j: &RegionId| {
            areas[*j] > areas[i]
                && boxes[*j].is_some_and(|(l, h)| {
                    l.cmple(low + margin).all() && h.cmpge(high - margin).all()
                })
                && area(&intersect(&regions[i].outline, &regions[*j].outline))
                    > CONTAINED * areas[i]
        };
        let container = boxes
            .keys()
            .filter(around)
            .min_by(|a, b| areas[*a].total_cmp(&areas[*b]));
        regions[i].container = container;
    }
}

fn box_overlap(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> f64 {
    let size = |(low, high): (DVec2, DVec2)| (high - low).max(DVec2::ZERO).element_product();
    let common = size((a.0.max(b.0), a.1.min(b.1)));
    common / (size(a) + size(b) - common)
}

fn turn(i: usize, of: usize) -> f64 {
    std::f64::consts::TAU * i as f64 / of as f64
}

/// Two directions across a third: right and up where there is one.
fn tangents(normal: DVec3) -> [DVec3; 2] {
    let up = if normal.y.abs() < 0.99 {
        DVec3::Y
    } else {
        -DVec3::Z
    };
    let right = up.cross(normal).normalize();
    [right, normal.cross(right)]
}
