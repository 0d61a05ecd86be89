//! Draws gradients in their own plane (SVG 2, section 14.2).
//!
//! Colours are computed here rather than by a rasteriser: transparent pixels keep their colours, because alpha is not
//! premultiplied, and the few operations used give the same bits on every machine.

use crate::math;
use glam::{DAffine2, DVec2};
use image::{Rgba, RgbaImage};

/// Rows of a linear gradient's image: the block size of texture compression.
pub(super) const ROWS: u32 = 4;
/// Pixels along a linear gradient: normally, and with sharp edges.
const ROW: [u32; 2] = [256, 1024];
/// Pixels across the end circle of a radial gradient: normally, and with sharp edges.
const SIDE: [u32; 2] = [128, 512];
/// The largest number of pixels along a side.
const MAX_SIDE: u32 = 1024;
/// How far a radial gradient is drawn beyond its end circle at most, in its radii.
const MAX_REACH: f64 = 32.0;
/// Different stops nearer than this are a sharp edge.
const SHARP: f64 = 1.0 / 64.0;

/// How a gradient continues beyond its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// With the colour of the end.
    Pad,
    /// Repeated, alternately reversed.
    Reflect,
    /// Repeated.
    Repeat,
}

/// A colour stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Its offset, 0 to 1.
    pub offset: f64,
    /// sRGB and straight alpha, each 0 to 255.
    pub color: [f64; 4],
}

/// A gradient without its position.
#[derive(Debug, Clone, PartialEq)]
pub struct Gradient {
    /// In ascending order, at least one.
    pub stops: Vec<Stop>,
    /// How it continues beyond its ends.
    pub spread: Spread,
}

/// The circle that a radial gradient starts from; the one it ends at is the unit circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Focus {
    /// The x coordinate of its centre.
    pub x: f64,
    /// The y coordinate of its centre.
    pub y: f64,
    /// Its radius.
    pub radius: f64,
}

/// The extent to draw for a gradient that must reach `far`: powers of two, so that parts of many sizes share images.
pub(super) fn reach(far: f64) -> f64 {
    let mut reach = 1.0;
    while reach < far && reach < MAX_REACH {
        reach *= 2.0;
    }
    reach
}

impl Gradient {
    pub(super) fn key(&self, key: &mut Vec<u64>) {
        let Self { stops, spread } = self;
        key.push(*spread as u64);
        for Stop { offset, color } in stops {
            key.push(offset.to_bits());
            key.extend(color.map(f64::to_bits));
        }
    }

    fn is_sharp(&self) -> bool {
        let near = |pair: &[Stop]| {
            pair[1].offset - pair[0].offset < SHARP && pair[0].color != pair[1].color
        };
        self.stops.windows(2).any(near)
    }

    /// Pixels along a linear gradient.
    pub(super) fn row(&self) -> u32 {
        ROW[usize::from(self.is_sharp())]
    }

    /// Pixels along a side of a radial gradient's square.
    pub(super) fn side(&self, reach: f64) -> u32 {
        let side = SIDE[usize::from(self.is_sharp())];
        (side * reach.min(16.0) as u32).min(MAX_SIDE)
    }

    /// Whether a radial gradient has a constant colour outside its end circle.
    pub(super) fn is_bounded(&self, focus: Focus) -> bool {
        let inside = math::hypot(focus.x, focus.y) + focus.radius < 1.0;
        self.spread == Spread::Pad && inside
    }

    /// From a linear gradient's own plane to its image.
    pub(super) fn row_map(&self, width: f64) -> DAffine2 {
        let (scale, start) = match self.spread {
            // The ends lie at the centres of the outermost pixels, which the sampler repeats.
            Spread::Pad => ((width - 1.0) / width, 0.5 / width),
            Spread::Reflect | Spread::Repeat => (1.0, 0.0),
        };
        DAffine2::from_cols(DVec2::new(scale, 0.0), DVec2::ZERO, DVec2::new(start, 0.5))
    }

    /// The image of a linear gradient.
    pub(super) fn bake_row(&self, width: u32, height: u32) -> RgbaImage {
        let to_row = self.row_map(f64::from(width));
        let (scale, start) = (to_row.matrix2.x_axis.x, to_row.translation.x);
        let row: Vec<Rgba<u8>> = (0..width)
            .map(|x| {
                let u = (f64::from(x) + 0.5) / f64::from(width);
                self.color((u - start) / scale)
            })
            .collect();
        RgbaImage::from_fn(width, height, |x, _| row[x as usize])
    }

    /// The image of a radial gradient.
    pub(super) fn bake_square(&self, focus: Focus, reach: f64, side: u32) -> RgbaImage {
        let own = |pixel: u32| ((f64::from(pixel) + 0.5) / f64::from(side) * 2.0 - 1.0) * reach;
        let last = self.color(1.0);
        RgbaImage::from_fn(side, side, |x, y| {
            // The sampler repeats the outermost pixels.
            let border = [x, y].iter().any(|at| *at == 0 || *at == side - 1);
            if border && self.is_bounded(focus) {
                return last;
            }
            match focus.along(DVec2::new(own(x), own(y))) {
                Some(t) => self.color(self.spread(t)),
                // Outside the cone of two circles neither of which contains the other.
                None => last,
            }
        })
    }

    /// Maps an offset to between 0 and 1.
    fn spread(&self, t: f64) -> f64 {
        match self.spread {
            Spread::Pad => t.clamp(0.0, 1.0),
            Spread::Repeat => t - t.floor(),
            Spread::Reflect => {
                let twice = t - 2.0 * (t / 2.0).floor();
                if twice > 1.0 { 2.0 - twice } else { twice }
            }
        }
    }

    /// The colour at an offset between 0 and 1.
    fn color(&self, t: f64) -> Rgba<u8> {
        let next = self.stops.partition_point(|stop| stop.offset <= t);
        let color = match (next.checked_sub(1), self.stops.get(next)) {
            (Some(before), Some(after)) => {
                let before = &self.stops[before];
                let share = (t - before.offset) / (after.offset - before.offset);
                let between =
                    |i: usize| before.color[i] + (after.color[i] - before.color[i]) * share;
                [0, 1, 2, 3].map(between)
            }
            (None, Some(stop)) => stop.color,
            (Some(last), None) => self.stops[last].color,
            (None, None) => [0.0; 4],
        };
        Rgba(color.map(|channel| channel.round() as u8))
    }
}

impl Focus {
    /// The offset of a point: the largest `t` whose circle, between this one and the unit circle, passes through it.
    fn along(self, point: DVec2) -> Option<f64> {
        let focus = DVec2::new(self.x, self.y);
        let from = point - focus;
        let (scale_of, moves) = (1.0 - self.radius, -focus);
        let a = moves.dot(moves) - scale_of * scale_of;
        let b = from.dot(moves) + self.radius * scale_of;
        let c = from.dot(from) - self.radius * self.radius;
        let fits = |t: &f64| t.is_finite() && self.radius + t * scale_of >= 0.0;
        if a.abs() < 1e-9 {
            return Some(c / (2.0 * b)).filter(fits);
        }
        let root = b * b - a * c;
        if root < 0.0 {
            return None;
        }
        let root = root.sqrt();
        let roots = [(b + root) / a, (b - root) / a];
        roots.into_iter().filter(fits).reduce(f64::max)
    }
}
