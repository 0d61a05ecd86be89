//! Houses whose walls are hidden (rule 9): only their roofs are seen, behind something nearer.

use std::cmp::Reverse;

use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::houses::House;
use super::occlusion::{View, Visible, wall_seen};
use super::solids::{Block, MapContext, Solids};

/// A roof whose wall may be hidden by what is drawn below it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct HiddenHouse {
    /// The index of its house.
    pub(super) house: u32,
    /// Its first cell.
    pub(super) first: usize,
    /// The surfaces drawn behind and beside it, on one of which it stands; none if it stands on the ground.
    pub(super) around: Vec<u32>,
}

/// A place where a house may stand: the height of its floor, down to which height there is ground below it, and its material.
type Place = (i32, Option<(i32, u8)>);

/// How often the rows below roofs are looked at, for each cell of the map.
const EFFORT: usize = 4;

/// Gives houses without visible walls their size: the walls are as high as those of the nearest house, as far as they stay hidden.
/// Gives the first cells of the roofs that cannot be such houses, because nothing nearer would hide a wall of even one tile.
/// `beige` is the material of walls where there is no other house.
pub(super) fn measure(context: &mut MapContext, beige: Option<u8>) -> Vec<usize> {
    let mut refused = vec![];
    let mut hidden = std::mem::take(&mut context.groups.hidden);
    // The nearer one hides the farther one, so its height must be known first.
    hidden.sort_by_key(|hidden| {
        let house = &context.houses[hidden.house as usize];
        (Reverse(house.front), hidden.house)
    });
    let middle = |house: &House| {
        let [left, right] = [house.roof.start, house.roof.end].map(f64::from);
        [(left + right) / 2.0, f64::from(house.front - house.eaves())]
    };
    let walled = context.houses.iter().enumerate();
    let walled = walled.filter(|(_, house)| !house.walls.is_empty());
    let walled = walled.map(|(index, house)| GeomWithData::new(middle(house), index));
    let walled = RTree::bulk_load(walled.collect());
    let mut columns = Columns {
        views: vec![None; context.grid.columns],
        left: EFFORT.saturating_mul(context.grid.cells.len()),
    };
    for hidden in &hidden {
        let house = &context.houses[hidden.house as usize];
        let neighbour = walled.nearest_neighbor(middle(house));
        let neighbour = neighbour.map(|neighbour| &context.houses[neighbour.data]);
        let wanted = neighbour.map_or(1, |neighbour| neighbour.height);
        let wall = neighbour.map(|neighbour| neighbour.materials[1]).or(beige);
        let sized = places(context, hidden).into_iter().find_map(|place| {
            let highest = columns.top_below(context, house) - place.0;
            let mut heights = (1..=wanted.min(highest)).rev();
            let height = heights
                .find(|height| columns.rows_hidden(context, house, place.0 + height) >= *height);
            height.map(|height| (place, height))
        });
        let Some(((base, ground), height)) = sized else {
            refused.push(hidden.first);
            continue;
        };
        let rows = columns.rows_hidden(context, house, base + height);
        columns.raise(house, base + height);
        let side = context.earth;
        let house = &mut context.houses[hidden.house as usize];
        house.front += base + height;
        (house.base, house.height) = (base, height);
        house.walls = house.roof.clone();
        house.materials[1] = wall.unwrap_or(house.materials[0]);
        house.under = ground.map(|(bottom, top)| Block {
            z: [house.back(), house.front],
            y: [bottom.max(house.eaves() - rows).min(base), base],
            top: Some(top),
            side: side.unwrap_or(top),
        });
    }
    context.groups.hidden = hidden;
    refused
}

/// Where a house may stand, the highest first.
fn places(context: &MapContext, hidden: &HiddenHouse) -> Vec<Place> {
    let levels = &context.levels;
    let place = |surface: &u32| {
        let first = context.groups.surfaces[*surface as usize].first;
        let [level, base] = [&levels.level, &levels.base].map(|of| of[*surface as usize]);
        (level, Some((base, context.grid.cells[first])))
    };
    let mut places: Vec<Place> = hidden.around.iter().map(place).collect();
    if places.is_empty() {
        places.push((0, None));
    }
    places.sort_unstable_by(|one, other| other.cmp(one));
    places
}

/// What is visible in columns, read when it is asked for.
struct Columns {
    views: Vec<Option<Vec<View>>>,
    /// How many more times a column may be looked at.
    left: usize,
}

impl Columns {
    /// What is visible in a column from a row on; nothing if the map has been looked at too often.
    fn below(&mut self, context: &MapContext, column: i32, row: i32) -> &[View] {
        let Some(left) = self.left.checked_sub(1) else {
            return &[];
        };
        self.left = left;
        let views = self.views[column as usize].get_or_insert_with(|| {
            let mut solids = Solids::default();
            solids.read_views(context, column as usize);
            solids.views
        });
        &views[views.partition_point(|view| view.end <= row)..]
    }

    /// The height of the lowest top or eaves right below a roof.
    fn top_below(&mut self, context: &MapContext, house: &House) -> i32 {
        let tops = house.roof.clone().map(|column| {
            let views = self.below(context, column, house.front);
            views.first().map_or(0, |view| match view.visible {
                Visible::Top(level) | Visible::Roof(level) => level,
                Visible::Front(plane) => plane - house.front,
                Visible::Nothing => 0,
            })
        });
        tops.min().unwrap_or(0)
    }

    /// How many rows below a roof are hidden in all of its columns by something nearer than its wall, if the eaves are at a height.
    /// The front of the house is still that of eaves at height 0.
    fn rows_hidden(&mut self, context: &MapContext, house: &House, eaves: i32) -> i32 {
        let row = house.front;
        let rows = house.roof.clone().map(|column| {
            let views = self.below(context, column, row);
            wall_seen(views, row, row + eaves) - row
        });
        rows.min().unwrap_or(0)
    }

    /// Sets the height of a roof's eaves.
    fn raise(&mut self, house: &House, eaves: i32) {
        for column in house.roof.clone() {
            let Some(views) = &mut self.views[column as usize] else {
                continue;
            };
            let at = views.partition_point(|view| view.end < house.front);
            if let Some(View { visible, .. }) = views.get_mut(at)
                && matches!(visible, Visible::Roof(_))
            {
                *visible = Visible::Roof(eaves);
            }
        }
    }
}
