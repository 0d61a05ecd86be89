//! Pictures as files: PNG, animated PNG, GIF.

use std::io::{self, Write};

use color_quant::NeuQuant;
use rustc_hash::FxHashMap;

use super::stage::Image;

/// The most frames a second that viewers of GIFs show.
pub const GIF_FPS_LIMIT: u32 = 50;
/// The shortest delay that viewers of GIFs keep, hundredths of a second.
const SHORTEST: u16 = 2;
/// The colours of a GIF, the clear one not counted.
const COLOURS: usize = 255;
/// How many pixels the colours of a GIF are chosen from, at the most.
const SAMPLES: usize = 200_000;
/// Which pixels of eight by eight stay when some must be dropped (Bayer).
const THRESHOLDS: [[u8; 8]; 8] = [
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
/// What `out` answers.
pub fn write_png(image: &Image, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut encoder = png::Encoder::new(out, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(image.as_raw())?;
    Ok(writer.finish()?)
}

/// The colours of a GIF: one list for all frames, so that nothing flickers.
pub struct Palette {
    chosen: NeuQuant,
}

impl Palette {
    /// Chooses colours for pictures like these.
    pub fn new(samples: &[Image]) -> Self {
        let solid = samples
            .iter()
            .flat_map(|image| image.pixels())
            .filter(|pixel| pixel.0[3] > 127);
        let step = (solid.clone().count() / SAMPLES).max(1);
        let mut pixels: Vec<u8> = solid
            .step_by(step)
            .flat_map(|pixel| [pixel.0[0], pixel.0[1], pixel.0[2], 255])
            .collect();
        // Shadows are black, and a list of nothing would not do.
        pixels.extend([0, 0, 0, 255].repeat(1 + pixels.len() / 4 / COLOURS));
        Self {
            chosen: NeuQuant::new(1, COLOURS, &pixels),
        }
    }

    /// Red, green, blue of each, the clear one last.
    fn table(&self) -> Vec<u8> {
        let mut table = self.chosen.color_map_rgb();
        table.resize(3 * COLOURS, 0);
        table.extend([0, 0, 0]);
        table
    }
}

/// A moving picture that is being written, one frame after the other. It runs for ever.
pub struct Animation<W: Write> {
    file: Format<W>,
    /// When the last frame ends, seconds.
    until: f64,
    /// The sum of the delays so far, in the file's own unit.
    told: f64,
}

/// How it is written.
enum Format<W: Write> {
    /// 256 colours; a pixel is there or clear. Half-clear ones are scattered.
    Gif {
        /// What writes it.
        encoder: gif::Encoder<W>,
        /// Its colours.
        palette: Palette,
        /// Colours that were looked up before.
        known: FxHashMap<[u8; 3], u8>,
    },
    /// PNG with frames: all colours, all transparency.
    Apng(png::Writer<W>),
}

impl<W: Write> Animation<W> {
    /// A GIF.
    ///
    /// # Errors
    /// What `out` answers.
    pub fn gif(out: W, size: [u32; 2], palette: Palette) -> io::Result<Self> {
        let sides = size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
        let mut encoder = gif::Encoder::new(out, sides[0], sides[1], &palette.table())
            .map_err(io::Error::other)?;
        encoder
            .set_repeat(gif::Repeat::Infinite)
            .map_err(io::Error::other)?;
        Ok(Self::new(Format::Gif {
            encoder,
            palette,
            known: FxHashMap::default(),
        }))
    }

    /// An animated PNG of `frames` frames.
    ///
    /// # Errors
    /// What `out` answers.
    pub fn apng(out: W, [width, height]: [u32; 2], frames: u32) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_animated(frames, 0)?;
        encoder.set_blend_op(png::BlendOp::Source)?;
        Ok(Self::new(Format::Apng(encoder.write_header()?)))
    }

    fn new(file: Format<W>) -> Self {
        Self {
            file,
            until: 0.0,
            told: 0.0,
        }
    }

    /// How long a frame stands that is to stand so many seconds, in units of which a second has `units`: what is lost by
    /// rounding one frame the next ones make up for.
    fn delay(&mut self, seconds: f64, units: f64, least: u16) -> u16 {
        self.until += seconds;
        let delay = (self.until * units).round() - self.told;
        let delay = delay.clamp(f64::from(least), f64::from(u16::MAX)) as u16;
        self.told += f64::from(delay);
        delay
    }

    /// Appends a frame that stands for some seconds, in a GIF to the hundredth and for two of them at least, else to the
    /// thousandth.
    ///
    /// # Errors
    /// What the output answers.
    pub fn push(&mut self, image: &Image, seconds: f64) -> io::Result<()> {
        let delay = match self.file {
            Format::Apng(_) => self.delay(seconds, 1000.0, 0),
            Format::Gif { .. } => self.delay(seconds, 100.0, SHORTEST),
        };
        match &mut self.file {
            Format::Apng(writer) => {
                writer.set_frame_delay(delay, 1000)?;
                Ok(writer.write_image_data(image.as_raw())?)
            }
            Format::Gif {
                encoder,
                palette,
                known,
            } => {
                let clear = COLOURS as u8;
                let pixels = image.enumerate_pixels().map(|(x, y, pixel)| {
                    let [r, g, b, alpha] = pixel.0;
                    let threshold = THRESHOLDS[(y % 8) as usize][(x % 8) as usize];
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
                encoder.write_frame(&frame).map_err(io::Error::other)
            }
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// What the output answers, or that frames are missing.
    pub fn finish(self) -> io::Result<()> {
        match self.file {
            Format::Apng(writer) => Ok(writer.finish()?),
            Format::Gif { encoder, .. } => encoder.into_inner().map(drop).map_err(io::Error::other),
        }
    }
}
