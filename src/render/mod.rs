//! Pictures of a model: glTF in, pixels out. Knows no drawing, opens no file, prints nothing.
//!
//! [`read`] takes a file's bytes apart, [`Model::rest`] and [`Stage::new`] pose it, [`Stage::picture`] draws it;
//! [`Stage::seen`] tells what is seen where, without light. A [`Film`] is a clip that is drawn from one place:
//!
//! ```text
//!  bytes ─► Model ─► (Pose) ─► Stage ─► Image ─► encode
//!                     surface · bvh     camera · tiles: fragments, light, shade
//! ```
//!
//! Pictures are ray traced. Shadows, ambient occlusion, order of transparent surfaces and thin solids are then one
//! question, asked of one tree, where a rasteriser such as `euc` would need a shadow map, a screen-space guess and a
//! sort. The tree is `obvhs`: small, kept up, on the glam that okoshi is on, and the fastest on the processor of those
//! that need neither a GPU nor C. Noise is kept out without a random number: each pixel of a block of four by four
//! takes its own sixteenth of one fixed set of directions, and gathers the rest from its neighbours on the same
//! surface (interleaved sampling: Keller and Heidrich 2001). Same input, same picture, on any number of threads.
//!
//! Conventions: the model's axes are glTF's (right-handed, +Y up, its front looks along +Z). A [`Stage`] is moved and
//! scaled so that the model's box is centred at the origin and its longest side is 1. Colours are linear until
//! they become pixels. Pictures have their first row at the top.

mod camera;
mod encode;
mod error;
mod film;
mod fragment;
mod light;
mod materials;
mod model;
mod seen;
mod shade;
mod stage;
mod surface;
#[cfg(test)]
mod tests;
mod texture;
mod tile;
mod trace;

pub use crate::import::{Clip, Pose, TRIANGLE_LIMIT};
pub use camera::{PITCH_LIMIT, Projection, View};
pub use encode::{Animation, GIF_FPS_LIMIT, Palette, write_png};
pub use error::RenderError;
pub use film::{Film, Shot};
pub use model::{Model, read};
pub use seen::{Seen, Window};
pub use stage::{Image, Stage};

/// The longest side of a picture, pixels.
pub const SIZE_LIMIT: u32 = 8192;
/// The most frames of a turntable.
pub const FRAME_LIMIT: u32 = 1000;
/// How long a turn of a turntable takes, seconds.
pub const TURN: f64 = 4.0;
/// The most frames of a clip: seven minutes at 24 frames a second.
pub const CLIP_FRAME_LIMIT: u32 = 10_000;
/// The most moments of a strip.
pub const CELL_LIMIT: u32 = 1000;
/// The most pixels of a strip: those of the largest picture.
pub const STRIP_LIMIT: u64 = SIZE_LIMIT as u64 * SIZE_LIMIT as u64;

/// How surfaces are shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// By the file's normals.
    #[default]
    Smooth,
    /// Each triangle as the flat piece that it is.
    Flat,
}

/// What a picture is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Width and height, pixels, each from 1 to [`SIZE_LIMIT`].
    pub size: [u32; 2],
    /// Where the camera stands.
    pub view: View,
    /// How it sees.
    pub projection: Projection,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Whether nodes with the extension `OKOSHI_view_dependent` are bent as it says (docs/view-dependent.md); else they
    /// are shown as they are.
    pub bend: bool,
    /// sRGB; transparent if there is none.
    pub background: Option<[u8; 3]>,
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
