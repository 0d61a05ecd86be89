//! Pictures as parts: the border of what is opaque in an `<image>` (figure.md, Parts).

use std::sync::Arc;

use glam::DVec2;
use rustc_hash::FxHashMap;

use crate::diagnostic::Code;
use crate::geometry::Ring;
use crate::scene::Filter;
use crate::texture::{self, Decoded, Picture, PictureError};

/// Pixels along the longer side of a picture that is SVG itself.
const SVG_SIDE: u32 = 1024;
/// How far the border may lie off the pixels' edges, pixels: enough to smooth the steps of slanted borders.
const BORDER_TOLERANCE: f64 = 0.75;

/// The opaque area of a picture.
pub(super) struct Opaque {
    /// Its border in the picture's units, y down; areas by the even-odd rule.
    pub(super) rings: Vec<Ring>,
    /// Its mean colour, sRGB.
    pub(super) color: [u8; 3],
    /// What is seen on it, if that can be told.
    pub(super) picture: Option<Picture>,
    /// How large the picture is.
    pub(super) size: DVec2,
    /// What lies between its pixels.
    pub(super) filter: Filter,
}

/// The opaque area of a picture: alpha over one half, the whole rectangle where it has no alpha.
///
/// # Errors
/// What is wrong with it: it passes a limit, or cannot be read.
pub(super) fn opaque(picture: &usvg::Image) -> Result<Opaque, (Code, String)> {
    let (decoded, bytes) = match picture.kind() {
        usvg::ImageKind::JPEG(bytes)
        | usvg::ImageKind::PNG(bytes)
        | usvg::ImageKind::GIF(bytes)
        | usvg::ImageKind::WEBP(bytes) => {
            let decoded = texture::decode(bytes).map_err(|error| {
                let code = match error {
                    PictureError::TooLarge => Code::LimitPassed,
                    PictureError::Unreadable(_) => Code::MissingFile,
                };
                (code, format!("the picture {error}"))
            })?;
            (decoded, Arc::from(bytes.as_slice()))
        }
        usvg::ImageKind::SVG(tree) => {
            let pixels = texture::render_tree(tree, SVG_SIDE).map_err(|why| {
                let message = format!("the picture cannot be drawn: {why}");
                (Code::LimitPassed, message)
            })?;
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
    let color = sum.map(|channel| (channel / count.max(1)) as u8);
    let mut rings = if count == u64::from(width) * u64::from(height) {
        vec![rectangle(width.into(), height.into())]
    } else {
        border(width.into(), height.into(), solid)
    };
    let size = picture.size();
    let size = DVec2::new(size.width().into(), size.height().into());
    let scale = size / DVec2::new(width.into(), height.into());
    rings.iter_mut().flatten().for_each(|point| *point *= scale);
    Ok(Opaque {
        rings,
        color,
        picture: texture::picture(decoded, &bytes, true),
        size,
        filter: match picture.rendering_mode() {
            usvg::ImageRendering::CrispEdges | usvg::ImageRendering::Pixelated => Filter::Nearest,
            _ => Filter::Linear,
        },
    })
}

fn rectangle(width: f64, height: f64) -> Ring {
    [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
        .map(DVec2::from)
        .to_vec()
}

/// The rings of pixel edges between solid and other pixels, solid on the right hand, simplified.
fn border(width: i64, height: i64, solid: impl Fn(i64, i64) -> bool) -> Vec<Ring> {
    // An edge is known by its start and direction: 0 right, 1 down, 2 left, 3 up.
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
                // Turning right first keeps pixels that touch at a corner apart.
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

/// Douglas and Peucker's simplification of a ring, cut at its first point and the one farthest from it.
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
