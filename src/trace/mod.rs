//! Drawings from pictures: a scan, a photograph of a drawing on paper, or a picture that a program painted.
//!
//! - `sheet` finds the sheet of paper in a photograph, and straightens it.
//! - `light` makes the light on it even, and the paper white.
//! - `texture` closes the gaps between the strokes of crayons.
//! - `crate::raster` finds the regions, which `svg` writes as shapes.
//!
//! Invariants: every shape lies on the page; what is written is a drawing that okoshi and Inkscape read.

mod light;
mod sheet;
mod svg;
#[cfg(test)]
mod tests;
mod texture;

use image::{DynamicImage, RgbaImage};

use crate::geometry::area;
use crate::raster::{self, RasterView, Shades};
use crate::texture::{PictureError, upright};

/// The longest side of a photograph in which regions are looked for, pixels.
const SIDE: u32 = 1024;
/// The area of a speck, as a share of all that is drawn.
const SPECK: f64 = 1e-3;
/// Of pairs of neighbouring pixels, more are equal in a picture that a program painted, and fewer in a photograph.
const EQUAL: f64 = 0.9;
/// The border of a photograph varies: a smaller share of its pixels is like their median, by so many of 255 steps.
const LIKE: f64 = 0.95;
const STEPS: u8 = 8;

/// A drawing that was made from a picture.
#[derive(Debug)]
pub(crate) struct Traced {
    /// The text of the drawing.
    pub svg: String,
    /// How many shapes it has.
    pub shapes: usize,
    /// Whether a sheet of paper was found in the picture, and straightened.
    pub is_straightened: bool,
    /// Whether most shapes are only steps of soft shades.
    pub is_shaded: bool,
}

/// Why there is no drawing. Messages follow the name of the picture.
#[derive(Debug, thiserror::Error)]
pub(crate) enum TraceError {
    /// It is no picture that can be read.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// There is nothing on the paper.
    #[error(
        "shows nothing but its background; draw with dark lines or in colours, on light paper, and leave a margin around the drawing"
    )]
    Empty,
}

/// Makes a drawing from the file of a picture: PNG, JPEG, GIF or WebP.
///
/// # Errors
/// See [`TraceError`].
pub(crate) fn trace(file: &[u8]) -> Result<Traced, TraceError> {
    let mut picture = upright(file)?.into_rgba8();
    let mut is_straightened = false;
    let is_photograph = is_photograph(&picture);
    if is_photograph {
        if let Some(sheet) = sheet::sheet(&picture) {
            picture = sheet;
            is_straightened = true;
        }
        if picture.width().max(picture.height()) > SIDE {
            picture = DynamicImage::from(picture)
                .thumbnail(SIDE, SIDE)
                .into_rgba8();
        }
        if light::even(&mut picture) {
            texture::close(&mut picture);
        }
    }
    let mut view = raster::regions(&picture);
    if is_photograph {
        without_specks(&mut view);
    }
    let shapes = view.regions.len() + view.lines.len();
    if shapes == 0 {
        return Err(TraceError::Empty);
    }
    Ok(Traced {
        svg: svg::write(&view, [picture.width(), picture.height()]),
        shapes,
        is_straightened,
        is_shaded: view.shades == Shades::Steps,
    })
}

/// Takes away what is too small to be drawn on purpose.
fn without_specks(view: &mut RasterView) {
    let regions = view.regions.iter().map(|region| &region.outline);
    let outlines = regions.chain(view.lines.iter().map(|line| &line.outline));
    let least = SPECK * outlines.map(area).sum::<f64>();
    view.regions.retain(|region| area(&region.outline) > least);
    view.lines.retain(|line| area(&line.outline) > least);
}

/// Whether the light in a picture varies, as in a photograph of paper. On a scan it does not, and nothing has to be evened out.
fn is_photograph(picture: &RgbaImage) -> bool {
    let (pixels, _) = picture.as_raw().as_chunks::<4>();
    let [width, height] = [picture.width(), picture.height()].map(|side| side as usize);
    if width < 2 || height < 2 || pixels.iter().any(|pixel| pixel[3] < u8::MAX) {
        return false;
    }
    let equal = pixels.windows(2).filter(|pair| pair[0] == pair[1]).count();
    let sides = (0..height).flat_map(|y| [y * width, (y + 1) * width - 1]);
    let border: Vec<[u8; 4]> = (0..width)
        .chain((height - 1) * width..height * width)
        .chain(sides)
        .map(|at| pixels[at])
        .collect();
    let median = [0, 1, 2].map(|channel| {
        let mut values: Vec<u8> = border.iter().map(|pixel| pixel[channel]).collect();
        let middle = values.len() / 2;
        *values.select_nth_unstable(middle).1
    });
    let is_like = |pixel: &&[u8; 4]| {
        let mut pairs = pixel.iter().zip(median);
        pairs.all(|(channel, median)| channel.abs_diff(median) <= STEPS)
    };
    let like = border.iter().filter(is_like).count();
    (equal as f64) < EQUAL * pixels.len() as f64 && (like as f64) < LIKE * border.len() as f64
}
