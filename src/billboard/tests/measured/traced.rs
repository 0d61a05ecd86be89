//! Pictures by others, beside what is painted from their regions.

use std::path::Path;

use super::labels::{Labels, Overlaps, Shape};
use crate::geometry::{Outline, Ring};
use crate::raster;

const PICTURES: [&str; 6] = [
    "kenney-green-front",
    "kenney-green-threequarter",
    "kenney-pink-front",
    "kenney-pink-threequarter",
    "robot-00",
    "robot-45",
];
/// Colours that differ by less are the same; each channel from 0 to 1.
const SAME: f64 = 0.05;

/// Red, green, blue and alpha, multiplied, from 0 to 1.
type Color = [f64; 4];

fn apart(a: Color, b: Color) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

/// A hard painting of a picture's regions: which of them, or whose line, is seen in each pixel, and its colour.
struct Painting {
    labels: Vec<Option<usize>>,
    colors: Vec<Color>,
    /// The length of each region's border, pixels.
    borders: Vec<f64>,
}

impl Painting {
    fn new(view: &raster::RasterView, size: [u32; 2], paper: Color) -> Self {
        let count = (size[0] * size[1]) as usize;
        let mut painting = Self {
            labels: vec![None; count],
            colors: vec![paper; count],
            borders: Vec::new(),
        };
        let rings = |outline: &Outline| -> Vec<Ring> {
            let rings = outline.polygons.iter().flat_map(|p| p.rings.iter());
            rings.cloned().collect()
        };
        // All lines are one thing.
        let lines = view.regions.len();
        for (label, region) in view.regions.iter().enumerate() {
            let rings = rings(&region.outline);
            let steps = |ring: &Ring| -> f64 {
                let next = ring.iter().cycle().skip(1);
                ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
            };
            painting.borders.push(rings.iter().map(steps).sum());
            let area = Shape {
                label,
                rings: rings.clone(),
                line: None,
            };
            painting.add(area, region.color, size);
            if let Some(line) = region.line {
                let border = Shape {
                    label: lines,
                    rings,
                    line: Some(line.width),
                };
                painting.add(border, line.color, size);
            }
        }
        for line in &view.lines {
            let area = Shape {
                label: lines,
                rings: rings(&line.outline),
                line: None,
            };
            painting.add(area, line.color, size);
        }
        painting
    }

    fn add(&mut self, shape: Shape, [r, g, b, alpha]: [f64; 4], size: [u32; 2]) {
        let own = [r * alpha, g * alpha, b * alpha, alpha];
        for (at, label) in Labels::new(&[shape], size).pixels.into_iter().enumerate() {
            if label.is_some() {
                self.labels[at] = label;
                let below = self.colors[at];
                self.colors[at] = [0, 1, 2, 3].map(|c| own[c] + below[c] * (1.0 - alpha));
            }
        }
    }

    /// What a picture shows in a pixel: of what is painted there and beside it, what it looks most like. `Err` if its colour is
    /// none of these, and no mixture of two.
    fn shown(
        &self,
        color: Color,
        at: usize,
        [width, height]: [u32; 2],
    ) -> Result<Option<usize>, ()> {
        let [width, height] = [width, height].map(|side| side as usize);
        let (x, y) = (at % width, at / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let near: Vec<usize> = rows
            .flat_map(|row| {
                let columns = x.saturating_sub(1)..(x + 2).min(width);
                columns.map(move |column| row * width + column)
            })
            .collect();
        // The pixel itself wins over others that are equally like it.
        let difference = |at: &usize| apart(self.colors[*at], color);
        let best = near.iter().fold(at, |best, other| {
            if difference(other) < difference(&best) {
                *other
            } else {
                best
            }
        });
        let widest = near.iter().flat_map(|a| near.iter().map(move |b| (a, b)));
        let widest = widest.map(|(a, b)| apart(self.colors[*a], self.colors[*b]));
        let most = widest.fold(0.0, f64::max) / 2.0 + SAME;
        if difference(&best) > most {
            return Err(());
        }
        Ok(self.labels[best])
    }
}

#[test]
fn pictures_by_others_are_their_regions() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/characters");
    let mut regions = 0;
    for name in PICTURES {
        let picture = image::open(folder.join(name).with_extension("png"));
        let picture = picture.expect("a picture").into_rgba8();
        let size = [picture.width(), picture.height()];
        let view = raster::regions(&picture);
        let colors = picture.pixels().map(|pixel| {
            let [r, g, b, alpha] = pixel.0.map(|channel| f64::from(channel) / 255.0);
            [r * alpha, g * alpha, b * alpha, alpha]
        });
        let colors: Vec<Color> = colors.collect();
        // Nothing is drawn in the corner.
        let painting = Painting::new(&view, size, colors[0]);
        let mut overlaps = Overlaps::new(view.regions.len() + 1);
        for (at, color) in colors.iter().enumerate() {
            let shown = painting.shown(*color, at, size).unwrap_or(None);
            overlaps.add(shown, &[(painting.labels[at], 1.0)]);
        }
        for (label, region) in view.regions.iter().enumerate() {
            let ratio = overlaps.ratio(label);
            let off = (overlaps.either[label] - overlaps.common[label]) / painting.borders[label];
            assert!(
                ratio >= 0.98 || off < 0.5,
                "{name}: region {label}, {:?}: {ratio:.3}, its border {off:.2} pixels off",
                region.color
            );
            regions += 1;
        }
    }
    assert!(regions > 60, "{regions}");
}
