//! `okoshi watch`

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::args::{Common, Noticing, Reading, Watch};
use super::build::overwrites_drawing;
use super::digest::{Detail, describe};
use super::loading::{count, tally};
use super::{Failure, Outcome, counted, style};
use crate::disk::{
    ChangeDetection, Inputs, Naming, ReadError, is_drawing, is_standard_stream, make_folder,
};
use crate::export::{self, Exporter, GLB, Model};
use crate::report::{Findings, part_count};
use crate::watch::{Build, Event, NoModel, Options, watch};

/// Builds drawings on every save until it is interrupted.
pub(super) fn run(arguments: &Watch, common: Common) -> Result<Outcome, Failure> {
    if let Some(missing) = arguments.paths.iter().find(|path| !path.exists()) {
        return Err(ReadError::missing(missing).into());
    }
    let destination = Destination::of(arguments.output.as_deref(), &arguments.paths)?;
    let options = Options {
        exporter: match destination {
            Destination::File(_, exporter) => exporter,
            Destination::Beside | Destination::Folder(_) => &GLB,
        },
        ..options(&arguments.reading, &arguments.noticing)
    };
    let mut outputs = Outputs {
        destination,
        targets: &arguments.paths,
        owners: BTreeMap::new(),
    };
    follow(&arguments.paths, &options, |event| match event {
        Event::Built(drawing, build) => built(drawing, build, &mut outputs, common),
        event => describe_event(&event, common),
    })
}

/// Watches until it is interrupted, and prints what `describe` returns for each event.
pub(super) fn follow(
    paths: &[PathBuf],
    options: &Options,
    mut describe: impl FnMut(Event<'_>) -> String,
) -> Result<Outcome, Failure> {
    match watch(paths, options, |event| eprint!("{}", describe(event))) {
        Ok(never) => match never {},
        Err(error) => {
            Err(format!("file changes are not reported here: {error}; try --poll").into())
        }
    }
}

/// How drawings are read and watched.
pub(super) fn options(reading: &Reading, noticing: &Noticing) -> Options {
    Options {
        base: reading.base.clone(),
        root: reading.root.clone(),
        tolerance: reading.tolerance,
        detection: noticing.poll.map_or(ChangeDetection::Native, |pause| {
            ChangeDetection::Polling(Duration::from_millis(pause))
        }),
        ..Options::default()
    }
}

/// Where models are written.
#[derive(Debug, Clone, Copy)]
enum Destination<'a> {
    /// Beside each drawing, as binary glTF.
    Beside,
    /// In a folder, as binary glTF.
    Folder(&'a Path),
    /// The model of the one drawing, in a file of this format.
    File(&'a Path, &'static dyn Exporter),
}

impl<'a> Destination<'a> {
    /// What `-o` asks for: a name that ends like a model is a file, any other a folder.
    fn of(output: Option<&'a Path>, watched: &[PathBuf]) -> Result<Self, String> {
        let Some(output) = output else {
            return Ok(Self::Beside);
        };
        if is_standard_stream(output) {
            return Err("a model that is written at every save needs a file or a folder: for example -o models".to_owned());
        }
        if is_drawing(output) && !output.is_dir() {
            return Err(overwrites_drawing(output));
        }
        let exporter = match export::by_extension(output) {
            Some(exporter) if !output.is_dir() => exporter,
            _ => return Ok(Self::Folder(output)),
        };
        match watched {
            [drawing] if !drawing.is_dir() => Ok(Self::File(output, exporter)),
            _ => Err(format!(
                "`{}` is one file, and more than one drawing may be watched; name a folder, for example -o models",
                output.display()
            )),
        }
    }
}

/// The output files.
struct Outputs<'a> {
    destination: Destination<'a>,
    targets: &'a [PathBuf],
    /// The drawing that each output is made from.
    owners: BTreeMap<PathBuf, PathBuf>,
}

impl Outputs<'_> {
    /// The output file of a drawing.
    fn of(&mut self, drawing: &Path) -> Result<PathBuf, String> {
        let output = match self.destination {
            Destination::Beside => drawing.with_extension("glb"),
            Destination::File(output, _) => output.to_owned(),
            Destination::Folder(folder) => {
                // Drawings below a watched folder keep their relative paths.
                let below = |target: &PathBuf| drawing.strip_prefix(target).ok();
                let mut inner = self.targets.iter().filter_map(below);
                let place = inner.find(|place| !place.as_os_str().is_empty());
                let place = place.or(drawing.file_name().map(Path::new));
                folder.join(place.unwrap_or(drawing)).with_extension("glb")
            }
        };
        let entry = self.owners.entry(output.clone());
        let owner = entry.or_insert_with(|| drawing.to_owned());
        if owner != drawing {
            return Err(format!(
                "its output `{}` is already that of `{}`; rename one of them",
                output.display(),
                owner.display()
            ));
        }
        Ok(output)
    }
}

/// Writes a model that was built, and describes it: its findings, then one line.
fn built(drawing: &Path, build: &Build, outputs: &mut Outputs<'_>, common: Common) -> String {
    let name = drawing.display().to_string();
    let mut text = findings(&name, build, common);
    let found = counts(build);
    let output = match outputs.of(drawing) {
        Ok(output) => output,
        Err(why) => return format!("{text}{}", line(&name, &format!("not written: {why}"))),
    };
    let unchanged = || {
        if output.exists() {
            format!("{} is unchanged", output.display())
        } else {
            "nothing was written".to_owned()
        }
    };
    let (message, failed) = match &build.model {
        Err(NoModel::Errors) => (format!("{found}{}", unchanged()), true),
        Err(NoModel::Unwritten(why)) => (format!("{found}{why}; {}", unchanged()), true),
        Ok(model) => {
            let (folder, naming) = match outputs.destination {
                Destination::Beside => (None, Naming::Derived),
                Destination::Folder(_) => (output.parent(), Naming::Derived),
                Destination::File(..) => (None, Naming::Given),
            };
            let written = folder
                .map_or(Ok(()), make_folder)
                .and_then(|()| {
                    let inputs = Inputs::of(drawing).linking(build.linked.iter().cloned());
                    inputs.target(&output, naming)
                })
                .and_then(|target| target.write(|out| out.write_all(&model.bytes)));
            match written {
                Err(error) => (error.to_string(), true),
                Ok(()) => {
                    let wrote = output.display().to_string();
                    (summary(build, model, &found, &wrote), false)
                }
            }
        }
    };
    if failed || !common.quiet {
        text.push_str(&line(&name, &message));
    }
    text
}

/// Describes a build that is shown on a page: its findings, then one line.
pub(super) fn describe_shown(drawing: &Path, build: &Build, common: Common) -> String {
    let name = drawing.display().to_string();
    let mut text = findings(&name, build, common);
    let found = counts(build);
    let message = match &build.model {
        Err(NoModel::Errors) if build.incomplete.is_some() => {
            format!("{found}what can be built is shown")
        }
        Err(NoModel::Errors) => format!("{found}the last good model is shown"),
        Err(NoModel::Unwritten(why)) => format!("{found}{why}; the last good model is shown"),
        Ok(_) if common.quiet => return text,
        Ok(model) => summary(build, model, &found, "shown"),
    };
    text.push_str(&line(&name, &message));
    text
}

fn findings(name: &str, build: &Build, common: Common) -> String {
    let findings = Findings {
        look: None,
        path: name,
        text: &build.text,
        diagnostics: &build.compiled.diagnostics,
    };
    let style = style(common, &std::io::stderr());
    describe(findings, common, Detail::Repeated, style)
}

/// `2 hints, `, or nothing
fn counts(build: &Build) -> String {
    match tally(&build.compiled.diagnostics) {
        [0, 0, 0] => String::new(),
        counts => format!("{}, ", count(counts)),
    }
}

/// `7 parts, 2260 triangles, 2 hints, human.glb in 4.2 ms`
fn summary(build: &Build, model: &Model, found: &str, done: &str) -> String {
    format!(
        "{}, {}, {found}{done} in {:.1} ms",
        counted(part_count(&build.compiled), "part"),
        counted(model.written.triangles, "triangle"),
        build.times.duration().as_secs_f64() * 1e3,
    )
}

/// Describes an event other than a build.
pub(super) fn describe_event(event: &Event<'_>, common: Common) -> String {
    let about = |path: &Path, what: &str| line(&path.display().to_string(), what);
    match event {
        Event::Gone(drawing) => about(drawing, "the file is gone; waiting for it"),
        Event::Back(drawing) => about(drawing, "the file is back, unchanged"),
        Event::Unreadable(drawing, why) => about(drawing, why),
        Event::Unwatchable(folder, why) => {
            let why = format!("changes in it are not reported: {why}; try --poll");
            about(folder, &why)
        }
        Event::Ready(_) if common.quiet => String::new(),
        Event::Ready(0) => "no drawings yet; waiting for them, press Ctrl-C to stop\n".to_owned(),
        Event::Ready(drawings) => format!(
            "watching {}; press Ctrl-C to stop\n",
            counted(*drawings, "drawing")
        ),
        Event::Built(..) => String::new(),
    }
}

/// `12:01:07 human.svg: …`
fn line(name: &str, message: &str) -> String {
    format!(
        "{} {name}: {message}\n",
        chrono::Local::now().format("%H:%M:%S")
    )
}
