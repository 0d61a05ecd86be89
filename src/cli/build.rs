//! `okoshi build`

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::args::{Build, Common};
use super::loading::{Loaded, load, made_from, resolver};
use super::parallel::each;
use super::progress::spinning;
use super::{Failure, Outcome, counted};
use crate::disk::{Inputs, Naming, is_drawing, is_standard_stream};
use crate::export::{self, Exporter, GLB, Written};
use crate::report::part_count;

/// Builds every drawing, several in parallel, and reports in the order given.
pub(super) fn run(arguments: &Build, common: Common) -> Result<Outcome, Failure> {
    let outputs = distinct(outputs(arguments)?)?;
    let tasks: Vec<(&PathBuf, &PathBuf)> = arguments.drawings.iter().zip(&outputs).collect();
    let built = spinning("building", || {
        each(&tasks, |(drawing, output)| {
            build(drawing, output, arguments, common)
        })
    });
    let mut worst = Outcome::Done;
    for (outcome, text) in built {
        eprint!("{text}");
        worst = worst.max(outcome);
    }
    Ok(worst)
}

/// The output file of each drawing.
fn outputs(arguments: &Build) -> Result<Vec<PathBuf>, Failure> {
    let several = arguments.drawings.len() > 1;
    if several && arguments.depfile.is_some() {
        return Err("--depfile goes with one drawing; build the drawings one by one".into());
    }
    let folder = match &arguments.output {
        Some(output) if !output.is_dir() => {
            if several {
                return Err("with several drawings, -o must name an existing folder".into());
            }
            exporter(output)?;
            return Ok(vec![output.clone()]);
        }
        folder => folder.as_deref(),
    };
    let output = |drawing: &PathBuf| made_from(drawing, folder, GLB.extension());
    Ok(arguments
        .drawings
        .iter()
        .map(output)
        .collect::<Result<_, _>>()?)
}

/// Refuses two drawings that would be written to one file.
fn distinct(outputs: Vec<PathBuf>) -> Result<Vec<PathBuf>, String> {
    let mut seen = BTreeSet::new();
    match outputs.iter().find(|output| !seen.insert(*output)) {
        Some(twice) => Err(format!(
            "two drawings would both be written to `{}`; build them one by one, each with its own -o",
            twice.display()
        )),
        None => Ok(outputs),
    }
}

/// The exporter for the extension of the output.
fn exporter(output: &Path) -> Result<&'static dyn Exporter, String> {
    if is_standard_stream(output) {
        return Ok(&GLB);
    }
    export::by_extension(output).ok_or_else(|| {
        let name = output.display();
        if is_drawing(output) {
            return overwrites_drawing(output);
        }
        let extensions = export::extensions(|_| true);
        format!("the output `{name}` must end in {extensions}")
    })
}

/// What is wrong with an output that is named like a drawing.
pub(super) fn overwrites_drawing(output: &Path) -> String {
    format!(
        "`{}` is a drawing, and okoshi never overwrites drawings: the output must end in {}",
        output.display(),
        export::extensions(|_| true)
    )
}

fn build(drawing: &Path, output: &Path, arguments: &Build, common: Common) -> (Outcome, String) {
    let mut text = String::new();
    match built(drawing, output, arguments, common, &mut text) {
        Ok(outcome) | Err(Failure::Reported(outcome)) => (outcome, text),
        Err(Failure::Message(message)) => (Outcome::Failed, format!("{text}error: {message}\n")),
    }
}

fn built(
    drawing: &Path,
    output: &Path,
    arguments: &Build,
    common: Common,
    text: &mut String,
) -> Result<Outcome, Failure> {
    let start = Instant::now();
    let mut loaded = load(drawing, &arguments.reading)?;
    let compiled = start.elapsed();
    text.push_str(&loaded.findings_aside(common));
    if !loaded.can_be_written(arguments.keep_going) {
        if !common.quiet {
            let unchanged = if output.exists() {
                format!("; `{}` is unchanged", output.display())
            } else {
                String::new()
            };
            let _ = writeln!(text, "nothing was written{unchanged}");
        }
        return Ok(Outcome::Errors);
    }
    if arguments.skin {
        loaded.compiled.scene = std::mem::take(&mut loaded.compiled.scene).skinned()?;
    }
    let counts = Counts::of(&loaded);
    loaded.keep_model();
    let written = write(drawing, output, &loaded, arguments)?;
    if arguments.stats {
        let times = [compiled, start.elapsed() - compiled];
        text.push_str(&stats(&loaded, counts, output, written, times));
    } else if !common.quiet {
        let summary = summary(&loaded, counts, written);
        let _ = writeln!(text, "wrote {}: {summary}", output.display());
    }
    let outcome = loaded.outcome();
    if arguments.drawings.len() == 1 {
        // The program ends here, and the system frees its memory faster at once.
        std::mem::forget(loaded);
    }
    Ok(outcome)
}

/// Writes the model and the depfile, if one is wanted.
fn write(
    drawing: &Path,
    output: &Path,
    loaded: &Loaded,
    arguments: &Build,
) -> Result<Written, Failure> {
    let exporter = exporter(output)?;
    let linked = loaded.linked(&resolver(drawing, &arguments.reading));
    let inputs = Inputs::of(drawing).linking(linked.clone());
    let naming = Naming::of(arguments.output.as_deref(), output);
    let target = inputs.target(output, naming)?;
    let depfile = match &arguments.depfile {
        // Written after the model, which it must not replace either.
        Some(depfile) => Some(inputs.writing(output).target(depfile, Naming::Given)?),
        None => None,
    };
    let written = target.write(|out| export::write(exporter, &loaded.compiled.scene, out, None))?;
    if let Some(depfile) = depfile {
        let rule = rule(drawing, output, &linked);
        depfile.write(|out| out.write_all(rule.as_bytes()))?;
    }
    Ok(written)
}

/// What a drawing has, for what is said when its model is written.
#[derive(Clone, Copy)]
struct Counts {
    parts: usize,
    strings: usize,
}

impl Counts {
    fn of(loaded: &Loaded) -> Self {
        Self {
            parts: part_count(&loaded.compiled),
            strings: loaded.compiled.bindings.strings.len(),
        }
    }
}

fn summary(loaded: &Loaded, counts: Counts, written: Written) -> String {
    let scene = &loaded.compiled.scene;
    let parts = counted(counts.parts, "part");
    let clips = match scene.animations.len() {
        0 => String::new(),
        count => format!(", {}", counted(count, "clip")),
    };
    let size = written.size.map(|size| format!(", {size}"));
    format!(
        "{parts}, {}{clips}{}",
        counted(written.triangles, "triangle"),
        size.unwrap_or_default()
    )
}

/// What was built and how long it took, one value per line.
fn stats(
    loaded: &Loaded,
    counts: Counts,
    output: &Path,
    written: Written,
    times: [Duration; 2],
) -> String {
    let scene = &loaded.compiled.scene;
    let milliseconds = |duration: Duration| format!("{:.1} ms", duration.as_secs_f64() * 1e3);
    let rows = [
        ("output", output.display().to_string()),
        ("parts", counts.parts.to_string()),
        ("strings", counts.strings.to_string()),
        ("nodes", scene.nodes.len().to_string()),
        ("meshes", scene.meshes.len().to_string()),
        ("materials", scene.materials.len().to_string()),
        ("clips", scene.animations.len().to_string()),
        ("triangles", written.triangles.to_string()),
        ("vertices", written.vertices.to_string()),
        (
            "size",
            written
                .size
                .map_or("none".to_owned(), |size| size.to_string()),
        ),
        ("data bytes", written.bytes.to_string()),
        ("compiled in", milliseconds(times[0])),
        ("written in", milliseconds(times[1])),
    ];
    rows.iter().fold(String::new(), |mut out, (name, value)| {
        let _ = writeln!(out, "{name:>12}  {value}");
        out
    })
}

/// `output: drawing links…`, so that make and similar tools know when to build again.
fn rule(drawing: &Path, output: &Path, linked: &[PathBuf]) -> String {
    let inputs: Vec<String> = std::iter::once(drawing)
        .chain(linked.iter().map(PathBuf::as_path))
        .map(for_make)
        .collect();
    let mut rule = format!("{}: {}\n", for_make(output), inputs.join(" "));
    // An empty rule for each input, so that make does not fail when one of them is deleted.
    inputs
        .iter()
        .skip(1)
        .for_each(|input| rule.push_str(&format!("{input}:\n")));
    rule
}

/// A path escaped for make.
fn for_make(path: &Path) -> String {
    let mut out = String::new();
    for c in path.display().to_string().chars() {
        match c {
            ' ' | '#' | '\\' => out.extend(['\\', c]),
            '$' => out.push_str("$$"),
            c => out.push(c),
        }
    }
    out
}
