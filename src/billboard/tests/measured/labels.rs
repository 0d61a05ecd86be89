//! Pictures in which each pixel says which thing it shows.

use glam::DVec2;
use resvg::tiny_skia::{Color, FillRule, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

use crate::geometry::Ring;

/// The area of one thing.
pub(super) struct Shape {
    pub(super) label: usize,
    /// Pixels, x right, y down; what they surround more than once is filled, too.
    pub(super) rings: Vec<Ring>,
    /// The width of a line along its border, pixels, that is the thing instead of the area.
    pub(super) line: Option<f64>,
}

/// Which thing is seen in each pixel, row by row.
pub(super) struct Labels {
    pub(super) pixels: Vec<Option<usize>>,
}

impl Labels {
    /// Paints shapes over each other, back-most first: a pixel whose centre is inside shows the shape.
    pub(super) fn new(shapes: &[Shape], [width, height]: [u32; 2]) -> Self {
        let mut map = Pixmap::new(width, height).expect("a size");
        for shape in shapes {
            let mut path = PathBuilder::new();
            for ring in &shape.rings {
                for (index, DVec2 { x, y }) in ring.iter().enumerate() {
                    match index {
                        0 => path.move_to(*x as f32, *y as f32),
                        _ => path.line_to(*x as f32, *y as f32),
                    }
                }
                path.close();
            }
            let Some(path) = path.finish() else {
                continue;
            };
            let [low, high, ..] = (shape.label as u32).to_le_bytes();
            let mut paint = Paint::default();
            paint.set_color(Color::from_rgba8(low, high, 0, 255));
            paint.anti_alias = false;
            let as_is = Transform::identity();
            match shape.line {
                None => map.fill_path(&path, &paint, FillRule::Winding, as_is, None),
                Some(width) => {
                    let stroke = Stroke {
                        width: width as f32,
                        line_join: LineJoin::Round,
                        ..Stroke::default()
                    };
                    map.stroke_path(&path, &paint, &stroke, as_is, None);
                }
            }
        }
        let label =
            |alpha: u8, bytes: [u8; 2]| (alpha > 0).then(|| u16::from_le_bytes(bytes).into());
        let pixels = map.pixels().iter();
        Self {
            pixels: pixels
                .map(|pixel| label(pixel.alpha(), [pixel.red(), pixel.green()]))
                .collect(),
        }
    }
}

/// How much of some things is common to two pictures, and how much is in either, pixels.
pub(super) struct Overlaps {
    pub(super) common: Vec<f64>,
    pub(super) either: Vec<f64>,
}

impl Overlaps {
    pub(super) fn new(things: usize) -> Self {
        Self {
            common: vec![0.0; things],
            either: vec![0.0; things],
        }
    }

    /// Adds a pixel in which a picture shows a thing, and another the things of a mixture with a share of each.
    pub(super) fn add(&mut self, shown: Option<usize>, mixture: &[(Option<usize>, f64)]) {
        let mut common = 0.0;
        for (thing, share) in mixture {
            match thing {
                Some(thing) if shown == Some(*thing) => common += share,
                Some(thing) => self.either[*thing] += share,
                None => {}
            }
        }
        if let Some(thing) = shown {
            self.common[thing] += common;
            self.either[thing] += 1.0;
        }
    }

    /// The intersection over the union of a thing, 0 to 1; of fuzzy areas the sum of the lesser shares over that of the greater.
    pub(super) fn ratio(&self, thing: usize) -> f64 {
        self.common[thing] / self.either[thing].max(1.0)
    }
}
