//! What a solid lies on, and how far it has to come out in front of that.

use glam::{DAffine2, DVec2};

use super::cover::flat;
use super::growth::Growth;
use super::rim::Rim;
use super::{BodyHeights, Lay, LayForm};
use crate::geometry::{EdgeRanges, Intervals, LINES, Outline, Scanlines, bounds};
use crate::solid::Solid;
use crate::solid::heights::Heights;
use crate::solid::inflate::Mesh;

/// A body that another one lies on or around, as seen from that.
pub(super) struct BodyInFrame {
    pub(super) body: BodyHeights,
    /// From the frame of the body that lies on it to its own.
    pub(super) to: DAffine2,
    pub(super) is_given: bool,
    pub(super) is_detail: bool,
}

/// What a solid lies on, around and behind.
pub(super) struct Ground {
    /// The topmost first.
    below: Vec<BodyInFrame>,
    /// Indices into `below`: the bodies that are volumes, and the bodies that others do not hide from the front.
    volumes: Vec<usize>,
    visible: Vec<usize>,
    pub(super) wraps: Vec<BodyInFrame>,
    pub(super) behind: Vec<BodyInFrame>,
}

impl BodyInFrame {
    /// The front over a point, where the body is, and the number of the triangle there.
    pub(super) fn front(&self, point: DVec2) -> Option<(f64, u32)> {
        self.body.front(self.to.transform_point2(point))
    }

    pub(super) fn back(&self, point: DVec2) -> Option<f64> {
        self.body.back(self.to.transform_point2(point))
    }

    /// The depths of the back at the farthest and of the front at the nearest.
    pub(super) fn depths(&self) -> [f64; 2] {
        let [front, back] = self.body.sides().map(Heights::highest);
        let BodyHeights { depth, factor, .. } = self.body;
        [depth - factor * back, depth + factor * front]
    }

    pub(super) fn front_heights(&self) -> &Heights {
        self.body.sides()[0]
    }

    pub(super) fn back_heights(&self) -> &Heights {
        self.body.sides()[1]
    }

    /// Where a line crosses edges of the front, as shares of its length: in no order, some of them several times.
    pub(super) fn crossings(&self, from: DVec2, to: DVec2, found: &mut Vec<f64>) {
        let [from, to] = [from, to].map(|point| self.to.transform_point2(point));
        self.front_heights().crossings(from, to, found);
    }

    /// The same for both sides.
    pub(super) fn all_crossings(&self, from: DVec2, to: DVec2) -> Vec<f64> {
        let mut found = Vec::new();
        self.crossings(from, to, &mut found);
        let [from, to] = [from, to].map(|point| self.to.transform_point2(point));
        self.back_heights().crossings(from, to, &mut found);
        found
    }

    /// The corners of one side's triangles that are in a box.
    pub(super) fn corners(
        &self,
        [low, high]: [DVec2; 2],
        side: fn(&Self) -> &Heights,
    ) -> impl Iterator<Item = DVec2> {
        let back = self.to.inverse();
        let corners = side(self).corners();
        let corners = corners.map(move |corner| back.transform_point2(corner));
        corners.filter(move |corner| corner.clamp(low, high) == *corner)
    }
}

impl Ground {
    /// What a solid with this outline lies on, the topmost first, around and behind.
    pub(super) fn new(
        below: Vec<BodyInFrame>,
        wraps: Vec<BodyInFrame>,
        behind: Vec<BodyInFrame>,
        outline: &Outline,
    ) -> Self {
        let volumes = (0..below.len()).filter(|index| !below[*index].is_detail);
        Self {
            volumes: volumes.collect(),
            visible: visible(&below, outline),
            below,
            wraps,
            behind,
        }
    }

    /// The bodies that it lies on, without those that others hide from the front.
    pub(super) fn visible(&self) -> impl Iterator<Item = &BodyInFrame> {
        self.visible.iter().map(|index| &self.below[*index])
    }

    /// The front of what lies below a point.
    pub(super) fn front(&self, point: DVec2) -> Option<f64> {
        let mut highest = Highest::default();
        for body in &self.below {
            highest.add(body, body.front(point));
            if highest.is_final {
                break;
            }
        }
        highest.front
    }

    /// What lies below a point of a solid that adds this share of its own heights to those of volumes.
    fn below(&self, point: DVec2, bulge: f64) -> Option<Below> {
        let (mut all, mut volumes) = (Highest::default(), Highest::default());
        let mut triangle = None;
        for (index, body) in self.below.iter().enumerate() {
            if body.is_detail && all.is_final {
                continue;
            }
            let found = body.front(point);
            all.add(body, found);
            if !body.is_detail {
                volumes.add(body, found);
            }
            if volumes.is_final || (all.is_final && bulge == 0.0) {
                triangle = found.filter(|_| index == 0).map(|(_, triangle)| triangle);
                break;
            }
        }
        Some(Below {
            front: all.front?,
            volumes: volumes.front,
            triangle,
        })
    }

    /// The index of the topmost volume below a point.
    pub(super) fn top(&self, point: DVec2) -> Option<usize> {
        let mut volumes = self.volumes.iter();
        volumes
            .find(|index| self.below[**index].front(point).is_some())
            .copied()
    }

    /// The depth of the nearest border of what lies directly below.
    fn nearest(&self, point: DVec2) -> Option<f64> {
        let nearest = |body: &BodyInFrame| body.body.nearest_front(body.to.transform_point2(point));
        self.volumes
            .first()
            .and_then(|index| nearest(&self.below[*index]))
    }
}

/// The highest front over a point, of bodies that are added in their order, the topmost first.
#[derive(Default)]
struct Highest {
    front: Option<f64>,
    /// Whether nothing below can be higher.
    is_final: bool,
}

impl Highest {
    /// Adds a body with its front over the point.
    fn add(&mut self, body: &BodyInFrame, front: Option<(f64, u32)>) {
        if let Some((front, _)) = front.filter(|_| !self.is_final) {
            self.front = Some(self.front.map_or(front, |highest| highest.max(front)));
            // What is not given comes out in front of all that is below it itself.
            self.is_final = !body.is_given;
        }
    }
}

/// Those of the bodies below an outline, the topmost first, that can be seen from the front, as far as a number of points tell.
fn visible(below: &[BodyInFrame], outline: &Outline) -> Vec<usize> {
    if below.len() < 2 {
        return (0..below.len()).collect();
    }
    let Some((low, high)) = bounds(outline) else {
        return Vec::new();
    };
    let lines = Scanlines::across((low, high));
    let mut inside = Intervals::default();
    lines.cut(outline, &EdgeRanges::new(outline), &mut inside);
    let apart = (high.x - low.x) / (4 * LINES) as f64;
    let mut points = Vec::new();
    inside.spread(apart, |line, x, _| {
        points.push(DVec2::new(x, lines.place(line)))
    });
    let mut visible = Vec::new();
    for (index, body) in below.iter().enumerate() {
        let mut is_visible = false;
        points.retain(|point| {
            let is_over = body.front(*point).is_some();
            is_visible |= is_over;
            !is_over || body.is_given
        });
        if is_visible {
            visible.push(index);
        }
    }
    visible
}

/// A solid by itself.
pub(super) enum Own<'a> {
    /// A line has no heights of its own.
    Line,
    /// One whose heights are looked up.
    Body(BodyHeights),
    /// One whose heights are known over every mesh of its outline, with the factor by which they are multiplied.
    Field(&'a Solid, f64),
}

/// What the height fields of a solid are to be.
pub(super) struct Target<'a> {
    /// The solid by itself.
    pub(super) own: Own<'a>,
    /// The depth of its plane.
    pub(super) depth: f64,
    pub(super) lay: &'a Lay,
    pub(super) ground: &'a Ground,
    /// Where a line is a hoop around what it lies on.
    pub(super) rim: Option<Rim>,
    /// How many points of the mesh may be spent on following the ground.
    pub(super) growth: Growth,
}

/// What lies below a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Below {
    /// Its front.
    pub(super) front: f64,
    /// The front of the volumes there.
    volumes: Option<f64>,
    /// The triangle of the topmost body, if nothing else matters there.
    pub(super) triangle: Option<u32>,
}

/// The target over a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    pub(super) front: f64,
    pub(super) back: f64,
    /// How far the solid by itself reaches to the front.
    pub(super) reach: f64,
    /// What lies below, if something does.
    pub(super) below: Option<Below>,
}

impl Target<'_> {
    /// How far the solid by itself reaches to the front and to the back, unless that is known for meshes alone.
    pub(super) fn reach(&self, point: DVec2) -> Option<[f64; 2]> {
        match &self.own {
            Own::Line => Some([0.0; 2]),
            Own::Body(own) => Some(self.formed(point, own.reach(point))),
            Own::Field(..) => None,
        }
    }

    /// How far it reaches by its form, where by its heights it reaches this far.
    fn formed(&self, point: DVec2, mut reach: [f64; 2]) -> [f64; 2] {
        if let Some((girth, to_drawing)) = &self.lay.girth {
            let scale = to_drawing.matrix2.determinant().abs().sqrt();
            let own = reach.map(|reach| reach * scale);
            let around = girth.reach(to_drawing.transform_point2(point), own);
            reach = around.map(|reach| reach / scale);
        }
        match &self.lay.toes {
            Some(toes) => toes.reach(point, reach),
            None => reach,
        }
    }

    /// The same over the points of a mesh of its outline.
    pub(super) fn reaches(&self, mesh: &Mesh) -> Vec<[f64; 2]> {
        if let Own::Field(solid, factor) = self.own
            && let Some(heights) = solid.heights_over(mesh)
        {
            let points = mesh.points.iter().zip(heights);
            let reach =
                |(point, height): (&[f32; 2], f64)| self.formed(flat(point), [height * factor; 2]);
            return points.map(reach).collect();
        }
        let reach = |point: &[f32; 2]| self.reach(flat(point)).unwrap_or_default();
        mesh.points.iter().map(reach).collect()
    }

    /// The front of what lies below a point.
    pub(super) fn below(&self, point: DVec2) -> Option<f64> {
        self.ground.front(point)
    }

    /// The front of the hoop that a line is at a point; -∞ where it is none.
    pub(super) fn rim(&self, point: DVec2) -> f64 {
        let front = self.rim.as_ref().and_then(|rim| rim.front(point));
        front.unwrap_or(f64::NEG_INFINITY)
    }

    /// The depth of the nearest border of what it lies on.
    fn beside(&self, point: DVec2) -> f64 {
        self.ground.nearest(point).unwrap_or(self.depth)
    }

    /// What lies below a point, and the depth that it lifts this solid to, which by itself reaches this far to the front there,
    /// and whose hoop reaches to `rim`.
    pub(super) fn lifted(&self, point: DVec2, rim: f64, reach: f64) -> Option<(Below, f64)> {
        let Lay { step, bulge, .. } = self.lay;
        let below = self.ground.below(point, *bulge)?;
        let volumes = below.volumes.filter(|_| *bulge > 0.0);
        let on_volumes = volumes.map_or(f64::NEG_INFINITY, |volumes| volumes + bulge * reach);
        Some((below, on_volumes.max(below.front + step).max(rim)))
    }

    /// Whether what lies below a point lifts the solid there.
    pub(super) fn lifts(&self, point: DVec2) -> bool {
        let [front, _] = self.reach(point).unwrap_or_default();
        let lifted = self.lifted(point, self.rim(point), front);
        lifted.is_some_and(|(_, lifted)| lifted > self.depth + front)
    }

    /// Whether the front, if it is lifted, is a plane over the triangle between points with these levels: over one triangle of
    /// what lies below, by the same rule.
    pub(super) fn is_plane(&self, levels: &[Level; 3]) -> bool {
        let Lay { step, bulge, .. } = self.lay;
        let triangles = levels.map(|level| level.below.and_then(|below| below.triangle));
        let bulges = levels.map(|level| bulge * level.reach > *step);
        self.rim.is_none()
            && triangles[0].is_some()
            && triangles.iter().all(|triangle| *triangle == triangles[0])
            && bulges.iter().all(|is_bulging| *is_bulging == bulges[0])
    }

    /// Whether anything makes the solid differ from what it is by itself, as far as these points of it tell.
    pub(super) fn is_lifting(&self, points: &[DVec2]) -> bool {
        let Ground { wraps, behind, .. } = self.ground;
        self.lay.form != LayForm::Volume
            || points.is_empty()
            || self.lay.clips
            || self.lay.toes.is_some()
            || self.lay.girth.is_some()
            || !wraps.is_empty()
            || !behind.is_empty()
            || points.iter().any(|point| self.lifts(*point))
    }

    /// The back where the front is here, if the solid reaches as far to the back as to the front.
    pub(super) fn mirrored(&self, front: f64) -> Option<f64> {
        let is_symmetric = self.lay.is_symmetric && self.lay.form == LayForm::Volume;
        is_symmetric.then_some(2.0 * self.depth - front)
    }

    /// The target over a point where the solid by itself reaches this far to the front and to the back.
    pub(super) fn at(&self, point: DVec2, [reach, back]: [f64; 2]) -> Level {
        let Lay {
            step, bulge, form, ..
        } = self.lay;
        let rim = self.rim(point);
        let (below, lifted) = self.lifted(point, rim, reach).unzip();
        let natural = [self.depth + reach, self.depth - back];
        let [front, back] = match (form, lifted, below.map(|below| below.front)) {
            (LayForm::Volume, lifted, below) => {
                let front = natural[0].max(lifted.unwrap_or(rim));
                // A line climbs onto what it begins on, where a shape would reach down to its plane like a wall.
                let is_climbing = self.lay.is_line && front > natural[0];
                let thickness = if is_climbing {
                    reach + back + step
                } else {
                    f64::INFINITY
                };
                let back = natural[1].max(front - thickness);
                // An arm in front of a trunk is fixed to it at its joint.
                let is_root = |root: f64| point.length_squared() < root * root;
                let fixed = self.lay.root.filter(|root| is_root(*root)).and(below);
                [front, fixed.map_or(back, |below| back.min(below - step))]
            }
            (LayForm::Sheet, lifted, _) => [lifted.unwrap_or(natural[0]); 2],
            (LayForm::DeepSkin, Some(lifted), Some(below)) => [lifted, below - step - back],
            (_, Some(lifted), Some(below)) => [lifted, below - step],
            (LayForm::Ink, ..) => {
                let beside = self.beside(point);
                [rim.max(beside + step), beside - step]
            }
            _ => {
                let bulge = bulge * reach;
                [
                    (self.depth + bulge.max(*step)).max(rim),
                    self.depth - back.min(bulge + step),
                ]
            }
        };
        let behind = |bodies: &[BodyInFrame]| {
            let backs = bodies.iter().filter_map(|body| body.back(point));
            backs.reduce(f64::min)
        };
        let around = behind(&self.ground.wraps);
        let around = around.map(|around| around - step - bulge * (natural[0] - self.depth));
        let covered = behind(&self.ground.behind).map(|covered| covered - step);
        // A hoop is as deep behind the border that it is around as in front of it.
        let hoop = rim.is_finite().then(|| 2.0 * self.beside(point) - rim);
        let other_side = self.mirrored(front);
        let lower = around.into_iter().chain(covered).chain(hoop);
        let lower = lower.chain(other_side);
        let back = lower.fold(back, f64::min);
        Level {
            front,
            back,
            reach,
            below,
        }
    }
}
