//! Keeps poses: pose layers with clones of the parts that are posed otherwise than before.

use std::collections::BTreeMap;

use glam::DAffine2;
use serde::{Deserialize, Serialize};

use super::{Analysis, Refusal};
use crate::bind::PartId;
use crate::diagnostic::Edit;
use crate::lang::keyword::Keyword;
use crate::lang::quoting::{NamePlace, quoted_if_needed};
use crate::math;
use crate::rig;
use crate::source::{Span, end_of_tag, escape_xml};
use crate::svg::{self, Element, GroupId, GroupKind, ShapeId};

/// A part that is turned by hand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartTurn {
    /// The part.
    pub part: String,
    /// By how much it is turned about its joint from how it is drawn, degrees, counter-clockwise as the drawing is seen.
    pub degrees: f64,
}

impl PartTurn {
    fn radians(&self) -> Result<f64, Refusal> {
        let Self { part, degrees } = self;
        match degrees.is_finite() {
            true => Ok(degrees.to_radians()),
            false => Err(Refusal::new(format!(
                "`{part}` is turned by no number of degrees"
            ))),
        }
    }
}

/// A moment of a recorded movement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// When it is, since the movement began.
    pub seconds: f64,
    /// The parts that are turned; all others are as in the moment before, and in the first one as they are drawn.
    pub turns: Vec<PartTurn>,
}

/// How much of the layer is seen where drawings are shown: like on a light table.
const OPACITY: f64 = 0.3;
/// The longest movement, in seconds.
const LONGEST: f64 = 120.0;

impl Analysis {
    /// Adds a key pose after the last one, behind everything else in the file.
    pub(super) fn keep_pose(&self, turns: &[PartTurn]) -> Result<Vec<Edit>, Refusal> {
        let turned = turns
            .iter()
            .map(|turn| Ok((self.node_to_change(&turn.part)?, turn.radians()?)))
            .collect::<Result<Vec<_>, Refusal>>()?;
        let parts: Vec<PartId> = turned.iter().map(|(part, _)| *part).collect();
        let mut poses = rig::KeptPoses::of(self.drawing(), self.bindings(), &parts);
        let copies = poses.go_on(&turned);
        if copies.is_empty() {
            return Err(Refusal::new(
                "no part is posed otherwise than in the pose before, or, without one, than it is drawn",
            ));
        }
        let seconds = poses.last.unwrap_or_default() + poses.step;
        self.add_poses(&poses, &[(seconds, copies)])
    }

    /// Adds the key poses of a movement after the last one: few, between which it goes as it was recorded.
    pub(super) fn keep_movement(&self, moments: &[Moment]) -> Result<Vec<Edit>, Refusal> {
        let mut parts: Vec<PartId> = Vec::new();
        let mut frames: Vec<usize> = Vec::new();
        let mut tracks: Vec<Vec<f64>> = Vec::new();
        let mut places: BTreeMap<&str, usize> = BTreeMap::new();
        for Moment { seconds, turns } in moments {
            if !(0.0..=LONGEST).contains(seconds) {
                return Err(Refusal::new(format!(
                    "a movement lasts from 0 to {LONGEST} seconds, and a moment of this one is at {seconds}"
                )));
            }
            let frame = (seconds * rig::KeptPoses::FRAME_RATE).round() as usize;
            match frames.last() {
                Some(last) if *last > frame => {
                    return Err(Refusal::new(format!(
                        "the moments of the movement are not in order: {seconds} seconds come after a later one"
                    )));
                }
                Some(last) if *last == frame => {}
                _ => {
                    frames.push(frame);
                    for track in &mut tracks {
                        track.push(track.last().copied().unwrap_or_default());
                    }
                }
            }
            for turn in turns {
                let place = match places.get(turn.part.as_str()) {
                    Some(place) => *place,
                    None => {
                        parts.push(self.node_to_change(&turn.part)?);
                        tracks.push(vec![0.0; frames.len()]);
                        places.insert(&turn.part, tracks.len() - 1);
                        tracks.len() - 1
                    }
                };
                if let Some(now) = tracks[place].last_mut() {
                    *now = turn.radians()?;
                }
            }
        }
        let still = || {
            Refusal::new("no part of the movement is posed otherwise than in the pose before it")
        };
        if frames.is_empty() {
            return Err(still());
        }
        let turns = |moment: usize| -> Vec<(PartId, f64)> {
            let angles = tracks.iter().map(|track| track[moment]);
            parts.iter().copied().zip(angles).collect()
        };
        let mut poses = rig::KeptPoses::of(self.drawing(), self.bindings(), &parts);
        let first = poses.go_on(&turns(0));
        let mut moves = !first.is_empty();
        // The clip ends in the pose in which the movement begins, or goes there first.
        let begin = match poses.last {
            Some(last) if moves => last + poses.step,
            last => last.unwrap_or_default(),
        };
        let mut layers = Vec::new();
        if moves {
            layers.push((begin, poses.with_those_that_wait(first)));
        }
        let before: Vec<_> = parts
            .iter()
            .map(|part| poses.key_before(*part, begin))
            .collect();
        for moment in rig::key_moments(&frames, &tracks, &before)
            .into_iter()
            .skip(1)
        {
            let copies = poses.go_on(&turns(moment));
            moves |= !copies.is_empty();
            let since = (frames[moment] - frames[0]) as f64 / rig::KeptPoses::FRAME_RATE;
            layers.push((begin + since, poses.with_those_that_wait(copies)));
        }
        if !moves {
            return Err(still());
        }
        self.add_poses(&poses, &layers)
    }

    /// Adds layers of poses with their seconds behind everything else in the file.
    fn add_poses(
        &self,
        poses: &rig::KeptPoses<'_>,
        layers: &[(f64, rig::Copies)],
    ) -> Result<Vec<Edit>, Refusal> {
        let Some(end) = self.source.rfind("</") else {
            return Err(Refusal::new(
                "the drawing has no end to which a layer could be added",
            ));
        };
        let (bindings, drawing) = (self.bindings(), self.drawing());
        let root = &drawing.groups[GroupId::ROOT].element;
        let prefix = self.source[root.span.start + 1..root.span.end].strip_suffix("svg");
        let prefix = prefix.unwrap_or_default();
        let link = match self.source.contains("xmlns:xlink=") {
            true => "xlink:href",
            false => "href",
        };
        let is_layered = self.source.contains("xmlns:inkscape=");
        let whose = poses
            .root()
            .map(|root| bindings.parts[root].name.as_str())
            .map(|name| quoted_if_needed(name, NamePlace::Head));
        let mut edits = Vec::new();
        let mut ids = Ids::new(self);
        // What draws each part: its elements' ids, and where their tags begin.
        let mut drawn: BTreeMap<PartId, Vec<(usize, String)>> = BTreeMap::new();
        for (part, _) in layers.iter().flat_map(|(_, copies)| copies) {
            if !drawn.contains_key(part) {
                let name = &bindings.parts[*part].name;
                let elements = self.drawn_as(*part).into_iter().map(|element| {
                    let id = ids.of(element, name, &mut edits)?;
                    Ok((element.span.start, id))
                });
                drawn.insert(*part, elements.collect::<Result<_, Refusal>>()?);
            }
        }
        let starts: Vec<usize> = drawn.values().flatten().map(|(start, _)| *start).collect();
        let around = svg::transforms_around(&self.source, &starts);
        let around: BTreeMap<usize, DAffine2> = starts
            .into_iter()
            .zip(around)
            .map(|(start, around)| (start, around.unwrap_or_default()))
            .collect();
        let mut text = String::new();
        for (seconds, copies) in layers {
            let seconds = (seconds * 1000.0).round() / 1000.0;
            let name = format!("{} {seconds}", Keyword::Pose.name());
            let layer = match is_layered {
                true => format!(" inkscape:groupmode=\"layer\" inkscape:label=\"{name}\""),
                false => String::new(),
            };
            let id = ids.free("pose");
            let string = escape_xml(&format!("{}${name}", whose.as_deref().unwrap_or_default()));
            text.push_str(&format!(
                "  <{prefix}g id=\"{id}\"{layer} style=\"opacity:{OPACITY}\">\n    <{prefix}desc>{string}</{prefix}desc>\n"
            ));
            for (part, moved) in copies {
                for (start, id) in &drawn[part] {
                    let transform = written(*moved, around[start]);
                    let (id, own) = (escape_xml(id), ids.free("copy"));
                    text.push_str(&format!(
                        "    <{prefix}use id=\"{own}\" {link}=\"#{id}\"{transform} />\n"
                    ));
                }
            }
            text.push_str(&format!("  </{prefix}g>\n"));
        }
        edits.push(Edit {
            span: Span::at(end),
            text,
        });
        Ok(edits)
    }

    /// The elements that draw a part, in paint order: its group, if that holds nothing else, and shapes outside of it.
    pub(super) fn drawn_as(&self, part: PartId) -> Vec<&Element> {
        let (bindings, drawing) = (self.bindings(), self.drawing());
        let own = bindings
            .parts
            .iter()
            .filter(|other| other.main == part && other.kind.is_solid());
        let mut own: Vec<ShapeId> = own.map(|part| part.shape).collect();
        own.sort_unstable();
        own.dedup();
        let above = |shape: ShapeId| {
            std::iter::successors(Some(drawing.shapes[shape].group), |inner| {
                Some(drawing.groups[*inner].parent).filter(|outer| outer != inner)
            })
        };
        let is_its_own = |group: &GroupId| {
            let is_group = drawing.groups[*group].kind == GroupKind::Group;
            let mut others = drawing.shapes.keys();
            is_group
                && others
                    .all(|shape| own.contains(&shape) || above(shape).all(|outer| outer != *group))
        };
        let main = bindings.parts[part].shape;
        let group = above(main).take_while(is_its_own).last();
        let mut elements: Vec<&Element> = Vec::new();
        for shape in &own {
            let in_group = group.filter(|group| above(*shape).any(|outer| outer == *group));
            let element = match in_group {
                Some(group) => &drawing.groups[group].element,
                None => &drawing.shapes[*shape].element,
            };
            // Clones of groups hold several shapes.
            if !elements.iter().any(|known| known.span == element.span) {
                elements.push(element);
            }
        }
        elements
    }
}

/// The ids of elements, and new ones for those that have none.
pub(super) struct Ids<'a> {
    source: &'a str,
    given: Vec<(usize, String)>,
    /// The last number of each word.
    numbers: BTreeMap<String, usize>,
}

impl<'a> Ids<'a> {
    pub(super) fn new(analysis: &'a Analysis) -> Self {
        Self {
            source: &analysis.source,
            given: Vec::new(),
            numbers: BTreeMap::new(),
        }
    }

    /// An id that nothing has: a word with a number.
    pub(super) fn free(&mut self, word: &str) -> String {
        let number = self.numbers.entry(word.to_owned()).or_default();
        loop {
            *number += 1;
            let id = format!("{word}-{number}");
            let is_used = ['"', '\'']
                .iter()
                .any(|quote| self.source.contains(&format!("{quote}{id}{quote}")));
            if !is_used {
                return id;
            }
        }
    }

    /// The id of an element; an element without one gets one.
    fn of(
        &mut self,
        element: &Element,
        name: &str,
        edits: &mut Vec<Edit>,
    ) -> Result<String, Refusal> {
        if let Some(id) = &element.id {
            return Ok(id.clone());
        }
        let start = element.span.start;
        if let Some((_, id)) = self.given.iter().find(|(known, _)| *known == start) {
            return Ok(id.clone());
        }
        let end = end_of_tag(self.source, start).unwrap_or(element.span.end);
        let tag = &self.source[element.span.end..end];
        let mut attributes = tag.split_whitespace();
        if attributes.any(|attribute| attribute.starts_with("id=")) {
            return Err(Refusal::new(format!(
                "`{name}` has the id of another shape: open the drawing in Inkscape and save it, which gives each its own"
            )));
        }
        let id = self.free("part");
        edits.push(Edit {
            span: Span::at(element.span.end),
            text: format!(" id=\"{id}\""),
        });
        self.given.push((start, id.clone()));
        Ok(id)
    }
}

/// The attribute that moves a clone in an untransformed layer, given the transform around what it clones.
fn written(moved: DAffine2, around: DAffine2) -> String {
    let whole = moved * around;
    if whole.abs_diff_eq(DAffine2::IDENTITY, 1e-9) {
        return String::new();
    }
    let round = |value: f64| {
        let value = (value * 1e6).round() / 1e6;
        // Without a sign before 0.
        value + 0.0
    };
    let angle = math::atan2(moved.matrix2.x_axis.y, moved.matrix2.x_axis.x);
    if around.abs_diff_eq(DAffine2::IDENTITY, 1e-9) && angle.abs() > 1e-3 {
        // A turn about the point that stays: half of the shift, and across it by the cotangent of half of the angle.
        let shift = moved.translation;
        let center = (shift + shift.perp() / math::tan(angle / 2.0)) / 2.0;
        let values = [angle.to_degrees(), center.x, center.y].map(round);
        return format!(
            " transform=\"rotate({},{},{})\"",
            values[0], values[1], values[2]
        );
    }
    let [a, b, c, d, e, f] = whole.to_cols_array().map(round);
    format!(" transform=\"matrix({a},{b},{c},{d},{e},{f})\"")
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    #[test]
    fn turns_are_written_about_the_point_that_stays() {
        let joint = DVec2::new(120.5, 80.25);
        for degrees in [-170.0, -30.0, 5.0, 90.0_f64] {
            let moved = DAffine2::from_translation(joint)
                * DAffine2::from_angle(degrees.to_radians())
                * DAffine2::from_translation(-joint);
            let wanted = format!(" transform=\"rotate({degrees},120.5,80.25)\"");
            assert_eq!(written(moved, DAffine2::IDENTITY), wanted);
        }
        let shift = DAffine2::from_translation(DVec2::new(3.0, -4.0));
        assert_eq!(
            written(shift, DAffine2::IDENTITY),
            " transform=\"matrix(1,0,0,1,3,-4)\""
        );
        assert_eq!(written(DAffine2::IDENTITY, DAffine2::IDENTITY), "");
    }
}
