//! A picture of a matching: which regions of a character's views are taken for the same thing.
//!
//! Each character is a row, and each of its views a drawing in it. Regions that are a pair have one colour and one number in all
//! views; regions without a partner are grey with stripes.

mod colors;
mod digits;
mod labels;

use glam::DVec2;
use image::RgbaImage;
use resvg::tiny_skia::{
    Color, FillRule, FilterQuality, Mask, Paint, Path, PathBuilder, Pattern, Pixmap, PixmapPaint,
    SpreadMode, Stroke, Transform,
};
use typed_index_collections::TiVec;

use crate::billboard::{Character, RegionId, TrackId, View, ViewId};
use crate::geometry::Outline;

/// The height of a view, if there is room, pixels.
const HEIGHT: f64 = 480.0;
/// Between views and at the border, pixels.
const MARGIN: f64 = 20.0;
/// The height of the angles below each view, pixels.
const CAPTION: f64 = 28.0;
/// The height of the digits of the angles, pixels.
const CAPTION_DIGITS: f32 = 11.0;
/// The longest side for which views have their full height, pixels.
const LONGEST: f64 = 6000.0;
/// The least height of a view, pixels.
const LEAST_HEIGHT: f64 = 40.0;
/// The width of the line around a region, pixels.
const BORDER: f32 = 1.2;
/// Width and distance of the stripes of regions without a partner, pixels.
const STRIPE: u32 = 2;
const STRIPES: u32 = 7;

const PAPER: [u8; 3] = [255; 3];
const INK: [u8; 3] = [38, 38, 44];
const ALONE: [u8; 3] = [222; 3];
const ALONE_STRIPE: [u8; 3] = [140; 3];

/// A picture of the matching of each character, as described at the top of this module. The number of a region is its place, from
/// 1, in the list of the character's regions.
///
/// `None` if there is nothing to draw, or the picture would be too large for memory.
pub fn picture_of_matches(characters: &[Character]) -> Option<RgbaImage> {
    let rows: Vec<Vec<Cell<'_>>> = characters.iter().map(cells).collect();
    let rows: Vec<_> = rows.into_iter().filter(|row| !row.is_empty()).collect();
    if rows.is_empty() {
        return None;
    }
    let height = height_of_views(&rows);
    let width_of = |row: &Vec<Cell<'_>>| -> f64 {
        let widths = row.iter().map(|cell| cell.size(height)[0] as f64);
        widths.sum()
    };
    let width = rows.iter().map(width_of).fold(0.0, f64::max);
    let row_height = cell_height(height);
    let mut page = Pixmap::new(width as u32, row_height.checked_mul(rows.len() as u32)?)?;
    page.fill(color(PAPER));
    for (index, row) in rows.iter().enumerate() {
        let top = i32::try_from(index as u32 * row_height).ok()?;
        let mut left = 0;
        for cell in row {
            let drawn = cell.draw(height)?;
            let copy = PixmapPaint::default();
            page.draw_pixmap(
                left,
                top,
                drawn.as_ref(),
                &copy,
                Transform::identity(),
                None,
            );
            left += i32::try_from(drawn.width()).ok()?;
        }
    }
    // Every pixel is opaque, so that multiplying with alpha has changed nothing.
    RgbaImage::from_raw(page.width(), page.height(), page.take())
}

/// The views of a character that show something.
fn cells(character: &Character) -> Vec<Cell<'_>> {
    let views = character.views.iter_enumerated();
    let cell = |(index, view): (ViewId, &'_ View)| {
        let (low, high) = view.bounds()?;
        let size = high - low;
        let is_drawable = size.is_finite() && size.max_element() > 0.0;
        is_drawable.then_some((index, low, size))
    };
    let found = views.filter_map(cell);
    found
        .map(|(view, low, size)| Cell {
            character,
            view,
            low,
            size,
        })
        .collect()
}

/// The height at which no row is too long, and all rows together are not.
fn height_of_views(rows: &[Vec<Cell<'_>>]) -> f64 {
    let along = |row: &Vec<Cell<'_>>| {
        let scalable: f64 = row.iter().map(Cell::aspect).sum();
        (LONGEST - 2.0 * MARGIN * row.len() as f64) / scalable
    };
    let down = LONGEST / rows.len() as f64 - 2.0 * MARGIN - CAPTION;
    let most = rows.iter().map(along).fold(HEIGHT.min(down), f64::min);
    most.max(LEAST_HEIGHT)
}

/// The height of a row whose views are `height` pixels high.
fn cell_height(height: f64) -> u32 {
    (height + 2.0 * MARGIN + CAPTION).ceil() as u32
}

/// A view, and what of the drawing it shows.
struct Cell<'a> {
    character: &'a Character,
    view: ViewId,
    /// The corner and the size of the box around its regions, drawing units.
    low: DVec2,
    size: DVec2,
}

impl Cell<'_> {
    /// Width by height, at most so large that the least height is no problem.
    fn aspect(&self) -> f64 {
        let aspect = self.size.x / self.size.y;
        aspect.clamp(0.0, LONGEST / LEAST_HEIGHT)
    }

    /// Width and height in pixels, if the view itself is `height` pixels high.
    fn size(&self, height: f64) -> [u32; 2] {
        let width = (self.aspect() * height + 2.0 * MARGIN).ceil();
        // The angles need room, too.
        let least = f64::from(digits::width(&self.angles(), CAPTION_DIGITS)) + MARGIN;
        [width.max(least) as u32, cell_height(height)]
    }

    /// The direction of the view.
    fn angles(&self) -> String {
        let angles = self.character.turn.views[self.view];
        let rounded = angles.map(|angle| (angle * 10.0).round() / 10.0 + 0.0);
        format!("{}° {}°", rounded[0], rounded[1])
    }

    fn draw(&self, height: f64) -> Option<Pixmap> {
        let [width, full] = self.size(height);
        let mut pixmap = Pixmap::new(width, full)?;
        pixmap.fill(color(PAPER));
        let scale = (height / self.size.y).min(self.aspect() * height / self.size.x);
        let corner = DVec2::new(f64::from(width), height + 2.0 * MARGIN) - self.size * scale;
        let place = |point: DVec2| (point - self.low) * scale + corner / 2.0;
        let stripes = stripes()?;
        // No number lies on the angles.
        let mut labels = labels::Labels::new(width, full - CAPTION as u32)?;
        let mut mask = Mask::new(width, full)?;
        let tracks = self.tracks();
        let regions = &self.character.views[self.view].regions;
        for (region, track) in regions.iter().zip(&tracks) {
            let (Some(path), Some(track)) = (path(&region.outline, place), track) else {
                continue;
            };
            let mut paint = Paint::default();
            if self.is_matched(*track) {
                paint.set_color(color(colors::numbered((*track).into())));
            } else {
                let quality = FilterQuality::Nearest;
                let still = Transform::identity();
                paint.shader =
                    Pattern::new(stripes.as_ref(), SpreadMode::Repeat, quality, 1.0, still);
            }
            let still = Transform::identity();
            pixmap.fill_path(&path, &paint, FillRule::EvenOdd, still, None);
            paint = Paint::default();
            paint.set_color(color(INK));
            let stroke = Stroke {
                width: BORDER,
                ..Stroke::default()
            };
            pixmap.stroke_path(&path, &paint, &stroke, still, None);
            mask.fill_path(&path, FillRule::EvenOdd, true, still);
            labels.cover(&mut mask, path.bounds(), (*track).into());
        }
        labels.write(&mut pixmap);
        let middle = [
            width as f32 / 2.0,
            (height + 2.0 * MARGIN + CAPTION / 2.0 - MARGIN / 2.0) as f32,
        ];
        digits::write(&mut pixmap, &self.angles(), middle, CAPTION_DIGITS);
        Some(pixmap)
    }

    /// Per region of the view its track.
    fn tracks(&self) -> TiVec<RegionId, Option<TrackId>> {
        let count = self.character.views[self.view].regions.len();
        let mut tracks = TiVec::from(vec![None; count]);
        for (index, track) in self.character.matching.tracks.iter_enumerated() {
            if let Some(region) = track.regions[self.view] {
                tracks[region] = Some(index);
            }
        }
        tracks
    }

    /// Whether a track has regions in two views.
    fn is_matched(&self, track: TrackId) -> bool {
        let regions = &self.character.matching.tracks[track].regions;
        regions.iter().flatten().count() > 1
    }
}

/// The pattern of regions without a partner.
fn stripes() -> Option<Pixmap> {
    let mut tile = Pixmap::new(STRIPES, STRIPES)?;
    let pixels = tile.pixels_mut().iter_mut().enumerate();
    for (at, pixel) in pixels {
        let diagonal = (at as u32 % STRIPES + at as u32 / STRIPES) % STRIPES;
        let shown = if diagonal < STRIPE {
            ALONE_STRIPE
        } else {
            ALONE
        };
        *pixel = color(shown).premultiply().to_color_u8();
    }
    Some(tile)
}

fn color([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgba8(r, g, b, 255)
}

/// An outline as a path in the picture; `None` if it is empty.
fn path(outline: &Outline, place: impl Fn(DVec2) -> DVec2) -> Option<Path> {
    let mut path = PathBuilder::new();
    for ring in outline.rings() {
        for (index, point) in ring.iter().enumerate() {
            let at = place(*point);
            match index {
                0 => path.move_to(at.x as f32, at.y as f32),
                _ => path.line_to(at.x as f32, at.y as f32),
            }
        }
        path.close();
    }
    path.finish()
}
