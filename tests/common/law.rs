//! Laws for random inputs, which must not hold only because their inputs say nothing.

use std::cell::Cell;

use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Counts inputs, and those for which something held.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    all: Cell<usize>,
    held: Cell<usize>,
}

impl Tally {
    pub(crate) fn count(&self, holds: bool) {
        self.add(usize::from(holds), 1);
    }

    /// Counts `all` inputs, `held` of which it held for.
    pub(crate) fn add(&self, held: usize, all: usize) {
        self.all.set(self.all.get() + all);
        self.held.set(self.held.get() + held);
    }

    /// Fails if it held for less than this share of the inputs. Five inputs are let off, so that a run with few has no bad luck.
    #[track_caller]
    #[allow(clippy::print_stdout, reason = "with --nocapture it says the share")]
    pub(crate) fn assert_share(&self, what: &str, percent: usize) {
        let (all, held) = (self.all.get(), self.held.get());
        println!("{what}: {held} of {all}, at least {percent} % are required");
        assert!(
            held * 100 + 500 >= all * percent,
            "{what}: only {held} of {all}, which is less than {percent} %"
        );
    }
}

/// So many random inputs, unless `PROPTEST_CASES` says how many. One that fails is printed, and not kept in a file.
pub(crate) fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases: std::env::var("PROPTEST_CASES")
            .ok()
            .and_then(|cases| cases.parse().ok())
            .unwrap_or(cases),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Checks a law for random inputs. It returns whether it said all that it can say about an input, as it must about `percent` of them.
#[track_caller]
pub(crate) fn check<S: Strategy>(
    config: ProptestConfig,
    percent: usize,
    inputs: S,
    law: impl Fn(S::Value) -> Result<bool, TestCaseError>,
) {
    let whole = Tally::default();
    let found = TestRunner::new(config).run(&inputs, |input| {
        whole.count(law(input)?);
        Ok(())
    });
    if let Err(error) = found {
        panic!("{error}");
    }
    whole.assert_share("inputs that the law is about", percent);
}
