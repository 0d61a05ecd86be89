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
    /// The least area of a region, as a share of the picture.
    pub(super) least_share: f64,
    /// The colours of its flat areas, if it was cleaned.
    pub(super) flat_colors: Option<Vec<[u8; 4]>>,
}

/// The least area of a region in a picture that was drawn cleanly, as a share of it.
const LEAST_SHARE: f64 = 3e-5;

impl Canvas {
    /// The canvas of a picture in which each square of so many pixels along each side is one.
    pub(super) fn new(picture: &RgbaImage, square: usize) -> Self {
        let [inner_width, inner_height] =
            [picture.width(), picture.height()].map(|side| (side as usize).div_ceil(square));
        let (width, height) = (inner_width + 2 * PAD, inner_height + 2 * PAD);
        let mut pixels = vec![[0; 4]; width * height];
        if square == 1 && inner_width > 0 {
            let (colors, _) = picture.as_raw().as_chunks::<4>();
            for (row, line) in colors.chunks_exact(inner_width).enumerate() {
                let start = (row + PAD) * width + PAD;
                for (pixel, color) in pixels[start..].iter_mut().zip(line) {
                    *pixel = premultiplied(*color);
                }
            }
        } else {
            for row in 0..inner_height {
                let means = (0..inner_width).map(|column| mean(picture, [column, row], square));
                let start = (row + PAD) * width + PAD;
                for (pixel, mean) in pixels[start..].iter_mut().zip(means) {
                    *pixel = mean;
                }
            }
        }
        let mut canvas = Self {
            width,
            height,
            pixels,
            background: [0; 4],
            least_share: LEAST_SHARE,
            flat_colors: None,
        };
        canvas.find_background();
        canvas
    }

    /// Finds the background of the picture, and pads the picture with it.
    pub(super) fn find_background(&mut self) {
        let is_clear = |at: usize| self.pixels[at][3] <= TRANSPARENT;
        self.background = if self.rows().flatten().any(is_clear) {
            [0; 4]
        } else {
            self.commonest_on_border()
        };
        let (width, height) = (self.width, self.height);
        for (y, row) in self.pixels.chunks_exact_mut(width).enumerate() {
            if (PAD..height - PAD).contains(&y) {
                row[..PAD].fill(self.background);
                row[width - PAD..].fill(self.background);
            } else {
                row.fill(self.background);
            }
        }
    }

    fn commonest_on_border(&self) -> [u8; 4] {
        let mut counts: FxHashMap<[u8; 4], usize> = FxHashMap::default();
        let (right, bottom) = (self.width - PAD - 1, self.height - PAD - 1);
        for at in self.rows().flatten() {
            let (x, y) = (at % self.width, at / self.width);
            if x == PAD || y == PAD || x == right || y == bottom {
                *counts.entry(self.pixels[at]).or_default() += 1;
            }
        }
        let commonest = counts
            .into_iter()
            .max_by_key(|(color, count)| (*count, *color));
        commonest.map_or([0; 4], |(color, _)| color)
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

/// The mean of the premultiplied colours in a square of pixels, the one in this column and row of squares, as far as it is in the picture.
fn mean(picture: &RgbaImage, [column, row]: [usize; 2], square: usize) -> [u8; 4] {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let (colors, _) = picture.as_raw().as_chunks::<4>();
    let (left, right) = (column * square, ((column + 1) * square).min(width));
    let (mut sums, mut count) = ([0_u32; 4], 0);
    for y in row * square..((row + 1) * square).min(height) {
        for color in &colors[y * width..][left..right] {
            let color = premultiplied(*color);
            for (sum, channel) in sums.iter_mut().zip(color) {
                *sum += u32::from(channel);
            }
            count += 1;
        }
    }
    sums.map(|sum| ((sum + count / 2) / count.max(1)) as u8)
}

fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let by = |c: u8| ((u32::from(c) * u32::from(a) + 127) / 255) as u8;
    match a {
        255 => [r, g, b, a],
        _ => [by(r), by(g), by(b), a],
    }
}

/// The square of the distance of two colours.
#[inline]
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
