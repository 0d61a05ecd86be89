//! What is seen where, by itself: no light, no neighbours, one ray a pixel.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::camera::View;
use super::stage::{Posed, Stage};
use super::trace::{Rays, Tracer};
use super::{RenderError, SIZE_LIMIT};

/// Rows that one thread looks at, at a time.
const ROWS: usize = 16;
/// The most surfaces that a ray goes through where nothing of them is.
const LAYERS: usize = 64;

/// The rectangle that a picture in parallel projection shows, in metres: on the plane through the world's origin that the
/// camera looks at squarely, to the right of the origin and above it, as the camera sees right and up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// How far to the right of the origin the left edge is.
    pub left: f64,
    /// How far above the origin the top edge is.
    pub top: f64,
    /// From the left edge to the right one.
    pub width: f64,
    /// From the top edge to the bottom one.
    pub height: f64,
}

/// What is seen at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// The number of its material in the file; none if it has none.
    pub material: Option<usize>,
    /// Its base colour and alpha there, linear, each 0 to 1: factor, texture and vertex colour. Light changes nothing.
    pub base: [f32; 4],
}

impl Stage<'_> {
    /// What is seen at the middle of each pixel in parallel projection, rows from the top; none where nothing is.
    ///
    /// What alpha makes quite clear is looked through, what it makes half clear is not. `bend` is as in
    /// [`Options`](super::Options). Pixels may be wider than high: `size` alone says into how many the window is cut.
    ///
    /// # Errors
    /// A size out of range.
    pub fn seen(
        &self,
        view: View,
        bend: bool,
        window: Window,
        [width, height]: [u32; 2],
    ) -> Result<Vec<Option<Seen>>, RenderError> {
        let fits = |side: u32| (1..=SIZE_LIMIT).contains(&side);
        if !fits(width) || !fits(height) {
            return Err(RenderError::Size(width, height));
        }
        let frame = self.frame();
        let [right, up, towards] = view.axes();
        let pixel = [
            window.width / f64::from(width),
            window.height / f64::from(height),
        ];
        let look = |posed: &Posed<'_>| {
            let tracer = &posed.tracer;
            let (low, high) = (tracer.surface.low, tracer.surface.high);
            // In front of all that there is.
            let away = 1.0 + low.abs().max(high.abs()).length();
            let at = |row: u32, column: u32| {
                let x = window.left + (f64::from(column) + 0.5) * pixel[0];
                let y = window.top - (f64::from(row) + 0.5) * pixel[1];
                let place = frame.place(right * x + up * y);
                let place = place - towards * place.dot(towards) + towards * f64::from(away);
                first(tracer, place, -towards.as_vec3())
            };
            (0..height)
                .into_par_iter()
                .with_min_len(ROWS)
                .flat_map_iter(|row| (0..width).map(move |column| (row, column)))
                .map(|(row, column)| at(row, column))
                .collect()
        };
        self.with(view, bend, Rays::Few, look)
    }
}

/// The first thing on a ray that is there at all.
fn first(tracer: &Tracer<'_>, origin: DVec3, direction: Vec3) -> Option<Seen> {
    let mut nearest = 0.0;
    for _ in 0..LAYERS {
        let hit = tracer.closest(origin.as_vec3(), direction, nearest)?;
        let base = tracer.base(&hit, 0.0);
        if tracer.cover(&hit, base.w) > 0.0 {
            let material = tracer.material(hit.triangle);
            return Some(Seen {
                material: (material + 1 < tracer.materials.len()).then_some(material),
                base: base.to_array(),
            });
        }
        nearest = hit.distance + 1e-6;
    }
    None
}
