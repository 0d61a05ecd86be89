//! The arguments of `okoshi render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Reading;
use crate::render::{MAX_FILM_STRIP_CELLS, MAX_PITCH, MAX_SIDE, MAX_TURNTABLE_FRAMES, View};

const EXAMPLES: &str = "\
Examples:
  okoshi render human.svg                             writes human.png beside the drawing
  okoshi render human.svg -o front.png --view 0,0     from the front
  okoshi render human.svg --view=-60,30               from its right, and from above
  okoshi render human.svg -o turn.gif --turntable 36  the model turns, as a moving GIF
  okoshi render human.svg -o turn.png --turntable 8   turn-1.png to turn-8.png
  okoshi render human.svg -o walk.gif --clip walk     the model moves; walk.png gives numbered frames
  okoshi render human.svg -o walk.mp4 --clip walk --follow
                                                      a video whose camera goes along with the model
  okoshi render human.svg -o walk.mp4 --clip walk --camera
                                                      a video by the camera that films the clip
  okoshi render human.svg -o step.png --clip walk --time 0.5
                                                      its pose after half a second
  okoshi render human.svg -o walk.png --clip walk --strip 6
                                                      six frames side by side
  okoshi render island.svg --view 0,45 --projection orthographic
                                                      terrain, tile for tile as drawn
  okoshi render human.svg -o drawn.png --as-drawn --scale 2
                                                      lies on the drawing, pixel for pixel
  okoshi render human.glb --size 1920x1080 --background '#ffffff'

The picture shows the model that `okoshi build` writes. The camera frames it by itself, a clip as a whole, so that a
walking figure stays in the picture. The background is transparent, in a GIF or a video white.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Render {
    /// The drawing, an SVG file, `-` for stdin; or a model, a .glb or .gltf file
    #[arg(value_name = "DRAWING")]
    pub(in crate::cli) drawing: PathBuf,
    /// Where to write: a .png, .gif, .apng, .mp4 or .webm file, `-` for stdout, or a folder [default: beside the drawing]
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// The direction of the camera: degrees to the model's left, degrees up [default: 30,15]
    #[arg(long, value_name = "YAW,PITCH", value_parser = view, allow_hyphen_values = true)]
    pub(in crate::cli) view: Option<View>,
    /// Show what a camera of the model sees, by name or by number from 1; without a name that of the clip, or the first
    #[arg(long, value_name = "NAME", num_args = 0..=1)]
    pub(in crate::cli) camera: Option<Option<String>>,
    /// Show the page as drawn: from the front, in parallel, without light, and exactly as large as the page
    ///
    /// Terrain looks as from 45° above, bent. The model is at rest.
    #[arg(long, conflicts_with_all = ["view", "size", "shading", "projection", "bend", "turntable", "clip", "time", "strip", "from", "to", "fps", "follow"])]
    pub(in crate::cli) as_drawn: bool,
    /// With --as-drawn, the pixels of a drawing unit [default: 1]
    #[arg(long, value_name = "PIXELS", requires = "as_drawn", value_parser = scale)]
    pub(in crate::cli) scale: Option<f64>,
    /// Width and height in pixels, 1 to 8192 each; of a strip, the size of each frame
    #[arg(long, value_name = "WxH", default_value = "800x800", value_parser = size)]
    pub(in crate::cli) size: [u32; 2],
    /// How surfaces are shaded
    #[arg(long, default_value = "smooth")]
    pub(in crate::cli) shading: Shading,
    /// How the camera projects [default: perspective]
    #[arg(long)]
    pub(in crate::cli) projection: Option<Projection>,
    /// Bend terrain with the view, so that from 45° above tops and fronts are as large as drawn; off shows its true shape
    #[arg(long, value_name = "WHEN", default_value = "on")]
    pub(in crate::cli) bend: Bend,
    /// The background colour, or `transparent` [default: transparent, in a GIF or a video white]
    #[arg(long, value_name = "#RRGGBB", value_parser = background)]
    pub(in crate::cli) background: Option<Background>,
    /// Turn the model once around in N pictures: one .gif, .apng, .mp4 or .webm, or numbered .png files
    #[arg(long, value_name = "N", value_parser = frames)]
    pub(in crate::cli) turntable: Option<u32>,
    /// Show a clip, by name or by number from 1: one .gif, .apng, .mp4 or .webm, or numbered .png files
    #[arg(long, value_name = "NAME")]
    pub(in crate::cli) clip: Option<String>,
    /// Move the camera along with the figure of the clip; lines show the ground
    #[arg(long, conflicts_with_all = ["time", "turntable"])]
    pub(in crate::cli) follow: bool,
    /// Show one frame of the clip, S seconds after its start
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with_all = ["fps", "strip", "from", "to"])]
    pub(in crate::cli) time: Option<f64>,
    /// Show N frames of the clip side by side, evenly spaced from its start to its end
    #[arg(long, value_name = "N", value_parser = cells, conflicts_with_all = ["fps", "turntable"])]
    pub(in crate::cli) strip: Option<u32>,
    /// Start the clip S seconds after its start
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "turntable")]
    pub(in crate::cli) from: Option<f64>,
    /// End the clip S seconds after its start
    #[arg(long, value_name = "S", value_parser = seconds, conflicts_with = "turntable")]
    pub(in crate::cli) to: Option<f64>,
    /// Frames a second of the clip, 1 to 120, in a GIF up to 50 [default: 24]
    #[arg(long, value_name = "F", value_parser = clap::value_parser!(u32).range(1..=120), conflicts_with = "turntable")]
    pub(in crate::cli) fps: Option<u32>,
    /// Draw whatever can be built despite errors
    #[arg(long)]
    pub(in crate::cli) keep_going: bool,
    #[command(flatten)]
    pub(in crate::cli) reading: Reading,
}

impl Render {
    /// Whether any option concerns a clip.
    pub(in crate::cli) fn asks_for_clip(&self) -> bool {
        let times = [self.time, self.from, self.to];
        self.clip.is_some()
            || self.follow
            || self.strip.or(self.fps).is_some()
            || times.iter().any(Option::is_some)
    }
}

/// What is behind the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Background {
    Transparent,
    /// In sRGB.
    Color([u8; 3]),
}

/// How surfaces are shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Shading {
    /// Every triangle flat
    Flat,
    /// With the normals of the model
    Smooth,
    /// In plain colours, without light
    Unlit,
}

/// How the camera projects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Projection {
    /// Distant things are smaller
    Perspective,
    /// Parallels stay parallel
    Orthographic,
}

/// Whether view-dependent nodes are bent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Bend {
    /// As the model asks: the drawn appearance
    On,
    /// Never: true 3D
    Off,
}

fn view(text: &str) -> Result<View, String> {
    let numbers = text.split_once(',').and_then(|(yaw, pitch)| {
        let number = |text: &str| {
            text.trim()
                .parse::<f64>()
                .ok()
                .filter(|number| number.is_finite())
        };
        Some((number(yaw)?, number(pitch)?))
    });
    match numbers {
        // Whole turns change nothing, and would cost precision.
        Some((yaw, pitch)) if pitch.abs() <= MAX_PITCH => Ok(View {
            yaw: yaw % 360.0,
            pitch,
        }),
        Some(_) => Err(format!(
            "the camera can be at most {MAX_PITCH} degrees up or down"
        )),
        None => Err("expected two numbers separated by a comma, for example 30,15".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once(['x', 'X', '×'])
        .and_then(|(width, height)| {
            Some([
                width.trim().parse::<u32>().ok()?,
                height.trim().parse::<u32>().ok()?,
            ])
        });
    match sides {
        Some(sides) if sides.iter().all(|side| (1..=MAX_SIDE).contains(side)) => Ok(sides),
        Some(_) => Err(format!("each side must have 1 to {MAX_SIDE} pixels")),
        None => Err("expected two whole numbers separated by an x, for example 800x800".to_owned()),
    }
}

fn scale(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(pixels) if pixels > 0.0 && pixels <= f64::from(MAX_SIDE) => Ok(pixels),
        _ => Err(format!(
            "expected a number of pixels above 0, up to {MAX_SIDE}, for example 2"
        )),
    }
}

fn background(text: &str) -> Result<Background, String> {
    if text == "transparent" {
        return Ok(Background::Transparent);
    }
    let digits = text.strip_prefix('#').unwrap_or(text);
    let valid = digits.len() == 6 && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| valid);
    match number {
        Some(number) => {
            let [_, color @ ..] = number.to_be_bytes();
            Ok(Background::Color(color))
        }
        None => Err(
            "expected a colour of six digits, for example '#ffffff' for white, or transparent"
                .to_owned(),
        ),
    }
}

fn frames(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(frames) if (2..=MAX_TURNTABLE_FRAMES).contains(&frames) => Ok(frames),
        _ => Err(format!(
            "expected a whole number from 2 to {MAX_TURNTABLE_FRAMES}, for example 36"
        )),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..1e9).contains(&seconds) => Ok(seconds),
        _ => Err("expected a number of seconds from 0, for example 1.5".to_owned()),
    }
}

fn cells(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(cells) if (2..=MAX_FILM_STRIP_CELLS).contains(&cells) => Ok(cells),
        _ => Err(format!(
            "expected a whole number from 2 to {MAX_FILM_STRIP_CELLS}, for example 6"
        )),
    }
}
