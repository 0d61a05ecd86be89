//! `cone`: narrows both ways.

use super::taper::{Both, Taper};

/// The outline scaled evenly from one depth to another.
pub(super) type Cone = Taper<Both>;
