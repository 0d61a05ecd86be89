//! Results kept from one compile to the next.
//!
//! A [`Memo`] caches the results of functions of their keys. A function is given as a function pointer, which captures
//! nothing: it sees the key, and the files that it reads through the [`Resolver`] that it is given, so that no result
//! can depend on anything else. A result is used only if the function is the same, its whole key is equal, and what
//! was read is as it was; tests/again.rs holds the compiler to that. Keys whose parts have no bitwise `Eq` are wrapped
//! in `Exactly`; `exact!` compares structures field by field, and does not compile if a field is forgotten.
//! Results that were not used between two calls of [`Memo::next_generation`] are dropped, so that a memo is about as
//! large as the last drawing.
//!
//! The crate `comemo` works alike: it tracks files as they are read, as `Memo::get_reading` does. But it hashes all arguments
//! at every call, takes two with the same hash for equal, and has one cache for the whole process, where each compiler
//! has its own here. Found again for 2,000 unchanged outlines of 100 points, its results took five times as long as those
//! of `Memo::get`, whose keys compare the outlines' addresses. The generations are those of `salsa`, without its macros:
//! the functions cached here are few and coarse.

use std::any::{Any, TypeId};
use std::fmt;
use std::hash::{BuildHasher, Hash, Hasher};
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, PoisonError, RwLock};

use bytemuck::NoUninit;
use rayon::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap};

use crate::resolver::{Dependency, Recorder, Resolver};
use crate::threads::GRAIN;

pub(crate) use exact::{Exact, Exactly, exact};

mod exact;

/// What can be the key of a result: all that the result is computed from.
///
/// `Eq` must compare numbers by their bits ([`Bits`]), for `-0.0` and `0.0` may give different results. `Hash` may leave out what takes long to hash, as there are only a few keys of a kind.
pub(crate) trait Key: Eq + Hash + Send + Sync + 'static {}

impl<T: Eq + Hash + Send + Sync + 'static> Key for T {}

/// What can be kept. It is cloned at every use: large results are kept in an [`Arc`].
pub(crate) trait Value: Clone + Send + Sync + 'static {}

impl<T: Clone + Send + Sync + 'static> Value for T {}

/// A cache of results of pure functions.
pub struct Memo {
    /// By the types of key, function and value; `None` in a memo that keeps nothing.
    tables: Option<RwLock<Tables>>,
    generation: u32,
    misses: AtomicUsize,
    /// How many results were computed, rather than found, in the last generation: for statistics and tests.
    pub last_misses: usize,
}

type Tables = FxHashMap<TypeId, Box<dyn AnyTable>>;

type Table<K, F, V> = FxHashMap<Hashed<K, F>, Entry<V>>;

/// A result, and the generation in which it was last used.
struct Entry<V> {
    value: V,
    used: AtomicU32,
}

/// A key with its hash, which is computed before the lock is taken, and the function `F` that is called with it.
struct Hashed<K, F> {
    hash: u64,
    function: F,
    key: K,
}

/// A pointer to a function that computes results.
trait Function: Copy + Send + Sync + 'static {
    /// Whether both run the same code.
    fn is_same(self, other: Self) -> bool;
}

impl<K: 'static, V: 'static> Function for fn(&K) -> V {
    fn is_same(self, other: Self) -> bool {
        std::ptr::fn_addr_eq(self, other)
    }
}

impl<K: 'static, V: 'static> Function for fn(&K, &dyn Resolver) -> V {
    fn is_same(self, other: Self) -> bool {
        std::ptr::fn_addr_eq(self, other)
    }
}

trait AnyTable: Any + Send + Sync {
    fn drop_unused(&mut self, generation: u32);
}

/// A result with all that was read to compute it.
#[derive(Clone)]
struct Tracked<V> {
    value: V,
    dependencies: Arc<[Dependency]>,
}

impl Default for Memo {
    fn default() -> Self {
        Self {
            tables: Some(RwLock::default()),
            ..Self::none()
        }
    }
}

impl Memo {
    /// A memo that keeps nothing, for what is computed only once.
    pub fn none() -> Self {
        Self {
            tables: None,
            generation: 0,
            misses: AtomicUsize::new(0),
            last_misses: 0,
        }
    }

    /// Drops all results that were not used since the last call.
    pub fn next_generation(&mut self) {
        self.last_misses = std::mem::take(self.misses.get_mut());
        if let Some(tables) = &mut self.tables {
            let tables = tables.get_mut().unwrap_or_else(PoisonError::into_inner);
            let generation = self.generation;
            let unused = tables.values_mut();
            unused.for_each(|table| table.drop_unused(generation));
        }
        self.generation = self.generation.wrapping_add(1);
    }

    /// The result of `compute` for `key`: found or computed.
    pub(crate) fn get<K: Key, V: Value>(&self, key: K, compute: fn(&K) -> V) -> V {
        if self.tables.is_none() {
            return compute(&key);
        }
        let key = Hashed::new(key, compute);
        let found = self.find(std::slice::from_ref(&key)).pop();
        found.flatten().unwrap_or_else(|| {
            // No lock is held here: whatever is computed may use the memo itself, on any thread.
            let value = compute(&key.key);
            self.keep([(key, value.clone())]);
            value
        })
    }

    /// The results of `compute` for many keys, in their order: found, or computed in parallel.
    pub(crate) fn get_each<K: Key, V: Value>(&self, keys: Vec<K>, compute: fn(&K) -> V) -> Vec<V> {
        if self.tables.is_none() {
            return keys.par_iter().map(compute).collect();
        }
        let keys = keys.into_par_iter().with_min_len(GRAIN);
        let keys: Vec<_> = keys.map(|key| Hashed::new(key, compute)).collect();
        let found = keys.par_chunks(GRAIN).flat_map_iter(|keys| self.find(keys));
        let found: Vec<Option<V>> = found.collect();
        let computed = keys.par_iter().zip(&found);
        let computed = computed.filter(|(_, found)| found.is_none());
        let computed: Vec<V> = computed.map(|(key, _)| compute(&key.key)).collect();
        let mut next = computed.iter();
        let new = keys.into_iter().zip(&found).filter_map(|(key, found)| {
            found.is_none().then_some(())?;
            Some((key, next.next()?.clone()))
        });
        self.keep(new);
        let mut computed = computed.into_iter();
        let found = found.into_iter();
        found
            .filter_map(|found| found.or_else(|| computed.next()))
            .collect()
    }

    /// The result of `compute`, which also reads files, for `key`: found, if whatever it read is as it was, or computed.
    pub(crate) fn get_reading<K: Key, V: Value>(
        &self,
        key: K,
        resolver: &dyn Resolver,
        compute: fn(&K, &dyn Resolver) -> V,
    ) -> V {
        if self.tables.is_none() {
            return compute(&key, resolver);
        }
        let key = Hashed::new(key, compute);
        let found = self.find::<_, _, Tracked<V>>(std::slice::from_ref(&key));
        let found = found.into_iter().next();
        if let Some(found) = found.flatten()
            && found
                .dependencies
                .iter()
                .all(|dependency| dependency.is_unchanged(resolver))
        {
            return found.value;
        }
        let recorder = Recorder::new(resolver);
        let value = compute(&key.key, &recorder);
        let tracked = Tracked {
            value: value.clone(),
            dependencies: recorder.into_dependencies().into(),
        };
        self.keep([(key, tracked)]);
        value
    }

    /// The results that are there, each marked as used.
    fn find<K: Key, F: Function, V: Value>(&self, keys: &[Hashed<K, F>]) -> Vec<Option<V>> {
        let nothing = || keys.iter().map(|_| None).collect();
        let Some(tables) = &self.tables else {
            return nothing();
        };
        let tables = tables.read().unwrap_or_else(PoisonError::into_inner);
        let table = tables.get(&TypeId::of::<(K, F, V)>()).map(|table| {
            let table: &dyn Any = &**table;
            table.downcast_ref::<Table<K, F, V>>()
        });
        let Some(table) = table.flatten() else {
            return nothing();
        };
        let find = |key| {
            let entry = table.get(key)?;
            entry.used.store(self.generation, Ordering::Relaxed);
            Some(entry.value.clone())
        };
        keys.iter().map(find).collect()
    }

    /// Keeps results for the next time.
    fn keep<K: Key, F: Function, V: Value>(
        &self,
        results: impl IntoIterator<Item = (Hashed<K, F>, V)>,
    ) {
        let Some(tables) = &self.tables else {
            return;
        };
        let mut tables = tables.write().unwrap_or_else(PoisonError::into_inner);
        let table = tables.entry(TypeId::of::<(K, F, V)>());
        let table: &mut dyn Any =
            &mut **table.or_insert_with(|| Box::new(Table::<K, F, V>::default()));
        let Some(table) = table.downcast_mut::<Table<K, F, V>>() else {
            return;
        };
        let used = self.generation;
        let entry = |value| Entry {
            value,
            used: AtomicU32::new(used),
        };
        let mut misses = 0;
        for (key, value) in results {
            table.insert(key, entry(value));
            misses += 1;
        }
        self.misses.fetch_add(misses, Ordering::Relaxed);
    }
}

impl fmt::Debug for Memo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut state = f.debug_struct("Memo");
        state.field("generation", &self.generation);
        state.finish_non_exhaustive()
    }
}

impl<K: Key, F: Function, V: Value> AnyTable for Table<K, F, V> {
    fn drop_unused(&mut self, generation: u32) {
        self.retain(|_, entry| *entry.used.get_mut() == generation);
    }
}

impl<K: Hash, F> Hashed<K, F> {
    fn new(key: K, function: F) -> Self {
        let hash = FxBuildHasher.hash_one(&key);
        Self {
            hash,
            function,
            key,
        }
    }
}

impl<K: Eq, F: Function> PartialEq for Hashed<K, F> {
    fn eq(&self, other: &Self) -> bool {
        self.hash == other.hash && self.function.is_same(other.function) && self.key == other.key
    }
}

impl<K: Eq, F: Function> Eq for Hashed<K, F> {}

impl<K, F> Hash for Hashed<K, F> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.hash);
    }
}

/// Something shared, as part of a key: equal to whatever is at the same place in memory, so that comparing takes no
/// time.
#[derive(Debug)]
pub(crate) struct Same<T>(pub(crate) Arc<T>);

impl<T> Clone for Same<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> Eq for Same<T> {}

impl<T> Hash for Same<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        Arc::as_ptr(&self.0).hash(state);
    }
}

/// A long list as part of a key. Only its length and first item are hashed: there are few lists of a kind, and comparing
/// them takes less time than hashing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Long<T>(pub(crate) Vec<T>);

impl<T: Hash> Hash for Long<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.len().hash(state);
        self.0.first().hash(state);
    }
}

impl<T> FromIterator<T> for Long<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        Self(items.into_iter().collect())
    }
}

/// Numbers as part of a key, compared bit by bit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bits<T>(pub(crate) T);

impl<T: NoUninit> PartialEq for Bits<T> {
    fn eq(&self, other: &Self) -> bool {
        bytemuck::bytes_of(&self.0) == bytemuck::bytes_of(&other.0)
    }
}

impl<T: NoUninit> Eq for Bits<T> {}

impl<T: NoUninit> Hash for Bits<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write(bytemuck::bytes_of(&self.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolver::{LinkError, MemoryResolver};

    #[derive(PartialEq, Eq, Hash)]
    struct Square(i32);

    #[derive(PartialEq, Eq, Hash)]
    struct Negative(i32);

    fn misses(memo: &Memo) -> usize {
        memo.misses.load(Ordering::Relaxed)
    }

    // Small functions may be compiled once for each place that uses them: they are different functions then, and computed again.
    #[inline(never)]
    fn squared(Square(number): &Square) -> i32 {
        number * number
    }

    #[test]
    fn results_are_computed_once_a_key() {
        let memo = Memo::default();
        let square = |number| memo.get(Square(number), squared);
        assert_eq!([3, 3, 4, 3].map(square), [9, 9, 16, 9]);
        assert_eq!(misses(&memo), 2);
        assert_eq!(memo.get(Negative(3), |Negative(number)| -number), -3);
        // The same key for another function, of another type or of the same.
        assert_eq!(memo.get(Square(3), |_| "three"), "three");
        assert_eq!(memo.get(Square(3), |Square(number)| number + 1), 4);
        assert_eq!(memo.get_each(vec![Square(3)], |_| 5), [5]);
        assert_eq!(square(3), 9);
        assert_eq!(misses(&memo), 6);
    }

    #[test]
    fn unused_results_are_dropped() {
        let mut memo = Memo::default();
        let get = |memo: &Memo, numbers: &[i32]| {
            let keys = numbers.iter().map(|number| Square(*number)).collect();
            memo.get_each(keys, |Square(number)| number * number)
        };
        for (numbers, misses) in [
            (vec![1, 2, 3], 3),
            (vec![3, 1], 0),
            (vec![1, 2, 3], 1),
            (vec![], 0),
            (vec![1], 1),
        ] {
            let squares: Vec<i32> = numbers.iter().map(|number| number * number).collect();
            assert_eq!(get(&memo, &numbers), squares);
            memo.next_generation();
            assert_eq!(memo.last_misses, misses, "{numbers:?}");
        }
    }

    #[test]
    fn many_results_come_in_their_order() {
        let memo = Memo::default();
        let squares = |range: std::ops::Range<i32>| {
            let found = memo.get_each(range.clone().map(Square).collect(), |key| key.0 * key.0);
            assert!(found.into_iter().eq(range.map(|number| number * number)));
        };
        squares(500..600);
        squares(0..1000);
        squares(0..1000);
    }

    #[test]
    fn a_memo_that_keeps_nothing_computes_all() {
        let mut memo = Memo::none();
        let calls = Arc::new(AtomicUsize::new(0));
        for _ in 0..3 {
            memo.get(Same(Arc::clone(&calls)), |calls| {
                calls.0.fetch_add(1, Ordering::Relaxed)
            });
            memo.next_generation();
        }
        assert_eq!(calls.load(Ordering::Relaxed), 3);
        assert_eq!(memo.get_each(vec![Square(2)], |key| key.0), [2]);
    }

    #[test]
    fn results_depend_on_the_files_that_were_read() {
        let memo = Memo::default();
        let length = |files: &MemoryResolver| {
            memo.get_reading(Square(0), files, |_, resolver| {
                let read = resolver.read("list")?;
                let link = String::from_utf8_lossy(&read).into_owned();
                Ok::<_, LinkError>(resolver.read(&link)?.len())
            })
        };
        let files = MemoryResolver::default().with("list", *b"a");
        assert_eq!(length(&files), Err(LinkError::Missing));
        assert_eq!(length(&files), Err(LinkError::Missing));
        let files = files.with("a", *b"1234");
        assert_eq!(length(&files), Ok(4));
        assert_eq!(length(&files.clone().with("b", *b"12")), Ok(4));
        assert_eq!(misses(&memo), 2);
        assert_eq!(length(&files.clone().with("a", *b"4321")), Ok(4));
        assert_eq!(misses(&memo), 3);
    }

    #[test]
    fn numbers_are_compared_bit_by_bit() {
        assert!(Bits(0.0) != Bits(-0.0));
        assert!(Bits(f64::NAN) == Bits(f64::NAN));
        assert!(Bits([1.0, 2.0]) == Bits([1.0, 2.0]));
        let one = Arc::new(1);
        assert!(Same(Arc::clone(&one)) == Same(Arc::clone(&one)));
        assert!(Same(one) != Same(Arc::new(1)));
    }
}
