//! The camera of the model that a picture is taken by.

use crate::cli::args::Render;
use crate::render::{Clip, Model, ModelCamera};

/// The most cameras that a message lists.
const MAX_LISTED: usize = 20;

/// Refuses options that say something else about the camera.
pub(super) fn check(arguments: &Render) -> Result<(), String> {
    if arguments.camera.is_none() {
        return Ok(());
    }
    let others = [
        (arguments.as_drawn, "--as-drawn"),
        (arguments.view.is_some(), "--view"),
        (arguments.projection.is_some(), "--projection"),
        (arguments.turntable.is_some(), "--turntable"),
        (arguments.follow, "--follow"),
    ];
    match others.iter().find(|(is_given, _)| *is_given) {
        Some((_, other)) => Err(format!(
            "--camera shows what a camera of the model sees, so {other} has no meaning: leave out {other}, or --camera"
        )),
        None => Ok(()),
    }
}

/// The requested camera, by name or by number from 1; without a name that of the clip, or the first.
pub(super) fn chosen<'a>(
    model: &'a Model,
    clip: Option<&Clip>,
    arguments: &Render,
) -> Result<Option<&'a ModelCamera>, String> {
    let Some(asked) = &arguments.camera else {
        return Ok(None);
    };
    let cameras = model.cameras();
    let Some(first) = cameras.first() else {
        return Err("has no camera: leave out --camera".to_owned());
    };
    let Some(asked) = asked else {
        let of_clip = clip.and_then(|clip| model.camera_of(clip));
        return Ok(of_clip.or(Some(first)));
    };
    let number = || cameras.get(asked.parse::<usize>().ok()?.checked_sub(1)?);
    let named = cameras.iter().find(|camera| camera.name == *asked);
    match named.or_else(number) {
        Some(camera) => Ok(Some(camera)),
        None => Err(format!(
            "has no camera `{asked}`; there is {}",
            listed(cameras)
        )),
    }
}

/// The cameras by number and name.
fn listed(cameras: &[ModelCamera]) -> String {
    let one = |(index, camera): (usize, &ModelCamera)| match camera.name.as_str() {
        "" => format!("{} without a name", index + 1),
        name => format!("{} `{name}`", index + 1),
    };
    let listed = cameras.iter().enumerate().take(MAX_LISTED);
    let mut names: Vec<String> = listed.map(one).collect();
    if cameras.len() > MAX_LISTED {
        names.push(format!("{} more", cameras.len() - MAX_LISTED));
    }
    names.join(", ")
}
