//! Surfaces of primitives while they are written, from the memo if it has them.

use std::borrow::Cow;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::memo::Memo;
use crate::scene::{Primitive, Surface, SurfacePatch, SurfaceSource};

/// A deferred surface as the key of a result.
struct Source(Arc<dyn SurfaceSource>);

impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        *self.0 == *other.0
    }
}

impl Eq for Source {}

impl Hash for Source {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.0.key());
    }
}

/// Calls `work` with the surface of a primitive.
pub(super) fn with_surface<R>(
    primitive: &Primitive,
    memo: &Memo,
    work: impl FnOnce(&Surface) -> R,
) -> R {
    let made = |source: &Arc<dyn SurfaceSource>| {
        memo.get(Source(Arc::clone(source)), |key| Arc::new(key.0.surface()))
    };
    match primitive.patches.as_slice() {
        // The usual case, in which a surface from the memo is not copied.
        [SurfacePatch::Deferred(source)] => work(&made(source)),
        _ => work(
            &primitive.surface_by(&mut |source| Cow::Owned(Arc::unwrap_or_clone(made(source)))),
        ),
    }
}
