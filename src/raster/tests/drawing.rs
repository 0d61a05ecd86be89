//! Drawings of known shapes, and their comparison with what is repainted.

use image::{Rgba, RgbaImage};
use resvg::tiny_skia::{
    BlendMode, Color, FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Stroke,
    Transform,
};

use super::super::RasterView;
use crate::geometry::Outline;

/// Shapes with and without soft edges. The hard picture has one colour a pixel, that of the shape at its centre.
pub(super) struct Drawing {
    soft: Pixmap,
    hard: Pixmap,
    background: [u8; 4],
    /// The width and colour of the outline of the shapes that follow.
    pub(super) line: Option<(f32, [u8; 4])>,
}

impl Drawing {
    pub(super) fn new(width: u32, height: u32, background: [u8; 4]) -> Self {
        let mut blank = Pixmap::new(width, height).unwrap();
        let [r, g, b, a] = background;
        blank.fill(Color::from_rgba8(r, g, b, a));
        Self {
            soft: blank.clone(),
            hard: blank,
            background,
            line: None,
        }
    }

    pub(super) fn fill(&mut self, path: Path, color: [u8; 4]) {
        for (pixmap, is_soft) in [(&mut self.soft, true), (&mut self.hard, false)] {
            let mut paint = paint(color, is_soft);
            pixmap.fill_path(
                &path,
                &paint,
                FillRule::EvenOdd,
                Transform::identity(),
                None,
            );
            if let Some((width, color)) = self.line {
                paint.set_color_rgba8(color[0], color[1], color[2], color[3]);
                pixmap.stroke_path(&path, &paint, &stroke(width), Transform::identity(), None);
            }
        }
    }

    pub(super) fn stroke(&mut self, path: Path, width: f32, color: [u8; 4]) {
        for (pixmap, is_soft) in [(&mut self.soft, true), (&mut self.hard, false)] {
            let paint = paint(color, is_soft);
            pixmap.stroke_path(&path, &paint, &stroke(width), Transform::identity(), None);
        }
    }

    pub(super) fn clear(&mut self, path: Path) {
        for (pixmap, is_soft) in [(&mut self.soft, true), (&mut self.hard, false)] {
            let mut paint = paint([255; 4], is_soft);
            paint.blend_mode = BlendMode::DestinationOut;
            pixmap.fill_path(
                &path,
                &paint,
                FillRule::EvenOdd,
                Transform::identity(),
                None,
            );
        }
    }

    /// Removes what is outside of a shape.
    pub(super) fn clip(&mut self, path: Path) {
        for (pixmap, is_soft) in [(&mut self.soft, true), (&mut self.hard, false)] {
            let mut mask = Mask::new(pixmap.width(), pixmap.height()).unwrap();
            mask.fill_path(&path, FillRule::EvenOdd, is_soft, Transform::identity());
            pixmap.apply_mask(&mask);
        }
    }

    pub(super) fn picture(&self) -> RgbaImage {
        let mut picture = RgbaImage::new(self.soft.width(), self.soft.height());
        for (pixel, color) in picture.pixels_mut().zip(self.soft.pixels()) {
            let color = color.demultiply();
            *pixel = Rgba([color.red(), color.green(), color.blue(), color.alpha()]);
        }
        picture
    }

    /// Asserts that each colour covers the same pixels when the regions are painted.
    pub(super) fn assert_repainted(&self, view: &RasterView, least: f64) {
        let painted = self.repaint(view);
        let mut counts: Vec<([u8; 4], usize, usize)> = Vec::new();
        let mut count = |color: [u8; 4], both: usize, either: usize| {
            let index = counts.iter().position(|known| is_near(known.0, color));
            let index = index.unwrap_or_else(|| {
                counts.push((color, 0, 0));
                counts.len() - 1
            });
            counts[index].1 += both;
            counts[index].2 += either;
        };
        for (drawn, painted) in colors(&self.hard).zip(colors(&painted)) {
            if is_near(drawn, painted) {
                count(drawn, 1, 1)
            } else {
                count(drawn, 0, 1);
                count(painted, 0, 1);
            }
        }
        assert!(counts.len() > 1);
        for (color, both, either) in counts {
            let ratio = both as f64 / either as f64;
            // A line deviates on both of its sides.
            let least = match self.line {
                Some((width, line)) if is_near(color, line) => 1.0 - 0.5 / f64::from(width),
                _ => least,
            };
            assert!(
                either < 200 || ratio >= least,
                "{color:?}: {both} of {either}"
            );
        }
    }

    /// Asserts that all pixels farther than 2 pixels from a border are painted in their colour, and returns how many there are.
    pub(super) fn assert_inside_repainted(&self, view: &RasterView, case: usize) -> usize {
        let painted: Vec<_> = colors(&self.repaint(view)).collect();
        let drawn: Vec<_> = colors(&self.hard).collect();
        let (width, height) = (self.hard.width() as usize, self.hard.height() as usize);
        let mut compared = 0;
        for y in 2..height - 2 {
            for x in 2..width - 2 {
                let at = y * width + x;
                let window = (0..25).map(|i| drawn[(y + i / 5 - 2) * width + x + i % 5 - 2]);
                if window.into_iter().all(|color| color == drawn[at]) {
                    let (drawn, painted) = (drawn[at], painted[at]);
                    assert!(
                        is_near(drawn, painted),
                        "{case}: {drawn:?}, {painted:?} at {x}, {y}"
                    );
                    compared += 1;
                }
            }
        }
        compared
    }

    /// The regions back to front, each with its line, then the inner lines, without soft edges.
    fn repaint(&self, view: &RasterView) -> Pixmap {
        let mut pixmap = Self::new(self.hard.width(), self.hard.height(), self.background).hard;
        let color = |color: [f64; 4]| color.map(|c| (c * 255.0).round() as u8);
        let rule = FillRule::EvenOdd;
        for region in &view.regions {
            let Some(path) = path(&region.outline) else {
                continue;
            };
            let fill = paint(color(region.color), false);
            pixmap.fill_path(&path, &fill, rule, Transform::identity(), None);
            if let Some(line) = region.line {
                let (line_paint, stroke) =
                    (paint(color(line.color), false), stroke(line.width as f32));
                pixmap.stroke_path(&path, &line_paint, &stroke, Transform::identity(), None);
            }
        }
        for line in &view.lines {
            if let Some(path) = path(&line.outline) {
                let fill = paint(color(line.color), false);
                pixmap.fill_path(&path, &fill, rule, Transform::identity(), None);
            }
        }
        pixmap
    }
}

fn colors(pixmap: &Pixmap) -> impl Iterator<Item = [u8; 4]> {
    let color =
        |c: &resvg::tiny_skia::PremultipliedColorU8| [c.red(), c.green(), c.blue(), c.alpha()];
    pixmap.pixels().iter().map(color)
}

fn is_near(a: [u8; 4], b: [u8; 4]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2)
}

fn paint(color: [u8; 4], is_soft: bool) -> Paint<'static> {
    let mut paint = Paint {
        anti_alias: is_soft,
        ..Paint::default()
    };
    paint.set_color_rgba8(color[0], color[1], color[2], color[3]);
    paint
}

fn stroke(width: f32) -> Stroke {
    Stroke {
        width,
        line_cap: LineCap::Round,
        line_join: LineJoin::Round,
        ..Stroke::default()
    }
}

fn path(outline: &Outline) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for ring in outline.rings() {
        for (index, point) in ring.iter().enumerate() {
            match index {
                0 => builder.move_to(point.x as f32, point.y as f32),
                _ => builder.line_to(point.x as f32, point.y as f32),
            }
        }
        builder.close();
    }
    builder.finish()
}

pub(super) fn disc(x: f32, y: f32, radius: f32) -> Path {
    PathBuilder::from_circle(x, y, radius).unwrap()
}

pub(super) fn rectangle(left: f32, top: f32, right: f32, bottom: f32) -> Path {
    polygon(&[(left, top), (right, top), (right, bottom), (left, bottom)])
}

pub(super) fn polygon(points: &[(f32, f32)]) -> Path {
    let mut builder = PathBuilder::new();
    join(&mut builder, points);
    builder.close();
    builder.finish().unwrap()
}

pub(super) fn line(points: &[(f32, f32)]) -> Path {
    let mut builder = PathBuilder::new();
    join(&mut builder, points);
    builder.finish().unwrap()
}

fn join(builder: &mut PathBuilder, points: &[(f32, f32)]) {
    for (index, &(x, y)) in points.iter().enumerate() {
        match index {
            0 => builder.move_to(x, y),
            _ => builder.line_to(x, y),
        }
    }
}

/// A smooth closed shape with bulges.
pub(super) fn blob(random: &mut fastrand::Rng, (x, y): (f32, f32), radius: f32) -> Path {
    let (bulges, start) = (random.u32(2..5) as f32, random.f32() * 6.0);
    let depth = random.f32() * 0.3;
    let point = |i: u32| {
        let angle = i as f32 / 60.0 * std::f32::consts::TAU;
        let r = radius * (1.0 + depth * (bulges * angle + start).sin());
        (x + r * angle.cos(), y + r * angle.sin())
    };
    polygon(&(0..60).map(point).collect::<Vec<_>>())
}
