//! What is said about drawings in the types of the language server protocol: answers of [`crate::ide`] to its requests, and edits.
//!
//! ```text
//!  lsp (threads, files, stdin and stdout) ─┐
//!                                          ├─► queries, edits, changes ─► ide
//!  Server (one text at a time, in memory) ─┘         └► convert, positions
//! ```
//!
//! Only this module and `lsp` name these types.

pub(crate) mod capabilities;
pub(crate) mod changes;
pub(crate) mod convert;
pub(crate) mod document;
pub(crate) mod edits;
pub(crate) mod news;
pub(crate) mod positions;
pub(crate) mod queries;
mod server;

pub use server::Server;

/// The code of a request that is understood but cannot be met, such as an impossible rename.
pub(crate) const REFUSED: i64 = -32803;
