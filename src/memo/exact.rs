//! Values with numbers as keys, compared bit by bit.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};
use typed_index_collections::TiVec;

/// What can be compared exactly, without copying it: numbers by their bits.
pub(crate) trait Exact {
    /// Whether everything in both is equal, all numbers by their bits.
    fn is_exactly(&self, other: &Self) -> bool;

    /// Hashes a few of its values, which differ in most values that differ.
    fn hash_some(&self, state: &mut impl Hasher);
}

/// A value as a key, equal to those that are exactly the same. Something shared is compared by its address first.
#[derive(Debug, Clone)]
pub(crate) struct Exactly<T>(pub(crate) T);

impl<T: Exact> PartialEq for Exactly<T> {
    fn eq(&self, other: &Self) -> bool {
        self.0.is_exactly(&other.0)
    }
}

impl<T: Exact> Eq for Exactly<T> {}

impl<T: Exact> Hash for Exactly<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.hash_some(state);
    }
}

/// Implements [`Exact`] for structures, whose fields must all be named.
macro_rules! exact {
    ($($structure:ty { $($field:ident),* $(,)? })*) => {$(
        impl $crate::memo::Exact for $structure {
            fn is_exactly(&self, other: &Self) -> bool {
                let Self { $($field),* } = self;
                true $(&& $crate::memo::Exact::is_exactly($field, &other.$field))*
            }

            fn hash_some(&self, state: &mut impl std::hash::Hasher) {
                let Self { $($field),* } = self;
                $($crate::memo::Exact::hash_some($field, state);)*
            }
        }
    )*};
    // What has an `Eq` that is exact.
    ($($whole:ty),* $(,)?) => {$(
        impl $crate::memo::Exact for $whole {
            fn is_exactly(&self, other: &Self) -> bool {
                self == other
            }

            fn hash_some(&self, state: &mut impl std::hash::Hasher) {
                std::hash::Hash::hash(self, state);
            }
        }
    )*};
}
pub(crate) use exact;

exact!(bool, usize, String);
exact!(DVec2 { x, y });
exact!(DVec3 { x, y, z });

impl Exact for f64 {
    fn is_exactly(&self, other: &Self) -> bool {
        self.to_bits() == other.to_bits()
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        state.write_u64(self.to_bits());
    }
}

impl Exact for DQuat {
    fn is_exactly(&self, other: &Self) -> bool {
        self.to_array().is_exactly(&other.to_array())
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        self.to_array().hash_some(state);
    }
}

impl<T: Exact, const N: usize> Exact for [T; N] {
    fn is_exactly(&self, other: &Self) -> bool {
        self.iter().zip(other).all(|(a, b)| a.is_exactly(b))
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        self.iter().for_each(|item| item.hash_some(state));
    }
}

impl<T: Exact> Exact for Vec<T> {
    fn is_exactly(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().zip(other).all(|(a, b)| a.is_exactly(b))
    }

    // There are few lists of a kind, and comparing them takes less time than hashing.
    fn hash_some(&self, state: &mut impl Hasher) {
        state.write_usize(self.len());
        for item in [self.first(), self.last()].into_iter().flatten() {
            item.hash_some(state);
        }
    }
}

impl<K, T: Exact> Exact for TiVec<K, T> {
    fn is_exactly(&self, other: &Self) -> bool {
        self.raw.is_exactly(&other.raw)
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        self.raw.hash_some(state);
    }
}

impl<T: Exact> Exact for Option<T> {
    fn is_exactly(&self, other: &Self) -> bool {
        match (self, other) {
            (Some(a), Some(b)) => a.is_exactly(b),
            (None, None) => true,
            _ => false,
        }
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        state.write_u8(self.is_some().into());
        self.iter().for_each(|item| item.hash_some(state));
    }
}

impl<A: Exact, B: Exact> Exact for (A, B) {
    fn is_exactly(&self, other: &Self) -> bool {
        self.0.is_exactly(&other.0) && self.1.is_exactly(&other.1)
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        self.0.hash_some(state);
        self.1.hash_some(state);
    }
}

impl<T: Exact> Exact for Arc<T> {
    fn is_exactly(&self, other: &Self) -> bool {
        Self::ptr_eq(self, other) || T::is_exactly(self, other)
    }

    fn hash_some(&self, state: &mut impl Hasher) {
        T::hash_some(self, state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Both {
        size: f64,
        names: Vec<Option<String>>,
    }

    exact!(Both { size, names });

    #[test]
    fn equal_is_what_is_equal_to_the_last_bit() {
        let both = |size, names: [Option<&str>; 3]| {
            let names = names.map(|name| name.map(str::to_owned)).to_vec();
            Exactly(Arc::new(Both { size, names }))
        };
        let names = [Some("a"), None, Some("c")];
        let one = both(0.0, names);
        assert!(one == one.clone() && one == both(0.0, names));
        assert!(one != both(-0.0, names));
        assert!(one != both(0.0, [Some("a"), Some("b"), Some("c")]));
        assert!(one != both(0.0, [Some("a"), Some(""), Some("c")]));
        assert!(both(f64::NAN, names) == both(f64::NAN, names));
    }
}
