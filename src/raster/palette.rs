//! The flat colours of a picture.

use rustc_hash::FxHashMap;

use super::canvas::{Canvas, TRANSPARENT, distance_squared};

/// Colours are one within this distance (0.03), squared, in steps of 1/255.
pub(super) const SAME: i32 = 58;
/// A pixel with at least so many of its eight neighbours in its colour lies on a flat area.
const FLAT_NEIGHBORS: usize = 3;
/// More colours are not flat art: the rarer ones are left out, so that a photograph takes no longer than a drawing.
const MAX_COLORS: usize = 192;
/// How many different colours of flat areas are merged into the palette, commonest first.
const MAX_CANDIDATES: usize = 8192;

/// The class of a pixel that is in no colour of the palette.
pub(super) const NONE: u16 = u16::MAX;
/// The class of transparent pixels.
pub(super) const CLEAR: u16 = 0;

/// The flat colours of a picture, and the nearest of them to each pixel.
#[derive(Debug)]
pub(super) struct Palette {
    /// Premultiplied, the commonest first. The first place is that of transparent pixels.
    pub(super) colors: Vec<[u8; 4]>,
    /// By pixel, the colour within 0.03, or [`NONE`].
    pub(super) classes: Vec<u16>,
}

/// Finds the flat colours of a picture and classifies its pixels.
pub(super) fn palette(canvas: &Canvas) -> Palette {
    let known = canvas.flat_colors.as_ref();
    let known = known.map(|colors| colors.iter().map(|color| (*color, 1)).collect());
    let colors = merged(canvas, known.unwrap_or_else(|| flat_colors(canvas)));
    let mut classes = Vec::with_capacity(canvas.pixels.len());
    let mut class_of: FxHashMap<[u8; 4], u16> = FxHashMap::default();
    let mut last = (canvas.background, nearest(&colors, canvas.background));
    for &pixel in &canvas.pixels {
        if pixel != last.0 {
            let class = class_of
                .entry(pixel)
                .or_insert_with(|| nearest(&colors, pixel));
            last = (pixel, *class);
        }
        classes.push(last.1);
    }
    Palette { colors, classes }
}

/// The colours of pixels on flat areas, each with its number of pixels, the commonest first.
fn flat_colors(canvas: &Canvas) -> Vec<([u8; 4], usize)> {
    let mut counts: FxHashMap<[u8; 4], usize> = FxHashMap::default();
    let around = canvas.around();
    let pixels = &canvas.pixels;
    let mut run = (canvas.background, 0);
    for row in canvas.rows() {
        for at in row {
            let color = pixels[at];
            let at_offset = |offset: isize| pixels[at.wrapping_add_signed(offset)];
            let alike = |offset: &&isize| distance_squared(at_offset(**offset), color) <= SAME;
            let is_flat = around[..3].iter().all(|offset| at_offset(*offset) == color)
                || around.iter().filter(alike).count() >= FLAT_NEIGHBORS;
            if !is_flat {
                continue;
            }
            if color != run.0 {
                *counts.entry(run.0).or_default() += run.1;
                run = (color, 0);
            }
            run.1 += 1;
        }
    }
    *counts.entry(run.0).or_default() += run.1;
    let mut colors: Vec<_> = counts.into_iter().collect();
    colors.sort_unstable_by_key(|(color, count)| (usize::MAX - count, *color));
    colors.truncate(MAX_CANDIDATES);
    colors
}

/// The colours without those within 0.03 of a commoner one, after the place of transparent pixels and the background's colour.
fn merged(canvas: &Canvas, candidates: Vec<([u8; 4], usize)>) -> Vec<[u8; 4]> {
    let mut colors = vec![[0; 4]];
    if !canvas.is_cut_out() {
        colors.push(canvas.background);
    }
    for (color, count) in candidates {
        let is_known = |known: &[u8; 4]| distance_squared(*known, color) <= SAME;
        let is_full = colors.len() > MAX_COLORS;
        if count > 0 && color[3] > TRANSPARENT && !is_full && !colors[1..].iter().any(is_known) {
            colors.push(color);
        }
    }
    colors
}

fn nearest(colors: &[[u8; 4]], pixel: [u8; 4]) -> u16 {
    if pixel[3] <= TRANSPARENT {
        return CLEAR;
    }
    let distances = colors.iter().map(|color| distance_squared(*color, pixel));
    match distances.enumerate().skip(1).min_by_key(|(_, d)| *d) {
        Some((index, distance)) if distance <= SAME => index as u16,
        _ => NONE,
    }
}
