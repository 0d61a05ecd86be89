//! `okoshi render`

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use super::args::{Bend, Common, Projection, Render, Shading};
use super::loading::{Detail, describe, load, root};
use super::progress::{counting, spinning};
use super::{Outcome, fail, style};
use crate::disk::{FolderResolver, read_drawing, write_atomic};
use crate::export::{self, GLB};
use crate::render::{
    self, AnimationWriter, Clip, Model, Options, Palette, PosedModel, TURNTABLE_SECONDS, write_png,
};

mod clips;

/// The side of the pictures that a GIF's colours are chosen from, pixels, and the most that there are: flat sides change
/// their shade with every frame.
const SKETCH: u32 = 160;
const SKETCHES: u32 = 36;

/// The files that pictures are put into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// One picture, or numbered ones.
    Png,
    Gif,
    Apng,
}

/// What is to be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    /// The model at rest, or at a moment of a clip.
    Still,
    /// The same from so many sides.
    Turning(u32),
    /// A clip.
    Moving,
    /// So many moments of a clip.
    Strip(u32),
}

/// Draws a drawing's model, or a model.
pub(super) fn run(arguments: &Render, common: Common) -> Outcome {
    let asked = output(arguments).and_then(|output| {
        let subject = subject(arguments)?;
        Ok((form(&output, subject, arguments)?, subject, output))
    });
    let (form, subject, output) = match asked {
        Ok(asked) => asked,
        Err(message) => return fail(&message),
    };
    let (bytes, loaded) = match model(arguments, common) {
        Ok(found) => found,
        Err(outcome) => return outcome,
    };
    let name = arguments.drawing.display();
    let resolver = FolderResolver::new(root(&arguments.drawing, &arguments.reading));
    let model = match render::read(&bytes, &resolver) {
        Ok(model) => model,
        Err(error) => return fail(&format!("`{name}` {error}")),
    };
    drop(bytes);
    let clip = match clip(&model, arguments) {
        Ok(clip) => clip,
        Err(message) => return fail(&format!("`{name}` {message}")),
    };
    let written = match (subject, clip) {
        (Subject::Moving | Subject::Strip(_), Some((clip, _))) => {
            let film = match clips::film(&model, clip, arguments) {
                Ok(film) => film,
                Err(message) => return fail(&format!("`{name}` {message}")),
            };
            match subject {
                Subject::Strip(cells) => clips::strip(&film, arguments, cells, &output),
                _ => clips::moving(&film, arguments, form, &output),
            }
        }
        (_, clip) => {
            let pose = match clip {
                Some((clip, time)) => model.pose_at(clip, time),
                None => model.rest(),
            };
            let posed = match spinning("posing", || PosedModel::new(&model, &pose)) {
                Ok(posed) => posed,
                // What is wrong is the drawing's, not the call's.
                Err(error) => {
                    fail(&format!("`{name}` {error}"));
                    return Outcome::Errors;
                }
            };
            draw(&posed, arguments, &output, (form, subject))
        }
    };
    match written {
        Ok(written) => {
            if !common.quiet {
                eprintln!("wrote {written}");
            }
            loaded
        }
        Err(Failure(message)) => fail(&message),
    }
}

/// The clip that is asked for, if one is, and the moment of it.
fn clip<'a>(model: &'a Model, arguments: &Render) -> Result<Option<(&'a Clip, f64)>, String> {
    if !arguments.asks_for_clip() {
        return Ok(None);
    }
    let clip = clips::chosen(model, arguments.clip.as_deref())?;
    let time = clips::within(clip, "--time", arguments.time.unwrap_or(0.0))?;
    Ok(Some((clip, time)))
}

/// Where the picture goes.
fn output(arguments: &Render) -> Result<PathBuf, String> {
    let drawing = &arguments.drawing;
    let stdin = drawing.as_os_str() == "-";
    let beside = |drawing: &Path| drawing.with_extension("png");
    match &arguments.output {
        Some(folder) if folder.is_dir() => match drawing.file_name() {
            Some(name) if !stdin => Ok(folder.join(beside(Path::new(name)))),
            _ => Err("a drawing from stdin has no name: name the output file with -o".to_owned()),
        },
        Some(output) => Ok(output.clone()),
        None if stdin => {
            Err("a drawing from stdin has no place of its own: name the output with -o".to_owned())
        }
        None => Ok(beside(drawing)),
    }
}

/// What the options ask for.
fn subject(arguments: &Render) -> Result<Subject, String> {
    match (arguments.strip, arguments.turntable) {
        (Some(cells), _) => Ok(Subject::Strip(cells)),
        (None, Some(_)) if arguments.clip.is_some() && arguments.time.is_none() => Err(
            "--turntable turns one moment of a clip: say which with --time, in seconds".to_owned(),
        ),
        (None, Some(frames)) => Ok(Subject::Turning(frames)),
        (None, None) if arguments.asks_for_clip() && arguments.time.is_none() => {
            Ok(Subject::Moving)
        }
        (None, None) => Ok(Subject::Still),
    }
}

/// What a file's ending asks for.
fn form(output: &Path, subject: Subject, arguments: &Render) -> Result<Form, String> {
    let ending = output
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    let one = matches!(subject, Subject::Still | Subject::Strip(_));
    let form = match ending.as_deref() {
        // A file of frames where there can be but one file.
        _ if output.as_os_str() == "-" && !one => Form::Apng,
        _ if output.as_os_str() == "-" => Form::Png,
        Some("png") => Form::Png,
        Some("gif") => Form::Gif,
        Some("apng") => Form::Apng,
        _ => {
            return Err(format!(
                "the output `{}` must end in .png, .gif or .apng",
                output.display()
            ));
        }
    };
    if one && form != Form::Png {
        let name = output.display();
        return Err(match arguments.asks_for_clip() {
            true => format!(
                "`{name}` would be an animation, but --time and --strip make a still picture: use an output that ends in .png"
            ),
            false => format!(
                "`{name}` would be a moving picture: say in how many frames the model turns, --turntable 36 for example, or which clip it shows, --clip NAME, or end the output in .png"
            ),
        });
    }
    clips::check_fps(arguments, form)?;
    Ok(form)
}

/// The model's bytes, and how the reading of the drawing ended; findings are printed.
fn model(arguments: &Render, common: Common) -> Result<(Vec<u8>, Outcome), Outcome> {
    let drawing = &arguments.drawing;
    let ending = drawing
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    if matches!(ending.as_deref(), Some("glb" | "gltf")) {
        let bytes = read_drawing(drawing).map_err(|error| fail(&error.to_string()))?;
        return Ok((bytes, Outcome::Done));
    }
    let loaded = spinning("building", || load(drawing, &arguments.reading))?;
    eprint!(
        "{}",
        describe(
            loaded.findings(),
            common,
            Detail::Aside,
            style(common, &io::stderr())
        )
    );
    let empty = loaded.compiled.scene.nodes.is_empty();
    if loaded.compiled.has_errors() && (empty || !arguments.keep_going) {
        if !common.quiet {
            eprintln!("nothing was written");
        }
        return Err(Outcome::Errors);
    }
    match export::to_memory(&GLB, &loaded.compiled.scene, None) {
        Ok(model) => Ok((model.bytes, loaded.outcome())),
        Err(error) => Err(fail(&format!("`{}` cannot be drawn: {error}", loaded.path))),
    }
}

/// The size of pictures, and how much there is in them.
fn same_look([width, height]: [u32; 2], triangles: usize) -> String {
    format!("{width} × {height} pixels, {triangles} triangles")
}

/// Draws and writes; says what was written.
fn draw(
    posed: &PosedModel<'_>,
    arguments: &Render,
    output: &Path,
    what: (Form, Subject),
) -> Result<String, Failure> {
    let options = options(arguments);
    let look = same_look(options.size, posed.triangles());
    let name = output.display();
    match what {
        (Form::Png, Subject::Turning(frames)) => {
            let mut number = 0;
            counting("drawing", frames, |done| {
                posed.turntable(&options, frames, |image| {
                    number += 1;
                    write_atomic(&numbered(output, number, frames), |out| {
                        write_png(&image, out)
                    })
                    .map_err(Failure::written)?;
                    done(number);
                    Ok::<(), Failure>(())
                })
            })?;
            let [first, last] = [1, frames].map(|number| numbered(output, number, frames));
            let (first, last) = (first.display(), last.display());
            Ok(format!("{first} to {last}: {look} each"))
        }
        (form, Subject::Turning(frames)) => {
            counting("drawing", frames, |done| {
                write_atomic(output, |out| {
                    let mut animation = match form {
                        Form::Gif => {
                            let palette = palette(posed, &options, frames)?;
                            AnimationWriter::gif(out, options.size, palette)?
                        }
                        Form::Png | Form::Apng => AnimationWriter::apng(out, options.size, frames)?,
                    };
                    let mut number = 0;
                    posed.turntable(&options, frames, |image| -> io::Result<()> {
                        animation.push(&image, TURNTABLE_SECONDS / f64::from(frames))?;
                        number += 1;
                        done(number);
                        Ok(())
                    })?;
                    animation.finish()
                })
            })
            .map_err(Failure::written)?;
            Ok(format!("{name}: {frames} frames, {look} each"))
        }
        _ => {
            let image = spinning("drawing", || posed.picture(&options))?;
            write_atomic(output, |out| write_png(&image, out)).map_err(Failure::written)?;
            Ok(format!("{name}: {look}"))
        }
    }
}

/// Why pictures could not be drawn or written.
struct Failure(String);

impl Failure {
    /// What is wrong with the model.
    fn of(arguments: &Render, error: &render::RenderError) -> Self {
        Self(format!("`{}` {error}", arguments.drawing.display()))
    }

    fn written(error: impl std::fmt::Display) -> Self {
        Self(error.to_string())
    }
}

impl From<render::RenderError> for Failure {
    fn from(error: render::RenderError) -> Self {
        Self(error.to_string())
    }
}

fn options(arguments: &Render) -> Options {
    Options {
        size: arguments.size,
        view: arguments.view,
        projection: match arguments.projection {
            Projection::Perspective => render::Projection::Perspective,
            Projection::Orthographic => render::Projection::Orthographic,
        },
        shading: match arguments.shading {
            Shading::Flat => render::Shading::Flat,
            Shading::Smooth => render::Shading::Smooth,
        },
        bend: arguments.bend == Bend::On,
        background: arguments.background,
    }
}

/// A size, made so small that drawing it is quick.
fn sketched(size: [u32; 2]) -> [u32; 2] {
    let longest = size[0].max(size[1]).max(SKETCH);
    size.map(|side| (side * SKETCH / longest).max(1))
}

/// The colours of a GIF, from a few small pictures of what it will show.
fn palette(posed: &PosedModel<'_>, options: &Options, frames: u32) -> io::Result<Palette> {
    let size = sketched(options.size);
    let mut sketches = Vec::new();
    posed.turntable(
        &Options { size, ..*options },
        frames.min(SKETCHES),
        |image| -> io::Result<()> {
            sketches.push(image);
            Ok(())
        },
    )?;
    Ok(Palette::new(&sketches))
}

/// `turn.png` becomes `turn-07.png`: as many digits as the last number has.
fn numbered(output: &Path, number: u32, last: u32) -> PathBuf {
    let digits = last.to_string().len();
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    let mut tail = String::new();
    let _ = write!(tail, "-{number:0digits$}.");
    name.push(tail);
    name.push(output.extension().unwrap_or_default());
    output.with_file_name(name)
}
