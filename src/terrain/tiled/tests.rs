mod refused;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use image::{ImageFormat, Rgba, RgbaImage};
use proptest::prelude::*;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use serde_json::json;

use super::*;
use crate::resolver::MemoryResolver;

/// Tiles of 4 × 4 pixels, four in a row, with a margin and spacing.
const TILE: u32 = 4;
const SHEET_COLUMNS: u32 = 4;
const COUNT: u32 = 12;
const MARGIN: u32 = 2;
const SPACING: u32 = 1;

/// A colour for each pixel of each tile; the last tiles have holes.
fn pixel(tile: u32, x: u32, y: u32) -> [u8; 4] {
    let alpha = if tile >= 9 && (x + y).is_multiple_of(2) {
        0
    } else {
        255
    };
    [20 * tile as u8, 60 * x as u8, 60 * y as u8, alpha]
}

fn png(image: &RgbaImage) -> Vec<u8> {
    let mut bytes = Cursor::new(vec![]);
    image.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn sheet() -> Vec<u8> {
    let side = |count: u32| 2 * MARGIN + count * (TILE + SPACING) - SPACING;
    let mut image = RgbaImage::new(side(SHEET_COLUMNS), side(COUNT / SHEET_COLUMNS));
    for tile in 0..COUNT {
        let corner =
            [tile % SHEET_COLUMNS, tile / SHEET_COLUMNS].map(|at| MARGIN + at * (TILE + SPACING));
        for (x, y) in (0..TILE * TILE).map(|at| (at % TILE, at / TILE)) {
            image.put_pixel(corner[0] + x, corner[1] + y, Rgba(pixel(tile, x, y)));
        }
    }
    png(&image)
}

/// A map to be written in all ways.
#[derive(Debug, Clone)]
struct Sample {
    size: [usize; 2],
    /// Each with its height, or none.
    layers: Vec<(Vec<u32>, Option<i32>)>,
    /// The number of the first tile.
    first: u32,
    /// Per tile its height.
    heights: Vec<Option<i32>>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Packing {
    Elements,
    Csv,
    Base64,
    Zlib,
    Gzip,
    Zstd,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Style {
    packing: Packing,
    /// In chunks, at another place.
    infinite: bool,
    /// The tile set is in a file of its own.
    external: bool,
    json: bool,
}

impl Packing {
    const ALL: [Self; 6] = [
        Self::Elements,
        Self::Csv,
        Self::Base64,
        Self::Zlib,
        Self::Gzip,
        Self::Zstd,
    ];

    fn names(self) -> [&'static str; 2] {
        match self {
            Self::Elements => ["", ""],
            Self::Csv => ["csv", ""],
            Self::Base64 => ["base64", ""],
            Self::Zlib => ["base64", "zlib"],
            Self::Gzip => ["base64", "gzip"],
            Self::Zstd => ["base64", "zstd"],
        }
    }

    fn text(self, numbers: &[u32]) -> String {
        let bytes: Vec<u8> = numbers.iter().flat_map(|one| one.to_le_bytes()).collect();
        match self {
            Self::Elements => numbers
                .iter()
                .map(|number| match number {
                    0 => "<tile/>".to_owned(),
                    number => format!("<tile gid=\"{number}\"/>"),
                })
                .collect(),
            Self::Csv => {
                let written: Vec<String> = numbers.iter().map(u32::to_string).collect();
                format!("\n{}\n", written.join(",\n"))
            }
            Self::Base64 => format!("\n   {}\n  ", STANDARD.encode(bytes)),
            Self::Zlib => {
                let mut packed = ZlibEncoder::new(vec![], Compression::best());
                packed.write_all(&bytes).unwrap();
                STANDARD.encode(packed.finish().unwrap())
            }
            Self::Gzip => {
                let mut packed = GzEncoder::new(vec![], Compression::fast());
                packed.write_all(&bytes).unwrap();
                STANDARD.encode(packed.finish().unwrap())
            }
            Self::Zstd => {
                STANDARD.encode(compress_to_vec(bytes.as_slice(), CompressionLevel::Fastest))
            }
        }
    }
}

/// The place and the numbers of each part of a layer of an infinite map.
fn parts(size: [usize; 2], numbers: &[u32]) -> Vec<([i64; 2], [usize; 2], Vec<u32>)> {
    const SIDE: usize = 3;
    let mut parts = vec![];
    for top in (0..size[1]).step_by(SIDE) {
        for left in (0..size[0]).step_by(SIDE) {
            let [width, height] = [size[0] - left, size[1] - top].map(|most| most.min(SIDE));
            let rows = top..top + height;
            let inner = rows.flat_map(|row| &numbers[row * size[0] + left..][..width]);
            let at = [left as i64 - 5, top as i64 - 7];
            parts.push((at, [width, height], inner.copied().collect()));
        }
    }
    parts.reverse();
    parts
}

impl Sample {
    fn random(seed: u64) -> Self {
        let mut random = fastrand::Rng::with_seed(seed);
        let size = [random.usize(1..9), random.usize(1..9)];
        let first = random.u32(1..50);
        let height = |random: &mut fastrand::Rng| random.bool().then(|| random.i32(-5..9));
        let layers = (0..random.usize(1..5)).map(|_| {
            let numbers = (0..size[0] * size[1]).map(|_| match random.u32(..3) {
                0 => 0,
                _ => first + random.u32(..COUNT) + (random.u32(..8) << 29),
            });
            let numbers = numbers.collect();
            (numbers, height(&mut random))
        });
        let layers = layers.collect();
        let heights = (0..COUNT).map(|_| height(&mut random)).collect();
        Self {
            size,
            layers,
            first,
            heights,
        }
    }

    fn xml(&self, style: Style) -> (String, String) {
        let mut set = format!(
            r#" tilewidth="{TILE}" tileheight="{TILE}" spacing="{SPACING}" margin="{MARGIN}" tilecount="{COUNT}" columns="{SHEET_COLUMNS}" name="a"><image source="a b.png"/>"#
        );
        for (id, height) in self.heights.iter().enumerate() {
            if let Some(height) = height {
                let _ = write!(
                    set,
                    r#"<tile id="{id}"><properties><property name="height" type="int" value="{height}"/></properties></tile>"#
                );
            }
        }
        let tileset = format!("<tileset{set}</tileset>");
        let [width, height] = self.size;
        let first = self.first;
        let mut map = format!(
            r#"<?xml version="1.0"?><map orientation="orthogonal" width="{width}" height="{height}" tilewidth="{TILE}" tileheight="{TILE}" infinite="{}">"#,
            u8::from(style.infinite)
        );
        map += &match style.external {
            true => format!(r#"<tileset firstgid="{first}" source="sets/a.tsx"/>"#),
            false => format!(r#"<tileset firstgid="{first}"{set}</tileset>"#)
                .replace("a b.png", "sets/a b.png"),
        };
        for (numbers, height_of_layer) in &self.layers {
            let _ = write!(map, r#"<layer width="{width}" height="{height}">"#);
            if let Some(height) = height_of_layer {
                let _ = write!(
                    map,
                    r#"<properties><property name="height" value="{height}"/></properties>"#
                );
            }
            let [encoding, compression] = style.packing.names();
            map += "<data";
            for (name, value) in [("encoding", encoding), ("compression", compression)] {
                if !value.is_empty() {
                    let _ = write!(map, r#" {name}="{value}""#);
                }
            }
            map += ">";
            if style.infinite {
                for ([x, y], [width, height], numbers) in parts(self.size, numbers) {
                    let text = style.packing.text(&numbers);
                    let _ = write!(
                        map,
                        r#"<chunk x="{x}" y="{y}" width="{width}" height="{height}">{text}</chunk>"#
                    );
                }
            } else {
                map += &style.packing.text(numbers);
            }
            map += "</data></layer>";
        }
        (map + "</map>", tileset)
    }

    fn json(&self, style: Style) -> (String, String) {
        let data = |numbers: &[u32]| match style.packing {
            Packing::Elements | Packing::Csv => json!(numbers),
            packing => json!(packing.text(numbers)),
        };
        let tiles = self.heights.iter().enumerate();
        let tiles = tiles.filter_map(|(id, height)| {
            let height = (*height)?;
            let property = json!({"name": "height", "type": "int", "value": height});
            Some(json!({"id": id, "properties": [property]}))
        });
        let mut set = json!({
            "name": "a", "tilewidth": TILE, "tileheight": TILE, "spacing": SPACING, "margin": MARGIN,
            "tilecount": COUNT, "columns": SHEET_COLUMNS, "image": "a b.png", "tiles": tiles.collect::<Vec<_>>(),
        });
        let file = set.to_string();
        let [width, height] = self.size;
        let layers = self.layers.iter().map(|(numbers, height_of_layer)| {
            let [encoding, compression] = style.packing.names();
            let mut layer = json!({"type": "tilelayer", "width": width, "height": height, "opacity": 1, "visible": true});
            if encoding == "base64" {
                layer["encoding"] = json!(encoding);
                layer["compression"] = json!(compression);
            }
            if let Some(height) = height_of_layer {
                layer["properties"] = json!([
                    {"name": "other", "type": "class", "value": {"height": 3, "list": [1, {}]}},
                    {"name": "height", "type": "float", "value": f64::from(*height)},
                ]);
            }
            if style.infinite {
                let chunks = parts(self.size, numbers).into_iter();
                let chunks = chunks.map(|([x, y], [width, height], numbers)| {
                    json!({"x": x, "y": y, "width": width, "height": height, "data": data(&numbers)})
                });
                layer["chunks"] = json!(chunks.collect::<Vec<_>>());
            } else {
                layer["data"] = data(numbers);
            }
            layer
        });
        let layers: Vec<_> = layers.collect();
        let tileset = if style.external {
            json!({"firstgid": self.first, "source": "sets/a.tsj"})
        } else {
            set["firstgid"] = json!(self.first);
            set["image"] = json!("sets/a b.png");
            set
        };
        let map = json!({
            "orientation": "orthogonal", "width": width, "height": height, "tilewidth": TILE, "tileheight": TILE,
            "infinite": style.infinite, "tilesets": [tileset], "layers": layers,
        });
        (map.to_string(), file)
    }

    fn read(&self, style: Style) -> TiledMap {
        let (map, set) = if style.json {
            self.json(style)
        } else {
            self.xml(style)
        };
        let (name, set_name) = match style.json {
            true => ("maps/m.tmj", "maps/sets/a.tsj"),
            false => ("maps/m.tmx", "maps/sets/a.tsx"),
        };
        let files = MemoryResolver::default()
            .with(name, map.as_bytes())
            .with(set_name, set.as_bytes())
            .with("maps/sets/a b.png", sheet());
        read(name, &files).unwrap_or_else(|error| panic!("{style:?}: {error}\n{map}"))
    }

    /// Per cell its height, and whether a tile gives it, by the plain method.
    fn expected_height(&self, cell: usize) -> (i8, bool) {
        for (numbers, of_layer) in self.layers.iter().rev() {
            let number = numbers[cell] & 0x0fff_ffff;
            if number == 0 {
                continue;
            }
            if let Some(height) = self.heights[(number - self.first) as usize] {
                return (height as i8, true);
            }
            if let Some(height) = of_layer {
                return (*height as i8, false);
            }
        }
        (UNSET, false)
    }

    /// The pixels of a cell by the plain method; `None` for one that nothing is seen of.
    fn expected_pixels(&self, cell: usize) -> Option<Vec<Option<[u8; 3]>>> {
        let of_pixel = |at: u32| {
            let layers = self.layers.iter().rev();
            layers.map(|(numbers, _)| numbers[cell]).find_map(|number| {
                let id = (number & 0x0fff_ffff).checked_sub(self.first)?;
                // Where the pixel of the turned tile comes from: turns are made in the order swap, across, down.
                let (mut x, mut y) = (at % TILE, at / TILE);
                if number >> 30 & 1 != 0 {
                    y = TILE - 1 - y;
                }
                if number >> 31 & 1 != 0 {
                    x = TILE - 1 - x;
                }
                if number >> 29 & 1 != 0 {
                    (x, y) = (y, x);
                }
                let [r, g, b, alpha] = pixel(id, x, y);
                (alpha > 0).then_some([r, g, b])
            })
        };
        let pixels: Vec<_> = (0..TILE * TILE).map(of_pixel).collect();
        pixels.iter().any(Option::is_some).then_some(pixels)
    }
}

/// The pixels of a place of an atlas.
fn shown(atlas: &Atlas, place: u16) -> Vec<[u8; 3]> {
    let image = image::load_from_memory(&atlas.picture.bytes)
        .unwrap()
        .into_rgb8();
    let (width, height) = image.dimensions();
    let at = |at: u32| {
        let middle = [at % TILE, at / TILE].map(|at| (f64::from(at) + 0.5) / f64::from(TILE));
        let [u, v] = atlas.grid.uv(place, middle);
        let (x, y) = (u * f64::from(width), v * f64::from(height));
        image.get_pixel(x as u32, y as u32).0
    };
    (0..TILE * TILE).map(at).collect()
}

fn styles() -> Vec<Style> {
    let mut styles = vec![];
    for packing in Packing::ALL {
        for bits in 0..8 {
            styles.push(Style {
                packing,
                infinite: bits & 1 != 0,
                external: bits & 2 != 0,
                json: bits & 4 != 0,
            });
        }
    }
    styles
}

/// What a map shows, however its looks are numbered.
fn summary(map: &TiledMap) -> Vec<(i8, bool, Vec<[u8; 3]>)> {
    let of_cell = |look: &u16| {
        let Some(look) = usize::from(*look).checked_sub(1) else {
            return (UNSET, false, vec![]);
        };
        let LookHeight { height, is_of_tile } = map.heights[look];
        let place = map.pictured[look].place;
        let atlas = map.atlas.as_ref().filter(|_| place != 0);
        (
            height,
            is_of_tile,
            atlas.map_or(vec![], |atlas| shown(atlas, place)),
        )
    };
    map.cells.iter().map(of_cell).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// In whichever way a map is saved, it has the same tiles and heights, and they are those that were drawn.
    #[test]
    fn all_ways_to_save_a_map_are_one(seed: u64) {
        let sample = Sample::random(seed);
        let mut first = None;
        for style in styles() {
            let map = sample.read(style);
            prop_assert_eq!([map.columns, map.rows], sample.size, "{:?}", style);
            prop_assert_eq!(&map.idle, &BTreeSet::new(), "{:?}", style);
            let found = summary(&map);
            match &first {
                Some(first) => prop_assert_eq!(first, &found, "{:?}", style),
                None => first = Some(found),
            }
        }
        for (cell, (height, is_of_tile, pixels)) in first.unwrap().into_iter().enumerate() {
            prop_assert_eq!((height, is_of_tile), sample.expected_height(cell), "{}", cell);
            match sample.expected_pixels(cell) {
                None => prop_assert!(pixels.is_empty()),
                Some(expected) => {
                    prop_assert_eq!(pixels.len(), expected.len());
                    for (found, expected) in pixels.iter().zip(expected) {
                        // Holes have the mean colour.
                        prop_assert!(expected.is_none_or(|expected| expected == *found));
                    }
                }
            }
        }
    }

    /// Nothing that a map may be damaged to ends the program.
    #[test]
    fn damaged_maps_are_read_or_refused(seed: u64, json: bool, at in 0.0..1.0_f64, byte: u8, cut: bool) {
        let sample = Sample::random(seed);
        let style = Style { packing: Packing::ALL[(seed % 6) as usize], infinite: seed % 2 == 0, external: false, json };
        let (map, _) = if json { sample.json(style) } else { sample.xml(style) };
        let mut bytes = map.into_bytes();
        let at = (at * bytes.len() as f64) as usize;
        if cut {
            bytes.truncate(at);
        } else {
            bytes[at] = byte;
        }
        let files = MemoryResolver::default().with("m.tmx", bytes).with("sets/a b.png", sheet());
        // Both are right, as long as it ends.
        let _ = read("m.tmx", &files);
    }
}
