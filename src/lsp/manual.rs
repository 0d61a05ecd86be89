//! The manual of diagnostics as a file, so that an editor's links at codes work offline.

use std::sync::LazyLock;

use tower_lsp::ls_types::Uri;

use crate::diagnostic::Code;
use crate::disk::write_cached;
use crate::lang::reference;
use crate::protocol::document::Pages;

/// The file with the line of each code, written on first use. Empty if it cannot be written.
static PAGES: LazyLock<Pages> = LazyLock::new(|| pages().unwrap_or_default());

/// The links at codes, if the client supports them.
pub(super) fn links(wanted: bool) -> Option<&'static Pages> {
    wanted.then(|| &*PAGES)
}

fn pages() -> Option<Pages> {
    let text = reference::diagnostics(|_| None);
    let name = concat!("diagnostics-", env!("CARGO_PKG_VERSION"), ".md");
    let path = write_cached(name, |out| out.write_all(text.as_bytes()))?;
    let base = Uri::from_file_path(&path)?;
    let of = |code: &Code| {
        let heading = format!("{}: ", code.id());
        let line = text.lines().position(|line| {
            line.trim_start_matches(['#', ' ']).starts_with(&heading) && line.starts_with('#')
        })?;
        format!("{}#L{}", base.as_str(), line + 1).parse().ok()
    };
    Some(
        Code::ALL
            .iter()
            .filter_map(|code| Some((*code, of(code)?)))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_heading_to_link_to() {
        let text = reference::diagnostics(|_| None);
        for code in Code::ALL {
            let heading = format!("{}: ", code.id());
            let found = text.lines().any(|line| {
                line.starts_with('#') && line.trim_start_matches(['#', ' ']).starts_with(&heading)
            });
            assert!(found, "{heading}");
        }
    }
}
