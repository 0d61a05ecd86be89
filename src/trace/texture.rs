//! The texture of crayons and of coloured pencils, between whose strokes the paper is seen.

use image::RgbaImage;
use rayon::prelude::*;

use crate::regions::connected;

/// Gaps that are closed, as radii in shares of the longer side, in this order, each if there are more than so many: a few are eyes and
/// teeth, and slits beside an arm.
const RADII: [(f64, usize); 2] = [(0.0035, 120), (0.006, 30)];
/// A pixel in a gap becomes darker by more, of 255.
const DARKER: u8 = 25;

/// Closes the gaps between strokes, if there are many: light spots that are smaller than a radius take the colour around them
/// (a morphological opening of each channel).
pub(super) fn close(picture: &mut RgbaImage) {
    let side = f64::from(picture.width().max(picture.height()));
    for (radius, most) in RADII {
        let closed = opened(picture, (radius * side).round() as i64);
        let is_gap: Vec<bool> = (picture.pixels().zip(closed.pixels()))
            .map(|(before, after)| {
                let mut pairs = before.0.iter().zip(after.0);
                pairs.any(|(before, after)| before.saturating_sub(after) > DARKER)
            })
            .collect();
        let width = picture.width() as usize;
        let is_in_gap = |at: usize| is_gap[at];
        let joined = |a: usize, b: usize| is_gap[a] && is_gap[b];
        let gaps = connected(
            is_gap.len(),
            width,
            1,
            is_in_gap,
            |at| joined(at, at - 1),
            |at| joined(at, at - width),
        );
        if gaps.firsts.len() <= most {
            return;
        }
        *picture = closed;
    }
}

/// Of each channel the greatest of the least values in discs around a pixel.
fn opened(picture: &RgbaImage, radius: i64) -> RgbaImage {
    let least = of_discs(picture, radius, |a, b| a.min(b));
    of_discs(&least, radius, |a, b| a.max(b))
}

fn of_discs(picture: &RgbaImage, radius: i64, choose: fn(u8, u8) -> u8) -> RgbaImage {
    let [width, height] = [picture.width(), picture.height()].map(i64::from);
    let (pixels, _) = picture.as_raw().as_chunks::<4>();
    // Half the width of the disc at each distance from its middle row.
    let spans: Vec<(i64, i64)> = (-radius..=radius)
        .map(|dy| {
            (
                dy,
                (((radius * radius + radius - dy * dy) as f64).sqrt()) as i64,
            )
        })
        .collect();
    let chosen = |x: i64, y: i64| {
        let mut color = pixels[(y * width + x) as usize];
        for (dy, half) in &spans {
            let row = (y + dy).clamp(0, height - 1) * width;
            let span =
                (row + (x - half).max(0)) as usize..=(row + (x + half).min(width - 1)) as usize;
            for pixel in &pixels[span] {
                for (channel, other) in color.iter_mut().zip(pixel) {
                    *channel = choose(*channel, *other);
                }
            }
        }
        color
    };
    let rows = (0..height).into_par_iter();
    let raw: Vec<u8> = rows
        .flat_map_iter(|y| (0..width).flat_map(move |x| chosen(x, y)))
        .collect();
    RgbaImage::from_raw(picture.width(), picture.height(), raw).unwrap_or_default()
}
