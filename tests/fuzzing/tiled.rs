//! Every file in place of a map of Tiled is built as a landscape, or refused with a diagnostic.

use okoshi::resolver::MemoryResolver;

use super::{drawing, files};

/// The longest map that the search begins with, in bytes.
const LONGEST: usize = 16 << 10;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300">
<g><text x="10" y="20">Land$Tiles "map.tmx" Bevel 0.2</text></g></svg>"##;

pub(super) fn check(bytes: &[u8]) -> bool {
    let folder = "examples/terrain/";
    let resolver = MemoryResolver::default()
        .with("map.tmx", bytes)
        .with(
            "harbour.tsx",
            files::read(folder.to_owned() + "harbour.tsx"),
        )
        .with(
            "harbour.png",
            files::read(folder.to_owned() + "harbour.png"),
        );
    let compiled = drawing::check_compiled(DRAWING, &resolver);
    let is_built = !compiled.layers.is_empty();
    assert!(
        is_built || !compiled.diagnostics.is_empty(),
        "nothing is told"
    );
    is_built
}

/// The map of the example, small ones in other styles, and those of the cases.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let tiny = |data: &str| {
        format!(
            r#"<map orientation="orthogonal" width="3" height="2" tilewidth="16" tileheight="16" infinite="0"><properties><property name="height" type="int" value="1"/></properties><tileset firstgid="1" name="a" tilewidth="16" tileheight="16" tilecount="14" columns="7"><image source="harbour.png" width="112" height="32"/><tile id="4" type="water"><properties><property name="height" type="int" value="0"/></properties></tile></tileset><layer id="1" width="3" height="2">{data}</layer></map>"#
        )
    };
    let json = r#"{"orientation":"orthogonal","width":3,"height":2,"tilewidth":16,"tileheight":16,"infinite":true,"layers":[{"type":"tilelayer","chunks":[{"x":-1,"y":0,"width":2,"height":2,"data":[1,2,5,5]}]},{"type":"group","layers":[{"type":"objectgroup","objects":[{}]}]}],"tilesets":[{"firstgid":1,"source":"harbour.tsx"}]}"#;
    let mut seeds = vec![
        files::read("examples/terrain/harbour.tmx"),
        json.into(),
        tiny(r#"<data encoding="csv">1,2,3,4,5,6</data>"#).into(),
        tiny(r#"<data encoding="base64">AQAAAAIAAAADAAAABAAAAAUAAIAGAABA</data>"#).into(),
        tiny(r#"<data><tile gid="1"/><tile/><tile gid="5"/><tile gid="5"/><tile/><tile/></data>"#)
            .into(),
    ];
    let folders = files::case_folders().into_iter();
    let maps = folders.flat_map(|folder| files::ending(&folder.to_string_lossy(), ".tmx"));
    seeds.extend(maps.map(files::read).filter(|file| file.len() <= LONGEST));
    seeds
}
