//! Connected pixels and cells, and the borders around them.
//!
//! - [`connected`] labels all cells of a table, such as a picture of classes or a tile map; what joins two neighbors is the caller's to say.
//! - [`connected_runs`] labels a few pixels of a large picture, given as runs.
//! - [`groups`] lists the pixels of each group, for a few marked ones in a padded picture.
//! - [`follow`] goes around an area along its border.
//!
//! Invariants: regions are numbered in the order of their first cells, whatever the number of threads; a border has its area on its
//! right.
//!
//! `imageproc`'s `region_labelling` and `contours` do the like for whole pictures of gray pixels with one background value. Here cells
//! join by a predicate (edges between equal tiles), pixels come as runs without a picture, and borders run between the labels of a map.

mod border;
mod connected;
mod groups;
mod runs;
mod sets;

pub(crate) use border::{Side, follow};
pub(crate) use connected::{Labels, connected};
pub(crate) use groups::groups;
pub(crate) use runs::{Span, connected_runs};
pub(crate) use sets::{join, root};
