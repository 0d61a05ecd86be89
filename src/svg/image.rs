//! The picture of an `<image>`: its pixels, and the outline of its opaque area (docs/figures.md, Parts).

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rustc_hash::FxHashMap;

use super::clip::Clip;
use crate::diagnostic::Code;
use crate::geometry::{FillRule, Outline, Ring, resolve_overlaps};
use crate::scene::Filter;
use crate::texture::{self, Decoded, Holes, PaintServer, PictureError, Source};

/// Pixels along the longer side of an SVG picture.
const SVG_SIDE: u32 = 1024;
/// How far the outline may deviate from the pixels' edges, in pixels: enough to smooth the steps of slanted borders.
const BORDER_TOLERANCE: f64 = 0.75;

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

/// A picture as a part.
pub(super) struct Traced {
    /// Its opaque area.
    pub(super) outline: Outline,
    /// Its mean colour, sRGB.
    pub(super) color: [u8; 3],
    /// The paint of the part, if it can be determined.
    pub(super) server: Option<PaintServer>,
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
            Contents::Pixels(bytes) => {
                let (pixels, _) = texture::pixels(bytes).map_err(unreadable)?;
                Ok(pixels)
            }
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

    /// The picture as a part. Its area is where alpha exceeds one half, or the whole rectangle if it has no alpha.
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
        let solid = |x: i64, y: i64| {
            x >= 0
                && y >= 0
                && x < i64::from(width)
                && y < i64::from(height)
                && rgba.get_pixel(x as u32, y as u32).0[3] > 127
        };
        let mut sum = [0_u64; 3];
        let mut count = 0_u64;
        for pixel in rgba.pixels().filter(|pixel| pixel.0[3] > 127) {
            (0..3).for_each(|channel| sum[channel] += u64::from(pixel.0[channel]));
            count += 1;
        }
        let mut rings = if count == u64::from(width) * u64::from(height) {
            vec![rectangle(width.into(), height.into())]
        } else {
            border(width.into(), height.into(), solid)
        };
        let scale = self.size / DVec2::new(width.into(), height.into());
        rings.iter_mut().flatten().for_each(|point| *point *= scale);
        let picture = texture::picture(decoded, &bytes, Holes::Outline);
        Ok(Traced {
            outline: self.outline(rings),
            color: sum.map(|channel| (channel / count.max(1)) as u8),
            server: picture.map(|picture| PaintServer {
                source: Source::Picture(picture, self.filter),
                place: self.place(),
            }),
        })
    }
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

/// The rings of pixel edges between opaque and other pixels, with the opaque side on the right, simplified.
fn border(width: i64, height: i64, solid: impl Fn(i64, i64) -> bool) -> Vec<Ring> {
    // An edge is identified by its start and direction: 0 right, 1 down, 2 left, 3 up.
    let step = [(1, 0), (0, 1), (-1, 0), (0, -1)];
    let has = |x: i64, y: i64, direction: usize| match direction {
        0 => solid(x, y) && !solid(x, y - 1),
        1 => solid(x - 1, y) && !solid(x, y),
        2 => solid(x - 1, y - 1) && !solid(x - 1, y),
        _ => solid(x, y - 1) && !solid(x - 1, y - 1),
    };
    let mut seen: FxHashMap<(i64, i64), u8> = FxHashMap::default();
    let mut rings = Vec::new();
    for y in 0..=height {
        for x in 0..=width {
            let visited = seen.get(&(x, y)).is_some_and(|bits| bits & 1 != 0);
            if !has(x, y, 0) || visited {
                continue;
            }
            let mut ring = Vec::new();
            let (mut at, mut direction) = ((x, y), 0_usize);
            loop {
                let bits = seen.entry(at).or_default();
                if *bits & (1 << direction) != 0 {
                    break;
                }
                *bits |= 1 << direction;
                ring.push(DVec2::new(at.0 as f64, at.1 as f64));
                at = (at.0 + step[direction].0, at.1 + step[direction].1);
                // Turning right first separates pixels that touch only at a corner.
                let turns = [(direction + 1) % 4, direction, (direction + 3) % 4];
                match turns.into_iter().find(|turn| has(at.0, at.1, *turn)) {
                    Some(turn) => direction = turn,
                    None => break,
                }
            }
            rings.push(simplify(&ring));
        }
    }
    rings.retain(|ring| ring.len() > 2);
    rings
}

/// Douglas–Peucker simplification of a ring, split at its first point and the point farthest from it.
fn simplify(ring: &[DVec2]) -> Ring {
    let Some(first) = ring.first() else {
        return Ring::new();
    };
    let far = (0..ring.len())
        .max_by(|a, b| {
            first
                .distance_squared(ring[*a])
                .total_cmp(&first.distance_squared(ring[*b]))
        })
        .unwrap_or(0);
    let mut out = halves(&ring[..=far]);
    let mut back = ring[far..].to_vec();
    back.push(*first);
    out.pop();
    out.extend(halves(&back));
    out.pop();
    out
}

fn halves(line: &[DVec2]) -> Vec<DVec2> {
    let mut keep = vec![false; line.len()];
    let mut stack = vec![(0, line.len() - 1)];
    keep[0] = true;
    keep[line.len() - 1] = true;
    while let Some((from, to)) = stack.pop() {
        let direction = (line[to] - line[from]).normalize_or_zero();
        let distance = |p: DVec2| match direction == DVec2::ZERO {
            true => p.distance(line[from]),
            false => direction.perp_dot(p - line[from]).abs(),
        };
        let farthest =
            (from + 1..to).max_by(|a, b| distance(line[*a]).total_cmp(&distance(line[*b])));
        if let Some(middle) = farthest.filter(|index| distance(line[*index]) > BORDER_TOLERANCE) {
            keep[middle] = true;
            stack.push((from, middle));
            stack.push((middle, to));
        }
    }
    line.iter()
        .zip(keep)
        .filter(|(_, keep)| *keep)
        .map(|(p, _)| *p)
        .collect()
}
