//! Clips made by chance, of kinds in which something could be taken for the mark.

use std::f64::consts::TAU;
use std::io::Cursor;

use fastrand::Rng;
use glam::DVec2;
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageFormat};

use super::synthetic::{Disc, Path, Scene, Truth};

/// Frames of each clip.
pub(crate) const FRAMES: usize = 100;
/// Width and height of the pictures, pixels.
pub(crate) const SIZE: [u32; 2] = [240, 180];

/// What could be taken for the mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nothing: still patches of other hues.
    Plain,
    /// Nothing, but there is noise, blur, and compression.
    Rough,
    /// Something of the mark's size and colour passes, or moves around.
    Passing,
    /// Some such things stand still, and the mark passes over them or behind them.
    Standing,
    /// A board with a pattern in like colours, compressed.
    Board,
    /// The mark leaves the picture for a while, and something like it is there.
    Leaving,
    /// A large surface of its hue passes.
    Surface,
}

impl Kind {
    pub(crate) const ALL: [Self; 7] = [
        Self::Plain,
        Self::Rough,
        Self::Passing,
        Self::Standing,
        Self::Board,
        Self::Leaving,
        Self::Surface,
    ];
}

/// A clip with one mark.
pub(crate) struct Clip {
    /// About the mark's colour.
    pub(crate) color: [u8; 3],
    /// The mark's radius, pixels.
    pub(crate) radius: f64,
    pub(crate) frames: Vec<Vec<u8>>,
    /// Where the mark is in each frame.
    pub(crate) truth: Vec<Truth>,
}

/// A rectangle that passes behind the mark, or before it.
struct Surface {
    color: [u8; 3],
    /// Half its width and height, pixels.
    half: DVec2,
    /// Where its middle is in a frame.
    path: Path,
    is_in_front: bool,
}

/// What marks are painted with.
const COLORS: [[u8; 3]; 8] = [
    [205, 40, 45],
    [230, 120, 30],
    [225, 205, 40],
    [40, 150, 60],
    [30, 165, 180],
    [40, 70, 190],
    [120, 50, 170],
    [220, 60, 150],
];

/// A clip of a kind. The same seed gives the same clip.
pub(crate) fn clip(kind: Kind, seed: u64) -> Clip {
    let mut random = Rng::with_seed(1_000_003 * (kind as u64 + 1) + seed);
    let random = &mut random;
    let color = COLORS[random.usize(..COLORS.len())];
    let color = near(random, color, 12.0);
    let radius = 5.0 + 4.0 * random.f64();
    let leaves = kind == Kind::Leaving;
    let mark = Disc {
        mark: ("mark", color),
        radius,
        path: path(random, leaves),
    };
    let alike = |random: &mut Rng, path: Path| Disc {
        mark: ("alike", near(random, color, 18.0)),
        radius: radius * (0.8 + 0.45 * random.f64()),
        path,
    };
    let mut others = Vec::new();
    let mut surface = None;
    match kind {
        Kind::Plain | Kind::Rough | Kind::Board => {}
        Kind::Passing => {
            let way = match random.bool() {
                true => pass(random),
                false => path(random, false),
            };
            others.push(alike(random, way));
        }
        Kind::Standing => {
            for _ in 0..1 + random.usize(..3) {
                // On the mark's way.
                let at = (mark.path)(random.f64() * FRAMES as f64);
                let away = between(random, -3.0, 3.0);
                let way: Path = std::sync::Arc::new(move |_| at + away);
                others.push(alike(random, way));
            }
        }
        Kind::Leaving => {
            let way: Path = match random.usize(..3) {
                0 => path(random, false),
                1 => pass(random),
                _ => {
                    let at = DVec2::new(between(random, 20.0, 220.0), between(random, 20.0, 160.0));
                    std::sync::Arc::new(move |_| at)
                }
            };
            others.push(alike(random, way));
        }
        Kind::Surface => {
            surface = Some(Surface {
                color: near(random, color, 18.0),
                half: DVec2::new(between(random, 18.0, 40.0), between(random, 25.0, 60.0)),
                path: pass(random),
                is_in_front: random.bool(),
            });
        }
    }
    let is_rough = kind == Kind::Rough;
    let scene = Scene {
        seeds: [seed, 1000 * seed],
        size: SIZE,
        discs: vec![mark.clone()],
        colorful: 0,
        patches: unlike(random, color),
        noise: between(random, 2.0, if is_rough { 14.0 } else { 7.0 }),
        shutter: random.f64() * if is_rough { 1.0 } else { 0.5 },
        light: |_| 1.0,
    };
    // Before the mark or behind it.
    let mut discs: Vec<Disc> = Vec::new();
    let in_front = others.len() - random.usize(..=others.len());
    discs.extend(others.drain(in_front..));
    let index = discs.len();
    discs.push(mark);
    discs.extend(others);
    let scene = Scene { discs, ..scene };
    let mut still = scene.background();
    if kind == Kind::Board {
        board(random, color, &mut still);
    }
    let quality = match kind {
        Kind::Board => Some(random.u8(30..=90)),
        Kind::Rough => Some(random.u8(40..=95)),
        _ => random.bool().then(|| random.u8(60..=95)),
    };
    let frame = |number: usize| {
        let mut background = std::borrow::Cow::Borrowed(&still);
        if let Some(surface) = surface.as_ref().filter(|surface| !surface.is_in_front) {
            let pixels = background.to_mut();
            surface.paint(number, |index| {
                pixels[index] = surface.color.map(f64::from);
            });
        }
        let mut pixels = scene.frame(&background, number);
        if let Some(surface) = surface.as_ref().filter(|surface| surface.is_in_front) {
            let mut random = Rng::with_seed(number as u64);
            surface.paint(number, |index| {
                for (channel, color) in surface.color.iter().enumerate() {
                    pixels[3 * index + channel] = color.saturating_sub(4) + random.u8(..9);
                }
            });
        }
        match quality {
            Some(quality) => compressed(&pixels, quality),
            None => pixels,
        }
    };
    let truth = |number: usize| {
        let mut truth = scene.truth(number)[index];
        if let Some(surface) = surface.as_ref().filter(|surface| surface.is_in_front) {
            let away = ((surface.path)(number as f64) - truth.at).abs() - surface.half;
            if away.max_element() < radius {
                truth.visible = 0.0;
            }
        }
        truth
    };
    Clip {
        color,
        radius,
        frames: (0..FRAMES).map(frame).collect(),
        truth: (0..FRAMES).map(truth).collect(),
    }
}

impl Surface {
    /// Calls a function for all pixels that it covers in a frame.
    fn paint(&self, number: usize, mut pixel: impl FnMut(usize)) {
        let at = (self.path)(number as f64);
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let away = (DVec2::new(f64::from(x), f64::from(y)) - at).abs();
                if away.cmple(self.half).all() {
                    pixel((y * SIZE[0] + x) as usize);
                }
            }
        }
    }
}

fn between(random: &mut Rng, least: f64, most: f64) -> f64 {
    least + (most - least) * random.f64()
}

/// A colour near another one.
fn near(random: &mut Rng, color: [u8; 3], most: f64) -> [u8; 3] {
    color.map(|channel| (f64::from(channel) + between(random, -most, most)).clamp(0.0, 255.0) as u8)
}

/// Colours that are not like a mark's: greys, and those whose channels are turned.
fn unlike(random: &mut Rng, [r, g, b]: [u8; 3]) -> Vec<[u8; 3]> {
    let mut colors = vec![[g, b, r], [b, r, g]];
    colors.extend((0..3).map(|_| [random.u8(30..220); 3]));
    colors
}

/// A way of a mark in the picture; one that leaves it does so to one or two sides.
fn path(random: &mut Rng, leaves: bool) -> Path {
    let [width, height] = SIZE.map(f64::from);
    let mut turn = |most: f64| (between(random, 0.03, 0.13), most * TAU * random.f64());
    let ([x, y], [slow, fast]) = ([turn(1.0), turn(1.0)], [turn(1.0), turn(1.0)]);
    let reach = match leaves {
        true => DVec2::new(0.75 * width, 0.4 * height),
        false => DVec2::new(
            between(random, 0.15, 0.4) * width,
            between(random, 0.15, 0.4) * height,
        ),
    };
    let middle = DVec2::new(width, height) / 2.0;
    let wobble = between(random, 0.0, 0.1);
    std::sync::Arc::new(move |time| {
        let wave = |(speed, phase): (f64, f64)| (speed * time + phase).sin();
        let sway = wobble * DVec2::new(wave(slow), wave(fast));
        middle + reach * (DVec2::new(wave(x), wave(y)) * (1.0 - wobble) + sway)
    })
}

/// A way across the picture.
fn pass(random: &mut Rng) -> Path {
    let [width, height] = SIZE.map(f64::from);
    let y = [(); 2].map(|()| between(random, 0.15, 0.85) * height);
    let speed = between(random, 2.5, 12.0);
    let start = between(random, -10.0, 40.0);
    let is_mirrored = random.bool();
    std::sync::Arc::new(move |time| {
        let x = speed * (time - start) - 45.0;
        let part = x / width;
        let x = if is_mirrored { width - x } else { x };
        DVec2::new(x, y[0] + (y[1] - y[0]) * part)
    })
}

/// Draws a board with a pattern of squares or stripes, in the mark's hue, paler or darker.
fn board(random: &mut Rng, color: [u8; 3], pixels: &mut [[f64; 3]]) {
    let cell = between(random, 6.0, 24.0);
    let (is_striped, slope) = (random.bool(), between(random, 0.0, 0.5));
    let colors = [(); 3].map(|()| {
        let (pale, dark) = (between(random, 0.1, 0.75), between(random, 0.6, 1.1));
        let gray = color.iter().map(|channel| f64::from(*channel)).sum::<f64>() / 3.0;
        near(random, color, 15.0).map(|channel| {
            let channel = f64::from(channel);
            ((channel + pale * (gray - channel)) * dark).clamp(0.0, 255.0)
        })
    });
    let from = DVec2::new(between(random, -40.0, 80.0), between(random, -40.0, 60.0));
    let to = from + DVec2::new(between(random, 90.0, 220.0), between(random, 80.0, 160.0));
    for (index, pixel) in pixels.iter_mut().enumerate() {
        let place = DVec2::new(
            (index % SIZE[0] as usize) as f64,
            (index / SIZE[0] as usize) as f64,
        );
        if place.cmpge(from).all() && place.cmplt(to).all() {
            let u = ((place.x + slope * place.y) / cell).floor() as i64;
            let v = ((place.y - slope * place.x) / cell).floor() as i64;
            let number = if is_striped { u } else { u + v };
            *pixel = colors[number.rem_euclid(3) as usize];
        }
    }
}

/// A frame after it was compressed as JPEG.
fn compressed(pixels: &[u8], quality: u8) -> Vec<u8> {
    let mut file = Vec::new();
    JpegEncoder::new_with_quality(&mut file, quality)
        .encode(pixels, SIZE[0], SIZE[1], ExtendedColorType::Rgb8)
        .expect("a JPEG");
    image::load(Cursor::new(file), ImageFormat::Jpeg)
        .expect("a JPEG")
        .into_rgb8()
        .into_raw()
}
