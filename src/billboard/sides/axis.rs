//! The upright line about which a view from the front is symmetric, whatever lies on one side only.
//!
//! Outlines vote: each for the middle of its own box, and each two that may be images of each other for the middle between them. Of the
//! lines for which most area votes, the one is taken about which most of the drawing on a grid is its own mirror image. A stick in one
//! hand has no partner there, so it moves nothing.

use glam::DVec2;
use typed_index_collections::{TiSlice, TiVec};

use super::grid::{Colors, Grid, is_alike};
use crate::billboard::region::{Region, RegionId, View};
use crate::geometry::bounds;

// Lengths are shares of the height of the view.

/// The largest regions alone vote.
const VOTERS: usize = 96;
/// Two regions may be images of each other if their areas and the sides of their boxes differ by at most this share of the larger …
const ALIKE: f64 = 0.12;
/// … and their boxes' middles are at most so far apart upwards.
const LEVEL: f64 = 0.02;
/// Votes count for lines that are nearer than this, the more the nearer they are.
const NEAR: f64 = 0.01;
/// Votes this near are for the same line.
const SAME: f64 = 0.002;
/// How many lines are compared on the grid.
const COMPARED: usize = 24;
/// A line this near to the middle of the whole view is that middle.
const MIDDLE: f64 = 0.003;

/// A place across, and the area that votes for it, drawing units.
#[derive(Debug, Clone, Copy)]
struct Vote {
    x: f64,
    weight: f64,
}

/// The place across of the axis of symmetry, drawing units: that of the line about which the view is most symmetric, even if it hardly
/// is. 0 for a view that shows nothing. `areas` are those of the regions.
pub(super) fn axis(view: &View, areas: &TiSlice<RegionId, f64>) -> f64 {
    let Some((low, high)) = view.bounds() else {
        return 0.0;
    };
    let middle = (low.x + high.x) / 2.0;
    let height = high.y - low.y;
    let Some(grid) = Grid::new(view).filter(|_| height > 0.0) else {
        return middle;
    };
    let votes = votes(view, areas, height);
    let colors = Colors::new(&grid, view);
    let mut best = (colors.mirrored(middle), middle);
    for line in lines(&votes, NEAR * height) {
        let mirrored = colors.mirrored(line);
        if mirrored > best.0 {
            best = (mirrored, line);
        }
    }
    let axis = median(&votes, best.1, SAME * height).unwrap_or(best.1);
    if (axis - middle).abs() < MIDDLE * height {
        middle
    } else {
        axis
    }
}

/// The votes of the largest regions, from left to right.
fn votes(view: &View, areas: &TiSlice<RegionId, f64>, height: f64) -> Vec<Vote> {
    let boxes: TiVec<RegionId, Option<(DVec2, DVec2)>> =
        view.regions.iter().map(|r| bounds(&r.outline)).collect();
    let mut voters: Vec<RegionId> = view.regions.keys().collect();
    voters.retain(|id| boxes[*id].is_some() && areas[*id] > 0.0);
    voters.sort_by(|a, b| areas[*b].total_cmp(&areas[*a]));
    voters.truncate(VOTERS);
    let is_equal = |a: f64, b: f64| (a - b).abs() <= ALIKE * a.max(b);
    let mut votes: Vec<Vote> = Vec::new();
    for (index, &one) in voters.iter().enumerate() {
        let Some((low, high)) = boxes[one] else {
            continue;
        };
        let (at, size) = ((low + high) / 2.0, high - low);
        votes.push(Vote {
            x: at.x,
            weight: areas[one],
        });
        for &other in &voters[index + 1..] {
            let Some((low, high)) = boxes[other] else {
                continue;
            };
            let (of_other, size_of_other) = ((low + high) / 2.0, high - low);
            let [first, second]: [&Region; 2] = [one, other].map(|id| &view.regions[id]);
            let fits = first.is_line == second.is_line
                && is_alike(first.color, second.color)
                && (at.y - of_other.y).abs() <= LEVEL * height
                && is_equal(areas[one], areas[other])
                && is_equal(size.x, size_of_other.x)
                && is_equal(size.y, size_of_other.y);
            if fits {
                votes.push(Vote {
                    x: (at.x + of_other.x) / 2.0,
                    weight: areas[one] + areas[other],
                });
            }
        }
    }
    votes.sort_by(|a, b| a.x.total_cmp(&b.x));
    votes
}

/// The lines for which most area votes, those first; no two of them are nearer to each other than `near`.
fn lines(votes: &[Vote], near: f64) -> Vec<f64> {
    let within = |x: f64| {
        let first = votes.partition_point(|vote| vote.x <= x - near);
        let end = votes.partition_point(|vote| vote.x < x + near);
        let votes = votes[first..end].iter();
        let weight = |vote: &Vote| vote.weight * (1.0 - (vote.x - x).abs() / near);
        votes.map(weight).sum::<f64>()
    };
    let mut all: Vec<Vote> = votes
        .iter()
        .map(|vote| Vote {
            x: vote.x,
            weight: within(vote.x),
        })
        .collect();
    all.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let mut lines: Vec<f64> = Vec::new();
    for Vote { x, .. } in all {
        if lines.len() == COMPARED {
            break;
        }
        if lines.iter().all(|line| (line - x).abs() >= near) {
            lines.push(x);
        }
    }
    lines
}

/// The place between the votes that are near to a line, of which half of the area lies on each side; `None` without such a vote.
fn median(votes: &[Vote], line: f64, near: f64) -> Option<f64> {
    let of_line = || votes.iter().filter(|vote| (vote.x - line).abs() <= near);
    let all: f64 = of_line().map(|vote| vote.weight).sum();
    let mut seen = 0.0;
    let mut of_half = of_line().filter(|vote| {
        seen += vote.weight;
        2.0 * seen >= all
    });
    of_half.next().map(|vote| vote.x)
}
