//! The map: what is drawn in each cell of a tile layer's grid.

/// The kinds of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Tile {
    /// Nothing is drawn there.
    #[default]
    None,
    /// The top of ground.
    Green,
    /// The front of a cliff.
    Brown,
    /// Water.
    Blue,
    /// A roof.
    Red,
    /// The wall of a house.
    Beige,
}

impl Tile {
    /// All kinds except [`Tile::None`], in the order of the manual.
    pub const DRAWN: [Self; 5] = [Self::Green, Self::Brown, Self::Blue, Self::Red, Self::Beige];

    /// Its name in the language.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Green => "green",
            Self::Brown => "brown",
            Self::Blue => "blue",
            Self::Red => "red",
            Self::Beige => "beige",
        }
    }

    /// Its default colour, sRGB.
    pub fn color(self) -> [u8; 3] {
        match self {
            Self::None => [0; 3],
            Self::Green => [0x4c, 0xaf, 0x50],
            Self::Brown => [0x8d, 0x6e, 0x63],
            Self::Blue => [0x42, 0xa5, 0xf5],
            Self::Red => [0xe5, 0x39, 0x35],
            Self::Beige => [0xf5, 0xde, 0xb3],
        }
    }
}

/// There is an edge between a cell and the one to its right.
pub const EDGE_RIGHT: u8 = 1;
/// There is an edge between a cell and the one below it.
pub const EDGE_BELOW: u8 = 2;

/// The height of a cell to which nothing gives one.
pub const UNSET: i8 = i8::MIN;

/// The largest number of cells in a map.
pub(crate) const MAX_CELLS: usize = 1 << 26;

/// A tile map. Rows count from the top, towards the viewer; columns from the left.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// The number of columns.
    pub columns: usize,
    /// The number of rows.
    pub rows: usize,
    /// Per cell, row by row, the index of its material.
    pub cells: Vec<u8>,
    /// Per material the kind of tile; the first is [`Tile::None`], and no other is.
    pub tiles: Vec<Tile>,
    /// Per cell [`EDGE_RIGHT`] and [`EDGE_BELOW`].
    pub edges: Vec<u8>,
    /// Per cell its height, or [`UNSET`], if the map is plain, which is seen from straight above; empty in the drawn look.
    pub heights: Vec<i8>,
    /// The pictures of the tops of a plain map, if they have any.
    pub(crate) pictures: Option<CellPictures>,
}

/// The pictures on the tops of cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CellPictures {
    /// The material that shows them.
    pub(crate) material: u8,
    pub(crate) grid: PictureGrid,
    /// Per cell the place of its picture, from 1; 0 for cells that show their own material.
    pub(crate) places: Vec<u16>,
}

/// Pictures of one size, side by side in one picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PictureGrid {
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    /// Width and height of each, pixels.
    pub(crate) side: [u32; 2],
    /// How far each is continued around itself, pixels.
    pub(crate) margin: u32,
}

impl PictureGrid {
    /// Texture coordinates of a point of the picture at a place, from 1; the point goes from 0 to 1 to the right and down.
    pub(crate) fn uv(&self, place: u16, point: [f64; 2]) -> [f64; 2] {
        let number = u32::from(place.max(1)) - 1;
        let at = [number % self.columns, number / self.columns];
        let count = [self.columns, self.rows];
        [0, 1].map(|axis| {
            let [side, margin] = [self.side[axis], self.margin].map(f64::from);
            let step = side + 2.0 * margin;
            let pixel = f64::from(at[axis]) * step + margin + point[axis].clamp(0.0, 1.0) * side;
            pixel / (f64::from(count[axis]) * step)
        })
    }
}

impl Map {
    /// A map of empty cells with a material for each kind, in the order of [`Tile::DRAWN`].
    pub fn empty(columns: usize, rows: usize) -> Self {
        let mut tiles = vec![Tile::None];
        tiles.extend(Tile::DRAWN);
        Self {
            columns,
            rows,
            cells: vec![0; columns * rows],
            tiles,
            edges: vec![0; columns * rows],
            heights: vec![],
            pictures: None,
        }
    }

    /// The index of a cell.
    pub fn index(&self, column: usize, row: usize) -> usize {
        row * self.columns + column
    }

    /// Whether it is seen from straight above, with a height for each cell.
    pub fn is_plain(&self) -> bool {
        !self.heights.is_empty()
    }

    /// The kind of tile in a cell.
    pub fn tile(&self, cell: usize) -> Tile {
        self.tiles[usize::from(self.cells[cell])]
    }
}
