//! Lighting: three soft lamps that turn with the camera, and a sky.

use crate::math;
use glam::{Quat, Vec2, Vec3};

use super::fragment::Fragment;
use super::sampling::{LightRays, Sampling};
use super::trace::Tracer;

/// `BLOCK` × `BLOCK` pixels share their rays.
pub(super) const BLOCK: u32 = 4;
const BLOCK_PIXELS: usize = (BLOCK * BLOCK) as usize;
/// `CELL` × `CELL` points of the lattice on the ground share their rays.
pub(super) const CELL: u32 = 2;
const CELL_POINTS: usize = (CELL * CELL) as usize;
/// The number of lamps.
pub(super) const LAMPS: usize = 3;
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
const LAMP: [Lamp; LAMPS] = [
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
    pub(super) lamps: [f32; LAMPS],
    /// Of sky and ground together, weighted by the cosine.
    pub(super) sky: f32,
}

impl IncidentLight {
    #[inline]
    pub(super) fn add(&mut self, other: &Self) {
        for (sum, one) in self.lamps.iter_mut().zip(other.lamps) {
            *sum += one;
        }
        self.sky += other.sky;
    }

    #[inline]
    pub(super) fn scaled(&self, factor: f32) -> Self {
        Self {
            // Not `map`, which is not inlined.
            lamps: [
                self.lamps[0] * factor,
                self.lamps[1] * factor,
                self.lamps[2] * factor,
            ],
            sky: self.sky * factor,
        }
    }
}

/// The lights for a view.
pub(super) struct Lights {
    pub(super) directions: [Vec3; LAMPS],
    /// The rays from the model, distributed over the pixels of a block.
    model: Rays,
    /// Those from the ground, distributed over the points of a cell of the lattice.
    ground: Rays,
}

/// Directions to the lights. Neighbours have different ones and share their results.
struct Rays {
    count: LightRays,
    /// Directions to each lamp, grouped by neighbour.
    lamps: [Vec<Vec3>; LAMPS],
    /// Cosine-weighted directions around +Z, grouped by neighbour.
    sky: Vec<Vec3>,
}

impl Rays {
    /// Directions for a number of neighbours.
    fn new(directions: [Vec3; LAMPS], count: LightRays, neighbors: usize) -> Self {
        let lamps = std::array::from_fn(|index| {
            let turn = Quat::from_rotation_arc(Vec3::Z, directions[index]);
            spread(count.lamps[index], neighbors, |share| {
                (turn * disk(share, LAMP[index].spread).extend(1.0)).normalize()
            })
        });
        let dome = |share| {
            let flat = disk(share, 1.0);
            flat.extend((1.0 - flat.length_squared()).max(0.0).sqrt())
        };
        Self {
            count,
            lamps,
            sky: spread(count.sky, neighbors, dome),
        }
    }
}

impl Lights {
    /// Lights that turn with the camera by `yaw` degrees.
    pub(super) fn new(yaw: f64, sampling: &Sampling) -> Self {
        let turn = math::rotation_y(yaw.to_radians()).as_quat();
        let directions = LAMP.map(|lamp| turn * lamp.direction.normalize());
        Self {
            directions,
            model: Rays::new(directions, sampling.model, BLOCK_PIXELS),
            ground: Rays::new(directions, sampling.ground.rays, CELL_POINTS),
        }
    }

    /// The light that reaches a fragment of the model, by the rays of pixel `share` of its block.
    pub(super) fn incident(
        &self,
        tracer: &Tracer<'_>,
        piece: &Fragment,
        share: usize,
    ) -> IncidentLight {
        self.reaching(tracer, piece.place, piece.normal, &self.model, share)
    }

    /// The light that reaches a point of the ground, by the rays of point `share` of its cell of the lattice.
    pub(super) fn on_ground(
        &self,
        tracer: &Tracer<'_>,
        place: Vec3,
        share: usize,
    ) -> IncidentLight {
        self.reaching(tracer, place, Vec3::Y, &self.ground, share)
    }

    fn reaching(
        &self,
        tracer: &Tracer<'_>,
        place: Vec3,
        normal: Vec3,
        rays: &Rays,
        share: usize,
    ) -> IncidentLight {
        let mut incident = IncidentLight::default();
        for (index, directions) in rays.lamps.iter().enumerate() {
            let count = rays.count.lamps[index];
            // A surface that faces away from the lamp needs no shadow rays.
            incident.lamps[index] = if count > 0 && self.facing(index, normal) > 0.0 {
                let rays = &directions[share * count..][..count];
                rays.iter()
                    .map(|ray| tracer.light_through(place, *ray))
                    .sum::<f32>()
                    / count as f32
            } else {
                1.0
            };
        }
        let turn = Quat::from_rotation_arc(Vec3::Z, normal);
        let count = rays.count.sky;
        let rays = &rays.sky[share * count..][..count];
        let light = rays.iter().map(|ray| {
            let ray = turn * *ray;
            sky(ray) * tracer.light_through(place, ray)
        });
        incident.sky = light.sum::<f32>() / count as f32;
        incident
    }

    /// How much a surface faces a lamp, 0 to 1.
    #[inline]
    fn facing(&self, lamp: usize, normal: Vec3) -> f32 {
        let wrap = LAMP[lamp].wrap;
        ((normal.dot(self.directions[lamp]) + wrap) / (1.0 + wrap)).max(0.0)
    }

    /// The light of a lamp on a white surface.
    #[inline]
    pub(super) fn on(&self, lamp: usize, normal: Vec3, incident: &IncidentLight) -> f32 {
        LAMP[lamp].strength * self.facing(lamp, normal) * incident.lamps[lamp]
    }

    #[inline]
    pub(super) fn strength(&self, lamp: usize) -> f32 {
        LAMP[lamp].strength
    }

    #[inline]
    pub(super) fn sky_strength(&self) -> f32 {
        SKY
    }
}

/// The light from an unobstructed direction, relative to the sky.
#[inline]
pub(super) fn sky(direction: Vec3) -> f32 {
    let share = (direction.y * 0.9 + 0.45).clamp(0.0, 1.0);
    GROUND + (1.0 - GROUND) * share * share * (3.0 - 2.0 * share)
}

/// The mean of [`sky`] over the hemisphere of a normal.
#[inline]
pub(super) fn open_sky(normal: Vec3) -> f32 {
    GROUND + (1.0 - GROUND) * (0.5 + 0.5 * normal.y).clamp(0.0, 1.0)
}

/// `count` rays for each of some neighbours, evenly distributed for each of them and for all together.
fn spread(count: usize, neighbors: usize, ray: impl Fn(Vec2) -> Vec3) -> Vec<Vec3> {
    let mut rays = Vec::with_capacity(neighbors * count);
    for share in 0..neighbors {
        rays.extend((0..count).map(|index| ray(even(index * neighbors + share))));
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
    let (sin, cos) = math::sin_cos(share.x * std::f32::consts::TAU);
    Vec2::new(cos, sin) * share.y.sqrt() * radius
}

/// The position of a pixel in its block's order, in which neighbours are far apart (Bayer matrix).
#[inline]
pub(super) fn share(x: u32, y: u32) -> usize {
    const ORDER: [[u8; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    usize::from(ORDER[(y % BLOCK) as usize][(x % BLOCK) as usize])
}
