//! The server of the live page, which shows drawings after every build, and the server of okoshi in the browser.
//!
//! ```text
//!  watch, or an editor ─► Hub of `page` ─► sockets ─► pages
//!                                   └─► models, thumbnails and moving pictures, by number
//!  changes of a page ─► changes ─► the editor of `watch` ─► the drawing's file
//!  pictures of a page's camera ─► camera ─► places of marks, a track
//! ```
//!
//! It is served on loopback only, and only to its own page: requests that name another host or come from another page are
//! refused, and nothing is served but the page and what was built. A page that does not read blocks nobody. A page with the key of the
//! server can change a drawing that is shown, and begin one in a folder without drawings; nothing else is written.
//!
//! okoshi in the browser is a folder of files (`app`), served by the same rules. That server learns nothing of drawings.

mod access;
mod app;
mod assets;
mod camera;
mod changes;
mod complete;
mod loopback;
mod server;
mod socket;

pub(crate) use app::{Files, PORT as APP_PORT, serve as serve_app};
pub(crate) use complete::lacking;
pub(crate) use loopback::{Bound, bind};
pub(crate) use server::{PORT, serve};
