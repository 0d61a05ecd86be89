//! Textures that were drawn, for the next time that they are wanted.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::{Baked, Plan, PlanKey};

/// Draws plans, and remembers what it drew the last time.
#[derive(Debug, Default)]
pub struct Baker {
    last: FxHashMap<Wanted, (Plan, Result<Baked, &'static str>)>,
}

/// What two plans have in common of which the same is drawn.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Wanted {
    key: PlanKey,
    size: [u32; 2],
    given_up: bool,
}

impl Wanted {
    fn of(plan: &Plan) -> Self {
        Self {
            key: plan.key(),
            size: plan.size,
            given_up: plan.work.is_infinite(),
        }
    }
}

impl Baker {
    /// Draws plans, as [`Plan::bake`] does.
    pub fn bake(&mut self, plans: &[Plan]) -> Vec<Result<Baked, &'static str>> {
        let last = &self.last;
        let baked: Vec<_> = plans
            .par_iter()
            .map(|plan| match last.get(&Wanted::of(plan)) {
                Some((_, baked)) => baked.clone(),
                None => plan.bake(),
            })
            .collect();
        // The plans hold on to what keys know only by its place in memory.
        let both = plans.iter().zip(&baked);
        self.last = both
            .map(|(plan, baked)| (Wanted::of(plan), (plan.clone(), baked.clone())))
            .collect();
        baked
    }
}
