//! Maps that are not what they say, and such as would take all memory.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use super::super::*;
use super::{Packing, sheet};
use crate::resolver::MemoryResolver;

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

/// How long a map may take: this only ends a test that would not end, also on a slow machine that does much else.
const PATIENCE: Duration = Duration::from_secs(300);

/// Reads a map.
fn tried(text: &str) -> Result<TiledMap, TiledError> {
    let files = MemoryResolver::default()
        .with("m.tmx", text.as_bytes())
        .with("a.png", sheet());
    let started = Instant::now();
    let read = read("m.tmx", &files);
    assert!(started.elapsed() < PATIENCE, "it takes too long");
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
        "a cell or an object has the tile 13, which is in none of its tile sets",
    );
    refused(&one("536870911"), "which is in none");
    refused(&one("-1"), "not a number");
    // Only the bits that turn it.
    refused(&one("3758096384"), "a cell or an object has the tile 0,");
    let no_set = r#"<map width="1" height="1" tilewidth="4" tileheight="4"><layer width="1" height="1"><data encoding="csv">1</data></layer></map>"#;
    refused(no_set, "which is in none of its tile sets");
    let no_picture = one("1").replace(r#"<image source="a.png"/>"#, "");
    refused(&no_picture, "which is in none of its tile sets");
    for (usual, odd) in [
        (r#"spacing="1""#, r#"spacing="-9""#),
        (r#"margin="2""#, r#"margin="-3""#),
        (r#"margin="2""#, r#"margin="9223372036854775807""#),
        (r#"columns="4""#, r#"columns="-1""#),
    ] {
        let text = one("12");
        assert!(text.contains(usual));
        let text = text.replace(usual, odd);
        // Whatever it means, it does no harm.
        let _ = tried(&text);
    }
}

#[test]
fn xml_and_json_that_grow_are_refused() {
    let bomb =
        r#"<!DOCTYPE map [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><map>&b;</map>"#;
    refused(bomb, "it has entities of its own");
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
fn many_links_to_one_file_are_refused() {
    let set = format!("<tileset{}/>", " ".repeat(1 << 20));
    let links = r#"<tileset firstgid="1" source="a.tsx"/>"#.repeat(100);
    let map = format!(r#"<map width="1" height="1" tilewidth="4" tileheight="4">{links}</map>"#);
    let set = set.replace("<tileset", r#"<tileset tilewidth="4" tileheight="4""#);
    let files = MemoryResolver::default()
        .with("m.tmx", map.as_bytes())
        .with("a.tsx", set.as_bytes());
    let error = read("m.tmx", &files).unwrap_err().to_string();
    assert!(
        error.contains("is larger than the limit of 64 MiB"),
        "{error}"
    );
}

#[test]
fn what_means_nothing_is_told_once_even_if_it_is_written_in_many_ways() {
    let layers: String = (0..1000).fold(String::new(), |mut text, at| {
        let _ = write!(
            text,
            r#"<layer width="1" height="1"><properties><property name="height" value="0.{at}1"/></properties></layer>"#
        );
        text
    });
    let read = tried(&map(r#"width="1" height="1""#, &layers)).unwrap();
    assert_eq!(
        read.idle,
        [Idle::Height("0.01".to_owned())].into_iter().collect()
    );
}

#[test]
fn maps_with_a_document_type_are_read() {
    let old =
        r#"<?xml version="1.0"?><!DOCTYPE map SYSTEM "http://mapeditor.org/dtd/1.0/map.dtd">"#;
    let text = layer(1, 1, r#"<data encoding="csv">1</data>"#);
    assert!(tried(&(old.to_owned() + &text)).is_ok());
}

#[test]
fn tiles_may_be_parts_of_their_own_pictures() {
    let map = |area: &str| {
        format!(
            r#"<map width="1" height="1" tilewidth="4" tileheight="4"><tileset firstgid="1" tilewidth="9" tileheight="9"><tile id="0" {area}><image source="a.png"/></tile></tileset><layer width="1" height="1"><data encoding="csv">1</data></layer></map>"#
        )
    };
    // The second tile of the sheet.
    let read = tried(&map(r#"x="7" y="2" width="4" height="4""#)).unwrap();
    let color = read.pictured[0].color;
    assert_eq!(color, [20, 90, 90]);
    let wrong = "its tile 0 lies outside of the picture";
    refused(&map(r#"x="70" y="2" width="4" height="4""#), wrong);
    refused(&map(r#"x="-1" y="2" width="4" height="4""#), wrong);
    refused(&map(r#"x="1" y="2" width="0" height="4""#), wrong);
    // Without an area it is the whole picture, which is larger than a cell.
    let read = tried(&map("")).unwrap();
    assert_eq!(read.idle, [Idle::OtherSize].into_iter().collect());
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

/// A map of one cell with these objects, in XML.
fn with_objects(objects: &str) -> String {
    let ground = r#"<layer width="1" height="1"><data encoding="csv">1</data></layer>"#;
    map(
        r#"width="1" height="1""#,
        &format!("{ground}<objectgroup>{objects}</objectgroup>"),
    )
}

#[test]
fn objects_with_tiles_stand_on_the_middle_of_their_lower_edge() {
    let objects = r#"<object id="1" name="Oak" gid="2" x="3" y="9" width="8" height="6"/><object id="2" gid="2" x="0" y="4"/>
<object id="3" gid="5" x="1" y="1" rotation="30"/><object id="4" x="1" y="1"/><object id="5" gid="2" x="1" y="1" visible="0"/>"#;
    let set = json!({"firstgid": 1, "name": "a", "tilewidth": 4, "tileheight": 4, "spacing": 1, "margin": 2, "tilecount": 12, "columns": 4, "image": "a.png"});
    let entries = json!([
        {"name": "Oak", "gid": 2, "x": 3, "y": 9, "width": 8, "height": 6}, {"gid": 2, "x": 0, "y": 4},
        {"gid": 5, "x": 1, "y": 1, "rotation": 30}, {"x": 1, "y": 1}, {"gid": 2, "x": 1, "y": 1, "visible": false}]);
    let in_json = json!({"orientation": "orthogonal", "width": 1, "height": 1, "tilewidth": 4, "tileheight": 4, "tilesets": [set],
        "layers": [{"type": "tilelayer", "width": 1, "height": 1, "data": [1]}, {"type": "objectgroup", "objects": entries}]});
    for text in [with_objects(objects), in_json.to_string()] {
        let read = tried(&text).unwrap();
        let told = [Idle::Objects, Idle::Turned];
        assert_eq!(read.idle, told.into_iter().collect());
        let found: Vec<_> = read
            .objects
            .iter()
            .map(|one| (one.name.as_str(), one.foot.to_array(), one.size.to_array()))
            .collect();
        // Without a size, that of the tile.
        let expected = [
            ("Oak", [7.0, 9.0], [8.0, 6.0]),
            ("", [2.0, 4.0], [4.0, 4.0]),
            ("", [3.0, 1.0], [4.0, 4.0]),
        ];
        assert_eq!(found, expected);
        let pictures: Vec<usize> = read.objects.iter().map(|one| one.picture).collect();
        assert_eq!(pictures, [0, 0, 1]);
        for picture in &read.object_pictures {
            assert_eq!(crate::geometry::area(&picture.outline), 1.0);
        }
    }
}

#[test]
fn hostile_objects_are_refused_or_left_out() {
    refused(
        &with_objects(r#"<object id="1" gid="99" x="0" y="0"/>"#),
        "has the tile 99, which is in none of its tile sets",
    );
    refused(
        &with_objects(r#"<object id="1" gid="2" x="left" y="0"/>"#),
        "`x` is `left`, not a number",
    );
    let many = r#"<object gid="2" x="0" y="0"/>"#.repeat((1 << 14) + 1);
    refused(&with_objects(&many), "more than 16384 objects");
    let far = r#"<object gid="2" x="1e300" y="0"/><object gid="2" x="NaN" y="0"/><object gid="2" x="0" y="0" width="1e300"/>"#;
    let read = tried(&with_objects(far)).unwrap();
    assert!(read.objects.is_empty());
    assert!(read.idle.contains(&Idle::Unseen));
}
