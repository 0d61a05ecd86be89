//! Hovers about tiles: kind, height and group.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec2;

use super::Analysis;
use super::hover::escaped;
use crate::bind::StringId;
use crate::geometry::contains;
use crate::svg::ShapeId;
use crate::terrain::{Layer, Tile};

/// The most cells that are examined for a hover; of larger shapes only the first.
const MAX_CELLS: usize = 1 << 14;
/// The most kinds of cells that are listed.
const MAX_KINDS: usize = 6;

/// A kind of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Cells {
    /// Ground or water: the group, and whether it is water.
    Top(usize, bool),
    /// A front.
    Front,
    /// Part of a house.
    House(usize, bool),
}

impl Analysis {
    /// Describes the landscape that a string names, if it names one.
    pub(super) fn landscape_card(&self, string: StringId) -> Option<String> {
        let mut layers = self.compiled().layers.iter();
        let layer = layers.find(|layer| layer.string == string)?;
        let group = self.drawing().groups[layer.group].element.describe();
        let water = layer.landscape.groups().filter(|group| group.water).count();
        let ground = layer.landscape.groups().count() - water;
        let houses = layer.landscape.houses().count();
        let heights = layer.landscape.groups().map(|group| group.height);
        let (low, high) = heights.fold((0, 0), |(low, high), height| {
            (height.min(low), height.max(high))
        });
        Some(format!(
            "**{}**, the landscape that {group} shows\n\n{} columns and {} rows of tiles of {}, from height {low} to {high}\n\nGroups of ground: {ground}, bodies of water: {water}, houses: {houses}",
            escaped(&layer.name),
            layer.map.columns,
            layer.map.rows,
            layer.size
        ))
    }

    /// Describes the tiles that a shape paints: their kinds, heights and groups. `None` if it paints none.
    pub(super) fn tiles_card(&self, shape: ShapeId) -> Option<String> {
        let layers = self.compiled().layers.iter();
        let mut all =
            layers.flat_map(|layer| layer.sources.iter().map(move |tiles| (layer, tiles)));
        let (layer, tiles) = all.find(|(_, tiles)| tiles.shape == shape)?;
        let mut out = format!("**Tiles** of {}", escaped(&layer.name));
        let (columns, rows) = (tiles.columns.clone(), tiles.rows.clone());
        let mut found: BTreeMap<Cells, (usize, [usize; 2], [i32; 2])> = BTreeMap::new();
        let outline = &self.drawing().shapes[shape].outline;
        let most = (MAX_CELLS / rows.len().max(1)).max(1);
        for column in columns.take(most) {
            let seen = layer.landscape.visible_heights(column);
            for row in rows.clone().take(MAX_CELLS) {
                let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * layer.size;
                let painted =
                    outline.polygons.is_empty() || contains(outline, layer.origin + middle);
                let Some(cells) = kind(layer, column, row).filter(|_| painted) else {
                    continue;
                };
                let height = seen[row].unwrap_or(0);
                let known = found
                    .entry(cells)
                    .or_insert((0, [column, row], [height; 2]));
                known.0 += 1;
                known.2 = [known.2[0].min(height), known.2[1].max(height)];
            }
        }
        if found.is_empty() {
            let _ = write!(out, "\n\nNo tile shows it: other shapes cover it.");
        }
        for (cells, (count, [column, row], [low, high])) in found.iter().take(MAX_KINDS) {
            let _ = write!(
                out,
                "\n\n- {}",
                described(layer, *cells, *count, [*low, *high])
            );
            let _ = write!(out, ", from column {}, row {} on", column + 1, row + 1);
        }
        if let Some(more) = found.len().checked_sub(MAX_KINDS).filter(|more| *more > 0) {
            let _ = write!(out, "\n\n… and {more} more groups");
        }
        Some(out)
    }
}

fn kind(layer: &Layer, column: usize, row: usize) -> Option<Cells> {
    let land = &layer.landscape;
    if let Some(group) = land.group_at(column, row) {
        let water = layer.map.tile(layer.map.index(column, row)) == Tile::Blue;
        return Some(Cells::Top(group, water));
    }
    match layer.map.tile(layer.map.index(column, row)) {
        Tile::Brown => Some(Cells::Front),
        Tile::Red => land
            .house_at(column, row)
            .map(|house| Cells::House(house, true)),
        Tile::Beige => land
            .house_at(column, row)
            .map(|house| Cells::House(house, false)),
        _ => None,
    }
}

fn described(layer: &Layer, cells: Cells, count: usize, [low, high]: [i32; 2]) -> String {
    let tiles = match count {
        1 => "1 tile".to_owned(),
        count => format!("{count} tiles"),
    };
    match cells {
        Cells::Top(group, water) => {
            let kind = if water { "water" } else { "ground" };
            let all = layer
                .landscape
                .groups()
                .nth(group)
                .map_or(count, |group| group.cells);
            format!("{tiles} of {kind} at height {high}, in a group of {all}")
        }
        Cells::Front => format!(
            "{tiles} of cliff, between the heights {low} and {}",
            high + 1
        ),
        Cells::House(house, roof) => {
            let what = if roof { "roof" } else { "wall" };
            let house = layer.landscape.houses().nth(house);
            let size = house.map_or(String::new(), |house| {
                format!(
                    " of a house {} wide, {} deep and {} high on ground at height {}",
                    house.width, house.depth, house.height, house.base
                )
            });
            format!("{tiles} of the {what}{size}")
        }
    }
}
