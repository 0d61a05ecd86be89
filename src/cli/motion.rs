//! `okoshi motion`

use std::fmt::Write as _;
use std::path::Path;

use typed_index_collections::TiVec;

use super::args::{Common, Motion};
use super::progress::spinning;
use super::{Failure, Outcome, counted, ending, fail, print_out};
use crate::clips::BuiltIn;
use crate::disk::{Inputs, Naming, Target, WriteError, is_standard_stream, open_stream};
use crate::export::{self, Exporter};
use crate::labels::{Anatomy, Label};
use crate::limited::frame_ranges;
use crate::limited::{self, Error, Length, Method};
use crate::mocap::bvh::{self, Reading};
use crate::mocap::resample::rate;
use crate::mocap::{Clip, JointId};
use crate::motion::edit::{self, EditedClip, ExposureMethod, Filmed, edit};
use crate::motion::{add_camera, skeleton_model};
use crate::prepare::{self, LeadInPolicy};

mod in_turn;
mod performance;

/// What to write.
#[derive(Clone, Copy)]
enum Kind {
    Bvh,
    Model(&'static dyn Exporter),
    Chart,
}

/// Edits a motion file, or lists its joints.
pub(super) fn run(arguments: &Motion, common: Common) -> Result<Outcome, Failure> {
    let kind = arguments.output.as_deref().map(kind).transpose()?;
    let plot = arguments.plot.as_ref().map(|plot| (plot, Kind::Chart));
    let outputs = arguments.output.as_ref().zip(kind).into_iter().chain(plot);
    let track = arguments.performing.perform.clone();
    let mut inputs = Inputs::of(&arguments.motion).linking(track);
    let mut targets = Vec::new();
    for (output, kind) in outputs {
        targets.push((output, inputs.target(output, Naming::Given)?, kind));
        // The chart must not replace the motion that was written before.
        inputs = inputs.writing(output);
    }
    let name = arguments.motion.display().to_string();
    let mut messages = String::new();
    let options = prepare::Options {
        fps: arguments.fps,
        lead_in: if arguments.keep_rest {
            LeadInPolicy::Keep
        } else {
            LeadInPolicy::Drop
        },
        range: arguments.range,
        speed: arguments.speed,
        up: arguments.up,
        is_loop: arguments.is_loop,
        is_in_place: arguments.in_place,
    };
    let (opening, prepared) = match built_in(arguments) {
        Some(which) => {
            let turns = in_turn::turns(which, arguments)?;
            let opening = describe(&turns.0.clip.clip);
            (opening, in_turn::joined(turns, &options))
        }
        None => {
            if let Some(near) = in_turn::meant(&arguments.motion) {
                return Err(in_turn::unknown(&name, near).into());
            }
            if let Some(other) = arguments.in_turn.first() {
                return Err(in_turn::not_in_turn(other).into());
            }
            let reading = read(arguments, &name)?;
            for note in &reading.notes {
                let _ = writeln!(messages, "  {note}");
            }
            let opening = describe(&reading.clip);
            let options = in_turn::cut(&reading.clip, arguments, options)?;
            let prepared = spinning("cutting", || prepare::prepare(reading.clip, &options));
            (opening, prepared)
        }
    };
    let prepared = prepared.map_err(|error| format!("`{name}`: {error}"))?;
    let performed = performance::perform(&arguments.performing, prepared)?;
    messages.push_str(&performed.messages);
    let options = edit::Options {
        method: exposure_method(arguments),
        points: arguments.points,
        camera: arguments.camera,
        key: performed.key_frame,
    };
    let mut edited = spinning("cutting", || edit(performed.prepared, &options));
    for note in &edited.notes {
        let _ = writeln!(messages, "  {note}");
    }
    if let Some(cycle) = edited.cycle {
        let (first, last) = (cycle.first + 1, cycle.last + 1);
        let _ = writeln!(messages, "  a loop of the frames {first} to {last}");
    }
    let report = report(&edited, arguments);
    if let Some(film) = performed.film
        && edited.film(film) == Filmed::NotMoved
    {
        messages.push_str("  warning: the root of the motion has no position: it is not moved\n");
    }
    let mut wrote = String::new();
    for (output, target, kind) in &targets {
        spinning("writing", || write(&edited, target, *kind, arguments))?;
        if !is_standard_stream(output) {
            let _ = writeln!(wrote, "wrote {}", output.display());
        }
    }
    let cuts = arguments.compare
        || arguments.omit.is_some()
        || arguments.hold.is_some()
        || arguments.every.is_some()
        || arguments.drawings.is_some();
    if !common.quiet && (!targets.is_empty() || cuts) {
        messages.push_str(&report);
    }
    if !common.quiet {
        eprint!("{name}: {opening}\n{messages}{wrote}");
    }
    Ok(if targets.is_empty() {
        print_out(&joints(&edited.clip, &edited.anatomy))
    } else {
        Outcome::Done
    })
}

/// The clip that comes along that the argument names; a file of that name is `./walk`.
fn built_in(arguments: &Motion) -> Option<BuiltIn> {
    arguments.motion.to_str().and_then(BuiltIn::from_name)
}

/// Why a clip that moves the parts of a figure cannot be written.
fn needs_a_figure(which: BuiltIn) -> String {
    let word = which.name();
    format!(
        "`{word}` moves the parts of a figure and has no skeleton: write `Motion {word}` in a drawing, and build that"
    )
}

/// Reads the motion file; failures are reported.
fn read(arguments: &Motion, name: &str) -> Result<Reading, Outcome> {
    let stream = open_stream(&arguments.motion).map_err(fail)?;
    let mut error = match spinning("reading", || bvh::read(stream)) {
        Ok(reading) => return Ok(reading),
        Err(error) => error,
    };
    let rescued = error.partial.take().filter(|clip| clip.frames > 0);
    let outcome = fail(format!("{name}: {error}"));
    eprintln!("  help: {}", error.help);
    let Some(clip) = rescued else {
        return Err(outcome);
    };
    let before = counted(clip.frames, "frame");
    if !arguments.keep_going {
        eprintln!("  help: --keep-going continues with the {before} before it");
        return Err(outcome);
    }
    eprintln!("  continuing with the {before} before it");
    Ok(Reading {
        clip: *clip,
        notes: Vec::new(),
    })
}

/// What to write, by the ending of the output's name.
fn kind(output: &Path) -> Result<Kind, String> {
    match ending(output).as_str() {
        _ if is_standard_stream(output) => Ok(Kind::Bvh),
        "bvh" => Ok(Kind::Bvh),
        "svg" => Ok(Kind::Chart),
        _ => match export::by_extension(output).filter(|exporter| exporter.is_animated()) {
            Some(exporter) => Ok(Kind::Model(exporter)),
            None => Err(format!(
                "the output `{}` must end in .bvh (the motion), {} (a model that plays it) or .svg (a chart of it)",
                output.display(),
                export::extensions(|exporter| exporter.is_animated()),
            )),
        },
    }
}

/// How to thin out the motion, by the arguments.
fn exposure_method(arguments: &Motion) -> ExposureMethod {
    let is_limited = arguments.omit.is_some() || arguments.hold.is_some() || arguments.shorten;
    match (arguments.every, arguments.drawings) {
        _ if arguments.full => ExposureMethod::Full,
        // Clips that come along are even motions, from which nothing is omitted unasked.
        (None, None) if built_in(arguments).is_some() && !is_limited => ExposureMethod::Full,
        (Some(every), _) => ExposureMethod::Every(every),
        (None, Some(drawings)) => ExposureMethod::Drawings(drawings),
        (None, None) => ExposureMethod::Limited {
            omit: arguments.omit,
            hold: arguments.hold,
            length: if arguments.shorten {
                Length::Shortened
            } else {
                Length::Kept
            },
        },
    }
}

fn write(
    edited: &EditedClip,
    target: &Target,
    kind: Kind,
    arguments: &Motion,
) -> Result<(), WriteError> {
    let stem = arguments.motion.file_stem().filter(|stem| *stem != "-");
    let stem = stem.map_or("motion".into(), |stem| stem.to_string_lossy());
    match kind {
        Kind::Bvh => target.write(|out| edited.write_bvh(out)),
        Kind::Chart => target.write(|out| out.write_all(edited.chart(&stem).as_bytes())),
        Kind::Model(exporter) => {
            let exposure = edited.exposure.as_ref();
            let mut scene = skeleton_model(&edited.clip, exposure, &stem, edited.to_model);
            if let Some(joint) = edited.filmed_joint {
                add_camera(&mut scene, &edited.clip, exposure, joint, edited.to_model);
            }
            target.write(|out| export::write(exporter, &scene, out, None).map(|_| ()))
        }
    }
}

/// Describes a clip in one line.
fn describe(clip: &Clip) -> String {
    format!(
        "{}, {} at {} a second",
        counted(clip.skeleton.joints.len(), "joint"),
        counted(clip.frames, "frame"),
        round(rate(clip.frame_time)),
    )
}

/// Rounds to two decimals.
fn round(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

/// Reports what was omitted and held, and the error against the source.
fn report(edited: &EditedClip, arguments: &Motion) -> String {
    let mut out = String::new();
    let frames = counted(edited.clip.frames, "frame");
    let fps = round(rate(edited.clip.frame_time));
    let _ = writeln!(out, "  {frames} at {fps} a second");
    let Some(exposure) = &edited.exposure else {
        return out;
    };
    if let Some(cut) = &edited.cut {
        let mut omitted: Vec<u32> = cut.omitted.clone();
        omitted.sort_unstable();
        let which = if omitted.is_empty() {
            String::new()
        } else {
            format!(" ({})", frame_ranges(&omitted, usize::MAX))
        };
        let _ = writeln!(
            out,
            "  omitted {}{which}, held {}",
            cut.omitted.len(),
            cut.held.len()
        );
        let (omit, hold) = (cut.omissions, cut.holds);
        if omit.shortfall() > 0 {
            let _ = writeln!(
                out,
                "  warning: {} omissions were asked for: no more are possible while the length is kept",
                omit.asked
            );
        }
        if hold.shortfall() > 0 {
            let _ = writeln!(
                out,
                "  warning: {} holds were asked for: no pose may be held for more than {} frames",
                hold.asked,
                limited::MAX_COPIED_FRAMES
            );
        }
        if cut.omitted_run > limited::MAX_OMITTED_RUN {
            let _ = writeln!(
                out,
                "  warning: {} were omitted in a row, which tears a motion apart: 4 to 6 look right, in a clip of one action",
                cut.omitted_run
            );
        }
    }
    if let Some(drawn) = edited
        .best_drawings
        .as_ref()
        .filter(|drawn| drawn.asked != drawn.drawings)
    {
        let _ = writeln!(
            out,
            "  warning: {} drawings were asked for: {} to {} are possible, because a drawing is held for at most {} frames",
            drawn.asked,
            drawn.fewest,
            drawn.most,
            limited::MAX_HOLD
        );
    }
    let shown = counted(exposure.len(), "frame");
    let _ = writeln!(
        out,
        "  {} drawings for {shown}",
        exposure.drawings().count()
    );
    let compares = arguments.compare || arguments.every.is_some() || arguments.drawings.is_some();
    let methods = if compares { edited.compared() } else { None };
    match methods {
        Some(methods) => {
            for (method, error) in methods {
                let name = match method {
                    Method::Asked => "as asked",
                    Method::Twos => "on twos",
                    Method::Threes => "on threes",
                    Method::Best => "best drawings",
                };
                let _ = writeln!(
                    out,
                    "  {name:>13}: {:>5} drawings, joints off by {}",
                    error.drawings,
                    off(&error)
                );
            }
        }
        None => {
            if let Some(error) = edited.error() {
                let _ = writeln!(out, "  joints off by {}", off(&error));
            }
        }
    }
    out
}

/// The error of the joints.
fn off(error: &Error) -> String {
    match error.percent {
        Some(percent) => format!("{percent:.2} % of the height (RMS)"),
        None => format!("{:.4} of the file's unit (RMS)", error.rms),
    }
}

/// The joints as a tree, each with its label.
fn joints(clip: &Clip, anatomy: &Anatomy) -> String {
    let mut depth: TiVec<JointId, usize> = TiVec::new();
    let mut rows: Vec<[String; 2]> = Vec::new();
    for (id, joint) in clip.skeleton.joints.iter_enumerated() {
        depth.push(joint.parent.map_or(0, |parent| depth[parent] + 1));
        // Limited, because deep chains would become wider than any terminal.
        let indent = "  ".repeat(depth[id].min(40));
        let what = anatomy
            .labels
            .get(id)
            .and_then(Option::as_ref)
            .map(Label::describe);
        rows.push([format!("{indent}{}", joint.name), what.unwrap_or_default()]);
    }
    let widths = rows.iter().map(|[name, _]| name.chars().count());
    let width = widths.max().unwrap_or(0);
    rows.iter().fold(String::new(), |mut out, [name, what]| {
        let line = format!("{name:width$}  {what}");
        let _ = writeln!(out, "{}", line.trim_end());
        out
    })
}
