//! Drawings of generated characters as pictures: painted cleanly, or as scanners and JPEG files spoil them.

use glam::DVec2;
use image::codecs::jpeg::JpegEncoder;
use image::{ImageFormat, Rgb, RgbImage, RgbaImage};
use resvg::tiny_skia::{
    Color, FillRule, GradientStop, LineJoin, Paint, Path, PathBuilder, Pixmap, Point,
    RadialGradient, Rect, Shader, SpreadMode, Stroke, StrokeDash, Transform,
};
use typed_index_collections::TiVec;

use super::labels::{Labels, Shape};
use crate::billboard::region::{Direction, Region, RegionId, View};
use crate::billboard::tests::generated::Drawn;
use crate::billboard::tests::generated::random::Random;
use crate::geometry::{Outline, area, bounds};
use crate::raster::{self, RasterView};

/// The width of an outline, as a share of the character's height.
const LINE: f64 = 0.012;
/// What is smaller, as a share of the squared height, has no outline.
const LINED: f64 = 0.001;
const INK: [u8; 3] = [32, 26, 24];
/// The width of a picture, in the character's height: arms are wide.
const WIDE: f64 = 1.25;
/// A region of a picture shows an item if this much of their union is common to both.
const SAME: f64 = 0.5;

/// How a drawing is painted.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Style {
    /// The character's height, pixels.
    pub(super) height: f64,
    /// Whether regions have dark outlines.
    pub(super) is_outlined: bool,
    /// Whether all regions are white.
    pub(super) is_white: bool,
    /// How long a piece is missing in each outline that is at least eight times as long, heights.
    pub(super) gap: f64,
    /// How much darker and lighter regions become from their middle to their borders, from 0 to 1.
    pub(super) shading: f64,
    /// The standard deviation of the noise, in steps of 1/255.
    pub(super) noise: f64,
    /// The quality of the JPEG file.
    pub(super) jpeg: Option<u8>,
}

impl Style {
    /// The width and height of a picture.
    pub(super) fn size(self) -> [u32; 2] {
        [(WIDE * self.height).ceil() as u32; 2]
    }

    /// From a drawing to pixels.
    fn place(self, scale: f64) -> impl Fn(DVec2) -> DVec2 {
        let middle = f64::from(self.size()[0]) / 2.0;
        move |p| p * (self.height / scale) + middle
    }

    /// Paints a drawing of a character with this many drawing units per height.
    pub(super) fn paint(self, drawn: &Drawn, scale: f64, seed: u64) -> RgbaImage {
        let [width, height] = self.size();
        let mut map = Pixmap::new(width, height).expect("a size");
        map.fill(Color::WHITE);
        let place = self.place(scale);
        let mut random = Random::new(seed);
        for region in &drawn.view.regions {
            let Some(path) = path(&region.outline, &place) else {
                continue;
            };
            let bounds = path.bounds();
            let paint = Paint {
                shader: self.shader(region, bounds),
                ..Paint::default()
            };
            let as_is = Transform::identity();
            map.fill_path(&path, &paint, FillRule::Winding, as_is, None);
            if self.is_outlined && area(&region.outline) > LINED * scale * scale {
                let mut ink = Paint::default();
                ink.set_color_rgba8(INK[0], INK[1], INK[2], 255);
                let stroke = Stroke {
                    width: (LINE * self.height) as f32,
                    line_join: LineJoin::Round,
                    dash: self.gap_in(&path, &mut random),
                    ..Stroke::default()
                };
                map.stroke_path(&path, &ink, &stroke, as_is, None);
            }
        }
        let pixels = map.pixels().iter();
        let channels = pixels.flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]);
        let picture = RgbImage::from_raw(width, height, channels.collect());
        self.spoiled(picture.expect("as many pixels"), seed)
    }

    /// One piece of an outline is missing; `None` if it is too short for that.
    fn gap_in(self, path: &Path, random: &mut Random) -> Option<StrokeDash> {
        let gap = (self.gap * self.height) as f32;
        let points = path.points();
        let next = points.iter().cycle().skip(1);
        let steps = points.iter().zip(next);
        let length: f32 = steps.map(|(a, b)| a.distance(*b)).sum();
        let start = random.between(0.0, f64::from(length)) as f32;
        (gap > 0.0 && length > 8.0 * gap)
            .then(|| StrokeDash::new(vec![length - gap, gap], start))
            .flatten()
    }

    fn shader(self, region: &Region, bounds: Rect) -> Shader<'static> {
        let color = |by: f64| {
            let own = if self.is_white {
                [1.0; 4]
            } else {
                region.color
            };
            let [r, g, b, _] = own.map(|c| (c * by).clamp(0.0, 1.0) as f32);
            Color::from_rgba(r, g, b, 1.0).expect("a colour")
        };
        let middle = Point::from_xy(
            bounds.left() + 0.35 * bounds.width(),
            bounds.top() + 0.3 * bounds.height(),
        );
        let gradient = (self.shading > 0.0).then(|| {
            let stops = [-1.0, 1.0].map(|side| {
                let at = if side < 0.0 { 1.0 } else { 0.0 };
                GradientStop::new(at, color(1.0 + side * self.shading))
            });
            RadialGradient::new(
                middle,
                0.0,
                middle,
                0.8 * bounds.width().max(bounds.height()),
                stops.to_vec(),
                SpreadMode::Pad,
                Transform::identity(),
            )
        });
        gradient
            .flatten()
            .unwrap_or_else(|| Shader::SolidColor(color(1.0)))
    }

    fn spoiled(self, mut picture: RgbImage, seed: u64) -> RgbaImage {
        if self.noise > 0.0 {
            let mut random = Random::new(seed);
            for Rgb(pixel) in picture.pixels_mut() {
                for channel in pixel {
                    // A normal distribution (Box and Muller).
                    let radius = (-2.0 * (1.0 - random.next()).ln()).sqrt();
                    let value = radius * (std::f64::consts::TAU * random.next()).cos();
                    *channel = (f64::from(*channel) + self.noise * value).round() as u8;
                }
            }
        }
        if let Some(quality) = self.jpeg {
            let mut file = Vec::new();
            let encoder = JpegEncoder::new_with_quality(&mut file, quality);
            picture.write_with_encoder(encoder).expect("a file");
            let read = image::load_from_memory_with_format(&file, ImageFormat::Jpeg);
            picture = read.expect("a picture").into_rgb8();
        }
        image::DynamicImage::from(picture).into_rgba8()
    }
}

fn path(outline: &Outline, place: impl Fn(DVec2) -> DVec2) -> Option<Path> {
    let mut path = PathBuilder::new();
    for ring in outline.rings() {
        for (index, point) in ring.iter().enumerate() {
            let [x, y] = place(*point).to_array().map(|at| at as f32);
            match index {
                0 => path.move_to(x, y),
                _ => path.line_to(x, y),
            }
        }
        path.close();
    }
    path.finish()
}

/// What okoshi sees in a picture, pixels.
pub(super) struct Seen {
    pub(super) view: View,
    /// By region, the item that it shows.
    pub(super) items: TiVec<RegionId, Option<usize>>,
    /// By region that shows an item, a pixel of it far from other regions.
    pub(super) points: TiVec<RegionId, Option<DVec2>>,
}

impl Style {
    /// The regions of a painted drawing.
    pub(super) fn seen(
        self,
        picture: &RgbaImage,
        drawn: &Drawn,
        (scale, direction): (f64, Direction),
    ) -> Seen {
        self.of_view(view(raster::regions(picture), direction), drawn, scale)
    }

    /// The same of regions that are known, in pixels.
    pub(super) fn of_view(self, view: View, drawn: &Drawn, scale: f64) -> Seen {
        let place = self.place(scale);
        let rings = |outline: &Outline, place: &dyn Fn(DVec2) -> DVec2| {
            let rings = outline.rings();
            rings
                .map(|ring| ring.iter().map(|point| place(*point)).collect())
                .collect()
        };
        let true_shapes = drawn.view.regions.iter().zip(&drawn.items);
        let true_shapes: Vec<Shape> = true_shapes
            .map(|(region, item)| Shape {
                label: *item,
                rings: rings(&region.outline, &place),
                line: None,
            })
            .collect();
        let regions = view.regions.iter_enumerated();
        let regions = regions.map(|(id, region)| Shape {
            label: usize::from(id),
            rings: rings(&region.outline, &|point| point),
            line: None,
        });
        let size = self.size();
        let truth = Labels::new(&true_shapes, size).pixels;
        let found = Labels::new(&regions.collect::<Vec<_>>(), size).pixels;
        let most = drawn.items.iter().max().map_or(0, |most| most + 1);
        let mut common = vec![vec![0_usize; most]; view.regions.len()];
        let mut areas = vec![0_usize; most];
        let mut own = vec![0_usize; view.regions.len()];
        for (truth, found) in truth.iter().zip(&found) {
            if let Some(item) = truth {
                areas[*item] += 1;
            }
            if let Some(region) = found {
                own[*region] += 1;
                if let Some(item) = truth {
                    common[*region][*item] += 1;
                }
            }
        }
        let item = |region: usize| {
            let shares = (0..most).map(|item| {
                let common = common[region][item];
                let union = own[region] + areas[item] - common;
                (item, common as f64 / union.max(1) as f64)
            });
            let best = shares.reduce(|best, next| if next.1 > best.1 { next } else { best })?;
            (best.1 >= SAME).then_some(best.0)
        };
        let items: TiVec<RegionId, Option<usize>> = (0..view.regions.len()).map(item).collect();
        let points = items.iter_enumerated();
        let points = points.map(|(id, item)| {
            item.and_then(|_| deepest(&found, size[0] as usize, usize::from(id), &view))
        });
        Seen {
            points: points.collect(),
            items,
            view,
        }
    }
}

/// The middle of the largest square of pixels in which a region is seen.
fn deepest(labels: &[Option<usize>], width: usize, region: usize, view: &View) -> Option<DVec2> {
    let (low, high) = bounds(&view.regions[RegionId::from(region)].outline)?;
    let [low, high] = [low, high].map(|corner| corner.max(DVec2::ZERO).to_array());
    let rows = low[1] as usize..=(high[1] as usize).min(labels.len() / width - 1);
    let columns = low[0] as usize..=(high[0] as usize).min(width - 1);
    // The side of the largest square that ends at each pixel of the row above.
    let mut sides = vec![0_usize; width + 1];
    let mut best = (0, DVec2::ZERO);
    for y in rows {
        let mut corner = 0;
        for x in columns.clone() {
            let above = sides[x + 1];
            let is_own = labels[y * width + x] == Some(region);
            let side = if is_own {
                1 + above.min(sides[x]).min(corner)
            } else {
                0
            };
            corner = above;
            sides[x + 1] = side;
            if side > best.0 {
                let end = DVec2::new(x as f64 + 1.0, y as f64 + 1.0);
                best = (side, end - side as f64 / 2.0);
            }
        }
    }
    (best.0 > 0).then_some(best.1)
}

/// The regions of a picture as a view, pixels.
fn view(found: RasterView, direction: Direction) -> View {
    let region = |outline: Outline, color, container: Option<usize>| Region {
        name: None,
        outline: outline.into(),
        color,
        container: container.map(RegionId::from),
        is_line: false,
    };
    let regions = found.regions.into_iter();
    let regions = regions.map(|found| region(found.outline, found.color, found.container));
    let lines = found.lines.into_iter();
    let lines = lines.map(|line| region(line.outline, line.color, line.region));
    View {
        direction,
        regions: regions.chain(lines).collect(),
    }
}
