//! A rectangle of the picture: pieces, light, neighbours' light, pixels.

use glam::{Vec3, Vec4};

use super::fragment::{Eye, Fragment, Matter};
use super::light::{Arriving, Rig, share};
use super::shade::shade;
use super::texture::{encode, linear};

/// The side of a tile, pixels.
pub(super) const TILE: u32 = 64;
/// How far a pixel's neighbours reach beyond a tile.
const HALO: u32 = 2;
/// Neighbours whose surface differs less in direction (cosine) share their light.
const ALIKE: f32 = 0.88;

/// Draws the pixels from `left`, `top`, at most [`TILE`] each way; rows from the top, RGBA.
pub(super) fn draw(
    eye: &Eye<'_>,
    rig: &Rig,
    background: Option<[u8; 3]>,
    [left, top]: [u32; 2],
    [width, height]: [u32; 2],
) -> Vec<[u8; 4]> {
    let tile = Tile::new(eye, rig, [left, top], [width, height]);
    let pixels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| {
            let here = glam::Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
            let border = eye.camera.border(here);
            let mut colour = Vec4::ZERO;
            for fragment in tile.at(x, y) {
                let arriving = tile.gathered(x, y, fragment);
                let mut light = shade(fragment, &arriving, eye.tracer, rig);
                if fragment.matter == Matter::Ground {
                    light.w *= border;
                }
                colour += light * fragment.weight;
            }
            pixel(colour, background)
        })
        .collect()
}

fn pixel(colour: Vec4, background: Option<[u8; 3]>) -> [u8; 4] {
    let alpha = colour.w.clamp(0.0, 1.0);
    match background {
        Some(background) => {
            let behind = Vec3::from(background.map(linear));
            let [r, g, b] = (colour.truncate() + behind * (1.0 - alpha))
                .to_array()
                .map(encode);
            [r, g, b, 255]
        }
        None => {
            let alpha = (alpha * 255.0 + 0.5) as u8;
            if alpha == 0 {
                return [0; 4];
            }
            let [r, g, b] = (colour.truncate() / colour.w).to_array().map(encode);
            [r, g, b, alpha]
        }
    }
}

/// The pieces of a tile and its halo.
struct Tile {
    left: i64,
    top: i64,
    width: usize,
    fragments: Vec<Fragment>,
    /// Where the pieces of each pixel begin, and where the last ends.
    starts: Vec<usize>,
}

impl Tile {
    fn new(eye: &Eye<'_>, rig: &Rig, [left, top]: [u32; 2], [width, height]: [u32; 2]) -> Self {
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
                eye.see(x, y, &mut fragments);
                let share = share(x, y);
                for fragment in &mut fragments[start..] {
                    fragment.arriving = rig.arriving(eye.tracer, fragment, share);
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

    /// The pieces of a pixel, which lies in the tile or its halo.
    fn at(&self, x: u32, y: u32) -> &[Fragment] {
        let column = (i64::from(x) - self.left) as usize;
        let row = (i64::from(y) - self.top) as usize;
        let index = row * self.width + column;
        &self.fragments[self.starts[index]..self.starts[index + 1]]
    }

    /// The light on a piece, by its own rays and those of its neighbours on the same surface: one pixel of each kind.
    fn gathered(&self, x: u32, y: u32, fragment: &Fragment) -> Arriving {
        let mut sum = Arriving::default();
        let mut count = 0.0;
        for y in (y + 1).saturating_sub(HALO)..=y + HALO {
            for x in (x + 1).saturating_sub(HALO)..=x + HALO {
                for other in self.at(x, y) {
                    if same_surface(fragment, other) {
                        sum.add(&other.arriving);
                        count += 1.0;
                    }
                }
            }
        }
        if count > 0.0 {
            sum.scaled(1.0 / count)
        } else {
            fragment.arriving
        }
    }
}

fn same_surface(one: &Fragment, other: &Fragment) -> bool {
    let apart = other.place - one.place;
    (one.matter == Matter::Ground) == (other.matter == Matter::Ground)
        && one.normal.dot(other.normal) > ALIKE
        && apart.dot(one.normal).abs() < one.width * 2.5
        && apart.length_squared() < (one.width * 12.0).powi(2)
}
