//! Which regions lie inside of which others.

use super::canvas::Color;
use super::components::components;

/// Regions with a smaller alpha show what is behind them, in steps of 1/255.
const OPAQUE: f32 = 0.98 * 255.0;

/// How the regions of a picture lie inside of each other.
#[derive(Debug)]
pub(super) struct Nesting {
    /// By label, the labels of all regions that it encloses, in ascending order.
    pub(super) enclosed: Vec<Vec<u16>>,
    /// By label, the smallest region around it.
    pub(super) container: Vec<Option<u16>>,
    /// By label, how many regions are around it.
    pub(super) depth: Vec<usize>,
    /// By label, the pixels of the region and of all that it encloses.
    pub(super) extent: Vec<usize>,
}

/// Finds which regions enclose which: those that no path leaves but through the region, where paths take corners too.
pub(super) fn nesting(labels: &[u16], width: usize, count: usize) -> Nesting {
    let (nodes, ids) = components(labels, width);
    let neighbors = adjacency(&ids, width, nodes.len());
    let outside = ids.first().map_or(0, |id| *id as usize);
    let mut result = Nesting {
        enclosed: vec![Vec::new(); count],
        container: vec![None; count],
        depth: vec![0; count],
        extent: vec![0; count],
    };
    for (id, node) in nodes.iter().enumerate().filter(|(_, node)| node.class > 0) {
        let label = usize::from(node.class);
        let mut is_reached = vec![false; nodes.len()];
        is_reached[id] = true;
        is_reached[outside] = true;
        let mut stack = vec![outside];
        while let Some(at) = stack.pop() {
            for &next in &neighbors[at] {
                if !std::mem::replace(&mut is_reached[next as usize], true) {
                    stack.push(next as usize);
                }
            }
        }
        result.extent[label] += node.area;
        for inner in (0..nodes.len()).filter(|inner| !is_reached[*inner]) {
            result.extent[label] += nodes[inner].area;
            if nodes[inner].class > 0 {
                result.enclosed[label].push(nodes[inner].class);
            }
        }
        result.enclosed[label].sort_unstable();
    }
    for outer in 1..count {
        for &inner in &result.enclosed[outer] {
            let inner = usize::from(inner);
            result.depth[inner] += 1;
            let is_smaller = |other: u16| result.extent[outer] < result.extent[usize::from(other)];
            if result.container[inner].is_none_or(is_smaller) {
                result.container[inner] = Some(outer as u16);
            }
        }
    }
    result
}

/// Whether what is behind a region cannot be seen.
pub(super) fn is_opaque(color: Color) -> bool {
    color[3] >= OPAQUE
}

/// By component, those that touch it at an edge or a corner.
fn adjacency(ids: &[u32], width: usize, count: usize) -> Vec<Vec<u32>> {
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    let mut last = (0, 0);
    let mut add = |a: u32, b: u32| {
        let pair = (a.min(b), a.max(b));
        if a != b && pair != last {
            pairs.push(pair);
            last = pair;
        }
    };
    for at in 0..ids.len().saturating_sub(width) {
        if at % width + 1 == width {
            continue;
        }
        let cell = [ids[at], ids[at + 1], ids[at + width], ids[at + width + 1]];
        if cell[1..] == [cell[0]; 3] {
            continue;
        }
        for (first, second) in [(0, 1), (0, 2), (0, 3), (1, 2)] {
            add(cell[first], cell[second]);
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let mut neighbors = vec![Vec::new(); count];
    for (a, b) in pairs {
        neighbors[a as usize].push(b);
        neighbors[b as usize].push(a);
    }
    neighbors
}
