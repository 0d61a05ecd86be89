//! Groups: tiles of one kind that are connected through sides without an edge (terrain.md, rules 2, 4 and 8).

use rayon::prelude::*;

use super::grid::Grid;
use super::map::Tile;

/// What a group of tiles is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GroupKind {
    /// Nothing is drawn.
    Nothing,
    /// The top of ground or water: index of the surface.
    Surface(u32),
    /// The front of cliffs.
    Front,
    /// The roof of a house: index of the house.
    Roof(u32),
    /// The wall of a house: index of the house.
    Wall(u32),
}

impl GroupKind {
    /// The house that it is part of.
    pub(super) fn house(self) -> Option<u32> {
        match self {
            Self::Roof(house) | Self::Wall(house) => Some(house),
            _ => None,
        }
    }
}

/// The top of a group of ground, or a body of water.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Surface {
    pub(super) water: bool,
    /// The number of its cells; [`GROUND`] counts as larger than any other.
    pub(super) area: usize,
    /// Its first cell, column by column.
    pub(super) first: usize,
    /// Whether it runs to the border of the map.
    pub(super) at_border: bool,
}

/// The ground, at height 0.
pub(super) const GROUND: u32 = 0;

#[derive(Debug)]
pub(super) struct Groups {
    /// Per cell, column by column, its group. Groups of different kinds of tiles may belong to the same surface.
    pub(super) labels: Vec<u32>,
    /// Per group its kind. The first group is that of the empty cells.
    pub(super) kinds: Vec<GroupKind>,
    /// The surfaces; the first is the ground.
    pub(super) surfaces: Vec<Surface>,
    /// How many houses there are.
    pub(super) houses: usize,
    /// Groups that are read as tops although their colour is that of a house: the first cell and the number of cells of each.
    pub(super) plain: Vec<(usize, usize)>,
}

impl Groups {
    pub(super) fn new(grid: &Grid) -> Self {
        let (labels, firsts) = components(grid);
        let mut groups = Joined::new(grid, labels, &firsts);
        groups.join_houses();
        groups.join_tops();
        groups.finish()
    }

    /// The kind of the group that a cell belongs to.
    pub(super) fn kind(&self, cell: usize) -> GroupKind {
        self.kinds[self.labels[cell] as usize]
    }
}

/// Finds the representative of a set in a union-find forest, with path halving.
fn root(parents: &mut [u32], mut index: u32) -> u32 {
    while parents[index as usize] != index {
        let next = parents[parents[index as usize] as usize];
        parents[index as usize] = next;
        index = next;
    }
    index
}

fn join(parents: &mut [u32], one: u32, other: u32) {
    let (one, other) = (root(parents, one), root(parents, other));
    // The smaller index becomes the root, so that the result does not depend on the order.
    let (low, high) = (one.min(other), one.max(other));
    parents[high as usize] = low;
}

/// Labels connected cells of one kind (connected-component labelling by union-find), and gives the first cell of each label.
/// Label 0 is that of the empty cells.
fn components(grid: &Grid) -> (Vec<u32>, Vec<usize>) {
    let (columns, rows) = (grid.columns, grid.rows);
    let mut parents = vec![0_u32; columns * rows];
    if parents.is_empty() {
        return (parents, vec![0]);
    }
    let band = columns.div_ceil(rayon::current_num_threads() * 4).max(16);
    // Label each band by itself, in parallel…
    parents
        .par_chunks_mut(band * rows)
        .enumerate()
        .for_each(|(index, parents)| {
            let base = index * band * rows;
            for at in 0..parents.len() {
                let cell = base + at;
                let tile = grid.tile(cell);
                let row = cell % rows;
                let above = row > 0 && grid.tile(cell - 1) == tile && !grid.edge_below(cell - 1);
                parents[at] = if above { parents[at - 1] } else { at as u32 };
                let left =
                    at >= rows && grid.tile(cell - rows) == tile && !grid.edge_right(cell - rows);
                // Usually the pair of cells above has joined the two columns already.
                let known = above
                    && left
                    && grid.tile(cell - rows - 1) == tile
                    && !grid.edge_right(cell - rows - 1)
                    && !grid.edge_below(cell - rows - 1);
                if left && !known {
                    join(parents, at as u32, (at - rows) as u32);
                }
            }
            for at in 0..parents.len() {
                parents[at] = root(parents, at as u32);
            }
            let base = base as u32;
            parents.iter_mut().for_each(|parent| *parent += base);
        });
    // …then join the bands.
    for column in (band..columns).step_by(band) {
        for row in 0..rows {
            let (cell, left) = (column * rows + row, (column - 1) * rows + row);
            if grid.tile(cell) == grid.tile(left) && !grid.edge_right(left) {
                join(&mut parents, cell as u32, left as u32);
            }
        }
    }
    number(grid, parents)
}

/// Numbers the sets in the order of their first cells.
fn number(grid: &Grid, parents: Vec<u32>) -> (Vec<u32>, Vec<usize>) {
    let leads = |cell: usize| parents[cell] as usize == cell && grid.tile(cell) != Tile::None;
    let mut firsts = vec![usize::MAX];
    firsts.extend((0..parents.len()).filter(|cell| leads(*cell)));
    // A root's label is found by binary search; for most cells it is that of the cell before.
    let find = |cell: usize| {
        let mut lead = cell as u32;
        while parents[lead as usize] != lead {
            lead = parents[lead as usize];
        }
        lead as usize
    };
    let mut labels = vec![0_u32; parents.len()];
    labels
        .par_chunks_mut(grid.rows.max(1))
        .enumerate()
        .for_each(|(column, labels)| {
            let mut last = (usize::MAX, 0);
            for (row, label) in labels.iter_mut().enumerate() {
                let cell = column * grid.rows + row;
                if grid.tile(cell) == Tile::None {
                    continue;
                }
                let lead = find(cell);
                if last.0 != lead {
                    let index = firsts[1..].partition_point(|first| *first < lead) + 1;
                    last = (lead, index as u32);
                }
                *label = last.1;
            }
        });
    (labels, firsts)
}

/// Groups while they are joined to surfaces and houses.
struct Joined<'a> {
    grid: &'a Grid,
    labels: Vec<u32>,
    firsts: &'a [usize],
    /// Per group its parent in the union-find forest.
    parents: Vec<u32>,
    /// Per group whether it is part of a house.
    housed: Vec<bool>,
}

impl<'a> Joined<'a> {
    fn new(grid: &'a Grid, labels: Vec<u32>, firsts: &'a [usize]) -> Self {
        Self {
            grid,
            labels,
            firsts,
            parents: (0..firsts.len() as u32).collect(),
            housed: vec![false; firsts.len()],
        }
    }

    fn tile(&self, label: usize) -> Tile {
        match label {
            0 => Tile::None,
            label => self.grid.tile(self.firsts[label]),
        }
    }

    /// Joins roofs with the walls right below them to houses (rule 8).
    fn join_houses(&mut self) {
        let rows = self.grid.rows;
        for cell in 1..self.labels.len() {
            let pair = [self.grid.tile(cell - 1), self.grid.tile(cell)];
            if cell % rows != 0 && pair == [Tile::Red, Tile::Beige] {
                let [roof, wall] = [self.labels[cell - 1], self.labels[cell]];
                self.housed[roof as usize] = true;
                self.housed[wall as usize] = true;
                join(&mut self.parents, roof, wall);
            }
        }
    }

    /// Whether a group is a top: green, or a house's colour where there is no house (rule 9).
    fn is_top(&self, label: u32) -> bool {
        match self.tile(label as usize) {
            Tile::Green => true,
            Tile::Red | Tile::Beige => !self.housed[label as usize],
            _ => false,
        }
    }

    /// Joins paths and plazas with the ground around them.
    fn join_tops(&mut self) {
        let rows = self.grid.rows;
        let colored = |tile| matches!(tile, Tile::Red | Tile::Beige);
        if !(1..self.firsts.len()).any(|label| colored(self.tile(label)) && !self.housed[label]) {
            return;
        }
        for cell in 0..self.labels.len() {
            let label = self.labels[cell];
            if label == 0 || !self.is_top(label) {
                continue;
            }
            let below = (cell % rows + 1 < rows && !self.grid.edge_below(cell)).then_some(cell + 1);
            let right = cell + rows;
            let right = (right < self.labels.len() && !self.grid.edge_right(cell)).then_some(right);
            for other in [below, right].into_iter().flatten() {
                let other = self.labels[other];
                if other != label && other != 0 && self.is_top(other) {
                    join(&mut self.parents, label, other);
                }
            }
        }
    }

    fn finish(mut self) -> Groups {
        let (rows, count) = (self.grid.rows, self.firsts.len());
        let ground = Surface {
            water: false,
            area: usize::MAX,
            first: usize::MAX,
            at_border: true,
        };
        let mut surfaces = vec![ground];
        let mut kinds = vec![GroupKind::Nothing; count];
        let mut numbers = vec![u32::MAX; count];
        let (mut houses, mut plain) = (0_u32, vec![]);
        for (label, kind) in kinds.iter_mut().enumerate().skip(1) {
            let tile = self.tile(label);
            if tile == Tile::Brown {
                *kind = GroupKind::Front;
                continue;
            }
            let lead = root(&mut self.parents, label as u32) as usize;
            let surface = self.is_top(label as u32) || tile == Tile::Blue;
            if numbers[lead] == u32::MAX {
                numbers[lead] = if surface {
                    surfaces.push(Surface {
                        water: tile == Tile::Blue,
                        area: 0,
                        first: self.firsts[label],
                        at_border: false,
                    });
                    surfaces.len() as u32 - 1
                } else {
                    houses += 1;
                    houses - 1
                };
            }
            if surface && matches!(tile, Tile::Red | Tile::Beige) {
                plain.push(label);
            }
            let number = numbers[lead];
            *kind = match tile {
                _ if surface => GroupKind::Surface(number),
                Tile::Red => GroupKind::Roof(number),
                _ => GroupKind::Wall(number),
            };
        }
        let mut areas = vec![0_usize; count];
        let columns = self.grid.columns;
        for (column, labels) in self.labels.chunks(rows.max(1)).enumerate() {
            let side = column == 0 || column + 1 == columns;
            let mut row = 0;
            while row < rows {
                let label = labels[row];
                let run = labels[row..]
                    .iter()
                    .take_while(|next| **next == label)
                    .count();
                areas[label as usize] += run;
                if let GroupKind::Surface(surface) = kinds[label as usize] {
                    let surface = &mut surfaces[surface as usize];
                    surface.area += run;
                    surface.at_border |= side || row == 0 || row + run == rows;
                }
                row += run;
            }
        }
        let plain = plain
            .into_iter()
            .map(|label: usize| (self.firsts[label], areas[label]));
        let plain = plain.collect();
        Groups {
            labels: self.labels,
            kinds,
            surfaces,
            houses: houses as usize,
            plain,
        }
    }
}
