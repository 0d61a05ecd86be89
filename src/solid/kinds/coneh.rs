//! `coneh`: narrows along the axis.

use super::taper::{Direction, Taper};

/// The outline scaled along its axis from one depth to another.
pub(super) type ConeH = Taper<Along>;

/// Along the axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Along;

impl Direction for Along {
    fn scales(top: f64) -> [f64; 2] {
        [1.0, top]
    }
}
