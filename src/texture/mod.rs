//! Gradients, patterns and pictures as images that lie on parts.
//!
//! A gradient is baked in its own plane and not over its part: a linear one is a row of colours along itself, a
//! radial one a square around its circle. So parts that share a gradient share its image, whatever their size,
//! and a part is textured by one affine map from the drawing to the image. Patterns are one tile that the sampler
//! repeats.
//!
//! Conventions, stated once: images have their first row at v = 0; a paint's *own plane* is the plane in which a
//! linear gradient runs from x = 0 to 1, the end circle of a radial one is the unit circle, and the tile of a
//! pattern, as a picture, fills the unit square, y down.

mod baker;
mod gradient;
mod picture;
mod tile;

use std::sync::Arc;

use glam::{DAffine2, DMat2, DVec2};

pub use baker::Baker;
pub use gradient::{Focus, Gradient, Spread, Stop};
pub use picture::{Decoded, PictureError, decode, picture, pixels};

use crate::scene::{Filter, MediaType, Wrap};

pub(crate) use tile::render_tree;

/// Most pixels of all textures that are drawn for a model: where there are many, each becomes smaller.
const MOST_PIXELS: f64 = (16 << 20) as f64;
/// Fewest pixels along a side of a texture that became smaller.
const LEAST_SIDE: u32 = 16;

/// Most pixels that may be touched on the way to all patterns of a model.
const MOST_WORK: f64 = (4_u64 << 30) as f64;

/// What a part is painted with, other than a colour.
#[derive(Debug, Clone)]
pub struct Server {
    /// What it shows.
    pub source: Source,
    /// From its own plane to the drawing.
    pub place: DAffine2,
}

/// What a paint shows in its own plane.
#[derive(Debug, Clone)]
pub enum Source {
    /// Colours along a line.
    Linear(Gradient),
    /// Colours around a point.
    Radial(Gradient, Focus),
    /// A tile.
    Pattern(Arc<usvg::Pattern>),
    /// A picture, and what lies between its pixels.
    Picture(Picture, Filter),
}

/// An image file and what its alpha says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// What the bytes are.
    pub media_type: MediaType,
    /// The file.
    pub bytes: Arc<[u8]>,
    /// Where it can be seen through.
    pub alpha: Alpha,
}

/// Where an image can be seen through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Alpha {
    /// Nowhere.
    #[default]
    Opaque,
    /// It has holes with sharp borders.
    Holes,
    /// It has half-tones.
    Blended,
}

/// A texture that is to be drawn: parts with equal ones share it.
#[derive(Debug, Clone)]
pub struct Plan {
    source: Source,
    /// How far a radial gradient reaches in its own plane.
    reach: f64,
    /// Pixels.
    size: [u32; 2],
    /// Pixels that are touched on the way, where that may be much.
    work: f64,
}

/// What makes two plans one.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PlanKey(Vec<u64>);

/// A texture that was drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Baked {
    /// Its image.
    pub picture: Picture,
    /// What lies beyond the image.
    pub wrap: [Wrap; 2],
    /// What lies between its pixels.
    pub filter: Filter,
}

impl Server {
    /// How the server is drawn for a part whose box in the drawing goes from `low` to `high`, where a drawing unit
    /// is worth `density` pixels.
    ///
    /// # Errors
    /// Why it cannot be drawn, for people.
    pub fn plan(&self, [low, high]: [DVec2; 2], density: f64) -> Result<Plan, &'static str> {
        let to_own = self.place.inverse();
        if !to_own.is_finite() || self.place.matrix2.determinant() == 0.0 {
            return Err("it is squeezed to a line");
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
                let size = tile::size([x_axis.length() * density, y_axis.length() * density]);
                work = tile::check(pattern, size)?;
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
    /// What makes it the same as another one.
    pub fn key(&self) -> PlanKey {
        let mut key = Vec::new();
        match &self.source {
            Source::Linear(gradient) => {
                key.push(0);
                gradient.key(&mut key);
            }
            Source::Radial(gradient, focus) => {
                key.extend([1, self.reach.to_bits()]);
                key.extend([focus.x, focus.y, focus.radius].map(f64::to_bits));
                gradient.key(&mut key);
            }
            // These are told apart by where they are in memory; what is written knows nothing of it.
            Source::Pattern(pattern) => {
                let [width, height] = self.size;
                key.extend([2, Arc::as_ptr(pattern).addr() as u64]);
                key.extend([u64::from(width), u64::from(height)]);
            }
            Source::Picture(picture, filter) => {
                let place = picture.bytes.as_ptr().addr() as u64;
                key.extend([3, place, *filter as u64]);
            }
        }
        PlanKey(key)
    }

    /// From the drawing to texture coordinates, for a server of this plan.
    pub fn map(&self, server: &Server) -> DAffine2 {
        let [width, _] = self.size.map(f64::from);
        let own = match &self.source {
            Source::Linear(gradient) => gradient.row_map(width),
            Source::Radial(..) => {
                let scale = DVec2::splat(0.5 / self.reach);
                DAffine2::from_scale_angle_translation(scale, 0.0, DVec2::splat(0.5))
            }
            Source::Pattern(_) | Source::Picture(..) => DAffine2::IDENTITY,
        };
        own * server.place.inverse()
    }

    /// Draws it.
    ///
    /// # Errors
    /// Why it cannot be drawn, for people.
    pub fn bake(&self) -> Result<Baked, &'static str> {
        if self.work.is_infinite() {
            return Err("all patterns of the drawing together hold too much");
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
                (picture::encode(pixels), [along, Wrap::ClampToEdge])
            }
            Source::Radial(gradient, focus) => {
                let pixels = gradient.bake_square(*focus, self.reach, width);
                (picture::encode(pixels), clamped)
            }
            Source::Pattern(pattern) => {
                let pixels = tile::render(pattern, self.size)?;
                (picture::encode(pixels), [Wrap::Repeat; 2])
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

/// Makes plans smaller until all of them together keep to the limit; those that there is no time left for are
/// given up.
///
/// Rows of colours stay as they are; they are small, and their length is part of the map onto them.
pub fn fit(plans: &mut [Plan]) {
    let drawn = |plan: &&mut Plan| matches!(plan.source, Source::Radial(..) | Source::Pattern(_));
    let pixels = |plan: &mut Plan| f64::from(plan.size[0]) * f64::from(plan.size[1]);
    let total: f64 = plans.iter_mut().filter(drawn).map(pixels).sum();
    let share = (MOST_PIXELS / total).min(1.0);
    let mut work = 0.0;
    for plan in plans.iter_mut().filter(drawn) {
        let shrunk = |side: u32| (f64::from(side) * share.sqrt()) as u32;
        if share < 1.0 {
            plan.size = plan.size.map(|side| shrunk(side).max(LEAST_SIDE).min(side));
        }
        work += plan.work * share;
        if work > MOST_WORK {
            plan.work = f64::INFINITY;
        }
    }
}

#[cfg(test)]
mod tests;
