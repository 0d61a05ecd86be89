//! Finds the grid that a drawing was drawn on: the size and the offset of tiles that fit its borders best.
//!
//! For one size of tiles, each border has a phase: where it lies between two grid lines. The more the phases agree, the better the size
//! fits, and their mean is the offset of the grid. Sizes are tried one after the other (a periodogram; Lomb, *Least-squares frequency
//! analysis of unequally spaced data*, 1976).

use crate::math;
use glam::DVec2;

use super::grid::Grid;

/// How much less across than along a border may run, as a ratio.
const UPRIGHT: f64 = 0.25;
/// The largest number of borders of a direction that are looked at; of more, evenly chosen ones.
const MAX_BORDERS: usize = 256;
/// The least number of borders that show a size.
const MIN_BORDERS: usize = 8;
/// The largest ratio of a size to the one that is written, in both directions.
const RATIO: f64 = 4.0;
/// Sizes that are tried while the phase of the farthest border changes by 1.
const STEPS: f64 = 8.0;
/// The largest number of sizes that are tried.
const MAX_SIZES: f64 = 131_072.0;
/// Borders that agree so much are on a grid: those that are off by a tenth of a tile at random, agree by 0.9.
const AGREES: f64 = 0.7;
/// How much better another size must agree than the one that is written.
const BETTER: f64 = 0.1;
/// Larger sizes are preferred that agree by so much less than the best: borders on a grid also fit half of its size.
const PREFERRED: f64 = 0.05;

/// The borders of a drawing.
#[derive(Debug, Default)]
pub(super) struct Borders {
    /// For x and y: where the borders across that axis are, and how long each is; drawing units.
    axes: [Vec<[f64; 2]>; 2],
}

/// The grid that fits borders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fit {
    /// The size of tiles, if another one fits.
    pub(super) size: Option<f64>,
    /// By how much the drawing must be moved so that its borders are at multiples of the size, drawing units; rounded to hundredths.
    pub(super) shift: DVec2,
}

impl Borders {
    /// Adds a line, if it is upright or level.
    pub(super) fn add(&mut self, from: DVec2, to: DVec2) {
        let [way, middle] = [(to - from).abs(), (from + to) / 2.0];
        if !(way + middle).is_finite() {
            return;
        }
        if way.x <= way.y * UPRIGHT && way.y > 0.0 {
            self.axes[0].push([middle.x, way.y]);
        } else if way.y <= way.x * UPRIGHT && way.x > 0.0 {
            self.axes[1].push([middle.y, way.x]);
        }
    }

    /// How well the borders lie on the lines of a grid: 1 if all do, -1 if all lie in the middle between lines; `None` without borders.
    pub(super) fn agreement(&self, grid: &Grid) -> Option<f64> {
        let origin = grid.origin.to_array();
        let axes = self.axes.iter().zip(origin);
        let (sum, weight) = axes.fold((0.0, 0.0), |(sum, weight), (axis, origin)| {
            let [along, _, all] = sums(axis, |at| (at - origin) / grid.size);
            (sum + along, weight + all)
        });
        (weight > 0.0).then_some(sum / weight)
    }

    /// The grid that the borders lie on, if they do not lie on this one but clearly on another one.
    pub(super) fn fit(mut self, grid: &Grid) -> Option<Fit> {
        if self.agreement(grid)? >= AGREES {
            return None;
        }
        for axis in &mut self.axes {
            let step = axis.len().div_ceil(MAX_BORDERS).max(1);
            let mut at = 0;
            axis.retain(|_| {
                at += 1;
                (at - 1) % step == 0
            });
        }
        let here = self.strength(1.0 / grid.size);
        let count: usize = self.axes.iter().map(Vec::len).sum();
        let other = (count >= MIN_BORDERS)
            .then(|| self.size(grid.size))
            .flatten();
        let other = other.filter(|size| self.strength(1.0 / size) > here + BETTER);
        (other.is_some() || here >= AGREES).then(|| Fit {
            size: other,
            shift: self.shift(other.unwrap_or(grid.size)),
        })
    }

    /// How much the phases agree at a frequency, 1 / size: 0 to 1.
    fn strength(&self, frequency: f64) -> f64 {
        let (mut sum, mut weight) = (0.0, 0.0);
        for axis in &self.axes {
            let [along, across, all] = sums(axis, |at| at * frequency);
            sum += math::hypot(along, across);
            weight += all;
        }
        sum / weight
    }

    /// The largest size that fits about as well as any.
    fn size(&self, written: f64) -> Option<f64> {
        let extent = self.axes.iter().map(|axis| {
            let low = axis.iter().map(|[at, _]| *at).fold(f64::INFINITY, f64::min);
            let high = axis
                .iter()
                .map(|[at, _]| *at)
                .fold(f64::NEG_INFINITY, f64::max);
            high - low
        });
        let extent = extent.fold(0.0, f64::max);
        let step = 1.0 / (STEPS * extent);
        let [first, last] = [1.0 / (RATIO * written), RATIO / written];
        let count = (last - first) / step;
        if !(count.is_finite() && count <= MAX_SIZES) {
            return None;
        }
        let strengths: Vec<f64> = (0..=count as usize)
            .map(|at| self.strength(first + at as f64 * step))
            .collect();
        let best = strengths.iter().copied().fold(0.0, f64::max);
        let good = strengths
            .iter()
            .position(|strength| *strength >= best - PREFERRED)?;
        // Uphill from there, and then between the steps.
        let mut top = good;
        while strengths
            .get(top + 1)
            .is_some_and(|next| *next > strengths[top])
        {
            top += 1;
        }
        let near = (-16..=16).map(|at| first + (top as f64 + f64::from(at) / 16.0) * step);
        let frequency =
            near.max_by(|one, other| self.strength(*one).total_cmp(&self.strength(*other)))?;
        let found = self.strength(frequency);
        if found < AGREES {
            return None;
        }
        // The roundest number that fits as well.
        let size = 1.0 / frequency;
        let rounded = [1.0, 2.0, 10.0, 100.0, 1000.0].map(|parts| (size * parts).round() / parts);
        let fits = |size: &f64| *size > 0.0 && self.strength(1.0 / size) >= found - PREFERRED / 4.0;
        Some(rounded.into_iter().find(fits).unwrap_or(size))
    }

    /// The way from the borders to the nearest multiples of a size.
    fn shift(&self, size: f64) -> DVec2 {
        let shift = [0, 1].map(|axis| {
            let axis = &self.axes[axis];
            // The phase around which the others lie: the best of a few, and the mean around it.
            let at_phase = |phase: f64| sums(axis, |at| at / size - phase)[0];
            let phases = (0..16).map(|at| f64::from(at) / 16.0);
            let phase = phases.fold(0.0, |best, phase| {
                if at_phase(phase) > at_phase(best) {
                    phase
                } else {
                    best
                }
            });
            let off = |at: f64| {
                let off = at / size - phase;
                off - off.round()
            };
            let near = axis.iter().filter(|[at, _]| off(*at).abs() < 0.25);
            let (sum, weight) = near.fold((0.0, 0.0), |(sum, all), [at, weight]| {
                (sum + off(*at) * weight, all + weight)
            });
            let phase = if weight > 0.0 {
                phase + sum / weight
            } else {
                0.0
            };
            let shift = -(phase - phase.round()) * size;
            (shift * 100.0).round() / 100.0 + 0.0
        });
        DVec2::from(shift)
    }
}

/// The sums of the borders' waves and of their waves a quarter later, and of their weights; `phase` is a border's phase.
fn sums(axis: &[[f64; 2]], phase: impl Fn(f64) -> f64) -> [f64; 3] {
    axis.iter()
        .fold([0.0; 3], |[along, across, all], [at, weight]| {
            let phase = phase(*at);
            [
                along + weight * wave(phase),
                across + weight * wave(phase - 0.25),
                all + weight,
            ]
        })
}

/// About the cosine of 2 π times a number, from parabolas, so that it is the same on every platform.
fn wave(phase: f64) -> f64 {
    let off = (phase - phase.round()).abs();
    if off < 0.25 {
        1.0 - 16.0 * off * off
    } else {
        16.0 * (0.5 - off) * (0.5 - off) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Borders at multiples of a size from an offset, each off by up to a share of the size.
    fn borders(size: f64, offset: DVec2, noise: f64) -> Borders {
        let mut random = fastrand::Rng::with_seed(7);
        let mut borders = Borders::default();
        for _ in 0..60 {
            let [x, y, length] = [0; 3].map(|_| f64::from(random.i32(0..20)));
            let mut jitter = || (random.f64() * 2.0 - 1.0) * noise;
            let p = (DVec2::new(x + jitter(), y + jitter())) * size + offset;
            let way = (length + 1.0) * size;
            borders.add(p, p + DVec2::new(way, jitter() * size));
            borders.add(p, p + DVec2::new(jitter() * size, way));
        }
        borders
    }

    fn grid(size: f64) -> Grid {
        Grid::over([DVec2::ZERO, DVec2::splat(size * 20.0)], size, 1 << 20).unwrap()
    }

    #[test]
    fn borders_on_the_grid_need_no_other() {
        assert_eq!(borders(16.0, DVec2::ZERO, 0.1).fit(&grid(16.0)), None);
    }

    #[test]
    fn the_grid_of_noisy_borders_is_found() {
        for (drawn, written) in [
            (16.0, 16.0),
            (18.0, 16.0),
            (10.0, 16.0),
            (32.0, 10.0),
            (12.5, 20.0),
        ] {
            for offset in [DVec2::new(0.5, 0.5), DVec2::new(0.3, -0.4)] {
                let offset = offset * drawn;
                let fit = borders(drawn, offset, 0.1).fit(&grid(written)).unwrap();
                let size = fit.size.unwrap_or(written);
                assert!((size - drawn).abs() < drawn * 0.005, "{drawn}: {fit:?}");
                let off = (offset + fit.shift) / drawn;
                assert!(
                    (off - off.round()).abs().max_element() < 0.06,
                    "{drawn} {offset}: {fit:?}"
                );
            }
        }
    }

    #[test]
    fn borders_anywhere_are_on_no_grid() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut borders = Borders::default();
        for _ in 0..80 {
            let [x, y] = [0; 2].map(|_| random.f64() * 300.0);
            borders.add(DVec2::new(x, 0.0), DVec2::new(x, 10.0));
            borders.add(DVec2::new(0.0, y), DVec2::new(10.0, y));
        }
        assert_eq!(borders.fit(&grid(16.0)), None);
    }
}
