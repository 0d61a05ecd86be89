//! What a pixel sees: pieces of surface, each with its share.

use glam::{Vec2, Vec3};

use super::Shading;
use super::camera::Camera;
use super::light::{Arriving, even};
use super::surface::{Alpha, Surface};
use super::trace::{Hit, Tracer};

/// Rays of every pixel.
const FEW: usize = 4;
/// Rays of a pixel that has an edge or a texture in it.
const MANY: usize = 16;
/// The most surfaces that a ray goes through.
const LAYERS: usize = 64;
/// Behind so little clearness nothing is seen.
const OPAQUE: f32 = 0.004;
/// Surfaces in a pixel that differ less in direction (cosine) are shaded as one.
const ALIKE: f32 = 0.94;
/// The most pieces of a pixel that are shaded apart.
const MOST: usize = 12;
/// How far rays start from a surface, so that they do not meet it.
const LIFT: f32 = 3e-5;

/// What a piece is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Matter {
    /// A material.
    Of(usize),
    /// The invisible ground that takes shadows.
    Ground,
}

/// A piece of what a pixel sees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fragment {
    pub(super) matter: Matter,
    /// Share of the pixel; all of a pixel add up to at most 1.
    pub(super) weight: f32,
    /// Base colour, linear; while it is gathered, times `weight`.
    pub(super) colour: Vec3,
    /// The direction in which the surface faces.
    pub(super) normal: Vec3,
    /// A place on it that rays may start from.
    pub(super) place: Vec3,
    /// Towards the camera.
    pub(super) towards: Vec3,
    /// How wide the pixel is there.
    pub(super) width: f32,
    pub(super) arriving: Arriving,
}

/// Sees what the pixels see.
pub(super) struct Eye<'a> {
    pub(super) tracer: &'a Tracer<'a>,
    pub(super) camera: &'a Camera,
    pub(super) shading: Shading,
}

impl Eye<'_> {
    /// The pieces of a pixel, appended to `out`.
    pub(super) fn see(&self, x: u32, y: u32, out: &mut Vec<Fragment>) {
        let first = out.len();
        let corner = Vec2::new(x as f32, y as f32);
        let mut rays = 0;
        for index in 0..MANY {
            let plain = index == FEW && self.is_plain(&out[first..]);
            if plain {
                break;
            }
            self.look(corner + even(index), first, out);
            rays += 1;
        }
        for fragment in &mut out[first..] {
            fragment.colour /= fragment.weight;
            fragment.weight /= rays as f32;
            fragment.normal = fragment.normal.normalize_or(fragment.towards);
        }
    }

    /// Whether a few rays tell what there is to see.
    fn is_plain(&self, seen: &[Fragment]) -> bool {
        match seen {
            [] => true,
            [one] => {
                let flat = match one.matter {
                    Matter::Ground => true,
                    Matter::Of(material) => {
                        let material = &self.tracer.materials[material];
                        material.sampler.is_none() && material.alpha == Alpha::Opaque
                    }
                };
                flat && one.weight > FEW as f32 - 0.5
            }
            _ => false,
        }
    }

    /// Follows the ray through one place of the picture.
    fn look(&self, place: Vec2, first: usize, out: &mut Vec<Fragment>) {
        let (origin, direction) = self.camera.ray(place);
        let mut nearest = 0.0;
        let mut clear = 1.0;
        for _ in 0..LAYERS {
            let Some(hit) = self.tracer.closest(origin, direction, nearest) else {
                break;
            };
            nearest = hit.distance + 1e-6;
            let width = self.camera.pixel(hit.distance);
            let base = self.tracer.base(&hit, width / (MANY as f32).sqrt());
            let cover = self.tracer.cover(&hit, base.w);
            if cover > 0.0 {
                let fragment = self.fragment(&hit, origin, direction, width, base.truncate());
                put(fragment, clear * cover, first, out);
                clear *= 1.0 - cover;
            }
            if clear < OPAQUE {
                return;
            }
        }
        if let Some(ground) = self.ground(origin, direction) {
            put(ground, clear, first, out);
        }
    }

    fn fragment(
        &self,
        hit: &Hit,
        origin: Vec3,
        direction: Vec3,
        width: f32,
        colour: Vec3,
    ) -> Fragment {
        let tracer = self.tracer;
        let facet = tracer.facet(hit.triangle);
        // The side that is seen, of a surface with two.
        let side = if facet.dot(direction) > 0.0 {
            -1.0
        } else {
            1.0
        };
        let place = origin + direction * hit.distance;
        let smooth = match self.shading {
            Shading::Smooth => tracer.normal(hit),
            Shading::Flat => None,
        };
        let place = match smooth {
            Some(_) => tracer.lifted(hit, place, side),
            None => place,
        };
        Fragment {
            matter: Matter::Of(tracer.material(hit.triangle)),
            weight: 0.0,
            colour,
            normal: smooth.unwrap_or(facet) * side,
            place: place + facet * side * LIFT,
            towards: -direction,
            width,
            arriving: Arriving::default(),
        }
    }

    /// The ground where a ray meets it, seen from above and not too far from the model.
    fn ground(&self, origin: Vec3, direction: Vec3) -> Option<Fragment> {
        let surface = &self.tracer.surface;
        let distance = (surface.low.y - origin.y) / direction.y;
        if direction.y > -1e-4 || !(0.0..1e6).contains(&distance) {
            return None;
        }
        let place = origin + direction * distance;
        (ground_fade(place, surface) > 0.0).then(|| Fragment {
            matter: Matter::Ground,
            weight: 0.0,
            colour: Vec3::ZERO,
            normal: Vec3::Y,
            place,
            towards: -direction,
            width: self.camera.pixel(distance),
            arriving: Arriving::default(),
        })
    }
}

/// How much of a shadow of the model is left on the ground at a place.
pub(super) fn ground_fade(place: Vec3, model: &Surface) -> f32 {
    let beside = (model.low - place).max(place - model.high).max(Vec3::ZERO);
    let share = 1.0 - (Vec2::new(beside.x, beside.z).length() / 0.65).min(1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Adds a piece to those of its pixel that it is like.
fn put(piece: Fragment, weight: f32, first: usize, out: &mut Vec<Fragment>) {
    let full = out.len() - first >= MOST;
    let alike = |other: &&mut Fragment| {
        let cosine = other.normal.normalize_or_zero().dot(piece.normal);
        let near = (other.place - piece.place).dot(piece.normal).abs() < piece.width * 2.0;
        other.matter == piece.matter && (full || cosine > ALIKE && near)
    };
    match out[first..].iter_mut().find(alike) {
        Some(other) => {
            other.weight += weight;
            other.colour += piece.colour * weight;
            other.normal += piece.normal * weight;
        }
        None => out.push(Fragment {
            weight,
            colour: piece.colour * weight,
            normal: piece.normal * weight,
            ..piece
        }),
    }
}
