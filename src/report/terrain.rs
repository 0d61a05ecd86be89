//! The landscapes of a drawing.

use serde::Serialize;

use crate::compile::Compiled;

/// A landscape. All lengths are tiles.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Terrain<'a> {
    /// Its name.
    pub name: &'a str,
    /// Columns and rows of its map.
    pub size: [usize; 2],
    /// The side of a tile, drawing units.
    pub tile: f64,
    /// Per row and cell the height of the top that is drawn there, ground or water.
    pub tops: Vec<Vec<Option<i32>>>,
    /// The groups of ground and the bodies of water.
    pub groups: Vec<Group>,
    /// The houses.
    pub houses: Vec<House>,
    /// What stands on it.
    pub props: Vec<Prop<'a>>,
}

/// A group of ground or a body of water.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Group {
    /// `ground` or `water`.
    pub kind: &'static str,
    /// Its height.
    pub height: i32,
    /// How many cells it has.
    pub cells: usize,
    /// Column and row of one of its cells, counted from 1.
    pub cell: [usize; 2],
}

/// A house.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct House {
    /// The height of its floor.
    pub base: i32,
    /// The width of its walls.
    pub width: i32,
    /// The depth from front to back.
    pub depth: i32,
    /// The height of its walls.
    pub height: i32,
    /// The height of its ridge.
    pub ridge: f64,
}

/// A prop.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Prop<'a> {
    /// Its name.
    pub name: &'a str,
    /// What its foot is drawn on: `ground`, `roof`, `water`, `front`, `outside`.
    pub on: &'static str,
    /// Column and row of that cell, counted from 1; `None` beside the map.
    pub cell: Option<[usize; 2]>,
    /// The height on which it stands.
    pub height: f64,
    /// The first prop with the same mesh, if it is not the first one itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub same_as: Option<&'a str>,
}

/// What stands on a landscape.
fn props(compiled: &Compiled, landscape: usize) -> Vec<Prop<'_>> {
    let bindings = &compiled.bindings;
    let name = |index: usize| &*bindings.parts[bindings.props[index].main].name;
    let all = compiled.props.iter().enumerate();
    let own = all.filter(|(_, standing)| usize::from(standing.landscape) == landscape);
    own.map(|(index, standing)| Prop {
        name: name(index),
        on: standing.place.footing.name(),
        cell: standing.place.cell.map(|cell| cell.map(|at| at + 1)),
        height: standing.place.point.y,
        same_as: Some(bindings.props[index].like)
            .filter(|like| *like != index)
            .map(name),
    })
    .collect()
}

/// The landscapes of a drawing.
pub(crate) fn terrain(compiled: &Compiled) -> Vec<Terrain<'_>> {
    let layers = compiled.layers.iter().enumerate();
    let report = layers.map(|(index, layer)| {
        let (map, land) = (&layer.map, &layer.landscape);
        let tops = (0..map.rows).map(|row| {
            let columns = 0..map.columns;
            columns.map(|column| land.top(column, row)).collect()
        });
        let groups = land.groups().map(|group| Group {
            kind: if group.water { "water" } else { "ground" },
            height: group.height,
            cells: group.cells,
            cell: group.first.map(|at| at + 1),
        });
        let houses = land.houses().map(|house| House {
            base: house.base,
            width: house.width,
            depth: house.depth,
            height: house.height,
            ridge: house.ridge(layer.roof),
        });
        Terrain {
            name: &layer.name,
            size: [map.columns, map.rows],
            tile: layer.size,
            tops: tops.collect(),
            groups: groups.collect(),
            houses: houses.collect(),
            props: props(compiled, index),
        }
    });
    report.collect()
}
