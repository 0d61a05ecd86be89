//! Renders the pictures of a film one after another, several at the same time.

use std::sync::Mutex;
use std::sync::mpsc::{SyncSender, sync_channel};

use rayon::prelude::*;

use super::camera::{Camera, Framing};
use super::film::Film;
use super::hierarchy::{Hierarchy, Rays};
use super::posed_model::{Image, Take, check_size, draw};
use super::sampling::{FILM, Sampling};
use super::{Options, RenderError, on_pool};
use crate::crash::Crash;
use crate::import::ModelCamera;
use crate::threads;

/// The most pixels of the pictures that are rendered at the same time, unless one has more.
const MAX_BATCH_PIXELS: u64 = 8 << 20;

/// A film and the camera that shows all of it.
pub struct Shooting<'a> {
    film: &'a Film<'a>,
    options: Options,
    camera: FilmCamera<'a>,
    sampling: &'static Sampling,
    /// The triangles of one pose and their hierarchy, which is fitted to other poses.
    hierarchy: (Vec<[u32; 3]>, Hierarchy),
    /// Hierarchies of the same triangles that no picture uses: they need not be allocated again.
    spare: Mutex<Vec<Hierarchy>>,
}

/// The camera of a film.
enum FilmCamera<'a> {
    /// Frames all of the film. It stands still, or goes along with what it follows.
    Framed(Framing),
    /// One of the file, with the yaw at the beginning, degrees: the lights do not turn with it.
    InModel(&'a ModelCamera, f64),
}

impl<'a> Film<'a> {
    /// Places the camera.
    ///
    /// # Errors
    /// A size out of range.
    pub fn shooting(&'a self, options: &Options) -> Result<Shooting<'a>, RenderError> {
        self.shooting_sampled(options, &FILM)
    }

    /// As [`Self::shooting`], with pictures of this quality.
    pub(super) fn shooting_sampled(
        &'a self,
        options: &Options,
        sampling: &'static Sampling,
    ) -> Result<Shooting<'a>, RenderError> {
        check_size(options.size)?;
        let camera = match self.camera {
            None => FilmCamera::Framed(self.framing(options)?),
            Some(camera) => {
                let pose = self.model.pose_at(self.clip, self.span[0]);
                let yaw = self.model.camera_pose(&pose, camera)?.yaw();
                FilmCamera::InModel(camera, yaw)
            }
        };
        let hierarchy = || {
            // As it is drawn, limbs are apart: the boxes of a pose in which they touch would fit other poses badly.
            let pose = self.seen(options, self.model.rest())?;
            let surface = self.model.surface(&pose, Some(self.normalization))?;
            let hierarchy = Hierarchy::new(&surface, Rays::Film);
            Ok((surface.triangles, hierarchy))
        };
        Ok(Shooting {
            film: self,
            options: *options,
            camera,
            sampling,
            hierarchy: on_pool(hierarchy)?,
            spare: Mutex::default(),
        })
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
        if threads::are_none() {
            return hand_over(self.batches(&moments), &mut each);
        }
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

    /// Renders pictures until nobody takes more.
    fn render(&self, moments: &[f64], taken: SyncSender<Batch>) {
        for images in self.batches(moments) {
            let failed = images.is_err();
            // Nobody takes pictures after an error.
            if taken.send(images).is_err() || failed {
                return;
            }
        }
    }

    /// Renders pictures in batches, several at once: much of the work for one picture uses one thread only.
    fn batches<'m>(&'m self, moments: &'m [f64]) -> impl Iterator<Item = Batch> + 'm {
        let [width, height] = self.options.size.map(u64::from);
        let fitting = (MAX_BATCH_PIXELS / (width * height)).max(1);
        let work = || Ok(rayon::current_num_threads() as u64);
        let batch = on_pool(work).map_or(1, |threads| threads.min(fitting)) as usize;
        moments.chunks(batch).map(|moments| {
            let picture = |time: &f64| self.picture(*time);
            on_pool(|| moments.par_iter().map(picture).collect())
        })
    }

    /// The camera at a time.
    fn camera(&self, time: f64) -> Result<Camera, RenderError> {
        let (film, options) = (self.film, &self.options);
        match &self.camera {
            FilmCamera::Framed(framing) => {
                let camera = framing.camera(options.view);
                Ok(camera.moved(film.camera_offset(time)))
            }
            FilmCamera::InModel(camera, yaw) => {
                let pose = film.model.pose_at(film.clip, time);
                let pose = film.model.camera_pose(&pose, camera)?;
                let mut camera = Camera::in_model(camera, &pose, film.normalization, options.size);
                camera.yaw = *yaw;
                Ok(camera)
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
        let same = *triangles == surface.triangles;
        let hierarchy = if same {
            let spare = self.spare.lock().ok().and_then(|mut spare| spare.pop());
            let mut fitted = spare.unwrap_or_else(|| hierarchy.clone());
            fitted.fit(&surface);
            fitted
        } else {
            // Other triangles are visible: some are too small in one of the poses.
            Hierarchy::new(&surface, Rays::Many)
        };
        let tracer = film.model.tracer_with(surface, hierarchy);
        let take = Take {
            camera: self.camera(time)?,
            sampling: self.sampling,
            floor: film.floor(time),
        };
        let image = draw(&tracer, options, &take);
        if same && let Ok(mut spare) = self.spare.lock() {
            spare.push(tracer.into_hierarchy());
        }
        image
    }
}

/// Consecutive pictures, or why they cannot be rendered.
type Batch = Result<Vec<Image>, RenderError>;

/// Hands over pictures one by one until there are no more. Its end, early or not, ends the rendering of more.
fn hand_over<E: From<RenderError>>(
    batches: impl IntoIterator<Item = Batch>,
    each: &mut impl FnMut(Image) -> Result<(), E>,
) -> Result<(), E> {
    for images in batches {
        images?.into_iter().try_for_each(&mut *each)?;
    }
    Ok(())
}
