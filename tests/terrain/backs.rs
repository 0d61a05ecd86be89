//! Rule 10: what a drawing hides is land.

use std::ops::Range;

use okoshi::internals::terrain::{Landscape, Map};

use crate::letters::map;
use crate::surfaces::{looked_at, triangles};
use crate::worlds::{World, picture, scribble};

/// What became of the cells that drawings hide.
#[derive(Debug, Default)]
struct Hidden {
    /// Ground that the drawing hides.
    ground: usize,
    /// Of that, without anything in the model.
    missing: usize,
    /// Of that, at the exact height.
    exact: usize,
    /// Cells where there is nothing.
    nothing: usize,
    /// Of these, with something in the model.
    wrong: usize,
}

/// Compares the hidden cells of the maps without ambiguities with the truth.
fn hidden(seeds: Range<u64>) -> Hidden {
    let mut found = Hidden::default();
    for seed in seeds {
        let world = World::random(seed);
        let map = world.draw().map;
        let land = Landscape::new(&map);
        if !land.ambiguities().is_empty() {
            continue;
        }
        let columns: Vec<Vec<[[i32; 2]; 2]>> =
            (0..map.columns).map(|column| land.blocks(column)).collect();
        for ([x, z], height) in world.hidden() {
            let blocks = columns[x as usize].iter();
            let here = blocks.filter(|[depth, _]| depth[0] <= z && z < depth[1]);
            let top = here.map(|[_, y]| y[1]).max();
            match height {
                None => {
                    found.nothing += 1;
                    found.wrong += usize::from(top.is_some());
                }
                Some(height) => {
                    found.ground += 1;
                    found.missing += usize::from(top.is_none());
                    found.exact += usize::from(top == Some(height));
                }
            }
        }
    }
    found
}

#[test]
fn hidden_ground_is_mostly_there() {
    // The first half was looked at while the rule was written, the second was not.
    for seeds in [0..1000, 70_000..71_000] {
        let found = hidden(seeds.clone());
        println!("seeds {seeds:?}: {found:?}");
        assert!(found.missing * 100 < found.ground * 12, "{found:?}");
        assert!(found.exact * 100 > found.ground * 75, "{found:?}");
        assert!(found.wrong * 100 < found.nothing * 8, "{found:?}");
    }
}

/// Fails where the map looks otherwise with its hidden ground than without.
fn assert_unchanged(map: &Map, roof: f64, name: &str) {
    let [with, without] = [Landscape::new(map), Landscape::new(map).without_backs()];
    let shown = |land: &Landscape, spot| looked_at(map, &triangles(map, land, roof, 0.0), spot);
    for spot in [[0.47, 0.56], [0.03, 0.05], [0.96, 0.94], [0.52, 0.21]] {
        let [with, without] = [shown(&with, spot), shown(&without, spot)];
        for (cell, (new, old)) in with.iter().zip(&without).enumerate() {
            let is_same = new.1 == old.1 && (new.0 == old.0 || (new.0 - old.0).abs() < 1e-6);
            assert!(
                is_same,
                "{name}: cell {cell}: {old:?} became {new:?}\n{}",
                picture(map)
            );
        }
    }
}

#[test]
fn hidden_ground_is_not_seen_in_the_drawing() {
    let clear = |map: &Map| Landscape::new(map).ambiguities().is_empty();
    let drawn = (0..).map(|seed| (seed, World::random(seed).draw().map));
    for (seed, map) in drawn.filter(|(_, map)| clear(map)).take(1000) {
        assert_unchanged(&map, 0.5, &format!("landscape {seed}"));
    }
    for seed in 0..500 {
        assert_unchanged(&scribble(seed), 0.7, &format!("scribble {seed}"));
    }
}

/// The ranges of depth and height of a column's blocks, sorted.
fn blocks(lines: &str, column: usize) -> Vec<[[i32; 2]; 2]> {
    let mut blocks = Landscape::new(&map(lines)).blocks(column);
    blocks.sort_unstable();
    blocks
}

/// A block that rises above the far edge of a meadow: the meadow goes on behind it, because it does on both sides.
#[test]
fn ground_goes_on_behind_a_block() {
    let meadow = "
        . . g . .
        . . g . .
        g g b g g
        g g b g g
        g g g g g";
    // The block is 2 high and 2 deep: its back is at z = 2, and so is that of the meadow.
    assert_eq!(blocks(meadow, 2).iter().map(|[z, _]| z[0]).min(), Some(2));
    let meadow = "
        . . g . .
        g g b g g
        g g b g g
        g g b g g
        g g g g g";
    // 3 high and 1 deep, at z = 3: 2 rows behind it are hidden.
    assert_eq!(
        blocks(meadow, 2),
        [[[1, 3], [0, 0]], [[3, 4], [0, 3]], [[3, 5], [0, 0]]]
    );
}

/// Land that hangs over water, because its shore has no front in some columns: the water goes on below it, without a hole.
#[test]
fn water_goes_on_below_what_hangs() {
    let island = "
        w w w w w
        w g g g w
        w g g g w
        w w b w w
        w w w w w";
    let land = Landscape::new(&map(island));
    assert_eq!(land.top(1, 1), Some(1));
    let blocks = blocks(island, 1);
    let is_water = |z: i32| {
        let mut here = blocks
            .iter()
            .filter(|[depth, _]| depth[0] <= z && z < depth[1]);
        here.any(|[_, y]| *y == [0, 0])
    };
    assert!((0..5).all(is_water), "{blocks:?}");
}
