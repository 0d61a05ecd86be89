//! The sheet of paper in a photograph.

use glam::DVec2;
use image::{Rgba, RgbaImage, imageops};
use rayon::prelude::*;

use crate::geometry::{Ring, convex_hull, shoelace};
use crate::regions::connected;

use super::SIDE;

/// The longer side of the picture in which the sheet is looked for, pixels.
const SMALL: u32 = 256;
/// Neighbours on the sheet differ by less, as a share of the brighter one: light and shadow change it slowly, its edge at once. The
/// lighter the table, the less.
const STEPS: [f64; 4] = [0.05, 0.035, 0.025, 0.018];
/// The least area of a sheet, as a share of the picture.
const LEAST: f64 = 0.15;
/// A sheet of this share of the picture or more is all of it.
const ALL: f64 = 0.95;
/// The hull of a sheet fills the square of its corners at least so far.
const SQUARE: f64 = 0.9;
/// What is cut off along the edge of a sheet, as a share of its sides: shadows beside it, and corners that are not exact.
const EDGE: f64 = 0.015;

/// The sheet of paper that lies in a photograph, seen from straight above; `None` if there is none, or the picture is nothing else.
pub(super) fn sheet(photo: &RgbaImage) -> Option<RgbaImage> {
    let scale = f64::from(photo.width().max(photo.height())) / f64::from(SMALL);
    let [width, height] = [photo.width(), photo.height()]
        .map(|side| ((f64::from(side) / scale).round() as u32).max(1));
    let small = imageops::thumbnail(photo, width, height);
    let corners = STEPS.into_iter().find_map(|step| corners(&small, step))?;
    Some(straightened(photo, &corners.map(|corner| corner * scale)))
}

/// The corners of the sheet in a small picture, clockwise from the upper left, pixels.
fn corners(small: &RgbaImage, step: f64) -> Option<[DVec2; 4]> {
    let [width, height] = [small.width(), small.height()].map(|side| side as usize);
    let (pixels, _) = small.as_raw().as_chunks::<4>();
    let joined = |a: usize, b: usize| {
        (0..3).all(|channel| {
            let [a, b] = [a, b].map(|at| f64::from(pixels[at][channel]));
            (a - b).abs() <= step * a.max(b).max(1.0)
        })
    };
    let labels = connected(
        width * height,
        width,
        1,
        |_| true,
        |at| joined(at, at - 1),
        |at| joined(at, at - width),
    );
    let mut areas = vec![(0_usize, 0_u64); labels.firsts.len()];
    for (label, pixel) in labels.of.iter().zip(pixels) {
        let (count, light) = &mut areas[*label as usize - 1];
        *count += 1;
        *light += pixel[..3]
            .iter()
            .map(|channel| u64::from(*channel))
            .sum::<u64>();
    }
    let all = (width * height) as f64;
    // Paper is lighter than what it lies on.
    let large = areas.iter().enumerate();
    let large = large.filter(|(_, (count, _))| *count as f64 >= LEAST * all);
    let (label, _) = large.max_by_key(|(_, (count, light))| light / *count as u64)?;
    // The first and the last pixel of each row have its hull.
    let rows = labels.of.chunks(width).enumerate();
    let ends = rows.filter_map(|(row, of)| {
        let is_sheet = |of: &u32| *of as usize == label + 1;
        let (first, last) = (
            of.iter().position(is_sheet)?,
            of.iter().rposition(is_sheet)?,
        );
        Some([
            (first, row),
            (last + 1, row),
            (first, row + 1),
            (last + 1, row + 1),
        ])
    });
    let ends = ends.flatten();
    let ends = ends.map(|(x, y)| DVec2::new(x as f64, y as f64));
    let hull = convex_hull(ends.collect());
    let hull_area = shoelace(&hull).abs();
    if hull_area >= ALL * all {
        return None;
    }
    let corners = largest_square(&hull)?;
    (shoelace(&corners).abs() >= SQUARE * hull_area).then(|| from_upper_left(corners))
}

/// The four points of a convex ring between which most of it lies.
fn largest_square(hull: &Ring) -> Option<[DVec2; 4]> {
    let count = hull.len();
    // The farthest point of a range from the line between two others, and twice the area of that triangle.
    let farthest = |from: usize, to: usize, between: std::ops::Range<usize>| {
        let line = hull[to] - hull[from];
        let reach = |at: usize| line.perp_dot(hull[at % count] - hull[from]).abs();
        between
            .map(|at| (reach(at), at % count))
            .max_by(|(a, _), (b, _)| a.total_cmp(b))
    };
    let mut best: Option<(f64, [usize; 4])> = None;
    for a in 0..count {
        for c in a + 2..count {
            let sides = farthest(a, c, a + 1..c).zip(farthest(a, c, c + 1..a + count));
            let Some(((one, b), (other, d))) = sides else {
                continue;
            };
            if best.is_none_or(|(area, _)| one + other > area) {
                best = Some((one + other, [a, b, c, d]));
            }
        }
    }
    best.map(|(_, corners)| corners.map(|corner| hull[corner]))
}

/// The corners in their order from the upper left: a photograph is nearly upright.
fn from_upper_left(mut corners: [DVec2; 4]) -> [DVec2; 4] {
    if shoelace(&corners) < 0.0 {
        corners.reverse();
    }
    let first = (0..4).min_by(|a, b| {
        let sum = |at: usize| corners[at].element_sum();
        sum(*a).total_cmp(&sum(*b))
    });
    corners.rotate_left(first.unwrap_or(0));
    corners
}

/// The part of a photograph between four corners as a rectangle.
fn straightened(photo: &RgbaImage, corners: &[DVec2; 4]) -> RgbaImage {
    let [a, b, c, d] = *corners;
    let size = DVec2::new(
        (b - a).length() + (c - d).length(),
        (d - a).length() + (c - b).length(),
    ) / 2.0;
    let size = (size * (f64::from(SIDE) / size.max_element()).min(1.0))
        .round()
        .max(DVec2::ONE);
    let seen = Perspective::new(corners);
    let row = |y: u32| {
        let seen = &seen;
        (0..size.x as u32).flat_map(move |x| {
            let place = (DVec2::new(x.into(), y.into()) + 0.5) / size;
            let place = DVec2::splat(EDGE) + place * (1.0 - 2.0 * EDGE);
            sampled(photo, seen.at(place)).0
        })
    };
    let pixels: Vec<u8> = (0..size.y as u32)
        .into_par_iter()
        .flat_map_iter(row)
        .collect();
    RgbaImage::from_raw(size.x as u32, size.y as u32, pixels).unwrap_or_default()
}

/// Where the points of a square are seen.
///
/// Source: Heckbert, *Fundamentals of texture mapping and image warping* (1989), section 2.2.3.
struct Perspective {
    origin: DVec2,
    x: DVec2,
    y: DVec2,
    depth: DVec2,
}

impl Perspective {
    /// By the corners where (0, 0), (1, 0), (1, 1) and (0, 1) are seen, of which no three are in line.
    fn new(&[a, b, c, d]: &[DVec2; 4]) -> Self {
        let (right, below, off) = (b - c, d - c, a - b + c - d);
        let turn = right.perp_dot(below);
        let depth = DVec2::new(off.perp_dot(below), right.perp_dot(off)) / turn;
        Self {
            origin: a,
            x: b - a + depth.x * b,
            y: d - a + depth.y * d,
            depth,
        }
    }

    fn at(&self, place: DVec2) -> DVec2 {
        (self.origin + self.x * place.x + self.y * place.y) / (1.0 + self.depth.dot(place))
    }
}

/// The colour at a point, between the four pixels around it.
fn sampled(picture: &RgbaImage, point: DVec2) -> Rgba<u8> {
    let last = DVec2::new(picture.width().into(), picture.height().into()) - 1.0;
    let point = (point - 0.5).clamp(DVec2::ZERO, last);
    imageops::interpolate_bilinear(picture, point.x as f32, point.y as f32)
        .unwrap_or(Rgba([255; 4]))
}
