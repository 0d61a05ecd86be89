//! Gradients, patterns and pictures as textures of parts.
//!
//! A gradient is baked in its own plane, not over its part: a linear one as a row of colours, a radial one as a square
//! around its circle. So parts that share a gradient share its image, whatever their size, and each part is textured by
//! one affine map from the drawing to the image. A pattern is one tile that the sampler repeats.
//!
//! Conventions, stated once: the first row of an image is at v = 0. In a paint's *own plane* a linear gradient runs from
//! x = 0 to 1, the end circle of a radial one is the unit circle, and a picture or the tile of a pattern fills the unit
//! square, y down.

mod gradient;
mod pattern;
mod picture;

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::{DAffine2, DMat2, DVec2};

pub(crate) use gradient::{Focus, Gradient, Spread, Stop};
pub(crate) use picture::{Decoded, Holes, PictureError, decode, picture, pixels, upright};

use crate::scene::{Filter, MediaType, Wrap};

pub(crate) use pattern::render_tree;

/// The largest number of pixels of all textures drawn for a model: if there would be more, each becomes smaller.
const MAX_PIXELS: f64 = (16 << 20) as f64;
/// The smallest side of a texture made smaller, in pixels.
const MIN_SIDE: u32 = 16;

/// The largest number of pixels that all patterns of a model may touch while they are drawn.
const MAX_WORK: f64 = (4_u64 << 30) as f64;

/// A paint server of SVG: a paint other than a solid colour.
#[derive(Debug, Clone)]
pub struct PaintServer {
    /// Its content.
    pub source: Source,
    /// From its own plane to the drawing.
    pub place: DAffine2,
}

/// The content of a paint in its own plane.
#[derive(Debug, Clone)]
pub enum Source {
    /// A linear gradient.
    Linear(Gradient),
    /// A radial gradient.
    Radial(Gradient, Focus),
    /// A pattern.
    Pattern(Arc<usvg::Pattern>),
    /// A picture and how it is filtered.
    Picture(Picture, Filter),
}

/// An image file and a summary of its alpha.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// The format of the file.
    pub media_type: MediaType,
    /// The file.
    pub bytes: Arc<[u8]>,
    /// Where it is transparent.
    pub alpha: Alpha,
}

/// Where an image is transparent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Alpha {
    /// Nowhere.
    #[default]
    Opaque,
    /// In holes with sharp borders.
    Holes,
    /// Partly, with intermediate values.
    Blended,
}

/// A texture to be drawn. Parts with equal plans share it.
#[derive(Debug, Clone)]
pub struct Plan {
    source: Source,
    /// How far a radial gradient extends in its own plane.
    reach: f64,
    /// Width and height in pixels.
    size: [u32; 2],
    /// An estimate of the pixels touched while drawing it, if it is a pattern; infinite if it is not to be drawn.
    work: f64,
}

/// Equal for plans that give the same texture.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PlanKey(Vec<u64>);

// Plans with equal keys are drawn alike. A plan holds on to the patterns and pictures that its key knows by their
// address.
impl PartialEq for Plan {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl Eq for Plan {}

impl Hash for Plan {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

/// A drawn texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Baked {
    /// Its image.
    pub picture: Picture,
    /// How it continues beyond its edges.
    pub wrap: [Wrap; 2],
    /// How it is filtered.
    pub filter: Filter,
}

impl PaintServer {
    /// Whether another one has the same content, wherever it lies. Two patterns are alike only if they are one.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        match (&self.source, &other.source) {
            (Source::Linear(a), Source::Linear(b)) => a == b,
            (Source::Radial(a, from), Source::Radial(b, to)) => a == b && from == to,
            (Source::Pattern(a), Source::Pattern(b)) => Arc::ptr_eq(a, b),
            (Source::Picture(a, by), Source::Picture(b, with)) => a == b && by == with,
            _ => false,
        }
    }

    /// A point of the drawing in the paint's own plane; for a linear gradient, which is the same across its direction, on its axis.
    pub(crate) fn in_own_plane(&self, point: DVec2) -> DVec2 {
        let own = self.place.inverse().transform_point2(point);
        match self.source {
            Source::Linear(_) => DVec2::new(own.x, 0.0),
            _ => own,
        }
    }

    /// Plans the texture for a part with the bounding box `low` to `high` in the drawing, at `density` pixels per drawing
    /// unit.
    ///
    /// # Errors
    /// The reason why it cannot be drawn, for a diagnostic.
    pub fn plan(&self, [low, high]: [DVec2; 2], density: f64) -> Result<Plan, &'static str> {
        let to_own = self.place.inverse();
        if !to_own.is_finite() || self.place.matrix2.determinant() == 0.0 {
            return Err("it is scaled to a line");
        }
        let (mut reach, mut work) = (1.0, 0.0);
        let size = match &self.source {
            Source::Linear(gradient) => [gradient.row(), gradient::ROWS],
            Source::Radial(gradient, focus) => {
                if !gradient.is_bounded(*focus) {
                    let corners = [
                        low,
                        DVec2::new(low.x, high.y),
                        high,
                        DVec2::new(high.x, low.y),
                    ];
                    let far =
                        corners.map(|corner| to_own.transform_point2(corner).abs().max_element());
                    reach = gradient::reach(far.into_iter().fold(1.0, f64::max));
                }
                [gradient.side(reach); 2]
            }
            Source::Pattern(pattern) => {
                let DMat2 { x_axis, y_axis } = self.place.matrix2;
                let size = pattern::size([x_axis.length() * density, y_axis.length() * density]);
                work = pattern::check(pattern, size)?;
                size
            }
            Source::Picture(..) => [0; 2],
        };
        Ok(Plan {
            source: self.source.clone(),
            reach,
            size,
            work,
        })
    }
}

impl Plan {
    /// The key of this plan.
    pub fn key(&self) -> PlanKey {
        let Self {
            source,
            reach,
            size,
            work,
        } = self;
        let mut key = Vec::new();
        match source {
            Source::Linear(gradient) => {
                key.push(0);
                gradient.key(&mut key);
            }
            Source::Radial(gradient, focus) => {
                let Focus { x, y, radius } = focus;
                key.extend([1, reach.to_bits()]);
                key.extend([x, y, radius].map(|number| number.to_bits()));
                gradient.key(&mut key);
            }
            // Patterns and pictures are compared by address, which does not influence the output.
            Source::Pattern(pattern) => {
                key.extend([2, Arc::as_ptr(pattern).addr() as u64]);
            }
            Source::Picture(picture, filter) => {
                let Picture {
                    media_type,
                    bytes,
                    alpha,
                } = picture;
                let place = bytes.as_ptr().addr() as u64;
                key.extend([3, place, *filter as u64, *media_type as u64, *alpha as u64]);
            }
        }
        key.extend(size.map(u64::from));
        key.push(u64::from(work.is_infinite()));
        PlanKey(key)
    }

    /// From the drawing to texture coordinates, for a paint server with this plan.
    pub fn map(&self, server: &PaintServer) -> DAffine2 {
        let [width, _] = self.size.map(f64::from);
        let own = match &self.source {
            Source::Linear(gradient) => gradient.row_map(width),
            Source::Radial(..) => {
                let scale = DVec2::splat(0.5 / self.reach);
                DAffine2::from_mat2_translation(DMat2::from_diagonal(scale), DVec2::splat(0.5))
            }
            Source::Pattern(_) | Source::Picture(..) => DAffine2::IDENTITY,
        };
        own * server.place.inverse()
    }

    /// Draws it.
    ///
    /// # Errors
    /// The reason why it cannot be drawn, for a diagnostic.
    pub fn bake(&self) -> Result<Baked, &'static str> {
        if self.work.is_infinite() {
            return Err("the patterns of the drawing are too complex together");
        }
        let [width, height] = self.size;
        let clamped = [Wrap::ClampToEdge; 2];
        let (picture, wrap) = match &self.source {
            Source::Linear(gradient) => {
                let along = match gradient.spread {
                    Spread::Pad => Wrap::ClampToEdge,
                    Spread::Reflect => Wrap::MirroredRepeat,
                    Spread::Repeat => Wrap::Repeat,
                };
                let pixels = gradient.bake_row(width, height);
                (picture::encode_png(pixels), [along, Wrap::ClampToEdge])
            }
            Source::Radial(gradient, focus) => {
                let pixels = gradient.bake_square(*focus, self.reach, width);
                (picture::encode_png(pixels), clamped)
            }
            Source::Pattern(pattern) => {
                let pixels = pattern::render(pattern, self.size)?;
                (picture::encode_png(pixels), [Wrap::Repeat; 2])
            }
            Source::Picture(picture, _) => (Some(picture.clone()), clamped),
        };
        Ok(Baked {
            picture: picture.ok_or("it takes too much memory")?,
            wrap,
            filter: match &self.source {
                Source::Picture(_, filter) => *filter,
                _ => Filter::Linear,
            },
        })
    }
}

/// Makes the textures smaller until all together are within the limits; patterns that would take too long are
/// abandoned.
///
/// Linear gradients keep their size: they are small, and their map depends on it.
pub(crate) fn fit(plans: &mut [Plan]) {
    let drawn = |plan: &&mut Plan| matches!(plan.source, Source::Radial(..) | Source::Pattern(_));
    let pixels = |plan: &mut Plan| f64::from(plan.size[0]) * f64::from(plan.size[1]);
    let total: f64 = plans.iter_mut().filter(drawn).map(pixels).sum();
    let share = (MAX_PIXELS / total).min(1.0);
    let mut work = 0.0;
    for plan in plans.iter_mut().filter(drawn) {
        let shrunk = |side: u32| (f64::from(side) * share.sqrt()) as u32;
        if share < 1.0 {
            plan.size = plan.size.map(|side| shrunk(side).max(MIN_SIDE).min(side));
        }
        work += plan.work * share;
        if work > MAX_WORK {
            plan.work = f64::INFINITY;
        }
    }
}

#[cfg(test)]
mod tests;
