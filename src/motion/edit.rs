//! A motion edited by itself: made ready, cut, and compared with other ways to cut it.

use glam::{DQuat, DVec3};

use super::bvh::{self, Decimals};
use super::carry::{self, Landmarks};
use super::chart::{Chart, chart};
use super::labels::Anatomy;
use super::limited::{self, Camera, Cut, Drawn, Error, Exposure, Length, Method};
use super::ready::{self, Ready};
use super::resample;
use super::skeleton::{Clip, height};

/// How a motion is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum How {
    /// Not at all.
    Full,
    /// As limited animation: how many drawings are omitted and how many frames are held; what is right for most motions where
    /// nothing is said.
    Limited {
        /// Drawings to omit.
        omit: Option<usize>,
        /// Frames to hold.
        hold: Option<usize>,
        /// What becomes of the length.
        length: Length,
    },
    /// On twos, on threes: a drawing for every so many frames.
    Every(u32),
    /// The best drawings of this number.
    Drawings(usize),
}

/// A motion that was edited.
#[derive(Debug)]
pub struct Edited {
    /// The clip before it was cut.
    pub clip: Clip,
    /// What its joints are.
    pub anatomy: Anatomy,
    /// What was done to it before it was cut, for people.
    pub notes: Vec<String>,
    /// What is shown when; `None` for a motion that was not cut.
    pub exposure: Option<Exposure>,
    /// How it was limited.
    pub cut: Option<Cut>,
    /// The best drawings, where they were asked for.
    pub drawn: Option<Drawn>,
    /// The clip's world, turned so that it stands upright and faces +z.
    pub to_model: DQuat,
    is_resampled: bool,
    /// Where the joints are: frames × joints, the file's unit; upright where a camera looks.
    positions: Vec<DVec3>,
    /// The same as it counts for what is fast and slow.
    seen: Option<Vec<DVec3>>,
}

/// Makes a clip ready and cuts it. With a camera, what is fast and slow in its picture counts.
///
/// # Errors
/// A rate or a range that the clip cannot have.
pub fn edit(
    clip: Clip,
    options: &ready::Options,
    how: How,
    camera: Option<Camera>,
) -> Result<Edited, resample::Error> {
    let Ready {
        clip,
        mut positions,
        is_resampled,
        anatomy,
        notes,
    } = ready::ready(clip, options)?;
    let to_model = carry::to_drawing(&clip, &Landmarks::of(&anatomy));
    if camera.is_some() {
        // Sums of squares do not change by a turn, so it is left out where nobody looks.
        positions
            .iter_mut()
            .for_each(|position| *position = to_model * *position);
    }
    let seen = camera.map(|camera| camera.seen(&positions));
    let mut edited = Edited {
        exposure: None,
        cut: None,
        drawn: None,
        clip,
        anatomy,
        notes,
        to_model,
        is_resampled,
        positions,
        seen,
    };
    edited.shoot(how);
    Ok(edited)
}

impl Edited {
    fn shoot(&mut self, how: How) {
        let frames = self.clip.frames();
        let joints = self.clip.skeleton.joints.len();
        self.exposure = match how {
            How::Full => None,
            How::Limited { omit, hold, length } => {
                let usual = limited::Options::usual(frames);
                let options = limited::Options {
                    omit: omit.unwrap_or(usual.omit),
                    hold: hold.unwrap_or(usual.hold),
                    length,
                };
                let cut = limited::limit(self.measured(), joints, &options);
                let exposure = cut.exposure.clone();
                self.cut = Some(cut);
                Some(exposure)
            }
            How::Every(n) => Some(limited::every(frames as u32, n)),
            How::Drawings(count) => {
                let drawn = limited::drawings(self.measured(), joints, count, limited::LONGEST);
                let exposure = drawn.exposure.clone();
                self.drawn = Some(drawn);
                Some(exposure)
            }
        };
    }

    /// Where the joints are, as it counts for what is fast and slow.
    fn measured(&self) -> &[DVec3] {
        self.seen.as_deref().unwrap_or(&self.positions)
    }

    /// How far what is shown is from the source, beside other ways to cut it.
    pub fn compared(&self) -> Option<[(Method, Error); 4]> {
        let joints = self.clip.skeleton.joints.len();
        let sheet = self.exposure.as_ref()?;
        Some(limited::compare(
            &self.positions,
            joints,
            self.height(),
            sheet,
        ))
    }

    /// How far what is shown is from the source.
    pub fn error(&self) -> Option<Error> {
        let joints = self.clip.skeleton.joints.len();
        let sheet = self.exposure.as_ref()?;
        Some(limited::error(
            &self.positions,
            joints,
            self.height(),
            sheet,
        ))
    }

    /// How high the body is in the first frame, the file's unit.
    fn height(&self) -> f64 {
        let joints = self.clip.skeleton.joints.len();
        let upright = |position: &DVec3| match self.seen {
            Some(_) => *position,
            None => self.to_model * *position,
        };
        height(self.positions.iter().take(joints).map(upright))
    }

    /// A chart of how fast the motion is, and of what was omitted and held.
    pub fn chart(&self, title: &str) -> String {
        let joints = self.clip.skeleton.joints.len();
        let full;
        let exposure = match &self.exposure {
            Some(exposure) => exposure,
            None => {
                full = limited::every(self.clip.frames() as u32, 1);
                &full
            }
        };
        let held: Vec<u32> = match &self.cut {
            Some(cut) => cut.held.iter().map(|held| held.covered).collect(),
            None => Vec::new(),
        };
        let cut = self.cut.as_ref();
        chart(&Chart {
            title,
            fps: resample::rate(self.clip.frame_time),
            speeds: &limited::speeds(self.measured(), joints),
            omitted: cut.map_or(&[], |cut| &cut.omitted),
            duplicated: cut.map_or(&[], |cut| &cut.duplicated),
            held: &held,
            exposure,
        })
    }

    /// Writes the clip as it is shown, as BVH: frames that were not resampled with the very numbers that were read.
    ///
    /// # Errors
    /// What the output answers.
    pub fn write_bvh(
        &self,
        out: &mut (impl std::io::Write + Send + ?Sized),
    ) -> std::io::Result<()> {
        let decimals = match self.is_resampled {
            true => Decimals::Six,
            false => Decimals::All,
        };
        match &self.exposure {
            Some(sheet) => bvh::write_shown(&self.clip, sheet.sources(), decimals, out),
            None => bvh::write(&self.clip, decimals, out),
        }
    }
}
