//! `okoshi preview`

use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

use super::args::{Common, Preview};
use super::watch::{describe_event, describe_shown, follow, options};
use super::{Failure, Outcome, serving};
use crate::compile;
use crate::disk::{ReadError, write_new};
use crate::page::{Editing, Hub, Shown, Starters, Times, random_key};
use crate::preview::{PORT, serve};
use crate::resolver::Resolver;
use crate::watch::{Build, Editor, Event, Options};

/// Shows drawings on a live page until it is interrupted.
pub(super) fn run(arguments: &Preview, common: Common) -> Result<Outcome, Failure> {
    let path = &arguments.path;
    if !path.exists() {
        return Err(ReadError::missing(path).into());
    }
    if arguments.unsaved.is_some() && path.is_dir() {
        return Err("--unsaved names the copy of one drawing, and this is a folder".into());
    }
    let bound = serving::bound(arguments.port, PORT)?;
    let url = bound.url();
    let options = Options {
        shows_incomplete: true,
        unsaved: arguments.unsaved.clone(),
        ..options(&arguments.reading, &arguments.noticing)
    };
    let editing = (!arguments.read_only).then(|| Editing::of_files(Editor::new(options.clone())));
    let folder = path.is_dir().then(|| path.clone());
    let folder = folder.filter(|_| !arguments.read_only);
    let offered = folder.map(|folder| {
        Starters::new(random_key(), move |template| {
            let drawing = folder.join(format!("{}.svg", template.name()));
            let written = write_new(&drawing, template.drawing().as_bytes());
            written.map_err(|error| error.to_string())
        })
    });
    let read = options.clone();
    let reads = move |id: &str| -> (compile::Options, Box<dyn Resolver>) {
        let (options, resolver) = read.reading(Path::new(id));
        (options, Box::new(resolver))
    };
    let hub = Hub::new(|_, _| (), offered, editing, Some(Box::new(reads)));
    let server = hub.clone();
    let runtime = serving::runtime()?;
    runtime.spawn(serve(bound, server));
    println!("{url}");
    if arguments.open {
        serving::open(&url);
    }
    follow(std::slice::from_ref(path), &options, |event| {
        show(&hub, path, &event);
        match event {
            Event::Built(drawing, build) => describe_shown(drawing, build, common),
            event => describe_event(&event, common),
        }
    })
}

fn show(hub: &Arc<Hub>, target: &Path, event: &Event<'_>) {
    match event {
        Event::Built(drawing, build) => publish(hub, target, drawing, build),
        Event::Ready(0) => hub.offer_starters(),
        Event::Gone(drawing) => hub.gone(&drawing.display().to_string()),
        Event::Back(drawing) => hub.back(&drawing.display().to_string()),
        _ => {}
    }
}

fn publish(hub: &Arc<Hub>, target: &Path, drawing: &Path, build: &Build) {
    let below = drawing.strip_prefix(target).unwrap_or(drawing);
    let folder = below.parent().filter(|_| target.is_dir());
    let folder = folder.map_or_else(String::new, |folder| folder.display().to_string());
    let name = drawing.file_name().map(|name| name.to_string_lossy());
    let names = [&folder, name.as_deref().unwrap_or("")];
    let model = build.model.as_ref().ok().or(build.incomplete.as_ref());
    let bytes = model.map(|model| Arc::from(model.bytes.as_slice()));
    let model = bytes.as_ref().zip(model.map(|model| model.written));
    let shown = Shown {
        text: &build.text,
        compiled: &build.compiled,
        model,
        times: Times {
            noticed: build.times.noticed,
            started: build.times.started,
            finished: build.times.finished,
            pushed: SystemTime::now(),
        },
    };
    hub.publish(&drawing.display().to_string(), names, &shown);
}
