//! Terrain: maps of landscapes with known heights give these landscapes, and each looks like its
//! map.

use std::collections::BTreeMap;
use std::ops::Range;

use okoshi::internals::terrain::{Landscape, Map, Tile};

use crate::worlds::{World, picture, scribble};

/// The number of cells with the right height, and of all cells with a tile.
fn score(seed: u64) -> [usize; 2] {
    let drawn = World::random(seed).draw();
    let land = Landscape::new(&drawn.map);
    let mut score = [0; 2];
    for column in 0..drawn.map.columns {
        for (row, seen) in land.visible_heights(column).into_iter().enumerate() {
            if let Some(height) = drawn.heights[drawn.map.index(column, row)] {
                score[0] += usize::from(seen == Some(height));
                score[1] += 1;
            }
        }
    }
    score
}

#[test]
fn landscapes_are_reconstructed_from_their_maps() {
    // The first half was looked at while the rules were written, the second was not.
    for seeds in [0..2000, 50_000..52_000] {
        assert_reconstructed(seeds);
    }
}

fn assert_reconstructed(seeds: Range<u64>) {
    let scores: Vec<[usize; 2]> = seeds.clone().map(score).collect();
    let sum = |at: usize| scores.iter().map(|score| score[at]).sum::<usize>() as f64;
    let exact = scores.iter().filter(|[right, all]| right == all).count();
    let right = sum(0) / sum(1);
    let found = format!("seeds {seeds:?}: {right:.4} of all cells and {exact} maps are right");
    println!("{found}");
    assert!(right >= 0.95, "{found}");
    assert!(exact * 2 >= scores.len(), "{found}");
}

/// The corners of a triangle, in tiles from the map's top left.
pub(crate) type Triangle = [[f64; 3]; 3];

/// A triangle with its material.
pub(crate) type Shown = (u8, Triangle);

/// All triangles of a landscape.
pub(crate) fn triangles(map: &Map, land: &Landscape, roof: f64, bevel: f64) -> Vec<Shown> {
    let middle = [map.columns as f64 / 2.0, 0.0, map.rows as f64 / 2.0];
    let mut shown = vec![];
    for (look, pieces) in land.surface(roof, bevel) {
        for piece in pieces {
            let place = |corner: u32| {
                let place = piece.positions[corner as usize];
                [0, 1, 2].map(|axis| f64::from(place[axis]) + middle[axis])
            };
            shown.extend(
                piece
                    .triangles
                    .iter()
                    .map(|triangle| (look, triangle.map(place))),
            );
        }
    }
    shown
}

/// What is visible at a spot of each cell, where a point (x, y, z) appears at column x and row z − y: how near it is, y + z, and its
/// material.
pub(crate) fn looked_at(map: &Map, triangles: &[Shown], spot: [f64; 2]) -> Vec<(f64, u8)> {
    let mut nearest = vec![(f64::NEG_INFINITY, 0); map.cells.len()];
    for (look, corners) in triangles {
        let flat = corners.map(|[x, y, z]| [x, z - y]);
        let bounds = |axis: usize| {
            let values = flat.map(|point| point[axis]);
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (low.floor().max(0.0) as usize, high.ceil().max(0.0) as usize)
        };
        let cross = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
            (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
        };
        let area = cross(flat[0], flat[1], flat[2]);
        if area == 0.0 {
            continue;
        }
        let ((left, right), (top, bottom)) = (bounds(0), bounds(1));
        for row in top..bottom.min(map.rows) {
            for column in left..right.min(map.columns) {
                let spot = [column as f64 + spot[0], row as f64 + spot[1]];
                let weights = [
                    cross(flat[1], flat[2], spot) / area,
                    cross(flat[2], flat[0], spot) / area,
                    cross(flat[0], flat[1], spot) / area,
                ];
                if weights.iter().any(|weight| *weight < 0.0) {
                    continue;
                }
                let near = |axis: usize| -> f64 {
                    (0..3)
                        .map(|corner| weights[corner] * corners[corner][axis])
                        .sum()
                };
                let near = near(1) + near(2);
                let cell = &mut nearest[row * map.columns + column];
                // Where a wall meets the ground both are equally near: the face towards the viewer is visible.
                let faces = area < 0.0;
                if near > cell.0 + 1e-9 || (near > cell.0 - 1e-9 && faces) {
                    *cell = (near, *look);
                }
            }
        }
    }
    nearest
}

/// Fails with the cells of a map that do not look as drawn.
fn assert_seen_as_drawn(map: &Map, name: &str) {
    let land = Landscape::new(map);
    // Slightly off the middle, which is on the diagonals of squares.
    let seen = looked_at(map, &triangles(map, &land, 0.5, 0.0), [0.47, 0.56]);
    let seen: Vec<u8> = seen.into_iter().map(|(_, look)| look).collect();
    let wrong: Vec<_> = (0..map.cells.len())
        .filter(|cell| map.tile(*cell) != Tile::None && seen[*cell] != map.cells[*cell])
        .map(|cell| (cell % map.columns, cell / map.columns))
        .collect();
    let mut shown = map.clone();
    shown.cells = seen;
    assert!(
        wrong.is_empty(),
        "{name}: {wrong:?}\n{}\n{}",
        picture(map),
        picture(&shown)
    );
}

/// Fails where a surface is open: each edge of a triangle must meet an opposite one.
pub(crate) fn assert_closed(map: &Map, roof: f64, bevel: f64, name: &str) {
    let land = Landscape::new(map);
    let mut sides: BTreeMap<[[i64; 3]; 2], i32> = BTreeMap::new();
    for (_, corners) in triangles(map, &land, roof, bevel) {
        let corners = corners.map(|place| place.map(|value| (value * 4096.0).round() as i64));
        for side in 0..3 {
            let [from, to] = [corners[side], corners[(side + 1) % 3]];
            assert!(from != to, "{name}: a triangle without area");
            *sides.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    let open: Vec<_> = sides.iter().filter(|(_, count)| **count != 0).collect();
    let place = |side: &[[i64; 3]; 2]| side.map(|point| point.map(|value| value as f64 / 4096.0));
    let open: Vec<_> = open
        .iter()
        .map(|(side, count)| (place(side), **count))
        .take(8)
        .collect();
    assert!(open.is_empty(), "{name}: {open:?}\n{}", picture(map));
}

/// The area that two triangles of one plane share, seen along the axis `drop`.
fn shared(one: &Triangle, other: &Triangle, drop: usize) -> f64 {
    let [u, v] = [(drop + 1) % 3, (drop + 2) % 3];
    let flat = |corners: &Triangle| corners.map(|place| [place[u], place[v]]);
    let area = |ring: &[[f64; 2]]| -> f64 {
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        let twice = sides.map(|(a, b)| a[0] * b[1] - a[1] * b[0]);
        twice.sum::<f64>() / 2.0
    };
    let (mut ring, mut clip) = (flat(one).to_vec(), flat(other));
    if area(&clip) < 0.0 {
        clip.reverse();
    }
    // Sutherland and Hodgman: what lies left of each side of the other triangle remains.
    for side in 0..3 {
        let [a, b] = [clip[side], clip[(side + 1) % 3]];
        let left = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let mut kept = vec![];
        for (at, p) in ring.iter().enumerate() {
            let q = ring[(at + 1) % ring.len()];
            let [before, after] = [left(*p), left(q)];
            if before >= 0.0 {
                kept.push(*p);
            }
            if before * after < 0.0 {
                let along = before / (before - after);
                kept.push([0, 1].map(|axis| p[axis] + along * (q[axis] - p[axis])));
            }
        }
        ring = kept;
    }
    area(&ring).abs()
}

/// Fails where two faces lie back to back in one plane: no solid has a thickness of 0, and solids that touch have no faces
/// between them.
pub(crate) fn assert_no_faces_back_to_back(map: &Map, roof: f64, bevel: f64, name: &str) {
    let land = Landscape::new(map);
    // Per plane the triangles that look along its normal, and those that look against it.
    let mut planes: BTreeMap<[i64; 4], [Vec<Triangle>; 2]> = BTreeMap::new();
    for (_, corners) in triangles(map, &land, roof, bevel) {
        let [a, b, c] = corners;
        let [u, v] = [b, c].map(|end| [0, 1, 2].map(|axis| end[axis] - a[axis]));
        let normal = [1, 2, 0].map(|i: usize| {
            let j = (i + 1) % 3;
            u[i] * v[j] - u[j] * v[i]
        });
        let length = normal.iter().map(|value| value * value).sum::<f64>().sqrt();
        if length < 1e-9 {
            continue;
        }
        let normal = normal.map(|value| value / length);
        let first = normal.iter().find(|value| value.abs() > 1e-4);
        let against = first.is_some_and(|value| *value < 0.0);
        let sign = if against { -1.0 } else { 1.0 };
        let offset: f64 = (0..3).map(|axis| normal[axis] * a[axis]).sum();
        let [x, y, z] = normal;
        let plane = [x, y, z, offset].map(|value| (sign * value * 4096.0).round() as i64);
        planes.entry(plane).or_default()[usize::from(against)].push(corners);
    }
    for (plane, [along, against]) in &planes {
        let drop = (0..3).max_by_key(|axis| plane[*axis].abs()).unwrap_or(0);
        for (one, other) in along
            .iter()
            .flat_map(|one| against.iter().map(move |other| (one, other)))
        {
            let area = shared(one, other, drop);
            assert!(
                area < 1e-4,
                "{name}: {one:?} and {other:?}\n{}",
                picture(map)
            );
        }
    }
}

#[test]
fn surfaces_look_like_their_maps() {
    let open = |map: &Map| !Landscape::new(map).ambiguities().is_empty();
    let drawn = (0..).map(|seed| (seed, World::random(seed).draw().map));
    for (seed, map) in drawn.filter(|(_, map)| !open(map)).take(1000) {
        assert_seen_as_drawn(&map, &format!("landscape {seed}"));
    }
}

/// The map with a second material for some of its roofs' tiles.
fn with_patterned_roofs(mut map: Map, seed: u64) -> Map {
    let mut random = fastrand::Rng::with_seed(seed);
    map.tiles.push(Tile::Red);
    let other = map.tiles.len() as u8 - 1;
    for cell in &mut map.cells {
        if map.tiles[usize::from(*cell)] == Tile::Red && random.u8(..3) == 0 {
            *cell = other;
        }
    }
    map
}

#[test]
fn patterned_roofs_look_as_drawn_and_are_closed() {
    for seed in 0..1500 {
        let world = with_patterned_roofs(World::random(seed).draw().map, seed);
        if !world.cells.contains(&4) {
            continue;
        }
        let name = format!("landscape {seed}");
        assert_closed(&world, 0.5, 0.0, &name);
        assert_closed(&world, 0.7, 0.3, &name);
        assert_no_faces_back_to_back(&world, 0.5, 0.0, &name);
        if Landscape::new(&world).ambiguities().is_empty() {
            assert_seen_as_drawn(&world, &name);
        }
    }
    for seed in 0..300 {
        let scribble = with_patterned_roofs(scribble(seed), seed);
        assert_closed(&scribble, 0.7, 0.0, &format!("scribble {seed}"));
    }
}

/// Checks a landscape and a scribble for each seed, with these bevels.
fn for_each_map(seeds: u64, bevels: [f64; 2], check: impl Fn(&Map, f64, f64, &str)) {
    let [of_landscape, of_scribble] = bevels;
    for seed in 0..seeds {
        let drawn = World::random(seed).draw();
        check(&drawn.map, 0.5, of_landscape, &format!("landscape {seed}"));
        check(
            &scribble(seed),
            0.7,
            of_scribble,
            &format!("scribble {seed}"),
        );
    }
}

#[test]
fn surfaces_are_closed() {
    for_each_map(500, [0.0; 2], assert_closed);
}

#[test]
fn bevelled_surfaces_are_closed() {
    for_each_map(200, [0.25, 0.4], assert_closed);
}

/// Landscapes side by side, so that the map is wider than the stripes that are meshed at once.
fn wide(seed: u64) -> Map {
    let maps: Vec<Map> = (0..9)
        .map(|part| World::random(seed * 9 + part).draw().map)
        .collect();
    let columns = maps.iter().map(|map| map.columns).sum();
    let rows = maps.iter().map(|map| map.rows).max().unwrap_or(0);
    let mut wide = Map::empty(columns, rows);
    let mut left = 0;
    for map in maps {
        for cell in 0..map.cells.len() {
            let (column, row) = (cell % map.columns, cell / map.columns);
            let at = wide.index(left + column, row);
            wide.cells[at] = map.cells[cell];
            wide.edges[at] = map.edges[cell];
        }
        left += map.columns;
    }
    wide
}

#[test]
fn wide_surfaces_are_closed() {
    for seed in 0..40 {
        let map = wide(seed);
        assert!(map.columns > 64);
        for bevel in [0.0, 0.3] {
            assert_closed(&map, 0.5, bevel, &format!("wide {seed}"));
            assert_no_faces_back_to_back(&map, 0.5, bevel, &format!("wide {seed}"));
        }
    }
}

#[test]
fn no_faces_lie_back_to_back() {
    for_each_map(300, [0.0; 2], assert_no_faces_back_to_back);
}

#[test]
fn no_bevelled_faces_lie_back_to_back() {
    for_each_map(100, [0.25, 0.4], assert_no_faces_back_to_back);
}

/// The area of each material, square tiles.
fn areas(map: &Map, land: &Landscape, bevel: f64) -> BTreeMap<u8, f64> {
    let mut areas: BTreeMap<u8, f64> = BTreeMap::new();
    for (look, [a, b, c]) in triangles(map, land, 0.7, bevel) {
        let [u, v] = [b, c].map(|end| [0, 1, 2].map(|axis| end[axis] - a[axis]));
        let cross = [1, 2, 0].map(|i: usize| {
            let j = (i + 1) % 3;
            u[i] * v[j] - u[j] * v[i]
        });
        let length = cross.iter().map(|value| value * value).sum::<f64>().sqrt();
        *areas.entry(look).or_default() += length / 2.0;
    }
    areas
}

/// The extent across a face that looks in a direction, of what of it is flat.
fn flat_extent(map: &Map, land: &Landscape, bevel: f64, toward: usize, across: usize) -> f64 {
    let all = triangles(map, land, 0.7, bevel);
    let flat = all.iter().map(|(_, corners)| corners).filter(|corners| {
        let at = corners[0][toward];
        corners
            .iter()
            .all(|corner| (corner[toward] - at).abs() < 1e-6)
    });
    let near = flat
        .clone()
        .map(|corners| corners[0][toward])
        .fold(f64::NEG_INFINITY, f64::max);
    let nearest = flat.filter(|corners| corners[0][toward] > near - 1e-6);
    let values = nearest.flatten().map(|corner| corner[across]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    high - low
}

#[test]
fn bevels_leave_narrow_faces_their_middle_half() {
    // A plate, a step and a pillar: the front's height, and the top's depth.
    for (lines, front, top) in [
        ("g g g\ng g g\ng g g", 0.25, 3.0),
        ("g g g\ng g g\nb b b", 1.0, 2.0),
        ("g\nb\nb\nb", 3.0, 1.0),
    ] {
        let map = crate::letters::map(lines);
        let land = Landscape::new(&map);
        for bevel in [0.1, 0.3, 0.5] {
            let kept = |extent: f64| (extent - 2.0 * bevel).max(extent / 2.0) - 0.02;
            let found = flat_extent(&map, &land, bevel, 2, 1);
            assert!(found >= kept(front), "{lines}, {bevel}: {found} of {front}");
            let found = flat_extent(&map, &land, bevel, 1, 2);
            assert!(found >= kept(top), "{lines}, {bevel}: {found} of {top}");
        }
    }
}

#[test]
fn bevels_leave_each_material_most_of_its_area() {
    let mut least = f64::INFINITY;
    for seed in 0..300 {
        let map = World::random(seed).draw().map;
        let land = Landscape::new(&map);
        let whole = areas(&map, &land, 0.0);
        for bevel in [0.15, 0.3, 0.5] {
            let left = areas(&map, &land, bevel);
            for (look, area) in &whole {
                let share = left.get(look).copied().unwrap_or(0.0) / area;
                least = least.min(share);
                assert!(
                    share > 0.6,
                    "landscape {seed}, {bevel}: {share} of material {look}"
                );
            }
        }
    }
    println!("each material keeps at least {least:.3} of its area");
}
