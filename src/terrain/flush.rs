//! Fronts that end flush with what is behind them.

use super::column::{Below, Column};
use super::grid::Grid;
use super::groups::{GroupKind, Groups};
use super::levels::Levels;
use super::map::Tile;

/// Per group of fronts its lowest row, if it ends flush with what is behind it: it has an edge to another front, and all its
/// columns hang (rule 6).
pub(super) fn flush(grid: &Grid, groups: &Groups, levels: &Levels) -> Vec<Option<i32>> {
    let mut lowest = vec![None::<i32>; groups.kinds.len()];
    let rows = grid.rows;
    let front = |cell: usize| grid.tile(cell) == Tile::Brown;
    if !grid.edges.iter().any(|edges| *edges != 0) {
        return lowest;
    }
    for cell in 0..groups.labels.len() {
        if !front(cell) {
            continue;
        }
        let below = (cell % rows + 1 < rows && grid.edge_below(cell)).then_some(cell + 1);
        let right = cell + rows;
        let right = (right < groups.labels.len() && grid.edge_right(cell)).then_some(right);
        for other in [below, right].into_iter().flatten() {
            let [one, other] = [cell, other].map(|cell| groups.labels[cell] as usize);
            if one != other && groups.kinds[other] == GroupKind::Front {
                lowest[one].get_or_insert(0);
                lowest[other].get_or_insert(0);
            }
        }
    }
    let mut column = Column::default();
    for number in 0..grid.columns {
        column.read(grid, groups, number);
        for index in 0..column.segments.len() {
            let segment = column.segments[index];
            if segment.kind != GroupKind::Front {
                continue;
            }
            let cells =
                number * rows + segment.start as usize..number * rows + segment.end as usize;
            let hangs = hangs(&column, levels, index);
            for cell in cells {
                let label = groups.labels[cell] as usize;
                if let Some(low) = &mut lowest[label] {
                    // A group that stands on something in any column is not filled.
                    *low = if hangs && *low >= 0 {
                        (*low).max((cell % rows) as i32)
                    } else {
                        -1
                    };
                }
            }
        }
    }
    lowest
        .iter_mut()
        .for_each(|low| *low = low.filter(|low| *low >= 0));
    lowest
}

/// Whether a front's foot is visibly above what lies below it.
fn hangs(column: &Column, levels: &Levels, front: usize) -> bool {
    let above = front
        .checked_sub(1)
        .map(|above| column.segments[above].kind);
    let Some(GroupKind::Surface(surface)) = above else {
        return false;
    };
    let foot = levels.level[surface as usize] - column.segments[front].rows();
    match column.below(front - 1) {
        (_, Below::Surface(below), _) => foot > levels.level[below as usize],
        (_, Below::House(_), _) => false,
    }
}
