//! Files that hold all pictures of a clip or turntable: animations and videos.

use std::io;

use super::video::{self, Container, VideoFormat};
use crate::disk::{Target, WriteError};
use crate::export::Output;
use crate::render::{AnimationWriter, Image, Palette};

/// The format of a file with all pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum MovieForm {
    Gif,
    Apng,
    Video(Container),
}

impl MovieForm {
    /// The format for the extension of a file, in lower case.
    pub(in crate::cli) fn of(extension: &str) -> Option<Self> {
        match extension {
            "gif" => Some(Self::Gif),
            "apng" => Some(Self::Apng),
            "mp4" => Some(Self::Video(Container::Mp4)),
            "webm" => Some(Self::Video(Container::Webm)),
            _ => None,
        }
    }
}

/// A file with all pictures.
pub(in crate::cli) struct Movie {
    pub(in crate::cli) form: MovieForm,
    /// Width and height, pixels.
    pub(in crate::cli) size: [u32; 2],
    /// The number of pictures.
    pub(in crate::cli) pictures: u32,
    /// Frames per second, as a fraction.
    pub(in crate::cli) rate: [u32; 2],
}

/// Appends a picture that is shown for some seconds, which are some frames.
pub(in crate::cli) type Push<'a> = &'a mut dyn FnMut(&Image, f64, u32) -> io::Result<()>;

impl Movie {
    /// Writes the pictures that `draw` makes. `palette` finds the colours of a GIF.
    pub(in crate::cli) fn write(
        &self,
        target: &Target,
        palette: impl FnOnce() -> io::Result<Palette>,
        draw: impl FnOnce(Push<'_>) -> io::Result<()>,
    ) -> Result<(), WriteError> {
        let size = self.size;
        match self.form {
            MovieForm::Gif => {
                target.write(|out| animate(AnimationWriter::gif(out, size, palette()?)?, draw))
            }
            MovieForm::Apng => {
                target.write(|out| animate(AnimationWriter::apng(out, size, self.pictures)?, draw))
            }
            MovieForm::Video(container) => {
                let format = VideoFormat {
                    container,
                    size,
                    rate: self.rate,
                };
                let scratch = target.scratch()?;
                target.write(|out| {
                    video::encode(format, scratch, out, |encoder| {
                        draw(&mut |image, _, frames| encoder.push(image, frames))
                    })
                })
            }
        }
    }
}

fn animate(
    mut writer: AnimationWriter<&mut dyn Output>,
    draw: impl FnOnce(Push<'_>) -> io::Result<()>,
) -> io::Result<()> {
    draw(&mut |image, seconds, _| writer.push(image, seconds))?;
    writer.finish()
}
