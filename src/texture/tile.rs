//! Tiles of patterns and pictures in SVG, drawn by resvg.
//!
//! A drawing may ask its renderer for more than there is time or memory for, so it is looked through before.

use image::RgbaImage;
use resvg::tiny_skia::{Pixmap, Transform};
use usvg::{Node, Paint};

/// Fewest and most pixels along a side of a tile; the longer side has at least [`CLEAR`].
const SIDES: [f64; 2] = [4.0, 512.0];
/// Pixels along the longer side that show a tile well.
const CLEAR: f64 = 64.0;
/// Most things in a tile, with those in patterns, clips and masks that it uses counted each time.
const MOST_NODES: usize = 4096;
/// How deep patterns, clips, masks and groups may hold each other.
const MOST_DEPTH: usize = 64;
/// Most pixels of pictures, layers and inner patterns that are made on the way to a tile.
const MOST_PIXELS: f64 = (256 << 20) as f64;
/// Most pixels of one of them.
const MOST_INNER: f64 = (64 << 20) as f64;
/// How much larger a layer may be than the tile.
const LAYER: f64 = 4.0;

const TOO_MUCH: &str = "it holds too much";

/// Pixels of a tile that covers so many pixels of the page.
pub(super) fn size(wanted: [f64; 2]) -> [u32; 2] {
    let [least, most] = SIDES;
    let longer = wanted[0].max(wanted[1]).max(1e-9);
    let scale = (CLEAR / longer).max(1.0).min(most / longer.min(most));
    wanted.map(|side| (side * scale).round().clamp(least, most) as u32)
}

/// Whether a pattern can be drawn, and how many pixels are touched by it, about.
///
/// # Errors
/// Why not, for people.
pub(super) fn check(
    pattern: &usvg::Pattern,
    [width, height]: [u32; 2],
) -> Result<f64, &'static str> {
    let rect = pattern.rect();
    let scale = (width as f32 / rect.width()).max(height as f32 / rect.height());
    search(pattern.root(), f64::from(scale), width, height)
}

fn search(group: &usvg::Group, scale: f64, width: u32, height: u32) -> Result<f64, &'static str> {
    let tile = f64::from(width) * f64::from(height);
    let mut search = Search {
        tile,
        nodes: 0,
        pixels: 0.0,
    };
    search.group(group, scale, 0)?;
    Ok(search.pixels + search.nodes as f64 * tile)
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

/// A picture in SVG as pixels, `side` along the longer side.
///
/// # Errors
/// Why it cannot be drawn, for people.
pub(crate) fn render_tree(tree: &usvg::Tree, side: u32) -> Result<RgbaImage, &'static str> {
    let (width, height) = (tree.size().width(), tree.size().height());
    let scale = side as f32 / width.max(height);
    let [wide, high] = [width, height].map(|length| ((length * scale).round() as u32).max(1));
    search(tree.root(), f64::from(scale), wide, high)?;
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
    // What is drawn alone is moved to the corner: back to where it stands.
    let corner = group.abs_layer_bounding_box();
    let transform = transform.pre_translate(corner.x(), corner.y());
    let node = Node::Group(Box::new(group.clone()));
    resvg::render_node(&node, transform, &mut pixmap.as_mut()).ok_or("there is nothing in it")?;
    let straight = pixmap.pixels().iter().flat_map(|pixel| {
        let color = pixel.demultiply();
        [color.red(), color.green(), color.blue(), color.alpha()]
    });
    RgbaImage::from_raw(width, height, straight.collect()).ok_or("it is too large")
}

/// Looks a tile through.
struct Search {
    /// Pixels of the tile.
    tile: f64,
    nodes: usize,
    /// Pixels of everything else.
    pixels: f64,
}

/// How much a transform makes larger, at most about.
fn grows(transform: usvg::Transform) -> f64 {
    let (x, y) = transform.get_scale();
    f64::from(x.max(y))
}

impl Search {
    /// `scale` is what a user unit outside the group is worth in pixels.
    fn group(&mut self, group: &usvg::Group, scale: f64, depth: usize) -> Result<(), &'static str> {
        if depth > MOST_DEPTH {
            return Err(TOO_MUCH);
        }
        // A filter's work has no bound that could be told from its size.
        if !group.filters().is_empty() {
            return Err("it holds a filter");
        }
        // The renderer reckons these only roughly, and differently on different machines.
        if matches!(
            group.blend_mode(),
            usvg::BlendMode::ColorDodge | usvg::BlendMode::ColorBurn
        ) {
            return Err("it holds a colour that is dodged or burnt");
        }
        if group.should_isolate() {
            self.made(LAYER * self.tile)?;
        }
        let scale = scale * grows(group.transform());
        let mut clip = group.clip_path();
        while let Some(path) = clip {
            self.made(LAYER * self.tile)?;
            self.group(path.root(), scale * grows(path.transform()), depth + 1)?;
            clip = path.clip_path();
        }
        let mut mask = group.mask();
        while let Some(inner) = mask {
            self.made(LAYER * self.tile)?;
            self.group(inner.root(), scale, depth + 1)?;
            mask = inner.mask();
        }
        for node in group.children() {
            self.nodes += 1;
            if self.nodes > MOST_NODES {
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

    /// Counts what is made on the way.
    fn made(&mut self, pixels: f64) -> Result<(), &'static str> {
        self.pixels += pixels;
        // Written so that what is no number is refused as well.
        if pixels <= MOST_INNER && self.pixels <= MOST_PIXELS {
            Ok(())
        } else {
            Err("it holds something too large")
        }
    }

    fn paint(&mut self, paint: &Paint, scale: f64, depth: usize) -> Result<(), &'static str> {
        let Paint::Pattern(pattern) = paint else {
            return Ok(());
        };
        let scale = scale * grows(pattern.transform());
        let rect = pattern.rect();
        self.made(f64::from(rect.width()) * scale * f64::from(rect.height()) * scale)?;
        self.group(pattern.root(), scale, depth + 1)
    }

    fn image(&mut self, image: &usvg::Image, scale: f64, depth: usize) -> Result<(), &'static str> {
        let size = image.size();
        match image.kind() {
            usvg::ImageKind::SVG(tree) => {
                let grown = f64::from(size.width() / tree.size().width());
                self.made(LAYER * self.tile)?;
                self.group(tree.root(), scale * grown, depth + 1)
            }
            _ => self.made(f64::from(size.width()) * f64::from(size.height())),
        }
    }
}
