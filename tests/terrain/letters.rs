//! Tile maps as letters.

use okoshi::internals::terrain::{EDGE_BELOW, EDGE_RIGHT, Map};

/// The material of water in these maps.
pub(crate) const WATER: u8 = 3;

/// A map from lines of letters: `g b w R B` for green, brown, blue, red and beige, a dot for nothing. Between letters stands
/// `|` for an edge or a space; a line that begins with `:` says by `-` below which letters of the line before there is an edge.
pub(crate) fn map(lines: &str) -> Map {
    let lines: Vec<&str> = lines
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect();
    let rows: Vec<&&str> = lines.iter().filter(|line| !line.starts_with(':')).collect();
    let columns = rows
        .iter()
        .map(|row| row.len().div_ceil(2))
        .max()
        .unwrap_or(0);
    let mut map = Map::empty(columns, rows.len());
    let mut row = 0;
    for line in &lines {
        let edges = line.strip_prefix(':');
        for (at, letter) in edges.unwrap_or(line).chars().enumerate() {
            let column = at / 2;
            match (edges, letter) {
                (Some(_), '-') => {
                    let cell = map.index(column, row - 1);
                    map.edges[cell] |= EDGE_BELOW;
                }
                (None, '|') => {
                    let cell = map.index(column, row);
                    map.edges[cell] |= EDGE_RIGHT;
                }
                (None, letter) if at % 2 == 0 => {
                    let look = ".gbwRB".find(letter).expect("a letter of a tile");
                    let cell = map.index(column, row);
                    map.cells[cell] = look as u8;
                }
                _ => {}
            }
        }
        row += usize::from(edges.is_none());
    }
    map
}
