//! Edits a motion by itself: prepares it, limits it, and compares the ways to limit it.

use glam::{DQuat, DVec3};

use crate::labels::{Anatomy, Facing};
use crate::limited::Measured;
use crate::limited::{self, BestDrawings, Camera, Cut, Error, Exposure, Length, Method, Poses};
use crate::mocap::bvh::{self, Decimals};
use crate::mocap::resample;
use crate::mocap::travel::Ending;
use crate::mocap::{Clip, JointId, height};
use crate::motion::{Chart, PointChoice, chart};
use crate::performance::{self, Filming};
use crate::prepare::{Cycle, PreparedClip};
use crate::retarget;

/// How a motion is thinned out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum ExposureMethod {
    /// Not at all.
    #[default]
    Full,
    /// As limited animation; `None` stands for the defaults of [`limited::Options`].
    Limited {
        /// Drawings to omit.
        omit: Option<usize>,
        /// Frames to hold.
        hold: Option<usize>,
        /// Whether the clip keeps its length.
        length: Length,
    },
    /// On twos, on threes: one drawing for each of this many frames.
    Every(u32),
    /// The best drawings, this many.
    Drawings(usize),
}

/// How a motion is edited.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Options {
    /// How it is thinned out.
    pub method: ExposureMethod,
    /// Where its speed is measured.
    pub points: PointChoice,
    /// In whose picture its speed is measured; `None` for space.
    pub camera: Option<Camera>,
    /// The frame that stays, whatever is thinned out: the key of a performance.
    pub key: Option<usize>,
}

/// An edited motion.
#[derive(Debug)]
pub struct EditedClip {
    /// The prepared clip, with all its frames.
    pub clip: Clip,
    /// What its joints are.
    pub anatomy: Anatomy,
    /// What was done to prepare it, for people to read.
    pub notes: Vec<String>,
    /// Which source frame each frame shows; `None` for a motion that was not thinned out.
    pub exposure: Option<Exposure>,
    /// The omissions and holds of limited animation.
    pub cut: Option<Cut>,
    /// The best drawings, if they were requested.
    pub best_drawings: Option<BestDrawings>,
    /// Rotates the clip's world so that it stands upright and faces +z.
    pub to_model: DQuat,
    /// The cycle that was made a loop.
    pub cycle: Option<Cycle>,
    /// The joint that a camera follows.
    pub filmed_joint: Option<JointId>,
    is_changed: bool,
    /// Where speed is measured, in the file's unit; upright if there is a camera.
    measured: Measured,
    /// The same points in the camera's picture, where speed is measured then.
    projected: Option<Vec<DVec3>>,
    /// The frame that stays.
    key: Option<usize>,
    /// Whether it ends in the pose in which it begins.
    is_loop: bool,
    /// The height of the body in the first frame, in the file's unit.
    height: f64,
}

/// Thins a prepared clip out.
pub fn edit(prepared: PreparedClip, options: &Options) -> EditedClip {
    let Options {
        method,
        points,
        camera,
        key,
    } = *options;
    let to_model = retarget::to_drawing(&prepared.clip, &prepared.landmarks(), Facing::Viewer);
    let PreparedClip {
        clip,
        positions,
        is_changed,
        anatomy,
        notes,
        cycle,
        ending,
        ..
    } = prepared;
    let first = positions.iter().take(clip.skeleton.joints.len());
    let height = height(first.map(|position| to_model * *position));
    let mut measured = Measured::of_clip(&clip, &positions, &anatomy, points);
    if camera.is_some() {
        // A rotation does not change sums of squares, so only a camera needs upright points.
        let points = measured.points.iter_mut();
        points.for_each(|point| *point = to_model * *point);
    }
    let projected = camera.map(|camera| camera.project(&measured.points));
    let mut edited = EditedClip {
        exposure: None,
        cut: None,
        best_drawings: None,
        clip,
        anatomy,
        notes,
        to_model,
        is_changed,
        cycle,
        filmed_joint: None,
        measured,
        projected,
        key,
        is_loop: ending == Ending::Loop,
        height,
    };
    edited.expose(method);
    edited
}

/// How an edited motion is filmed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Film {
    /// Whether a camera moves, or the character.
    pub filming: Filming,
    /// The joint in the middle of the picture.
    pub joint: JointId,
}

/// Whether a motion could be filmed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filmed {
    /// It is filmed.
    Filmed,
    /// The character cannot be moved, because its root has no position.
    NotMoved,
}

impl EditedClip {
    /// Films what is shown. A camera is only noted, for models; moving the character changes the clip, which then has exactly the
    /// frames that are shown.
    pub fn film(&mut self, film: Film) -> Filmed {
        match film.filming {
            Filming::None => {}
            Filming::Camera => self.filmed_joint = Some(film.joint),
            Filming::Character => return self.move_character(film.joint),
        }
        Filmed::Filmed
    }

    fn move_character(&mut self, joint: JointId) -> Filmed {
        let shown = Exposure::shown(self.exposure.as_ref(), self.clip.frames);
        let upright = |at: &DVec3| self.to_model * *at;
        let points: Vec<DVec3> = self.clip.positions().iter().map(upright).collect();
        let per_frame = self.clip.skeleton.joints.len();
        let filmed =
            performance::Filmed::new(Filming::Character, &points, per_frame, &shown, joint.into());
        let back = self.to_model.inverse();
        let shifts = filmed.shifts().unwrap_or_default();
        let shifts: Vec<DVec3> = shifts.iter().map(|shift| back * *shift).collect();
        let Some(moved) = self.clip.select_frames(shown).moved(&shifts) else {
            return Filmed::NotMoved;
        };
        self.exposure = self
            .exposure
            .as_ref()
            .map(|sheet| limited::every(sheet.len() as u32, 1));
        self.clip = moved;
        self.is_changed = true;
        Filmed::Filmed
    }

    fn expose(&mut self, method: ExposureMethod) {
        let frames = self.seen().count();
        self.exposure = match method {
            ExposureMethod::Full => None,
            ExposureMethod::Limited { omit, hold, length } => {
                let usual = limited::Options::recommended(frames);
                let options = limited::Options {
                    omit: omit.unwrap_or(usual.omit),
                    hold: hold.unwrap_or(usual.hold),
                    length,
                };
                let cut = limited::limit(self.seen(), &options);
                let exposure = cut.exposure.clone();
                self.cut = Some(cut);
                Some(exposure)
            }
            ExposureMethod::Every(n) => {
                let key = self.key.unwrap_or(0) as u32;
                Some(limited::every_through(frames as u32, n, key))
            }
            ExposureMethod::Drawings(count) => {
                let best_drawings = limited::drawings(self.seen(), count, limited::MAX_HOLD);
                let exposure = best_drawings.exposure.clone();
                self.best_drawings = Some(best_drawings);
                Some(exposure)
            }
        };
    }

    /// The poses by which speed is measured.
    fn seen(&self) -> Poses<'_> {
        let points = self.projected.as_ref().unwrap_or(&self.measured.points);
        Poses::new(points, self.measured.per_frame)
            .repeating(&self.measured.repeats)
            .keeping(self.key)
            .looping(self.is_loop)
    }

    /// The error of what is shown against the source, and those of other ways to thin it out.
    pub fn compared(&self) -> Option<[(Method, Error); 4]> {
        let exposure = self.exposure.as_ref()?;
        let poses = self.measured.poses().looping(self.is_loop);
        Some(limited::compare(poses, self.height, exposure))
    }

    /// The error of what is shown against the source.
    pub fn error(&self) -> Option<Error> {
        let exposure = self.exposure.as_ref()?;
        Some(limited::error(self.measured.poses(), self.height, exposure))
    }

    /// A chart of the motion's speed, and of what was omitted and held.
    pub fn chart(&self, title: &str) -> String {
        let full;
        let exposure = match &self.exposure {
            Some(exposure) => exposure,
            None => {
                full = limited::every(self.clip.frames as u32, 1);
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
            speeds: &self.seen().speeds(),
            omitted: cut.map_or(&[], |cut| &cut.omitted),
            duplicated: cut.map_or(&[], |cut| &cut.duplicated),
            held: &held,
            exposure,
        })
    }

    /// Writes what is shown as BVH. Frames that were not changed keep the very numbers that were read.
    ///
    /// # Errors
    /// Those of the output.
    pub fn write_bvh(
        &self,
        out: &mut (impl std::io::Write + Send + ?Sized),
    ) -> std::io::Result<()> {
        let decimals = if self.is_changed {
            Decimals::Six
        } else {
            Decimals::All
        };
        match &self.exposure {
            Some(exposure) => {
                let mut frames = exposure.sources.clone();
                // A file of rows has no key that closes a loop, only its last row.
                if self.is_loop && frames.len() < self.clip.frames {
                    frames.push(self.clip.frames as u32 - 1);
                }
                bvh::write_frames(&self.clip, &frames, decimals, out)
            }
            None => bvh::write(&self.clip, decimals, out),
        }
    }
}
