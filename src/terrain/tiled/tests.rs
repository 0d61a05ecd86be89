use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use std::time::{Duration, Instant};

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
    let alpha = if tile >= 9 && (x + y) % 2 == 0 {
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
            let found = layers.map(|(numbers, _)| numbers[cell]).find_map(|number| {
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
            });
            found
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

/// A map with this content, its tile set aside.
fn map(attributes: &str, content: &str) -> String {
    let set = r#"<tileset firstgid="1" name="a" tilewidth="4" tileheight="4" spacing="1" margin="2" tilecount="12" columns="4"><image source="a.png"/></tileset>"#;
    format!(
        r#"<map orientation="orthogonal" tilewidth="4" tileheight="4" {attributes}>{set}{content}</map>"#
    )
}

fn layer(width: i64, height: i64, data: &str) -> String {
    map(
        r#"width="2" height="2""#,
        &format!(r#"<layer width="{width}" height="{height}">{data}</layer>"#),
    )
}

/// Reads a map, in little time.
fn tried(text: &str) -> Result<TiledMap, TiledError> {
    let files = MemoryResolver::default()
        .with("m.tmx", text.as_bytes())
        .with("a.png", sheet());
    let started = Instant::now();
    let read = read("m.tmx", &files);
    assert!(
        started.elapsed() < Duration::from_secs(20),
        "it takes too long"
    );
    read
}

#[track_caller]
fn refused(text: &str, why: &str) {
    match tried(text) {
        Ok(map) => panic!("it is read: {} × {}", map.columns, map.rows),
        Err(error) => assert!(error.to_string().contains(why), "{error}"),
    }
}

#[test]
fn sizes_that_are_claimed_are_checked_first() {
    let csv = |text: &str| format!(r#"<data encoding="csv">{text}</data>"#);
    refused(
        &layer(8193, 8192, &csv("1")),
        "8193 × 8192 cells, more than the limit",
    );
    refused(&layer(1 << 62, 1 << 62, &csv("1")), "more than the limit");
    refused(&layer(-4, 4, &csv("1")), "the size of a layer is -4 ×");
    refused(&layer(0, 0, &csv("1")), "the size of a layer is 0 × 0");
    refused(
        &layer(8192, 8192, &csv("1")),
        "has 1 numbers of tiles where its size is 67108864",
    );
    refused(&layer(2, 2, &csv("1,2,3,4,1")), "5 numbers of tiles");
    refused(&layer(2, 2, &csv("1,2,x,4")), "`data` is `x`, not a number");
    refused(&layer(2, 2, &csv("1,2,99999999999,4")), "not a number");
    let tiny = r#"<map width="2" height="2" tilewidth="0" tileheight="-1"/>"#;
    refused(tiny, "the size of a tile is 0 × -1");
    refused(r#"<map width="x"/>"#, "`width` is `x`, not a number");
    refused(
        r#"<map width="-3" height="2" tilewidth="4" tileheight="4"/>"#,
        "the size of a map is -3 × 2",
    );
    // Parts of an infinite map that are far from each other.
    let chunk = |x: i64| format!(r#"<chunk x="{x}" y="0" width="1" height="1">1</chunk>"#);
    let far = csv(&(chunk(0) + &chunk(1 << 30)));
    refused(
        &layer(2, 2, &far),
        "1073741825 × 1 cells, more than the limit",
    );
    refused(
        &layer(2, 2, &csv(&chunk(i64::MIN))),
        "is at -9223372036854775808",
    );
    // A tile set that claims very many tiles takes no memory for them.
    let claims = map(
        r#"width="1" height="1""#,
        r#"<layer width="1" height="1"><data encoding="csv">12</data></layer>"#,
    )
    .replace(r#"tilecount="12""#, r#"tilecount="4000000000""#);
    assert_eq!(tried(&claims).unwrap().cells, [1]);
    refused(
        &claims.replace(">12<", ">13<"),
        "its tile 12 lies outside of the picture",
    );
}

#[test]
fn what_unpacks_to_very_much_is_refused() {
    let zeros = vec![0_u32; 48 << 20];
    for packing in [Packing::Zlib, Packing::Gzip, Packing::Zstd] {
        let [encoding, compression] = packing.names();
        let data = format!(
            r#"<data encoding="{encoding}" compression="{compression}">{}</data>"#,
            packing.text(&zeros)
        );
        refused(
            &layer(2, 2, &data),
            "more numbers of tiles than its size, 4",
        );
    }
    // A frame of zstd that asks for a window of 2 GiB.
    let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd, 0, 21 << 3];
    frame.extend([0; 16]);
    let data = format!(
        r#"<data encoding="base64" compression="zstd">{}</data>"#,
        STANDARD.encode(frame)
    );
    refused(&layer(2, 2, &data), "cannot be read");
    // Many layers of one text.
    let data = format!(
        r#"<data encoding="base64" compression="zlib">{}</data>"#,
        Packing::Zlib.text(&vec![0; 1 << 24])
    );
    let many = format!(r#"<layer width="4096" height="4096">{data}</layer>"#).repeat(40);
    refused(
        &map(r#"width="4096" height="4096""#, &many),
        "cells in total",
    );
}

#[test]
fn broken_numbers_of_tiles_are_refused() {
    let one = |number: &str| layer(1, 1, &format!(r#"<data encoding="csv">{number}</data>"#));
    assert!(tried(&one("12")).is_ok());
    refused(
        &one("13"),
        "a cell has the tile 13, which is in none of its tile sets",
    );
    refused(&one("536870911"), "which is in none");
    refused(&one("-1"), "not a number");
    // Only the bits that turn it.
    refused(&one("3758096384"), "a cell has the tile 0,");
    let no_set = r#"<map width="1" height="1" tilewidth="4" tileheight="4"><layer width="1" height="1"><data encoding="csv">1</data></layer></map>"#;
    refused(no_set, "which is in none of its tile sets");
    let no_picture = one("1").replace(r#"<image source="a.png"/>"#, "");
    refused(&no_picture, "which is in none of its tile sets");
    for odd in [
        r#"spacing="-9""#,
        r#"margin="-3""#,
        r#"margin="9223372036854775807""#,
        r#"columns="-1" margin="99""#,
    ] {
        let name = odd.split('=').next().unwrap();
        let text = one("12");
        let start = text.find(&format!("{name}=")).unwrap();
        let end = start
            + text[start..]
                .find("\" ")
                .map_or_else(|| text[start..].find("\">").unwrap(), |at| at)
            + 1;
        let text = format!("{}{odd}{}", &text[..start], &text[end..]);
        // Whatever it means, it does no harm.
        let _ = tried(&text);
    }
}

#[test]
fn xml_and_json_that_grow_are_refused() {
    let bomb =
        r#"<!DOCTYPE map [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><map>&b;</map>"#;
    refused(bomb, "it has a document type");
    let groups = "<group>".repeat(200_000) + &"</group>".repeat(200_000);
    assert!(tried(&map("", &groups)).is_err());
    let attributes: String = (0..100_000).fold(String::new(), |mut text, at| {
        let _ = write!(text, r#" a{at}="""#);
        text
    });
    refused(
        &format!("<map{attributes}/>"),
        "has more than 64 attributes",
    );
    refused(
        &format!("<map>{}</map>", "<a/>".repeat(2 << 20)),
        "elements",
    );
    refused(
        &format!(r#"{{"layers":{}"#, "[".repeat(1 << 20)),
        "cannot be read",
    );
    let objects = format!(
        r#"{{"tilewidth":4,"tileheight":4,"layers":[{}{{}}]}}"#,
        "{},".repeat(1 << 19)
    );
    refused(&objects, "has more than 262144 objects");
    refused("{}", "missing field");
    refused("", "cannot be read");
    refused("<svg/>", "its outermost element is not a `<map>`");
}

#[test]
fn other_kinds_of_maps_are_refused_by_name() {
    for kind in ["isometric", "hexagonal", "staggered"] {
        let text = layer(2, 2, "").replace("orthogonal", kind);
        refused(
            &text,
            &format!("it is {kind}; only orthogonal maps are read"),
        );
    }
    let data = r#"<data encoding="base64" compression="lzma">AAAA</data>"#;
    refused(&layer(2, 2, data), "compressed with `lzma`");
    refused(
        &layer(2, 2, r#"<data encoding="morse">.</data>"#),
        "encoded as `morse`",
    );
}

#[test]
fn links_stay_in_the_folder() {
    let linked = |source: &str| {
        format!(
            r#"<map width="1" height="1" tilewidth="4" tileheight="4"><tileset firstgid="1" source="{source}"/></map>"#
        )
    };
    for (source, error) in [
        ("../../a.tsx", LinkError::Outside),
        ("/etc/passwd", LinkError::Absolute),
        ("https://a.example/a.tsx", LinkError::Remote),
        ("none.tsx", LinkError::Missing),
    ] {
        let files = MemoryResolver::default().with("maps/m.tmx", linked(source).as_bytes());
        match read("maps/m.tmx", &files) {
            Err(TiledError::Link(_, found)) => assert_eq!(found, error, "{source}"),
            other => panic!("{source}: {other:?}"),
        }
    }
    // A set that links to itself is a set without tiles.
    let itself = linked("m.tmx");
    refused(&itself, "its outermost element is not a `<tileset>`");
}

#[test]
fn what_means_nothing_is_told_once_a_kind() {
    let more = r#"<objectgroup><object id="1" template="m.tmx"/><object id="2"/></objectgroup><objectgroup><object id="3"/></objectgroup><objectgroup/>
<imagelayer/><group offsetx="3"><imagelayer/></group>
<layer width="1" height="1" tintcolor="ff0000" visible="0"/><layer width="1" height="1" tintcolor="ff0000" parallaxx="0.5"/>
<layer width="1" height="1"><properties><property name="Height" value="2.5"/></properties><data encoding="csv">3</data></layer>"#;
    let read = tried(&map(r#"width="1" height="1""#, more)).unwrap();
    let told = [
        Idle::Objects,
        Idle::Images,
        Idle::Shifted,
        Idle::Tinted,
        Idle::Height("2.5".to_owned()),
    ];
    assert_eq!(read.idle, told.into_iter().collect());
    assert_eq!(read.cells, [1]);
}

#[test]
fn groups_hand_down_their_heights_and_opacity() {
    let text = r#"<group opacity="0.5"><properties><property name="height" value="4"/></properties>
<group><layer width="1" height="1"><data encoding="csv">2</data></layer></group></group>"#;
    let read = tried(&map(r#"width="1" height="1""#, text)).unwrap();
    assert_eq!(read.heights[0].height, 4);
    // Half of nothing is solid all the same.
    let atlas = read.atlas.unwrap();
    assert_eq!(atlas.picture.alpha, crate::texture::Alpha::Opaque);
}
