//! A posed model, ready to be drawn from anywhere.

use std::borrow::Cow;

use glam::Vec3;
use image::RgbaImage;
use rayon::prelude::*;

use super::camera::{Framing, View};
use super::fragment::Eye;
use super::light::Rig;
use super::model::Model;
use super::surface::{Frame, Surface};
use super::tile::{TILE, draw};
use super::trace::{Rays, Tracer};
use super::{Options, RenderError, SIZE_LIMIT};
use crate::import::{ImportError, Pose};
use crate::threads;

/// A picture, sRGB with straight alpha.
pub type Image = RgbaImage;

/// A posed model.
pub struct Stage<'a> {
    model: &'a Model,
    pose: Pose,
    frame: Frame,
    triangles: usize,
    /// The model as it is from everywhere; none if it is another from elsewhere.
    settled: Option<Posed<'a>>,
}

/// What rays are sent at.
pub(super) struct Posed<'a> {
    pub(super) tracer: Tracer<'a>,
    /// What must be in the picture.
    points: Vec<Vec3>,
}

impl<'a> Posed<'a> {
    pub(super) fn new(model: &'a Model, surface: Surface, rays: Rays) -> Self {
        let points = surface.used();
        Self {
            tracer: Tracer::new(surface, &model.materials, &model.textures, rays),
            points,
        }
    }
}

impl<'a> Stage<'a> {
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
                frame: surface.frame,
                triangles: surface.triangles.len(),
                settled: (!model.follows_viewer()).then(|| Posed::new(model, surface, Rays::Many)),
            })
        };
        threads::run(build).unwrap_or(Err(RenderError::Broken))
    }

    /// How many triangles there are.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Where the world lies on the stage.
    pub(super) fn frame(&self) -> Frame {
        self.frame
    }

    /// The surface of a model that follows the viewer, as it is from one view.
    fn surface(&self, view: View, bend: bool) -> Result<Surface, RenderError> {
        let [_, _, towards] = view.axes();
        let pose = self.pose.seen_from(bend.then_some(towards));
        self.model.surface(&pose, Some(self.frame))
    }

    /// Has `work` done with the model as it is from a view, on the threads that all of it runs on.
    pub(super) fn with<T: Send>(
        &self,
        view: View,
        bend: bool,
        rays: Rays,
        work: impl FnOnce(&Posed<'_>) -> T + Send,
    ) -> Result<T, RenderError> {
        let done = threads::run(|| match &self.settled {
            Some(posed) => Ok(work(posed)),
            None => {
                let surface = self.surface(view, bend)?;
                Ok(work(&Posed::new(self.model, surface, rays)))
            }
        });
        done.unwrap_or(Err(RenderError::Broken))
    }

    /// Draws the model, as large as the picture takes it.
    ///
    /// # Errors
    /// A size out of range.
    pub fn picture(&self, options: &Options) -> Result<Image, RenderError> {
        let framing = self.framing(options, &[options.view])?;
        self.draw(options, &framing, options.view)
    }

    /// Draws the model from `frames` sides, all the way round from the view that the options give; `each` gets one
    /// picture after the other and may break off with an error of its own.
    ///
    /// # Errors
    /// A size out of range, or what `each` answers.
    pub fn turntable<E: From<RenderError>>(
        &self,
        options: &Options,
        frames: u32,
        mut each: impl FnMut(Image) -> Result<(), E>,
    ) -> Result<(), E> {
        let views: Vec<View> = (0..frames)
            .map(|frame| turned(options.view, frame, frames))
            .collect();
        // One framing for all, so that the model keeps its size and place while it turns.
        let framing = self.framing(options, &views)?;
        for view in views {
            each(self.draw(options, &framing, view)?)?;
        }
        Ok(())
    }

    fn framing(&self, options: &Options, views: &[View]) -> Result<Framing, RenderError> {
        check_size(options.size)?;
        let sights: Vec<(View, ())> = views.iter().map(|view| (*view, ())).collect();
        let points = |view: View, ()| match &self.settled {
            Some(posed) => Ok(Cow::Borrowed(&*posed.points)),
            None => Ok(Cow::Owned(self.surface(view, options.bend)?.used())),
        };
        let framing = || Framing::new(&sights, options.projection, options.size, points);
        threads::run(framing).unwrap_or(Err(RenderError::Broken))
    }

    fn draw(&self, options: &Options, framing: &Framing, view: View) -> Result<Image, RenderError> {
        let pixels = self.with(view, options.bend, Rays::Many, |posed| {
            pixels(posed, options, framing, view)
        })?;
        let [width, height] = options.size;
        Image::from_raw(width, height, pixels).ok_or(RenderError::Broken)
    }

    /// The same on the threads that the caller is on.
    #[cfg(test)]
    pub(super) fn drawn_here(&self, options: &Options) -> Result<Image, RenderError> {
        let framing = self.framing(options, &[options.view])?;
        let [width, height] = options.size;
        let posed = self.settled.as_ref().ok_or(RenderError::Broken)?;
        let pixels = pixels(posed, options, &framing, options.view);
        Image::from_raw(width, height, pixels).ok_or(RenderError::Broken)
    }
}

/// Refuses pictures without pixels and those with too many.
pub(super) fn check_size([width, height]: [u32; 2]) -> Result<(), RenderError> {
    let fits = |side: u32| (1..=SIZE_LIMIT).contains(&side);
    match fits(width) && fits(height) {
        true => Ok(()),
        false => Err(RenderError::Size(width, height)),
    }
}

/// The pixels of a picture, four bytes each, rows from the top.
pub(super) fn pixels(
    posed: &Posed<'_>,
    options: &Options,
    framing: &Framing,
    view: View,
) -> Vec<u8> {
    let [width, height] = options.size;
    let camera = framing.camera(view);
    let rig = Rig::new(camera.yaw);
    let eye = Eye {
        tracer: &posed.tracer,
        camera: &camera,
        shading: options.shading,
    };
    let mut pixels = vec![[0_u8; 4]; width as usize * height as usize];
    let bands = pixels
        .par_chunks_mut(width as usize * TILE as usize)
        .enumerate();
    bands.for_each(|(band, pixels)| {
        let top = band as u32 * TILE;
        let high = TILE.min(height - top);
        // Bands are shared among threads, and tiles within a band, where there are fewer bands than threads.
        let lefts: Vec<u32> = (0..width).step_by(TILE as usize).collect();
        let tiles: Vec<Vec<[u8; 4]>> = lefts
            .par_iter()
            .map(|left| {
                let wide = TILE.min(width - left);
                draw(&eye, &rig, options.background, [*left, top], [wide, high])
            })
            .collect();
        for (left, tile) in lefts.iter().zip(&tiles) {
            let wide = TILE.min(width - left) as usize;
            for (line, tile) in pixels
                .chunks_exact_mut(width as usize)
                .zip(tile.chunks_exact(wide))
            {
                line[*left as usize..][..wide].copy_from_slice(tile);
            }
        }
    });
    pixels.into_flattened()
}

/// The view of a turntable's frame: as if the model turned to its right.
fn turned(view: View, frame: u32, frames: u32) -> View {
    let turn = 360.0 * f64::from(frame % frames) / f64::from(frames);
    View {
        yaw: view.yaw + turn,
        ..view
    }
}
