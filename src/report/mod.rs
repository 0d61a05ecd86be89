//! Reports on a compiled drawing: as data for programs (`check --format json`, `inspect --json` and the preview's page), and as a
//! picture (`inspect --matches`).

mod billboards;
mod clips;
mod depths;
mod findings;
mod inspection;
mod joints;
mod matches;
mod parts;
#[cfg(test)]
pub(crate) mod samples;
mod terrain;

pub use billboards::{Billboard, billboards, describe_character};
pub use clips::{Clip, clips};
pub use depths::depth_reason;
pub use findings::{Findings, Likeness, findings_json};
pub use inspection::inspection_json;
pub use matches::picture_of_matches;
pub use parts::{Part, everything, part_count, parts};
pub use terrain::{Terrain, terrain};

/// Indented JSON. Reports hold only text and numbers, so this cannot fail.
pub(crate) fn pretty(report: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(report).unwrap_or_default();
    text.push('\n');
    text
}
