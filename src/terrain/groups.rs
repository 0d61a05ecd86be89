//! Groups: tiles of one kind that are connected through sides without an edge.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::Grid;
use super::hidden_houses::HiddenHouse;
use super::map::Tile;
use crate::regions::{connected, join, root};

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
    /// Roofs whose walls may be hidden.
    pub(super) hidden: Vec<HiddenHouse>,
}

impl Groups {
    /// The groups of a map. Roofs without walls whose first cell passes the test `is_plain` are tops in any case.
    pub(super) fn new(grid: &Grid, is_plain: impl Fn(usize) -> bool) -> Self {
        let (labels, firsts) = components(grid);
        let mut groups = Joined::new(grid, labels, &firsts);
        groups.join_houses();
        groups.find_hidden(is_plain);
        groups.join_tops();
        groups.finish()
    }

    /// The kind of the group that a cell belongs to.
    pub(super) fn kind(&self, cell: usize) -> GroupKind {
        self.kinds[self.labels[cell] as usize]
    }
}

/// Labels connected cells of one kind, and gives the first cell of each label. Label 0 is that of the empty cells.
fn components(grid: &Grid) -> (Vec<u32>, Vec<usize>) {
    let rows = grid.rows;
    let is_member = |cell: usize| grid.tile(cell) != Tile::None;
    let below = |cell: usize| grid.tile(cell - 1) == grid.tile(cell) && !grid.edge_below(cell - 1);
    let right =
        |cell: usize| grid.tile(cell - rows) == grid.tile(cell) && !grid.edge_right(cell - rows);
    let labels = connected(grid.columns * rows, rows, 1, is_member, below, right);
    let firsts = std::iter::once(usize::MAX).chain(labels.firsts);
    (labels.of, firsts.collect())
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
    /// The roofs whose walls may be hidden, each with the groups of ground and water behind and beside it.
    hidden: BTreeMap<u32, BTreeSet<u32>>,
}

impl<'a> Joined<'a> {
    fn new(grid: &'a Grid, labels: Vec<u32>, firsts: &'a [usize]) -> Self {
        Self {
            grid,
            labels,
            firsts,
            parents: (0..firsts.len() as u32).collect(),
            housed: vec![false; firsts.len()],
            hidden: BTreeMap::new(),
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

    /// Finds the roofs without walls that may have a wall behind something nearer (rule 9): below all of their columns is ground,
    /// water or a roof, and none of that is also behind or beside them, as it is around a path or a plaza.
    fn find_hidden(&mut self, is_plain: impl Fn(usize) -> bool) {
        let rows = self.grid.rows;
        let is_roof = |groups: &Self, label: usize| {
            groups.tile(label) == Tile::Red
                && !groups.housed[label]
                && !is_plain(groups.firsts[label])
        };
        if !(1..self.firsts.len()).any(|label| is_roof(self, label)) {
            return;
        }
        /// What is around a roof and below it; `None` if there is no surface below one of its columns.
        type Sides = (BTreeSet<u32>, Option<BTreeSet<u32>>);
        let mut roofs: BTreeMap<u32, Sides> = BTreeMap::new();
        for (cell, label) in self.labels.iter().enumerate() {
            if !is_roof(self, *label as usize) {
                continue;
            }
            let (around, below) = roofs
                .entry(*label)
                .or_insert_with(|| (BTreeSet::new(), Some(BTreeSet::new())));
            let row = cell % rows;
            let is_surface =
                |other: &u32| matches!(self.tile(*other as usize), Tile::Green | Tile::Blue);
            let sides = [
                (row > 0).then(|| cell - 1),
                cell.checked_sub(rows),
                Some(cell + rows).filter(|cell| *cell < self.labels.len()),
            ];
            let sides = sides.into_iter().flatten().map(|cell| self.labels[cell]);
            around.extend(sides.filter(is_surface));
            let next = (row + 1 < rows).then(|| self.labels[cell + 1]);
            match next {
                Some(next) if next == *label => {}
                Some(next) if is_surface(&next) || self.tile(next as usize) == Tile::Red => {
                    below.iter_mut().for_each(|below| {
                        below.insert(next);
                    });
                }
                _ => *below = None,
            }
        }
        for (label, (around, below)) in roofs {
            if below.is_some_and(|below| below.is_disjoint(&around)) {
                self.housed[label as usize] = true;
                self.hidden.insert(label, around);
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
        let hidden = self.hidden.iter().filter_map(|(label, around)| {
            let around = around
                .iter()
                .filter_map(|around| match kinds[*around as usize] {
                    GroupKind::Surface(surface) => Some(surface),
                    _ => None,
                });
            let around: BTreeSet<u32> = around.collect();
            Some(HiddenHouse {
                house: kinds[*label as usize].house()?,
                first: self.firsts[*label as usize],
                around: around.into_iter().collect(),
            })
        });
        let hidden = hidden.collect();
        Groups {
            labels: self.labels,
            hidden,
            kinds,
            surfaces,
            houses: houses as usize,
            plain,
        }
    }
}
