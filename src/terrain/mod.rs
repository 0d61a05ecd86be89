//! Terrain: from a tile map, drawn as seen from above and in front at once, to a landscape of blocks (terrain.md).
//!
//! Invariants: one unit is one tile; x grows to the right with the columns, y upwards, z towards the viewer; a point
//! at height y that is seen at row r lies at z = r + y.

mod column;
mod grid;
mod groups;
mod houses;
mod land;
mod levels;
mod map;
mod nodes;
mod notes;
mod reading;
mod solids;
mod surface;
mod ties;

pub use land::{Built, Group, Land, ROOF};
pub use map::{EDGE_BELOW, EDGE_RIGHT, MOST_CELLS, Map, Tile};
pub use nodes::node;
pub use notes::{Note, Open};
pub use reading::{Layer, TileLook, TileTexture, Tiles, cells_named, read};
