//! `okoshi render`

use std::fmt::Write as _;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use super::args::{Bend, Common, Projection, Render, Shading};
use super::loading::{Detail, describe, load, root};
use super::progress::{counting, spinning};
use super::{Outcome, fail, style};
use crate::disk::{FolderResolver, read_drawing, write_atomic};
use crate::gltf::{self, Container};
use crate::render::{self, Animation, Options, Palette, Stage, write_png};

/// The side of the pictures that a GIF's colours are chosen from, pixels, and the most that there are: flat sides change
/// their shade with every frame.
const SKETCH: u32 = 160;
const SKETCHES: u32 = 36;

/// What is to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Picture,
    Numbered(u32),
    Gif(u32),
    Apng(u32),
}

/// Draws a drawing's model, or a model.
pub(super) fn run(arguments: &Render, common: Common) -> Outcome {
    let (output, kind) =
        match output(arguments).and_then(|output| Ok((kind(&output, arguments)?, output))) {
            Ok((kind, output)) => (output, kind),
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
    let stage = match spinning("posing", || Stage::new(&model, &model.rest())) {
        Ok(stage) => stage,
        // What is wrong is the drawing's, not the call's.
        Err(error) => {
            fail(&format!("`{name}` {error}"));
            return Outcome::Errors;
        }
    };
    match draw(&stage, arguments, &output, kind) {
        Ok(written) => {
            if !common.quiet {
                eprintln!("wrote {written}");
            }
            loaded
        }
        Err(message) => fail(&message),
    }
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

/// What a file's ending asks for.
fn kind(output: &Path, arguments: &Render) -> Result<Kind, String> {
    let ending = output
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    let stdout = output.as_os_str() == "-";
    match (ending.as_deref(), arguments.turntable) {
        // A file of frames where there can be but one file.
        (_, Some(frames)) if stdout => Ok(Kind::Apng(frames)),
        (_, None) if stdout => Ok(Kind::Picture),
        (Some("png"), None) => Ok(Kind::Picture),
        (Some("png"), Some(frames)) => Ok(Kind::Numbered(frames)),
        (Some("gif"), Some(frames)) => Ok(Kind::Gif(frames)),
        (Some("apng"), Some(frames)) => Ok(Kind::Apng(frames)),
        (Some("gif" | "apng"), None) => Err(format!(
            "`{}` would be a moving picture: say in how many frames the model turns, --turntable 36 for example, or end the output in .png",
            output.display()
        )),
        _ => Err(format!(
            "the output `{}` must end in .png, .gif or .apng",
            output.display()
        )),
    }
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
    let mut bytes = Cursor::new(Vec::new());
    match gltf::write(&loaded.compiled.scene, Container::Glb, &mut bytes) {
        Ok(_) => Ok((bytes.into_inner(), loaded.outcome())),
        Err(error) => Err(fail(&format!("`{}` cannot be drawn: {error}", loaded.path))),
    }
}

/// Draws and writes; says what was written.
fn draw(
    stage: &Stage<'_>,
    arguments: &Render,
    output: &Path,
    kind: Kind,
) -> Result<String, String> {
    let options = options(arguments);
    let [width, height] = options.size;
    let size = format!("{width} × {height} pixels, {} triangles", stage.triangles());
    let name = output.display();
    match kind {
        Kind::Picture => {
            let image = spinning("drawing", || stage.picture(&options))
                .map_err(|error| error.to_string())?;
            write_atomic(output, |out| write_png(&image, out))
                .map_err(|error| error.to_string())?;
            Ok(format!("{name}: {size}"))
        }
        Kind::Numbered(frames) => {
            let mut number = 0;
            counting("drawing", frames, |done| {
                stage.turntable(&options, frames, |image| {
                    number += 1;
                    write_atomic(&numbered(output, number, frames), |out| {
                        write_png(&image, out)
                    })
                    .map_err(|error| Failure(error.to_string()))?;
                    done(number);
                    Ok(())
                })
            })
            .map_err(|Failure(message)| message)?;
            let (first, last) = (
                numbered(output, 1, frames),
                numbered(output, frames, frames),
            );
            Ok(format!(
                "{} to {}: {size} each",
                first.display(),
                last.display()
            ))
        }
        Kind::Gif(frames) | Kind::Apng(frames) => {
            counting("drawing", frames, |done| {
                write_atomic(output, |out| {
                    let mut animation = match kind {
                        Kind::Gif(_) => Animation::gif(
                            out,
                            options.size,
                            frames,
                            palette(stage, &options, frames)?,
                        )?,
                        _ => Animation::apng(out, options.size, frames)?,
                    };
                    let mut number = 0;
                    stage.turntable(&options, frames, |image| -> io::Result<()> {
                        animation.push(&image)?;
                        number += 1;
                        done(number);
                        Ok(())
                    })?;
                    animation.finish()
                })
            })
            .map_err(|error| error.to_string())?;
            Ok(format!("{name}: {frames} frames, {size} each"))
        }
    }
}

/// Why frames could not be drawn or written.
struct Failure(String);

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

/// The colours of a GIF, from a few small pictures of what it will show.
fn palette(stage: &Stage<'_>, options: &Options, frames: u32) -> io::Result<Palette> {
    let longest = options.size[0].max(options.size[1]).max(SKETCH);
    let size = options.size.map(|side| (side * SKETCH / longest).max(1));
    let mut sketches = Vec::new();
    stage.turntable(
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
