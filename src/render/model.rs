//! A model as read from a file.

use glam::DVec3;
use typed_index_collections::TiSlice;

use super::RenderError;
use super::hierarchy::{Hierarchy, Rays};
use super::materials;
use super::surface::{Material, Normalization, Surface};
use super::texture::Texture;
use super::trace::Tracer;
use crate::import::{self, CameraPose, Clip, Geometry, ModelCamera, NodeId, Pose, Travellers};
use crate::resolver::Resolver;

/// A model as read from a file, not yet posed.
#[derive(Debug)]
pub struct Model {
    geometry: Geometry,
    clips: Vec<Clip>,
    cameras: Vec<ModelCamera>,
    /// The file's materials, followed by the one for triangles without a material.
    materials: Vec<Material>,
    textures: Vec<Option<Texture>>,
}

/// Reads a `.glb` or `.gltf`; what it links to comes from `resolver`.
///
/// # Errors
/// Bytes that are not glTF, that violate the specification or require an unsupported extension; broken links; images
/// that cannot be decoded.
pub fn read(bytes: &[u8], resolver: &dyn Resolver) -> Result<Model, RenderError> {
    let file = import::read(bytes, resolver)?;
    Ok(Model {
        materials: materials::read(&file.document),
        textures: materials::textures(&file.document, &file.buffers, resolver)?,
        clips: import::read_clips(&file.document, &file.buffers)?,
        cameras: import::read_cameras(&file.document, &file.geometry)?,
        geometry: file.geometry,
    })
}

impl Model {
    /// The pose in which the file stores the model.
    pub fn rest(&self) -> Pose {
        self.geometry.rest()
    }

    /// Its clips, in the file's order.
    pub fn clips(&self) -> &[Clip] {
        &self.clips
    }

    /// Its cameras, in the order of their nodes.
    pub fn cameras(&self) -> &[ModelCamera] {
        &self.cameras
    }

    /// The camera that films a clip: the first one that it moves, or else the first one.
    pub fn camera_of(&self, clip: &Clip) -> Option<&ModelCamera> {
        let mut cameras = self.cameras.iter();
        let moved = cameras.find(|camera| self.geometry.is_moved(camera, clip));
        moved.or(self.cameras.first())
    }

    /// Where a camera is in a pose.
    ///
    /// # Errors
    /// A camera whose node has no direction.
    pub(super) fn camera_pose(
        &self,
        pose: &Pose,
        camera: &ModelCamera,
    ) -> Result<CameraPose, RenderError> {
        let pose = self.geometry.camera_pose(pose, camera);
        pose.ok_or_else(|| RenderError::CameraPose(camera.name.clone()))
    }

    /// The pose with all cameras at rest, except one.
    pub(super) fn without_cameras(&self, pose: Pose, except: Option<&ModelCamera>) -> Pose {
        self.geometry.without_cameras(pose, &self.cameras, except)
    }

    /// The pose at a time of one of its clips, in seconds from the beginning.
    pub fn pose_at(&self, clip: &Clip, time: f64) -> Pose {
        clip.pose_at(&self.rest(), time)
    }

    /// Whether the geometry depends on the view.
    pub(super) fn is_view_dependent(&self) -> bool {
        self.geometry.is_view_dependent()
    }

    /// All triangles of a pose, moved by `normalization`, or by their own if it is `None`.
    pub(super) fn surface(
        &self,
        pose: &Pose,
        normalization: Option<Normalization>,
    ) -> Result<Surface, RenderError> {
        let soup = self.geometry.triangles(pose)?;
        Ok(Surface::new(soup, self.materials.len() - 1, normalization))
    }
    /// What a clip moves from place to place.
    pub(super) fn travellers(&self, clip: &Clip) -> Travellers {
        self.geometry.travellers(clip)
    }

    /// The places of some nodes in a pose, in the world.
    pub(super) fn places(&self, pose: &Pose, nodes: &[NodeId]) -> Vec<DVec3> {
        self.geometry.places(pose, nodes)
    }

    /// The triangles of the nodes that are marked, in a pose, moved by `normalization`.
    pub(super) fn surface_of(
        &self,
        marked: &TiSlice<NodeId, bool>,
        pose: &Pose,
        normalization: Normalization,
    ) -> Result<Surface, RenderError> {
        let soup = self.geometry.triangles_of(pose, marked)?;
        let materials = self.materials.len() - 1;
        Ok(Surface::new(soup, materials, Some(normalization)))
    }
    /// A surface of this model, ready for rays.
    pub(super) fn tracer(&self, surface: Surface, rays: Rays) -> Tracer<'_> {
        Tracer::new(surface, &self.materials, &self.textures, rays)
    }

    /// As [`tracer`](Self::tracer), with a hierarchy of the surface.
    pub(super) fn tracer_with(&self, surface: Surface, hierarchy: Hierarchy) -> Tracer<'_> {
        Tracer::with_hierarchy(surface, &self.materials, &self.textures, hierarchy)
    }
}
