//! The page itself, built by `build.rs` and held in the program.

/// A file of the page: where it is served, what it is, its bytes.
pub(super) type Asset = (&'static str, &'static str, &'static [u8]);

/// All files of the page.
pub(super) const ASSETS: [Asset; 3] = [
    (
        "/",
        "text/html; charset=utf-8",
        include_bytes!(concat!(env!("OUT_DIR"), "/page.html")),
    ),
    (
        "/page.js",
        "text/javascript; charset=utf-8",
        include_bytes!(concat!(env!("OUT_DIR"), "/page.js")),
    ),
    (
        "/page.css",
        "text/css; charset=utf-8",
        include_bytes!(concat!(env!("OUT_DIR"), "/page.css")),
    ),
];
