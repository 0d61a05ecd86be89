//! Moving pictures of models that pages show, also where there is one thread alone.

use std::io;

use super::models::Bytes;
use crate::render::{
    self, AnimationWriter, Film, Image, Options, Palette, PosedModel, RenderError,
    TURNTABLE_SECONDS, View,
};
use crate::resolver::MemoryResolver;

/// The side of the pictures, in pixels.
const SIZE: u32 = 480;
/// Frames a second of a clip: that of film, and of the clips that okoshi makes.
const FPS: u32 = 24;
/// The longest clip, in seconds.
const MAX_SECONDS: f64 = 60.0;
/// The pictures of a model that turns.
const TURNS: u32 = 48;
/// The colours of a GIF are chosen from so many pictures.
const PALETTE_PICTURES: usize = 12;
/// The background, which a GIF needs for soft edges.
const WHITE: [u8; 3] = [255; 3];

/// What a moving picture is to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shot {
    /// The clip, by its number from 0; without one the model turns around once.
    pub(crate) clip: Option<usize>,
    /// Degrees to the model's left, and up.
    pub(crate) view: [f64; 2],
}

/// Why there is no moving picture.
#[derive(Debug, thiserror::Error)]
pub(crate) enum NoFilm {
    #[error("the model {0}")]
    Drawing(#[from] RenderError),
    #[error("the picture cannot be written: {0}")]
    Writing(#[from] io::Error),
    #[error("the drawing was built again meanwhile, without this clip: choose another one")]
    NoClip,
    #[error(
        "the clip lasts {0:.0} seconds, and moving pictures made here at most {MAX_SECONDS}: \
         `okoshi render --clip` with `--from` and `--to` makes one of any part"
    )]
    TooLong(f64),
}

/// A moving picture of a model in binary glTF, as GIF.
pub(crate) fn gif(model: &[u8], shot: Shot) -> Result<Bytes, NoFilm> {
    let model = render::read(model, &MemoryResolver::default())?;
    let [yaw, pitch] = shot.view;
    let options = Options::default()
        .with_size([SIZE; 2])
        .with_view(View { yaw, pitch })
        .with_background(WHITE);
    let gif = match shot.clip {
        Some(number) => {
            let clip = model.clips().get(number).ok_or(NoFilm::NoClip)?;
            if clip.seconds > MAX_SECONDS {
                return Err(NoFilm::TooLong(clip.seconds));
            }
            let film = Film::new(&model, clip, [0.0, clip.seconds])?;
            let pictures = film.held_frames(FPS)?;
            let shooting = film.shooting(&options)?;
            let seconds = pictures.iter().map(|picture| picture.seconds);
            written(seconds.collect(), |wanted, each| {
                let moments = wanted.iter().map(|index| pictures[*index].time);
                shooting.draw(moments, each)
            })?
        }
        None => {
            let posed = PosedModel::new(&model, &model.rest())?;
            let seconds = f64::from(TURNTABLE_SECONDS) / f64::from(TURNS);
            written(vec![seconds; TURNS as usize], |wanted, each| {
                // Every fourth picture of a turn is one of a turn with a fourth of the pictures.
                posed.turntable(&options, wanted.len() as u32, each)
            })?
        }
    };
    Ok(gif.into())
}

/// A moving picture of a model in binary glTF, as GIF: of a clip, by its number, or of the model that turns around once; from a
/// direction in degrees to its left and up.
///
/// # Errors
/// Why there is none, as the end of a sentence.
pub fn film(model: &[u8], clip: Option<usize>, view: [f64; 2]) -> Result<Vec<u8>, String> {
    let film = gif(model, Shot { clip, view });
    film.map(|film| film.to_vec())
        .map_err(|why| why.to_string())
}

/// What draws pictures of these numbers, in their order.
type Each<'a> = &'a mut dyn FnMut(Image) -> io::Result<()>;

/// Writes pictures that last so many seconds each.
fn written(
    seconds: Vec<f64>,
    draw: impl Fn(&[usize], Each<'_>) -> io::Result<()>,
) -> io::Result<Vec<u8>> {
    let all: Vec<usize> = (0..seconds.len()).collect();
    // Several, as flat sides change their shade with every picture. Drawing them twice takes less memory than keeping all.
    let step = all.len().div_ceil(PALETTE_PICTURES).max(1);
    let some: Vec<usize> = all.iter().copied().step_by(step).collect();
    let mut samples: Vec<Image> = Vec::new();
    draw(&some, &mut |image| {
        samples.push(image);
        Ok(())
    })?;
    let palette = Palette::new(&samples, Some(WHITE));
    drop(samples);
    let mut gif = Vec::new();
    let mut writer = AnimationWriter::gif(&mut gif, [SIZE; 2], palette)?;
    let mut left = seconds.iter();
    draw(&all, &mut |image| {
        let seconds = left.next().copied().unwrap_or_default();
        writer.push(&image, seconds)
    })?;
    writer.finish()?;
    Ok(gif)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile;
    use crate::export::{GLB, to_memory};

    #[test]
    fn why_there_is_no_film_is_said() {
        let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><rect width="9" height="9"/></svg>"#;
        let files = MemoryResolver::default();
        let compiled = compile::compile(drawing, &compile::Options::default(), &files);
        let model = to_memory(&GLB, &compiled.scene, None).unwrap().bytes;
        let none = film(&model, Some(3), [0.0, 0.0]).unwrap_err();
        assert!(none.contains("choose another one"), "{none}");
        let unread = film(b"glTF", None, [0.0, 0.0]).unwrap_err();
        assert!(unread.starts_with("the model "), "{unread}");
    }
}
