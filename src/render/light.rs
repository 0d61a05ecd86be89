//! Where light comes from: three soft lights that turn with the camera, and a sky.

use glam::{Quat, Vec2, Vec3};

use super::fragment::{Fragment, Matter};
use super::trace::Tracer;

/// Pixels in a block share their rays: `BLOCK` × `BLOCK` of them.
pub(super) const BLOCK: u32 = 4;
const SHARES: usize = (BLOCK * BLOCK) as usize;
/// Rays of a pixel to each light.
const RAYS: [usize; 3] = [3, 1, 1];
/// Rays of a pixel to the sky: from the model, and from the ground, where faint shadows are seen on white.
const SKY_RAYS: [usize; 2] = [6, 16];
/// Light from below, that the ground gives back, where the sky's is 1.
const GROUND: f32 = 0.5;

/// A distant lamp.
struct Lamp {
    /// Towards it; the camera looks along -Z.
    direction: Vec3,
    strength: f32,
    /// The tangent of half the angle that it fills.
    spread: f32,
    /// How far its light reaches round a surface that turns away.
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
/// The strength of the sky.
const SKY: f32 = 0.5;

/// How much of each light arrives at a place; 1 is all that could.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Arriving {
    pub(super) lamps: [f32; 3],
    /// Of the sky and the ground, weighted by the angle.
    pub(super) sky: f32,
}

impl Arriving {
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

/// The lights of a view.
pub(super) struct Rig {
    pub(super) directions: [Vec3; 3],
    /// Directions to each lamp, the rays of one pixel of a block after the other.
    lamps: [Vec<Vec3>; 3],
    /// Directions about +Z, the denser the nearer, of each of [`SKY_RAYS`].
    sky: [Vec<Vec3>; 2],
}

impl Rig {
    /// Lights that are turned with the camera by `yaw` degrees.
    pub(super) fn new(yaw: f64) -> Self {
        let turn = Quat::from_rotation_y(yaw.to_radians() as f32);
        let directions = LAMPS.map(|lamp| turn * lamp.direction.normalize());
        let lamps = [0, 1, 2].map(|index| {
            let towards = directions[index];
            let turn = Quat::from_rotation_arc(Vec3::Z, towards);
            spread(RAYS[index], |share| {
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

    /// The light that arrives at a piece, by the rays of the pixel `share` of its block.
    pub(super) fn arriving(&self, tracer: &Tracer<'_>, piece: &Fragment, share: usize) -> Arriving {
        let Fragment { place, normal, .. } = *piece;
        let mut arriving = Arriving::default();
        for (index, rays) in self.lamps.iter().enumerate() {
            let count = RAYS[index];
            // No ray to a lamp that the surface turns away from: there is nothing to shade.
            arriving.lamps[index] = match self.facing(index, normal) > 0.0 {
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
        let kind = usize::from(piece.matter == Matter::Ground);
        let count = SKY_RAYS[kind];
        let rays = &self.sky[kind][share * count..][..count];
        let light = rays.iter().map(|ray| {
            let ray = turn * *ray;
            sky(ray) * tracer.light_through(place, ray)
        });
        arriving.sky = light.sum::<f32>() / count as f32;
        arriving
    }

    /// How far a surface faces a lamp, 0 to 1.
    fn facing(&self, lamp: usize, normal: Vec3) -> f32 {
        let wrap = LAMPS[lamp].wrap;
        ((normal.dot(self.directions[lamp]) + wrap) / (1.0 + wrap)).max(0.0)
    }

    /// The light of each lamp on a white surface.
    pub(super) fn on(&self, lamp: usize, normal: Vec3, arriving: &Arriving) -> f32 {
        LAMPS[lamp].strength * self.facing(lamp, normal) * arriving.lamps[lamp]
    }

    /// The strength of a lamp.
    pub(super) fn strength(&self, lamp: usize) -> f32 {
        LAMPS[lamp].strength
    }

    /// The strength of the sky.
    pub(super) fn sky_strength(&self) -> f32 {
        SKY
    }
}

/// The light that comes from a direction where nothing stands, the sky's being 1.
pub(super) fn sky(direction: Vec3) -> f32 {
    let share = (direction.y * 0.9 + 0.45).clamp(0.0, 1.0);
    GROUND + (1.0 - GROUND) * share * share * (3.0 - 2.0 * share)
}

/// The mean of [`sky`] over what a surface sees.
pub(super) fn open_sky(normal: Vec3) -> f32 {
    GROUND + (1.0 - GROUND) * (0.5 + 0.5 * normal.y).clamp(0.0, 1.0)
}

/// `count` rays for each pixel of a block, so that those of a pixel and those of a block are both evenly spread.
fn spread(count: usize, ray: impl Fn(Vec2) -> Vec3) -> Vec<Vec3> {
    let mut rays = Vec::with_capacity(SHARES * count);
    for share in 0..SHARES {
        rays.extend((0..count).map(|index| ray(even(index * SHARES + share))));
    }
    rays
}

/// The place `index` of a sequence that fills the unit square evenly, however long it gets (Roberts's R2).
pub(super) fn even(index: usize) -> Vec2 {
    let place = |step: f64| (0.5 + step * index as f64).fract() as f32;
    Vec2::new(
        place(0.754_877_666_246_692_8),
        place(0.569_840_290_998_053_2),
    )
}

/// A place in a disk, evenly.
fn disk(share: Vec2, radius: f32) -> Vec2 {
    let (sin, cos) = (share.x * std::f32::consts::TAU).sin_cos();
    Vec2::new(cos, sin) * share.y.sqrt() * radius
}

/// Which pixel of its block a pixel is: neighbours are far apart in this order (Bayer).
pub(super) fn share(x: u32, y: u32) -> usize {
    const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    usize::from(ORDER[(y % BLOCK) as usize][(x % BLOCK) as usize])
}
