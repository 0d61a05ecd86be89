//! Renders a square tile of a picture: fragments, their light, the light of their neighbours, pixels.

use glam::{Vec2, Vec3, Vec4};

use super::fragment::{Fragment, FragmentKind, MIN_RAYS, PixelSampler, same_surface};
use super::ground::{GroundLight, shadow_fade, shadow_on_lines};
use super::light::{IncidentLight, Lights, share};
use super::raster::Area;
use super::sampling::Refinement;
use super::shade::{shade, shadow};
use super::texture::{linear_to_srgb, srgb_to_linear, srgb_values};

/// The width of the border of neighbours around a tile, in pixels.
pub(super) const HALO: u32 = 2;

/// The triangles that rays meet are not known before the rays are traced.
const TRACED: Option<fn(usize) -> Option<usize>> = None;

/// Renders the pixels of the tile that begins at `left`, `top`; rows from the top, RGBA. `ground` is the light on the ground; without it
/// base colours are shown.
pub(super) fn draw_tile(
    sampler: &PixelSampler<'_>,
    lights: &Lights,
    ground: Option<&GroundLight<'_>>,
    background: Option<[u8; 3]>,
    [left, top]: [u32; 2],
    [width, height]: [u32; 2],
) -> Vec<[u8; 4]> {
    let pixels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
    let Some(ground) = ground else {
        let mut fragments = Vec::new();
        return pixels
            .map(|(x, y)| {
                fragments.clear();
                sampler.sample(x, y, TRACED, &mut fragments);
                let color = base_color(&fragments, lines(sampler, x, y));
                pixel(color, &SRGB, background)
            })
            .collect();
    };
    let tile = Tile::new(sampler, lights, [left, top], [width, height]);
    pixels
        .map(|(x, y)| {
            if !sampler.coverage.contains(x, y) {
                let color = bare_ground(sampler, ground, x, y);
                return pixel(color, &LINEAR, background);
            }
            let mut color = Vec4::ZERO;
            for fragment in tile.at(x, y) {
                let light = match fragment.kind {
                    FragmentKind::Ground => {
                        let fade = shadow_fade(fragment.place, &sampler.tracer.surface);
                        ground_color(sampler, x, y, shadow(ground.at(x, y)) * fade)
                    }
                    FragmentKind::Model(material) => {
                        let incident = tile.gathered(x, y, fragment);
                        let material = &sampler.tracer.materials[material];
                        shade(fragment, material, &incident, lights).extend(1.0)
                    }
                };
                color += light * fragment.weight;
            }
            pixel(color, &LINEAR, background)
        })
        .collect()
}

/// Premultiplied colour and alpha of a pixel that shows nothing but the ground.
fn bare_ground(sampler: &PixelSampler<'_>, ground: &GroundLight<'_>, x: u32, y: u32) -> Vec4 {
    let surface = &sampler.tracer.surface;
    let faded = |shadow: f32| {
        let middle = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let place = sampler.camera.on_level(middle, surface.low.y);
        place.map_or(0.0, |place| shadow * shadow_fade(place, surface))
    };
    match (shadow(ground.at(x, y)), sampler.floor) {
        (0.0, None) => Vec4::ZERO,
        (0.0, Some(_)) => ground_color(sampler, x, y, 0.0),
        (shadow, _) => ground_color(sampler, x, y, faded(shadow)),
    }
}

/// Premultiplied colour and alpha of the ground in a pixel, with a shadow of some opacity.
fn ground_color(sampler: &PixelSampler<'_>, x: u32, y: u32, shadow: f32) -> Vec4 {
    let middle = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
    let shadow = shadow * sampler.camera.border(middle);
    match sampler.floor {
        Some(_) => shadow_on_lines(shadow, lines(sampler, x, y)),
        None => Vec4::new(0.0, 0.0, 0.0, shadow),
    }
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
fn pixel(color: Vec4, encoding: &Encoding, background: Option<[u8; 3]>) -> [u8; 4] {
    let alpha = color.w.clamp(0.0, 1.0);
    if let Some([r, g, b]) = background.filter(|_| color == Vec4::ZERO) {
        return [r, g, b, 255];
    }
    let (seen, alpha) = match background {
        Some(background) => {
            let behind = Vec3::from(background.map(encoding.read));
            (color.truncate() + behind * (1.0 - alpha), 255)
        }
        None if byte(alpha) == 0 => return [0; 4],
        None => (color.truncate() / color.w, byte(alpha)),
    };
    let write = encoding.write;
    [write(seen.x), write(seen.y), write(seen.z), alpha]
}

/// A value from 0 to 1 as a byte.
fn byte(value: f32) -> u8 {
    (value * 255.0 + 0.5).clamp(0.0, 255.0) as u8
}

/// The base colours of a pixel's fragments as sRGB values, multiplied by alpha, and alpha. The ground shows lines only.
fn base_color(fragments: &[Fragment], lines: f32) -> Vec4 {
    let parts = fragments.iter().map(|fragment| {
        let color = match fragment.kind {
            FragmentKind::Model(_) => srgb_values(fragment.color).extend(1.0),
            FragmentKind::Ground => {
                let lines = shadow_on_lines(0.0, lines);
                let alpha = lines.w.max(f32::MIN_POSITIVE);
                (srgb_values(lines.truncate() / alpha) * lines.w).extend(lines.w)
            }
        };
        color * fragment.weight
    });
    parts.sum()
}

/// The pixels of an area that are in the picture or behind it, row by row.
fn pixels_of(area: Area) -> impl Iterator<Item = [u32; 2]> {
    let rows = area.top.max(0)..area.top + i64::from(area.height);
    let columns = area.left.max(0)..area.left + i64::from(area.width);
    rows.flat_map(move |y| columns.clone().map(move |x| [x as u32, y as u32]))
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
        [left, top]: [u32; 2],
        [width, height]: [u32; 2],
    ) -> Self {
        let halo = i64::from(HALO);
        let corner = [i64::from(left) - halo, i64::from(top) - halo];
        let size = [width + 2 * HALO, height + 2 * HALO];
        // Pixels that show nothing but the ground need no fragments: the light on it is known.
        let is_bare = |x: u32, y: u32| !sampler.coverage.contains(x, y);
        let area = Area {
            left: corner[0],
            top: corner[1],
            width: size[0],
            height: size[1],
        };
        let mut tile = match (sampler.sampling.refinement, &sampler.raster) {
            (Refinement::Pixel, None) => Self::filled(corner, size, |x, y, out| {
                if !is_bare(x, y) {
                    sampler.sample(x, y, TRACED, out);
                }
            }),
            (Refinement::Pixel, Some(raster)) => {
                let covered = pixels_of(area).filter(|[x, y]| !is_bare(*x, *y));
                let covered: Vec<[u32; 2]> = covered.collect();
                let samples = raster.samples(area, &covered, MIN_RAYS);
                let mut number = 0..;
                let few = Self::filled(corner, size, |x, y, out| {
                    if !is_bare(x, y)
                        && let Some(pixel) = number.next()
                    {
                        sampler.sample_few(x, y, |index| samples.at(pixel, index), out);
                    }
                });
                let is_edge = |[x, y]: &[u32; 2]| !sampler.is_uniform(few.at(*x, *y), MIN_RAYS);
                few.refined(sampler, area, covered.into_iter().filter(is_edge).collect())
            }
            (Refinement::Neighbors, raster) => {
                let middles = raster.as_ref().map(|raster| raster.middles(area));
                let once = Self::filled(corner, size, |x, y, out| {
                    if !is_bare(x, y) {
                        let met = middles.as_ref().map(|middles| middles.at(x, y));
                        sampler.sample_once(x, y, met, out);
                    }
                });
                let is_edge = |[x, y]: &[u32; 2]| {
                    !is_bare(*x, *y) && !sampler.is_enough(once.at(*x, *y), once.neighbors(*x, *y))
                };
                once.refined(sampler, area, pixels_of(area).filter(is_edge).collect())
            }
        };
        let width = tile.width;
        for (index, ends) in tile.starts.windows(2).enumerate() {
            let place = |start: i64, step: usize| start + step as i64;
            let [x, y] = [
                place(corner[0], index % width),
                place(corner[1], index / width),
            ];
            let share = share(x.max(0) as u32, y.max(0) as u32);
            for fragment in &mut tile.fragments[ends[0]..ends[1]] {
                if fragment.kind != FragmentKind::Ground {
                    fragment.incident = lights.incident(sampler.tracer, fragment, share);
                }
            }
        }
        tile
    }

    /// The tile with all rays of the pixels at edges, which are listed row by row.
    fn refined(&self, sampler: &PixelSampler<'_>, area: Area, edges: Vec<[u32; 2]>) -> Self {
        let count = sampler.sampling.edge;
        let samples = sampler.raster.as_ref();
        let samples = samples.map(|raster| raster.samples(area, &edges, count));
        let mut edges = edges.into_iter().enumerate().peekable();
        Self::filled(
            [area.left, area.top],
            [area.width, area.height],
            |x, y, out| match edges.next_if(|(_, edge)| *edge == [x, y]) {
                None => out.extend_from_slice(self.at(x, y)),
                // Most pixels beside an edge contain none: the first few rays tell.
                Some((edge, _)) => {
                    let met = samples.as_ref();
                    let met = met.map(|samples| move |index| samples.at(edge, index));
                    sampler.sample(x, y, met, out);
                }
            },
        )
    }

    /// A tile whose pixels `sample` gives. Those left of the picture and above it have no fragments.
    fn filled(
        [left, top]: [i64; 2],
        [width, height]: [u32; 2],
        mut sample: impl FnMut(u32, u32, &mut Vec<Fragment>),
    ) -> Self {
        let mut fragments = Vec::new();
        let mut starts = Vec::with_capacity((width * height) as usize + 1);
        for y in top..top + i64::from(height) {
            for x in left..left + i64::from(width) {
                starts.push(fragments.len());
                if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) {
                    sample(x, y, &mut fragments);
                }
            }
        }
        starts.push(fragments.len());
        Self {
            left,
            top,
            width: width as usize,
            fragments,
            starts,
        }
    }

    /// The fragments of the pixels beside, above and below a pixel, as far as they are in the tile or its halo.
    fn neighbors(&self, x: u32, y: u32) -> impl Iterator<Item = &[Fragment]> {
        let (x, y) = (i64::from(x), i64::from(y));
        let height = ((self.starts.len() - 1) / self.width) as i64;
        let places = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let inside = move |(x, y): &(i64, i64)| {
            (self.left..self.left + self.width as i64).contains(x)
                && (self.top..self.top + height).contains(y)
                && *x >= 0
                && *y >= 0
        };
        let inside = places.into_iter().filter(inside);
        inside.map(|(x, y)| self.at(x as u32, y as u32))
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
