//! A model as a file has it, with what it takes to draw it.

use super::RenderError;
use super::materials;
use super::surface::{Frame, Material, Surface};
use super::texture::Texture;
use crate::import::{self, Clip, Geometry, Pose};
use crate::resolver::Resolver;

/// A model as a file has it, not yet posed.
#[derive(Debug)]
pub struct Model {
    geometry: Geometry,
    clips: Vec<Clip>,
    /// The last is the one of what has none.
    pub(super) materials: Vec<Material>,
    pub(super) textures: Vec<Option<Texture>>,
}

/// Reads a `.glb` or `.gltf`; what it links to comes from `resolver`.
///
/// # Errors
/// Bytes that are no glTF, that break its rules, or need what is not known; links that lead nowhere; images that
/// cannot be decoded.
pub fn read(bytes: &[u8], resolver: &dyn Resolver) -> Result<Model, RenderError> {
    let file = import::read(bytes, resolver)?;
    Ok(Model {
        materials: materials::read(&file.document),
        textures: materials::textures(&file.document, &file.buffers, resolver)?,
        clips: import::read_clips(&file.document, &file.buffers)?,
        geometry: file.geometry,
    })
}

impl Model {
    /// The pose that the file is in.
    pub fn rest(&self) -> Pose {
        self.geometry.rest()
    }

    /// Its clips, in the file's order.
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// The pose at a moment of one of its clips, seconds from the beginning.
    pub fn pose_at(&self, clip: &Clip, time: f64) -> Pose {
        clip.pose_at(&self.rest(), time)
    }

    /// Whether anything looks otherwise from elsewhere.
    pub(super) fn follows_viewer(&self) -> bool {
        self.geometry.follows_viewer()
    }

    /// All triangles in a pose.
    ///
    /// They are moved into the frame, or where there is none into one that they fill.
    pub(super) fn surface(
        &self,
        pose: &Pose,
        frame: Option<Frame>,
    ) -> Result<Surface, RenderError> {
        let soup = self.geometry.triangles(pose)?;
        Ok(Surface::new(soup, self.materials.len() - 1, frame))
    }
}
