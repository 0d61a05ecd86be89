//! `okoshi render`

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use self::movie::{Movie, MovieForm};
use super::args::{Background, Bend, Common, Projection, Render, Shading};
use super::loading::{load, made_from, resolver};
use super::progress::{counting, spinning};
use super::{Failure, Outcome, ending, fail};
use crate::disk::{Inputs, Naming, Target, WriteError, is_standard_stream, read_file};
use crate::export::{self, GLB};
use crate::look::{DrawnView, LookError};
use crate::render::{
    self, Clip, Model, ModelCamera, Options, Palette, PosedModel, RenderError, Sheet,
    TURNTABLE_SECONDS, write_png,
};
use crate::resolver::LinkList;

mod cameras;
mod clips;
pub(super) mod movie;
pub(super) mod video;

/// The side in pixels of the thumbnails that the colours of a GIF are chosen from.
const THUMBNAIL_SIZE: u32 = 128;
/// The most thumbnails: several are needed, as flat sides change their shade with every frame.
const MAX_THUMBNAILS: u32 = 16;
/// The background of formats without partial transparency, unless another one is requested.
const DEFAULT_BACKGROUND: [u8; 3] = [255; 3];

/// The format of the output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// One picture, or numbered ones.
    Png,
    /// All pictures in one file.
    Movie(MovieForm),
}

/// What to draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    /// The model at rest, or at one time of a clip.
    Still,
    /// The same from this many sides.
    Turntable(u32),
    /// A clip.
    Clip,
    /// This many frames of a clip, side by side.
    Strip(u32),
}

/// Renders the model of a drawing, or a model.
pub(super) fn run(arguments: &Render, common: Common) -> Result<Outcome, Failure> {
    let path = output(arguments)?;
    cameras::check(arguments)?;
    let subject = subject(arguments)?;
    let form = form(&path, subject, arguments)?;
    let Source {
        bytes,
        page,
        linked,
        outcome,
    } = model(arguments, common)?;
    let resolver = resolver(&arguments.drawing, &arguments.reading);
    let links = LinkList::new(&resolver);
    let model = render::read(&bytes, &links).map_err(|error| of_drawing(arguments, &error))?;
    drop(bytes);
    let read = links.into_links().into_iter();
    let read = read.filter_map(|link| resolver.place(&link).ok());
    let output = Destination {
        inputs: Inputs::of(&arguments.drawing).linking(linked.into_iter().chain(read)),
        naming: Naming::of(arguments.output.as_deref(), &path),
        path,
    };
    let clip = clip(&model, arguments).map_err(|error| of_drawing(arguments, &error))?;
    let camera = cameras::chosen(&model, clip.map(|(clip, _)| clip), arguments)
        .map_err(|error| of_drawing(arguments, &error))?;
    let written = match (subject, clip) {
        (Subject::Clip | Subject::Strip(_), Some((clip, _))) => {
            let film = clips::film(&model, clip, camera, arguments)
                .map_err(|error| of_drawing(arguments, &error))?;
            match subject {
                Subject::Strip(cells) => clips::strip(&film, arguments, cells, &output),
                _ => match form {
                    Form::Png => clips::numbered(&film, arguments, &output),
                    Form::Movie(form) => clips::movie(&film, arguments, form, &output),
                },
            }
        }
        (_, clip) => {
            let pose = match clip {
                Some((clip, time)) => model.pose_at(clip, time),
                None => model.rest(),
            };
            let posed = spinning("posing", || PosedModel::new(&model, &pose));
            // An error of the drawing, not of how the command was called.
            let posed = posed.map_err(|error| {
                fail(of_drawing(arguments, &error));
                Outcome::Errors
            })?;
            match page {
                Some(page) => draw_page(&posed, arguments, &output, page),
                None => draw(&posed, camera, arguments, &output, (form, subject)),
            }
        }
    };
    let written = written?;
    if !common.quiet {
        eprintln!("wrote {written}");
    }
    Ok(outcome)
}

/// A message about the drawing or model.
fn of_drawing(arguments: &Render, message: &impl Display) -> String {
    format!("`{}` {message}", arguments.drawing.display())
}

/// Where pictures are written.
struct Destination {
    path: PathBuf,
    naming: Naming,
    /// What is read, and must not be replaced.
    inputs: Inputs,
}

impl Destination {
    /// The file of a single picture or animation.
    fn single(&self) -> Result<Target, WriteError> {
        self.inputs.target(&self.path, self.naming)
    }

    /// The file of one of several pictures: `turn.png` becomes `turn-07.png`, with as many digits as the last number has.
    fn numbered(&self, number: u32, last: u32) -> Result<Target, WriteError> {
        let path = self.numbered_path(number, last);
        self.inputs.target(&path, self.naming)
    }

    fn numbered_path(&self, number: u32, last: u32) -> PathBuf {
        let digits = last.to_string().len();
        let mut name = self.path.file_stem().unwrap_or_default().to_owned();
        name.push(format!("-{number:0digits$}."));
        name.push(self.path.extension().unwrap_or_default());
        self.path.with_file_name(name)
    }

    /// Refuses before anything is drawn if one of `count` pictures may not be written.
    fn check_numbered(&self, count: u32) -> Result<(), WriteError> {
        (1..=count).try_for_each(|number| self.numbered(number, count).map(|_| ()))
    }

    /// The names of the first and the last of several pictures.
    fn range(&self, last: u32) -> String {
        let [first, last] = [1, last].map(|number| self.numbered_path(number, last));
        format!("{} to {}", first.display(), last.display())
    }
}

/// The requested clip and time, if any.
fn clip<'a>(model: &'a Model, arguments: &Render) -> Result<Option<(&'a Clip, f64)>, String> {
    if !arguments.asks_for_clip() {
        return Ok(None);
    }
    let clip = clips::chosen(model, arguments.clip.as_deref())?;
    let time = clips::within(clip, "--time", arguments.time.unwrap_or(0.0))?;
    Ok(Some((clip, time)))
}

fn output(arguments: &Render) -> Result<PathBuf, &'static str> {
    match &arguments.output {
        Some(output) if !output.is_dir() => Ok(output.clone()),
        folder => made_from(&arguments.drawing, folder.as_deref(), "png"),
    }
}

/// The subject that the options request.
fn subject(arguments: &Render) -> Result<Subject, String> {
    match (arguments.strip, arguments.turntable) {
        (Some(cells), _) => Ok(Subject::Strip(cells)),
        (None, Some(_)) if arguments.clip.is_some() && arguments.time.is_none() => Err(
            "--turntable shows one pose of a clip: choose it with --time, in seconds".to_owned(),
        ),
        (None, Some(frames)) => Ok(Subject::Turntable(frames)),
        (None, None) if arguments.asks_for_clip() && arguments.time.is_none() => Ok(Subject::Clip),
        (None, None) => Ok(Subject::Still),
    }
}

/// The format for the extension of the output.
fn form(output: &Path, subject: Subject, arguments: &Render) -> Result<Form, String> {
    let one = matches!(subject, Subject::Still | Subject::Strip(_));
    let form = match ending(output).as_str() {
        // Standard output is a single file, so all frames go into one.
        _ if is_standard_stream(output) && !one => Form::Movie(MovieForm::Apng),
        _ if is_standard_stream(output) => Form::Png,
        "png" => Form::Png,
        ending => Form::Movie(MovieForm::of(ending).ok_or_else(|| {
            format!(
                "the output `{}` must end in .png, .gif, .apng, .mp4 or .webm",
                output.display()
            )
        })?),
    };
    if one && form != Form::Png {
        let name = output.display();
        return Err(if arguments.asks_for_clip() {
            format!(
                "`{name}` would be an animation, but --time and --strip make a still picture: use an output that ends in .png"
            )
        } else {
            format!(
                "`{name}` would be an animation: choose what it shows with --turntable 36 or --clip NAME, or end the output in .png"
            )
        });
    }
    clips::check_fps(arguments, form)?;
    let transparent = arguments.background == Some(Background::Transparent);
    match form {
        Form::Movie(MovieForm::Video(_)) if transparent => Err(
            "videos have no transparency: choose another --background, or write .apng".to_owned(),
        ),
        _ => Ok(form),
    }
}

/// What is drawn.
struct Source {
    /// The model, a glTF file.
    bytes: Vec<u8>,
    /// With `--as-drawn`, the page and its size in pixels.
    page: Option<(Sheet, [u32; 2])>,
    /// The files that the drawing links to.
    linked: Vec<PathBuf>,
    /// The outcome of compiling the drawing.
    outcome: Outcome,
}

/// The model, and the outcome of compiling the drawing, whose findings are printed.
fn model(arguments: &Render, common: Common) -> Result<Source, Failure> {
    let drawing = &arguments.drawing;
    if matches!(ending(drawing).as_str(), "glb" | "gltf") {
        if arguments.as_drawn {
            return Err(format!(
                "`{}` is a model, which has no page: --as-drawn needs the drawing",
                drawing.display()
            )
            .into());
        }
        return Ok(Source {
            bytes: read_file(drawing)?,
            page: None,
            linked: Vec::new(),
            outcome: Outcome::Done,
        });
    }
    let mut loaded = spinning("building", || load(drawing, &arguments.reading))?;
    eprint!("{}", loaded.findings_aside(common));
    if !loaded.can_be_written(arguments.keep_going) {
        if !common.quiet {
            eprintln!("nothing was written");
        }
        return Err(Outcome::Errors.into());
    }
    let outcome = loaded.outcome();
    let linked = loaded.linked(&resolver(drawing, &arguments.reading));
    let mut scene = std::mem::take(&mut loaded.compiled.scene);
    let page = if arguments.as_drawn {
        let scale = arguments.scale.unwrap_or(1.0);
        let view = DrawnView::new(&loaded.compiled, scene, scale)
            .map_err(|error| page_failure(&loaded.path, &error))?;
        scene = view.scene;
        Some((view.sheet, view.size))
    } else {
        None
    };
    let model = export::to_memory(&GLB, &scene, None)
        .map_err(|error| format!("`{}` cannot be drawn: {error}", loaded.path))?;
    Ok(Source {
        bytes: model.bytes,
        page,
        linked,
        outcome,
    })
}

/// Why the page cannot be drawn.
fn page_failure(path: &str, error: &LookError) -> String {
    let way = match error {
        LookError::Render(RenderError::Size(..)) => "; choose a smaller --scale",
        _ => "",
    };
    format!("`{path}` {error}{way}")
}

/// The size of pictures and the number of triangles in them.
fn describe_picture([width, height]: [u32; 2], triangles: usize) -> String {
    format!("{width} × {height} pixels, {triangles} triangles")
}

/// Draws and writes pictures, and returns a description of them.
fn draw(
    posed: &PosedModel<'_>,
    camera: Option<&ModelCamera>,
    arguments: &Render,
    output: &Destination,
    what: (Form, Subject),
) -> Result<String, Failure> {
    let options = options(arguments, what.0);
    let picture = describe_picture(options.size, posed.triangles);
    let name = output.path.display();
    match what {
        (Form::Png, Subject::Turntable(frames)) => {
            output.check_numbered(frames)?;
            let mut number = 0;
            counting("drawing", frames, |done| {
                posed.turntable(&options, frames, |image| {
                    number += 1;
                    output
                        .numbered(number, frames)
                        .and_then(|target| target.write(|out| write_png(&image, out)))?;
                    done(number);
                    Ok::<(), Failure>(())
                })
            })?;
            Ok(format!("{}: {picture} each", output.range(frames)))
        }
        (Form::Movie(form), Subject::Turntable(frames)) => {
            let target = output.single()?;
            let movie = Movie {
                form,
                size: options.size,
                pictures: frames,
                rate: [frames, TURNTABLE_SECONDS],
            };
            let seconds = f64::from(TURNTABLE_SECONDS) / f64::from(frames);
            counting("drawing", frames, |done| {
                let colors = || palette(posed, &options, frames);
                movie.write(&target, colors, |push| {
                    let mut number = 0;
                    posed.turntable(&options, frames, |image| -> io::Result<()> {
                        push(&image, seconds, 1)?;
                        number += 1;
                        done(number);
                        Ok(())
                    })
                })
            })?;
            Ok(format!("{name}: {frames} frames, {picture} each"))
        }
        _ => {
            let target = output.single()?;
            let image = spinning("drawing", || match camera {
                Some(camera) => posed.picture_by(&options, camera),
                None => posed.picture(&options),
            });
            let image = image.map_err(|error| of_drawing(arguments, &error))?;
            target.write(|out| write_png(&image, out))?;
            Ok(format!("{name}: {picture}"))
        }
    }
}

/// Draws and writes the page as it is drawn, and returns a description of the picture.
fn draw_page(
    posed: &PosedModel<'_>,
    arguments: &Render,
    output: &Destination,
    (sheet, size): (Sheet, [u32; 2]),
) -> Result<String, Failure> {
    let options = Options {
        size,
        shading: render::Shading::Unlit,
        background: background(arguments, Form::Png),
        ..Options::default()
    };
    let target = output.single()?;
    let image = spinning("drawing", || posed.picture_of(&options, &sheet))?;
    target.write(|out| write_png(&image, out))?;
    let picture = describe_picture(size, posed.triangles);
    Ok(format!("{}: {picture}", output.path.display()))
}

/// The background of the pictures; `None` is transparent.
fn background(arguments: &Render, form: Form) -> Option<[u8; 3]> {
    match (arguments.background, form) {
        (Some(Background::Color(color)), _) => Some(color),
        (Some(Background::Transparent), _) | (None, Form::Png | Form::Movie(MovieForm::Apng)) => {
            None
        }
        (None, Form::Movie(MovieForm::Gif | MovieForm::Video(_))) => Some(DEFAULT_BACKGROUND),
    }
}

fn options(arguments: &Render, form: Form) -> Options {
    Options {
        size: match form {
            // The codecs store the colours of two by two pixels together.
            Form::Movie(MovieForm::Video(_)) => arguments.size.map(|side| side.next_multiple_of(2)),
            Form::Png | Form::Movie(_) => arguments.size,
        },
        view: arguments.view.unwrap_or_default(),
        projection: match arguments.projection {
            None | Some(Projection::Perspective) => render::Projection::Perspective,
            Some(Projection::Orthographic) => render::Projection::Orthographic,
        },
        shading: match arguments.shading {
            Shading::Flat => render::Shading::Flat,
            Shading::Smooth => render::Shading::Smooth,
            Shading::Unlit => render::Shading::Unlit,
        },
        bend: arguments.bend == Bend::On,
        background: background(arguments, form),
    }
}

/// The size of a thumbnail of a picture.
fn thumbnail_size(size: [u32; 2]) -> [u32; 2] {
    let longest = size[0].max(size[1]).max(THUMBNAIL_SIZE);
    size.map(|side| (side * THUMBNAIL_SIZE / longest).max(1))
}

/// The colours of a GIF, from thumbnails of its frames.
fn palette(posed: &PosedModel<'_>, options: &Options, frames: u32) -> io::Result<Palette> {
    let size = thumbnail_size(options.size);
    let mut thumbnails = Vec::new();
    posed.turntable(
        &Options { size, ..*options },
        frames.min(MAX_THUMBNAILS),
        |image| -> io::Result<()> {
            thumbnails.push(image);
            Ok(())
        },
    )?;
    Ok(Palette::new(&thumbnails, options.background))
}
