//! Terrain: landscapes of blocks from tile maps, which show tops and fronts at once.
//!
//! Invariants: one unit is one tile; x grows to the right with the columns, y upwards, z towards the viewer; a point
//! at height y that is visible at row r lies at z = r + y.

mod ambiguities;
mod backs;
mod column;
mod constraints;
mod flush;
mod grid;
mod ground;
mod groups;
mod hidden_houses;
mod houses;
mod landscape;
mod levels;
mod map;
mod nodes;
mod occlusion;
mod plain;
mod reading;
mod solids;
mod surface;
mod tiled;

pub use ambiguities::AmbiguityKind;
pub(crate) use ground::{Footing, Place};
pub use landscape::{DEFAULT_ROOF, HouseInfo, Landscape};
pub(crate) use map::MAX_CELLS;
pub use map::{EDGE_BELOW, EDGE_RIGHT, Map, Tile, UNSET};
pub(crate) use nodes::node;
pub(crate) use reading::{LandscapeId, Layer, LayerObject, TileMaterial, TileTexture, read};
