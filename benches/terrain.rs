//! How long a landscape takes, from the map to its triangles, beside the decoding of the map's PNG and beside the greedy
//! quads of the crate block-mesh over the same voxels; and how much memory.
//!
//!   cargo bench --bench terrain [-- SIDE…]
//!
//! block-mesh gets its voxels in chunks, only those that hold some, ready filled; what is timed is its meshing alone. It makes
//! quads without normals, texture coordinates and looks, whose corners do not meet.

#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]

use std::collections::BTreeMap;
use std::io::Cursor;
use std::process::Command;
use std::time::{Duration, Instant};

use block_mesh::{
    GreedyQuadsBuffer, MergeVoxel, RIGHT_HANDED_Y_UP_CONFIG, Voxel, VoxelVisibility, greedy_quads,
};
use fastrand::Rng;
use ndshape::{ConstShape, ConstShape3u32};
use okoshi::internals::terrain::{Landscape, Map};
use rayon::prelude::*;

/// Repetitions, of which the median is printed.
const ROUNDS: usize = 5;
/// Cells of a chunk along a side, and of a chunk with its border.
const CHUNK: i32 = 32;
const PADDED: u32 = 34;
type Shape = ConstShape3u32<PADDED, PADDED, PADDED>;
/// Set in child processes that only measure memory.
const MEASURED: &str = "OKOSHI_BENCH_TERRAIN";

fn main() {
    if let Ok(what) = std::env::var(MEASURED) {
        return measured(&what);
    }
    let sides = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let sides: Vec<usize> = sides.collect();
    let sides = if sides.is_empty() {
        vec![512, 2048, 4096]
    } else {
        sides
    };
    for side in sides {
        compare(side);
    }
}

/// Terraces with wandering cliffs, ponds and houses.
fn map(side: usize) -> Map {
    let mut random = Rng::with_seed(side as u64);
    let mut map = Map::empty(side, side);
    map.cells.fill(1);
    let last = side as i32 - 1;
    let mut row = random.i32(6..=16);
    while row < last - 8 {
        let (mut at, mut height, mut run) = (row, random.i32(1..=6), 0);
        for column in 0..side {
            if run == 0 {
                run = random.i32(3..=14);
                at = (at + random.i32(-2..=2)).clamp(row - 4, row + 4);
                height = (height + random.i32(-1..=1)).clamp(0, 6);
            }
            run -= 1;
            for front in at.max(0)..(at + height).min(last) {
                let cell = map.index(column, front as usize);
                map.cells[cell] = 2;
            }
        }
        row += random.i32(12..=28);
    }
    for _ in 0..side * side / 1500 {
        let [x, y] = [random.i32(0..=last), random.i32(0..=last)];
        let [width, depth, wall] = [random.i32(3..=8), random.i32(2..=4), random.i32(1..=3)];
        let house = random.u8(..100) < 50;
        let rows = y..(y + depth + wall).min(last);
        let cells =
            rows.flat_map(|row| (x..(x + width).min(last)).map(move |column| (column, row)));
        let cells: Vec<(usize, i32)> = cells
            .map(|(column, row)| (map.index(column as usize, row as usize), row))
            .collect();
        if cells.iter().all(|(cell, _)| map.cells[*cell] == 1) {
            for (cell, row) in cells {
                map.cells[cell] = match house {
                    true if row < y + depth => 4,
                    true => 5,
                    // The first row is the far wall.
                    false if row == y => 2,
                    false => 3,
                };
            }
        }
    }
    map
}

/// The map as a picture of one pixel a tile.
fn png(map: &Map) -> Vec<u8> {
    let pixels = map.cells.iter().flat_map(|look| {
        let tile = map.tiles[usize::from(*look)];
        tile.color()
    });
    let picture = image::RgbImage::from_raw(map.columns as u32, map.rows as u32, pixels.collect());
    let mut bytes = Cursor::new(Vec::new());
    let written = picture
        .expect("as many pixels as cells")
        .write_to(&mut bytes, image::ImageFormat::Png);
    written.expect("a PNG");
    bytes.into_inner()
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times[times.len() / 2].as_secs_f64() * 1e3
}

fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let begun = Instant::now();
    let done = work();
    (begun.elapsed(), done)
}

fn compare(side: usize) {
    let map = map(side);
    let png = png(&map);
    let chunks = chunks(&Landscape::new(&map));
    let mut times: [Vec<Duration>; 5] = Default::default();
    let (mut triangles, mut quads) = (0, 0);
    for _ in 0..ROUNDS {
        times[0].push(timed(|| image::load_from_memory(&png).expect("a PNG")).0);
        let (heights, land) = timed(|| Landscape::new(&map));
        let (meshing, surface) = timed(|| land.surface(0.5, 0.0));
        let pieces = surface.iter().flat_map(|(_, pieces)| pieces);
        triangles = pieces.map(|piece| piece.triangles.len()).sum();
        times[1].push(heights);
        times[2].push(meshing);
        drop((surface, land));
        let (one, count) = timed(|| {
            let mut buffer = GreedyQuadsBuffer::new(Shape::SIZE as usize);
            chunks
                .iter()
                .map(|chunk| greedy(chunk, &mut buffer))
                .sum::<usize>()
        });
        times[3].push(one);
        quads = count;
        let new = || GreedyQuadsBuffer::new(Shape::SIZE as usize);
        let all = || {
            chunks
                .par_iter()
                .map_init(new, |buffer, chunk| greedy(chunk, buffer))
                .sum::<usize>()
        };
        times[4].push(timed(all).0);
    }
    let voxels: usize = chunks.iter().flatten().filter(|voxel| voxel.0).count();
    let [decode, heights, meshing, one, all] = times.map(median);
    let ours = heights + meshing;
    println!(
        "{side} × {side} tiles: decode {decode:.0} ms; heights {heights:.0} + surface {meshing:.0} = {ours:.0} ms for {triangles} triangles ({:.1} × decoding); block-mesh {one:.0} ms on one thread, {all:.0} ms on all, for {quads} quads of {voxels} voxels: {:.1} × and {:.1} × as long",
        ours / decode,
        one / ours,
        all / ours
    );
    drop(chunks);
    let program = std::env::current_exe().expect("this program");
    let peak = |what: &str| -> f64 {
        let run = Command::new(&program)
            .env(MEASURED, format!("{what} {side}"))
            .output();
        let run = run.expect("this program again");
        let text = String::from_utf8_lossy(&run.stdout).into_owned();
        text.trim().parse().unwrap_or(f64::NAN)
    };
    let [map, land] = ["map", "land"].map(peak);
    let output = triangles as f64 * 12.0;
    let cells = (side * side) as f64;
    println!(
        "    memory: {:.0} MiB more than the map's own, {:.1} bytes a tile, {:.0} MiB of them triangles and corners",
        (land - map) / 1048576.0,
        (land - map) / cells,
        (output + peak("output")) / 1048576.0
    );
}

/// Prints the peak memory of a step, bytes.
fn measured(what: &str) {
    let (what, side) = what.split_once(' ').expect("what, and of which size");
    let map = map(side.parse().expect("a number"));
    if what == "map" {
        println!("{}", peak());
        return;
    }
    let surface = Landscape::new(&map).surface(0.5, 0.0);
    if what == "output" {
        let pieces = surface.iter().flat_map(|(_, pieces)| pieces);
        let corners: usize = pieces.map(|piece| piece.positions.len()).sum();
        println!("{}", corners * 32);
        return;
    }
    println!("{}", peak());
}

/// The peak memory of this process, bytes.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kibibytes.unwrap_or(f64::NAN) * 1024.0
}

#[derive(Clone, Copy, PartialEq, Eq)]
struct Solid(bool);

impl Voxel for Solid {
    fn get_visibility(&self) -> VoxelVisibility {
        if self.0 {
            VoxelVisibility::Opaque
        } else {
            VoxelVisibility::Empty
        }
    }
}

impl MergeVoxel for Solid {
    type MergeValue = bool;

    fn merge_value(&self) -> bool {
        self.0
    }
}

/// The voxels of a landscape in chunks with a border of one voxel.
fn chunks(land: &Landscape) -> Vec<Vec<Solid>> {
    let mut chunks: BTreeMap<[i32; 3], Vec<Solid>> = BTreeMap::new();
    let around = |value: i32| (value - 1).div_euclid(CHUNK)..=(value + 1).div_euclid(CHUNK);
    for x in 0..land.columns() as i32 {
        for [depths, heights] in land.blocks(x as usize) {
            let voxels =
                (depths[0]..depths[1]).flat_map(|z| (heights[0]..heights[1]).map(move |y| (y, z)));
            for (y, z) in voxels {
                for (cx, cy, cz) in around(x).flat_map(|cx| {
                    around(y).flat_map(move |cy| around(z).map(move |cz| (cx, cy, cz)))
                }) {
                    let chunk = chunks.entry([cx, cy, cz]);
                    let chunk = chunk.or_insert_with(|| vec![Solid(false); Shape::SIZE as usize]);
                    let place = [x - cx * CHUNK, y - cy * CHUNK, z - cz * CHUNK];
                    let place = place.map(|value| (value + 1) as u32);
                    chunk[Shape::linearize(place) as usize] = Solid(true);
                }
            }
        }
    }
    chunks.into_values().collect()
}

fn greedy(chunk: &[Solid], buffer: &mut GreedyQuadsBuffer) -> usize {
    let faces = &RIGHT_HANDED_Y_UP_CONFIG.faces;
    greedy_quads(chunk, &Shape {}, [0; 3], [PADDED - 1; 3], faces, buffer);
    buffer.quads.num_quads()
}
