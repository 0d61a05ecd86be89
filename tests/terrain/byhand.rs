//! Maps drawn by hand are the maps that were meant: their shapes are off by up to a tenth of a tile, slanted, thick or soft.

use std::fmt::Write as _;
use std::io::Cursor;

use fastrand::Rng;
use image::{ImageFormat, Rgba, RgbaImage};
use okoshi::compile::{Compiled, Options, compile};
use okoshi::diagnostic::{Code, Diagnostic};
use okoshi::internals::terrain::{EDGE_BELOW, EDGE_RIGHT, Landscape, Map};
use okoshi::resolver::MemoryResolver;

use crate::worlds::World;

/// Side of a tile, drawing units.
const TILE: f64 = 10.0;
/// By how much places are off, tiles.
const NOISE: f64 = 0.1;

/// Draws places that are off.
struct Hand(Rng);

impl Hand {
    /// A place on the grid, in drawing units, off by up to [`NOISE`].
    fn place(&mut self, column: f64, row: f64) -> [f64; 2] {
        [column, row].map(|at| (at + (self.0.f64() * 2.0 - 1.0) * NOISE) * TILE)
    }

    fn line(&mut self, from: [usize; 2], to: [usize; 2]) -> String {
        let [a, b] = [from, to].map(|[column, row]| self.place(column as f64, row as f64));
        format!("M{} {}L{} {}", a[0], a[1], b[0], b[1])
    }

    /// All edges as lines of one tile each, or as long as they go on.
    fn edges(&mut self, map: &Map) -> String {
        let mut lines = String::new();
        let has =
            |column: usize, row: usize, edge: u8| map.edges[map.index(column, row)] & edge != 0;
        for column in 0..map.columns {
            for [from, to] in stretches(map.rows, |row| has(column, row, EDGE_RIGHT)) {
                lines += &self.line([column + 1, from], [column + 1, to]);
            }
        }
        for row in 0..map.rows {
            for [from, to] in stretches(map.columns, |column| has(column, row, EDGE_BELOW)) {
                lines += &self.line([from, row + 1], [to, row + 1]);
            }
        }
        lines
    }
}

/// The stretches of numbers up to `count` for which something holds: the first of each, and the one behind it.
fn stretches(count: usize, holds: impl Fn(usize) -> bool) -> Vec<[usize; 2]> {
    let all: Vec<usize> = (0..count).filter(|at| holds(*at)).collect();
    let stretches = all.chunk_by(|one, next| one + 1 == *next);
    let ends = stretches.map(|stretch| [stretch[0], stretch[stretch.len() - 1] + 1]);
    ends.collect()
}

/// The runs of equal cells in each row: first column, row, number of columns, and colour.
fn runs(map: &Map) -> Vec<(usize, usize, usize, String)> {
    let mut runs = vec![];
    for (row, cells) in map.cells.chunks(map.columns).enumerate() {
        let mut column = 0;
        for run in cells.chunk_by(|one, other| one == other) {
            if run[0] != 0 {
                let [r, g, b] = map.tiles[usize::from(run[0])].color();
                runs.push((column, row, run.len(), format!("#{r:02x}{g:02x}{b:02x}")));
            }
            column += run.len();
        }
    }
    runs
}

/// The ways of drawing a map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    Rectangles,
    Polygons,
    ThickStrokes,
    SoftPicture,
    HalfATileOff,
    AnotherSize,
}

/// A drawing of a map, and the files that it links.
fn drawn(map: &Map, way: Way, seed: u64) -> (String, MemoryResolver) {
    let mut hand = Hand(Rng::with_seed(seed));
    let mut files = MemoryResolver::default();
    let mut shapes = String::new();
    for (column, row, length, color) in runs(map) {
        let [left, top, right, bottom] =
            [column, row, column + length, row + 1].map(|at| at as f64);
        match way {
            Way::Rectangles | Way::HalfATileOff | Way::AnotherSize => {
                let [a, b] = [hand.place(left, top), hand.place(right, bottom)];
                let [x, y, width, height] = [a[0], a[1], b[0] - a[0], b[1] - a[1]];
                let _ = write!(
                    shapes,
                    "<rect x='{x}' y='{y}' width='{width}' height='{height}' fill='{color}'/>"
                );
            }
            Way::Polygons => {
                let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
                let corners = corners
                    .map(|[x, y]| hand.place(x, y))
                    .map(|[x, y]| format!("{x},{y}"));
                let _ = write!(
                    shapes,
                    "<polygon points='{}' fill='{color}'/>",
                    corners.join(" ")
                );
            }
            Way::ThickStrokes => {
                let [a, b] = [hand.place(left, top + 0.5), hand.place(right, top + 0.5)];
                let _ = write!(
                    shapes,
                    "<path d='M{} {}L{} {}' stroke='{color}' stroke-width='{TILE}' fill='none'/>",
                    a[0], a[1], b[0], b[1]
                );
            }
            Way::SoftPicture => {}
        }
    }
    if way == Way::SoftPicture {
        files = files.with("map.png", soft(map, &mut hand));
        let [width, height] = [map.columns, map.rows].map(|count| count as f64 * TILE);
        shapes = format!("<image width='{width}' height='{height}' href='map.png'/>");
    }
    let lines = hand.edges(map);
    let (moved, size) = match way {
        Way::HalfATileOff => (TILE / 2.0, TILE),
        Way::AnotherSize => (0.0, 13.0),
        _ => (0.0, TILE),
    };
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 300'><g id='map'><text y='-20' font-size='5'>Land$Tiles {size}</text>
        <g transform='translate({moved} {moved})'>{shapes}<path d='{lines}M0 0' fill='none' stroke='black'/></g></g></svg>"
    );
    (svg, files)
}

/// A picture of 12 pixels a tile whose borders are blurred, as by scaling, and whose colours vary a little. Empty cells are transparent.
fn soft(map: &Map, hand: &mut Hand) -> Vec<u8> {
    const PIXELS: usize = 12;
    let material = |column: usize, row: usize| usize::from(map.cells[map.index(column, row)]);
    let mut picture = RgbaImage::new((map.columns * PIXELS) as u32, (map.rows * PIXELS) as u32);
    let reach = [map.columns * PIXELS - 1, map.rows * PIXELS - 1];
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        let (mut sum, mut count) = ([0; 3], 0);
        for (dx, dy) in (0..3).flat_map(|dx| (0..3).map(move |dy| (dx, dy))) {
            let x = (x as usize + dx).saturating_sub(1).min(reach[0]);
            let y = (y as usize + dy).saturating_sub(1).min(reach[1]);
            let material = material(x / PIXELS, y / PIXELS);
            if material != 0 {
                let color = map.tiles[material].color();
                (0..3).for_each(|channel| sum[channel] += i32::from(color[channel]));
                count += 1;
            }
        }
        let mean = sum.map(|sum| sum / count.max(1) + hand.0.i32(-4..=4));
        let [r, g, b] = mean.map(|mean| mean.clamp(0, 255) as u8);
        *pixel = Rgba([r, g, b, (count * 255 / 9) as u8]);
    }
    let mut bytes = Cursor::new(vec![]);
    picture
        .write_to(&mut bytes, ImageFormat::Png)
        .expect("a PNG");
    bytes.into_inner()
}

fn compiled(svg: &str, files: &MemoryResolver) -> Compiled {
    compile(svg, &Options::default(), files)
}

/// The share of the cells of a map whose visible height is that of a landscape that was read from its drawing.
fn share(map: &Map, read: &Compiled) -> f64 {
    let clean = Landscape::new(map);
    let [mut right, mut all] = [0, 0];
    let layer = read.layers.iter().next().expect("a landscape");
    let heights = |land: &Landscape, column| {
        if column < land.columns() {
            land.visible_heights(column)
        } else {
            vec![]
        }
    };
    for column in 0..map.columns {
        let read = heights(&layer.landscape, column);
        for (row, height) in clean.visible_heights(column).into_iter().enumerate() {
            all += usize::from(height.is_some());
            right += usize::from(height.is_some() && read.get(row) == Some(&height));
        }
    }
    f64::from(right as u32) / f64::from(all as u32)
}

/// Applies the fix of the map's grid.
fn fixed(svg: &str, diagnostics: &[Diagnostic]) -> String {
    let fix = diagnostics
        .iter()
        .filter(|found| found.code == Code::OffGrid);
    let fix = fix.flat_map(|found| &found.fixes).next();
    let mut edits = fix
        .unwrap_or_else(|| panic!("no fix: {diagnostics:?}"))
        .edits
        .clone();
    edits.sort_by_key(|edit| std::cmp::Reverse(edit.span.start));
    let mut svg = svg.to_owned();
    for edit in edits {
        svg.replace_range(edit.span.start..edit.span.end, &edit.text);
    }
    svg
}

/// Ten maps without ambiguities, whose outermost rows and columns are drawn, so that all ways of drawing have the same bounds.
fn clean() -> Vec<Map> {
    let maps = (0..).map(|seed| World::random(seed).draw().map);
    let clear = maps.filter(|map| {
        let drawn = |cells: Vec<usize>| cells.iter().any(|cell| map.cells[*cell] != 0);
        let (columns, count) = (map.columns, map.cells.len());
        Landscape::new(map).ambiguities().is_empty()
            && drawn((0..columns).collect())
            && drawn((count - columns..count).collect())
            && drawn((0..count).step_by(columns).collect())
            && drawn((columns - 1..count).step_by(columns).collect())
    });
    clear.take(10).collect()
}

#[test]
fn maps_drawn_by_hand_are_what_was_meant() {
    for way in [
        Way::Rectangles,
        Way::Polygons,
        Way::ThickStrokes,
        Way::SoftPicture,
        Way::HalfATileOff,
        Way::AnotherSize,
    ] {
        let mut shares = vec![];
        for (index, map) in clean().iter().enumerate() {
            let (mut svg, files) = drawn(map, way, index as u64);
            let mut read = compiled(&svg, &files);
            if matches!(way, Way::HalfATileOff | Way::AnotherSize) {
                svg = fixed(&svg, &read.diagnostics);
                read = compiled(&svg, &files);
            }
            let share = share(map, &read);
            assert!(
                share > 0.97,
                "{way:?}, map {index}: {share}\n{:?}\n{svg}",
                read.diagnostics
            );
            shares.push(share);
        }
        let least = shares.iter().copied().fold(1.0, f64::min);
        println!("{way:?}: at least {least:.3} of the cells of each map have the right height");
    }
}
