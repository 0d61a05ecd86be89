//! Draws tiles of patterns, and pictures in SVG, with resvg.
//!
//! A drawing may ask for more than there is time or memory for, so the cost is estimated first.

use image::RgbaImage;
use resvg::tiny_skia::{Pixmap, Transform};
use usvg::{Node, Paint};

/// The smallest and the largest side of a tile in pixels; the longer side has at least [`MIN_LONG_SIDE`].
const SIDES: [f64; 2] = [4.0, 512.0];
/// The smallest longer side that shows a tile well, in pixels.
const MIN_LONG_SIDE: f64 = 64.0;
/// The largest number of elements in a tile; those in patterns, clips and masks count for each use.
const MAX_NODES: usize = 4096;
/// The deepest nesting of patterns, clips, masks and groups.
const MAX_DEPTH: usize = 64;
/// The largest number of pixels in intermediate pictures, layers and inner patterns together.
const MAX_PIXELS: f64 = (256 << 20) as f64;
/// The largest number of pixels in one of them.
const MAX_INNER_PIXELS: f64 = (64 << 20) as f64;
/// The size of a layer relative to the tile, at most.
const LAYER_TO_TILE: f64 = 4.0;

const TOO_MUCH: &str = "it is too complex";

/// The size in pixels of a tile that covers `wanted` pixels of the page.
pub(super) fn size(wanted: [f64; 2]) -> [u32; 2] {
    let [least, most] = SIDES;
    let longer = wanted[0].max(wanted[1]).max(1e-9);
    let scale = (MIN_LONG_SIDE / longer)
        .max(1.0)
        .min(most / longer.min(most));
    wanted.map(|side| (side * scale).round().clamp(least, most) as u32)
}

/// Checks whether a pattern can be drawn, and estimates how many pixels that touches.
///
/// # Errors
/// The reason why it cannot be drawn, for a diagnostic.
pub(super) fn check(
    pattern: &usvg::Pattern,
    [width, height]: [u32; 2],
) -> Result<f64, &'static str> {
    let rect = pattern.rect();
    let scale = (width as f32 / rect.width()).max(height as f32 / rect.height());
    estimate(pattern.root(), f64::from(scale), width, height)
}

fn estimate(group: &usvg::Group, scale: f64, width: u32, height: u32) -> Result<f64, &'static str> {
    let tile = f64::from(width) * f64::from(height);
    let mut estimate = CostEstimate {
        tile,
        nodes: 0,
        pixels: 0.0,
    };
    estimate.group(group, scale, 0)?;
    Ok(estimate.pixels + estimate.nodes as f64 * tile)
}

/// Draws a pattern's tile.
pub(super) fn render(
    pattern: &usvg::Pattern,
    [width, height]: [u32; 2],
) -> Result<RgbaImage, &'static str> {
    let rect = pattern.rect();
    let scale = Transform::from_scale(width as f32 / rect.width(), height as f32 / rect.height());
    draw(pattern.root(), scale, width, height)
}

/// Rasterises a picture in SVG, with `side` pixels along the longer side.
///
/// # Errors
/// The reason why it cannot be drawn, for a diagnostic.
pub(crate) fn render_tree(tree: &usvg::Tree, side: u32) -> Result<RgbaImage, &'static str> {
    let (width, height) = (tree.size().width(), tree.size().height());
    let scale = side as f32 / width.max(height);
    let [wide, high] = [width, height].map(|length| ((length * scale).round() as u32).max(1));
    estimate(tree.root(), f64::from(scale), wide, high)?;
    let scale = Transform::from_scale(wide as f32 / width, high as f32 / height);
    draw(tree.root(), scale, wide, high)
}

fn draw(
    group: &usvg::Group,
    transform: Transform,
    width: u32,
    height: u32,
) -> Result<RgbaImage, &'static str> {
    let mut pixmap = Pixmap::new(width, height).ok_or("it is too large")?;
    // resvg moves a node that is drawn alone to the corner; this moves it back.
    let corner = group.abs_layer_bounding_box();
    let transform = transform.pre_translate(corner.x(), corner.y());
    let node = Node::Group(Box::new(group.clone()));
    resvg::render_node(&node, transform, &mut pixmap.as_mut()).ok_or("it is empty")?;
    let straight = pixmap.pixels().iter().flat_map(|pixel| {
        let color = pixel.demultiply();
        [color.red(), color.green(), color.blue(), color.alpha()]
    });
    RgbaImage::from_raw(width, height, straight.collect()).ok_or("it is too large")
}

/// The estimated cost of drawing a tile.
struct CostEstimate {
    /// Pixels of the tile.
    tile: f64,
    nodes: usize,
    /// Pixels of intermediate pictures, layers and inner patterns.
    pixels: f64,
}

/// The scale of a transform, approximately and at most.
fn scale_of(transform: usvg::Transform) -> f64 {
    let (x, y) = transform.get_scale();
    f64::from(x.max(y))
}

impl CostEstimate {
    /// Adds a group; `scale` is the number of pixels per user unit outside of it.
    fn group(&mut self, group: &usvg::Group, scale: f64, depth: usize) -> Result<(), &'static str> {
        if depth > MAX_DEPTH {
            return Err(TOO_MUCH);
        }
        // The work of a filter is not bounded by its size.
        if !group.filters().is_empty() {
            return Err("it contains a filter");
        }
        // resvg approximates these, with different results on different machines.
        if matches!(
            group.blend_mode(),
            usvg::BlendMode::ColorDodge | usvg::BlendMode::ColorBurn
        ) {
            return Err("it uses the blend mode color-dodge or color-burn");
        }
        if group.should_isolate() {
            self.add_pixels(LAYER_TO_TILE * self.tile)?;
        }
        let scale = scale * scale_of(group.transform());
        let mut clip = group.clip_path();
        while let Some(path) = clip {
            self.add_pixels(LAYER_TO_TILE * self.tile)?;
            self.group(path.root(), scale * scale_of(path.transform()), depth + 1)?;
            clip = path.clip_path();
        }
        let mut mask = group.mask();
        while let Some(inner) = mask {
            self.add_pixels(LAYER_TO_TILE * self.tile)?;
            self.group(inner.root(), scale, depth + 1)?;
            mask = inner.mask();
        }
        for node in group.children() {
            self.nodes += 1;
            if self.nodes > MAX_NODES {
                return Err(TOO_MUCH);
            }
            match node {
                Node::Group(inner) => self.group(inner, scale, depth + 1)?,
                Node::Path(path) => {
                    let fill = path.fill().map(usvg::Fill::paint);
                    let stroke = path.stroke().map(usvg::Stroke::paint);
                    for paint in [fill, stroke].into_iter().flatten() {
                        self.paint(paint, scale, depth)?;
                    }
                }
                Node::Image(image) => self.image(image, scale, depth)?,
                Node::Text(text) => self.group(text.flattened(), scale, depth + 1)?,
            }
        }
        Ok(())
    }

    fn add_pixels(&mut self, pixels: f64) -> Result<(), &'static str> {
        self.pixels += pixels;
        // Written so that NaN is refused too.
        if pixels <= MAX_INNER_PIXELS && self.pixels <= MAX_PIXELS {
            Ok(())
        } else {
            Err("it contains something too large")
        }
    }

    fn paint(&mut self, paint: &Paint, scale: f64, depth: usize) -> Result<(), &'static str> {
        let Paint::Pattern(pattern) = paint else {
            return Ok(());
        };
        let scale = scale * scale_of(pattern.transform());
        let rect = pattern.rect();
        self.add_pixels(f64::from(rect.width()) * scale * f64::from(rect.height()) * scale)?;
        self.group(pattern.root(), scale, depth + 1)
    }

    fn image(&mut self, image: &usvg::Image, scale: f64, depth: usize) -> Result<(), &'static str> {
        let size = image.size();
        match image.kind() {
            usvg::ImageKind::SVG(tree) => {
                let grown = f64::from(size.width() / tree.size().width());
                self.add_pixels(LAYER_TO_TILE * self.tile)?;
                self.group(tree.root(), scale * grown, depth + 1)
            }
            _ => self.add_pixels(f64::from(size.width()) * f64::from(size.height())),
        }
    }
}
