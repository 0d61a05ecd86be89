//! Terrain: from a tile map, drawn as seen from above and in front at once, to a landscape of blocks (terrain.md).
//!
//! Invariants: one unit is one tile; x grows to the right with the columns, y upwards, z towards the viewer; a point
//! at height y that is seen at row r lies at z = r + y.

mod map;

pub use map::{EDGE_BELOW, EDGE_RIGHT, MOST_CELLS, Map, Tile};
