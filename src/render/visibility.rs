//! The visible surface of each pixel: no light, no antialiasing, one ray per pixel.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::posed_model::{PosedModel, RayTarget, check_size};
use super::trace::{Rays, Tracer};
use super::{Options, RenderError};

/// The smallest number of rows per task.
const ROWS: usize = 16;
/// The largest number of transparent surfaces that a ray passes through.
const MAX_LAYERS: usize = 64;

/// The rectangle that a picture in parallel projection shows, in metres. It lies in the plane through the world's origin
/// that faces the camera; its edges are measured to the right of the origin and above it, as the camera sees them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The distance of the left edge to the right of the origin.
    pub left: f64,
    /// The height of the top edge above the origin.
    pub top: f64,
    /// From the left edge to the right edge.
    pub width: f64,
    /// From the top edge to the bottom edge.
    pub height: f64,
}

/// The surface that a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleSurface {
    /// The index of its material in the file, if it has one.
    pub material: Option<usize>,
    /// Base colour and alpha, linear, each 0 to 1: factor, texture and vertex colour, without light.
    pub base: [f32; 4],
}

impl PosedModel<'_> {
    /// The visible surface at the middle of each pixel in parallel projection, rows from the top.
    ///
    /// Rays pass through fully transparent surfaces, but not through partly transparent ones. Of the options only the view,
    /// the size and `bend` are used. Pixels need not be square: the size is the number of columns and rows of the window.
    ///
    /// # Errors
    /// A size out of range.
    pub fn visible_surfaces(
        &self,
        options: &Options,
        window: Window,
    ) -> Result<Vec<Option<VisibleSurface>>, RenderError> {
        check_size(options.size)?;
        let [width, height] = options.size;
        let normalization = self.normalization();
        let [right, up, towards] = options.view.axes();
        let pixel = [
            window.width / f64::from(width),
            window.height / f64::from(height),
        ];
        let look = |target: &RayTarget<'_>| {
            let tracer = &target.tracer;
            let (low, high) = (tracer.surface.low, tracer.surface.high);
            // In front of the whole model.
            let away = 1.0 + low.abs().max(high.abs()).length();
            let at = |row: u32, column: u32| {
                let x = window.left + (f64::from(column) + 0.5) * pixel[0];
                let y = window.top - (f64::from(row) + 0.5) * pixel[1];
                let place = normalization.apply(right * x + up * y);
                let place = place - towards * place.dot(towards) + towards * f64::from(away);
                first(tracer, place, -towards.as_vec3())
            };
            Ok((0..height)
                .into_par_iter()
                .with_min_len(ROWS)
                .flat_map_iter(|row| (0..width).map(move |column| (row, column)))
                .map(|(row, column)| at(row, column))
                .collect())
        };
        self.with(options, options.view, Rays::Few, look)
    }
}

/// The first surface on a ray that is not fully transparent.
fn first(tracer: &Tracer<'_>, origin: DVec3, direction: Vec3) -> Option<VisibleSurface> {
    let mut nearest = 0.0;
    for _ in 0..MAX_LAYERS {
        let hit = tracer.closest(origin.as_vec3(), direction, nearest)?;
        let base = tracer.base(&hit, 0.0);
        if tracer.cover(&hit, base.w) > 0.0 {
            let material = tracer.material(hit.triangle);
            return Some(VisibleSurface {
                material: (material + 1 < tracer.materials.len()).then_some(material),
                base: base.to_array(),
            });
        }
        nearest = hit.distance + 1e-6;
    }
    None
}
