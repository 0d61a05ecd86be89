//! Renders a square tile of a picture: fragments, their light, the light of their neighbours, pixels.

use glam::{Vec2, Vec3, Vec4};

use super::Shading;
use super::fragment::{Fragment, FragmentKind, PixelSampler};
use super::ground::{GroundLight, shadow_on_lines};
use super::light::{IncidentLight, Lights, share};
use super::shade::shade;
use super::texture::{linear_to_srgb, srgb_to_linear, srgb_values};

/// The side of a tile in pixels.
pub(super) const TILE_SIDE: u32 = 64;
/// The width of the border of neighbours around a tile, in pixels.
pub(super) const HALO: u32 = 2;
/// Neighbours whose normals have at least this cosine share their light.
const ALIKE: f32 = 0.88;

/// Renders the pixels from `left`, `top`, at most [`TILE_SIDE`] each way; rows from the top, RGBA. `ground` is the light on
/// the ground, unless it is computed in each pixel.
pub(super) fn draw_tile(
    sampler: &PixelSampler<'_>,
    lights: &Lights,
    ground: Option<&GroundLight>,
    background: Option<[u8; 3]>,
    [left, top]: [u32; 2],
    [width, height]: [u32; 2],
) -> Vec<[u8; 4]> {
    let pixels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
    if sampler.shading == Shading::Unlit {
        let mut fragments = Vec::new();
        return pixels
            .map(|(x, y)| {
                fragments.clear();
                sampler.sample(x, y, &mut fragments);
                let colour = base_colour(&fragments, lines(sampler, x, y));
                pixel(colour, &SRGB, background)
            })
            .collect();
    }
    let tile = Tile::new(sampler, lights, ground, [left, top], [width, height]);
    pixels
        .map(|(x, y)| {
            let here = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let border = sampler.camera.border(here);
            let mut colour = Vec4::ZERO;
            for fragment in tile.at(x, y) {
                let incident = match (fragment.kind, ground) {
                    (FragmentKind::Ground, Some(ground)) => ground.at(x, y),
                    _ => tile.gathered(x, y, fragment),
                };
                let mut light = shade(fragment, &incident, sampler.tracer, lights);
                if fragment.kind == FragmentKind::Ground {
                    light.w *= border;
                    if sampler.floor.is_some() {
                        light = shadow_on_lines(light.w, lines(sampler, x, y));
                    }
                }
                colour += light * fragment.weight;
            }
            pixel(colour, &LINEAR, background)
        })
        .collect()
}

/// The opacity of the lines on the ground in a pixel.
fn lines(sampler: &PixelSampler<'_>, x: u32, y: u32) -> f32 {
    let place = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
    let level = sampler.tracer.surface.low.y;
    sampler.floor.map_or(0.0, |floor| {
        floor.opacity(sampler.camera, place, level) * sampler.camera.border(place)
    })
}

/// How colour values are written as sRGB bytes, and read from them.
struct Encoding {
    read: fn(u8) -> f32,
    write: fn(f32) -> u8,
}

/// Linear light.
const LINEAR: Encoding = Encoding {
    read: srgb_to_linear,
    write: linear_to_srgb,
};
/// sRGB values from 0 to 1.
const SRGB: Encoding = Encoding {
    read: |byte| f32::from(byte) / 255.0,
    write: byte,
};

/// A pixel of a colour that is multiplied by its alpha, both in an encoding, over a background or without one.
fn pixel(colour: Vec4, encoding: &Encoding, background: Option<[u8; 3]>) -> [u8; 4] {
    let alpha = colour.w.clamp(0.0, 1.0);
    let (seen, alpha) = match background {
        Some(background) => {
            let behind = Vec3::from(background.map(encoding.read));
            (colour.truncate() + behind * (1.0 - alpha), 255)
        }
        None if byte(alpha) == 0 => return [0; 4],
        None => (colour.truncate() / colour.w, byte(alpha)),
    };
    let [r, g, b] = seen.to_array().map(encoding.write);
    [r, g, b, alpha]
}

/// A value from 0 to 1 as a byte.
fn byte(value: f32) -> u8 {
    (value * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

/// The base colours of a pixel's fragments as sRGB values, multiplied by alpha, and alpha. The ground shows lines only.
fn base_colour(fragments: &[Fragment], lines: f32) -> Vec4 {
    let parts = fragments.iter().map(|fragment| {
        let colour = match fragment.kind {
            FragmentKind::Model(_) => srgb_values(fragment.colour).extend(1.0),
            FragmentKind::Ground => {
                let lines = shadow_on_lines(0.0, lines);
                let alpha = lines.w.max(f32::MIN_POSITIVE);
                (srgb_values(lines.truncate() / alpha) * lines.w).extend(lines.w)
            }
        };
        colour * fragment.weight
    });
    parts.sum()
}

/// The fragments of a tile and its halo.
struct Tile {
    left: i64,
    top: i64,
    width: usize,
    fragments: Vec<Fragment>,
    /// The index of the first fragment of each pixel, and the number of fragments at the end.
    starts: Vec<usize>,
}

impl Tile {
    fn new(
        sampler: &PixelSampler<'_>,
        lights: &Lights,
        ground: Option<&GroundLight>,
        [left, top]: [u32; 2],
        [width, height]: [u32; 2],
    ) -> Self {
        let halo = i64::from(HALO);
        let (first_x, first_y) = (i64::from(left) - halo, i64::from(top) - halo);
        let (wide, high) = (width + 2 * HALO, height + 2 * HALO);
        let mut fragments = Vec::with_capacity((wide * high) as usize);
        let mut starts = Vec::with_capacity((wide * high) as usize + 1);
        for y in first_y..first_y + i64::from(high) {
            for x in first_x..first_x + i64::from(wide) {
                let start = fragments.len();
                starts.push(start);
                let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else {
                    continue;
                };
                sampler.sample(x, y, &mut fragments);
                let share = share(x, y);
                let needs_light = |fragment: &&mut Fragment| match (fragment.kind, ground) {
                    (FragmentKind::Ground, ground) => ground.is_none(),
                    (FragmentKind::Model(_), _) => true,
                };
                for fragment in fragments[start..].iter_mut().filter(needs_light) {
                    fragment.incident = lights.incident(sampler.tracer, fragment, share);
                }
            }
        }
        starts.push(fragments.len());
        Self {
            left: first_x,
            top: first_y,
            width: wide as usize,
            fragments,
            starts,
        }
    }

    /// The fragments of a pixel in the tile or its halo.
    fn at(&self, x: u32, y: u32) -> &[Fragment] {
        let column = (i64::from(x) - self.left) as usize;
        let row = (i64::from(y) - self.top) as usize;
        let index = row * self.width + column;
        &self.fragments[self.starts[index]..self.starts[index + 1]]
    }

    /// The light on a fragment: the mean of its own and that of neighbours on the same surface, a full block of pixels.
    fn gathered(&self, x: u32, y: u32, fragment: &Fragment) -> IncidentLight {
        let mut sum = IncidentLight::default();
        let mut count = 0.0;
        for y in (y + 1).saturating_sub(HALO)..=y + HALO {
            for x in (x + 1).saturating_sub(HALO)..=x + HALO {
                for other in self.at(x, y) {
                    if same_surface(fragment, other) {
                        sum.add(&other.incident);
                        count += 1.0;
                    }
                }
            }
        }
        if count > 0.0 {
            sum.scaled(1.0 / count)
        } else {
            fragment.incident
        }
    }
}

fn same_surface(one: &Fragment, other: &Fragment) -> bool {
    let apart = other.place - one.place;
    (one.kind == FragmentKind::Ground) == (other.kind == FragmentKind::Ground)
        && one.normal.dot(other.normal) > ALIKE
        && apart.dot(one.normal).abs() < one.width * 2.5
        && apart.length_squared() < (one.width * 12.0).powi(2)
}
