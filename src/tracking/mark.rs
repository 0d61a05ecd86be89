//! Marks to look for.

use glam::DVec2;
use thiserror::Error;

use super::color::Hsv;
use super::frame::Frame;

/// Below this saturation, a colour has no hue that a camera tells reliably.
const LEAST_SATURATION: f64 = 0.2;
/// Below this chroma, too.
const LEAST_CHROMA: f64 = 0.1;

/// A mark: its name, and about which colour it has.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Its name.
    pub name: String,
    /// About its colour, sRGB.
    pub color: [u8; 3],
    /// Its hue in degrees.
    pub hue: f64,
}

/// Why a colour cannot be that of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum MarkError {
    /// Its colour is black, grey or white.
    #[error("has no hue")]
    NoHue,
}

impl Mark {
    /// A mark of about this colour, sRGB. Only its hue has to be right: how pale and how bright the mark is in the clip is learned.
    ///
    /// # Errors
    /// If the colour is nearly black, grey or white.
    pub fn new(name: impl Into<String>, color: [u8; 3]) -> Result<Self, MarkError> {
        let hsv = Hsv::of(color);
        if hsv.saturation >= LEAST_SATURATION && hsv.chroma >= LEAST_CHROMA {
            Ok(Self {
                name: name.into(),
                color,
                hue: hsv.hue,
            })
        } else {
            Err(MarkError::NoHue)
        }
    }

    /// The mark that a person points at: with the colour around this place of a picture.
    ///
    /// # Errors
    /// If the picture is nearly black, grey or white there.
    pub fn picked(name: impl Into<String>, frame: Frame<'_>, at: DVec2) -> Result<Self, MarkError> {
        let size = frame.size.map(|side| side as usize);
        // A place outside is brought to the edge, also one that is no number.
        let index = |place: f64, side: usize| (place.round().max(0.0) as usize).min(side - 1);
        let (x, y) = (index(at.x, size[0]), index(at.y, size[1]));
        // A hundredth of the picture: about what a finger or a mouse can hit.
        let reach = size[0].min(size[1]) / 200 + 1;
        let mut sum = [0.0; 3];
        let mut weight = 0.0;
        for row in y.saturating_sub(reach)..=(y + reach).min(size[1] - 1) {
            for pixel in frame
                .row(row)
                .chunks_exact(3)
                .take(x + reach + 1)
                .skip(x.saturating_sub(reach))
            {
                let chroma = Hsv::of([pixel[0], pixel[1], pixel[2]]).chroma;
                weight += chroma;
                for (sum, value) in sum.iter_mut().zip(pixel) {
                    *sum += chroma * f64::from(*value);
                }
            }
        }
        if weight > 0.0 {
            Self::new(name, sum.map(|sum| (sum / weight).round() as u8))
        } else {
            Err(MarkError::NoHue)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grays_are_no_marks() {
        assert_eq!(Mark::new("a", [90, 92, 90]), Err(MarkError::NoHue));
        assert_eq!(Mark::new("a", [9, 0, 0]), Err(MarkError::NoHue));
        assert!(Mark::new("a", [200, 40, 30]).is_ok());
    }

    #[test]
    fn a_mark_is_picked_anywhere_in_the_picture() {
        let mut pixels = vec![200; 3 * 20 * 10];
        pixels[3 * (20 * 9 + 19)..].copy_from_slice(&[10, 20, 200]);
        let frame = Frame::new([20, 10], &pixels).unwrap();
        for at in [DVec2::new(19.0, 9.0), DVec2::new(1e9, 1e9)] {
            assert_eq!(
                Mark::picked("hand", frame, at).unwrap().color,
                [10, 20, 200]
            );
        }
        for at in [DVec2::ZERO, DVec2::NAN] {
            assert_eq!(Mark::picked("hand", frame, at), Err(MarkError::NoHue));
        }
    }
}
