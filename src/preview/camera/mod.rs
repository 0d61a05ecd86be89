//! A puppet before a page's camera: its marks are tracked while the page sends pictures, and a recording becomes a track.
//!
//! ```text
//!  page ── frames (binary), pick, name, remove, record, stop ─► socket ─► Session ─► tracking
//!       ◄─ the places of the marks in each frame, the marks, a track
//! ```
//!
//! Each page that records has a WebSocket of its own, `/camera`. It sends one frame, and the next when the first is answered; nothing is
//! queued. What a session knows is dropped with its connection; nothing is written to disk.

mod frame;
mod message;
mod session;
mod socket;

pub(super) use socket::open;
