//! `okoshi motion`

use std::fmt::Write as _;
use std::path::Path;

use super::args::{Common, Motion};
use super::progress::spinning;
use super::{Outcome, fail, print_out};
use crate::disk::{WriteError, is_same_file, open_stream, write_atomic};
use crate::export::{self, Exporter};
use crate::motion::bvh::{self, Reading};
use crate::motion::edit::{Edited, How, edit};
use crate::motion::labels::{Anatomy, Label};
use crate::motion::limited::{self, Error, Length, Method};
use crate::motion::ready::{self, LeadIn};
use crate::motion::resample::rate;
use crate::motion::skeleton::Clip;
use crate::motion::stick::stick_figure;
use crate::report::ranges;

/// What is to be written.
#[derive(Clone, Copy)]
enum Kind {
    Bvh,
    Model(&'static dyn Exporter),
    Chart,
}

/// Edits a motion by itself, or says what is in it.
pub(super) fn run(arguments: &Motion, common: Common) -> Outcome {
    let kind = match arguments
        .output
        .as_deref()
        .map(|output| kind(output, &arguments.motion))
        .transpose()
    {
        Ok(kind) => kind,
        Err(message) => return fail(&message),
    };
    let name = arguments.motion.display().to_string();
    let stream = match open_stream(&arguments.motion) {
        Ok(stream) => stream,
        Err(error) => return fail(&error.to_string()),
    };
    let reading = match spinning("reading", || bvh::read(stream)) {
        Ok(reading) => reading,
        Err(mut error) => {
            let rescued = error.partial.take().filter(|clip| clip.frames() > 0);
            fail(&format!("{name}: {error}"));
            eprintln!("  help: {}", error.help);
            match rescued {
                Some(clip) if arguments.keep_going => {
                    eprintln!("  going on with the {} before it", frames(clip.frames()));
                    Reading {
                        clip: *clip,
                        notes: Vec::new(),
                    }
                }
                Some(clip) => {
                    eprintln!(
                        "  help: --keep-going goes on with the {} before it",
                        frames(clip.frames())
                    );
                    return Outcome::Failed;
                }
                None => return Outcome::Failed,
            }
        }
    };
    let mut told = String::new();
    for note in &reading.notes {
        let _ = writeln!(told, "  {note}");
    }
    let opening = describe(&reading.clip);
    let options = ready::Options {
        fps: arguments.fps,
        lead_in: if arguments.keep_rest {
            LeadIn::Keep
        } else {
            LeadIn::Drop
        },
        range: arguments.range,
    };
    let how = how(arguments);
    let edited = spinning("cutting", || {
        edit(reading.clip, &options, how, arguments.camera)
    });
    let edited = match edited {
        Ok(edited) => edited,
        Err(error) => return fail(&format!("`{name}`: {error}")),
    };
    for note in &edited.notes {
        let _ = writeln!(told, "  {note}");
    }
    let plot = arguments.plot.as_ref().map(|plot| (plot, Kind::Chart));
    let outputs = arguments.output.as_ref().zip(kind).into_iter().chain(plot);
    let mut wrote = String::new();
    let mut count = 0;
    for (output, kind) in outputs {
        if let Err(error) = spinning("writing", || write(&edited, output, kind, arguments)) {
            return fail(&error.to_string());
        }
        if output.as_os_str() != "-" {
            let _ = writeln!(wrote, "wrote {}", output.display());
        }
        count += 1;
    }
    let cuts = arguments.compare
        || arguments.omit.is_some()
        || arguments.hold.is_some()
        || arguments.every.is_some()
        || arguments.drawings.is_some();
    if !common.quiet && (count > 0 || cuts) {
        told.push_str(&report(&edited, arguments));
    }
    if !common.quiet {
        eprint!("{name}: {opening}\n{told}{wrote}");
    }
    match count {
        0 => print_out(&joints(&edited.clip, &edited.anatomy)),
        _ => Outcome::Done,
    }
}

/// What a file's ending asks for.
fn kind(output: &Path, input: &Path) -> Result<Kind, String> {
    let ending = output
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    if output.as_os_str() != "-" && is_same_file(output, input) {
        return Err(format!(
            "`{}` is the motion itself: name another file, so that nothing is lost",
            output.display()
        ));
    }
    match ending.as_deref() {
        _ if output.as_os_str() == "-" => Ok(Kind::Bvh),
        Some("bvh") => Ok(Kind::Bvh),
        Some("svg") => Ok(Kind::Chart),
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

/// How the arguments want the motion to be cut.
fn how(arguments: &Motion) -> How {
    match (arguments.every, arguments.drawings) {
        _ if arguments.full => How::Full,
        (Some(every), _) => How::Every(every),
        (None, Some(drawings)) => How::Drawings(drawings),
        (None, None) => How::Limited {
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

/// Writes a file.
fn write(edited: &Edited, output: &Path, kind: Kind, arguments: &Motion) -> Result<(), WriteError> {
    let stem = arguments.motion.file_stem().filter(|stem| *stem != "-");
    let stem = stem.map_or("motion".into(), |stem| stem.to_string_lossy());
    match kind {
        Kind::Bvh => write_atomic(output, |out| edited.write_bvh(out)),
        Kind::Chart => write_atomic(output, |out| out.write_all(edited.chart(&stem).as_bytes())),
        Kind::Model(exporter) => {
            let exposure = edited.exposure.as_ref();
            let scene = stick_figure(&edited.clip, exposure, &stem, edited.to_model);
            write_atomic(output, |out| {
                export::write(exporter, &scene, out, None).map(|_| ())
            })
        }
    }
}

/// A clip in a line.
fn describe(clip: &Clip) -> String {
    let joints = clip.skeleton.joints.len();
    format!(
        "{joints} joint{}, {} at {} a second",
        if joints == 1 { "" } else { "s" },
        frames(clip.frames()),
        round(rate(clip.frame_time)),
    )
}

fn frames(count: usize) -> String {
    match count {
        1 => "1 frame".to_owned(),
        count => format!("{count} frames"),
    }
}

/// A number with at most two decimals.
fn round(number: f64) -> f64 {
    (number * 100.0).round() / 100.0
}

/// What was omitted and held, and how far that is from the source.
fn report(edited: &Edited, arguments: &Motion) -> String {
    let mut out = String::new();
    let count = edited.clip.frames();
    let fps = round(rate(edited.clip.frame_time));
    let _ = writeln!(out, "  {} at {fps} a second", frames(count));
    let Some(bindings) = &edited.exposure else {
        return out;
    };
    if let Some(cut) = &edited.cut {
        let mut omitted: Vec<u32> = cut.omitted.iter().map(|frame| frame + 1).collect();
        omitted.sort_unstable();
        let which = match omitted.is_empty() {
            true => String::new(),
            false => format!(" ({})", ranges(&omitted, usize::MAX)),
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
                "  warning: {} were to be omitted: no more can be, with the length kept",
                omit.asked
            );
        }
        if hold.shortfall() > 0 {
            let _ = writeln!(
                out,
                "  warning: {} were to be held: no pose may stand for more than {} frames",
                hold.asked,
                limited::LONGEST_COPIED
            );
        }
        if cut.gathered > limited::MOST_GATHERED {
            let _ = writeln!(
                out,
                "  warning: {} were omitted in one place, which tears a motion apart: 4 to 6 look right, of one action a clip",
                cut.gathered
            );
        }
    }
    if let Some(drawn) = edited
        .drawn
        .as_ref()
        .filter(|drawn| drawn.asked != drawn.drawings)
    {
        let _ = writeln!(
            out,
            "  warning: {} drawings were asked for: {} to {} are possible, for one stands for {} frames at most",
            drawn.asked,
            drawn.fewest,
            drawn.most,
            limited::LONGEST
        );
    }
    let shown = bindings.len();
    let _ = writeln!(
        out,
        "  {} drawings for {}",
        bindings.drawings().count(),
        frames(shown)
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

/// How far joints are off.
fn off(error: &Error) -> String {
    match error.percent {
        Some(percent) => format!("{percent:.2} % of the height (RMS)"),
        None => format!("{:.4} of the file's unit (RMS)", error.rms),
    }
}

/// The joints as a tree, each with what it is.
fn joints(clip: &Clip, anatomy: &Anatomy) -> String {
    let mut depth: Vec<usize> = Vec::new();
    let mut rows: Vec<[String; 2]> = Vec::new();
    for (index, joint) in clip.skeleton.joints.iter().enumerate() {
        depth.push(joint.parent.map_or(0, |parent| depth[parent] + 1));
        // Deep chains would run off any page.
        let indent = "  ".repeat(depth[index].min(40));
        let what = anatomy
            .labels
            .get(index)
            .and_then(Option::as_ref)
            .map(Label::describe);
        rows.push([format!("{indent}{}", joint.name), what.unwrap_or_default()]);
    }
    let width = rows
        .iter()
        .map(|[name, _]| name.chars().count())
        .max()
        .unwrap_or(0);
    rows.iter().fold(String::new(), |mut out, [name, what]| {
        let line = format!("{name:width$}  {what}");
        let _ = writeln!(out, "{}", line.trim_end());
        out
    })
}
