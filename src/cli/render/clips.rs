//! Clips: which one, which part of it, and how it is written.

use std::io;
use std::path::Path;

use super::{Failure, Form, SKETCHES, numbered, options, same_look};
use crate::cli::args::Render;
use crate::cli::progress::{counting, spinning};
use crate::disk::write_atomic;
use crate::render::{
    AnimationWriter, Clip, Film, HeldFrame, MAX_GIF_FPS, Model, Options, Palette, write_png,
};

/// Frames a second where nothing else is asked for: film's, and that of the clips that okoshi makes.
const FPS: u32 = 24;
/// Clips that are named when one must be chosen.
const NAMED: usize = 20;

/// The clip that is asked for, by its name or its number from 1; without either the only one that there is.
pub(super) fn chosen<'a>(model: &'a Model, asked: Option<&str>) -> Result<&'a Clip, String> {
    let clips = model.clips();
    let number = |asked: &str| clips.get(asked.parse::<usize>().ok()?.checked_sub(1)?);
    match (asked, clips) {
        (_, []) => Err("has no clips: nothing in it moves".to_owned()),
        (None, [clip]) => Ok(clip),
        (None, _) => Err(format!(
            "has several clips: name one with --clip, {}",
            listed(clips)
        )),
        (Some(asked), _) => clips
            .iter()
            .find(|clip| clip.name == asked)
            .or_else(|| number(asked))
            .ok_or_else(|| format!("has no clip `{asked}`; there is {}", listed(clips))),
    }
}

/// The clips by number, name and length.
fn listed(clips: &[Clip]) -> String {
    let one = |(index, clip): (usize, &Clip)| {
        let name = match clip.name.as_str() {
            "" => "without a name".to_owned(),
            name => format!("`{name}`"),
        };
        format!("{} {name} ({} s)", index + 1, rounded(clip.seconds))
    };
    let mut names: Vec<String> = clips.iter().enumerate().take(NAMED).map(one).collect();
    if clips.len() > NAMED {
        names.push(format!("{} more", clips.len() - NAMED));
    }
    names.join(", ")
}

/// Seconds, to the thousandth.
fn rounded(seconds: f64) -> f64 {
    (seconds * 1000.0).round() / 1000.0
}

/// Refuses a moment that lies behind the end of a clip.
pub(super) fn within(clip: &Clip, option: &str, moment: f64) -> Result<f64, String> {
    // Lengths are told to the thousandth: whoever types what was told means the end.
    match moment <= clip.seconds + 0.0005 {
        true => Ok(moment.min(clip.seconds)),
        false => Err(format!(
            "has a clip of {} seconds: {option} {moment} is after its end",
            rounded(clip.seconds)
        )),
    }
}

/// The part of a clip that is asked for.
pub(super) fn film<'a>(
    model: &'a Model,
    clip: &'a Clip,
    arguments: &Render,
) -> Result<Film<'a>, String> {
    let from = within(clip, "--from", arguments.from.unwrap_or(0.0))?;
    let to = match arguments.to {
        Some(to) => within(clip, "--to", to)?,
        None => clip.seconds,
    };
    if from >= to && arguments.from.or(arguments.to).is_some() {
        let (from, to) = (rounded(from), rounded(to));
        return Err(format!(
            "cannot be shown from {from} to {to} seconds: --to must be after --from"
        ));
    }
    spinning("looking through the clip", || {
        Film::new(model, clip, [from, to])
    })
    .map_err(|error| error.to_string())
}

/// Draws moments side by side; says what was written.
pub(super) fn strip(
    film: &Film<'_>,
    arguments: &Render,
    cells: u32,
    output: &Path,
) -> Result<String, Failure> {
    let options = options(arguments);
    let image = counting("drawing", cells, |done| {
        film.film_strip(&options, cells, done)
    })
    .map_err(|error| Failure::of(arguments, &error))?;
    write_atomic(output, |out| write_png(&image, out)).map_err(Failure::written)?;
    let look = same_look(options.size, film.triangles());
    let name = output.display();
    Ok(format!("{name}: {cells} moments, {look} each"))
}

/// Draws a clip; says what was written.
pub(super) fn moving(
    film: &Film<'_>,
    arguments: &Render,
    form: Form,
    output: &Path,
) -> Result<String, Failure> {
    let options = options(arguments);
    let pictures = film
        .held_frames(arguments.fps.unwrap_or(FPS))
        .map_err(|error| Failure::of(arguments, &error))?;
    let times = || pictures.iter().map(|picture| picture.time);
    let count = pictures.len() as u32;
    let look = same_look(options.size, film.triangles());
    if form == Form::Png {
        let frames: u32 = pictures.iter().map(|picture| picture.frames).sum();
        counting("drawing", count, |done| {
            let mut number = 0;
            let mut left = pictures.iter().zip(1..);
            film.draw(&options, times(), |image| {
                let mut png = Vec::new();
                write_png(&image, &mut png).map_err(|error| Failure(error.to_string()))?;
                let Some((picture, drawn)) = left.next() else {
                    return Ok(());
                };
                for _ in 0..picture.frames {
                    number += 1;
                    let name = numbered(output, number, frames);
                    write_atomic(&name, |out| out.write_all(&png)).map_err(Failure::written)?;
                }
                done(drawn);
                Ok::<(), Failure>(())
            })
        })?;
        let [first, last] = [1, frames].map(|number| numbered(output, number, frames));
        let (first, last) = (first.display(), last.display());
        return Ok(format!("{first} to {last}: {look} each"));
    }
    counting("drawing", count, |done| {
        write_atomic(output, |out| {
            let mut animation = match form {
                Form::Gif => {
                    AnimationWriter::gif(out, options.size, palette(film, &options, &pictures)?)?
                }
                Form::Png | Form::Apng => AnimationWriter::apng(out, options.size, count)?,
            };
            let mut left = pictures.iter().zip(1..);
            film.draw(&options, times(), |image| -> io::Result<()> {
                if let Some((picture, drawn)) = left.next() {
                    animation.push(&image, picture.seconds)?;
                    done(drawn);
                }
                Ok(())
            })?;
            animation.finish()
        })
    })
    .map_err(Failure::written)?;
    let seconds = rounded(pictures.iter().map(|picture| picture.seconds).sum());
    let name = output.display();
    Ok(format!(
        "{name}: {count} pictures in {seconds} seconds, {look} each"
    ))
}

/// The colours of a GIF, from a few small pictures of what it will show.
fn palette(film: &Film<'_>, options: &Options, pictures: &[HeldFrame]) -> io::Result<Palette> {
    let size = super::sketched(options.size);
    let step = pictures.len().div_ceil(SKETCHES as usize).max(1);
    let times = pictures.iter().step_by(step).map(|picture| picture.time);
    let mut sketches = Vec::new();
    film.draw(
        &Options { size, ..*options },
        times,
        |image| -> io::Result<()> {
            sketches.push(image);
            Ok(())
        },
    )?;
    Ok(Palette::new(&sketches))
}

/// Refuses more frames a second than a form has.
pub(super) fn check_fps(arguments: &Render, form: Form) -> Result<(), String> {
    match arguments.fps {
        Some(fps) if form == Form::Gif && fps > MAX_GIF_FPS => Err(format!(
            "GIFs show at most {MAX_GIF_FPS} frames a second: ask for --fps {MAX_GIF_FPS} or fewer, or write .apng"
        )),
        _ => Ok(()),
    }
}
