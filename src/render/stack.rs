//! A stack whose first entries need no memory of their own.

/// How many entries are in the stack itself.
const INLINE: usize = 24;

/// Entries of which the last one is taken first. Almost always all of them are in the array, which is why this is faster than a
/// `SmallVec`: an entry is written without asking where.
pub(super) struct Stack<T> {
    entries: [T; INLINE],
    count: usize,
    /// Entries beyond those of the array.
    more: Vec<T>,
}

impl<T: Copy + Default> Stack<T> {
    pub(super) fn new() -> Self {
        Self {
            entries: [T::default(); INLINE],
            count: 0,
            more: Vec::new(),
        }
    }

    #[inline]
    pub(super) fn push(&mut self, entry: T) {
        match self.entries.get_mut(self.count) {
            Some(place) => {
                *place = entry;
                self.count += 1;
            }
            None => self.more.push(entry),
        }
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<T> {
        if self.count == INLINE
            && let Some(entry) = self.more.pop()
        {
            return Some(entry);
        }
        self.count = self.count.checked_sub(1)?;
        self.entries.get(self.count).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_beyond_the_array_are_taken_first() {
        let mut stack = Stack::new();
        for round in 0..3 {
            let count = INLINE * 2 + round;
            (0..count).for_each(|entry| stack.push(entry));
            let taken: Vec<usize> = std::iter::from_fn(|| stack.pop()).collect();
            assert!(taken.into_iter().eq((0..count).rev()), "{round}");
        }
    }
}
