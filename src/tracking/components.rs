//! Connected components of pixels with weights.

use glam::DVec2;

use crate::regions::{Span, connected_runs};

/// Pixels of a row beside each other, with their weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    pub(super) span: Span,
    /// The sum of the pixels' weights.
    pub(super) weight: f64,
    /// The sum of their columns, weighted.
    pub(super) moment: f64,
    /// The sum of what else is known about their colours, weighted.
    pub(super) tint: DVec2,
}

/// Pixels that are connected, also by corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Component {
    /// The number of pixels.
    pub(super) area: f64,
    /// The sum of their weights.
    pub(super) weight: f64,
    /// Their weighted middle.
    pub(super) middle: DVec2,
    /// The weighted mean of what else is known about their colours.
    pub(super) tint: DVec2,
    /// The first column and row.
    pub(super) least: [u32; 2],
    /// The last column and row.
    pub(super) most: [u32; 2],
}

/// Adds a pixel after those before it, in the order of rows and columns.
pub(super) fn push_pixel(runs: &mut Vec<Run>, x: u32, y: u32, weight: f64, tint: DVec2) {
    let moment = weight * f64::from(x);
    if let Some(run) = runs.last_mut()
        && run.span.extend(x, y)
    {
        run.weight += weight;
        run.moment += moment;
        run.tint += weight * tint;
        return;
    }
    runs.push(Run {
        span: Span::pixel(x, y),
        weight,
        moment,
        tint: weight * tint,
    });
}

/// The components of runs that are sorted by row and column, do not overlap and have weights, in the order of their first runs.
pub(super) fn components(runs: &[Run]) -> Vec<Component> {
    let (labels, count) = connected_runs(runs, |run| run.span);
    let mut components: Vec<Component> = Vec::with_capacity(count);
    for (run, label) in runs.iter().zip(labels) {
        let Span { y, from, to } = run.span;
        if label as usize == components.len() {
            components.push(Component {
                area: 0.0,
                weight: 0.0,
                middle: DVec2::ZERO,
                tint: DVec2::ZERO,
                least: [from, y],
                most: [from, y],
            });
        }
        let component = &mut components[label as usize];
        component.area += f64::from(to - from);
        component.weight += run.weight;
        // A sum, until all runs are in it.
        component.middle += DVec2::new(run.moment, run.weight * f64::from(y));
        component.tint += run.tint;
        component.least[0] = component.least[0].min(from);
        component.most = [component.most[0].max(to - 1), y];
    }
    for component in &mut components {
        component.middle /= component.weight;
        component.tint /= component.weight;
    }
    components
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The runs of a picture; pixels that are set have weight 1.
    fn runs(rows: &[Vec<bool>]) -> Vec<Run> {
        let mut runs = Vec::new();
        for (y, row) in rows.iter().enumerate() {
            for (x, _) in row.iter().enumerate().filter(|(_, set)| **set) {
                push_pixel(&mut runs, x as u32, y as u32, 1.0, DVec2::ZERO);
            }
        }
        runs
    }

    /// The sizes of the components by filling, in the order of their first pixels.
    fn filled(mut rows: Vec<Vec<bool>>) -> Vec<(f64, DVec2)> {
        let mut found = Vec::new();
        for y in 0..rows.len() {
            for x in 0..rows[y].len() {
                let mut todo = vec![(x, y)];
                let (mut area, mut sum) = (0.0, DVec2::ZERO);
                while let Some((x, y)) = todo.pop() {
                    if !std::mem::take(&mut rows[y][x]) {
                        continue;
                    }
                    area += 1.0;
                    sum += DVec2::new(x as f64, y as f64);
                    let (last_x, last_y) = (rows[y].len() - 1, rows.len() - 1);
                    for y in y.saturating_sub(1)..=(y + 1).min(last_y) {
                        for x in x.saturating_sub(1)..=(x + 1).min(last_x) {
                            todo.push((x, y));
                        }
                    }
                }
                if area > 0.0 {
                    found.push((area, sum / area));
                }
            }
        }
        found
    }

    proptest! {
        #[test]
        fn components_equal_those_of_filling(rows in prop::collection::vec(prop::collection::vec(any::<bool>(), 12), 0..12)) {
            let found = components(&runs(&rows));
            let expected = filled(rows);
            prop_assert_eq!(found.len(), expected.len());
            for (component, (area, middle)) in found.iter().zip(expected) {
                prop_assert_eq!(component.area, area);
                prop_assert!(component.middle.distance(middle) < 1e-9);
            }
        }
    }
}
