//! Even light on a sheet of paper.

use std::collections::HashSet;

use image::{Rgba, RgbaImage};

use crate::regions::connected;

/// Squares along the longer side of a picture, in each of which the paper has one colour.
const SQUARES: u32 = 96;
/// Paper is among the lightest pixels of a square: this share of them is darker.
const DARKER: f64 = 0.75;
/// The pixels of a square of paper, but for some exceptions, differ by less, as a share of its colour. With more, something is drawn in it.
const EVEN: f64 = 0.12;
const EXCEPTIONS: f64 = 0.03;
/// Neighbouring squares of paper differ by less, as a share of the lighter one: shadows on it are soft.
const STEP: f64 = 0.1;
/// What is lighter than this share of the paper is paper, with its texture and its noise.
const PAPER: f64 = 0.9;
/// How often the light under drawings is smoothed.
const ROUNDS: usize = 400;
/// Paper is lighter than this, of 255, and its channels differ by at most this share.
const DARKEST: f64 = 70.0;
const TINT: f64 = 0.4;

/// Divides by the light on the paper, and makes paper white. What is drawn keeps its colours in relation to the paper's. A picture whose
/// border is not of one light colour stays as it is.
pub(super) fn even(picture: &mut RgbaImage) -> bool {
    let Some(light) = Light::of(picture) else {
        return false;
    };
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        let paper = light.at(x, y);
        let mut shares = [0.0; 3];
        for (channel, share) in shares.iter_mut().enumerate() {
            *share = f64::from(pixel.0[channel]) / paper[channel].max(1.0);
        }
        let is_paper = shares.iter().all(|share| *share > PAPER);
        let shown = shares.map(|share| {
            if is_paper {
                255
            } else {
                (share * 255.0).round() as u8
            }
        });
        *pixel = Rgba([shown[0], shown[1], shown[2], 255]);
    }
    true
}

/// The colour that the paper has, or would have, everywhere.
struct Light {
    square: u32,
    columns: usize,
    rows: usize,
    colors: Vec<[f64; 3]>,
}

impl Light {
    fn of(picture: &RgbaImage) -> Option<Self> {
        let square = picture
            .width()
            .max(picture.height())
            .div_ceil(SQUARES)
            .max(1);
        let [columns, rows] =
            [picture.width(), picture.height()].map(|side| side.div_ceil(square) as usize);
        let squares =
            (0..columns * rows).map(|at| Square::of(picture, [at % columns, at / columns], square));
        let squares: Vec<Square> = squares.collect();
        let is_border = |at: usize| {
            let (column, row) = (at % columns, at / columns);
            column == 0 || row == 0 || column + 1 == columns || row + 1 == rows
        };
        let border: Vec<usize> = (0..columns * rows).filter(|at| is_border(*at)).collect();
        let mut lights: Vec<f64> = border.iter().map(|at| luma(squares[*at].color)).collect();
        lights.sort_by(f64::total_cmp);
        let usual = lights[lights.len() / 2];
        let seeds = border.iter().filter(|at| {
            let square = squares[**at];
            square.is_even && is_like_paper(square.color) && luma(square.color) > usual / 2.0
        });
        let seeds: Vec<usize> = seeds.copied().collect();
        if seeds.len() < border.len() / 2 {
            return None;
        }
        let joined = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|at| squares[at]);
            a.is_even && b.is_even && is_step(a.color, b.color)
        };
        let labels = connected(
            squares.len(),
            columns,
            1,
            |at| squares[at].is_even,
            |at| joined(at, at - 1),
            |at| joined(at, at - columns),
        );
        let papers: HashSet<_> = seeds.iter().map(|at| labels.of[*at]).collect();
        let is_paper: Vec<bool> = labels.of.iter().map(|of| papers.contains(of)).collect();
        let mut light = Self {
            square,
            columns,
            rows,
            colors: squares.iter().map(|square| square.color).collect(),
        };
        light.fill(&is_paper);
        Some(light)
    }

    /// Under what is drawn, the light goes over from what is around it: each square has the mean of its neighbours.
    fn fill(&mut self, is_paper: &[bool]) {
        let known: Vec<[f64; 3]> = (self.colors.iter().zip(is_paper))
            .filter_map(|(color, is_paper)| is_paper.then_some(*color))
            .collect();
        let mean = mean(known.into_iter());
        let unknown: Vec<usize> = (0..is_paper.len()).filter(|at| !is_paper[*at]).collect();
        for at in &unknown {
            self.colors[*at] = mean;
        }
        for _ in 0..ROUNDS {
            for at in &unknown {
                let around = neighbors(*at, self.columns, self.rows);
                self.colors[*at] = self::mean(around.map(|next| self.colors[next]));
            }
        }
    }

    /// Between the middles of squares, linear.
    fn at(&self, x: u32, y: u32) -> [f64; 3] {
        let place = |pixel: u32, count: usize| {
            let at = ((f64::from(pixel) + 0.5) / f64::from(self.square) - 0.5)
                .clamp(0.0, (count - 1) as f64);
            let low = (at as usize).min(count.saturating_sub(2));
            (low, (low + 1).min(count - 1), at - low as f64)
        };
        let (left, right, across) = place(x, self.columns);
        let (above, below, down) = place(y, self.rows);
        let mut color = [0.0; 3];
        for (channel, mixed) in color.iter_mut().enumerate() {
            let at = |column: usize, row: usize| self.colors[row * self.columns + column][channel];
            let row = |row: usize| at(left, row) + (at(right, row) - at(left, row)) * across;
            *mixed = row(above) + (row(below) - row(above)) * down;
        }
        color
    }
}

/// A square of the picture.
#[derive(Clone, Copy)]
struct Square {
    /// The mean of its lightest pixels.
    color: [f64; 3],
    is_even: bool,
}

impl Square {
    fn of(picture: &RgbaImage, [column, row]: [usize; 2], square: u32) -> Self {
        let [left, top] = [column, row].map(|at| at as u32 * square);
        let [right, bottom] = [
            (left + square).min(picture.width()),
            (top + square).min(picture.height()),
        ];
        let mut colors: Vec<[f64; 3]> = (top..bottom)
            .flat_map(|y| (left..right).map(move |x| (x, y)))
            .map(|(x, y)| {
                let [r, g, b, _] = picture.get_pixel(x, y).0;
                [r, g, b].map(f64::from)
            })
            .collect();
        colors.sort_by(|a, b| luma(*a).total_cmp(&luma(*b)));
        let at = |share: f64| luma(colors[(share * (colors.len() - 1) as f64) as usize]);
        let is_even = at(1.0 - EXCEPTIONS) - at(EXCEPTIONS) <= EVEN * at(1.0 - EXCEPTIONS);
        let begin = (colors.len() as f64 * DARKER) as usize;
        Self {
            color: mean(colors.drain(begin..)),
            is_even,
        }
    }
}

fn mean(colors: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let (mut sum, mut count) = ([0.0; 3], 0.0_f64);
    for color in colors {
        for (sum, channel) in sum.iter_mut().zip(color) {
            *sum += channel;
        }
        count += 1.0;
    }
    sum.map(|sum| sum / count.max(1.0))
}

fn luma(color: [f64; 3]) -> f64 {
    (color[0] + 2.0 * color[1] + color[2]) / 4.0
}

fn is_like_paper(color: [f64; 3]) -> bool {
    let most = color.iter().copied().fold(0.0, f64::max);
    let least = color.iter().copied().fold(f64::INFINITY, f64::min);
    luma(color) > DARKEST && most - least <= TINT * most
}

fn is_step(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter()
        .zip(b)
        .all(|(a, b)| (a - b).abs() <= STEP * a.max(b).max(1.0))
}

fn neighbors(at: usize, columns: usize, rows: usize) -> impl Iterator<Item = usize> {
    let (column, row) = (at % columns, at / columns);
    let left = (column > 0).then(|| at - 1);
    let right = (column + 1 < columns).then(|| at + 1);
    let above = (row > 0).then(|| at - columns);
    let below = (row + 1 < rows).then(|| at + columns);
    [left, right, above, below].into_iter().flatten()
}
