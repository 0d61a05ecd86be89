//! From 45° above, in parallel projection and bent, every tile of a drawing is visible in its own
//! colour at its own position in the model that `render` reads. Plain maps show theirs from straight above.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt::Write as _;
use std::path::Path;

use okoshi::FolderResolver;
use okoshi::compile::{Compiled, Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::internals::terrain::{EDGE_BELOW, EDGE_RIGHT, Map, Tile};
use okoshi::render::{self, PosedModel, View, Window};
use okoshi::resolver::{MemoryResolver, Resolver};

use crate::worlds::World;

/// Side of a tile, drawing units.
const TILE: usize = 10;

/// A map as a drawing: a rectangle for neighbours of one kind in a row, a line for each edge.
fn drawn(map: &Map) -> String {
    let mut shapes = String::new();
    for (row, cells) in map.cells.chunks(map.columns).enumerate() {
        let mut column = 0;
        for run in cells.chunk_by(|one, other| one == other) {
            let [r, g, b] = map.tiles[usize::from(run[0])].color();
            if run[0] != 0 {
                let (x, y, width) = (column * TILE, row * TILE, run.len() * TILE);
                let _ = writeln!(
                    shapes,
                    "<rect x='{x}' y='{y}' width='{width}' height='{TILE}' fill='#{r:02x}{g:02x}{b:02x}'/>"
                );
            }
            column += run.len();
        }
    }
    let mut lines = String::new();
    for (cell, edges) in map.edges.iter().enumerate() {
        let [left, top] = [cell % map.columns, cell / map.columns].map(|at| at * TILE);
        let [right, bottom] = [left + TILE, top + TILE];
        if edges & EDGE_RIGHT != 0 {
            let _ = write!(lines, "M{right} {top}V{bottom}");
        }
        if edges & EDGE_BELOW != 0 {
            let _ = write!(lines, "M{left} {bottom}H{right}");
        }
    }
    let [width, height] = [map.columns, map.rows].map(|count| count * TILE);
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}'>
        <text x='0' y='-5' font-size='5'>%Ground 0 0</text><g><text x='0' y='-20' font-size='5'>Land$Tiles {TILE} Roof 0.5</text>
        {shapes}<path d='{lines}M0 0' fill='none' stroke='black'/></g></svg>"
    )
}

/// The cells of each landscape that are not visible in the material of their tile. What stands on it is left out.
fn hidden(compiled: &Compiled, resolver: &dyn Resolver) -> Vec<String> {
    let mut scene = compiled.scene.clone();
    let is_landscape = |name: &str| compiled.layers.iter().any(|layer| layer.name == name);
    for node in &mut scene.nodes {
        node.mesh = node.mesh.filter(|_| is_landscape(&node.name));
    }
    let written = to_memory(&GLB, &scene, None).expect("written");
    let model = render::read(&written.bytes, resolver).expect("a model");
    let posed = PosedModel::new(&model, &model.rest()).expect("something to see");
    let mut wrong = vec![];
    for layer in &compiled.layers {
        let node = compiled
            .scene
            .nodes
            .iter()
            .find(|node| node.name == layer.name);
        let place = node.expect("the layer's node").translation;
        let tile = layer.size * 0.01 * compiled.bindings.settings.scale;
        let [columns, rows] = [layer.map.columns, layer.map.rows];
        let is_plain = layer.landscape.is_plain();
        let (pitch, up, back) = match is_plain {
            true => (90.0, 0.0, 1.0),
            false => (45.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2),
        };
        let window = Window {
            left: place.x - columns as f64 / 2.0 * tile,
            top: place.y * up - place.z * back + rows as f64 / 2.0 * tile,
            width: columns as f64 * tile,
            height: rows as f64 * tile,
        };
        let options = render::Options::default()
            .with_view(View { yaw: 0.0, pitch })
            .with_size([columns as u32, rows as u32]);
        let seen = posed.visible_surfaces(&options, window).expect("seen");
        let mut material_of: BTreeMap<u8, BTreeMap<Option<usize>, usize>> = BTreeMap::new();
        for (look, seen) in layer.map.cells.iter().zip(&seen) {
            let material = seen.as_ref().and_then(|seen| seen.material);
            *material_of
                .entry(*look)
                .or_default()
                .entry(material)
                .or_default() += 1;
        }
        let most = |look: u8| {
            material_of[&look]
                .iter()
                .max_by_key(|(_, count)| **count)
                .and_then(|(material, _)| *material)
        };
        for cell in 0..layer.map.cells.len() {
            let look = layer.map.cells[cell];
            let material = seen[cell].as_ref().and_then(|seen| seen.material);
            if layer.map.tile(cell) != Tile::None && (material != most(look) || material.is_none())
            {
                wrong.push(format!(
                    "{}: column {}, row {}",
                    layer.name,
                    cell % columns + 1,
                    cell / columns + 1
                ));
            }
        }
        // The tops of a map of Tiled have one material, with pictures of all tiles.
        if is_plain && layer.materials.iter().any(|of| of.texture.is_some()) {
            continue;
        }
        let mut kinds: BTreeMap<Option<usize>, Tile> = BTreeMap::new();
        for look in material_of.keys().filter(|look| **look != 0) {
            let tile = layer.map.tiles[usize::from(*look)];
            let known = *kinds.entry(most(*look)).or_insert(tile);
            if known != tile {
                wrong.push(format!(
                    "{}: {} and {} look alike",
                    layer.name,
                    known.name(),
                    tile.name()
                ));
            }
        }
    }
    wrong
}

#[test]
fn a_thousand_maps_look_as_drawn() {
    let is_seen = |seed: u64| {
        let source = drawn(&World::random(seed).draw().map);
        let compiled = compile(&source, &Options::default(), &MemoryResolver::default());
        assert!(
            !compiled.has_errors(),
            "{:?}\n{source}",
            compiled.diagnostics
        );
        if !compiled.diagnostics.is_empty() {
            return false;
        }
        let wrong = hidden(&compiled, &MemoryResolver::default());
        assert!(wrong.is_empty(), "landscape {seed}: {wrong:?}\n{source}");
        true
    };
    // One after the other: threads that wait for the compiler would begin further maps, nested too deep for the stack.
    let tried: Vec<bool> = (0..1100).map(is_seen).collect();
    let count = tried.iter().filter(|seen| **seen).count();
    assert!(count >= 1000, "only {count} maps give no diagnostic");
}

#[test]
fn example_landscapes_look_as_drawn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut count = 0;
    for folder in [root.clone(), root.join("terrain")] {
        let files = std::fs::read_dir(&folder)
            .expect("the folder")
            .map(|file| file.expect("a file").path());
        for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "svg")) {
            let source = std::fs::read_to_string(&path).expect("the drawing");
            // With roofs of the drawn slope, and without bevels, which would be visible.
            let source = source.replace(" Roof 0.7071", "").replace(" Roof 0.5", "");
            let words: Vec<&str> = source.split("$Tiles ").collect();
            let (first, rest) = words.split_first().expect("some text");
            let mut changed = (*first).to_owned();
            for word in rest {
                if word.starts_with('"') {
                    changed += &format!("$Tiles {word}");
                    continue;
                }
                let number = word
                    .find(|letter: char| !letter.is_ascii_digit() && letter != '.')
                    .unwrap_or(word.len());
                let tail = word[number..].replacen(" Bevel", "# Bevel", 1);
                let tail = match tail.strip_prefix("# Bevel ") {
                    Some(tail) => tail
                        .trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == '.')
                        .to_owned(),
                    None => word[number..].to_owned(),
                };
                changed += &format!("$Tiles {} Roof 0.5{tail}", &word[..number]);
            }
            let resolver = FolderResolver::new(&folder);
            let compiled = compile(&changed, &Options::default(), &resolver);
            if compiled.layers.is_empty() {
                continue;
            }
            assert!(
                !compiled.has_errors(),
                "{}: {:?}",
                path.display(),
                compiled.diagnostics
            );
            let wrong = hidden(&compiled, &resolver);
            assert!(wrong.is_empty(), "{}: {wrong:?}", path.display());
            count += 1;
        }
    }
    assert!(count > 10, "only {count} examples have terrain");
}
