//! Where frames and speeds stand in the picture.

use std::ops::Range;

/// Where the curve stands: left, right, top, bottom.
pub(super) const LEFT: f64 = 84.0;
pub(super) const RIGHT: f64 = 936.0;
pub(super) const TOP: f64 = 92.0;
pub(super) const BOTTOM: f64 = 312.0;
/// Columns of frames that are drawn as one where there are more frames.
const COLUMNS: usize = 852;

/// Where frames and speeds stand.
pub(super) struct Scale {
    /// Of a frame.
    pub(super) wide: f64,
    /// The speed at the top.
    pub(super) top: f64,
}

impl Scale {
    /// Where a frame begins.
    pub(super) fn x(&self, frame: f64) -> f64 {
        LEFT + frame * self.wide
    }

    pub(super) fn y(&self, speed: f64) -> f64 {
        // What is no number is taken as infinite.
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

/// The step of 1, 2 or 5 times a power of ten that is next above.
pub(super) fn step(least: f64) -> f64 {
    // What is smaller cannot be divided by without trouble.
    let least = if least > 1e-280 { least } else { 1.0 };
    let power = 10_f64.powi(least.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0].map(|step| step * power);
    let next = steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9));
    next.unwrap_or(10.0 * power)
}

/// A number without more digits than it needs.
pub(super) fn number(value: f64) -> String {
    let rounded = format!("{value:.4e}").parse().unwrap_or(value);
    match rounded {
        0.0 => "0".to_owned(),
        _ if !(1e-3..1e6).contains(&rounded) => format!("{rounded:e}"),
        _ => format!("{rounded}"),
    }
}

/// The frames by columns: each frame for itself, or those of one pixel.
pub(super) fn columns(frames: usize) -> impl Iterator<Item = Range<usize>> {
    let count = if frames > 2 * COLUMNS {
        COLUMNS
    } else {
        frames
    };
    (0..count).map(move |column| column * frames / count..(column + 1) * frames / count)
}
