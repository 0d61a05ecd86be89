//! Whether a folder is okoshi in the browser as a whole. `build.rs` includes this file, too.

/// What is in the folder itself.
const OUTER: [&str; 2] = ["index.html", "service-worker.js"];
/// What is in its folder of a version.
const INNER: [&str; 5] = [
    "app.css",
    "app.js",
    "okoshi_web.js",
    "okoshi_web_bg.wasm",
    "worker.js",
];

/// Whether a file belongs to one version: it never changes, because the next version is a folder of another name.
pub(crate) fn is_versioned(path: &str) -> bool {
    path.starts_with("v-") && path.contains('/')
}

/// The first file that a folder with these files lacks, by their paths from there with `/` between names.
pub(crate) fn lacking(files: &[String]) -> Option<String> {
    let is_there = |wanted: &str| files.iter().any(|file| file == wanted);
    let outer = OUTER.iter().map(|name| (*name).to_owned());
    let version = files.iter().find(|file| is_versioned(file));
    let version = version.and_then(|file| file.split('/').next());
    let version = version.unwrap_or("v-…");
    let inner = INNER.iter().map(|name| format!("{version}/{name}"));
    outer.chain(inner).find(|wanted| !is_there(wanted))
}
