//! Workspace symbols: the parts of all drawings in the client's folders.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

use tower_lsp::ls_types::{Location, OneOf, Range, Uri, WorkspaceSymbol};

use super::documents::Snapshot;
use crate::compile::{Options, compile};
use crate::disk::{FolderResolver, below, decode, is_drawing, read_drawing, stamp};
use crate::ide::{Analysis, Outline, has_letters};
use crate::protocol::convert;
use crate::protocol::positions::{Encoding, Positions};

/// The most symbols in an answer; a longer query finds the rest.
const MAX_SYMBOLS: usize = 500;

/// A part of a drawing.
#[derive(Debug, Clone)]
struct PartSymbol {
    name: String,
    on: Option<String>,
    is_joint: bool,
    range: Range,
}

/// The parts of a drawing, with the stamp of the file that they were read from.
#[derive(Debug)]
struct CachedParts {
    stamp: (u64, SystemTime),
    parts: Arc<Vec<PartSymbol>>,
}

/// The client's folders, and a cache of their drawings' parts.
#[derive(Debug, Default)]
pub(super) struct Workspace {
    folders: Mutex<Vec<PathBuf>>,
    read: Mutex<BTreeMap<PathBuf, CachedParts>>,
}

impl Workspace {
    /// Adds and removes folders.
    pub(super) fn change(&self, added: Vec<PathBuf>, removed: &[PathBuf]) {
        let mut folders = self.folders.lock().unwrap_or_else(PoisonError::into_inner);
        folders.retain(|folder| !removed.contains(folder));
        folders.extend(added);
    }

    /// The parts whose names contain the letters of `query` in this order. Open drawings count in their
    /// present state, all others as saved.
    pub(super) fn symbols(
        &self,
        query: &str,
        open: &BTreeMap<String, Snapshot>,
        encoding: Encoding,
    ) -> Vec<WorkspaceSymbol> {
        let mut found = vec![];
        let mut open_files = vec![];
        for snapshot in open.values() {
            let analyzed = snapshot.analyses.borrow().clone();
            if let Some(analyzed) = analyzed {
                open_files.extend(snapshot.document.path.clone());
                let parts = parts(&analyzed.analysis, &analyzed.document.positions);
                add_matches(&parts, query, &snapshot.document.uri, &mut found);
            }
        }
        let folders = self
            .folders
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        for folder in folders {
            let drawings = below(&folder)
                .files
                .into_iter()
                .filter(|file| is_drawing(file));
            for file in drawings.filter(|file| !open_files.contains(file)) {
                if found.len() >= MAX_SYMBOLS {
                    break;
                }
                if let (Some(parts), Some(uri)) =
                    (self.read(&file, encoding), Uri::from_file_path(&file))
                {
                    add_matches(&parts, query, &uri, &mut found);
                }
            }
        }
        found.truncate(MAX_SYMBOLS);
        found
    }

    fn read(&self, file: &Path, encoding: Encoding) -> Option<Arc<Vec<PartSymbol>>> {
        let stamp = stamp(file)?;
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
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
        let known = CachedParts {
            stamp,
            parts: parts.clone(),
        };
        read.insert(file.to_owned(), known);
        Some(parts)
    }
}

fn parts(analysis: &Analysis, positions: &Positions) -> Vec<PartSymbol> {
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
        found.push(PartSymbol {
            name: part.name,
            on,
            is_joint: part.is_joint,
            range: positions.range(part.selection),
        });
    }
    found
}

fn add_matches(parts: &[PartSymbol], query: &str, uri: &Uri, found: &mut Vec<WorkspaceSymbol>) {
    let matching = parts.iter().filter(|part| has_letters(&part.name, query));
    found.extend(matching.map(|part| WorkspaceSymbol {
        name: part.name.clone(),
        kind: convert::symbol_kind(part.is_joint),
        tags: None,
        container_name: part.on.clone(),
        location: OneOf::Left(Location::new(uri.clone(), part.range)),
        data: None,
    }));
}
