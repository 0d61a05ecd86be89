//! Lighting: three soft lamps that turn with the camera, and a sky.

use glam::{Quat, Vec2, Vec3};

use super::fragment::{Fragment, FragmentKind};
use super::trace::Tracer;

/// `BLOCK` × `BLOCK` pixels share their rays.
pub(super) const BLOCK: u32 = 4;
const BLOCK_PIXELS: usize = (BLOCK * BLOCK) as usize;
/// Rays of a pixel to each lamp.
const LAMP_RAYS: [usize; 3] = [3, 1, 1];
/// Rays of a pixel to the sky: from the model, and from the ground, where faint shadows show on white.
const SKY_RAYS: [usize; 2] = [6, 16];
/// Light that the ground reflects from below, relative to the sky.
const GROUND: f32 = 0.5;

/// A distant lamp.
struct Lamp {
    /// Towards the lamp; the camera looks along -Z.
    direction: Vec3,
    strength: f32,
    /// The tangent of half its angular size.
    spread: f32,
    /// How far its light reaches around surfaces that face away (wrapped diffuse).
    wrap: f32,
}

/// Key from the upper left, fill from the right, rim from behind.
const LAMPS: [Lamp; 3] = [
    Lamp {
        direction: Vec3::new(-0.55, 1.3, 0.95),
        strength: 0.75,
        spread: 0.16,
        wrap: 0.0,
    },
    Lamp {
        direction: Vec3::new(1.0, 0.25, 0.75),
        strength: 0.14,
        spread: 0.5,
        wrap: 0.3,
    },
    Lamp {
        direction: Vec3::new(0.45, 0.55, -1.0),
        strength: 0.3,
        spread: 0.3,
        wrap: 0.1,
    },
];
const SKY: f32 = 0.5;

/// The share of each light that reaches a point, 0 to 1.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct IncidentLight {
    pub(super) lamps: [f32; 3],
    /// Of sky and ground together, weighted by the cosine.
    pub(super) sky: f32,
}

impl IncidentLight {
    pub(super) fn add(&mut self, other: &Self) {
        for (sum, one) in self.lamps.iter_mut().zip(other.lamps) {
            *sum += one;
        }
        self.sky += other.sky;
    }

    pub(super) fn scaled(&self, factor: f32) -> Self {
        Self {
            lamps: self.lamps.map(|lamp| lamp * factor),
            sky: self.sky * factor,
        }
    }
}

/// The lights for a view.
pub(super) struct Lights {
    pub(super) directions: [Vec3; 3],
    /// Directions to each lamp, grouped by the pixels of a block.
    lamps: [Vec<Vec3>; 3],
    /// Cosine-weighted directions around +Z, for each of [`SKY_RAYS`].
    sky: [Vec<Vec3>; 2],
}

impl Lights {
    /// Lights that turn with the camera by `yaw` degrees.
    pub(super) fn new(yaw: f64) -> Self {
        let turn = Quat::from_rotation_y(yaw.to_radians() as f32);
        let directions = LAMPS.map(|lamp| turn * lamp.direction.normalize());
        let lamps = [0, 1, 2].map(|index| {
            let towards = directions[index];
            let turn = Quat::from_rotation_arc(Vec3::Z, towards);
            spread(LAMP_RAYS[index], |share| {
                (turn * disk(share, LAMPS[index].spread).extend(1.0)).normalize()
            })
        });
        let dome = |share| {
            let flat = disk(share, 1.0);
            flat.extend((1.0 - flat.length_squared()).max(0.0).sqrt())
        };
        let sky = SKY_RAYS.map(|count| spread(count, dome));
        Self {
            directions,
            lamps,
            sky,
        }
    }

    /// The light that reaches a fragment, by the rays of pixel `share` of its block.
    pub(super) fn incident(
        &self,
        tracer: &Tracer<'_>,
        piece: &Fragment,
        share: usize,
    ) -> IncidentLight {
        let Fragment { place, normal, .. } = *piece;
        let mut incident = IncidentLight::default();
        for (index, rays) in self.lamps.iter().enumerate() {
            let count = LAMP_RAYS[index];
            // A surface that faces away from the lamp needs no shadow rays.
            incident.lamps[index] = match self.facing(index, normal) > 0.0 {
                true => {
                    let rays = &rays[share * count..][..count];
                    rays.iter()
                        .map(|ray| tracer.light_through(place, *ray))
                        .sum::<f32>()
                        / count as f32
                }
                false => 1.0,
            };
        }
        let turn = Quat::from_rotation_arc(Vec3::Z, normal);
        let kind = usize::from(piece.kind == FragmentKind::Ground);
        let count = SKY_RAYS[kind];
        let rays = &self.sky[kind][share * count..][..count];
        let light = rays.iter().map(|ray| {
            let ray = turn * *ray;
            sky(ray) * tracer.light_through(place, ray)
        });
        incident.sky = light.sum::<f32>() / count as f32;
        incident
    }

    /// How much a surface faces a lamp, 0 to 1.
    fn facing(&self, lamp: usize, normal: Vec3) -> f32 {
        let wrap = LAMPS[lamp].wrap;
        ((normal.dot(self.directions[lamp]) + wrap) / (1.0 + wrap)).max(0.0)
    }

    /// The light of a lamp on a white surface.
    pub(super) fn on(&self, lamp: usize, normal: Vec3, incident: &IncidentLight) -> f32 {
        LAMPS[lamp].strength * self.facing(lamp, normal) * incident.lamps[lamp]
    }

    pub(super) fn strength(&self, lamp: usize) -> f32 {
        LAMPS[lamp].strength
    }

    pub(super) fn sky_strength(&self) -> f32 {
        SKY
    }
}

/// The light from an unobstructed direction, relative to the sky.
pub(super) fn sky(direction: Vec3) -> f32 {
    let share = (direction.y * 0.9 + 0.45).clamp(0.0, 1.0);
    GROUND + (1.0 - GROUND) * share * share * (3.0 - 2.0 * share)
}

/// The mean of [`sky`] over the hemisphere of a normal.
pub(super) fn open_sky(normal: Vec3) -> f32 {
    GROUND + (1.0 - GROUND) * (0.5 + 0.5 * normal.y).clamp(0.0, 1.0)
}

/// `count` rays for each pixel of a block, evenly distributed within a pixel and within the block.
fn spread(count: usize, ray: impl Fn(Vec2) -> Vec3) -> Vec<Vec3> {
    let mut rays = Vec::with_capacity(BLOCK_PIXELS * count);
    for share in 0..BLOCK_PIXELS {
        rays.extend((0..count).map(|index| ray(even(index * BLOCK_PIXELS + share))));
    }
    rays
}

/// Point `index` of a low-discrepancy sequence in the unit square (Roberts's R2).
pub(super) fn even(index: usize) -> Vec2 {
    let place = |step: f64| (0.5 + step * index as f64).fract() as f32;
    Vec2::new(
        place(0.754_877_666_246_692_8),
        place(0.569_840_290_998_053_2),
    )
}

/// A uniformly distributed point in a disk.
fn disk(share: Vec2, radius: f32) -> Vec2 {
    let (sin, cos) = (share.x * std::f32::consts::TAU).sin_cos();
    Vec2::new(cos, sin) * share.y.sqrt() * radius
}

/// The position of a pixel in its block's order, in which neighbours are far apart (Bayer matrix).
pub(super) fn share(x: u32, y: u32) -> usize {
    const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    usize::from(ORDER[(y % BLOCK) as usize][(x % BLOCK) as usize])
}
