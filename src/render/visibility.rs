//! The visible surface of each pixel: no light, no antialiasing, one ray per pixel.

use glam::{DVec3, Vec3, Vec4};
use rayon::prelude::*;

use super::camera::Sheet;
use super::hierarchy::Rays;
use super::posed_model::{PosedModel, check_size};
use super::texture::srgb_values;
use super::trace::Tracer;
use super::{Options, RenderError};

/// The smallest number of rows per task.
const ROWS: usize = 16;
/// The largest number of transparent surfaces that a ray passes through.
const MAX_LAYERS: usize = 64;
/// Below this transmittance nothing more is visible.
const OPAQUE: f32 = 0.002;

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
    /// Its base colour and those of the surfaces behind it, as far as it is transparent: sRGB values multiplied by alpha, and
    /// alpha, each 0 to 1.
    pub blended: [f32; 4],
}

/// Parallel rays, one through the middle of each pixel.
struct Beam {
    /// The top left corner of the picture, in the world.
    corner: DVec3,
    /// From a pixel to the next one, to the right and down, in the world.
    steps: [DVec3; 2],
    towards: DVec3,
    /// The width of a pixel for sampling textures, metres; 0 samples them at one point.
    width: f64,
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
        let [width, height] = options.size.map(f64::from);
        let [right, up, towards] = options.view.axes();
        let beam = Beam {
            corner: right * window.left + up * window.top,
            steps: [
                right * (window.width / width),
                -up * (window.height / height),
            ],
            towards,
            width: 0.0,
        };
        self.first_surfaces(options, &beam)
    }

    /// As [`visible_surfaces`](Self::visible_surfaces), for a rectangle in the world. Of the options only the size and `bend`
    /// are used.
    ///
    /// # Errors
    /// A size out of range.
    pub fn visible_surfaces_of(
        &self,
        options: &Options,
        sheet: &Sheet,
    ) -> Result<Vec<Option<VisibleSurface>>, RenderError> {
        let beam = Beam {
            corner: sheet.corner,
            steps: [sheet.right * sheet.pixel, -sheet.up * sheet.pixel],
            towards: sheet.towards(),
            width: sheet.pixel,
        };
        self.first_surfaces(options, &beam)
    }

    fn first_surfaces(
        &self,
        options: &Options,
        beam: &Beam,
    ) -> Result<Vec<Option<VisibleSurface>>, RenderError> {
        check_size(options.size)?;
        let [width, height] = options.size;
        let normalization = self.normalization;
        let towards = beam.towards;
        let texel = (beam.width * normalization.scale) as f32;
        let look = |tracer: &Tracer<'_>| {
            let away = tracer.surface.reach();
            let at = |row: u32, column: u32| {
                let [right, down] = beam.steps;
                let place =
                    beam.corner + right * (f64::from(column) + 0.5) + down * (f64::from(row) + 0.5);
                let place = normalization.apply(place);
                let place = place + towards * (away - place.dot(towards));
                first(tracer, place, -towards.as_vec3(), texel)
            };
            Ok((0..height)
                .into_par_iter()
                .with_min_len(ROWS)
                .flat_map_iter(|row| (0..width).map(move |column| (row, column)))
                .map(|(row, column)| at(row, column))
                .collect())
        };
        self.with(options.bend.then_some(towards), Rays::Few, look)
    }
}

/// The first surface on a ray that is not fully transparent, blended with those behind it.
fn first(
    tracer: &Tracer<'_>,
    origin: DVec3,
    direction: Vec3,
    texel: f32,
) -> Option<VisibleSurface> {
    let mut found: Option<VisibleSurface> = None;
    let mut blended = Vec4::ZERO;
    let mut nearest = 0.0;
    for _ in 0..MAX_LAYERS {
        let Some(hit) = tracer.closest(origin.as_vec3(), direction, nearest) else {
            break;
        };
        nearest = hit.distance + 1e-6;
        let base = tracer.base(&hit, texel);
        let cover = tracer.cover(&hit, base.w);
        if cover <= 0.0 {
            continue;
        }
        let shown = srgb_values(base.truncate()).extend(1.0);
        blended += shown * (cover * (1.0 - blended.w));
        found.get_or_insert_with(|| {
            let material = tracer.material(hit.triangle);
            VisibleSurface {
                material: (material + 1 < tracer.materials.len()).then_some(material),
                base: base.to_array(),
                blended: [0.0; 4],
            }
        });
        if 1.0 - blended.w < OPAQUE {
            break;
        }
    }
    found.map(|surface| VisibleSurface {
        blended: blended.to_array(),
        ..surface
    })
}
