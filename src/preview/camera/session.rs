//! One page that records: its marks, and what is known about them.

use glam::DVec2;
use thiserror::Error;

use super::frame::{FrameError, Picture};
use super::message::{FromCamera, MarkFacts, ToCamera};
use crate::mark_tracks::{MAX_NAME, MarkId, MarkTracks, hex, is_name};
use crate::tracking::{Follower, Learned, Learner, Mark, Sighting, Tracker, hue_name};

/// The most marks.
const MAX_MARKS: usize = 8;
/// The most frames of a recording: 30 seconds at 30 frames per second, and some more. They are held in memory.
const MAX_FRAMES: usize = 1000;
/// Two frames are at least so many milliseconds apart.
const MIN_INTERVAL: f64 = 1.0;
/// Whoever points at a colour whose hue is so near to that of a mark, in degrees, means this mark.
const SAME_HUE: f64 = 15.0;
/// Why a message is refused.
#[derive(Debug, Error)]
pub(super) enum Refusal {
    #[error(transparent)]
    Frame(#[from] FrameError),
    #[error("frame {0} does not follow the last one")]
    Order(u32),
    #[error("the size of the camera's pictures changed during the recording")]
    Size,
    #[error("the recording is full")]
    Full,
    #[error("there is no picture yet")]
    NoPicture,
    #[error("there is no colour: choose a coloured mark, not a grey, black or white one")]
    Gray,
    #[error("the mark is too small: bring it nearer to the camera")]
    Small,
    #[error("there are {MAX_MARKS} marks already")]
    TooMany,
    #[error("there is no such mark")]
    NoMark,
    #[error("a name has letters, digits, `-` and `_`, {MAX_NAME} at most, and belongs to one mark")]
    Name,
    #[error("marks are chosen before the recording")]
    Recording,
    #[error("no marks are chosen")]
    NoMarks,
    #[error("nothing was recorded")]
    Empty,
    #[error("the mark `{0}` was not found in the recording")]
    NotFound(String),
}

/// The state of a page that records.
#[derive(Debug, Default)]
pub(super) struct Session {
    marks: Vec<Mark>,
    /// Where each mark was last, pixels.
    places: Vec<Option<DVec2>>,
    /// The picture in which each mark was chosen.
    chosen: Vec<Picture>,
    last: Option<Picture>,
    live: Option<Live>,
    recording: Option<Recording>,
    /// The track of the last recording.
    track: Option<MarkTracks>,
}

/// Marks that are tracked while frames arrive.
#[derive(Debug)]
struct Live {
    learned: Learned,
    tracker: Tracker,
}

/// Frames that are kept until the recording ends.
#[derive(Debug)]
struct Recording {
    frames: Vec<Picture>,
    /// Where the marks were before.
    start: Vec<Option<DVec2>>,
}

impl Session {
    /// Tracks the marks in the next frame.
    pub(super) fn frame(&mut self, picture: Picture) -> Result<ToCamera, Refusal> {
        if let Some(last) = &self.last {
            let is_later =
                picture.sequence > last.sequence && picture.time >= last.time + MIN_INTERVAL;
            if !is_later {
                return Err(Refusal::Order(picture.sequence));
            }
            if last.size != picture.size {
                if self.recording.take().is_some() {
                    return Err(Refusal::Size);
                }
                // A phone was turned, or the camera was changed: the marks must be chosen again.
                self.places.fill(None);
                self.live = None;
            }
        }
        if let Some(recording) = &mut self.recording {
            if recording.frames.len() >= MAX_FRAMES {
                return Err(Refusal::Full);
            }
            recording.frames.push(picture.clone());
        }
        self.last = Some(picture);
        let seen = self.track_live();
        for (place, sighting) in self.places.iter_mut().zip(&seen) {
            *place = sighting.map(|sighting| sighting.at).or(*place);
        }
        let last = self.last.as_ref();
        Ok(ToCamera::Seen {
            sequence: last.map_or(0, |last| last.sequence),
            marks: seen
                .into_iter()
                .map(|sighting| sighting.map(|Sighting { at, radius }| [at.x, at.y, radius]))
                .collect(),
            recorded: self
                .recording
                .as_ref()
                .map_or(0, |recording| recording.frames.len()),
        })
    }

    /// Finds the marks in the last frame.
    fn track_live(&mut self) -> Vec<Option<Sighting>> {
        let frame = self.last.as_ref().and_then(Picture::frame);
        match (&mut self.live, frame) {
            (Some(live), Some(frame)) => live.tracker.push(frame),
            _ => vec![None; self.marks.len()],
        }
    }

    /// Learns the marks from the pictures in which they were chosen. What stands still and looks like a mark is not known yet: that is
    /// learned from the recording.
    fn learn(&mut self) {
        self.track = None;
        self.live = None;
        let Some(last) = &self.last else { return };
        let mut learner = Learner::new(last.size, self.marks.clone());
        let mut pictures: Vec<&Picture> = self.chosen.iter().collect();
        pictures.sort_by_key(|picture| picture.sequence);
        pictures.dedup_by_key(|picture| picture.sequence);
        for frame in pictures.into_iter().filter_map(Picture::frame) {
            learner.push(frame);
        }
        if let Ok(learned) = learner.learned() {
            let tracker = started(&learned, &self.places);
            self.live = Some(Live { learned, tracker });
        }
    }

    /// Does what a message asks for.
    pub(super) fn handle(&mut self, message: FromCamera) -> Result<Vec<ToCamera>, Refusal> {
        match message {
            FromCamera::Pick { x, y } => self.pick(DVec2::new(x, y)),
            FromCamera::Name { mark, name } => self.rename(mark, name),
            FromCamera::Remove { mark } => {
                self.may_choose()?;
                if mark >= self.marks.len() {
                    return Err(Refusal::NoMark);
                }
                self.forget(mark);
                Ok(vec![self.facts()])
            }
            FromCamera::Record {} => {
                if self.marks.is_empty() {
                    return Err(Refusal::NoMarks);
                }
                self.track = None;
                self.recording = Some(Recording {
                    frames: Vec::new(),
                    start: self.places.clone(),
                });
                Ok(Vec::new())
            }
            FromCamera::Stop {} => {
                let track = self.finish()?;
                let file = track.to_json();
                self.track = Some(track);
                Ok(vec![ToCamera::Track { file }])
            }
        }
    }

    fn may_choose(&self) -> Result<(), Refusal> {
        match self.recording {
            Some(_) => Err(Refusal::Recording),
            None => Ok(()),
        }
    }

    /// Takes the colour at a place for a mark: a new one, or the one that has this hue already.
    fn pick(&mut self, at: DVec2) -> Result<Vec<ToCamera>, Refusal> {
        self.may_choose()?;
        let picture = self.last.clone().ok_or(Refusal::NoPicture)?;
        let frame = picture.frame().ok_or(Refusal::NoPicture)?;
        let size = DVec2::from_array(picture.size.map(f64::from));
        let at = at.clamp(DVec2::ZERO, size - 1.0);
        let mark = Mark::picked("", frame, at).map_err(|_| Refusal::Gray)?;
        let is_same = |other: &Mark| {
            let difference = (mark.hue - other.hue + 180.0).rem_euclid(360.0) - 180.0;
            difference.abs() < SAME_HUE
        };
        let index = self.marks.iter().position(is_same);
        let is_new = index.is_none();
        let index = index.unwrap_or(self.marks.len());
        if index >= MAX_MARKS {
            return Err(Refusal::TooMany);
        }
        let name = match self.marks.get(index) {
            Some(same) => same.name.to_owned(),
            None => self.unused_name(hue_name(mark.hue)),
        };
        let mark = Mark::new(name, mark.color).map_err(|_| Refusal::Gray)?;
        match self.marks.get_mut(index) {
            Some(same) => {
                *same = mark;
                self.places[index] = Some(at);
                self.chosen[index] = picture;
            }
            None => {
                self.marks.push(mark);
                self.places.push(Some(at));
                self.chosen.push(picture);
            }
        }
        self.learn();
        if self.live.is_none() && is_new {
            self.forget(index);
            return Err(Refusal::Small);
        }
        Ok(vec![self.facts()])
    }

    fn forget(&mut self, mark: usize) {
        self.marks.remove(mark);
        self.places.remove(mark);
        self.chosen.remove(mark);
        self.learn();
    }

    fn rename(&mut self, mark: usize, name: String) -> Result<Vec<ToCamera>, Refusal> {
        let color = self.marks.get(mark).ok_or(Refusal::NoMark)?.color;
        let mut others = self.marks.iter().enumerate();
        let is_taken = others.any(|(other, taken)| other != mark && taken.name == name);
        if is_taken || !is_name(&name) {
            return Err(Refusal::Name);
        }
        self.marks[mark] = Mark::new(name.clone(), color).map_err(|_| Refusal::Gray)?;
        let mut answers = vec![self.facts()];
        if let Some(track) = &mut self.track
            && let Some(mark) = track.marks.get_mut(MarkId::from(mark))
        {
            mark.name = name;
            answers.push(ToCamera::Track {
                file: track.to_json(),
            });
        }
        Ok(answers)
    }

    /// The track of the recording. The marks are learned from all of its frames and tracked once more: what else has their colours, and
    /// which of it could be a mark, is known only at the end.
    fn finish(&mut self) -> Result<MarkTracks, Refusal> {
        let recording = self.recording.take().ok_or(Refusal::Empty)?;
        let first = recording.frames.first().ok_or(Refusal::Empty)?;
        let mut learner = Learner::new(first.size, self.marks.clone());
        for frame in recording.frames.iter().filter_map(Picture::frame) {
            learner.push(frame);
        }
        let live = self.live.as_ref().map(|live| live.learned.clone());
        let learned = learner.learned().or_else(|error| {
            let mark = self.marks.get(error.mark);
            let name = mark.map_or("", |mark| &mark.name).to_owned();
            live.ok_or(Refusal::NotFound(name))
        })?;
        let mut follower = Follower::new(learned);
        for (mark, place) in recording.start.iter().enumerate() {
            if let Some(at) = place {
                follower.start(mark, *at);
            }
        }
        let mut times = Vec::new();
        for picture in &recording.frames {
            if let Some(frame) = picture.frame() {
                times.push((picture.time - first.time) / 1e3);
                follower.push(frame);
            }
        }
        let mut track = follower.tracks(times);
        // A mark may have been renamed since it was learned.
        for (track, mark) in track.marks.iter_mut().zip(&self.marks) {
            mark.name.clone_into(&mut track.name);
        }
        Ok(track)
    }

    /// A name that no mark has: the hue's, or with a number.
    fn unused_name(&self, hue: &str) -> String {
        let is_free = |name: &String| self.marks.iter().all(|mark| mark.name != *name);
        let numbered = (2..=MAX_MARKS + 1).map(|number| format!("{hue}{number}"));
        let mut names = std::iter::once(hue.to_owned()).chain(numbered);
        names.find(is_free).unwrap_or_else(|| hue.to_owned())
    }

    fn facts(&self) -> ToCamera {
        let facts = |mark: &Mark| MarkFacts {
            name: mark.name.to_owned(),
            color: hex(mark.color),
        };
        ToCamera::Marks {
            marks: self.marks.iter().map(facts).collect(),
        }
    }
}

/// A tracker that begins at these places.
fn started(learned: &Learned, places: &[Option<DVec2>]) -> Tracker {
    let mut tracker = Tracker::new(learned.clone());
    for (mark, place) in places.iter().enumerate() {
        if let Some(at) = place {
            tracker.start(mark, *at);
        }
    }
    tracker
}

#[cfg(test)]
mod tests;
