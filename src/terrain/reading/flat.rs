//! PLACEHOLDER until the geometry of landscapes is there: every tile as a flat square at height 0.

use crate::scene::Surface;
use crate::terrain::Map;

/// Per look the squares of its cells, tile units about the map's middle, seen from above.
pub fn flat(map: &Map) -> Vec<(u8, Surface)> {
    let mut surfaces: Vec<Surface> = vec![Surface::default(); map.looks.len()];
    let middle = [map.columns as f32 / 2.0, map.rows as f32 / 2.0];
    for (cell, look) in map.cells.iter().enumerate().filter(|(_, look)| **look != 0) {
        let (x, z) = ((cell % map.columns) as f32, (cell / map.columns) as f32);
        let surface = &mut surfaces[usize::from(*look)];
        let base = surface.positions.len() as u32;
        for [u, v] in [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]] {
            surface
                .positions
                .push([x + u - middle[0], 0.0, z + v - middle[1]]);
            surface.normals.push([0.0, 1.0, 0.0]);
            surface.uvs.push([x + u, z + v]);
        }
        let corner = |at: u32| base + at;
        surface.triangles.push([0, 1, 2].map(corner));
        surface.triangles.push([0, 2, 3].map(corner));
    }
    let surfaces = surfaces.into_iter().enumerate();
    let drawn = surfaces.filter(|(_, surface)| !surface.triangles.is_empty());
    drawn.map(|(look, surface)| (look as u8, surface)).collect()
}
