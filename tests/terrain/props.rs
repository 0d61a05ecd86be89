//! Props stand on landscapes where their feet are drawn, and look as they are drawn.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use okoshi::compile::{Compiled, Options, compile};
use okoshi::internals::look;
use okoshi::resolver::MemoryResolver;
use okoshi::scene::{NodeId, Scene};

/// Side of a tile, drawing units.
const TILE: f64 = 10.0;

/// A plateau, 3 high at its front, behind a meadow with a pond; and these shapes as props. The page ends with the map: below it the side of
/// the ground would be seen.
fn stage(props: &str, string: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 130'>
        <g><text y='155' font-size='5'>Land$Tiles 10 Roof 0.5</text>
        <rect width='200' height='40' y='20' fill='#4caf50'/><rect width='200' height='30' y='60' fill='#8d6e63'/>
        <rect width='200' height='40' y='90' fill='#4caf50'/><rect x='100' width='40' height='10' y='100' fill='#8d6e63'/>
        <rect x='100' width='40' height='10' y='110' fill='#42a5f5'/></g>
        <g><text x='120' y='155' font-size='5'>{string}</text>{props}</g></svg>"
    )
}

fn compiled(source: &str) -> Compiled {
    let compiled = compile(source, &Options::default(), &MemoryResolver::default());
    assert!(
        !compiled.has_errors(),
        "{:?}\n{source}",
        compiled.diagnostics
    );
    compiled
}

fn node(scene: &Scene, name: &str) -> NodeId {
    let found = scene.nodes.position(|node| node.name == name);
    found.unwrap_or_else(|| panic!("no node {name}"))
}

/// The place of a node in its landscape, tiles, from its back left corner at height 0.
fn place(scene: &Scene, name: &str) -> [f64; 3] {
    let land = &scene.nodes[node(scene, "Land")];
    let id = node(scene, name);
    assert!(
        land.children.contains(&id),
        "{name} is not in the landscape"
    );
    let at = scene.nodes[id].translation * 100.0 / TILE;
    [at.x + 10.0, at.y, at.z + 5.5]
}

#[test]
fn feet_are_on_the_ground_that_is_drawn_there() {
    let tree = |id: &str, x: f64, y: f64| {
        // 4 wide: a slab of 0.4, with its face where the foot is.
        format!(
            "<g id='{id}'><rect x='{}' y='{}' width='4' height='20' fill='#c62828'/></g>",
            x - 2.0,
            y - 20.0
        )
    };
    let trees = [
        ("high", 25.0, 45.0),
        ("edge", 45.0, 60.0),
        ("low", 65.0, 95.0),
        ("pond", 120.0, 115.0),
    ];
    let props: String = trees.iter().map(|(id, x, y)| tree(id, *x, *y)).collect();
    let scene = compiled(&stage(&props, "Trees$Stand")).scene;
    let heights = [3.0, 3.0, 0.0, -1.0];
    for ((name, x, y), height) in trees.into_iter().zip(heights) {
        let [at_x, at_y, at_z] = place(&scene, name);
        let row = (y - 20.0) / TILE;
        assert!((at_x - x / TILE).abs() < 1e-6, "{name}: x {at_x}");
        assert!((at_y - height).abs() < 1e-6, "{name}: height {at_y}");
        // Half of the slab is before its node, and a hundredth of a tile keeps it out of walls.
        assert!(
            (at_z + 0.02 - 0.01 - (row + height)).abs() < 1e-6,
            "{name}: depth {at_z}"
        );
    }
}

#[test]
fn what_looks_the_same_is_one_mesh() {
    let tree = "<rect x='18' y='30' width='4' height='12' fill='#6b4a2f'/><circle cx='20' cy='26' r='8' fill='#2f7d3b'/>";
    let mut props = format!("<g id='oak'>{tree}</g>");
    for index in 0..20 {
        let (x, y) = (5 + index * 7, (index % 3) * 5);
        let _ = match index % 2 {
            0 => write!(props, "<use href='#oak' x='{x}' y='{y}'/>"),
            _ => write!(props, "<g transform='translate({x} {y})'>{tree}</g>"),
        };
    }
    // Another colour, another size, another form.
    let _ = write!(
        props,
        "<g>{}</g><g transform='scale(.9)'>{tree}</g><g>{tree}<text x='20' y='26' font-size='2'>Ball$Shape round</text></g>",
        tree.replace("#2f7d3b", "#a0522d")
    );
    let scene = compiled(&stage(&props, "Trees$Stand")).scene;
    let land = &scene.nodes[node(&scene, "Land")];
    let mut uses: BTreeMap<_, usize> = BTreeMap::new();
    for child in &land.children {
        *uses.entry(scene.nodes[*child].mesh).or_default() += 1;
    }
    let mut counts: Vec<usize> = uses.into_values().collect();
    counts.sort_unstable();
    assert_eq!(counts, [1, 1, 1, 21]);
}

/// Random props, each a trunk with a crown and a detail on it, sorted so that the nearer ones are drawn later.
fn forest(seed: u64) -> String {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut random = move |most: f64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 * most
    };
    let mut trees: Vec<[f64; 4]> = (0..12)
        .map(|index| {
            let size = 6.0 + random(8.0);
            let low = if index % 2 == 0 {
                26.0 + random(33.0)
            } else {
                96.0 + random(3.0)
            };
            [10.0 + random(180.0), low, size, random(1.0)]
        })
        .collect();
    trees.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let mut out = String::new();
    for [x, y, size, shade] in trees {
        let (half, green) = (size / 2.0, 90 + (shade * 120.0) as u32);
        let _ = write!(
            out,
            "<g><rect x='{}' y='{}' width='{}' height='{size}' fill='#5d4037'/><ellipse cx='{x}' cy='{}' rx='{half}' ry='{size}' fill='rgb(20,{green},60)'/>
            <circle cx='{}' cy='{}' r='{}' fill='#ffd54f'/></g>",
            x - size / 8.0,
            y - size,
            size / 4.0,
            y - 1.6 * size,
            x - half / 3.0,
            y - 1.8 * size,
            size / 6.0,
        );
    }
    out
}

#[test]
fn from_the_view_of_the_map_props_look_as_drawn() {
    let (mut counted, mut worst) = (0, 1.0_f64);
    for seed in 1..=6 {
        let source = stage(&forest(seed), "Trees$Stand");
        let compiled = compiled(&source);
        let look =
            look::compare(&compiled, &source, &MemoryResolver::default(), 500).expect("a picture");
        assert!(look.right >= 0.98, "forest {seed}: {}", look.right);
        let (mut pixels, mut right) = (0, 0);
        for part in &look.parts {
            (pixels, right) = (pixels + part.pixels, right + part.right);
        }
        let share = right as f64 / pixels as f64;
        assert!(share >= 0.95, "forest {seed}: {share} of the props");
        counted += look.parts.len();
        worst = worst.min(share);
    }
    assert!(
        counted >= 150,
        "only {counted} parts of props have pixels that count"
    );
    println!("at least {worst:.3} of the pixels of props are right");
}
