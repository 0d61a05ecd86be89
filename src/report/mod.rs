//! Reports on a compiled drawing: as data for programs (`inspect --json` and the preview's page), and as a picture (`inspect --matches`).

mod billboards;
mod clips;
mod depths;
mod joints;
mod matches;
mod parts;
mod performances;
mod terrain;

pub use billboards::{Billboard, BillboardRegion, billboards, characters, describe_character};
pub use clips::{Clip, clips, cut_frames};
pub use depths::depth_reason;
pub use joints::{Driver, drivers, frame_ranges, undriven};
pub use matches::picture_of_matches;
pub use parts::{AttributeReport, Part, StringReport, landscapes, own_name, part_count, parts};
pub use performances::{Frames, Performance, PerformedMark, performance, performed_mark};
pub use terrain::{Group, House, Terrain, terrain};
