//! Positions of frames and speeds in the picture.

use crate::math;

use std::ops::Range;

/// The edges of the curve's area.
pub(super) const LEFT: f64 = 84.0;
pub(super) const RIGHT: f64 = 936.0;
pub(super) const TOP: f64 = 92.0;
pub(super) const BOTTOM: f64 = 312.0;
/// The number of columns if there are more frames than fit.
const COLUMNS: usize = 852;

/// Maps frames and speeds to positions.
pub(super) struct Scale {
    /// The width of a frame.
    pub(super) wide: f64,
    /// The speed at the top.
    pub(super) top: f64,
}

impl Scale {
    /// The left edge of a frame.
    pub(super) fn x(&self, frame: f64) -> f64 {
        LEFT + frame * self.wide
    }

    pub(super) fn y(&self, speed: f64) -> f64 {
        // NaN counts as infinite.
        let share = if speed.is_nan() {
            1.0
        } else {
            (speed / self.top).clamp(0.0, 1.0)
        };
        BOTTOM - share * (BOTTOM - TOP)
    }

    pub(super) fn middle(&self, frame: usize) -> f64 {
        self.x(frame as f64 + 0.5)
    }
}

/// The next larger number of the form 1, 2 or 5 times a power of ten.
pub(super) fn step(least: f64) -> f64 {
    // Dividing by smaller numbers would overflow.
    let least = if least > 1e-280 { least } else { 1.0 };
    let power = 10_f64.powi(math::log10(least).floor() as i32);
    let steps = [1.0, 2.0, 5.0].map(|step| step * power);
    let next = steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9));
    next.unwrap_or(10.0 * power)
}

/// A number with no more digits than necessary.
pub(super) fn number(value: f64) -> String {
    let rounded = format!("{value:.4e}").parse().unwrap_or(value);
    match rounded {
        0.0 => "0".to_owned(),
        _ if !(1e-3..1e6).contains(&rounded) => format!("{rounded:e}"),
        _ => format!("{rounded}"),
    }
}

/// Splits the frames into columns: one frame each, or all those of one pixel.
pub(super) fn columns(frames: usize) -> impl Iterator<Item = Range<usize>> {
    let count = if frames > 2 * COLUMNS {
        COLUMNS
    } else {
        frames
    };
    (0..count).map(move |column| column * frames / count..(column + 1) * frames / count)
}
