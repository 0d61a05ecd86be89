//! Indices with types: what is counted cannot be mistaken for something else that is counted.
//!
//! Each kind of index is declared where the list lives that it counts, by [`index_type!`]; the list is a
//! [`TiVec`](typed_index_collections::TiVec), which accepts no other kind.

use rayon::prelude::*;
use typed_index_collections::TiSlice;

/// Declares a type of indices: a `usize` with a meaning. It converts to and from the `usize` that counts from 0, for formats and
/// for users that number things themselves; in between, nothing should need that.
macro_rules! index_type {
    ($(#[$attribute:meta])* $visibility:vis $name:ident) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $visibility struct $name(usize);

        impl From<usize> for $name {
            /// From a number that counts from 0.
            fn from(index: usize) -> Self {
                Self(index)
            }
        }

        impl From<$name> for usize {
            /// The number, counted from 0.
            fn from(index: $name) -> Self {
                index.0
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, concat!(stringify!($name), " {}"), self.0)
            }
        }
    };
}

pub(crate) use index_type;

/// The indices of a list, for work on all cores.
pub(crate) fn par_keys<K: From<usize> + Send, V>(
    list: &TiSlice<K, V>,
) -> impl IndexedParallelIterator<Item = K> + Clone + use<K, V> {
    (0..list.len()).into_par_iter().map(K::from)
}

#[cfg(test)]
mod tests {
    use typed_index_collections::{TiVec, ti_vec};

    index_type!(
        /// Counts letters.
        Letter
    );

    #[test]
    fn a_list_is_indexed_by_its_own_type() {
        let letters: TiVec<Letter, char> = ti_vec!['a', 'b'];
        let last = letters.last_key().unwrap();
        assert_eq!((usize::from(last), letters[last]), (1, 'b'));
        assert_eq!(format!("{last:?}"), "Letter 1");
    }
}
