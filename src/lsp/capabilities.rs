//! The capabilities of the client.

use std::sync::atomic::Ordering;

use tower_lsp::ls_types::ClientCapabilities;

use super::worker::ClientSupport;

impl ClientSupport {
    /// Records the client's capabilities.
    pub(super) fn record(&self, can: &ClientCapabilities) {
        let text = can.text_document.as_ref();
        let links = text
            .and_then(|text| text.publish_diagnostics.as_ref())
            .and_then(|can| can.code_description_support);
        let window = can.window.as_ref();
        let progress = window.and_then(|window| window.work_done_progress);
        self.links_at_codes
            .store(links.unwrap_or(false), Ordering::Relaxed);
        self.progress
            .store(progress.unwrap_or(false), Ordering::Relaxed);
        self.pulls_diagnostics
            .store(pulls_diagnostics(can), Ordering::Relaxed);
    }
}

/// Whether the client can request diagnostics and be asked to repeat that: a linked file may change while the text
/// does not.
pub(super) fn pulls_diagnostics(can: &ClientCapabilities) -> bool {
    let text = can.text_document.as_ref();
    let workspace = can.workspace.as_ref();
    let again = workspace
        .and_then(|workspace| workspace.diagnostics.as_ref())
        .and_then(|can| can.refresh_support);
    text.is_some_and(|text| text.diagnostic.is_some()) && again.unwrap_or(false)
}
