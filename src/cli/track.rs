//! `okoshi track`

mod annotate;
mod clip;
mod video;

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use self::annotate::annotated;
use self::clip::Clip;
use super::args::{Common, Track};
use super::progress::counting;
use super::render::movie::{Movie, MovieForm};
use super::{Failure, Outcome, counted, ending};
use crate::disk::{Inputs, Naming, Target, WriteError};
use crate::limited::frame_ranges;
use crate::mark_tracks::{MAX_MARKS, MarkTrack, MarkTracks, repeated_name};
use crate::render::{Image, Palette, write_png};
use crate::tracking::{Follower, Frame, LearnError, Learned, Learner, hue_name};

/// The most ranges of lost frames that are listed.
const MAX_RANGES: usize = 8;
/// A mark that is lost in more than this part of the frames is warned of.
const MUCH_LOST: f64 = 0.2;
/// So is one that may be in several places in more than this part of them.
const MUCH_AMBIGUOUS: f64 = 0.1;
/// So is one whose hue still things have in more than this part of the picture.
const MUCH_CLUTTER: f64 = 0.003;
/// The number of frames from which the colours of a GIF are chosen.
const PALETTE_FRAMES: usize = 8;

/// The format of a track.
#[derive(Clone, Copy)]
enum Form {
    Json,
    Csv,
}

/// The format of an annotated clip.
#[derive(Clone, Copy)]
enum Annotated {
    Numbered,
    Movie(MovieForm),
}

/// Follows marks through a clip.
pub(super) fn run(arguments: &Track, common: Common) -> Result<Outcome, Failure> {
    let names = arguments.marks.iter().map(|mark| mark.name.as_str());
    if let Some(index) = repeated_name(names) {
        let name = &arguments.marks[index].name;
        return Err(format!(
            "there are two marks `{name}`: name them, as in `--mark left={name} --mark right={name}`, \
             and give them colours that differ"
        )
        .into());
    }
    if arguments.marks.len() > MAX_MARKS {
        return Err(format!("at most {MAX_MARKS} marks can be followed").into());
    }
    let output = output(arguments);
    let form = form(&output)?;
    let annotated = arguments.annotated.as_deref();
    let annotated = annotated
        .map(|path| Ok::<_, String>((path, annotated_form(path)?)))
        .transpose()?;
    let clip = Clip::open(&arguments.clips, arguments.fps)?;
    let mut inputs = Inputs::default();
    for file in clip.files() {
        inputs = inputs.reading(&file);
    }
    let naming = Naming::of(arguments.output.as_deref(), &output);
    let target = inputs.target(&output, naming)?;
    inputs = inputs.writing(&output);
    // Refused before anything is read; numbered pictures are checked when their number is known.
    if let Some((path, Annotated::Movie(_))) = annotated {
        inputs.target(path, Naming::Given)?;
    }
    let (learned, count) = learn(&clip, arguments)?;
    let found = follow(&clip, &learned, count)?;
    let text = match form {
        Form::Json => found.to_json(),
        Form::Csv => found.to_csv(),
    };
    target.write(|out| out.write_all(text.as_bytes()))?;
    let name = arguments.clips[0].display();
    if !common.quiet {
        eprint!("{name}: {}", report(&found, &learned));
        if output.as_os_str() != "-" {
            eprintln!("wrote {}", output.display());
        }
    }
    if let Some((path, form)) = annotated {
        let wrote = annotate(&clip, &found, path, form, &inputs)?;
        if !common.quiet {
            eprintln!("wrote {wrote}");
        }
    }
    Ok(Outcome::Done)
}

/// Where the track is written.
fn output(arguments: &Track) -> PathBuf {
    match &arguments.output {
        Some(output) => output.clone(),
        None => arguments.clips[0].with_extension("json"),
    }
}

fn form(output: &Path) -> Result<Form, String> {
    match ending(output).as_str() {
        _ if output.as_os_str() == "-" => Ok(Form::Json),
        "json" => Ok(Form::Json),
        "csv" => Ok(Form::Csv),
        _ => Err(format!(
            "the track `{}` must end in .json or .csv",
            output.display()
        )),
    }
}

fn annotated_form(path: &Path) -> Result<Annotated, String> {
    match ending(path).as_str() {
        "png" => Ok(Annotated::Numbered),
        ending => MovieForm::of(ending).map(Annotated::Movie).ok_or_else(|| {
            format!(
                "the annotated clip `{}` must end in .gif, .apng, .mp4, .webm or .png",
                path.display()
            )
        }),
    }
}

/// Learns what the marks look like; the number of frames is returned too.
fn learn(clip: &Clip, arguments: &Track) -> Result<(Learned, u32), String> {
    let mut learner = None;
    let mut count = 0;
    counting("learning", clip.count().unwrap_or(0), |done| {
        clip.read(&mut |frame| {
            let size = [frame.image.width(), frame.image.height()];
            let learner =
                learner.get_or_insert_with(|| Learner::new(size, arguments.marks.clone()));
            if let Some(frame) = Frame::new(size, &frame.image) {
                learner.push(frame);
            }
            count += 1;
            done(count);
            Ok(())
        })
    })?;
    let name = arguments.clips[0].display();
    let learner = learner.ok_or_else(|| format!("`{name}` has no frames"))?;
    let learned = learner
        .learned()
        .map_err(|error| not_found(arguments, &error))?;
    Ok((learned, count))
}

/// That a clip has no pixels of a mark.
fn not_found(arguments: &Track, error: &LearnError) -> String {
    let hues = match error.hues.as_slice() {
        [] => "nothing in it is coloured".to_owned(),
        hues => format!("what is coloured in it is {}", hues.join(", ")),
    };
    format!(
        "the mark `{}` is not in `{}`: it would be {}, and {hues}; choose one of these, the largest area comes first",
        arguments.marks[error.mark].name,
        arguments.clips[0].display(),
        hue_name(error.hue),
    )
}

/// Finds the marks in all frames.
fn follow(clip: &Clip, learned: &Learned, count: u32) -> Result<MarkTracks, String> {
    let mut follower = Follower::new(learned.clone());
    let mut times = Vec::new();
    counting("tracking", count, |done| {
        clip.read(&mut |frame| {
            let size = [frame.image.width(), frame.image.height()];
            if let Some(pixels) = Frame::new(size, &frame.image) {
                follower.push(pixels);
                times.push(frame.time);
            }
            done(times.len() as u32);
            Ok(())
        })
    })?;
    Ok(follower.tracks(times))
}

/// What was found, a line for each mark, and what may be wrong.
fn report(found: &MarkTracks, learned: &Learned) -> String {
    let [width, height] = found.size;
    let frames = found.times.len();
    let seconds = found.times.last().copied().unwrap_or(0.0);
    let length = counted(frames, "frame");
    let mut text = format!("{length}, {width} × {height} pixels, {seconds:.1} s\n");
    for (index, mark) in found.marks.iter().enumerate() {
        let _ = writeln!(text, "  {}", seen(mark));
        let name = &mark.name;
        let part = |is: &[bool]| is.iter().filter(|is| **is).count() as f64 / frames as f64;
        let (lost, ambiguous) = (part(&mark.is_lost), part(&mark.is_ambiguous));
        if ambiguous > MUCH_AMBIGUOUS {
            let _ = writeln!(
                text,
                "  warning: in {:.0} % of the frames something else could be `{name}` too; they count as lost; look at them with \
                 --annotated check.gif, and film again without it, or with a mark of another colour",
                100.0 * ambiguous
            );
        } else if lost == 1.0 {
            let _ = writeln!(
                text,
                "  warning: `{name}` was never seen clearly; choose its colour from a frame, as in `{name}=#d03020`"
            );
        } else if lost > MUCH_LOST {
            let _ = writeln!(
                text,
                "  warning: `{name}` is lost in {:.0} % of the frames; look at them with --annotated check.gif",
                100.0 * lost
            );
        }
        let clutter = learned.clutter(index);
        if clutter > MUCH_CLUTTER {
            let _ = writeln!(
                text,
                "  warning: still things have the hue of `{name}` too, in {:.1} % of the picture; before them it may be lost",
                100.0 * clutter
            );
        }
    }
    text
}

/// In which frames a mark was seen, lost and ambiguous. Frames count from 1.
fn seen(mark: &MarkTrack) -> String {
    let frames = mark.is_lost.len();
    let list = |is_it: &dyn Fn(usize) -> bool| -> Vec<u32> {
        let frames = (0..frames).filter(|frame| is_it(*frame));
        frames.map(|frame| frame as u32).collect()
    };
    let ambiguous = list(&|frame| mark.is_ambiguous[frame]);
    let lost = list(&|frame| mark.is_lost[frame] && !mark.is_ambiguous[frame]);
    let seen = match frames - ambiguous.len() - lost.len() {
        all if all == frames => "all frames".to_owned(),
        some => format!("{some} of {frames} frames"),
    };
    let mut text = format!("{}: seen in {seen}", mark.name);
    for (what, list) in [("lost", lost), ("ambiguous", ambiguous)] {
        if !list.is_empty() {
            let (count, ranges) = (list.len(), frame_ranges(&list, MAX_RANGES));
            let _ = write!(text, ", {count} {what} ({ranges})");
        }
    }
    text
}

/// Writes the clip with what was found.
fn annotate(
    clip: &Clip,
    found: &MarkTracks,
    path: &Path,
    form: Annotated,
    inputs: &Inputs,
) -> Result<String, Failure> {
    let count = found.times.len() as u32;
    match form {
        Annotated::Numbered => {
            let name = |number: u32| numbered(path, number, count);
            let target = |number: u32| inputs.target(&name(number), Naming::Given);
            for number in 1..=count {
                target(number)?;
            }
            counting("writing", count, |done| {
                draw(clip, found, &mut |image, number| {
                    target(number as u32 + 1)
                        .and_then(|target| target.write(|out| write_png(&image, out)))
                        .map_err(|error| error.to_string())?;
                    done(number as u32 + 1);
                    Ok(())
                })
            })?;
            Ok(format!(
                "{} to {}",
                name(1).display(),
                name(count).display()
            ))
        }
        Annotated::Movie(form) => {
            let target = inputs.target(path, Naming::Given)?;
            counting("writing", count, |done| {
                movie(clip, found, form, &target, done)
            })?;
            Ok(path.display().to_string())
        }
    }
}

/// Writes all frames into one file.
fn movie(
    clip: &Clip,
    found: &MarkTracks,
    form: MovieForm,
    target: &Target,
    done: &dyn Fn(u32),
) -> Result<(), WriteError> {
    let count = found.times.len();
    // Videos store colours for two by two pixels.
    let size = match form {
        MovieForm::Video(_) => found.size.map(|side| (side & !1).max(2)),
        _ => found.size,
    };
    let length = found.times.last().copied().unwrap_or(0.0);
    let mean = if count > 1 {
        length / (count - 1) as f64
    } else {
        0.1
    };
    let movie = Movie {
        form,
        size,
        pictures: count as u32,
        rate: [(1000.0 / mean.max(1e-3)).round() as u32, 1000],
    };
    let palette = || -> io::Result<Palette> {
        let mut samples = Vec::new();
        let step = count.div_ceil(PALETTE_FRAMES);
        draw(clip, found, &mut |image, number| {
            if number.is_multiple_of(step) {
                samples.push(image);
            }
            Ok(())
        })
        .map_err(io::Error::other)?;
        Ok(Palette::new(&samples, None))
    };
    movie.write(target, palette, |push| {
        let frames = draw(clip, found, &mut |image, number| {
            let seconds = match found.times.get(number + 1) {
                Some(next) => next - found.times[number],
                None => mean,
            };
            let image = cut(image, size);
            push(&image, seconds, 1).map_err(|error| error.to_string())?;
            done(number as u32 + 1);
            Ok(())
        });
        frames.map_err(io::Error::other)
    })
}

/// Draws what was found on each frame.
fn draw(
    clip: &Clip,
    found: &MarkTracks,
    look: &mut dyn FnMut(Image, usize) -> Result<(), String>,
) -> Result<(), String> {
    let mut number = 0;
    clip.read(&mut |frame| {
        // A file that another program writes meanwhile may have more frames now.
        if number < found.times.len() {
            look(annotated(frame.image, found, number), number)?;
        }
        number += 1;
        Ok(())
    })
}

/// The upper left of a picture.
fn cut(image: Image, [width, height]: [u32; 2]) -> Image {
    if image.dimensions() == (width, height) {
        image
    } else {
        Image::from_fn(width, height, |x, y| {
            *image.get_pixel(x.min(image.width() - 1), y.min(image.height() - 1))
        })
    }
}

/// `check.png` becomes `check-07.png`, with as many digits as the last number has.
fn numbered(path: &Path, number: u32, last: u32) -> PathBuf {
    let digits = last.to_string().len();
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{number:0digits$}.png"));
    path.with_file_name(name)
}
