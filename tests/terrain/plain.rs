//! Plain maps, which are seen from straight above: each cell is as high as it was given, and nothing else is built.

use std::collections::BTreeMap;

use okoshi::internals::terrain::{Landscape, Map, Tile, UNSET};
use proptest::prelude::*;

use crate::surfaces::{assert_closed, assert_no_faces_back_to_back, triangles};

/// A random map of patches, with heights for some of its cells.
fn random(seed: u64) -> Map {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut map = Map::empty(random.usize(1..24), random.usize(1..24));
    map.heights = vec![UNSET; map.cells.len()];
    let deepest = random.i8(-4..=0);
    for _ in 0..random.usize(1..12) {
        let [left, top] = [map.columns, map.rows].map(|side| random.usize(..side));
        let [width, height] =
            [map.columns - left, map.rows - top].map(|most| random.usize(1..=most));
        let look = random.u8(..6);
        let given = if random.bool() {
            random.i8(deepest..6)
        } else {
            UNSET
        };
        for column in left..left + width {
            for row in top..top + height {
                let cell = map.index(column, row);
                (map.cells[cell], map.heights[cell]) = (look, given);
            }
        }
    }
    map
}

/// Per cell its height by the plain method: that which is given; water lies below its lowest bank, the sea at 0 or below.
fn heights(map: &Map) -> Vec<Option<i32>> {
    let [columns, rows] = [map.columns, map.rows];
    let is = |cell: usize, water: bool| {
        map.tile(cell) != Tile::None && (map.tile(cell) == Tile::Blue) == water
    };
    let around = |cell: usize| {
        let (column, row) = (cell % columns, cell / columns);
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < columns).then(|| cell + 1),
            (row > 0).then(|| cell - columns),
            (row + 1 < rows).then(|| cell + columns),
        ]
    };
    let given = |cell: usize| match map.heights[cell] {
        UNSET => 0,
        height => i32::from(height),
    };
    let height = |cell: usize| {
        if map.tile(cell) == Tile::None {
            return None;
        }
        if is(cell, false) || map.heights[cell] != UNSET {
            return Some(given(cell));
        }
        let (mut body, mut at) = (vec![cell], 0);
        let (mut bank, mut sea) = (None::<i32>, false);
        while at < body.len() {
            for next in around(body[at]) {
                match next {
                    None => sea = true,
                    Some(next) if is(next, false) => {
                        bank = Some(bank.unwrap_or(i32::MAX).min(given(next)));
                    }
                    Some(next) => {
                        let same = is(next, true) && map.heights[next] == UNSET;
                        if same && !body.contains(&next) {
                            body.push(next);
                        }
                    }
                }
            }
            at += 1;
        }
        Some(match bank {
            None => 0,
            Some(bank) if sea => (bank - 1).min(0),
            Some(bank) => bank - 1,
        })
    };
    (0..map.cells.len()).map(height).collect()
}

#[test]
fn every_cell_is_one_column_as_high_as_it_was_given() {
    for seed in 0..1500 {
        let map = random(seed);
        let land = Landscape::new(&map);
        let expected = heights(&map);
        let floor = expected.iter().flatten().min().copied().unwrap_or(0).min(0);
        for column in 0..map.columns {
            let mut built: BTreeMap<i32, [i32; 2]> = BTreeMap::new();
            for [z, y] in land.blocks(column) {
                for row in z[0]..z[1] {
                    assert_eq!(
                        built.insert(row, y),
                        None,
                        "map {seed}: two blocks in a cell"
                    );
                }
            }
            for row in 0..map.rows {
                let height = expected[map.index(column, row)];
                assert_eq!(land.top(column, row), height, "map {seed}: {column}, {row}");
                let block = built.remove(&(row as i32));
                assert_eq!(block, height.map(|height| [floor, height]), "map {seed}");
            }
            assert!(built.is_empty(), "map {seed}: {built:?} is outside");
        }
        assert!(land.ambiguities().is_empty());
    }
}

/// The volume that triangles enclose.
fn volume(shown: &[(u8, [[f64; 3]; 3])]) -> f64 {
    let of_one = |[a, b, c]: &[[f64; 3]; 3]| {
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    };
    shown
        .iter()
        .map(|(_, corners)| of_one(corners))
        .sum::<f64>()
        / 6.0
}

#[test]
fn the_surface_is_that_of_the_columns() {
    for seed in 0..600 {
        let map = random(seed);
        let name = format!("map {seed}");
        assert_closed(&map, 0.7, 0.0, &name);
        assert_closed(&map, 0.7, 0.3, &name);
        assert_no_faces_back_to_back(&map, 0.7, 0.0, &name);
        let shown = triangles(&map, &Landscape::new(&map), 0.7, 0.0);
        let expected = heights(&map);
        let floor = expected.iter().flatten().min().copied().unwrap_or(0).min(0);
        let tops = expected.iter().flatten();
        // Below the floor is the plate, a quarter of a tile thick.
        let solid: f64 = tops.map(|top| f64::from(top - floor) + 0.25).sum();
        assert!((volume(&shown) - solid).abs() < 1e-6, "{name}");
        // The area in each direction, so that there is no face between solids that touch.
        let cells = expected.iter().flatten().count() as f64;
        let at = |column: usize, row: usize| {
            let inside = column < map.columns && row < map.rows;
            let top = inside.then(|| expected[map.index(column, row)]).flatten();
            top.map_or(0.0, |top| f64::from(top - floor) + 0.25)
        };
        let step = |one: f64, other: f64| (one - other).abs();
        let mut walls = 0.0;
        for column in 0..=map.columns {
            for row in 0..=map.rows {
                let [left, above] = [column.wrapping_sub(1), row.wrapping_sub(1)];
                walls += step(at(column, row), at(left, row));
                walls += step(at(column, row), at(column, above));
            }
        }
        let area: f64 = shown
            .iter()
            .map(|(_, [a, b, c])| {
                let [u, v] = [b, c].map(|end| [0, 1, 2].map(|axis| end[axis] - a[axis]));
                let cross = [1, 2, 0].map(|i: usize| {
                    let j = (i + 1) % 3;
                    u[i] * v[j] - u[j] * v[i]
                });
                cross.iter().map(|value| value * value).sum::<f64>().sqrt() / 2.0
            })
            .sum();
        assert!(
            (area - (2.0 * cells + walls)).abs() < 1e-4,
            "{name}: {area}"
        );
    }
}

/// A map from lines of letters, all with these heights.
fn lettered(lines: &str, heights: &[(char, i8)]) -> Map {
    let spaced: Vec<String> = lines
        .split_whitespace()
        .map(|line| line.chars().map(|letter| format!("{letter} ")).collect())
        .collect();
    let mut map = crate::letters::map(&spaced.join("\n"));
    let letters = lines.split_whitespace().flat_map(str::chars);
    map.heights = letters
        .map(|letter| {
            let given = heights.iter().find(|(of, _)| *of == letter);
            given.map_or(UNSET, |(_, height)| *height)
        })
        .collect();
    map
}

#[test]
fn water_lies_below_its_banks() {
    let tops = |lines: &str, heights: &[(char, i8)]| {
        let map = lettered(lines, heights);
        let land = Landscape::new(&map);
        let row = |row: usize| (0..map.columns).map(move |column| (column, row));
        let tops = (0..map.rows).flat_map(row);
        tops.map(|(column, row)| land.top(column, row))
            .collect::<Vec<_>>()
    };
    // A pond, and one on a hill.
    assert_eq!(tops("ggg gwg ggg", &[])[4], Some(-1));
    assert_eq!(tops("ggg gwg ggg", &[('g', 3)])[4], Some(2));
    // The lowest bank counts, and water that a legend gives a height keeps it.
    assert_eq!(tops("ggg Rwg ggg", &[('g', 3), ('R', 1)])[4], Some(0));
    assert_eq!(tops("ggg gwg ggg", &[('g', 3), ('w', 3)])[4], Some(3));
    // The sea.
    assert_eq!(tops("wgw", &[('g', 5)]), [Some(0), Some(5), Some(0)]);
    assert_eq!(tops("wgw", &[]), [Some(-1), Some(0), Some(-1)]);
    assert_eq!(tops("w.w", &[]), [Some(0), None, Some(0)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A map turned by a quarter gives the same heights, turned: nothing depends on where the viewer is.
    #[test]
    fn plain_maps_have_no_front(seed in 2000..u64::MAX / 2) {
        let map = random(seed);
        let mut turned = Map::empty(map.rows, map.columns);
        turned.heights = vec![UNSET; map.cells.len()];
        for column in 0..map.columns {
            for row in 0..map.rows {
                let to = turned.index(map.rows - 1 - row, column);
                let from = map.index(column, row);
                (turned.cells[to], turned.heights[to]) = (map.cells[from], map.heights[from]);
            }
        }
        let [land, other] = [&map, &turned].map(Landscape::new);
        for column in 0..map.columns {
            for row in 0..map.rows {
                let there = other.top(map.rows - 1 - row, column);
                prop_assert_eq!(land.top(column, row), there);
            }
        }
        let shown = [(&map, &land), (&turned, &other)];
        let volumes = shown.map(|(map, land)| volume(&triangles(map, land, 0.7, 0.0)));
        prop_assert!((volumes[0] - volumes[1]).abs() < 1e-6);
    }
}
