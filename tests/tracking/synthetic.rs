//! Clips whose marks are known: discs that move before a cluttered background.

use std::f64::consts::TAU;
use std::sync::Arc;

use fastrand::Rng;
use glam::DVec2;

/// Where something is at a time, counted in frames.
pub(crate) type Path = Arc<dyn Fn(f64) -> DVec2 + Send + Sync>;

/// A disc that moves.
#[derive(Clone)]
pub(crate) struct Disc {
    /// Its name and its colour.
    pub(crate) mark: (&'static str, [u8; 3]),
    /// Pixels.
    pub(crate) radius: f64,
    /// Where its middle is at a time, counted in frames.
    pub(crate) path: Path,
}

/// A clip.
#[derive(Clone)]
pub(crate) struct Scene {
    /// Seeds of what chance decides: the patches, and the noise of the first frame.
    pub(crate) seeds: [u64; 2],
    /// Width and height, pixels.
    pub(crate) size: [u32; 2],
    /// Discs, from back to front.
    pub(crate) discs: Vec<Disc>,
    /// How many still patches of any colours are behind the discs.
    pub(crate) colorful: usize,
    /// The colours of more of them.
    pub(crate) patches: Vec<[u8; 3]>,
    /// The standard deviation of the noise, of 255.
    pub(crate) noise: f64,
    /// How long the shutter is open, of 1 frame.
    pub(crate) shutter: f64,
    /// How bright a frame is, of 1.
    pub(crate) light: fn(f64) -> f64,
}

/// The truth about a disc in a frame.
#[derive(Clone, Copy)]
pub(crate) struct Truth {
    pub(crate) at: DVec2,
    /// How much of it is seen, from 0 to 1.
    pub(crate) visible: f64,
}

/// The seeds of the clips that were looked at while tracking was written.
pub(crate) const FITTED: [u64; 2] = [7, 1000];
/// Instants of which a frame is the mean.
const INSTANTS: usize = 9;

impl Disc {
    pub(crate) fn new(
        mark: (&'static str, [u8; 3]),
        radius: f64,
        path: impl Fn(f64) -> DVec2 + Send + Sync + 'static,
    ) -> Self {
        Self {
            mark,
            radius,
            path: Arc::new(path),
        }
    }
}

impl Scene {
    /// The background: a gradient with patches of many colours.
    pub(crate) fn background(&self) -> Vec<[f64; 3]> {
        let [width, height] = self.size.map(|side| side as usize);
        let mut random = Rng::with_seed(self.seeds[0]);
        let scale = width as f64 / 320.0;
        let mut pixels: Vec<[f64; 3]> = (0..width * height)
            .map(|index| {
                let (x, y) = (index % width, index / width);
                let gray = 120.0 + 70.0 * x as f64 / width as f64 - 30.0 * y as f64 / height as f64;
                [gray, gray * 0.97, gray * 0.9]
            })
            .collect();
        let any = |random: &mut Rng| [(); 3].map(|()| random.f64() * 220.0 + 20.0);
        let mut colors: Vec<[f64; 3]> = (0..self.colorful).map(|_| any(&mut random)).collect();
        colors.extend(self.patches.iter().map(|color| color.map(f64::from)));
        for color in colors {
            let from = [random.f64() * width as f64, random.f64() * height as f64];
            let sides = [(); 2].map(|()| (10.0 + 30.0 * random.f64()) * scale);
            for (index, pixel) in pixels.iter_mut().enumerate() {
                let place = [(index % width) as f64, (index / width) as f64];
                if (0..2).all(|axis| (from[axis]..from[axis] + sides[axis]).contains(&place[axis]))
                {
                    *pixel = color;
                }
            }
        }
        pixels
    }

    /// A frame, made from the background.
    pub(crate) fn frame(&self, background: &[[f64; 3]], frame: usize) -> Vec<u8> {
        let [width, height] = self.size.map(|side| side as usize);
        let mut pixels = background.to_vec();
        let instants: Vec<f64> = (0..INSTANTS)
            .map(|instant| {
                frame as f64 + self.shutter * (instant as f64 / (INSTANTS - 1) as f64 - 0.5)
            })
            .collect();
        // Only the pixels that a disc can cover are drawn.
        let mut is_covered = vec![false; width * height];
        for disc in &self.discs {
            for time in &instants {
                let at = (disc.path)(*time);
                let reach = disc.radius + 1.0;
                let range = |middle: f64, side: usize| {
                    let to = (middle + reach + 1.0).clamp(0.0, side as f64) as usize;
                    (middle - reach).clamp(0.0, side as f64) as usize..to
                };
                for y in range(at.y, height) {
                    is_covered[y * width..][range(at.x, width)].fill(true);
                }
            }
        }
        for (index, pixel) in pixels
            .iter_mut()
            .enumerate()
            .filter(|(index, _)| is_covered[*index])
        {
            let place = DVec2::new((index % width) as f64, (index / width) as f64);
            let mut sum = [0.0; 3];
            for time in &instants {
                let mut color = background[index];
                for disc in &self.discs {
                    let cover =
                        (disc.radius + 0.5 - place.distance((disc.path)(*time))).clamp(0.0, 1.0);
                    for (channel, own) in color.iter_mut().zip(disc.mark.1) {
                        *channel += cover * (f64::from(own) - *channel);
                    }
                }
                for (sum, channel) in sum.iter_mut().zip(color) {
                    *sum += channel / INSTANTS as f64;
                }
            }
            *pixel = sum;
        }
        let mut random = Rng::with_seed(self.seeds[1] + frame as u64);
        let light = (self.light)(frame as f64);
        let mut noisy = |value: f64| {
            // The sum of three is nearly normal, with a variance of a quarter.
            let noise = random.f64() + random.f64() + random.f64() - 1.5;
            (value * light + 2.0 * self.noise * noise)
                .round()
                .clamp(0.0, 255.0) as u8
        };
        pixels.iter().flatten().map(|value| noisy(*value)).collect()
    }

    /// Where the discs are in a frame.
    pub(crate) fn truth(&self, frame: usize) -> Vec<Truth> {
        let places: Vec<DVec2> = self
            .discs
            .iter()
            .map(|disc| (disc.path)(frame as f64))
            .collect();
        let size = DVec2::from_array(self.size.map(f64::from));
        let visible = |index: usize| {
            let (at, radius) = (places[index], self.discs[index].radius);
            let points = (0..200).map(|point| {
                // Evenly over the disc.
                let (part, turn) = (
                    (f64::from(point) + 0.5) / 200.0,
                    f64::from(point) * 2.399_963,
                );
                at + radius * part.sqrt() * DVec2::from_angle(turn)
            });
            let is_seen = |point: &DVec2| {
                let in_front = self.discs.iter().zip(&places).skip(index + 1);
                let is_inside =
                    point.cmpge(DVec2::splat(-0.5)).all() && point.cmplt(size - 0.5).all();
                is_inside
                    && in_front
                        .into_iter()
                        .all(|(disc, at)| at.distance(*point) > disc.radius)
            };
            points.filter(is_seen).count() as f64 / 200.0
        };
        (0..places.len())
            .map(|index| Truth {
                at: places[index],
                visible: visible(index),
            })
            .collect()
    }
}

/// A point that goes around in an ellipse, at most `speed` pixels a frame.
pub(crate) fn ellipse(
    time: f64,
    middle: [f64; 2],
    radii: [f64; 2],
    speed: f64,
    phase: f64,
) -> DVec2 {
    let turn = DVec2::from_angle(time * speed / radii[0].max(radii[1]) + phase * TAU);
    DVec2::from_array(middle) + DVec2::from_array(radii) * turn
}
