//! A live page of drawings, updated with every build.
//!
//! ```text
//!  watch, or an editor ─► Hub ─► sockets ─► pages          (only the newest build of each drawing, if a page reads slowly)
//!                          └─► models and thumbnails, by number
//!  pictures of a page's camera ─► camera ─► places of marks, a track
//! ```
//!
//! It is served on loopback only, and only to its own page: requests that name another host or come from another page are
//! refused, and nothing is served but the page and what was built. A page that does not read blocks nobody. The one thing that a
//! page can have written is a starter drawing, in a folder without drawings.

mod access;
mod camera;
mod delta;
mod hub;
mod message;
mod page;
mod server;
mod socket;
mod starters;

pub(crate) use hub::{Builds, Hub, Picked, Shown};
pub(crate) use server::{bind, serve};
pub(crate) use starters::{Starter, Starters};
