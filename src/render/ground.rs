//! The invisible ground: shadows that fall on it, and lines that show how the camera moves over it.

use std::sync::OnceLock;

use crate::math;
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::camera::{Camera, on_level};
use super::coverage::Coverage;
use super::lanes::Hit;
use super::light::{CELL, Lights};
use super::shade::ground_light;
use super::surface::Surface;
use super::trace::Tracer;

/// How far from the model its shadow is visible, relative to the normalised model.
const SHADOW_REACH: f32 = 0.65;
/// The width of a line, relative to the distance of two lines.
const LINE_WIDTH: f32 = 0.04;
/// The opacity of the lines.
const LINE_OPACITY: f32 = 0.45;
/// The colour of the lines, linear: a grey that is visible on black and on white.
const LINE_COLOR: f32 = 0.2;
/// How many lines there are in the length of the figure, roughly.
const LINES: f64 = 4.0;
/// Where the lines begin to fade, and where they end, relative to the length of the figure.
const LINES_FADE: [f32; 2] = [0.5, 1.5];

/// How strong the model's shadow is at a point on the ground: it fades with the distance from the model.
#[inline]
pub(super) fn shadow_fade(place: Vec3, model: &Surface) -> f32 {
    let beside = (model.low - place).max(place - model.high).max(Vec3::ZERO);
    let share = 1.0 - (Vec2::new(beside.x, beside.z).length() / SHADOW_REACH).min(1.0);
    smooth(share)
}

/// Smoothstep.
#[inline]
fn smooth(share: f32) -> f32 {
    share * share * (3.0 - 2.0 * share)
}

/// A point of the lattice on the ground.
struct LatticePoint {
    place: Vec3,
    /// The share of the light that reaches it, 0 to 1, once it is asked for.
    light: OnceLock<f32>,
    /// Whether the camera sees it. Where the model covers the ground it is dark, which must not show beside the model.
    is_seen: bool,
}

/// The light on the ground in a picture, on a lattice of points.
pub(super) struct GroundLight<'a> {
    tracer: &'a Tracer<'a>,
    lights: &'a Lights,
    spacing: u32,
    columns: usize,
    /// Rows from the top; `None` where no shadow is visible. The first row and column lie outside the picture.
    own: Vec<Option<LatticePoint>>,
    /// The share of the light that is shown at each point, 0 to 1, which is gathered from its neighbours. Of points behind the model it is found
    /// once a pixel beside them shows the ground after all, as a gap in the model does: most are never asked for.
    shown: Vec<OnceLock<f32>>,
}

impl<'a> GroundLight<'a> {
    /// The light on the ground below the model in a picture of `size` pixels.
    pub(super) fn new(
        tracer: &'a Tracer<'a>,
        lights: &'a Lights,
        camera: &Camera,
        coverage: &Coverage,
        size: [u32; 2],
        spacing: u32,
    ) -> Self {
        // One point before the picture and two behind it: pixels interpolate, and points gather from their neighbours.
        let [columns, rows] = size.map(|side| (side.div_ceil(spacing) + 4) as usize);
        let level = tracer.surface.low.y;
        let is_covered = |point: [usize; 2]| {
            let [x, y] = point.map(|place| place.saturating_sub(1) as u32 * spacing);
            coverage.contains(x, y)
        };
        let at = |index: usize| {
            let [column, row] = [index % columns, index / columns];
            let pixel = |point: usize| (point as f32 - 1.0) * spacing as f32;
            let (origin, direction) = camera.ray(Vec2::new(pixel(column), pixel(row)));
            let distance = on_level(origin, direction, level)?;
            let place = origin + direction * distance;
            if shadow_fade(place, &tracer.surface) <= 0.0 {
                return None;
            }
            let hides = |hit: Hit| hit.distance < distance;
            let is_hidden = is_covered([column, row])
                && tracer.closest(origin, direction, 0.0).is_some_and(hides);
            Some(LatticePoint {
                place,
                light: OnceLock::new(),
                is_seen: !is_hidden,
            })
        };
        let mut ground = Self {
            tracer,
            lights,
            spacing,
            columns,
            own: (0..columns * rows).into_par_iter().map(at).collect(),
            shown: Vec::new(),
        };
        let seen = |index| {
            let light = ground.gathered(index, |point| point.is_seen);
            light.map_or_else(OnceLock::new, OnceLock::from)
        };
        ground.shown = (0..columns * rows).into_par_iter().map(seen).collect();
        ground
    }

    /// The share of the light that reaches a point itself, 0 to 1.
    fn light(&self, index: usize, point: &LatticePoint) -> f32 {
        *point.light.get_or_init(|| {
            let [column, row] = [index % self.columns, index / self.columns];
            let share = (row % CELL as usize) * CELL as usize + column % CELL as usize;
            let incident = self.lights.on_ground(self.tracer, point.place, share);
            ground_light(&incident, self.lights)
        })
    }

    /// The light of a point and of those around it that count, so that each of the rays of a cell has the same weight.
    fn gathered(&self, index: usize, counts: fn(&LatticePoint) -> bool) -> Option<f32> {
        let [column, row] = [index % self.columns, index / self.columns];
        let mut sum = 0.0;
        let mut weights = 0.0;
        for (y, high) in [(row.wrapping_sub(1), 1.0), (row, 2.0), (row + 1, 1.0)] {
            for (x, wide) in [
                (column.wrapping_sub(1), 1.0),
                (column, 2.0),
                (column + 1, 1.0),
            ] {
                if x >= self.columns || y >= self.own.len() / self.columns {
                    continue;
                }
                let neighbor = y * self.columns + x;
                let point = self.own[neighbor].as_ref().filter(|point| counts(point));
                if let Some(point) = point {
                    sum += self.light(neighbor, point) * high * wide;
                    weights += high * wide;
                }
            }
        }
        (weights > 0.0).then(|| sum / weights)
    }

    /// The share of the light that is shown at a point, 0 to 1.
    fn shown(&self, index: usize) -> f32 {
        *self.shown[index].get_or_init(|| self.gathered(index, |_| true).unwrap_or(1.0))
    }

    /// The share of the light that reaches the middle of a pixel, 0 to 1.
    #[inline]
    pub(super) fn at(&self, x: u32, y: u32) -> f32 {
        let place = |pixel: u32| (pixel as f32 + 0.5) / self.spacing as f32 + 1.0;
        let (x, y) = (place(x), place(y));
        let (column, row) = (x as usize, y as usize);
        let (right, down) = (x.fract(), y.fract());
        let between = |row: usize| {
            let first = row * self.columns + column;
            self.shown(first) * (1.0 - right) + self.shown(first + 1) * right
        };
        between(row) * (1.0 - down) + between(row + 1) * down
    }
}

/// A grid of lines on the ground, fixed in the world. In normalised space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Floor {
    /// Where two lines cross.
    crossing: Vec2,
    /// The distance of two lines.
    cell: f32,
    /// In the middle of the visible part.
    middle: Vec2,
    /// The length of the figure.
    length: f32,
}

impl Floor {
    /// Lines around a figure of some length at `middle`, which is given by its x and z. `origin` is that of the world,
    /// `scale` the factor from metres.
    pub(super) fn new(origin: Vec2, scale: f64, middle: Vec2, length: f32) -> Self {
        let cell = (round_length(f64::from(length) / scale / LINES) * scale) as f32;
        let cell = if cell.is_normal() { cell } else { 1.0 };
        Self {
            crossing: origin,
            cell,
            middle,
            length,
        }
    }

    /// How visible the lines are at a point on the ground.
    pub(super) fn fade(&self, place: Vec3) -> f32 {
        let [near, far] = LINES_FADE.map(|share| share * self.length);
        let distance = Vec2::new(place.x, place.z).distance(self.middle);
        smooth(((far - distance) / (far - near)).clamp(0.0, 1.0))
    }

    /// The share of the pixel at `pixel` that lines cover, with their opacity, where a camera sees the ground at `level`.
    pub(super) fn opacity(&self, camera: &Camera, pixel: Vec2, level: f32) -> f32 {
        let on_floor = |place: Vec2| {
            let place = camera.on_level(place, level)?;
            Some((Vec2::new(place.x, place.z) - self.crossing) / self.cell)
        };
        let corners = [pixel, pixel + Vec2::X, pixel + Vec2::Y].map(on_floor);
        let [Some(here), Some(right), Some(down)] = corners else {
            return 0.0;
        };
        let width = ((right - here).abs() + (down - here).abs()).max(Vec2::splat(1e-4));
        let clear = |axis: usize| 1.0 - lines_within(here[axis], width[axis]);
        let Some(middle) = camera.on_level(pixel, level) else {
            return 0.0;
        };
        (1.0 - clear(0) * clear(1)) * LINE_OPACITY * self.fade(middle)
    }
}

/// The nearest length of the series 1, 2, 5, 10, 20 and so on.
fn round_length(length: f64) -> f64 {
    let power = math::powf(10_f64, math::log10(length).floor());
    let digits = match length / power {
        ..1.5 => 1.0,
        ..3.5 => 2.0,
        ..7.5 => 5.0,
        _ => 10.0,
    };
    digits * power
}

/// The share of an interval around `place` that lines cover, which are [`LINE_WIDTH`] wide at all whole numbers.
fn lines_within(place: f32, width: f32) -> f32 {
    // The length that lines cover up to a point.
    let until = |end: f32| {
        let end = end + LINE_WIDTH / 2.0;
        end.floor() * LINE_WIDTH + (end - end.floor()).min(LINE_WIDTH)
    };
    ((until(place + width / 2.0) - until(place - width / 2.0)) / width).clamp(0.0, 1.0)
}

/// Premultiplied colour and alpha of a shadow on lines, each of some opacity.
pub(super) fn shadow_on_lines(shadow: f32, lines: f32) -> Vec4 {
    let color = LINE_COLOR * lines * (1.0 - shadow);
    Vec3::splat(color).extend(shadow + lines * (1.0 - shadow))
}
