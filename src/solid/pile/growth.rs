//! How finely bodies follow those that they lie on.

/// Points that all bodies together may spend on following those below, beside what each may by its own size.
const MORE_POINTS: usize = 1 << 16;
/// The same for one of a few bodies, and for one of many.
const MOST_EACH: usize = 1 << 9;
const LEAST_EACH: usize = 1 << 5;
/// Each of so many bodies may spend as many points on it as it has by itself; each of more, which are smaller, only a share of these.
const MANY_BODIES: usize = 1 << 9;

/// How many points the mesh of a body may spend on following those below.
#[derive(Debug, Clone, Copy)]
pub(super) struct Growth {
    /// However few it has by itself.
    pub(super) each: usize,
    /// And one more for each so many of its own.
    pub(super) per: usize,
}

impl Growth {
    /// That of each of so many bodies.
    pub(super) fn of(bodies: usize) -> Self {
        // Rounded, so that most changes of one body leave those of the others as they are.
        let bodies = bodies.max(1).next_power_of_two();
        Self {
            each: (MORE_POINTS / bodies).clamp(LEAST_EACH, MOST_EACH),
            per: (bodies / MANY_BODIES).max(1),
        }
    }

    /// The most points for a mesh that has so many by itself.
    pub(super) fn most(self, own: usize) -> usize {
        own / self.per + self.each
    }
}
