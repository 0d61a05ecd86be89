//! Renders pictures of a glTF model. Knows no drawing, opens no file, prints nothing.
//!
//! [`read`] parses a file, [`Model::rest`] and [`PosedModel::new`] pose the model, [`PosedModel::picture`] renders it.
//! [`PosedModel::visible_surfaces`] reports which surface each pixel shows, without light. A [`Sheet`] is a rectangle in the
//! world that a picture shows exactly, a [`ModelCamera`] one of the file's cameras. A [`Film`] is a stretch of a clip that one camera
//! renders:
//!
//! ```text
//!  bytes ─► Model ─► (Pose) ─► PosedModel, Film ─► Image ─► PNG, GIF
//!                     surface · BVH     camera · tiles: fragments, light, shade
//! ```
//!
//! Pictures are ray traced. Shadows, ambient occlusion, the order of transparent surfaces and thin solids are then the
//! same query of one tree, where a rasteriser such as `euc` would need a shadow map, a screen-space estimate and a sort.
//! The ray tracer is written by hand on `obvhs`, which builds the bounding volume hierarchy: it is small, maintained, fast on a
//! CPU and shares our version of `glam`, while complete renderers need a GPU or C++ (Embree) and do not give the same picture
//! on every machine. There is no noise and no random number: each pixel of a block of four
//! by four sends its own sixteenth of one fixed set of rays, and gathers the rest from its neighbours on the same
//! surface (interleaved sampling: Keller and Heidrich 2001). Same input, same picture, on any number of threads. Pictures of
//! films take fewer rays than still ones. What the camera sees first is found by going through the triangles, unless they are large.
//!
//! Conventions: the model's axes are glTF's (right-handed, +Y up, its front looks along +Z). Rendering happens in
//! normalised space: the world moved and scaled so that the model's bounding box is centred at the origin and its longest side is 1.
//! Colours are linear until they become pixels. The first row of a picture is the top one.

mod camera;
mod coverage;
mod error;
mod film;
mod follow;
mod fragment;
mod gif_writer;
mod ground;
mod hierarchy;
mod image_files;
mod image_tile;
mod lanes;
mod light;
mod materials;
mod model;
mod posed_model;
mod raster;
mod sampling;
mod shade;
mod shooting;
mod stack;
mod surface;
#[cfg(test)]
mod tests;
mod texture;
mod trace;
mod visibility;

use glam::DVec3;

use crate::threads;

pub use crate::import::{Clip, MAX_TRIANGLES, ModelCamera, Pose};
pub use camera::{MAX_PITCH, Projection, Sheet, View};
pub use error::RenderError;
pub use film::{Film, HeldFrame};
pub use gif_writer::{MAX_GIF_FPS, Palette};
pub use image_files::{AnimationWriter, write_png};
pub use model::{Model, read};
pub use posed_model::{Image, PosedModel};
pub use shooting::Shooting;
pub use visibility::{VisibleSurface, Window};

/// The largest width and height of a picture, in pixels.
pub const MAX_SIDE: u32 = 8192;
/// The largest number of frames of a turntable.
pub const MAX_TURNTABLE_FRAMES: u32 = 1000;
/// The duration of a full turn of a turntable, in seconds.
pub const TURNTABLE_SECONDS: u32 = 4;
/// The largest number of frames of a clip: seven minutes at 24 frames a second.
pub const MAX_CLIP_FRAMES: u32 = 10_000;
/// The largest number of pictures in a film strip.
pub const MAX_FILM_STRIP_CELLS: u32 = 1000;
/// The largest number of pixels of a film strip: that of the largest picture.
pub const MAX_FILM_STRIP_PIXELS: u64 = MAX_SIDE as u64 * MAX_SIDE as u64;

/// Runs `work` on the program's thread pool.
fn on_pool<T: Send>(
    work: impl FnOnce() -> Result<T, RenderError> + Send,
) -> Result<T, RenderError> {
    threads::run(work)?
}

/// How surfaces are shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Shading {
    /// By the file's normals.
    #[default]
    Smooth,
    /// Each triangle is flat.
    Flat,
    /// In its base colour, without light and shadow, and blended as drawing programs do: the values of sRGB, not light.
    Unlit,
}

/// Settings of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Width and height in pixels, each from 1 to [`MAX_SIDE`].
    pub size: [u32; 2],
    /// The direction of the camera.
    pub view: View,
    /// The projection of the camera.
    pub projection: Projection,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Whether nodes with the extension `OKOSHI_view_dependent` bend with the view (docs/view-dependent.md).
    pub bend: bool,
    /// The background colour in sRGB; `None` is transparent.
    pub background: Option<[u8; 3]>,
}

impl Options {
    /// These options with another width and height in pixels, each from 1 to [`MAX_SIDE`].
    #[must_use]
    pub fn with_size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// These options with another direction of the camera.
    #[must_use]
    pub fn with_view(self, view: View) -> Self {
        Self { view, ..self }
    }

    /// These options with another projection of the camera.
    #[must_use]
    pub fn with_projection(self, projection: Projection) -> Self {
        Self { projection, ..self }
    }

    /// These options with other shading.
    #[must_use]
    pub fn with_shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }

    /// These options with view-dependent nodes that do not bend with the view.
    #[must_use]
    pub fn unbent(self) -> Self {
        Self {
            bend: false,
            ..self
        }
    }

    /// These options with a background colour in sRGB instead of transparency.
    #[must_use]
    pub fn with_background(self, color: [u8; 3]) -> Self {
        Self {
            background: Some(color),
            ..self
        }
    }

    /// The direction to the viewer for which view-dependent nodes are bent; `None` leaves them unbent.
    fn viewer(&self, view: View) -> Option<DVec3> {
        let [_, _, towards] = view.axes();
        self.bend.then_some(towards)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            size: [800, 800],
            view: View::default(),
            projection: Projection::default(),
            shading: Shading::default(),
            bend: true,
            background: None,
        }
    }
}
