//! Surfaces that are made when they are asked for.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use super::Surface;

/// A description from which a surface can be made, many times smaller than the surface.
///
/// Many users of a scene never look at its triangles, and those of a large scene do not fit into memory: an exporter
/// makes them a few at a time.
pub trait SurfaceSource: Any + fmt::Debug + Send + Sync {
    /// Makes the surface; every call makes the same one.
    fn surface(&self) -> Surface;

    /// The source of the same surface mirrored in the plane z = 0.
    fn mirrored(&self) -> Arc<dyn SurfaceSource>;

    /// A hash of everything the surface is made from, for caches of surfaces. It is the same in every run.
    fn key(&self) -> u64;

    /// Whether `other` is of the same type and makes its surface from equal values.
    fn is_equal(&self, other: &dyn SurfaceSource) -> bool;
}

impl PartialEq for dyn SurfaceSource {
    fn eq(&self, other: &Self) -> bool {
        self.is_equal(other)
    }
}
