//! The surface of the landscape.
//!
//! Invariants: the surface is closed, and no two faces lie back to back in one plane. Coplanar faces are merged, there are no faces
//! between solids that touch, and a corner on the side of another face is a point of that face too (no T-junctions), so that no
//! gaps show.

mod bevel;
mod corners;
mod faces;
mod greedy;
mod mesh;
mod roofs;
mod slices;
mod steps;

use rayon::prelude::*;

use super::constraints::STRIPE;
use super::houses::House;
use super::solids::MapContext;
use crate::scene::Surface;

use bevel::{Bevel, Lines};
use corners::Corners;
use greedy::{Facing, Rect};
use mesh::Mesh;
use roofs::{Gable, Roof};

/// The triangles of all solids: per material the parts of its surface, in tiles, about the map's middle at height 0.
/// `factor` is the ratio of a roof's height to its depth, `radius` the radius of bevels.
pub(super) fn surface(context: &MapContext, factor: f64, radius: f64) -> Vec<(u8, Vec<Surface>)> {
    let grid = &context.grid;
    let stripes = grid.columns.div_ceil(STRIPE);
    if stripes == 0 || grid.rows == 0 {
        return vec![];
    }
    let columns = |stripe: usize| stripe * STRIPE..((stripe + 1) * STRIPE).min(grid.columns);
    let all = (0..stripes).into_par_iter();
    let mut rects: Vec<Vec<Rect>> = all
        .map(|stripe| faces::faces(context, columns(stripe)))
        .collect();
    let roofed = |house: &&House| house.depth > 0 && !house.roof.is_empty();
    let numbers = (0..).zip(&context.houses);
    let (numbers, houses): (Vec<u32>, Vec<&House>) =
        numbers.filter(|(_, house)| roofed(house)).unzip();
    let mut eaves: Vec<[i32; 3]> = houses
        .iter()
        .flat_map(|house| roofs::eaves(house))
        .collect();
    let gables = roofs::gables(&houses, &rects, factor);
    let mut tiles: Vec<Option<Vec<Vec<u8>>>> = numbers
        .par_iter()
        .map(|number| roofs::tiles(context, *number))
        .collect();
    let has_tiles = tiles.iter().any(Option::is_some);
    for ((tiles, gables), house) in tiles.iter_mut().zip(&gables).zip(&houses) {
        // Roofs that share a gable share the corners on it.
        if has_tiles && tiles.is_none() && gables.contains(&Gable::Shared) {
            let row = vec![house.materials[0]; house.roof.len()];
            *tiles = Some(vec![row; house.depth as usize]);
        }
        if tiles.is_some() {
            eaves.extend(roofs::eaves_between(house));
        }
    }
    if let Some(pictures) = &grid.pictures {
        let all = rects.par_iter_mut();
        all.for_each(|rects| split(rects, pictures.material));
    }
    let (lines, mut squares) = if radius > 0.0 {
        (Lines::new(rects.iter().flatten()), vec![vec![]; stripes])
    } else {
        (Lines::default(), vec![])
    };
    for (squares, rects) in squares.iter_mut().zip(&mut rects) {
        let mut rest = vec![];
        rects
            .iter()
            .for_each(|rect| bevel::ring(rect, &lines, squares, &mut rest));
        *rects = rest;
    }
    let corners = Corners::new(&rects, &squares, &eaves);
    let materials = 256;
    let mesh = || Mesh::new(grid, materials);
    let mut made: Vec<Vec<(u8, Surface)>> = rects
        .into_par_iter()
        .enumerate()
        .map(|(stripe, rects)| {
            let mut mesh = mesh();
            let mut sides: [Vec<[i32; 3]>; 4] = Default::default();
            for rect in &rects {
                let points = rect.corners();
                for (side, list) in sides.iter_mut().enumerate() {
                    let [from, to] = [points[side], points[(side + 1) % 4]];
                    list.clear();
                    list.push(from);
                    corners.between(Some(stripe), from, to, |point| list.push(point));
                }
                mesh.rectangle(rect.material, rect.facing, &sides);
            }
            if radius > 0.0 {
                bevelled(context, radius, &lines, &squares, stripe, &mut mesh);
            }
            mesh.finish()
        })
        .collect();
    let mut roof = mesh();
    for ((house, gables), tiles) in houses.into_iter().zip(gables).zip(tiles) {
        let one = Roof {
            house,
            factor,
            gables,
            tiles,
        };
        one.add(&mut roof, &corners);
    }
    made.push(roof.finish());
    let mut surfaces: Vec<(u8, Vec<Surface>)> =
        (0..=255).map(|material| (material, vec![])).collect();
    for (material, surface) in made.into_iter().flatten() {
        surfaces[usize::from(material)].1.push(surface);
    }
    surfaces.retain(|(_, pieces)| !pieces.is_empty());
    surfaces
}

/// Splits the tops of a material into single squares.
fn split(rects: &mut Vec<Rect>, material: u8) {
    let is_split = |rect: &Rect| rect.facing == Facing::Up && rect.material == material;
    let large: Vec<Rect> = rects.iter().copied().filter(is_split).collect();
    rects.retain(|rect| !is_split(rect));
    for rect in large {
        let across = rect.across[0]..rect.across[1];
        rects.extend(across.flat_map(|x| {
            (rect.along[0]..rect.along[1]).map(move |z| Rect {
                across: [x, x + 1],
                along: [z, z + 1],
                ..rect
            })
        }));
    }
}

/// Adds the bevelled squares of a stripe.
fn bevelled(
    context: &MapContext,
    radius: f64,
    lines: &Lines,
    squares: &[Vec<Rect>],
    stripe: usize,
    mesh: &mut Mesh<'_>,
) {
    let start = (stripe * STRIPE) as i32;
    let end = start + STRIPE as i32;
    let touches = |rect: &&Rect| {
        let x = rect.corners().map(|corner| corner[0]);
        let [low, high] = [x.iter().min(), x.iter().max()].map(|x| x.copied().unwrap_or(0));
        // One tile more, as it depends on the next side of a square how far its own is bevelled.
        low <= end + 1 && high >= start - 1
    };
    let near = stripe.saturating_sub(1)..(stripe + 2).min(squares.len());
    let mut around = squares[near].iter().flatten().filter(touches);
    let houses = context.houses.iter().filter(|house| {
        house.roof.start.min(house.walls.start) <= end + 1
            && house.roof.end.max(house.walls.end) >= start - 1
    });
    let bevel = Bevel::new(radius, lines, &mut around, houses.collect());
    bevel.add(
        mesh,
        &squares[stripe],
        bevel::columns(stripe, squares.len()),
    );
}
