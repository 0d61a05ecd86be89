//! A live page of drawings, updated with every build.
//!
//! ```text
//!  watch, or an editor ─► Hub ─► sockets ─► pages          (only the newest build of each drawing, if a page reads slowly)
//!                          └─► models, thumbnails and moving pictures, by number
//!  changes of a page ─► changes ─► the editor of `watch` ─► the drawing's file
//!  pictures of a page's camera ─► camera ─► places of marks, a track
//! ```
//!
//! It is served on loopback only, and only to its own page: requests that name another host or come from another page are
//! refused, and nothing is served but the page and what was built. A page that does not read blocks nobody. A page with the key of the
//! server can change a drawing that is shown, and begin one in a folder without drawings; nothing else is written.

mod access;
mod camera;
mod changes;
mod delta;
mod films;
mod hub;
mod message;
mod models;
mod page;
mod server;
mod socket;
mod starters;
mod texts;

pub(crate) use changes::Editing;
pub(crate) use hub::{Builds, Hub, Picked, Shown, editing_in_client};
pub(crate) use server::{bind, serve};
pub(crate) use starters::{Starter, Starters};
