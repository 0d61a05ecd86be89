//! The clips that figures play, and which joint drives which part.

use std::fmt::Write as _;

use super::columns;
use crate::cli::counted;
use crate::compile::Compiled;
use crate::limited::frame_ranges;
use crate::rig::Performance;

/// How many runs of frames are listed individually.
const MAX_RANGES: usize = 12;

/// Each clip with its length and its drawings, and per part the joint that drives it and why.
pub(super) fn clips(compiled: &Compiled) -> String {
    let parts = &compiled.bindings.parts;
    let mut out = String::new();
    for clip in &compiled.clips {
        let _ = writeln!(
            out,
            "clip {} of {}, from {}: {:.2} s, {}, {}",
            clip.name,
            parts[clip.root].name,
            clip.file,
            clip.seconds(),
            counted(clip.frames(), "frame"),
            counted(clip.drawings(), "drawing"),
        );
        let turns = clip.turns_in_words();
        if !turns.is_empty() {
            let _ = writeln!(out, "   in turn: {}", turns.join(", "));
        }
        let (omitted, held) = clip.cut_frames();
        for (what, frames) in [("omitted", omitted), ("held", held)] {
            if !frames.is_empty() {
                let ranges = frame_ranges(&frames, MAX_RANGES);
                let _ = writeln!(
                    out,
                    "   {what} {}: {ranges}",
                    counted(frames.len(), "frame")
                );
            }
        }
        if let Some(performance) = clip.performance(&compiled.bindings) {
            out.push_str(&performed(&performance));
        }
        let rows = clip.parts.iter().map(|drive| {
            let name = format!("   {}", parts[drive.part].name);
            match drive.joint {
                Some(joint) => [name, clip.joint_name(joint).to_owned(), drive.why.clone()],
                None => [name, "-".to_owned(), clip.undriven(drive)],
            }
        });
        out.push_str(&columns(&rows.collect::<Vec<_>>()));
    }
    out
}

/// What a performance does to a clip: its timing, what each mark does, and how it is filmed.
fn performed(performance: &Performance<'_>) -> String {
    let mut out = format!(
        "   performed by {}: {}\n",
        performance.track,
        performance.timing()
    );
    let rows = performance.marks.iter().map(|mark| {
        [
            format!("   mark {}", mark.name),
            mark.performs.join(", "),
            mark.effect(),
        ]
    });
    out.push_str(&columns(&rows.collect::<Vec<_>>()));
    let _ = writeln!(out, "   {}", performance.filmed());
    out
}
