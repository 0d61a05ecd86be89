//! Reports on a compiled drawing: as data for programs (`check --format json`, `inspect --json` and the preview's page), and as a
//! picture (`inspect --matches`).

mod billboards;
mod clips;
mod figures;
mod findings;
mod inspection;
mod joints;
mod matches;
mod parts;
mod reasons;
#[cfg(test)]
pub(crate) mod samples;
mod terrain;

pub(crate) use billboards::{Billboard, Fit, MatchedBy, billboards, describe_character};
pub(crate) use clips::{Clip, clips};
pub(crate) use figures::{Figure, figures};
pub use findings::Findings;
pub(crate) use findings::{Likeness, findings_json};
pub(crate) use inspection::inspection_json;
pub use matches::picture_of_matches;
pub(crate) use parts::{Part, everything, part_count, parts};
pub(crate) use reasons::{Reasons, Undo};
pub(crate) use terrain::{Terrain, terrain};

/// Indented JSON. Reports hold only text and numbers, so this cannot fail.
pub(crate) fn pretty(report: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(report).unwrap_or_default();
    text.push('\n');
    text
}
