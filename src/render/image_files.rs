//! Writes pictures as PNG, animated PNG and GIF.

use std::io::{self, Write};

use color_quant::NeuQuant;
use rustc_hash::FxHashMap;

use super::posed_model::Image;

/// The highest frame rate that viewers of GIFs show.
pub const MAX_GIF_FPS: u32 = 50;
/// The shortest delay that viewers of GIFs respect, in hundredths of a second.
const MIN_GIF_DELAY: u16 = 2;
/// The number of colours in a GIF, without the transparent one.
const PALETTE_SIZE: usize = 255;
/// How many pixels the palette of a GIF is computed from, at most.
const MAX_PALETTE_SAMPLES: usize = 200_000;
/// Thresholds for ordered dithering of alpha (Bayer matrix).
const BAYER_8X8: [[u8; 8]; 8] = [
    [0, 32, 8, 40, 2, 34, 10, 42],
    [48, 16, 56, 24, 50, 18, 58, 26],
    [12, 44, 4, 36, 14, 46, 6, 38],
    [60, 28, 52, 20, 62, 30, 54, 22],
    [3, 35, 11, 43, 1, 33, 9, 41],
    [51, 19, 59, 27, 49, 17, 57, 25],
    [15, 47, 7, 39, 13, 45, 5, 37],
    [63, 31, 55, 23, 61, 29, 53, 21],
];

/// Writes a picture as PNG.
///
/// # Errors
/// Those of `out`.
pub fn write_png(image: &Image, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    // Tells pictures that may be replaced from those of other programs.
    let software = concat!("okoshi ", env!("CARGO_PKG_VERSION"));
    let written = encoder
        .add_text_chunk("Software".to_owned(), software.to_owned())
        .and_then(|()| encoder.write_header())
        .and_then(|mut writer| {
            writer.write_image_data(image.as_raw())?;
            writer.finish()
        });
    written.map_err(png_failure)
}

/// The error of the output itself, whose kind the conversion of the crate loses.
fn png_failure(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        error => error.into(),
    }
}

/// As [`png_failure`].
fn gif_failure(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(error) => error,
        error => io::Error::other(error),
    }
}

/// The colours of a GIF: one palette for all frames avoids flicker.
pub struct Palette {
    chosen: NeuQuant,
}

impl Palette {
    /// Computes the palette of sample pictures (NeuQuant).
    pub fn new(samples: &[Image]) -> Self {
        let solid = samples
            .iter()
            .flat_map(|image| image.pixels())
            .filter(|pixel| pixel.0[3] > 127);
        let step = (solid.clone().count() / MAX_PALETTE_SAMPLES).max(1);
        let mut pixels: Vec<u8> = solid
            .step_by(step)
            .flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], 255])
            .collect();
        // Black for shadows, which also keeps the list from being empty.
        pixels.extend([0, 0, 0, 255].repeat(1 + pixels.len() / 4 / PALETTE_SIZE));
        Self {
            chosen: NeuQuant::new(1, PALETTE_SIZE, &pixels),
        }
    }

    /// Red, green and blue of each colour, the transparent one last.
    fn table(&self) -> Vec<u8> {
        let mut table = self.chosen.color_map_rgb();
        table.resize(3 * PALETTE_SIZE, 0);
        table.extend([0, 0, 0]);
        table
    }
}

/// Writes an animated picture frame by frame. It loops forever.
pub struct AnimationWriter<W: Write> {
    file: Format<W>,
    /// When the last frame ends, in seconds.
    until: f64,
    /// The sum of the delays written so far, in the file's own unit.
    written: f64,
}

/// The format of the file.
enum Format<W: Write> {
    /// 256 colours; a pixel is opaque or transparent, so partial alpha is dithered.
    Gif {
        /// Encodes the file.
        encoder: gif::Encoder<W>,
        /// The colours of all frames.
        palette: Palette,
        /// Palette indices that were looked up before.
        known: FxHashMap<[u8; 3], u8>,
    },
    /// Animated PNG: all colours, full alpha.
    Apng(png::Writer<W>),
}

impl<W: Write> AnimationWriter<W> {
    /// Starts a GIF.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn gif(out: W, size: [u32; 2], palette: Palette) -> io::Result<Self> {
        let sides = size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
        let mut encoder =
            gif::Encoder::new(out, sides[0], sides[1], &palette.table()).map_err(gif_failure)?;
        encoder
            .set_repeat(gif::Repeat::Infinite)
            .map_err(gif_failure)?;
        Ok(Self::new(Format::Gif {
            encoder,
            palette,
            known: FxHashMap::default(),
        }))
    }

    /// Starts an animated PNG of `frames` frames.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn apng(out: W, [width, height]: [u32; 2], frames: u32) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_animated(frames, 0).map_err(png_failure)?;
        encoder
            .set_blend_op(png::BlendOp::Source)
            .map_err(png_failure)?;
        let writer = encoder.write_header().map_err(png_failure)?;
        Ok(Self::new(Format::Apng(writer)))
    }

    fn new(file: Format<W>) -> Self {
        Self {
            file,
            until: 0.0,
            written: 0.0,
        }
    }

    /// The delay of a frame that lasts `seconds`, rounded to `1 / units` seconds. Later frames make up for the rounding
    /// error.
    fn delay(&mut self, seconds: f64, units: f64, least: u16) -> u16 {
        self.until += seconds;
        let delay = (self.until * units).round() - self.written;
        let delay = delay.clamp(f64::from(least), f64::from(u16::MAX)) as u16;
        self.written += f64::from(delay);
        delay
    }

    /// Appends a frame that lasts some seconds: rounded to milliseconds, in a GIF to hundredths of a second and at least
    /// two of them.
    ///
    /// # Errors
    /// Those of the output.
    pub fn push(&mut self, image: &Image, seconds: f64) -> io::Result<()> {
        let delay = match self.file {
            Format::Apng(_) => self.delay(seconds, 1000.0, 0),
            Format::Gif { .. } => self.delay(seconds, 100.0, MIN_GIF_DELAY),
        };
        match &mut self.file {
            Format::Apng(writer) => {
                let written = writer
                    .set_frame_delay(delay, 1000)
                    .and_then(|()| writer.write_image_data(image.as_raw()));
                written.map_err(png_failure)
            }
            Format::Gif {
                encoder,
                palette,
                known,
            } => {
                let clear = PALETTE_SIZE as u8;
                let pixels = image.enumerate_pixels().map(|(x, y, pixel)| {
                    let [r, g, b, alpha] = pixel.0;
                    let threshold = BAYER_8X8[(y % 8) as usize][(x % 8) as usize];
                    match alpha > threshold * 4 + 1 {
                        true => *known
                            .entry([r, g, b])
                            .or_insert_with(|| palette.chosen.index_of(&[r, g, b, 255]) as u8),
                        false => clear,
                    }
                });
                let pixels: Vec<u8> = pixels.collect();
                let size = [image.width(), image.height()]
                    .map(|side| u16::try_from(side).unwrap_or(u16::MAX));
                let mut frame =
                    gif::Frame::from_indexed_pixels(size[0], size[1], pixels, Some(clear));
                frame.delay = delay;
                frame.dispose = gif::DisposalMethod::Background;
                encoder.write_frame(&frame).map_err(gif_failure)
            }
        }
    }

    /// Completes the file.
    ///
    /// # Errors
    /// Those of the output, or missing frames.
    pub fn finish(self) -> io::Result<()> {
        match self.file {
            Format::Apng(writer) => writer.finish().map_err(png_failure),
            Format::Gif { encoder, .. } => encoder.into_inner().map(drop).map_err(gif_failure),
        }
    }
}
