//! stub
use super::{Outcome, args::Common};
pub(super) fn run(_: Option<&str>, _: Common) -> Outcome { Outcome::Done }
