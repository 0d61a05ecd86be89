//! Long lists of the JSON: their elements become text on all cores, and are written in order.

use std::io::{self, Write};
use std::ops::Range;

use rayon::prelude::*;
use serde::Serialize;

/// Elements that one thread turns into text at a time.
const CHUNK: usize = 1024;
/// Chunks that are in memory at once.
const CHUNKS: usize = 32;

/// Elements of a list as text, with commas between them.
#[derive(Default)]
pub(super) struct Elements(Vec<u8>);

impl Elements {
    /// Appends an element.
    pub(super) fn push(&mut self, element: &impl Serialize) -> io::Result<()> {
        if !self.0.is_empty() {
            self.0.push(b',');
        }
        Ok(serde_json::to_writer(&mut self.0, element)?)
    }
}

/// Writes `,"name":[…]`: what `describe` pushes for each range of the numbers below `count`.
pub(super) fn list(
    out: &mut (impl Write + ?Sized),
    name: &str,
    count: usize,
    describe: impl Fn(Range<usize>, &mut Elements) -> io::Result<()> + Sync,
) -> io::Result<()> {
    write!(out, r#","{name}":["#)?;
    let mut first = true;
    for window in (0..count).step_by(CHUNK * CHUNKS) {
        let end = count.min(window + CHUNK * CHUNKS);
        let chunks: Vec<Elements> = (window..end)
            .into_par_iter()
            .step_by(CHUNK)
            .map(|start| {
                let mut elements = Elements::default();
                describe(start..end.min(start + CHUNK), &mut elements)?;
                Ok(elements)
            })
            .collect::<io::Result<_>>()?;
        for Elements(text) in chunks.iter().filter(|elements| !elements.0.is_empty()) {
            if !std::mem::take(&mut first) {
                out.write_all(b",")?;
            }
            out.write_all(text)?;
        }
    }
    out.write_all(b"]")
}
