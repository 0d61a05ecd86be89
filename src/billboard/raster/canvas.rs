//! The padded picture, and colours as mixtures of others.

use image::RgbaImage;
use rustc_hash::FxHashMap;

/// Pixels of background on each side, so that neighbours within 2 pixels always exist.
pub(super) const PAD: usize = 2;
/// The greatest alpha of a transparent pixel (0.03), in steps of 1/255.
pub(super) const TRANSPARENT: u8 = 7;

/// A premultiplied colour: red, green, blue, alpha, each from 0 to 255.
pub(super) type Color = [f32; 4];

/// A picture with premultiplied colours, padded with its background.
#[derive(Debug)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<[u8; 4]>,
    /// The colour of the padding: nothing if the picture has transparent pixels, else the commonest colour of its border.
    pub(super) background: [u8; 4],
}

impl Canvas {
    pub(super) fn new(picture: &RgbaImage) -> Self {
        let (inner_width, inner_height) = (picture.width() as usize, picture.height() as usize);
        let (width, height) = (inner_width + 2 * PAD, inner_height + 2 * PAD);
        let (colors, _) = picture.as_raw().as_chunks::<4>();
        let background = if colors.iter().any(|color| color[3] <= TRANSPARENT) {
            [0; 4]
        } else {
            commonest_on_border(colors, inner_width, inner_height)
        };
        let mut pixels = vec![background; width * height];
        if inner_width > 0 {
            for (row, line) in colors.chunks_exact(inner_width).enumerate() {
                let start = (row + PAD) * width + PAD;
                for (pixel, color) in pixels[start..].iter_mut().zip(line) {
                    *pixel = premultiplied(*color);
                }
            }
        }
        Self {
            width,
            height,
            pixels,
            background,
        }
    }

    /// Whether transparent pixels are the background.
    pub(super) fn is_cut_out(&self) -> bool {
        self.background[3] <= TRANSPARENT
    }

    pub(super) fn color(&self, at: usize) -> Color {
        self.pixels[at].map(f32::from)
    }

    /// The pixels of the picture without its padding, row by row.
    pub(super) fn rows(&self) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let (width, height) = (self.width, self.height);
        (PAD..height - PAD).map(move |y| y * width + PAD..(y + 1) * width - PAD)
    }

    /// The pixels of the square of 5 × 5 around a pixel that is not of the padding.
    pub(super) fn window(&self, at: usize) -> impl Iterator<Item = usize> + use<> {
        let width = self.width;
        let first = at - 2 * width - 2;
        (0..5).flat_map(move |row| (0..5).map(move |column| first + row * width + column))
    }

    /// The differences of index from a pixel to its eight neighbours: the four that share an edge first.
    pub(super) fn around(&self) -> [isize; 8] {
        let width = self.width as isize;
        [
            -width,
            -1,
            1,
            width,
            -width - 1,
            1 - width,
            width - 1,
            width + 1,
        ]
    }

    /// The differences of index from a pixel to the four that share an edge with it.
    pub(super) fn beside(&self) -> [isize; 4] {
        let width = self.width as isize;
        [-width, -1, 1, width]
    }

    /// Whether a pixel is of the outermost ring of the padding, where not all neighbours exist.
    pub(super) fn is_rim(&self, at: usize) -> bool {
        let (x, y) = (at % self.width, at / self.width);
        x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height
    }
}

fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let by = |c: u8| ((u32::from(c) * u32::from(a) + 127) / 255) as u8;
    match a {
        255 => [r, g, b, a],
        _ => [by(r), by(g), by(b), a],
    }
}

fn commonest_on_border(colors: &[[u8; 4]], width: usize, height: usize) -> [u8; 4] {
    let mut counts: FxHashMap<[u8; 4], usize> = FxHashMap::default();
    for (index, color) in colors.iter().enumerate() {
        let (x, y) = (index % width.max(1), index / width.max(1));
        if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
            *counts.entry(premultiplied(*color)).or_default() += 1;
        }
    }
    let commonest = counts
        .into_iter()
        .max_by_key(|(color, count)| (*count, *color));
    commonest.map_or([0; 4], |(color, _)| color)
}

/// The square of the distance of two colours.
pub(super) fn distance_squared(a: [u8; 4], b: [u8; 4]) -> i32 {
    let square = |i: usize| (i32::from(a[i]) - i32::from(b[i])).pow(2);
    square(0) + square(1) + square(2) + square(3)
}

/// How a colour divides between two others: the share of the second, from 0 to 1, and the square of the distance of the
/// colour from that mixture.
pub(super) fn mixture(color: Color, first: Color, second: Color) -> (f32, f32) {
    let (mut along, mut length) = (0.0, 0.0);
    for i in 0..4 {
        along += (color[i] - first[i]) * (second[i] - first[i]);
        length += (second[i] - first[i]).powi(2);
    }
    let share = if length > 0.0 {
        (along / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let mixed = |i: usize| first[i] + share * (second[i] - first[i]) - color[i];
    let distance = (0..4).map(|i| mixed(i).powi(2)).sum();
    (share, distance)
}

/// The square of the distance of a colour from the nearest mixture of three others that has a share of each; infinite if there is
/// none.
pub(super) fn mixture_of_three(color: Color, [a, b, c]: [Color; 3]) -> f32 {
    let dot = |x: &Color, y: &Color| (0..4).map(|i| x[i] * y[i]).sum::<f32>();
    let from = |x: Color| -> Color { std::array::from_fn(|i| x[i] - a[i]) };
    let (along, across, to) = (from(b), from(c), from(color));
    let (ll, lr, rr) = (
        dot(&along, &along),
        dot(&along, &across),
        dot(&across, &across),
    );
    let (l, r) = (dot(&to, &along), dot(&to, &across));
    let area = ll * rr - lr * lr;
    let (second, third) = ((l * rr - r * lr) / area, (r * ll - l * lr) / area);
    let is_inside = second >= 0.0 && third >= 0.0 && second + third <= 1.0;
    if is_inside {
        (0..4)
            .map(|i| (to[i] - second * along[i] - third * across[i]).powi(2))
            .sum()
    } else {
        f32::INFINITY
    }
}

/// The square of the distance of two colours.
pub(super) fn apart(a: Color, b: Color) -> f32 {
    (0..4).map(|i| (a[i] - b[i]).powi(2)).sum()
}
