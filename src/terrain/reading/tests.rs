mod plain;

use std::io::Cursor;

use image::{ImageFormat, RgbaImage};
use proptest::prelude::*;

use super::*;
use crate::bind;
use crate::memo::Memo;
use crate::resolver::MemoryResolver;
use crate::svg;
use crate::terrain::{EDGE_BELOW, EDGE_RIGHT, Tile};

const GREEN: &str = "#4caf50";
const COLORS: [&str; 5] = [GREEN, "#8d6e63", "#42a5f5", "#e53935", "#f5deb3"];

/// The layers of a drawing with linked files, and the codes of the diagnostics.
fn read_with(svg: &str, files: MemoryResolver) -> (Vec<Layer>, Vec<String>) {
    let svg =
        format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400">{svg}</svg>"#);
    let (drawing, mut diagnostics) = svg::read(
        &svg,
        0.001,
        &files,
        &bind::in_layers_of_pixels,
        &bind::makes_pose_layer,
    );
    let bindings = bind::bind(&drawing, &Memo::none(), &mut diagnostics);
    let layers = read(&drawing, &bindings, &files, &Memo::none(), &mut diagnostics);
    // Heights are tested elsewhere.
    let told = diagnostics.iter();
    let told = told.filter(|found| found.code != Code::OpenTerrain);
    let told = told.map(|found| format!("{}: {}", found.code.id(), found.message));
    (layers.into(), told.collect())
}

fn read_svg(svg: &str) -> (Vec<Layer>, Vec<String>) {
    read_with(svg, MemoryResolver::default())
}

/// A layer of tiles of 10 units, its string far off.
fn island(tiles: &str) -> String {
    format!(r#"<g id="map">{tiles}<text x="0" y="390">Island$Tiles 10</text></g>"#)
}

fn rect(x: f64, y: f64, width: f64, height: f64, fill: &str) -> String {
    format!(r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="{fill}"/>"#)
}

/// The map with a letter for each cell.
fn drawn(layer: &Layer) -> Vec<String> {
    let letter = |cell: usize| match layer.map.tile(cell) {
        Tile::None => '.',
        Tile::Green => 'g',
        Tile::Brown => 'b',
        Tile::Blue => 'w',
        Tile::Red => 'r',
        Tile::Beige => 'h',
    };
    let row = |row: usize| {
        let columns = 0..layer.map.columns;
        columns
            .map(|column| letter(layer.map.index(column, row)))
            .collect()
    };
    (0..layer.map.rows).map(row).collect()
}

/// The only layer of a drawing without diagnostics.
fn only(svg: &str) -> Layer {
    let (mut layers, told) = read_svg(svg);
    assert_eq!(told, [""; 0]);
    assert_eq!(layers.len(), 1);
    layers.remove(0)
}

fn png(width: u32, height: u32, color: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let pixels = RgbaImage::from_fn(width, height, |x, y| image::Rgba(color(x, y)));
    let mut bytes = Cursor::new(Vec::new());
    pixels.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

fn rgba(color: &str) -> [u8; 4] {
    let channel = |at: usize| u8::from_str_radix(&color[at..at + 2], 16).unwrap();
    [channel(1), channel(3), channel(5), 255]
}

#[test]
fn squares_rectangles_and_free_shapes_are_tiles() {
    let layer = only(&island(
        r##"<rect x="20" y="30" width="50" height="40" fill="#4caf50"/>
        <g transform="translate(30 40)"><g transform="scale(2)"><rect width="10" height="5" fill="#8d6e63"/></g></g>
        <path d="M56 36 L88 50 L56 66 Z" fill="#42a5f5"/>"##,
    ));
    assert_eq!(drawn(&layer), ["ggggg..", "gbbgww.", "ggggww.", "ggggg.."]);
    assert_eq!(layer.origin, DVec2::new(20.0, 30.0));
    assert_eq!(
        (layer.size, layer.roof, layer.bevel),
        (10.0, DEFAULT_ROOF, 0.0)
    );
    assert_eq!((layer.name.as_str(), layer.parent), ("Island", None));
    assert_eq!(layer.sources[1].columns, 1..3);
    assert_eq!(layer.sources[1].rows, 1..2);
    assert_eq!(layer.cell_at(DVec2::new(20.5, 41.0)), Some(7));
    assert_eq!(layer.cell_at(DVec2::new(19.0, 41.0)), None);
}

#[test]
fn materials_have_the_colors_that_are_drawn() {
    let layer = only(&island(&format!(
        "{}{}{}",
        rect(0.0, 0.0, 20.0, 10.0, GREEN),
        rect(20.0, 0.0, 10.0, 10.0, "#00a000"),
        rect(30.0, 0.0, 10.0, 10.0, "#2060e0"),
    )));
    let tiles: Vec<Tile> = layer
        .materials
        .iter()
        .map(|material| material.tile)
        .collect();
    assert_eq!(tiles, [Tile::None, Tile::Green, Tile::Green, Tile::Blue]);
    assert_eq!(layer.map.tiles, tiles);
    assert_eq!(layer.map.cells, [2, 2, 1, 3]);
    let color = layer.materials[1]
        .factors
        .color
        .map(|channel| (channel * 255.0).round());
    assert_eq!(color, [0.0, 160.0, 0.0, 255.0]);
}

#[test]
fn legends_say_what_paints_mean() {
    let swatches = |inside: &str, outside: &str| {
        format!(
            r##"<g id="map"><rect width="20" height="10" fill="#800080"/><rect x="20" width="10" height="10" fill="#112233"/>
            {inside}<text x="0" y="390">Island$Tiles 10 Roughness 0.5</text></g>{outside}"##
        )
    };
    let swatch = r##"<rect x="100" y="100" width="10" height="10" fill="#800080"/>
        <text x="110" y="100" font-size="5">$Tile red Color #ff0000 Metallic 1</text>
        <rect x="100" y="130" width="10" height="10" fill="#112233"/>
        <text x="110" y="130" font-size="5">$Tile none</text>"##;
    for svg in [swatches(swatch, ""), swatches("", swatch)] {
        let layer = only(&svg);
        assert_eq!(drawn(&layer), ["rr."]);
        let look = &layer.materials[1].factors;
        assert_eq!(
            (look.color, look.metallic, look.roughness),
            ([1.0, 0.0, 0.0, 1.0], 1.0, 0.5)
        );
        assert!(layer.materials[1].is_tinted && layer.materials[1].legend.is_some());
    }
}

#[test]
fn unused_legends_are_reported() {
    let swatch = r##"<rect x="100" y="100" width="10" height="10" fill="#800080"/>
        <text x="110" y="100" font-size="5">$Tile red</text>"##;
    let tiles = island(&(rect(0.0, 0.0, 10.0, 10.0, GREEN) + swatch));
    let picture = island(&format!(
        r#"<image width="20" height="10" href="map.png"/>{swatch}"#
    ));
    let map = png(2, 1, |_, _| rgba(GREEN));
    for svg in [tiles, picture] {
        let files = MemoryResolver::default().with("map.png", map.clone());
        let (_, told) = read_with(&svg, files);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(
            told[0].starts_with("W303: no tile has the paint of this legend"),
            "{told:?}"
        );
    }
}

#[test]
fn unclear_colors_are_errors_that_name_cells() {
    let (layers, told) = read_svg(&island(&format!(
        "{}{}{}",
        rect(0.0, 0.0, 20.0, 10.0, GREEN),
        rect(0.0, 10.0, 50.0, 10.0, "#808080"),
        rect(20.0, 0.0, 10.0, 10.0, "#800080"),
    )));
    assert_eq!(
        told,
        [
            "E206: the colour #808080 is not a tile colour of `Island`: column 1, row 2; column 2, row 2; column 3, row 2 and 2 more",
            "E206: the colour #800080 is not a tile colour of `Island`: column 3, row 1",
        ]
    );
    assert_eq!(drawn(&layers[0]), ["gg...", "....."]);
}

#[test]
fn sand_is_ground_unless_a_roof_lies_over_it() {
    const SAND: &str = "#d2b48c";
    // A house with walls of sand on a beach, another one in a meadow whose wall is wider than its roof, and a frame around a wall.
    let layer = only(&island(&format!(
        "{}{}{}{}{}{}{}",
        rect(0.0, 0.0, 90.0, 60.0, GREEN),
        rect(0.0, 30.0, 60.0, 30.0, SAND),
        rect(10.0, 20.0, 20.0, 10.0, COLORS[3]),
        rect(70.0, 10.0, 10.0, 10.0, COLORS[3]),
        rect(70.0, 20.0, 20.0, 10.0, SAND),
        rect(70.0, 40.0, 10.0, 10.0, SAND),
        r##"<path d="M10 50 H30" stroke="black" fill="none"/>"##,
    )));
    assert_eq!(
        drawn(&layer),
        [
            "ggggggggg",
            "gggggggrg",
            "grrgggghh",
            "ghhgggggg",
            "ghhgggggg",
            "ggggggggg"
        ]
    );
    let sand: Vec<_> = layer
        .materials
        .iter()
        .filter(|material| material.is_sand)
        .collect();
    assert_eq!(sand.len(), 1);
    let walls: Vec<_> = layer
        .materials
        .iter()
        .filter(|material| material.tile == Tile::Beige)
        .collect();
    assert_eq!(walls.len(), 1);
    assert_eq!(walls[0].factors, sand[0].factors);
}

#[test]
fn a_road_of_sand_is_no_wall() {
    let road = |road: &str| {
        let layer = only(&island(&format!(
            "{}{}{}{road}",
            rect(0.0, 0.0, 50.0, 50.0, GREEN),
            rect(10.0, 0.0, 20.0, 10.0, COLORS[3]),
            rect(10.0, 10.0, 20.0, 10.0, "#d2b48c"),
        )));
        drawn(&layer)
    };
    let stroke = r##"<path d="M15 45V25H35" fill="none" stroke="#d2b48c" stroke-width="7"/>"##;
    let rows = ["grrgg", "ghhgg", "ggggg", "ggggg", "ggggg"];
    assert_eq!(road(stroke), rows);
    // Walls that are drawn tile by tile, or in rows, are whole.
    let tiles = [10.0, 20.0].map(|x| rect(x, 20.0, 10.0, 10.0, "#d2b48c"));
    let rows = ["grrgg", "ghhgg", "ghhgg", "ggggg", "ggggg"];
    assert_eq!(road(&rect(10.0, 20.0, 20.0, 10.0, "#d2b48c")), rows);
    let wall = tiles
        .clone()
        .map(|tile| tile.replace("y=\"20\"", "y=\"10\""))
        .concat();
    assert_eq!(road(&(wall + &tiles.concat())), rows);
}

#[test]
fn layers_without_tiles_and_huge_grids_are_reported() {
    let codes = |svg: &str| -> Vec<String> {
        let (layers, told) = read_svg(svg);
        assert!(layers.is_empty());
        told.iter().map(|told| told[..4].to_owned()).collect()
    };
    assert_eq!(codes(&island("")), ["W313"]);
    assert_eq!(codes(&island(&rect(1.0, 1.0, 2.0, 2.0, GREEN))), ["W313"]);
    let tiny =
        r#"<g><rect width="300" height="300" fill="green"/><text y="300">A$Tiles 0.001</text></g>"#;
    let (layers, told) = read_svg(tiny);
    assert!(layers.is_empty());
    assert_eq!(
        told,
        [
            "E005: tiles of 0.001 make a grid of 300000 × 300000 = 90000000000 cells, more than the limit of 67108864"
        ]
    );
}

#[test]
fn rectangles_off_the_grid_are_reported() {
    let off = |x: f64, width: f64| {
        let tiles = rect(0.0, 0.0, 20.0, 10.0, GREEN) + &rect(x, 10.0, width, 10.0, GREEN);
        read_svg(&island(&tiles)).1
    };
    assert_eq!(off(0.9, 9.1), [""; 0]);
    assert_eq!(off(-0.9, 11.8), [""; 0]);
    assert_eq!(
        off(1.2, 9.0),
        ["W312: 1 of 2 rectangles in `Island` are off the grid"]
    );
    assert_eq!(
        off(0.0, 14.0),
        ["W312: 1 of 2 rectangles in `Island` are off the grid"]
    );
}

#[test]
fn several_layers_may_lie_in_each_other() {
    let (layers, told) = read_svg(
        r##"<g><rect width="30" height="10" fill="#4caf50"/><text y="300">Land$Tiles 10</text>
        <g><rect x="100" width="8" height="8" fill="#42a5f5"/><text y="310">Lake@Boat$Tiles 4 Bevel 0.2 Roof 0.5</text></g>
        <rect y="10" width="10" height="10" fill="#8d6e63"/></g>
        <rect x="200" y="200" width="10" height="40" fill="#123456"/><text x="205" y="220">Boat</text>"##,
    );
    assert_eq!(told, [""; 0]);
    let names: Vec<_> = layers
        .iter()
        .map(|layer| (layer.name.as_str(), drawn(layer)))
        .collect();
    let rows = |rows: &[&str]| rows.iter().map(|row| (*row).to_owned()).collect::<Vec<_>>();
    assert_eq!(
        names,
        [
            ("Land", rows(&["ggg", "b.."])),
            ("Lake", rows(&["ww", "ww"]))
        ]
    );
    assert_eq!((layers[1].bevel, layers[1].roof), (0.2, 0.5));
    assert!(layers[1].parent.is_some() && layers[0].parent.is_none());
}

#[test]
fn pictures_are_read_pixel_by_pixel() {
    let colors = [GREEN, "#42a5f5", "#e53935", "#8d6e63", "#f5deb3", GREEN].map(rgba);
    let at = |x: u32, y: u32| {
        if (x, y) == (1, 1) {
            [0; 4]
        } else {
            colors[(x + 3 * y) as usize]
        }
    };
    let small = png(3, 2, at);
    let large = png(48, 32, |x, y| at(x / 16, y / 16));
    // Shapes below show through what is clear, shapes above cover it.
    let below = rect(0.0, 0.0, 30.0, 20.0, "#8d6e63");
    let above = rect(0.0, 0.0, 10.0, 10.0, "#e53935");
    for map in [small, large] {
        let read = |attributes: &str, clip: &str| {
            let image =
                format!(r#"{clip}<image {attributes} href="map.png" preserveAspectRatio="none"/>"#);
            let svg = island(&(below.clone() + &image + &above));
            let files = MemoryResolver::default().with("map.png", map.clone());
            let (layers, told) = read_with(&svg, files);
            (drawn(&layers[0]), told)
        };
        let upright = read(r#"width="30" height="20""#, "");
        assert_eq!(upright, (vec!["rwr".to_owned(), "bbg".to_owned()], vec![]));
        let turned = read(
            r#"width="30" height="20" transform="rotate(180 15 10)""#,
            "",
        );
        assert_eq!(turned, (vec!["rbb".to_owned(), "rwg".to_owned()], vec![]));
        let quarter = read(
            r#"width="30" height="20" transform="translate(20 0) rotate(90)""#,
            "",
        );
        assert_eq!(quarter.0, ["rgb", "bwb", "gr."]);
        let shifted = read(r#"x="0.4" y="-0.4" width="30" height="20""#, "");
        assert_eq!(shifted, upright);
        let clip = r#"<clipPath id="c"><rect x="10" width="10" height="20"/></clipPath>"#;
        let clipped = read(r#"width="30" height="20" clip-path="url(#c)""#, clip);
        assert_eq!(clipped, (vec!["rwb".to_owned(), "bbb".to_owned()], vec![]));
    }
}

#[test]
fn pictures_that_are_drawings_are_read_too() {
    let inner = r##"<svg xmlns="http://www.w3.org/2000/svg" width="2" height="1"><rect width="1" height="1" fill="#4caf50"/><rect x="1" width="1" height="1" fill="#42a5f5"/></svg>"##;
    let files = MemoryResolver::default().with("map.svg", inner.as_bytes());
    let (layers, told) = read_with(
        &island(r#"<image width="20" height="10" href="map.svg"/>"#),
        files,
    );
    assert_eq!(told, [""; 0]);
    assert_eq!(drawn(&layers[0]), ["gw"]);
}

#[test]
fn pictures_of_many_colors_have_a_material_for_each_kind() {
    let near = |base: &str, x: u32| {
        let [r, g, b, _] = rgba(base);
        [
            r - (x % 8) as u8,
            g - (x / 8 % 8) as u8,
            b - (x / 64) as u8,
            255,
        ]
    };
    let map = png(256, 2, |x, y| near(COLORS[y as usize], x));
    let files = MemoryResolver::default().with("map.png", map);
    let swatch = r##"<rect y="100" width="10" height="10" fill="#4caf50"/><text y="100" x="9" font-size="5">$Tile blue</text>"##;
    let image = r#"<image width="2560" height="20" href="map.png"/>"#;
    let (layers, told) = read_with(&island(&(image.to_owned() + swatch)), files);
    assert_eq!(told, [""; 0]);
    let layer = &layers[0];
    let rows = drawn(layer);
    assert_eq!(rows[0], format!("w{}", "g".repeat(255)));
    assert_eq!(rows[1], "b".repeat(256));
    let tiles: Vec<Tile> = layer
        .materials
        .iter()
        .map(|material| material.tile)
        .collect();
    assert_eq!(tiles, [Tile::None, Tile::Green, Tile::Brown, Tile::Blue]);
    let red = layer.materials[2].factors.color[0] * 255.0;
    assert!((red - (141.0 - 3.5)).abs() < 0.01, "{red}");
}

/// The edges as one list: columns, rows and whether right or below.
fn edges(layer: &Layer) -> Vec<(usize, usize, char)> {
    let mut found = Vec::new();
    for (cell, edge) in layer.map.edges.iter().enumerate() {
        let (column, row) = (cell % layer.map.columns, cell / layer.map.columns);
        for (bit, letter) in [(EDGE_RIGHT, 'r'), (EDGE_BELOW, 'b')] {
            if edge & bit != 0 {
                found.push((column, row, letter));
            }
        }
    }
    found
}

#[test]
fn strokes_along_grid_lines_are_edges() {
    let with = |strokes: &str| {
        let ground = rect(0.0, 0.0, 40.0, 30.0, GREEN);
        let style = r#"<g fill="none" stroke="black">"#;
        edges(&only(&island(&format!("{ground}{style}{strokes}</g>"))))
    };
    let line = |d: &str| with(&format!(r#"<path d="{d}"/>"#));
    assert_eq!(line("M10 0V20"), [(0, 0, 'r'), (0, 1, 'r')]);
    assert_eq!(
        line("M40 10H0"),
        [(0, 0, 'b'), (1, 0, 'b'), (2, 0, 'b'), (3, 0, 'b')]
    );
    // A quarter of a tile off, drawn by hand, slanted.
    assert_eq!(line("M12.4 0V10"), [(0, 0, 'r')]);
    assert_eq!(line("M9.5 0L10.3 4 9.3 10"), [(0, 0, 'r')]);
    assert_eq!(
        line("M10 5C10.4 5 9.6 15 10 15"),
        [(0, 0, 'r'), (0, 1, 'r')]
    );
    // At least half of a side.
    assert_eq!(line("M10 5V10"), [(0, 0, 'r')]);
    assert_eq!(line("M10 6V10"), []);
    assert_eq!(line("M10 0V3M10 7V10"), [(0, 0, 'r')]);
    // A stroke that is drawn twice counts once.
    assert_eq!(line("M10 0V4M10 1V4M10 4V0"), []);
    let border = [(1, 0, 'b'), (0, 1, 'r'), (1, 1, 'r'), (1, 1, 'b')];
    assert_eq!(
        with(r#"<rect x="10" y="10" width="10" height="10"/>"#),
        border
    );
    assert_eq!(
        with(r#"<rect x="10" y="10" width="10" height="10" stroke-dasharray="1 3"/>"#),
        border
    );
    assert_eq!(
        with(r#"<path transform="translate(20 10) rotate(90)" d="M0 0H10V10H0Z"/>"#),
        border
    );
}

#[test]
fn strokes_that_are_no_edges_are_reported() {
    let told = |stroke: &str| {
        let ground = rect(0.0, 0.0, 60.0, 50.0, GREEN) + &rect(0.0, 30.0, 60.0, 20.0, COLORS[1]);
        let stroke = format!(r#"<path fill="none" stroke="black" d="{stroke}"/>"#);
        read_svg(&island(&(ground + &stroke))).1
    };
    let told_at = |cell: &str| {
        [format!(
            "W312: `Island`: a stroke is no edge: it runs across tiles, more than a quarter of a tile from the lines between them: {cell}"
        )]
    };
    assert_eq!(told("M15 0V25"), told_at("column 2, row 1"));
    assert_eq!(told("M10 0L50 20"), told_at("column 2, row 1"));
    // Along the border of two kinds, less than half a tile, on the line for most of its way, and outside.
    for harmless in [
        "M0 27L60 33",
        "M15 10v4",
        "M20 0V20H24",
        "M-40 -40L-10 90",
        "M61 0V900",
    ] {
        assert_eq!(told(harmless), [""; 0], "{harmless}");
    }
}

#[test]
fn thick_strokes_in_the_color_of_a_tile_are_paint() {
    let ground = rect(0.0, 0.0, 50.0, 40.0, GREEN);
    let road = r##"<path d="M5 5H35V35" fill="none" stroke="#42a5f5" stroke-width="7"/>"##;
    let layer = only(&island(&(ground.clone() + road)));
    assert_eq!(drawn(&layer), ["wwwwg", "gggwg", "gggwg", "gggwg"]);
    assert_eq!(edges(&layer), []);
    // One that is thinner, or has no tile's colour, is an edge or nothing.
    for (width, color) in [("4", "#42a5f5"), ("7", "black")] {
        let road = format!(
            r##"<path d="M10 0V40" fill="none" stroke="{color}" stroke-width="{width}"/>"##
        );
        let layer = only(&island(&(ground.clone() + &road)));
        assert_eq!(edges(&layer).len(), 4, "{width} {color}");
    }
}

#[test]
fn pictures_are_read_by_the_majority_of_each_tile() {
    // Two tiles of 8 pixels with borders that are half one and half the other, and dots in the middles.
    let map = png(16, 8, |x, y| {
        let [one, other] = [rgba(COLORS[0]), rgba(COLORS[1])];
        let mixed = [0, 1, 2, 3].map(|i| one[i] / 2 + other[i] / 2);
        match x {
            4 | 12 if y == 4 => rgba("#e53935"),
            6..=9 => mixed,
            0..6 => one,
            _ => other,
        }
    });
    let files = MemoryResolver::default().with("map.png", map);
    let (layers, told) = read_with(
        &island(r#"<image width="20" height="10" href="map.png"/>"#),
        files,
    );
    assert_eq!(told, [""; 0]);
    assert_eq!(drawn(&layers[0]), ["gb"]);
}

#[test]
fn shapes_without_a_tile_are_reported() {
    let ground = rect(0.0, 0.0, 40.0, 30.0, GREEN);
    let flower = r##"<circle cx="10" cy="10" r="3" fill="#e53935"/>"##;
    let (_, told) = read_svg(&island(&(ground + flower)));
    assert_eq!(
        told,
        ["W312: a shape in `Island` covers the centre of no tile, so it is not in the map"]
    );
}

#[test]
fn borders_of_filled_shapes_and_strokes_over_pictures_are_edges() {
    let tiles = rect(0.0, 0.0, 30.0, 30.0, GREEN)
        + r##"<rect x="10" y="10" width="10" height="10" fill="#8d6e63" stroke="black"/>"##;
    let around = [(1, 0, 'b'), (0, 1, 'r'), (1, 1, 'r'), (1, 1, 'b')];
    assert_eq!(edges(&only(&island(&tiles))), around);
    let files = MemoryResolver::default().with("map.png", png(3, 3, |_, _| rgba(GREEN)));
    let svg = r#"<image width="30" height="30" href="map.png"/><rect x="10" y="10" width="10" height="10" fill="none" stroke="black"/>"#;
    let (layers, told) = read_with(&island(svg), files);
    assert_eq!(told, [""; 0]);
    assert_eq!(edges(&layers[0]), around);
}

#[test]
fn a_string_outside_takes_no_tile() {
    let (layers, told) = read_svg(&format!(
        r##"{}<text x="15" y="6" font-size="5">Boat</text><rect x="300" y="10" width="10" height="40" fill="#123456"/>"##,
        island(&rect(0.0, 0.0, 40.0, 10.0, GREEN))
    ));
    assert_eq!(told, [""; 0]);
    assert_eq!(drawn(&layers[0]), ["gggg"]);
}

#[test]
fn what_is_left_out_is_no_tile() {
    let files = MemoryResolver::default().with("map.png", png(2, 1, |_, _| rgba(GREEN)));
    let svg = r##"<rect width="10" height="10" fill="#42a5f5"/><image width="20" height="10" href="map.png"><desc>*</desc></image>"##;
    let (layers, told) = read_with(&island(svg), files);
    assert_eq!(told, [""; 0]);
    assert_eq!(drawn(&layers[0]), ["w"]);
}

#[test]
fn wild_sizes_do_no_harm() {
    for size in ["1e-300", "1e300", "1e9", "0.5"] {
        for shape in [
            r#"<rect width="1e9" height="1" fill="green"/>"#,
            r#"<rect x="-1e30" width="1e30" height="1e30" fill="green"/>"#,
            r#"<path d="M0 0C1e9 0 1e9 1e9 0 1e9" fill="green" stroke="red"/>"#,
            r#"<path d="M0 0C1e9 0 1e9 1e9 0 1e9" fill="none" stroke="red"/><rect width="9" height="9" fill="green"/>"#,
        ] {
            read_svg(&format!("<g>{shape}<text>A$Tiles {size}</text></g>"));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Squares, rows of rectangles and a picture give the same map.
    #[test]
    fn all_ways_to_draw_a_map_are_one(
        columns in 1..7_usize,
        cells in prop::collection::vec(0..6_usize, 1..40),
        (dx, dy) in (-0.9..0.9, -0.9..0.9_f64),
    ) {
        let rows = cells.len().div_ceil(columns);
        let color = |column: usize, row: usize| {
            let cell = cells.get(row * columns + column).copied().unwrap_or(0);
            // The corners are there, so that all grids are as large.
            let corner = (column == 0 || column + 1 == columns) && (row == 0 || row + 1 == rows);
            COLORS.get(if corner { 0 } else { cell })
        };
        let mut squares = String::new();
        let mut runs = String::new();
        for row in 0..rows {
            let mut from = 0;
            for column in 0..columns {
                let (x, y) = (10.0 * column as f64 + dx, 10.0 * row as f64 + dy);
                if let Some(color) = color(column, row) {
                    squares += &rect(x, y, 10.0, 10.0, color);
                }
                if column + 1 == columns || color(column, row) != color(column + 1, row) {
                    if let Some(color) = color(column, row) {
                        // Not recognised as a rectangle.
                        let (left, right) = (10.0 * from as f64, 10.0 * column as f64 + 10.0);
                        let (top, bottom) = (10.0 * row as f64, 10.0 * row as f64 + 10.0);
                        runs += &format!(
                            r#"<path fill="{color}" d="M{left} {top}L{} {} {right} {top}V{bottom}H{left}Z"/>"#,
                            (left + right) / 2.0,
                            top - 0.5,
                        );
                    }
                    from = column + 1;
                }
            }
        }
        let map = png(columns as u32, rows as u32, |x, y| {
            color(x as usize, y as usize).map_or([0; 4], |color| rgba(color))
        });
        let (width, height) = (10 * columns, 10 * rows);
        let image = format!(r#"<image x="{dx}" y="{dy}" width="{width}" height="{height}" href="map.png"/>"#);
        let files = || MemoryResolver::default().with("map.png", map.clone());
        let [a, b, c] = [squares, runs, image].map(|tiles| {
            let (mut layers, told) = read_with(&island(&tiles), files());
            assert_eq!(told, [""; 0]);
            layers.remove(0)
        });
        prop_assert_eq!(&a.map, &b.map);
        prop_assert_eq!(&a.map, &c.map);
        prop_assert_eq!(&a.materials, &c.materials);
    }

    /// Compares edges with those of a simple method: sides of which strokes cover half.
    #[test]
    fn edges_are_as_by_the_plain_method(
        lines in prop::collection::vec((0..5_i32, -4.0..4.0_f64, 0.0..40.0_f64, -20.0..20.0_f64), 1..8),
    ) {
        let mut strokes = String::new();
        for (line, off, from, length) in &lines {
            let x = f64::from(*line) * 10.0 + off;
            strokes += &format!(r#"<path fill="none" stroke="red" d="M{x} {from}v{length}"/>"#);
        }
        let (layers, told) = read_svg(&island(&(rect(0.0, 0.0, 40.0, 40.0, GREEN) + &strokes)));
        let layer = &layers[0];
        prop_assert!(told.iter().all(|told| told.starts_with("W312: `Island`: ")), "{told:?}");
        for column in 0..3 {
            for row in 0..4 {
                let places = (0..1600).map(|k| f64::from(row) * 10.0 + (f64::from(k) + 0.5) / 160.0);
                let covered = places.filter(|y| {
                    lines.iter().any(|(line, off, from, length)| {
                        let (low, high) = (from.min(from + length), from.max(from + length));
                        *line == column + 1 && off.abs() <= 2.5 && low <= *y && *y <= high
                    })
                });
                let share = covered.count() as f64 / 1600.0;
                let cell = layer.map.index(column as usize, row as usize);
                let edge = layer.map.edges[cell] & EDGE_RIGHT != 0;
                // Sides are tested in sixteenths, at each end of each stroke.
                let slack = lines.len() as f64 / 16.0;
                prop_assert!(!edge || share > 0.5 - slack, "{share}");
                prop_assert!(edge || share < 0.5 + slack, "{share}");
            }
        }
    }
}
