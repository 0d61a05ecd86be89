//! Renders a clip with one camera for all its frames.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::camera::{Framing, View};
use super::model::Model;
use super::posed_model::{Image, RayTarget, check_size, draw};
use super::surface::{Normalization, Surface};
use super::trace::Rays;
use super::{MAX_CLIP_FRAMES, MAX_FILM_STRIP_PIXELS, Options, RenderError, on_pool};
use crate::import::{Clip, ImportError};

/// At how many times the pose is sampled, at most, to find the space that the clip needs.
const MAX_SAMPLES: u32 = 32;
/// How many corners of these samples are kept in memory during framing; those of larger models are computed every time.
const MAX_CACHED_CORNERS: usize = 4 << 20;
/// The longest time that one picture is held, in seconds: file formats cannot store much longer delays.
const MAX_HOLD_SECONDS: f64 = 60.0;
/// A remainder of less than this many frames does not become a frame.
const FRAME_TOLERANCE: f64 = 1e-4;

/// A stretch of a clip to render.
pub struct Film<'a> {
    model: &'a Model,
    clip: &'a Clip,
    /// Its first and its last time, in seconds of the clip.
    span: [f64; 2],
    /// Normalised space: centred on all that the model does, with the scale of its largest pose.
    normalization: Normalization,
    /// The height of the ground in normalised space: below all poses.
    ground: f32,
    triangles: usize,
}

/// A picture of a film, and how long it is held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldFrame {
    /// Its time, in seconds of the clip.
    pub time: f64,
    /// Its duration in seconds.
    pub seconds: f64,
    /// Its duration in frames.
    pub frames: u32,
}

/// `count` evenly spaced times from the first of a span to its last.
fn evenly([from, to]: [f64; 2], count: u32) -> impl Iterator<Item = f64> {
    let steps = f64::from(count.saturating_sub(1).max(1));
    (0..count).map(move |index| from + (to - from) * f64::from(index) / steps)
}

impl<'a> Film<'a> {
    /// The stretch of a clip between two times, in seconds of the clip.
    ///
    /// # Errors
    /// A model without triangles, or with too many.
    pub fn new(model: &'a Model, clip: &'a Clip, span: [f64; 2]) -> Result<Self, RenderError> {
        let moments: Vec<f64> = evenly(span, MAX_SAMPLES).collect();
        let boxes = || -> Result<Vec<_>, RenderError> {
            let look = |time: &f64| {
                let surface = model.surface(&model.pose_at(clip, *time), None)?;
                let Normalization { middle, scale } = surface.normalization;
                let half = (surface.high - surface.low).as_dvec3() / 2.0 / scale;
                let count = surface.triangles.len();
                Ok((count > 0).then_some((middle - half, middle + half, count)))
            };
            let found: Result<Vec<_>, RenderError> = moments.iter().map(look).collect();
            Ok(found?.into_iter().flatten().collect())
        };
        let boxes = on_pool(boxes)?;
        if boxes.is_empty() {
            return Err(ImportError::Empty.into());
        }
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let (mut size, mut triangles) = (0.0_f64, 0);
        for (own_low, own_high, count) in boxes {
            low = low.min(own_low);
            high = high.max(own_high);
            size = size.max((own_high - own_low).max_element());
            triangles = triangles.max(count);
        }
        let normalization = Normalization {
            middle: (low + high) / 2.0,
            scale: if size > 0.0 { 1.0 / size } else { 1.0 },
        };
        Ok(Self {
            model,
            clip,
            span,
            normalization,
            ground: normalization.apply(low).y as f32,
            triangles,
        })
    }

    /// The largest number of triangles of any sampled pose.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// Its duration in seconds.
    pub fn seconds(&self) -> f64 {
        self.span[1] - self.span[0]
    }

    /// The pictures to render at a frame rate: one for consecutive frames with equal poses, unless they last longer than a
    /// minute.
    ///
    /// # Errors
    /// More than [`MAX_CLIP_FRAMES`] frames.
    pub fn held_frames(&self, fps: u32) -> Result<Vec<HeldFrame>, RenderError> {
        let (fps, seconds) = (f64::from(fps), self.seconds());
        let frames = (seconds * fps - FRAME_TOLERANCE).ceil().max(1.0);
        if frames > f64::from(MAX_CLIP_FRAMES) {
            return Err(RenderError::TooManyFrames(frames));
        }
        let mut held: Vec<HeldFrame> = Vec::new();
        let mut shown = None;
        for frame in 0..frames as u32 {
            let since = f64::from(frame) / fps;
            let last = f64::from(frame + 1) >= frames && seconds > 0.0;
            let frame = HeldFrame {
                time: self.span[0] + since,
                seconds: if last { seconds - since } else { 1.0 / fps },
                frames: 1,
            };
            let pose = self.model.pose_at(self.clip, frame.time);
            match held.last_mut() {
                Some(before)
                    if shown.as_ref() == Some(&pose)
                        && before.seconds + frame.seconds <= MAX_HOLD_SECONDS =>
                {
                    before.seconds += frame.seconds;
                    before.frames += 1;
                }
                _ => held.push(frame),
            }
            shown = Some(pose);
        }
        Ok(held)
    }

    /// Renders the film at some times with one camera that frames all of it. `each` gets the pictures one by one and may
    /// stop with its own error.
    ///
    /// # Errors
    /// A size out of range, or the error of `each`.
    pub fn draw<E: From<RenderError>>(
        &self,
        options: &Options,
        moments: impl IntoIterator<Item = f64>,
        mut each: impl FnMut(Image) -> Result<(), E>,
    ) -> Result<(), E> {
        let framing = self.framing(options)?;
        for time in moments {
            each(self.picture(options, &framing, time)?)?;
        }
        Ok(())
    }

    /// Renders `cells` evenly spaced times side by side, each in the size of the options. `done` is called with the number
    /// of finished pictures.
    ///
    /// # Errors
    /// A size out of range, or more than [`MAX_FILM_STRIP_PIXELS`] pixels.
    pub fn film_strip(
        &self,
        options: &Options,
        cells: u32,
        done: impl Fn(u32),
    ) -> Result<Image, RenderError> {
        let [width, height] = options.size;
        let wide = u64::from(width) * u64::from(cells);
        if wide * u64::from(height) > MAX_FILM_STRIP_PIXELS {
            return Err(RenderError::FilmStripTooLarge(wide, height));
        }
        let mut strip = Image::new(wide as u32, height);
        let mut cell = 0;
        self.draw(options, evenly(self.span, cells), |image| {
            let left = i64::from(cell * width);
            image::imageops::replace(&mut strip, &image, left, 0);
            cell += 1;
            done(cell);
            Ok::<(), RenderError>(())
        })?;
        Ok(strip)
    }

    fn framing(&self, options: &Options) -> Result<Framing, RenderError> {
        check_size(options.size)?;
        let moments: Vec<f64> = evenly(self.span, MAX_SAMPLES).collect();
        let view = options.view;
        let corners =
            |time: f64| Ok::<_, RenderError>(self.surface(options, time)?.used_positions());
        let few = self.triangles.saturating_mul(3 * moments.len()) <= MAX_CACHED_CORNERS;
        let framing = || {
            let kept: Vec<Vec<Vec3>> = match few {
                true => moments
                    .par_iter()
                    .map(|time| corners(*time))
                    .collect::<Result<_, _>>()?,
                false => Vec::new(),
            };
            let shots: Vec<(View, usize)> =
                (0..moments.len()).map(|moment| (view, moment)).collect();
            let points = |_, moment: usize| match kept.get(moment) {
                Some(kept) => Ok(Cow::Borrowed(&**kept)),
                None => corners(moments[moment]).map(Cow::Owned),
            };
            Framing::new(&shots, options.projection, options.size, points)
        };
        on_pool(framing)
    }

    /// The posed surface at a time.
    fn surface(&self, options: &Options, time: f64) -> Result<Surface, RenderError> {
        let pose = self.model.pose_at(self.clip, time);
        let pose = pose.seen_from(options.viewer(options.view));
        self.model.surface(&pose, Some(self.normalization))
    }

    fn picture(
        &self,
        options: &Options,
        framing: &Framing,
        time: f64,
    ) -> Result<Image, RenderError> {
        let [width, height] = options.size;
        on_pool(|| {
            let mut surface = self.surface(options, time)?;
            if surface.triangles.is_empty() {
                // The whole model is scaled to zero at this time.
                let [r, g, b] = options.background.unwrap_or_default();
                let alpha = if options.background.is_some() { 255 } else { 0 };
                let pixel = image::Rgba([r, g, b, alpha]);
                return Ok(Image::from_pixel(width, height, pixel));
            }
            // The ground stays where it is when the model jumps.
            surface.low.y = surface.low.y.min(self.ground);
            let target = RayTarget::new(self.model, surface, Rays::Many);
            draw(&target, options, &framing.camera(options.view))
        })
    }
}
