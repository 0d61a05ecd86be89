//! Renders a clip with one camera for all its frames, which stands still, follows the figure, or is one of the file's.

use std::borrow::Cow;

use glam::{DVec3, Vec3, Vec3Swizzles as _};
use rayon::prelude::*;
use typed_index_collections::TiVec;

use super::camera::{Framing, View};
use super::follow::CameraPath;
use super::ground::Floor;
use super::model::Model;
use super::posed_model::Image;
use super::sampling::STILL;
use super::surface::{Normalization, Surface};
use super::{MAX_CLIP_FRAMES, MAX_FILM_STRIP_PIXELS, Options, RenderError, on_pool};
use crate::import::{Clip, ImportError, ModelCamera, NodeId, Pose};

/// At how many times the pose is sampled, at most, to find the space that the clip needs.
const MAX_SAMPLES: u32 = 32;
/// How many corners of these samples are kept in memory during framing; those of larger models are computed every time.
const MAX_CACHED_CORNERS: usize = 4 << 20;
/// The longest time that one picture is held, in seconds: file formats cannot store much longer delays.
const MAX_HOLD_SECONDS: f64 = 60.0;
/// How far a camera moves at least if it moves at all, in normalised space.
const LEAST_MOVE: f32 = 1e-5;
/// A remainder of less than this many frames does not become a frame.
const FRAME_TOLERANCE: f64 = 1e-4;

/// A stretch of a clip to render.
pub struct Film<'a> {
    pub(super) model: &'a Model,
    pub(super) clip: &'a Clip,
    /// Its first and its last time, in seconds of the clip.
    pub(super) span: [f64; 2],
    /// Normalised space: centred on all that the model does, with the scale of its largest pose.
    pub(super) normalization: Normalization,
    /// The height of the ground in normalised space: below all poses.
    pub(super) ground: f32,
    /// The largest number of triangles of any sampled pose.
    pub triangles: usize,
    /// The camera of the file that films it.
    pub(super) camera: Option<&'a ModelCamera>,
    /// What moves from place to place. A camera that is not of the file follows it; lines show how it moves over the ground.
    following: Option<Following>,
}

/// The path of what moves from place to place.
struct Following {
    path: CameraPath,
    /// For each node whether it has a mesh that is followed, and so is kept in the picture.
    meshes: TiVec<NodeId, bool>,
    /// The longest side of what is followed, in normalised space.
    length: f32,
    /// How far in front of it there may be something else, in normalised space.
    clearance: f32,
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
            camera: None,
            following: None,
        })
    }

    /// The same, with a camera that follows what moves from place to place, smoothly and at one height, and keeps it in the
    /// picture. Lines on the ground show how far it goes. Where nothing moves from place to place, the camera stands still.
    ///
    /// # Errors
    /// A model with too many triangles.
    pub fn following(mut self) -> Result<Self, RenderError> {
        self.following = self.path()?;
        Ok(self)
    }

    /// The same, filmed by a camera of the file. If it moves, and something travels, lines on the ground show how far.
    ///
    /// # Errors
    /// A camera without a direction; a model with too many triangles.
    pub fn filmed_by(mut self, camera: &'a ModelCamera) -> Result<Self, RenderError> {
        let eye = |time: f64| {
            let pose = self.model.pose_at(self.clip, time);
            let eye = self.model.camera_pose(&pose, camera)?.eye;
            Ok::<_, RenderError>(self.normalization.apply(eye).as_vec3())
        };
        let start = eye(self.span[0])?;
        let mut moves = false;
        for time in evenly(self.span, MAX_SAMPLES) {
            moves |= eye(time)?.distance(start) > LEAST_MOVE;
        }
        self.following = if moves { self.path()? } else { None };
        self.camera = Some(camera);
        Ok(self)
    }

    /// The path of what moves from place to place, if anything does.
    fn path(&self) -> Result<Option<Following>, RenderError> {
        let travellers = self.model.travellers(self.clip);
        if travellers.roots.is_empty() {
            return Ok(None);
        }
        let length = || {
            let mut length = 0.0_f32;
            for time in evenly(self.span, MAX_SAMPLES) {
                let pose = self.model.pose_at(self.clip, time);
                let surface =
                    self.model
                        .surface_of(&travellers.meshes, &pose, self.normalization)?;
                if !surface.triangles.is_empty() {
                    length = length.max((surface.high - surface.low).max_element());
                }
            }
            Ok(length)
        };
        let length = on_pool(length)?;
        let path = CameraPath::new(self.model, self.clip, &travellers, self.span);
        Ok(Some(Following {
            meshes: travellers.meshes,
            length,
            // The diagonal of a cube with the longest side of a pose, and the way.
            clearance: 2.0 + (path.length() * self.normalization.scale) as f32,
            path,
        }))
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
            // A camera that does not film must not make pictures differ.
            let pose = self.model.without_cameras(pose, self.camera);
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
        let shooting = self.shooting_sampled(options, &STILL)?;
        shooting.draw(evenly(self.span, cells), |image| {
            let left = i64::from(cell * width);
            image::imageops::replace(&mut strip, &image, left, 0);
            cell += 1;
            done(cell);
            Ok::<(), RenderError>(())
        })?;
        Ok(strip)
    }

    /// The camera that frames all of the film.
    pub(super) fn framing(&self, options: &Options) -> Result<Framing, RenderError> {
        let moments: Vec<f64> = evenly(self.span, MAX_SAMPLES).collect();
        let view = options.view;
        let corners = |time: f64| match &self.following {
            None => Ok::<_, RenderError>(self.surface(options, time)?.used_positions()),
            Some(following) => {
                let pose = self.pose(options, time)?;
                let marked = &following.meshes;
                let surface = self.model.surface_of(marked, &pose, self.normalization)?;
                let moved = self.camera_offset(time);
                let positions = surface.used_positions().into_iter();
                Ok(positions.map(|position| position - moved).collect())
            }
        };
        let few = self.triangles.saturating_mul(3 * moments.len()) <= MAX_CACHED_CORNERS;
        let framing = || {
            let kept: Vec<Vec<Vec3>> = if few {
                let all = moments.par_iter().map(|time| corners(*time));
                all.collect::<Result<_, _>>()?
            } else {
                Vec::new()
            };
            let shots: Vec<(View, usize)> =
                (0..moments.len()).map(|moment| (view, moment)).collect();
            let points = |_, moment: usize| match kept.get(moment) {
                Some(kept) => Ok(Cow::Borrowed(&**kept)),
                None => corners(moments[moment]).map(Cow::Owned),
            };
            let framing = Framing::new(&shots, options.projection, options.size, points)?;
            Ok(match &self.following {
                Some(following) => framing.stepping_back(following.clearance),
                None => framing,
            })
        };
        on_pool(framing)
    }

    /// How far a camera that follows has moved at a time, in normalised space.
    pub(super) fn camera_offset(&self, time: f64) -> Vec3 {
        self.following.as_ref().map_or(Vec3::ZERO, |following| {
            let path = &following.path;
            let moved = path.at(time) - path.at(self.span[0]);
            (moved * self.normalization.scale).as_vec3()
        })
    }

    /// The lines on the ground at a time, if the camera moves.
    pub(super) fn floor(&self, time: f64) -> Option<Floor> {
        let following = self.following.as_ref()?;
        let on_ground = |place: DVec3| self.normalization.apply(place).as_vec3().xz();
        Some(Floor::new(
            on_ground(DVec3::ZERO),
            self.normalization.scale,
            on_ground(following.path.at(time)),
            following.length,
        ))
    }

    /// The pose at a time, for the viewer.
    fn pose(&self, options: &Options, time: f64) -> Result<Pose, RenderError> {
        self.seen(options, self.model.pose_at(self.clip, time))
    }

    /// A pose for the viewer.
    pub(super) fn seen(&self, options: &Options, pose: Pose) -> Result<Pose, RenderError> {
        let viewer = match self.camera {
            None => options.viewer(options.view),
            Some(camera) => {
                let towards = self.model.camera_pose(&pose, camera)?.towards;
                options.bend.then_some(towards)
            }
        };
        Ok(pose.seen_from(viewer))
    }

    /// The posed surface at a time.
    pub(super) fn surface(&self, options: &Options, time: f64) -> Result<Surface, RenderError> {
        let pose = self.pose(options, time)?;
        self.model.surface(&pose, Some(self.normalization))
    }
}
