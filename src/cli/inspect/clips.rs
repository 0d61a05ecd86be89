//! What figures play, and which joint drives which part.

use std::fmt::Write as _;

use super::columns;
use crate::compile::Compiled;
use crate::report::{cut_frames, ranges, undriven};

/// How many stretches of frames are listed one by one.
const MOST_RANGES: usize = 12;

/// Each clip with its length and drawings, and per part what drives it and why.
pub(super) fn clips(compiled: &Compiled) -> String {
    let parts = &compiled.bindings.parts;
    let mut out = String::new();
    for shot in &compiled.shots {
        let _ = writeln!(
            out,
            "clip {} of {}, from {}: {:.2} s, {}, {}",
            shot.name,
            parts[shot.root].name,
            shot.file,
            shot.seconds(),
            counted(shot.frames(), "frame"),
            counted(shot.drawings(), "drawing"),
        );
        let (omitted, held) = cut_frames(shot);
        for (what, frames) in [("omitted", omitted), ("held", held)] {
            if !frames.is_empty() {
                let ranges = ranges(&frames, MOST_RANGES);
                let _ = writeln!(
                    out,
                    "   {what} {}: {ranges}",
                    counted(frames.len(), "frame")
                );
            }
        }
        let rows = shot.parts.iter().map(|driven| {
            let name = format!("   {}", parts[driven.part].name);
            match driven.joint {
                Some(joint) => [name, shot.joint_name(joint).to_owned(), driven.why.clone()],
                None => [name, "-".to_owned(), undriven(shot, driven)],
            }
        });
        out.push_str(&columns(&rows.collect::<Vec<_>>()));
    }
    out
}

fn counted(count: usize, thing: &str) -> String {
    match count {
        1 => format!("1 {thing}"),
        count => format!("{count} {thing}s"),
    }
}
