//! Rasterises a layer at one pixel a cell, without anti-aliasing: the paint of shapes at the middle of each cell, and what most pixels of
//! a picture are there.
//!
//! Bands of rows are drawn on all cores, so that the whole layer is never in memory as a picture.

use glam::{DAffine2, DVec2};
use image::{DynamicImage, GenericImageView as _};
use rayon::prelude::*;
use resvg::tiny_skia::{BlendMode, FillRule, Mask, Paint, Path, PathBuilder, PixmapMut, Transform};
use rustc_hash::FxHashMap;

use super::colors::Named;
use super::grid::{Grid, rectangle};
use super::materials::Paints;
use crate::geometry::Outline;
use crate::terrain::UNSET;

/// The paint of a cell, as a pixel of an internal picture. The last byte gives the meaning of the others: 0 nothing; 255 the
/// index of a paint, little-endian; 1 to 254 the colour of a picture's pixel, the byte being its opacity.
pub(super) type Code = [u8; 4];

/// The code of a cell in which nothing is painted.
pub(super) const NOTHING: Code = [0; 4];
/// The number of paints that have codes.
pub(super) const MAX_PAINTS: usize = 1 << 24;

/// Cells in a band.
const BAND: usize = 1 << 20;
/// The largest number of places along a cell's side at which a picture is looked at.
const MAX_PLACES: f64 = 9.0;
/// The largest number of colours whose names are remembered in a section.
const MAX_NAMES: usize = 1 << 16;
/// The side of what is drawn at once, cells: the rasteriser's arithmetic is exact up to that size.
const SECTION: usize = 4096;

/// The code of a paint.
pub(super) fn paint_code(index: usize) -> Code {
    let [a, b, c, _] = (index as u32).to_le_bytes();
    [a, b, c, 255]
}

/// The index of a paint, if the code is that of one.
pub(super) fn paint_of([a, b, c, kind]: Code) -> Option<usize> {
    (kind == 255).then(|| u32::from_le_bytes([a, b, c, 0]) as usize)
}

/// The colour and opacity of a picture's pixel, if the code is that of one.
pub(super) fn pixel_of([r, g, b, kind]: Code) -> Option<([u8; 3], f64)> {
    let is_pixel = (1..=254).contains(&kind);
    is_pixel.then(|| ([r, g, b], f64::from(kind - 1) / 253.0))
}

/// A filled shape or a picture in a layer.
pub(super) struct Item<'a> {
    /// Its bounding box, cells.
    bounds: [DVec2; 2],
    source: Source<'a>,
    /// The height that its group gives its tiles.
    pub(super) height: Option<i8>,
}

/// What of the items is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Aspect {
    /// The codes of their paints.
    Paints,
    /// Their heights, as codes of [`height_code`].
    Heights,
}

/// The number of heights below 0, by which they are shifted to be codes of paints; the first of these stands for no height.
const HEIGHTS_BELOW: i16 = i8::MAX as i16;

/// The code of an item's height.
fn height_code(height: Option<i8>) -> Code {
    let number = height.map_or(0, |height| i16::from(height) + HEIGHTS_BELOW);
    paint_code(usize::try_from(number).unwrap_or(0))
}

/// The height of a code of [`height_code`].
fn height_of(code: Code) -> i8 {
    match paint_of(code) {
        None | Some(0) => UNSET,
        Some(number) => (number as i16 - HEIGHTS_BELOW) as i8,
    }
}

enum Source<'a> {
    Rectangle(Code),
    Area(&'a Outline, Code),
    Picture(Box<Picture<'a>>),
}

/// A picture whose pixels are tiles.
pub(super) struct Picture<'a> {
    pub(super) pixels: DynamicImage,
    /// From cells to pixels.
    pub(super) to_pixels: DAffine2,
    /// Opacity of the whole picture, 0 to 1.
    pub(super) opacity: f64,
    /// The visible area, if it is clipped.
    pub(super) within: Option<&'a Outline>,
}

impl<'a> Item<'a> {
    /// A shape filled with one paint.
    pub(super) fn area(grid: &Grid, outline: &'a Outline, bounds: [DVec2; 2], code: Code) -> Self {
        Self {
            bounds: bounds.map(|p| grid.cells(p)),
            source: match rectangle(outline) {
                Some(_) => Source::Rectangle(code),
                None => Source::Area(outline, code),
            },
            height: None,
        }
    }

    /// A picture; `bounds` is its bounding box, drawing units.
    pub(super) fn picture(grid: &Grid, bounds: [DVec2; 2], picture: Picture<'a>) -> Self {
        Self {
            bounds: bounds.map(|p| grid.cells(p)),
            source: Source::Picture(Box::new(picture)),
            height: None,
        }
    }

    /// The columns and rows whose middles are in its bounding box: for each the first, and the one after the last.
    pub(super) fn reach(&self, grid: &Grid) -> [[usize; 2]; 2] {
        let [low, high] = self
            .bounds
            .map(|p| (p - 0.5).ceil().clamp(DVec2::ZERO, grid.extent()));
        [
            [low.x as usize, high.x as usize],
            [low.y as usize, high.y as usize],
        ]
    }
}

/// A layer to be drawn.
pub(super) struct Canvas<'a> {
    grid: Grid,
    items: Vec<Item<'a>>,
    paints: &'a Paints<'a>,
    /// Per band the items that overlap it, back-most first.
    bands: Vec<Vec<u32>>,
    /// Rows in a band.
    height: usize,
}

impl<'a> Canvas<'a> {
    pub(super) fn new(grid: Grid, items: Vec<Item<'a>>, paints: &'a Paints<'a>) -> Self {
        let height = (BAND / grid.columns.max(1)).clamp(1, SECTION);
        let mut bands = vec![Vec::new(); grid.rows.div_ceil(height)];
        for (index, item) in items.iter().enumerate() {
            let [columns, rows] = item.reach(&grid);
            if columns[0] < columns[1] && rows[0] < rows[1] {
                for band in &mut bands[rows[0] / height..=(rows[1] - 1) / height] {
                    band.push(index as u32);
                }
            }
        }
        Self {
            grid,
            items,
            paints,
            bands,
            height,
        }
    }

    /// The number of columns of the grid.
    pub(super) fn columns(&self) -> usize {
        self.grid.columns
    }

    /// Whether the group of an item gives its tiles a height.
    pub(super) fn has_heights(&self) -> bool {
        self.items.iter().any(|item| item.height.is_some())
    }

    /// Per cell the height that the group of its front-most item gives its tiles, or [`UNSET`].
    pub(super) fn heights(&self, count: usize) -> Vec<i8> {
        let mut heights = vec![UNSET; count];
        self.bands(&mut heights, |band, heights| {
            band.draw_aspect(Aspect::Heights, |place, _, codes| {
                for (height, code) in heights[place..].iter_mut().zip(codes) {
                    *height = height_of(*code);
                }
            });
        });
        heights
    }

    /// Calls `fill` with every band and its part of `cells`, which has an entry for each cell. The results, from the top.
    pub(super) fn bands<C: Send, T: Send>(
        &self,
        cells: &mut [C],
        fill: impl Fn(Band<'_>, &mut [C]) -> T + Sync,
    ) -> Vec<T> {
        let band = self.height * self.grid.columns.max(1);
        let chunks = cells.par_chunks_mut(band).zip(&self.bands).enumerate();
        chunks
            .map(|(index, (cells, items))| {
                let band = Band {
                    canvas: self,
                    items,
                    first: index * self.height,
                    rows: cells.len() / self.grid.columns,
                };
                fill(band, cells)
            })
            .collect()
    }
}

impl Canvas<'_> {
    /// Replaces the byte of every cell by its entry in the table of its band.
    pub(super) fn remap(&self, cells: &mut [u8], tables: &[Vec<u8>]) {
        let band = self.height * self.grid.columns.max(1);
        let chunks = cells.par_chunks_mut(band).zip(tables);
        chunks.for_each(|(cells, table)| {
            for cell in cells {
                *cell = table[usize::from(*cell)];
            }
        });
    }
}

/// A band of rows.
pub(super) struct Band<'a> {
    canvas: &'a Canvas<'a>,
    items: &'a [u32],
    first: usize,
    rows: usize,
}

impl Band<'_> {
    /// Draws the band. `each` gets runs of cells of a row: the index of the first cell in the band, its index in the map, and the
    /// codes.
    pub(super) fn draw(&self, each: impl FnMut(usize, usize, &[Code])) {
        self.draw_aspect(Aspect::Paints, each);
    }

    fn draw_aspect(&self, aspect: Aspect, mut each: impl FnMut(usize, usize, &[Code])) {
        let columns = self.canvas.grid.columns;
        let mut codes = Vec::new();
        for left in (0..columns).step_by(SECTION) {
            let width = SECTION.min(columns - left);
            codes.clear();
            codes.resize(width * self.rows, NOTHING);
            let mut section = BandSection {
                codes: &mut codes,
                corner: [left, self.first],
                size: [width, self.rows],
            };
            for item in self.items {
                section.draw(&self.canvas.items[*item as usize], self.canvas, aspect);
            }
            for (row, codes) in codes.chunks(width).enumerate() {
                let place = row * columns + left;
                each(place, self.first * columns + place, codes);
            }
        }
    }
}

/// A part of a band.
struct BandSection<'a> {
    codes: &'a mut [Code],
    corner: [usize; 2],
    size: [usize; 2],
}

impl BandSection<'_> {
    fn draw(&mut self, item: &Item<'_>, canvas: &Canvas<'_>, aspect: Aspect) {
        let instead = (aspect == Aspect::Heights).then(|| height_code(item.height));
        let grid = &canvas.grid;
        let [left, top] = self.corner;
        let [width, height] = self.size;
        let [columns, rows] = item.reach(grid);
        let within = |[from, to]: [usize; 2], first: usize, count: usize| {
            let place = |at: usize| at.saturating_sub(first).min(count);
            place(from)..place(to)
        };
        let columns = within(columns, left, width);
        let rows = within(rows, top, height);
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        match &item.source {
            Source::Rectangle(code) => {
                let code = instead.unwrap_or(*code);
                for row in rows {
                    self.codes[row * width..][columns.clone()].fill(code);
                }
            }
            Source::Area(outline, code) => {
                let [r, g, b, a] = instead.unwrap_or(*code);
                let mut paint = Paint::default();
                paint.set_color_rgba8(r, g, b, a);
                paint.anti_alias = false;
                paint.blend_mode = BlendMode::Source;
                let path = self.path(outline, grid);
                let pixels: &mut [u8] = bytemuck::cast_slice_mut(self.codes);
                let pixels = PixmapMut::from_bytes(pixels, width as u32, height as u32);
                if let (Some(mut pixels), Some(path)) = (pixels, path) {
                    pixels.fill_path(
                        &path,
                        &paint,
                        FillRule::EvenOdd,
                        Transform::identity(),
                        None,
                    );
                }
            }
            Source::Picture(picture) => {
                let mask = picture.within.map(|outline| {
                    let mut mask = Mask::new(width as u32, height as u32)?;
                    let path = self.path(outline, grid)?;
                    mask.fill_path(&path, FillRule::EvenOdd, false, Transform::identity());
                    Some(mask)
                });
                let mut most = Majority::new(picture, canvas.paints);
                for row in rows {
                    for column in columns.clone() {
                        let at = row * width + column;
                        let is_visible = match &mask {
                            Some(Some(mask)) => mask.data()[at] != 0,
                            Some(None) => false,
                            None => true,
                        };
                        let corner = DVec2::new((left + column) as f64, (top + row) as f64);
                        if is_visible && let Some(code) = most.of_cell(corner) {
                            self.codes[at] = instead.unwrap_or(code);
                        }
                    }
                }
            }
        }
    }

    /// An outline in pixels of the section.
    fn path(&self, outline: &Outline, grid: &Grid) -> Option<Path> {
        let corner = self.corner.map(|at| at as f64);
        let mut path = PathBuilder::new();
        for ring in outline.rings() {
            for (index, point) in ring.iter().enumerate() {
                let p = grid.cells(*point) - DVec2::from(corner);
                let (x, y) = (p.x as f32, p.y as f32);
                match index {
                    0 => path.move_to(x, y),
                    _ => path.line_to(x, y),
                }
            }
            path.close();
        }
        path.finish()
    }
}

impl Picture<'_> {
    /// The code of the nearest pixel at a place, in cells, if it is opaque.
    fn at(&self, place: DVec2) -> Option<Code> {
        let at = self.to_pixels.transform_point2(place).floor();
        let (width, height) = self.pixels.dimensions();
        let size = DVec2::new(width.into(), height.into());
        if !(at.cmpge(DVec2::ZERO).all() && at.cmplt(size).all()) {
            return None;
        }
        let (x, y) = (at.x as u32, at.y as u32);
        let [r, g, b, alpha] = match &self.pixels {
            DynamicImage::ImageRgb8(pixels) => {
                let [r, g, b] = pixels.get_pixel(x, y).0;
                [r, g, b, 255]
            }
            DynamicImage::ImageRgba8(pixels) => pixels.get_pixel(x, y).0,
            pixels => pixels.get_pixel(x, y).0,
        };
        let opacity = 1 + (self.opacity.clamp(0.0, 1.0) * 253.0).round() as u8;
        (alpha > 127).then_some([r, g, b, opacity])
    }
}

/// Finds what most pixels of a cell are.
struct Majority<'a> {
    picture: &'a Picture<'a>,
    paints: &'a Paints<'a>,
    /// How many places along each side of a cell are looked at: no more than it has pixels.
    places: usize,
    names: FxHashMap<Code, Option<Named>>,
    /// The codes of a cell, each with its number of places; `None` where the picture is transparent.
    counts: Vec<(Option<Code>, usize)>,
}

impl<'a> Majority<'a> {
    fn new(picture: &'a Picture<'a>, paints: &'a Paints<'a>) -> Self {
        let axes = picture.to_pixels.matrix2;
        let pixels = axes.x_axis.length().min(axes.y_axis.length());
        Self {
            picture,
            paints,
            // A pixel's border may lie a little off the cell's.
            places: (pixels + 1e-6).floor().clamp(1.0, MAX_PLACES) as usize,
            names: FxHashMap::default(),
            counts: vec![],
        }
    }

    /// The code of a cell with this corner: the commonest of the name that most of its places have. Colours without a name, such as those
    /// of soft borders, count only where there are no others. `None` if most of it is transparent.
    fn of_cell(&mut self, corner: DVec2) -> Option<Code> {
        self.counts.clear();
        let places = self.places;
        for place in 0..places * places {
            let place = DVec2::new((place % places) as f64, (place / places) as f64);
            let code = self.picture.at(corner + (place + 0.5) / places as f64);
            match self.counts.iter_mut().find(|(known, _)| *known == code) {
                Some((_, count)) => *count += 1,
                None => self.counts.push((code, 1)),
            }
        }
        let most = self
            .counts
            .iter()
            .max_by_key(|(code, count)| (*count, *code))?;
        if most.1 * 2 > places * places {
            return most.0;
        }
        let mut named: Vec<Share> = vec![];
        for (code, count) in &self.counts {
            let name = match code {
                None => None,
                Some(code) => {
                    if self.names.len() > MAX_NAMES {
                        self.names.clear();
                    }
                    let name = self.names.entry(*code);
                    match *name.or_insert_with(|| self.paints.meaning(*code).named) {
                        None => continue,
                        name => name,
                    }
                }
            };
            let best = (*count, *code);
            match named.iter_mut().find(|share| share.name == name) {
                Some(share) => {
                    share.places += count;
                    share.best = share.best.max(best);
                }
                None => named.push(Share {
                    name,
                    places: *count,
                    best,
                }),
            }
        }
        let best = named.iter().max_by_key(|share| (share.places, share.name));
        best.map_or(most.0, |share| share.best.1)
    }
}

/// The places of a cell whose colours have one name.
struct Share {
    /// `None` for transparent places.
    name: Option<Named>,
    places: usize,
    /// How many of them have the commonest code, and that code.
    best: (usize, Option<Code>),
}
