//! A posed model, ready to be rendered from any view.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use image::RgbaImage;
use rayon::prelude::*;

use super::camera::{Camera, Framing, Sheet, View};
use super::coverage::{Coverage, places};
use super::fragment::PixelSampler;
use super::ground::{Floor, GroundLight};
use super::hierarchy::Rays;
use super::image_tile::{HALO, draw_tile};
use super::light::Lights;
use super::model::Model;
use super::raster::Raster;
use super::sampling::{FILM, STILL, Sampling};
use super::surface::{Normalization, Surface};
use super::trace::Tracer;
use super::{MAX_SIDE, Options, RenderError, Shading, on_pool};
use crate::import::{ImportError, ModelCamera, Pose};

/// A picture, sRGB with straight alpha.
pub type Image = RgbaImage;

/// A posed model.
pub struct PosedModel<'a> {
    model: &'a Model,
    pose: Pose,
    /// From the world into normalised space.
    pub(super) normalization: Normalization,
    /// The number of triangles.
    pub triangles: usize,
    /// The geometry for every view; `None` if it depends on the view.
    view_independent: Option<Tracer<'a>>,
    /// The points that must be in every picture, unless they depend on the view.
    points: Vec<Vec3>,
}

impl<'a> PosedModel<'a> {
    /// Poses a model.
    ///
    /// # Errors
    /// A model without triangles, or with too many.
    pub fn new(model: &'a Model, pose: &Pose) -> Result<Self, RenderError> {
        let build = || {
            let surface = model.surface(pose, None)?;
            if surface.triangles.is_empty() {
                return Err(ImportError::Empty.into());
            }
            Ok(Self {
                model,
                pose: pose.clone(),
                normalization: surface.normalization,
                triangles: surface.triangles.len(),
                points: surface.used_positions(),
                view_independent: (!model.is_view_dependent())
                    .then(|| model.tracer(surface, Rays::Many)),
            })
        };
        on_pool(build)
    }

    /// The surface of a view-dependent model for a viewer; see [`Options::viewer`].
    fn surface_from(&self, viewer: Option<DVec3>) -> Result<Surface, RenderError> {
        let pose = self.pose.seen_from(viewer);
        self.model.surface(&pose, Some(self.normalization))
    }

    /// Runs `work` on the geometry for a viewer, on the thread pool.
    pub(super) fn with<T: Send>(
        &self,
        viewer: Option<DVec3>,
        rays: Rays,
        work: impl FnOnce(&Tracer<'_>) -> Result<T, RenderError> + Send,
    ) -> Result<T, RenderError> {
        on_pool(|| match &self.view_independent {
            Some(tracer) => work(tracer),
            None => {
                let surface = self.surface_from(viewer)?;
                work(&self.model.tracer(surface, rays))
            }
        })
    }

    /// Renders the model, as large as it fits.
    ///
    /// # Errors
    /// A size out of range.
    pub fn picture(&self, options: &Options) -> Result<Image, RenderError> {
        let framing = self.framing(options, &[options.view])?;
        self.draw(options, &framing, options.view, &STILL)
    }

    /// Renders what a rectangle in the world shows of the model. Of the options the view and the projection are not used; the
    /// rectangle is as large as the size says.
    ///
    /// # Errors
    /// A size out of range.
    pub fn picture_of(&self, options: &Options, sheet: &Sheet) -> Result<Image, RenderError> {
        check_size(options.size)?;
        let viewer = options.bend.then_some(sheet.towards());
        self.with(viewer, Rays::Many, |tracer| {
            let camera = sheet.camera(options.size, &tracer.surface);
            draw(tracer, options, &Take::still(&camera))
        })
    }

    /// Renders what a camera of the file shows. Of the options the view and the projection are not used.
    ///
    /// # Errors
    /// A size out of range, or a camera without a direction.
    pub fn picture_by(
        &self,
        options: &Options,
        camera: &ModelCamera,
    ) -> Result<Image, RenderError> {
        check_size(options.size)?;
        let pose = self.model.camera_pose(&self.pose, camera)?;
        let viewer = options.bend.then_some(pose.towards);
        let camera = Camera::in_model(camera, &pose, self.normalization, options.size);
        self.with(viewer, Rays::Many, |tracer| {
            draw(tracer, options, &Take::still(&camera))
        })
    }

    /// Renders the model from `frames` directions all around, starting from the view of the options. `each` gets the
    /// pictures one by one and may stop with its own error.
    ///
    /// # Errors
    /// A size out of range, or the error of `each`.
    pub fn turntable<E: From<RenderError>>(
        &self,
        options: &Options,
        frames: u32,
        mut each: impl FnMut(Image) -> Result<(), E>,
    ) -> Result<(), E> {
        let views: Vec<View> = (0..frames)
            .map(|frame| turned(options.view, frame, frames))
            .collect();
        // One framing for all, so that the model keeps its size and position while it turns.
        let framing = self.framing(options, &views)?;
        for view in views {
            each(self.draw(options, &framing, view, &FILM)?)?;
        }
        Ok(())
    }

    fn framing(&self, options: &Options, views: &[View]) -> Result<Framing, RenderError> {
        check_size(options.size)?;
        let shots: Vec<(View, ())> = views.iter().map(|view| (*view, ())).collect();
        let points = |view: View, ()| match &self.view_independent {
            Some(_) => Ok(Cow::Borrowed(&*self.points)),
            None => Ok(Cow::Owned(
                self.surface_from(options.viewer(view))?.used_positions(),
            )),
        };
        on_pool(|| Framing::new(&shots, options.projection, options.size, points))
    }

    fn draw(
        &self,
        options: &Options,
        framing: &Framing,
        view: View,
        sampling: &Sampling,
    ) -> Result<Image, RenderError> {
        self.with(options.viewer(view), Rays::Many, |tracer| {
            let take = Take {
                sampling,
                ..Take::still(&framing.camera(view))
            };
            draw(tracer, options, &take)
        })
    }

    /// [`Self::picture`] on the caller's threads.
    #[cfg(test)]
    pub(super) fn drawn_here(&self, options: &Options) -> Result<Image, RenderError> {
        let framing = self.framing(options, &[options.view])?;
        let tracer = self.view_independent.as_ref().ok_or(RenderError::Broken)?;
        draw(tracer, options, &Take::still(&framing.camera(options.view)))
    }
}

/// Checks the width and height of a picture.
pub(super) fn check_size([width, height]: [u32; 2]) -> Result<(), RenderError> {
    let fits = |side: u32| (1..=MAX_SIDE).contains(&side);
    if fits(width) && fits(height) {
        Ok(())
    } else {
        Err(RenderError::Size(width, height))
    }
}

/// How one picture is taken.
#[derive(Clone, Copy)]
pub(super) struct Take<'a> {
    pub(super) camera: Camera,
    pub(super) sampling: &'a Sampling,
    /// The lines on the ground.
    pub(super) floor: Option<Floor>,
}

impl Take<'_> {
    /// A still picture.
    pub(super) fn still(camera: &Camera) -> Self {
        Self {
            camera: *camera,
            sampling: &STILL,
            floor: None,
        }
    }
}

/// Renders a picture.
pub(super) fn draw(
    tracer: &Tracer<'_>,
    options: &Options,
    take: &Take<'_>,
) -> Result<Image, RenderError> {
    let [width, height] = options.size;
    let Take {
        camera,
        sampling,
        floor,
    } = take;
    let lights = Lights::new(camera.yaw, sampling);
    let places = places(&tracer.surface, camera);
    let is_lit = options.shading != Shading::Unlit;
    let size = options.size.map(|side| side + HALO);
    let raster = is_lit.then(|| Raster::new(tracer, camera, &places, size));
    let sampler = PixelSampler {
        tracer,
        camera,
        coverage: &Coverage::new(&tracer.surface, &places, options.size, HALO),
        raster: raster.flatten(),
        sampling,
        shading: options.shading,
        floor: *floor,
    };
    let spacing = sampling.ground.spacing;
    let ground = is_lit.then(|| {
        GroundLight::new(
            tracer,
            &lights,
            camera,
            sampler.coverage,
            options.size,
            spacing,
        )
    });
    let side = sampling.tile;
    let mut pixels = vec![[0_u8; 4]; width as usize * height as usize];
    let bands = pixels
        .par_chunks_mut(width as usize * side as usize)
        .enumerate();
    bands.for_each(|(band, pixels)| {
        let top = band as u32 * side;
        let high = side.min(height - top);
        // Tiles within a band run in parallel too, for pictures with fewer bands than threads.
        let lefts: Vec<u32> = (0..width).step_by(side as usize).collect();
        let tiles: Vec<Vec<[u8; 4]>> = lefts
            .par_iter()
            .map(|left| {
                let wide = side.min(width - left);
                draw_tile(
                    &sampler,
                    &lights,
                    ground.as_ref(),
                    options.background,
                    [*left, top],
                    [wide, high],
                )
            })
            .collect();
        for (left, tile) in lefts.iter().zip(&tiles) {
            let wide = side.min(width - left) as usize;
            for (line, tile) in pixels
                .chunks_exact_mut(width as usize)
                .zip(tile.chunks_exact(wide))
            {
                line[*left as usize..][..wide].copy_from_slice(tile);
            }
        }
    });
    Image::from_raw(width, height, pixels.into_flattened()).ok_or(RenderError::Broken)
}

/// The view of a frame of a turntable: as if the model turned to its right.
fn turned(view: View, frame: u32, frames: u32) -> View {
    let turn = 360.0 * f64::from(frame % frames) / f64::from(frames);
    View {
        yaw: view.yaw + turn,
        ..view
    }
}
