//! What was measured, summed up.

use std::fmt;

/// The values of one measure.
#[derive(Debug, Clone, Default)]
pub(super) struct Values(Vec<f64>);

impl Values {
    pub(super) fn add(&mut self, value: f64) {
        assert!(value.is_finite(), "{value} was measured");
        self.0.push(value);
    }

    /// The share of the values that are at most a limit, percent.
    fn within(&self, limit: f64) -> f64 {
        let within = self.0.iter().filter(|value| **value <= limit).count();
        100.0 * within as f64 / self.0.len().max(1) as f64
    }

    fn quantile(&self, share: f64) -> f64 {
        let mut values = self.0.clone();
        values.sort_by(f64::total_cmp);
        let at = (values.len().max(1) - 1) as f64 * share;
        values.get(at.round() as usize).copied().unwrap_or(0.0)
    }
}

/// All measures.
#[derive(Debug, Clone, Default)]
pub(super) struct Totals {
    /// Of feet that stand: by how much their tilt differs from the actor's, degrees.
    pub(super) tilt: Values,
    /// Of feet that stand: how far they are below the ground, percent of the figure's height.
    pub(super) sunk: Values,
    /// Of frames with a foot that stands: how far the figure's lowest point is from the ground, likewise.
    pub(super) off_ground: Values,
    /// Of frames with one foot that stands and one in the air: 1 if that in the air is lower.
    pub(super) lowest: Values,
    /// The same of legs that keep their drawn pose, like a spider's.
    pub(super) lowest_splayed: Values,
    /// Of flights: by how much their height differs from the actor's, percent of it.
    pub(super) flight: Values,
    /// Of steps from frame to frame with a foot that stands: how fast it slides, in leg lengths per second, more than the actor's.
    pub(super) slide: Values,
    /// Of arms at moments: 1 if forearm or hand are in the trunk.
    pub(super) arms: Values,
    /// Of pieces of legs in frames: by how much their turn differs from that of the frame before, degrees.
    pub(super) jerks: Values,
}

/// A measure: what it is called, its values, and its limit.
type Row<'a> = (&'a str, &'a Values, f64);

impl Totals {
    fn rows(&self) -> [Row<'_>; 9] {
        [
            ("sole's tilt off the actor's, degrees", &self.tilt, 5.0),
            ("sole below the ground, % of the height", &self.sunk, 1.0),
            (
                "lowest point off the ground, % of the height",
                &self.off_ground,
                1.0,
            ),
            ("planted foot above a moving one", &self.lowest, 0.0),
            ("the same of splayed legs", &self.lowest_splayed, 0.0),
            ("height of flights off the actor's, %", &self.flight, 20.0),
            ("slide over the actor's, legs a second", &self.slide, 0.1),
            ("forearm or hand in the trunk", &self.arms, 0.0),
            ("change of a leg's turn, degrees", &self.jerks, 10.0),
        ]
    }
}

impl fmt::Display for Totals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (_, values, limit) in self.rows() {
            if values.0.is_empty() {
                write!(f, "    –        ")?;
            } else {
                write!(
                    f,
                    " {:5.1}%({:5.2})",
                    values.within(limit),
                    values.quantile(0.95)
                )?;
            }
        }
        Ok(())
    }
}

/// The measures of half of the figures.
#[derive(Debug, Default)]
pub(super) struct Half(Totals);

impl Half {
    pub(super) fn add(&mut self, totals: &Totals) {
        let own = &mut self.0;
        let pairs = [
            (&mut own.tilt, &totals.tilt),
            (&mut own.sunk, &totals.sunk),
            (&mut own.off_ground, &totals.off_ground),
            (&mut own.lowest, &totals.lowest),
            (&mut own.lowest_splayed, &totals.lowest_splayed),
            (&mut own.flight, &totals.flight),
            (&mut own.slide, &totals.slide),
            (&mut own.arms, &totals.arms),
            (&mut own.jerks, &totals.jerks),
        ];
        for (all, more) in pairs {
            all.0.extend(&more.0);
        }
    }

    /// Checks the least shares that are within their limits.
    pub(super) fn check(&self) {
        for ((name, values, limit), least) in self.0.rows().into_iter().zip(LEAST) {
            let share = values.within(limit);
            assert!(
                share >= least,
                "{name}: only {share:.2} % are at most {limit}"
            );
            assert!(
                values.0.len() >= FEWEST,
                "{name}: only {} values",
                values.0.len()
            );
        }
    }
}

/// The least share of values within the limit, percent, in the order of [`Totals::rows`].
/// Planted feet are meant to be lowest in 97 %: legs of one piece cannot bend, and a leg that lands is lowered early, so that the figure
/// does not jump.
const LEAST: [f64; 9] = [99.5, 99.5, 99.0, 85.0, 93.0, 90.0, 96.0, 95.0, 95.0];
/// The fewest values of a measure.
const FEWEST: usize = 14;

impl fmt::Display for Half {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, values, limit) in self.0.rows() {
            writeln!(
                f,
                "  {name}: {:.1} % of {} are at most {limit}; median {:.2}, 95 % {:.2}, all {:.2}",
                values.within(limit),
                values.0.len(),
                values.quantile(0.5),
                values.quantile(0.95),
                values.quantile(1.0)
            )?;
        }
        Ok(())
    }
}
