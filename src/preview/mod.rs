//! A live page of drawings: each build is shown where the last one stood.
//!
//! ```text
//!  watch, or an editor ─► Hub ─► sockets ─► pages          (the newest build of each drawing, as fast as each page reads)
//!                          └─► models and pictures, by number
//! ```
//!
//! It is served on loopback only, to this machine's own pages: requests that name another host, or come from another
//! page, are refused, and nothing is served but the page and what was built. A page that does not read holds up nobody.

mod guard;
mod hub;
mod message;
mod page;
mod server;
mod socket;

pub use hub::{Hub, Picked, Shown};
pub use server::{Bound, bind, serve};
