//! Renders a clip with one camera for all its frames, which stands still or follows the figure.

use std::borrow::Cow;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use glam::{DVec3, Vec3, Vec3Swizzles as _};
use rayon::prelude::*;

use super::camera::{Framing, View};
use super::follow::CameraPath;
use super::ground::Floor;
use super::hierarchy::{Hierarchy, Rays};
use super::model::Model;
use super::posed_model::{Image, Take, check_size, draw};
use super::sampling::{FILM, STILL, Sampling};
use super::surface::{Normalization, Surface};
use super::{MAX_CLIP_FRAMES, MAX_FILM_STRIP_PIXELS, Options, RenderError, on_pool};
use crate::crash::Crash;
use crate::import::{Clip, ImportError, Pose};

/// At how many times the pose is sampled, at most, to find the space that the clip needs.
const MAX_SAMPLES: u32 = 32;
/// How many corners of these samples are kept in memory during framing; those of larger models are computed every time.
const MAX_CACHED_CORNERS: usize = 4 << 20;
/// The longest time that one picture is held, in seconds: file formats cannot store much longer delays.
const MAX_HOLD_SECONDS: f64 = 60.0;
/// The most pixels of the pictures that are rendered at the same time, unless one has more.
const MAX_BATCH_PIXELS: u64 = 8 << 20;
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
    /// How the camera moves, unless it stands still.
    following: Option<Following>,
}

/// A camera that follows what moves from place to place.
struct Following {
    path: CameraPath,
    /// For each node whether it has a mesh that is followed, and so is kept in the picture.
    meshes: Vec<bool>,
    /// The longest side of what is followed, in normalised space.
    length: f32,
    /// How far in front of it there may be something else, in normalised space.
    clearance: f32,
}

/// A film and the camera that frames all of it.
pub struct Shooting<'a> {
    film: &'a Film<'a>,
    options: Options,
    framing: Framing,
    sampling: &'static Sampling,
    /// The triangles of one pose and their hierarchy, which is fitted to other poses.
    hierarchy: (Vec<[u32; 3]>, Hierarchy),
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
            following: None,
        })
    }

    /// The same, with a camera that follows what moves from place to place, smoothly and at one height, and keeps it in the
    /// picture. Lines on the ground show how far it goes. Where nothing moves from place to place, the camera stands still.
    ///
    /// # Errors
    /// A model with too many triangles.
    pub fn following(mut self) -> Result<Self, RenderError> {
        let travellers = self.model.travellers(self.clip);
        if travellers.roots.is_empty() {
            return Ok(self);
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
        self.following = Some(Following {
            meshes: travellers.meshes,
            length,
            // The diagonal of a cube with the longest side of a pose, and the way.
            clearance: 2.0 + (path.length() * self.normalization.scale) as f32,
            path,
        });
        Ok(self)
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

    /// Places the camera.
    ///
    /// # Errors
    /// A size out of range.
    pub fn shooting(&'a self, options: &Options) -> Result<Shooting<'a>, RenderError> {
        self.shooting_sampled(options, &FILM)
    }

    fn shooting_sampled(
        &'a self,
        options: &Options,
        sampling: &'static Sampling,
    ) -> Result<Shooting<'a>, RenderError> {
        let framing = self.framing(options)?;
        let hierarchy = || {
            // As it is drawn, limbs are apart: the boxes of a pose in which they touch would fit other poses badly.
            let pose = self.model.rest().seen_from(options.viewer(options.view));
            let surface = self.model.surface(&pose, Some(self.normalization))?;
            let hierarchy = Hierarchy::new(&surface, Rays::Film);
            Ok((surface.triangles, hierarchy))
        };
        Ok(Shooting {
            film: self,
            options: *options,
            framing,
            sampling,
            hierarchy: on_pool(hierarchy)?,
        })
    }

    fn framing(&self, options: &Options) -> Result<Framing, RenderError> {
        check_size(options.size)?;
        let moments: Vec<f64> = evenly(self.span, MAX_SAMPLES).collect();
        let view = options.view;
        let corners = |time: f64| match &self.following {
            None => Ok::<_, RenderError>(self.surface(options, time)?.used_positions()),
            Some(following) => {
                let pose = self.pose(options, time);
                let marked = &following.meshes;
                let surface = self.model.surface_of(marked, &pose, self.normalization)?;
                let moved = self.camera_offset(time);
                let positions = surface.used_positions().into_iter();
                Ok(positions.map(|position| position - moved).collect())
            }
        };
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
            let framing = Framing::new(&shots, options.projection, options.size, points)?;
            Ok(match &self.following {
                Some(following) => framing.stepping_back(following.clearance),
                None => framing,
            })
        };
        on_pool(framing)
    }

    /// How far the camera has moved at a time, in normalised space.
    fn camera_offset(&self, time: f64) -> Vec3 {
        self.following.as_ref().map_or(Vec3::ZERO, |following| {
            let path = &following.path;
            let moved = path.at(time) - path.at(self.span[0]);
            (moved * self.normalization.scale).as_vec3()
        })
    }

    /// The lines on the ground at a time, if the camera follows something.
    fn floor(&self, time: f64) -> Option<Floor> {
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
    fn pose(&self, options: &Options, time: f64) -> Pose {
        let pose = self.model.pose_at(self.clip, time);
        pose.seen_from(options.viewer(options.view))
    }

    /// The posed surface at a time.
    fn surface(&self, options: &Options, time: f64) -> Result<Surface, RenderError> {
        let pose = self.pose(options, time);
        self.model.surface(&pose, Some(self.normalization))
    }
}

impl Shooting<'_> {
    /// Renders the film at some times. `each` gets the pictures one by one, while the next ones are rendered, and may stop
    /// with its own error.
    ///
    /// # Errors
    /// The error of `each`.
    pub fn draw<E: From<RenderError>>(
        &self,
        moments: impl IntoIterator<Item = f64>,
        mut each: impl FnMut(Image) -> Result<(), E>,
    ) -> Result<(), E> {
        let moments: Vec<f64> = moments.into_iter().collect();
        std::thread::scope(|scope| {
            // A batch is rendered while `each` takes the one before.
            let (sender, batches) = sync_channel(0);
            let moments = &moments;
            std::thread::Builder::new()
                .spawn_scoped(scope, move || self.render(moments, sender))
                .map_err(|_| RenderError::from(Crash::no_threads()))?;
            hand_over(batches, &mut each)
        })
    }

    /// Renders pictures in batches, several at once: much of the work for one picture uses one thread only.
    fn render(&self, moments: &[f64], batches: SyncSender<Batch>) {
        let [width, height] = self.options.size.map(u64::from);
        let fitting = (MAX_BATCH_PIXELS / (width * height)).max(1);
        let work = || Ok(rayon::current_num_threads() as u64);
        let batch = on_pool(work).map_or(1, |threads| threads.min(fitting)) as usize;
        for moments in moments.chunks(batch) {
            let picture = |time: &f64| self.picture(*time);
            let images = on_pool(|| moments.par_iter().map(picture).collect());
            let failed = images.is_err();
            // Nobody takes pictures after an error.
            if batches.send(images).is_err() || failed {
                return;
            }
        }
    }

    fn picture(&self, time: f64) -> Result<Image, RenderError> {
        let (film, options) = (self.film, &self.options);
        let [width, height] = options.size;
        let mut surface = film.surface(options, time)?;
        if surface.triangles.is_empty() {
            // The whole model is scaled to zero at this time.
            let [r, g, b] = options.background.unwrap_or_default();
            let alpha = if options.background.is_some() { 255 } else { 0 };
            let pixel = image::Rgba([r, g, b, alpha]);
            return Ok(Image::from_pixel(width, height, pixel));
        }
        // The ground stays where it is when the model jumps.
        surface.low.y = surface.low.y.min(film.ground);
        let (triangles, hierarchy) = &self.hierarchy;
        let hierarchy = match *triangles == surface.triangles {
            true => hierarchy.fitted(&surface),
            // Other triangles are visible: some are too small in one of the poses.
            false => Hierarchy::new(&surface, Rays::Many),
        };
        let tracer = film.model.tracer_with(surface, hierarchy);
        let camera = self.framing.camera(options.view);
        let take = Take {
            camera: camera.moved(film.camera_offset(time)),
            sampling: self.sampling,
            floor: film.floor(time),
        };
        draw(&tracer, options, &take)
    }
}

/// Consecutive pictures, or why they cannot be rendered.
type Batch = Result<Vec<Image>, RenderError>;

/// Hands over pictures one by one until there are no more. Its end, early or not, ends the rendering of more.
fn hand_over<E: From<RenderError>>(
    batches: Receiver<Batch>,
    each: &mut impl FnMut(Image) -> Result<(), E>,
) -> Result<(), E> {
    for images in batches {
        images?.into_iter().try_for_each(&mut *each)?;
    }
    Ok(())
}
