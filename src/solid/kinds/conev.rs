//! `conev`: narrows across the axis.

use super::taper::{Direction, Taper};

/// The outline scaled across its axis from one depth to another.
pub(super) type ConeV = Taper<Across>;

/// Across the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Across;

impl Direction for Across {
    fn scales(top: f64) -> [f64; 2] {
        [top, 1.0]
    }
}
