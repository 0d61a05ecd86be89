//! Sharing units out among texts: one unit a text, at the least total cost.
//!
//! Successive shortest augmenting paths with potentials (Jonker & Volgenant 1987) on the few units that each text can have.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::units::{Candidate, Candidates};

/// What it costs to leave a text without a unit: more than any unit may cost in sum with what it displaces.
const UNBOUND: f64 = 1e7;

/// Per text its unit, and per unit its text.
pub(super) struct Assignment {
    pub(super) unit_of: Vec<Option<usize>>,
    pub(super) text_of: Vec<Option<usize>>,
}

/// A cost in a heap, smallest first; ties go to the earlier index.
struct Step(f64, usize);

impl PartialEq for Step {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Step {}

impl PartialOrd for Step {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Step {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

/// Assigns units to texts, in the order of the texts.
pub(super) fn assign(candidates: &[Candidates], unit_count: usize) -> Assignment {
    let mut state = Search {
        candidates,
        text_potential: vec![0.0; candidates.len()],
        unit_potential: vec![0.0; unit_count],
        unit_of: vec![None; candidates.len()],
        text_of: vec![None; unit_count],
        reached: vec![f64::INFINITY; unit_count],
        from: vec![usize::MAX; unit_count],
        settled: vec![false; unit_count],
    };
    (0..candidates.len()).for_each(|text| state.augment(text));
    Assignment {
        unit_of: state.unit_of,
        text_of: state.text_of,
    }
}

struct Search<'a> {
    candidates: &'a [Candidates],
    text_potential: Vec<f64>,
    unit_potential: Vec<f64>,
    unit_of: Vec<Option<usize>>,
    text_of: Vec<Option<usize>>,
    /// Per unit the length of the shortest path to it, the text before it on the path, and whether the length is final.
    reached: Vec<f64>,
    from: Vec<usize>,
    settled: Vec<bool>,
}

impl Search<'_> {
    /// Gives a text a unit along a shortest path, on which other texts change theirs.
    fn augment(&mut self, first: usize) {
        let mut heap: BinaryHeap<Reverse<Step>> = BinaryHeap::new();
        let mut touched: Vec<usize> = Vec::new();
        // Texts on the paths, each with the length of the path to it.
        let mut texts: Vec<(usize, f64)> = vec![(first, 0.0)];
        // The path that ends by leaving a text without a unit.
        let (mut shortest, mut left_out) = (f64::INFINITY, first);
        let mut end = None;
        let mut next = 0;
        loop {
            while next < texts.len() {
                let (text, length) = texts[next];
                next += 1;
                let without = length + UNBOUND - self.text_potential[text];
                if without < shortest {
                    (shortest, left_out) = (without, text);
                }
                for &Candidate { unit, cost, .. } in self.candidates[text].iter() {
                    let reduced = cost - self.text_potential[text] - self.unit_potential[unit];
                    let length = length + reduced.max(0.0);
                    if !self.settled[unit] && length < self.reached[unit] {
                        if self.reached[unit] == f64::INFINITY {
                            touched.push(unit);
                        }
                        self.reached[unit] = length;
                        self.from[unit] = text;
                        heap.push(Reverse(Step(length, unit)));
                    }
                }
            }
            let Some(Reverse(Step(length, unit))) = heap.pop() else {
                break;
            };
            if self.settled[unit] || length > self.reached[unit] {
                continue;
            }
            if length >= shortest {
                break;
            }
            self.settled[unit] = true;
            match self.text_of[unit] {
                None => {
                    (shortest, end) = (length, Some(unit));
                    break;
                }
                Some(text) => texts.push((text, length)),
            }
        }
        for &(text, length) in &texts {
            self.text_potential[text] += shortest - length;
        }
        for unit in touched {
            if self.settled[unit] && self.reached[unit] < shortest {
                self.unit_potential[unit] -= shortest - self.reached[unit];
            }
            self.settled[unit] = false;
            self.reached[unit] = f64::INFINITY;
        }
        let mut free = match end {
            Some(unit) => Some(unit),
            None if left_out == first => None,
            None => self.unit_of[left_out].take(),
        };
        while let Some(unit) = free {
            let text = self.from[unit];
            self.text_of[unit] = Some(text);
            free = self.unit_of[text].replace(unit);
            if text == first {
                break;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The least total cost over all ways to share out units.
    fn least(costs: &[Vec<f64>], taken: &mut Vec<bool>) -> f64 {
        let Some((first, rest)) = costs.split_first() else {
            return 0.0;
        };
        let mut best = UNBOUND + least(rest, taken);
        for unit in 0..taken.len() {
            if !taken[unit] {
                taken[unit] = true;
                best = best.min(first[unit] + least(rest, taken));
                taken[unit] = false;
            }
        }
        best
    }

    proptest! {
        #[test]
        fn the_total_is_the_least(
            (units, costs) in (1..6_usize).prop_flat_map(|units| {
                // Small whole numbers make ties common.
                let row = prop::collection::vec((0..9).prop_map(f64::from), units);
                (Just(units), prop::collection::vec(row, 0..6))
            })
        ) {
            let candidate = |(unit, cost): (usize, &f64)| Candidate {
                unit,
                cost: *cost,
                shows_at: 0,
            };
            let rows: Vec<Candidates> = costs
                .iter()
                .map(|row| row.iter().enumerate().map(candidate).collect())
                .collect();
            let found = assign(&rows, units);
            let cost = |(text, unit): (usize, &Option<usize>)| unit.map_or(UNBOUND, |unit| costs[text][unit]);
            let total: f64 = found.unit_of.iter().enumerate().map(cost).sum();
            prop_assert_eq!(total, least(&costs, &mut vec![false; units]));
            for (text, unit) in found.unit_of.iter().enumerate() {
                if let Some(unit) = unit {
                    prop_assert_eq!(found.text_of[*unit], Some(text));
                }
            }
            let bound = found.unit_of.iter().flatten().count();
            prop_assert_eq!(found.text_of.iter().flatten().count(), bound);
            prop_assert_eq!(bound, costs.len().min(units));
        }
    }
}
