//! Finds out for many points whether they are in an outline.

use glam::DVec2;

use super::Outline;
use super::query::{bounds_of, crosses, edges};

/// So many edges are in one band.
const FEW: usize = 32;
/// Edges a band, if each were in one.
const EDGES: usize = 8;
/// In how many bands an edge is at most on average.
const MOST_BANDS: usize = 8;

/// Edges around an area, sorted into level bands.
pub(crate) struct Bands {
    low: f64,
    /// Bands a unit.
    scale: f64,
    /// Per band its edges.
    bands: Vec<Vec<[DVec2; 2]>>,
}

impl Bands {
    /// Those of an outline.
    pub(crate) fn of(outline: &Outline) -> Self {
        Self::new(edges(outline).collect())
    }

    /// Those of edges that form closed rings.
    pub(crate) fn new(edges: Vec<[DVec2; 2]>) -> Self {
        let count = edges.len();
        let bounds = bounds_of(edges.iter().flatten().copied());
        let Some((low, high)) = bounds.filter(|_| count > FEW) else {
            return Self {
                low: 0.0,
                scale: 0.0,
                bands: vec![edges],
            };
        };
        let height = (high.y - low.y).max(f64::MIN_POSITIVE);
        let upright: f64 = edges.iter().map(|[a, b]| (b.y - a.y).abs()).sum();
        // An edge reaches into a band more than it is bands high.
        let most = ((MOST_BANDS - 1) * count) as f64 * height / upright.max(f64::MIN_POSITIVE);
        let bands = ((count / EDGES) as f64).min(most).max(1.0).floor();
        let mut found = Self {
            low: low.y,
            scale: bands / height,
            bands: vec![Vec::new(); bands as usize],
        };
        for [a, b] in edges {
            let [from, to] = [a.y.min(b.y), a.y.max(b.y)].map(|y| found.band(y));
            for band in &mut found.bands[from..=to] {
                band.push([a, b]);
            }
        }
        found
    }

    /// The band at a height, or the nearest one.
    fn band(&self, y: f64) -> usize {
        let band = ((y - self.low) * self.scale).max(0.0) as usize;
        band.min(self.bands.len() - 1)
    }

    /// Whether a point is filled, the same as [`contains`](super::contains).
    pub(crate) fn contains(&self, point: DVec2) -> bool {
        let band = self.bands[self.band(point.y)].iter();
        band.fold(false, |inside, edge| inside != crosses(*edge, point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polygon, contains};

    #[test]
    fn bands_contain_what_the_outline_contains() {
        let mut random = fastrand::Rng::with_seed(1);
        for upright in [0.01, 1.0, 100.0] {
            let place =
                |random: &mut fastrand::Rng| DVec2::new(random.f64(), upright * random.f64());
            let rings = (0..3).map(|_| (0..300).map(|_| place(&mut random)).collect());
            let outline = Outline {
                polygons: vec![Polygon {
                    rings: rings.collect(),
                }],
            };
            let bands = Bands::of(&outline);
            assert!(bands.bands.len() > 1);
            let entries: usize = bands.bands.iter().map(Vec::len).sum();
            assert!(entries <= MOST_BANDS * 900, "{entries}");
            for _ in 0..1000 {
                let point = place(&mut random) * 1.2 - 0.1;
                assert_eq!(bands.contains(point), contains(&outline, point));
            }
        }
    }
}
