//! How many keys the clips of a drawing may have.

use super::Context;
use super::turn::PlayedTurn;
use crate::budget::{Budget, Work};

/// A frame that is computed of a part that swings takes as long as so many keys: it is made of small steps.
pub(super) const SWING: usize = 8;
/// The most keys, however long the motions are.
const MAX_KEYS: usize = 1 << 24;
/// So many keys are allowed for each number of the largest motion that is played.
const KEYS_PER_NUMBER: usize = 4;

/// The keys of the clips so far.
pub(super) struct Keys {
    used: usize,
    most: usize,
}

/// More keys than allowed.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Excess {
    pub(super) keys: usize,
    pub(super) most: usize,
    /// Whether parts of the last figure swing.
    pub(super) swings: bool,
}

/// How many parts of a figure a motion moves.
#[derive(Debug, Clone, Copy)]
struct Moving {
    /// Those that follow joints or swing.
    parts: usize,
    swinging: usize,
}

impl Keys {
    /// None, of a drawing with this budget.
    pub(super) fn of(budget: Budget) -> Self {
        let most = usize::try_from(budget.most(Work::Keys));
        Self {
            used: 0,
            most: most.unwrap_or(usize::MAX).min(MAX_KEYS),
        }
    }

    /// Adds those of motions that play in turn on a figure.
    ///
    /// # Errors
    /// If there are too many then.
    pub(super) fn add_turns(
        &mut self,
        context: &Context<'_>,
        turns: &[PlayedTurn<'_>],
    ) -> Result<(), Excess> {
        let mut shown = 1_usize;
        let mut swung = 0_usize;
        let mut parts = 0;
        for turn in turns {
            let numbers = turn.motion.clip.values().len();
            self.most = self.most.max((KEYS_PER_NUMBER * numbers).min(MAX_KEYS));
            let moving = Moving::by(context, turn);
            parts = parts.max(moving.parts);
            shown = shown.saturating_add(turn.length());
            // A cycle that plays several times is computed once.
            let frames = turn.playing.steps + 1;
            swung = swung.saturating_add(frames.saturating_mul(moving.swinging));
        }
        self.add(shown.saturating_mul(parts), swung)
    }

    /// Adds those of a motion that is performed in so many frames.
    ///
    /// # Errors
    /// If there are too many then.
    pub(super) fn add_performed(
        &mut self,
        context: &Context<'_>,
        turn: &PlayedTurn<'_>,
        frames: usize,
    ) -> Result<(), Excess> {
        let Moving { parts, swinging } = Moving::by(context, turn);
        self.add(
            frames.saturating_mul(parts),
            frames.saturating_mul(swinging),
        )
    }

    /// Adds those of key poses that move so many parts, in so many frames.
    ///
    /// # Errors
    /// If there are too many then.
    pub(super) fn add_posed(&mut self, parts: usize, frames: usize) -> Result<(), Excess> {
        self.add(frames.saturating_mul(parts), 0)
    }

    /// Adds keys, and frames that are computed of parts that swing.
    fn add(&mut self, keys: usize, swung: usize) -> Result<(), Excess> {
        let more = keys.saturating_add(swung.saturating_mul(SWING));
        self.used = self.used.saturating_add(more);
        let (keys, most) = (self.used, self.most);
        if keys > most {
            let swings = swung > 0;
            Err(Excess { keys, most, swings })
        } else {
            Ok(())
        }
    }
}

impl Moving {
    fn by(context: &Context<'_>, turn: &PlayedTurn<'_>) -> Self {
        let (matched, parts) = (&turn.matched, turn.matched.group.parts.iter_enumerated());
        let mut moving = Self {
            parts: 0,
            swinging: 0,
        };
        for (index, part) in parts {
            let is_driven =
                matched.moves.is_some() || matched.matching.parts[index].drive.is_some();
            let swings = context.bindings.attributes(*part).swing().is_some();
            moving.parts += usize::from(is_driven || swings);
            moving.swinging += usize::from(swings);
        }
        moving
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_for_all_clips_together() {
        let mut keys = Keys::of(Budget::default());
        assert_eq!(keys.add(1_000_000, 0), Ok(()));
        assert_eq!(keys.add(500_000, 62_500), Ok(()));
        let excess = |keys, swings| Excess {
            keys,
            most: 2_000_000,
            swings,
        };
        assert_eq!(keys.add(0, 1), Err(excess(2_000_008, true)));
        assert_eq!(keys.add(1, 0), Err(excess(2_000_009, false)));
        assert!(keys.add(usize::MAX, usize::MAX).is_err());
    }
}
