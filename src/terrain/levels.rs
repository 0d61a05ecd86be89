//! How high every surface lies: ties applied one after another (terrain.md, rule 3).

use super::groups::{GROUND, Groups};
use super::ties::{Tie, Ties};

/// How high the surfaces lie, and what holds them.
#[derive(Debug)]
pub(super) struct Levels {
    /// Per surface its height.
    pub(super) level: Vec<i32>,
    /// Per surface the height down to which there is earth, or whatever it is made of, where nothing seen says otherwise.
    pub(super) base: Vec<i32>,
    /// Per surface the one it stands on.
    pub(super) support: Vec<Option<u32>>,
    /// Surfaces whose height no tie leads to.
    pub(super) loose: Vec<u32>,
    /// Ties that the heights do not fulfil: the upper surface hangs above the lower one by a gap that is seen.
    pub(super) hanging: Vec<Tie>,
}

/// Sets of surfaces whose heights are known relative to each other.
struct Sets {
    parents: Vec<u32>,
    /// Height above the parent.
    rises: Vec<i32>,
}

impl Sets {
    /// The set that a surface is in, and its height above that set's first surface.
    fn find(&mut self, surface: u32) -> (u32, i32) {
        let (mut root, mut rise) = (surface, 0);
        while self.parents[root as usize] != root {
            rise += self.rises[root as usize];
            root = self.parents[root as usize];
        }
        // All on the way point at the root from now on.
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

    /// Says that `upper` is `rise` above `lower`, unless both are known already. Says whether it was new.
    fn tie(&mut self, tie: &Tie) -> bool {
        let (upper, above) = self.find(tie.upper);
        let (lower, below) = self.find(tie.lower);
        if upper == lower {
            return false;
        }
        let rise = tie.rise + below - above;
        // The lesser one leads: the ground, where it is one of them.
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
    pub(super) fn new(groups: &Groups, ties: &Ties) -> Self {
        let count = groups.surfaces.len();
        let mut sets = Sets {
            parents: (0..count as u32).collect(),
            rises: vec![0; count],
        };
        let mut support = vec![None; count];
        // What is dug into a surface, in pairs with that surface.
        let mut host = vec![None; count];
        let mut skipped = vec![];
        let strong = ties.strong.iter().map(|tie| (tie, true));
        for (tie, is_strong) in strong.chain(ties.weak.iter().map(|tie| (tie, false))) {
            let [upper, lower] = [tie.upper as usize, tie.lower as usize];
            if !sets.tie(tie) {
                if is_strong {
                    skipped.push(*tie);
                }
            } else if is_strong && support[upper].is_none() {
                support[upper] = Some(tie.lower);
            } else if is_strong {
                host[lower].get_or_insert(tie.upper);
            } else if support[upper].is_none() {
                support[upper] = if tie.rise > 0 {
                    Some(tie.lower)
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
        // A tie that leads to nothing but itself says nothing.
        let loose = (0..count as u32)
            .filter(|surface| found[*surface as usize].0 == *surface && *surface != GROUND)
            .collect();
        let height = |surface: u32| level[surface as usize];
        let hanging = skipped
            .into_iter()
            .filter(|tie| tie.rise < height(tie.upper) - height(tie.lower))
            .collect();
        Self {
            base: bases(&level, &support, &host),
            level,
            support,
            loose,
            hanging,
        }
    }
}

/// Down to where each surface is solid: to what it stands on, and below all that is dug into it.
fn bases(level: &[i32], support: &[Option<u32>], host: &[Option<u32>]) -> Vec<i32> {
    let outermost = |surface: usize| {
        let mut surface = surface;
        // What hosts what is a forest: each pair was new when it was taken.
        while let Some(next) = host[surface] {
            surface = next as usize;
        }
        surface
    };
    let own = |surface: usize| match support[surface] {
        Some(support) => level[surface].min(level[support as usize]),
        None => level[surface],
    };
    let hosts: Vec<usize> = (0..level.len()).map(outermost).collect();
    let mut base: Vec<i32> = (0..level.len()).map(own).collect();
    for (surface, host) in hosts.iter().enumerate() {
        base[*host] = base[*host].min(base[surface]);
    }
    hosts.iter().map(|host| base[*host]).collect()
}
