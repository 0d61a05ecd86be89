//! What pages show of drawings, and how they change them, without a server.
//!
//! ```text
//!  builds ─► Hub ─► messages                    (only the newest build of each drawing, for a page that reads slowly)
//!             └─► models, thumbnails and pages of drawings, by number; other files of a drawing, made when they are asked for
//!  requests of a page ─► editing ─► an Editor, which keeps the texts
//!  files in memory ─► Studio ─► all of this, for pages that have the program as a module
//! ```

mod delta;
mod editing;
mod exports;
mod films;
mod hub;
mod message;
mod models;
mod paper;
mod pictures;
mod starters;
mod studio;
mod texts;

pub(crate) use editing::{Editing, Editor, Refused, ToChange, ToShow, ToTry};
pub(crate) use exports::Export;
pub use films::film;
pub(crate) use films::{Shot, gif};
pub(crate) use hub::{Builds, Hub, Picked, Shown, editing_in_client, json};
pub(crate) use message::{FromPage, Times, ToPage};
pub use pictures::trace;
pub(crate) use starters::{Starters, random_key};
pub use studio::{Studio, Tried};
