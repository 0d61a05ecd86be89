//! Rendering clips: which one, which part of it, and how it is written.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;

use super::movie::{Movie, MovieForm};
use super::{Destination, Form, describe_picture, of_drawing, options};
use crate::cli::Failure;
use crate::cli::args::Render;
use crate::cli::progress::{counting, spinning};
use crate::render::{
    Clip, Film, HeldFrame, Image, MAX_GIF_FPS, Model, ModelCamera, Options, Palette, RenderError,
    write_png,
};

/// The default frame rate: that of film, and of the clips that okoshi makes.
const FPS: u32 = 24;
/// The most pixels of the pictures that the colours of a GIF are chosen from.
const MAX_PALETTE_PIXELS: u64 = 16 << 20;
/// The most of these pictures: several are needed, as flat sides change their shade with every frame.
const MAX_PALETTE_PICTURES: u64 = 16;
/// The most clips that a message lists.
const MAX_LISTED: usize = 20;

/// The requested clip, by name or by number from 1; without a request the only clip.
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
    let mut names: Vec<String> = clips.iter().enumerate().take(MAX_LISTED).map(one).collect();
    if clips.len() > MAX_LISTED {
        names.push(format!("{} more", clips.len() - MAX_LISTED));
    }
    names.join(", ")
}

/// Seconds, rounded to milliseconds.
fn rounded(seconds: f64) -> f64 {
    (seconds * 1000.0).round() / 1000.0
}

/// Refuses a time after the end of a clip.
pub(super) fn within(clip: &Clip, option: &str, time: f64) -> Result<f64, String> {
    // Lengths are printed in milliseconds: whoever types a printed length means the end.
    if time <= clip.seconds + 0.0005 {
        Ok(time.min(clip.seconds))
    } else {
        Err(format!(
            "has a clip of {} seconds: {option} {time} is after its end",
            rounded(clip.seconds)
        ))
    }
}

/// The requested part of a clip, and the camera that films it.
pub(super) fn film<'a>(
    model: &'a Model,
    clip: &'a Clip,
    camera: Option<&'a ModelCamera>,
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
    let framed = || {
        let film = Film::new(model, clip, [from, to])?;
        match camera {
            Some(camera) => film.filmed_by(camera),
            None if arguments.follow => film.following(),
            None => Ok(film),
        }
    };
    spinning("framing the clip", framed).map_err(|error: RenderError| error.to_string())
}

/// Writes frames of a clip side by side, and describes the picture.
pub(super) fn strip(
    film: &Film<'_>,
    arguments: &Render,
    cells: u32,
    output: &Destination,
) -> Result<String, Failure> {
    let options = options(arguments, Form::Png);
    let target = output.single()?;
    let image = counting("drawing", cells, |done| {
        film.film_strip(&options, cells, done)
    })
    .map_err(|error| of_drawing(arguments, &error))?;
    target.write(|out| write_png(&image, out))?;
    let picture = describe_picture(options.size, film.triangles);
    let name = output.path.display();
    Ok(format!("{name}: {cells} moments, {picture} each"))
}

/// Writes a clip as numbered files, and describes the pictures.
pub(super) fn numbered(
    film: &Film<'_>,
    arguments: &Render,
    output: &Destination,
) -> Result<String, Failure> {
    let options = options(arguments, Form::Png);
    let pictures = held_frames(film, arguments)?;
    let frames: u32 = pictures.iter().map(|picture| picture.frames).sum();
    output.check_numbered(frames)?;
    counting("drawing", pictures.len() as u32, |done| {
        let mut number = 0;
        let mut left = pictures.iter().zip(1..);
        film.shooting(&options)?.draw(times(&pictures), |image| {
            let mut png = Vec::new();
            write_png(&image, &mut png)?;
            let Some((picture, drawn)) = left.next() else {
                return Ok(());
            };
            for _ in 0..picture.frames {
                number += 1;
                output
                    .numbered(number, frames)
                    .and_then(|target| target.write(|out| out.write_all(&png)))?;
            }
            done(drawn);
            Ok::<(), Failure>(())
        })
    })?;
    let picture = describe_picture(options.size, film.triangles);
    Ok(format!("{}: {picture} each", output.range(frames)))
}

/// Writes a clip as one file, and describes it.
pub(super) fn movie(
    film: &Film<'_>,
    arguments: &Render,
    form: MovieForm,
    output: &Destination,
) -> Result<String, Failure> {
    let options = options(arguments, Form::Movie(form));
    let pictures = held_frames(film, arguments)?;
    let count = pictures.len() as u32;
    let target = output.single()?;
    let movie = Movie {
        form,
        size: options.size,
        pictures: count,
        rate: [arguments.fps.unwrap_or(FPS), 1],
    };
    // Pictures that the colours of a GIF are chosen from are rendered before the others.
    let early = RefCell::new(VecDeque::new());
    counting("drawing", count, |done| -> Result<(), Failure> {
        let shooting = film.shooting(&options)?;
        let colors = || {
            let mut early = early.borrow_mut();
            let mut indices = (0..pictures.len()).step_by(palette_step(pictures.len(), &options));
            let moments = indices.clone().map(|index| pictures[index].time);
            shooting.draw(moments, |image| -> io::Result<()> {
                early.extend(indices.next().map(|index| (index, image)));
                done(early.len() as u32);
                Ok(())
            })?;
            let samples: Vec<&Image> = early.iter().map(|(_, image)| image).collect();
            Ok(Palette::new(samples, options.background))
        };
        Ok(movie.write(&target, colors, |push| {
            let mut early = early.take();
            let is_early = |index: &usize| early.iter().any(|(other, _)| other == index);
            let late: Vec<usize> = (0..pictures.len())
                .filter(|index| !is_early(index))
                .collect();
            let mut shown = 0;
            let mut show = |index: usize, image: &Image| -> io::Result<()> {
                let picture = &pictures[index];
                push(image, picture.seconds, picture.frames)?;
                shown += 1;
                done(shown);
                Ok(())
            };
            let mut indices = late.iter();
            let moments = late.iter().map(|index| pictures[*index].time);
            shooting.draw(moments, |image| -> io::Result<()> {
                let Some(index) = indices.next() else {
                    return Ok(());
                };
                while early.front().is_some_and(|(other, _)| *other < *index) {
                    if let Some((before, image)) = early.pop_front() {
                        show(before, &image)?;
                    }
                }
                show(*index, &image)
            })?;
            early
                .iter()
                .try_for_each(|(index, image)| show(*index, image))
        })?)
    })?;
    let seconds = rounded(pictures.iter().map(|picture| picture.seconds).sum());
    let picture = describe_picture(options.size, film.triangles);
    let name = output.path.display();
    Ok(format!(
        "{name}: {count} pictures in {seconds} seconds, {picture} each"
    ))
}

/// The pictures to draw.
fn held_frames(film: &Film<'_>, arguments: &Render) -> Result<Vec<HeldFrame>, String> {
    film.held_frames(arguments.fps.unwrap_or(FPS))
        .map_err(|error| of_drawing(arguments, &error))
}

/// The times of the pictures, in seconds of the clip.
fn times(pictures: &[HeldFrame]) -> impl Iterator<Item = f64> {
    pictures.iter().map(|picture| picture.time)
}

/// The colours of a GIF are chosen from one picture of so many: from several ones, but not from more than fit into memory.
fn palette_step(count: usize, options: &Options) -> usize {
    let [width, height] = options.size.map(u64::from);
    let fitting = (MAX_PALETTE_PIXELS / (width * height)).clamp(1, MAX_PALETTE_PICTURES);
    count.div_ceil(fitting as usize).max(1)
}

/// Refuses a frame rate that the format cannot hold.
pub(super) fn check_fps(arguments: &Render, form: Form) -> Result<(), String> {
    match arguments.fps {
        Some(fps) if form == Form::Movie(MovieForm::Gif) && fps > MAX_GIF_FPS => Err(format!(
            "GIFs show at most {MAX_GIF_FPS} frames a second: ask for --fps {MAX_GIF_FPS} or fewer, or write .apng or .mp4"
        )),
        _ => Ok(()),
    }
}
