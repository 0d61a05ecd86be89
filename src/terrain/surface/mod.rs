//! The surface of the landscape: coplanar faces merged, no faces between solids that touch, and no point of one face
//! on the side of another that does not have it too: so nothing shines through where faces meet, and what is solid is
//! closed.

mod corners;
mod faces;
mod mesh;
mod roofs;
mod slices;
mod sweep;

use rayon::prelude::*;

use super::houses::House;
use super::solids::Known;
use super::ties::STRIPE;
use crate::scene::Surface;

use corners::Corners;
use mesh::Mesh;
use sweep::Rect;

/// The triangles of all solids: per look pieces of its surface, in tiles, about the map's middle at height 0.
/// `factor` is the height of roofs over their depth.
pub(super) fn surface(known: &Known<'_>, factor: f64) -> Vec<(u8, Vec<Surface>)> {
    let grid = known.grid;
    let stripes = grid.columns.div_ceil(STRIPE);
    if stripes == 0 || grid.rows == 0 {
        return vec![];
    }
    let columns = |stripe: usize| stripe * STRIPE..((stripe + 1) * STRIPE).min(grid.columns);
    let all = (0..stripes).into_par_iter();
    let mut rects: Vec<Vec<Rect>> = all
        .map(|stripe| faces::faces(known, columns(stripe)))
        .collect();
    let roofed = |house: &&House| house.depth > 0 && !house.roof.is_empty();
    let mut eaves = vec![];
    for house in known.houses.iter().filter(roofed) {
        eaves.extend(roofs::eaves(house));
        for rect in roofs::soffits(house) {
            rects[rect.across[0] as usize / STRIPE].push(rect);
        }
    }
    let corners = Corners::new(&rects, &eaves);
    let looks = 256;
    let mesh = || Mesh::new(grid.columns, grid.rows, looks);
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
                mesh.rectangle(rect.look, rect.facing, &sides);
            }
            mesh.finish()
        })
        .collect();
    let mut roof = mesh();
    for house in known.houses.iter().filter(roofed) {
        roofs::roof(&mut roof, &corners, house, factor);
    }
    made.push(roof.finish());
    let mut surfaces: Vec<(u8, Vec<Surface>)> = (0..=255).map(|look| (look, vec![])).collect();
    for (look, surface) in made.into_iter().flatten() {
        surfaces[usize::from(look)].1.push(surface);
    }
    surfaces.retain(|(_, pieces)| !pieces.is_empty());
    surfaces
}
