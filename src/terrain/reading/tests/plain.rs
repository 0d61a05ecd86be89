//! Maps from straight above: drawn, and of Tiled.

use super::super::*;
use super::{COLORS, GREEN, island, only, png, read_with, rect, rgba};
use crate::resolver::MemoryResolver;
use crate::terrain::UNSET;

#[test]
fn heights_are_from_legends_groups_and_the_layer_in_this_order() {
    let layer = |own: &str, tiles: &str| {
        let string = format!(r#"<text x="0" y="390">Island$Tiles 10 {own}</text>"#);
        only(&format!(r#"<g id="map">{tiles}{string}</g>"#))
    };
    let heights = |layer: &Layer| -> Vec<Option<i32>> {
        let cells = 0..layer.map.columns;
        cells.map(|column| layer.landscape.top(column, 0)).collect()
    };
    let legend = r##"<rect y="200" width="10" height="10" fill="#e53935"/><text y="200" x="9" font-size="5">$Tile red Height 5</text>"##;
    // The innermost group counts, for shapes of every kind; what covers it is not of the group.
    let group = rect(0.0, 0.0, 60.0, 10.0, GREEN)
        + r#"<g><text x="20" y="300">Hill$Height 2</text>"#
        + &rect(10.0, 0.0, 40.0, 10.0, GREEN)
        + r##"<path d="M20 0L30 0 30 10 20 10.1Z" fill="#e53935"/>"##
        + r#"<g><text x="20" y="310">Peak$Height 4</text>"#
        + &rect(30.0, 0.0, 20.0, 10.0, GREEN)
        + "</g></g>"
        + &rect(40.0, 0.0, 10.0, 10.0, "#8d6e63");
    let found = layer("", &(group.clone() + legend));
    let expected = [0, 2, 5, 4, 0, 0].map(Some);
    assert_eq!(heights(&found), expected);
    let found = layer("Height 1", &(group + legend));
    assert_eq!(heights(&found), [1, 2, 5, 4, 1, 1].map(Some));
    // Water in a group lies below it.
    let lake = rect(0.0, 0.0, 30.0, 10.0, GREEN)
        + r#"<g><text x="20" y="300">Hill$Height 3</text>"#
        + &rect(10.0, 0.0, 20.0, 10.0, GREEN)
        + &rect(20.0, 0.0, 10.0, 10.0, COLORS[2])
        + "</g>";
    assert_eq!(heights(&layer("", &lake)), [0, 3, 2].map(Some));
}

#[test]
fn pictures_in_groups_have_their_height() {
    let files = MemoryResolver::default().with("map.png", png(2, 1, |_, _| rgba(GREEN)));
    let tiles = rect(0.0, 0.0, 40.0, 10.0, GREEN)
        + r#"<g><text x="20" y="300">Hill$Height 3</text><image x="10" width="20" height="10" href="map.png"/></g>"#;
    let (layers, told) = read_with(&island(&tiles), files);
    assert_eq!(told, [""; 0]);
    assert_eq!(layers[0].map.heights, [UNSET, 3, 3, UNSET]);
}

/// A pixel of a tile.
fn tile_pixel(tile: u32, x: u32, y: u32) -> [u8; 4] {
    [60 * tile as u8 + 10, 50 * x as u8, 50 * y as u8, 255]
}

#[test]
fn maps_of_tiled_show_their_tiles_on_their_tops() {
    const SIDE: u32 = 4;
    let sheet = png(4 * SIDE, SIDE, |x, y| tile_pixel(x / SIDE, x % SIDE, y));
    let numbers: Vec<u32> = vec![1, 1, 2, 1, 3, 2, 4, 4, 2, 1, 1, 3];
    let text: Vec<String> = numbers.iter().map(u32::to_string).collect();
    let map = format!(
        r#"<map orientation="orthogonal" width="4" height="3" tilewidth="{SIDE}" tileheight="{SIDE}"><tileset firstgid="1" name="a" tilewidth="{SIDE}" tileheight="{SIDE}" tilecount="4" columns="4"><image source="map.png"/><tile id="2"><properties><property name="height" value="2"/><property name="tile" value="beige"/></properties></tile></tileset><layer width="4" height="3"><data encoding="csv">{}</data></layer></map>"#,
        text.join(",")
    );
    for bevel in ["", "Bevel 0.3"] {
        let files = MemoryResolver::default()
            .with("map.png", sheet.clone())
            .with(
                "maps/map.tmx",
                map.replace("map.png", "../map.png").as_bytes(),
            );
        let frame = rect(30.0, 50.0, 9.0, 9.0, "none") + &rect(30.0, 50.0, 7.0, 3.0, "pink");
        let svg = format!(
            r#"<g>{frame}<text x="0" y="390">Island$Tiles "maps/map.tmx" {bevel}</text></g>"#
        );
        let (layers, told) = read_with(&svg, files);
        assert_eq!(told, [""; 0]);
        let layer = &layers[0];
        assert_eq!(
            layer.bounds().map(|at| at.to_array()),
            [[30.0, 50.0], [46.0, 62.0]]
        );
        let tops: Vec<_> = (0..3)
            .flat_map(|row| (0..4).map(move |column| (column, row)))
            .map(|(column, row)| layer.landscape.top(column, row))
            .collect();
        assert_eq!(tops, [0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 2].map(Some));
        let pictures = layer.map.pictures.as_ref().unwrap();
        let material = &layer.materials[usize::from(pictures.material)];
        let Some(TileTexture::Pictures(picture)) = &material.texture else {
            panic!("the tops have no pictures");
        };
        let atlas = image::load_from_memory(&picture.bytes)
            .unwrap()
            .into_rgba8();
        let mut seen = 0.0;
        for (of, pieces) in layer.landscape.surface(0.7, layer.bevel) {
            let pieces = pieces.iter().filter(|_| of == pictures.material);
            for piece in pieces {
                for triangle in &piece.triangles {
                    let mean = |of: &dyn Fn(usize) -> [f32; 2]| {
                        let sum = triangle.iter().fold([0.0; 2], |sum, corner| {
                            let [a, b] = of(*corner as usize);
                            [sum[0] + a, sum[1] + b]
                        });
                        sum.map(|sum| sum / 3.0)
                    };
                    let flat =
                        triangle.map(|corner| piece.normals[corner as usize] == [0.0, 1.0, 0.0]);
                    let [x, z] = mean(&|corner| {
                        let [x, _, z] = piece.positions[corner];
                        [x + 2.0, z + 1.5]
                    });
                    let [u, v] = mean(&|corner| piece.uvs[corner]);
                    let (width, height) = atlas.dimensions();
                    let found =
                        atlas.get_pixel((u * width as f32) as u32, (v * height as f32) as u32);
                    let tile = numbers[z as usize * 4 + x as usize] - 1;
                    // At the inner corners of a bevel, tops reach into their neighbours, and their pictures are stretched.
                    let is_inside = triangle.iter().all(|corner| {
                        let [a, _, c] = piece.positions[*corner as usize];
                        let [a, c] = [a + 2.0 - x.floor(), c + 1.5 - z.floor()];
                        (-0.001..1.001).contains(&a) && (-0.001..1.001).contains(&c)
                    });
                    // On bevels the pictures are stretched.
                    // Between two pixels it may be either.
                    let is_between = |at: f32| (at * SIDE as f32 + 0.01).fract() < 0.02;
                    let is_flat = is_inside && flat.iter().all(|flat| *flat);
                    if is_flat && !is_between(x) && !is_between(z) {
                        let [x, y] = [x, z].map(|at| (at.fract() * SIDE as f32) as u32);
                        assert_eq!(
                            found.0,
                            tile_pixel(tile, x, y),
                            "{bevel}: {x}, {y} of {tile}"
                        );
                        seen += 1.0;
                    }
                }
            }
        }
        assert!(seen >= 12.0, "{bevel}: {seen}");
    }
}
