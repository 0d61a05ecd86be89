//! The height of every surface: constraints applied one after another.

use rustc_hash::{FxHashMap, FxHashSet};

use super::constraints::{Constraints, HeightConstraint};
use super::groups::{GROUND, Groups};

/// The heights of the surfaces, and what they stand on.
#[derive(Debug)]
pub(super) struct Levels {
    /// Per surface its height.
    pub(super) level: Vec<i32>,
    /// Per surface the height down to which it is solid, where nothing visible says otherwise.
    pub(super) base: Vec<i32>,
    /// The heights up to 0 at which something drawn has nothing below it, so that it is a plate (rule 11).
    pub(super) plates: FxHashSet<i32>,
    /// Per surface the one that it stands on.
    pub(super) support: Vec<Option<u32>>,
    /// Surfaces whose height follows from no constraint.
    pub(super) unconstrained: Vec<u32>,
    /// Constraints that the heights do not satisfy: the upper surface hangs above the lower one with a visible gap.
    pub(super) hanging: Vec<HeightConstraint>,
}

/// A union-find forest of surfaces whose heights are known relative to each other.
struct Sets {
    parents: Vec<u32>,
    /// Height above the parent.
    rises: Vec<i32>,
}

impl Sets {
    /// The root of a surface's set, and the surface's height above the root.
    fn find(&mut self, surface: u32) -> (u32, i32) {
        let (mut root, mut rise) = (surface, 0);
        while self.parents[root as usize] != root {
            rise += self.rises[root as usize];
            root = self.parents[root as usize];
        }
        // Path compression.
        let (mut next, mut left) = (surface, rise);
        while self.parents[next as usize] != root && next != root {
            let (parent, step) = (self.parents[next as usize], self.rises[next as usize]);
            self.parents[next as usize] = root;
            self.rises[next as usize] = left;
            left -= step;
            next = parent;
        }
        (root, rise)
    }

    /// Applies a constraint unless its surfaces are in one set already. Whether it was applied.
    fn add(&mut self, constraint: &HeightConstraint) -> bool {
        let (upper, above) = self.find(constraint.upper);
        let (lower, below) = self.find(constraint.lower);
        if upper == lower {
            return false;
        }
        let rise = constraint.rise + below - above;
        // The smaller index becomes the root, which is the ground if that is one of them.
        if lower < upper {
            self.parents[upper as usize] = lower;
            self.rises[upper as usize] = rise;
        } else {
            self.parents[lower as usize] = upper;
            self.rises[lower as usize] = -rise;
        }
        true
    }
}

impl Levels {
    pub(super) fn new(groups: &Groups, constraints: &Constraints) -> Self {
        let count = groups.surfaces.len();
        let mut sets = Sets {
            parents: (0..count as u32).collect(),
            rises: vec![0; count],
        };
        let mut support = vec![None; count];
        // Per surface that is dug into another one, that other surface.
        let mut host = vec![None; count];
        let mut skipped = vec![];
        let strong = constraints.strong.iter().map(|c| (c, true));
        for (constraint, is_strong) in strong.chain(constraints.weak.iter().map(|c| (c, false))) {
            let [upper, lower] = [constraint.upper as usize, constraint.lower as usize];
            if !sets.add(constraint) {
                if is_strong {
                    skipped.push(*constraint);
                }
            } else if is_strong && support[upper].is_none() {
                support[upper] = Some(constraint.lower);
            } else if is_strong {
                host[lower].get_or_insert(constraint.upper);
            } else if support[upper].is_none() {
                support[upper] = if constraint.rise > 0 {
                    Some(constraint.lower)
                } else {
                    support[lower]
                };
            }
        }
        let found: Vec<(u32, i32)> = (0..count as u32)
            .map(|surface| sets.find(surface))
            .collect();
        let mut lowest = vec![i32::MAX; count];
        for (root, rise) in &found {
            let low = &mut lowest[*root as usize];
            *low = (*low).min(*rise);
        }
        lowest[GROUND as usize] = 0;
        let level: Vec<i32> = found
            .iter()
            .map(|(root, rise)| rise - lowest[*root as usize])
            .collect();
        // A root other than the ground has no height of its own.
        let unconstrained = (0..count as u32)
            .filter(|surface| found[*surface as usize].0 == *surface && *surface != GROUND)
            .collect();
        let height = |surface: u32| level[surface as usize];
        let hanging = skipped
            .into_iter()
            .filter(|c| c.rise < height(c.upper) - height(c.lower))
            .collect();
        let base = bases(&level, &support, &host, &constraints.pits);
        Self {
            plates: plates(&level, &base, &constraints.pits),
            base,
            level,
            support,
            unconstrained,
            hanging,
        }
    }
}

/// The height down to which each surface is solid: that of its support, of its pits, and of everything that is dug into it.
fn bases(
    level: &[i32],
    support: &[Option<u32>],
    host: &[Option<u32>],
    pits: &FxHashMap<u32, i32>,
) -> Vec<i32> {
    let outermost = |surface: usize| {
        let mut surface = surface;
        // This ends: hosts form a forest, because each constraint joined two sets.
        while let Some(next) = host[surface] {
            surface = next as usize;
        }
        surface
    };
    let own = |surface: usize| {
        let floor = level[surface] - pits.get(&(surface as u32)).unwrap_or(&0);
        support[surface].map_or(floor, |support| floor.min(level[support as usize]))
    };
    let hosts: Vec<usize> = (0..level.len()).map(outermost).collect();
    let mut base: Vec<i32> = (0..level.len()).map(own).collect();
    for (surface, host) in hosts.iter().enumerate() {
        base[*host] = base[*host].min(base[surface]);
    }
    hosts.iter().map(|host| base[*host]).collect()
}

/// The heights up to 0 of surfaces and floors of pits that are not solid below.
fn plates(level: &[i32], base: &[i32], pits: &FxHashMap<u32, i32>) -> FxHashSet<i32> {
    let is_plate = |surface: &usize| {
        let floor = pits
            .get(&(*surface as u32))
            .map(|depth| level[*surface] - depth);
        base[*surface] <= 0 && [Some(level[*surface]), floor].contains(&Some(base[*surface]))
    };
    // The first surface is the ground, which is not drawn.
    let plates = (1..level.len()).filter(is_plate);
    plates.map(|surface| base[surface]).collect()
}
