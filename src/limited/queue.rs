//! A priority queue whose keys change: a tournament tree.

/// Finds the smallest of many keys, O(log n) for each change.
///
/// Unlike a binary heap it changes a key in place, so no stale entries pile up.
pub(super) struct Queue {
    keys: Vec<u64>,
    /// The winner of each match: node i matches its children 2i and 2i + 1; the entries are the last `n` nodes.
    winners: Vec<u32>,
}

impl Queue {
    /// The key of an entry that cannot be chosen.
    pub(super) const OUT: u64 = u64::MAX;

    pub(super) fn new(keys: Vec<u64>) -> Self {
        let count = keys.len();
        let mut queue = Self {
            keys,
            winners: vec![0; 2 * count],
        };
        for entry in 0..count {
            queue.winners[count + entry] = entry as u32;
        }
        for node in (1..count).rev() {
            queue.winners[node] = queue.winner(node);
        }
        queue
    }

    /// The number of entries.
    pub(super) fn len(&self) -> usize {
        self.keys.len()
    }

    fn winner(&self, node: usize) -> u32 {
        let [a, b] = [self.winners[2 * node], self.winners[2 * node + 1]];
        let [key_a, key_b] = [a, b].map(|entry| self.keys[entry as usize]);
        if (key_a, a) <= (key_b, b) { a } else { b }
    }

    /// The entry with the smallest key, the first of equal ones.
    pub(super) fn first(&self) -> Option<usize> {
        let first = *self.winners.get(1)? as usize;
        (self.keys[first] != Self::OUT).then_some(first)
    }

    pub(super) fn set(&mut self, entry: usize, key: u64) {
        if self.keys[entry] == key {
            return;
        }
        self.keys[entry] = key;
        let mut node = (self.keys.len() + entry) / 2;
        while node > 0 {
            let winner = self.winner(node);
            // If another entry won this match before and still does, nothing above depends on the changed key.
            if self.winners[node] == winner && winner as usize != entry {
                return;
            }
            self.winners[node] = winner;
            node /= 2;
        }
    }
}

/// A key that orders small values first. `value` is at least 0 and not NaN, so its bits are ordered like the number.
pub(super) fn ascending(value: f64) -> u64 {
    // The bits of -0, which equals 0, would come last.
    (value + 0.0).to_bits()
}

/// A key that orders large values first; never [`Queue::OUT`].
pub(super) fn descending(value: f64) -> u64 {
    (1 << 63) - ascending(value)
}
