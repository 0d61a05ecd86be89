//! Parts of all drawings in the client's folders, by name.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use tower_lsp::ls_types::{Location, OneOf, Range, Uri, WorkspaceSymbol};

use super::convert;
use super::documents::Snapshot;
use super::positions::{Encoding, Positions};
use crate::compile::{Options, compile};
use crate::disk::{FolderResolver, below, decode, is_drawing, read_drawing, stamp};
use crate::ide::{Analysis, Outline};

/// How many symbols are answered at most; a longer query finds what is missing.
const MOST: usize = 500;

/// A part of a drawing.
#[derive(Debug, Clone)]
struct Found {
    name: String,
    on: Option<String>,
    is_joint: bool,
    range: Range,
}

/// The parts of a drawing, and how its file was when they were read.
#[derive(Debug)]
struct Read {
    stamp: (u64, SystemTime),
    parts: Arc<Vec<Found>>,
}

/// The client's folders, and what was read there.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    folders: Mutex<Vec<PathBuf>>,
    read: Mutex<BTreeMap<PathBuf, Read>>,
}

impl Workspace {
    /// Adds and removes folders.
    pub(super) fn change(&self, added: Vec<PathBuf>, removed: &[PathBuf]) {
        let mut folders = self
            .folders
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        folders.retain(|folder| !removed.contains(folder));
        folders.extend(added);
    }

    /// The parts whose name holds the letters of `query` in their order. Drawings that are open count as they are
    /// there, all others as they are on disk.
    pub(super) fn symbols(
        &self,
        query: &str,
        open: &BTreeMap<String, Snapshot>,
        encoding: Encoding,
    ) -> Vec<WorkspaceSymbol> {
        let mut found = vec![];
        let mut seen = vec![];
        for snapshot in open.values() {
            let analysed = snapshot.arrivals.borrow().clone();
            if let Some(analysed) = analysed {
                seen.extend(snapshot.document.path.clone());
                let parts = parts(&analysed.analysis, &analysed.document.positions);
                add(&parts, query, &snapshot.document.uri, &mut found);
            }
        }
        let folders = self
            .folders
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
            .clone();
        for folder in folders {
            let drawings = below(&folder)
                .files
                .into_iter()
                .filter(|file| is_drawing(file));
            for file in drawings.filter(|file| !seen.contains(file)) {
                if found.len() >= MOST {
                    break;
                }
                if let (Some(parts), Some(uri)) =
                    (self.read(&file, encoding), Uri::from_file_path(&file))
                {
                    add(&parts, query, &uri, &mut found);
                }
            }
        }
        found.truncate(MOST);
        found
    }

    fn read(&self, file: &Path, encoding: Encoding) -> Option<Arc<Vec<Found>>> {
        let stamp = stamp(file)?;
        let mut read = self
            .read
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(known) = read.get(file).filter(|known| known.stamp == stamp) {
            return Some(known.parts.clone());
        }
        let text = decode(read_drawing(file).ok()?).ok()?;
        let resolver = FolderResolver::new(file.parent()?);
        let analysis = Analysis::new(
            text.as_str(),
            compile(&text, &Options::default(), &resolver),
        );
        let positions = Positions::new(analysis.source().clone(), encoding);
        let parts = Arc::new(parts(&analysis, &positions));
        let known = Read {
            stamp,
            parts: parts.clone(),
        };
        read.insert(file.to_owned(), known);
        Some(parts)
    }
}

fn parts(analysis: &Analysis, positions: &Positions) -> Vec<Found> {
    let mut found = vec![];
    let mut waiting: Vec<(Outline, Option<String>)> = analysis
        .outline()
        .into_iter()
        .rev()
        .map(|part| (part, None))
        .collect();
    while let Some((part, on)) = waiting.pop() {
        let name = Some(part.name.clone());
        waiting.extend(
            part.children
                .into_iter()
                .rev()
                .map(|child| (child, name.clone())),
        );
        found.push(Found {
            name: part.name,
            on,
            is_joint: part.is_joint,
            range: positions.range(part.selection),
        });
    }
    found
}

fn add(parts: &[Found], query: &str, uri: &Uri, found: &mut Vec<WorkspaceSymbol>) {
    let fitting = parts.iter().filter(|part| fits(&part.name, query));
    found.extend(fitting.map(|part| WorkspaceSymbol {
        name: part.name.clone(),
        kind: convert::symbol_kind(part.is_joint),
        tags: None,
        container_name: part.on.clone(),
        location: OneOf::Left(Location::new(uri.clone(), part.range)),
        data: None,
    }));
}

/// Whether the letters of `query` stand in `name` in their order, whatever their case.
fn fits(name: &str, query: &str) -> bool {
    let mut letters = name.chars().flat_map(char::to_lowercase);
    let mut wanted = query.chars().flat_map(char::to_lowercase);
    wanted.all(|wanted| letters.any(|letter| letter == wanted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_by_their_letters() {
        for (name, query, expected) in [
            ("Ubody", "", true),
            ("Ubody", "ubd", true),
            ("Ubody", "bu", false),
            ("右腕", "腕", true),
        ] {
            assert_eq!(fits(name, query), expected, "{name} {query}");
        }
    }
}
