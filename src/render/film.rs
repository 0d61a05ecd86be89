//! A clip, ready to be drawn: one camera for all its moments.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::camera::{Framing, View};
use super::model::Model;
use super::stage::{Image, Posed, check_size, pixels};
use super::surface::{Frame, Surface};
use super::trace::Rays;
use super::{CLIP_FRAME_LIMIT, Options, RenderError, STRIP_LIMIT};
use crate::import::{Clip, ImportError};
use crate::threads;

/// How many moments are looked at to find where the clip takes place, at the most.
const MOMENTS: u32 = 32;
/// How many corners at those moments are kept while a picture is framed; those of larger models are found again each time.
const KEPT_CORNERS: usize = 4 << 20;
/// The longest time that one picture stands, seconds: files of frames cannot say much more.
const LONGEST: f64 = 60.0;
/// A part of a frame that is no frame of its own.
const SLIVER: f64 = 1e-4;

/// A stretch of a clip.
pub struct Film<'a> {
    model: &'a Model,
    clip: &'a Clip,
    /// Its first moment and its last, seconds of the clip.
    span: [f64; 2],
    /// Where the world lies on the stage: the model as large as ever, the middle of all that it does in the middle.
    frame: Frame,
    /// How high the ground lies on the stage: below all that the model does.
    ground: f32,
    triangles: usize,
}

/// A picture of a film, and how long it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// When it is, seconds of the clip.
    pub time: f64,
    /// How long it stands, seconds.
    pub seconds: f64,
    /// How many frames that is.
    pub frames: u32,
}

/// `count` moments from the first of a span to its last, evenly.
fn evenly([from, to]: [f64; 2], count: u32) -> impl Iterator<Item = f64> {
    let steps = f64::from(count.saturating_sub(1).max(1));
    (0..count).map(move |index| from + (to - from) * f64::from(index) / steps)
}

impl<'a> Film<'a> {
    /// A stretch of a clip, from one moment to a later one, seconds of the clip.
    ///
    /// # Errors
    /// A model without triangles, or with too many.
    pub fn new(model: &'a Model, clip: &'a Clip, span: [f64; 2]) -> Result<Self, RenderError> {
        let moments: Vec<f64> = evenly(span, MOMENTS).collect();
        let boxes = || -> Result<Vec<_>, RenderError> {
            let look = |time: &f64| {
                let surface = model.surface(&model.pose_at(clip, *time), None)?;
                let Frame { middle, scale } = surface.frame;
                let half = (surface.high - surface.low).as_dvec3() / 2.0 / scale;
                let count = surface.triangles.len();
                Ok((count > 0).then_some((middle - half, middle + half, count)))
            };
            let found: Result<Vec<_>, RenderError> = moments.iter().map(look).collect();
            Ok(found?.into_iter().flatten().collect())
        };
        let boxes = threads::run(boxes).unwrap_or(Err(RenderError::Broken))?;
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
        let frame = Frame {
            middle: (low + high) / 2.0,
            scale: if size > 0.0 { 1.0 / size } else { 1.0 },
        };
        Ok(Self {
            model,
            clip,
            span,
            frame,
            ground: frame.place(low).y as f32,
            triangles,
        })
    }

    /// How many triangles there are, at the most.
    pub fn triangles(&self) -> usize {
        self.triangles
    }

    /// How long it is, seconds.
    pub fn seconds(&self) -> f64 {
        self.span[1] - self.span[0]
    }

    /// The pictures that it is made of at so many frames a second: one for all frames in a row that show the same pose,
    /// unless that is longer than a minute.
    ///
    /// # Errors
    /// More than [`CLIP_FRAME_LIMIT`] frames.
    pub fn shots(&self, fps: u32) -> Result<Vec<Shot>, RenderError> {
        let (fps, seconds) = (f64::from(fps), self.seconds());
        let frames = (seconds * fps - SLIVER).ceil().max(1.0);
        if frames > f64::from(CLIP_FRAME_LIMIT) {
            return Err(RenderError::TooManyFrames(frames));
        }
        let mut shots: Vec<Shot> = Vec::new();
        let mut shown = None;
        for frame in 0..frames as u32 {
            let since = f64::from(frame) / fps;
            let last = f64::from(frame + 1) >= frames && seconds > 0.0;
            let shot = Shot {
                time: self.span[0] + since,
                seconds: if last { seconds - since } else { 1.0 / fps },
                frames: 1,
            };
            let pose = self.model.pose_at(self.clip, shot.time);
            match shots.last_mut() {
                Some(before)
                    if shown.as_ref() == Some(&pose)
                        && before.seconds + shot.seconds <= LONGEST =>
                {
                    before.seconds += shot.seconds;
                    before.frames += 1;
                }
                _ => shots.push(shot),
            }
            shown = Some(pose);
        }
        Ok(shots)
    }

    /// Draws moments of the clip, all as one camera sees them that has the whole film in the picture; `each` gets one
    /// picture after the other and may break off with an error of its own.
    ///
    /// # Errors
    /// A size out of range, or what `each` answers.
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

    /// Draws `cells` moments side by side, from the first to the last, evenly; each takes the size that the options say.
    /// `done` is told how many there are.
    ///
    /// # Errors
    /// A size out of range, or more than [`STRIP_LIMIT`] pixels.
    pub fn strip(
        &self,
        options: &Options,
        cells: u32,
        done: impl Fn(u32),
    ) -> Result<Image, RenderError> {
        let [width, height] = options.size;
        let wide = u64::from(width) * u64::from(cells);
        if wide * u64::from(height) > STRIP_LIMIT {
            return Err(RenderError::Strip(wide, height));
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
        let moments: Vec<f64> = evenly(self.span, MOMENTS).collect();
        let view = options.view;
        let corners = |time: f64| Ok::<_, RenderError>(self.surface(options, time)?.used());
        let few = self.triangles.saturating_mul(3 * moments.len()) <= KEPT_CORNERS;
        let framing = || {
            let kept: Vec<Vec<Vec3>> = match few {
                true => moments
                    .par_iter()
                    .map(|time| corners(*time))
                    .collect::<Result<_, _>>()?,
                false => Vec::new(),
            };
            let sights: Vec<(View, usize)> =
                (0..moments.len()).map(|moment| (view, moment)).collect();
            let points = |_, moment: usize| match kept.get(moment) {
                Some(kept) => Ok(Cow::Borrowed(&**kept)),
                None => corners(moments[moment]).map(Cow::Owned),
            };
            Framing::new(&sights, options.projection, options.size, points)
        };
        threads::run(framing).unwrap_or(Err(RenderError::Broken))
    }

    /// The model at a moment.
    fn surface(&self, options: &Options, time: f64) -> Result<Surface, RenderError> {
        let [_, _, towards] = options.view.axes();
        let pose = self.model.pose_at(self.clip, time);
        let pose = pose.seen_from(options.bend.then_some(towards));
        self.model.surface(&pose, Some(self.frame))
    }

    fn picture(
        &self,
        options: &Options,
        framing: &Framing,
        time: f64,
    ) -> Result<Image, RenderError> {
        let [width, height] = options.size;
        let draw = || {
            let mut surface = self.surface(options, time)?;
            if surface.triangles.is_empty() {
                // All of it is scaled to nothing for a while.
                let [r, g, b] = options.background.unwrap_or_default();
                let alpha = if options.background.is_some() { 255 } else { 0 };
                let pixel = image::Rgba([r, g, b, alpha]);
                return Ok(Image::from_pixel(width, height, pixel));
            }
            // Who jumps leaves the ground where it is.
            surface.low.y = surface.low.y.min(self.ground);
            let posed = Posed::new(self.model, surface, Rays::Many);
            let pixels = pixels(&posed, options, framing, options.view);
            Image::from_raw(width, height, pixels).ok_or(RenderError::Broken)
        };
        threads::run(draw).unwrap_or(Err(RenderError::Broken))
    }
}
