//! The picture of an `<image>`: its pixels, and the outline of its opaque area (docs/figures.md, Parts).

use std::sync::Arc;

use glam::{DAffine2, DVec2};

use super::clip::Clip;
use crate::diagnostic::Code;
use crate::geometry::{FillRule, Outline, Ring, pixel_borders, resolve_overlaps};
use crate::scene::Filter;
use crate::texture::{self, Decoded, Holes, PaintServer, PictureError, Source};

/// Pixels along the longer side of an SVG picture.
const SVG_SIDE: u32 = 1024;

/// The file of an `<image>`, and its position.
#[derive(Debug, Clone)]
pub struct PictureSource {
    file: Contents,
    /// The size of the picture in its own units.
    size: DVec2,
    /// Maps its own units to the drawing.
    transform: DAffine2,
    /// The interpolation between its pixels.
    filter: Filter,
    clips: Option<Arc<Vec<Clip>>>,
}

#[derive(Debug, Clone)]
enum Contents {
    /// PNG, JPEG, GIF or WebP.
    Pixels(Arc<Vec<u8>>),
    /// SVG.
    Drawing(Box<usvg::Tree>),
}

/// The file of a picture as parts show it.
pub(super) struct Traced {
    /// The borders of its opaque area, in the unit square, y down.
    rings: Vec<Ring>,
    /// Its mean colour, sRGB.
    pub(super) color: [u8; 3],
    /// The image for the model; `None` if there was not enough memory.
    texture: Option<texture::Picture>,
}

impl PictureSource {
    pub(super) fn of(
        picture: &usvg::Image,
        transform: DAffine2,
        clips: Option<Arc<Vec<Clip>>>,
    ) -> Self {
        let size = picture.size();
        Self {
            file: match picture.kind() {
                usvg::ImageKind::JPEG(bytes)
                | usvg::ImageKind::PNG(bytes)
                | usvg::ImageKind::GIF(bytes)
                | usvg::ImageKind::WEBP(bytes) => Contents::Pixels(Arc::clone(bytes)),
                usvg::ImageKind::SVG(tree) => Contents::Drawing(Box::new(tree.clone())),
            },
            size: DVec2::new(size.width().into(), size.height().into()),
            transform,
            filter: match picture.rendering_mode() {
                usvg::ImageRendering::CrispEdges | usvg::ImageRendering::Pixelated => {
                    Filter::Nearest
                }
                _ => Filter::Linear,
            },
            clips,
        }
    }

    /// Maps the unit square, y down, to the picture's position in the drawing.
    pub fn place(&self) -> DAffine2 {
        self.transform * DAffine2::from_scale(self.size)
    }

    /// Whether a clip cuts the picture's rectangle.
    pub fn is_clipped(&self) -> bool {
        self.clips.is_some()
    }

    /// The picture's pixels, top row first. An SVG picture has `side` pixels along its longer side.
    ///
    /// # Errors
    ///
    /// If the picture passes a limit or cannot be read.
    pub fn pixels(&self, side: u32) -> Result<image::DynamicImage, (Code, String)> {
        match &self.file {
            Contents::Pixels(bytes) => pixels_of(bytes),
            Contents::Drawing(tree) => {
                let pixels = texture::render_tree(tree, side).map_err(undrawn)?;
                Ok(pixels.into())
            }
        }
    }

    /// The whole rectangle, cut by the clips.
    pub(super) fn rectangle(&self) -> Outline {
        self.outline(vec![rectangle(self.size.x, self.size.y)])
    }

    fn outline(&self, rings: Vec<Ring>) -> Outline {
        let to_drawing = |ring: Ring| {
            let points = ring.into_iter();
            points.map(|p| self.transform.transform_point2(p)).collect()
        };
        let rings = rings.into_iter().map(to_drawing).collect();
        let clips = self.clips.iter().flat_map(|clips| clips.iter());
        clips.fold(
            resolve_overlaps(rings, FillRule::EvenOdd),
            |outline, clip| clip.cut(outline),
        )
    }

    /// What is the same wherever the file is shown. The area is where alpha exceeds one half, or the whole rectangle if it has
    /// no alpha.
    ///
    /// # Errors
    ///
    /// If the picture passes a limit or cannot be read.
    pub(super) fn trace(&self) -> Result<Traced, (Code, String)> {
        let (decoded, bytes) = match &self.file {
            Contents::Pixels(bytes) => {
                let decoded = texture::decode(bytes).map_err(unreadable)?;
                (decoded, Arc::from(bytes.as_slice()))
            }
            Contents::Drawing(tree) => {
                let pixels = texture::render_tree(tree, SVG_SIDE).map_err(undrawn)?;
                let media_type = None;
                (Decoded { pixels, media_type }, Arc::from([]))
            }
        };
        let rgba = &decoded.pixels;
        let (width, height) = rgba.dimensions();
        let is_solid = |x: u32, y: u32| rgba.get_pixel(x, y).0[3] > 127;
        let mut sum = [0_u64; 3];
        let mut count = 0_u64;
        for pixel in rgba.pixels().filter(|pixel| pixel.0[3] > 127) {
            (0..3).for_each(|channel| sum[channel] += u64::from(pixel.0[channel]));
            count += 1;
        }
        let rings = if count == u64::from(width) * u64::from(height) {
            vec![rectangle(1.0, 1.0)]
        } else {
            let mut rings = pixel_borders(width, height, is_solid);
            let size = DVec2::new(width.into(), height.into());
            rings.iter_mut().flatten().for_each(|point| *point /= size);
            rings
        };
        Ok(Traced {
            rings,
            color: sum.map(|channel| (channel / count.max(1)) as u8),
            texture: texture::picture(decoded, &bytes, Holes::Outline),
        })
    }

    /// The area and the paint of a part that shows a traced picture here.
    pub(super) fn part(&self, traced: &Traced) -> (Outline, Option<PaintServer>) {
        let scaled = |ring: &Ring| ring.iter().map(|point| *point * self.size).collect();
        let outline = self.outline(traced.rings.iter().map(scaled).collect());
        let server = traced.texture.clone().map(|picture| PaintServer {
            source: Source::Picture(picture, self.filter),
            place: self.place(),
        });
        (outline, server)
    }

    /// The file, if it is the same wherever it has the same bytes.
    pub fn bytes(&self) -> Option<&Arc<Vec<u8>>> {
        match &self.file {
            Contents::Pixels(bytes) => Some(bytes),
            Contents::Drawing(_) => None,
        }
    }
}

/// The pixels of a PNG, JPEG, GIF or WebP file, top row first.
///
/// # Errors
///
/// If the picture passes a limit or cannot be read.
pub(crate) fn pixels_of(file: &[u8]) -> Result<image::DynamicImage, (Code, String)> {
    let (pixels, _) = texture::pixels(file).map_err(unreadable)?;
    Ok(pixels)
}

fn unreadable(error: PictureError) -> (Code, String) {
    let code = match error {
        PictureError::TooLarge => Code::LimitPassed,
        PictureError::Unreadable(_) => Code::MissingFile,
    };
    (code, format!("the picture {error}"))
}

fn undrawn(why: &str) -> (Code, String) {
    let message = format!("the picture cannot be drawn: {why}");
    (Code::LimitPassed, message)
}

fn rectangle(width: f64, height: f64) -> Ring {
    [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
        .map(DVec2::from)
        .to_vec()
}
