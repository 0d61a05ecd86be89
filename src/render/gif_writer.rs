//! Writes animated GIFs.

use std::io::{self, Write};

use color_quant::NeuQuant;
use rustc_hash::FxHashMap;

use super::posed_model::Image;

/// The highest frame rate that viewers of GIFs show.
pub const MAX_GIF_FPS: u32 = 50;
/// The index of the background's colour.
const BACKGROUND: u8 = 254;
/// The index of transparent pixels.
const CLEAR: u8 = 255;
/// The number of other colours.
const CHOSEN_COLORS: usize = BACKGROUND as usize;
/// How many pixels the palette is computed from, at most.
const MAX_PALETTE_SAMPLES: usize = 60_000;
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

/// The error of the output itself, whose kind the conversion of the crate loses.
fn gif_failure(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(error) => error,
        error => io::Error::other(error),
    }
}

/// The colours of a GIF: one palette for all frames avoids flicker.
pub struct Palette {
    chosen: NeuQuant,
    background: Option<[u8; 3]>,
}

impl Palette {
    /// Computes the palette of sample pictures (NeuQuant), which have this background; `None` is transparent. The background
    /// keeps its exact colour.
    pub fn new<'i>(
        samples: impl IntoIterator<Item = &'i Image, IntoIter: Clone>,
        background: Option<[u8; 3]>,
    ) -> Self {
        let solid = samples
            .into_iter()
            .flat_map(|image| image.pixels())
            .map(|pixel| pixel.0)
            .filter(|[r, g, b, alpha]| *alpha > 127 && Some([*r, *g, *b]) != background);
        let step = solid.clone().count().div_ceil(MAX_PALETTE_SAMPLES).max(1);
        let mut pixels: Vec<u8> = solid
            .step_by(step)
            .flat_map(|[r, g, b, _]| [r, g, b, 255])
            .collect();
        // Black for shadows, which also keeps the list from being empty.
        pixels.extend([0, 0, 0, 255].repeat(1 + pixels.len() / 4 / CHOSEN_COLORS));
        Self {
            chosen: NeuQuant::new(1, CHOSEN_COLORS, &pixels),
            background,
        }
    }

    /// Red, green and blue of each colour, in the order of their indices.
    fn table(&self) -> Vec<u8> {
        let mut table = self.chosen.color_map_rgb();
        table.resize(3 * CHOSEN_COLORS, 0);
        table.extend(self.background.unwrap_or_default());
        table.extend([0, 0, 0]);
        table
    }

    /// The index of the nearest colour.
    fn nearest(&self, color: [u8; 3]) -> u8 {
        let [r, g, b] = color;
        let chosen = self.chosen.index_of(&[r, g, b, 255]);
        let of_chosen = self.chosen.lookup(chosen).unwrap_or_default();
        let distance = |other: [u8; 3]| -> u32 {
            let apart = (0..3).map(|channel| u32::from(color[channel].abs_diff(other[channel])));
            apart.map(|apart| apart * apart).sum()
        };
        match self.background {
            Some(background)
                if distance(background) <= distance([of_chosen[0], of_chosen[1], of_chosen[2]]) =>
            {
                BACKGROUND
            }
            _ => chosen as u8,
        }
    }
}

/// Writes an animated GIF frame by frame. It loops forever.
pub(super) struct GifWriter<W: Write> {
    encoder: gif::Encoder<W>,
    palette: Palette,
    /// Indices of colours that were looked up before.
    known: FxHashMap<u32, u8>,
    size: [u16; 2],
    /// The indices of the frame before, row by row; empty before the first.
    shown: Vec<u8>,
}

impl<W: Write> GifWriter<W> {
    pub(super) fn new(out: W, size: [u32; 2], palette: Palette) -> io::Result<Self> {
        let size = size.map(|side| u16::try_from(side).unwrap_or(u16::MAX));
        let encoder = gif::Encoder::new(out, size[0], size[1], &palette.table());
        let mut encoder = encoder.map_err(gif_failure)?;
        encoder
            .set_repeat(gif::Repeat::Infinite)
            .map_err(gif_failure)?;
        Ok(Self {
            encoder,
            palette,
            known: FxHashMap::default(),
            size,
            shown: Vec::new(),
        })
    }

    /// Appends a frame with a delay in hundredths of a second.
    pub(super) fn push(&mut self, image: &Image, delay: u16) -> io::Result<()> {
        let indices = self.indices(image);
        let mut frame = match self.palette.background {
            Some(_) => self.changed_part(&indices),
            None => gif::Frame {
                dispose: gif::DisposalMethod::Background,
                ..self.frame([0, 0], self.size, indices.clone())
            },
        };
        frame.delay = delay;
        self.shown = indices;
        self.encoder.write_frame(&frame).map_err(gif_failure)
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.encoder.into_inner().map(drop).map_err(gif_failure)
    }

    /// The index of each pixel's colour. On a transparent background a pixel is opaque or not, so partial alpha is dithered.
    fn indices(&mut self, image: &Image) -> Vec<u8> {
        let (palette, known) = (&self.palette, &mut self.known);
        // Most pixels have the colour of the one before. No colour is `u32::MAX`.
        let mut before = (u32::MAX, CLEAR);
        let pixels = image.enumerate_pixels().map(|(x, y, pixel)| {
            let [r, g, b, alpha] = pixel.0;
            let threshold = BAYER_8X8[(y % 8) as usize][(x % 8) as usize];
            if alpha > threshold * 4 + 1 {
                let color = u32::from_le_bytes([r, g, b, 0]);
                if color != before.0 {
                    let nearest = || palette.nearest([r, g, b]);
                    before = (color, *known.entry(color).or_insert_with(nearest));
                }
                before.1
            } else {
                CLEAR
            }
        });
        pixels.collect()
    }

    /// The part of a frame that differs from the one before, which stays in view around it.
    fn changed_part(&self, indices: &[u8]) -> gif::Frame<'static> {
        let width = usize::from(self.size[0]);
        let is_changed = |index: usize| self.shown.get(index) != Some(&indices[index]);
        let mut low = [usize::MAX; 2];
        let mut high = [0; 2];
        for index in (0..indices.len()).filter(|index| is_changed(*index)) {
            for (axis, place) in [index % width, index / width].into_iter().enumerate() {
                low[axis] = low[axis].min(place);
                high[axis] = high[axis].max(place);
            }
        }
        if low[0] > high[0] {
            // A frame needs a pixel.
            (low, high) = ([0, 0], [0, 0]);
        }
        let part = (low[1]..=high[1]).flat_map(|y| (low[0]..=high[0]).map(move |x| y * width + x));
        let pixels = part.map(|index| {
            if is_changed(index) {
                indices[index]
            } else {
                CLEAR
            }
        });
        let side = |axis: usize| (high[axis] - low[axis] + 1) as u16;
        let corner = low.map(|place| place as u16);
        gif::Frame {
            dispose: gif::DisposalMethod::Keep,
            ..self.frame(corner, [side(0), side(1)], pixels.collect())
        }
    }

    fn frame(
        &self,
        [left, top]: [u16; 2],
        [width, height]: [u16; 2],
        pixels: Vec<u8>,
    ) -> gif::Frame<'static> {
        gif::Frame {
            left,
            top,
            ..gif::Frame::from_indexed_pixels(width, height, pixels, Some(CLEAR))
        }
    }
}

#[cfg(test)]
mod tests {
    use image::{AnimationDecoder as _, Rgba};

    use super::*;

    /// A disk with soft edges and a soft shadow at a place, over a colour or none.
    fn ball(middle: f32, background: Option<[u8; 3]>) -> Image {
        Image::from_fn(60, 40, |x, y| {
            let distance = (x as f32 - middle).hypot(y as f32 - 18.0);
            let cover = (12.5 - distance).clamp(0.0, 1.0);
            let shadow = ((20.0 - distance) / 20.0).clamp(0.0, 1.0) * 0.5;
            let alpha = cover + shadow * (1.0 - cover);
            let over = |color: f32, behind: u8| {
                (color * cover + f32::from(behind) * (1.0 - alpha)).round() as u8
            };
            match background {
                Some([r, g, b]) => {
                    Rgba([over(200.0, r), over(3.0 * y as f32, g), over(40.0, b), 255])
                }
                None => Rgba([
                    over(200.0, 0),
                    over(90.0, 0),
                    over(40.0, 0),
                    (alpha * 255.0) as u8,
                ]),
            }
        })
    }

    /// A GIF with the colours of its first two pictures.
    fn written(images: &[Image], background: Option<[u8; 3]>) -> Vec<u8> {
        let mut file = Vec::new();
        let palette = Palette::new(&images[..2], background);
        let mut writer = GifWriter::new(&mut file, [60, 40], palette).unwrap();
        for image in images {
            writer.push(image, 4).unwrap();
        }
        writer.finish().unwrap();
        file
    }

    fn read(file: &[u8]) -> Vec<image::Frame> {
        let gif = image::codecs::gif::GifDecoder::new(io::Cursor::new(file)).unwrap();
        gif.into_frames().collect_frames().unwrap()
    }

    #[test]
    fn frames_are_complete_though_only_changes_are_stored() {
        let background = [250, 240, 230];
        let images = [15.0, 16.0, 16.0, 40.0].map(|middle| ball(middle, Some(background)));
        let file = written(&images, Some(background));
        let frames = read(&file);
        assert_eq!(frames.len(), 4);
        for (frame, image) in frames.iter().zip(&images) {
            for (found, wanted) in frame.buffer().pixels().zip(image.pixels()) {
                let apart = (0..3).map(|channel| found.0[channel].abs_diff(wanted.0[channel]));
                assert!(apart.max() < Some(16), "{found:?} {wanted:?}");
                assert_eq!(found.0[3], 255);
            }
            assert_eq!(frame.buffer().get_pixel(0, 39).0, [250, 240, 230, 255]);
        }
        // A frame that shows the same takes next to nothing.
        let once = written(&[images[0].clone(), images[1].clone()], Some(background));
        let again = [images[0].clone(), images[1].clone(), images[1].clone()];
        let again = written(&again, Some(background));
        assert!(
            again.len() - once.len() < 40,
            "{} {}",
            again.len(),
            once.len()
        );
    }

    #[test]
    fn without_a_background_frames_do_not_add_up() {
        let images = [15.0, 40.0].map(|middle| ball(middle, None));
        let frames = read(&written(&images, None));
        let alpha = |index: usize, x: u32| frames[index].buffer().get_pixel(x, 18).0[3];
        assert_eq!([alpha(0, 15), alpha(0, 55)], [255, 0]);
        assert_eq!([alpha(1, 5), alpha(1, 40)], [0, 255]);
    }
}
