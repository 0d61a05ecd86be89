//! Poses in which a person put figures, as copies of their parts in pose layers.

use std::f64::consts::{PI, TAU};

use glam::{DAffine2, DVec2};
use typed_index_collections::{TiVec, ti_vec};

use super::{
    KeyBefore, NAME, SAME, SEQUENCE_STEP, Turned, about, angle_of, order, sequences, turned_up,
};
use crate::bind::{Bindings, PartId};
use crate::geometry::y_up;
use crate::labels::{Figure, FigurePartId};
use crate::mocap::resample::FPS;
use crate::rig::figures::{self, FigureGroup};
use crate::rig::rigging;
use crate::svg::Drawing;

/// A pose as a layer has it: the parts whose pose is another one than before, in the order of the drawing, and from where each is drawn to
/// where it is then: a turn and a shift, drawing units, y down.
pub(crate) type Copies = Vec<(PartId, DAffine2)>;

/// Figures that are posed, as they are after their last key pose.
pub(crate) struct KeptPoses<'a> {
    bindings: &'a Bindings,
    figures: Vec<KeptFigure>,
    /// When the last key pose is reached; `None` without one.
    pub last: Option<f64>,
    /// How long after it the next one is.
    pub step: f64,
}

struct KeptFigure {
    group: FigureGroup,
    figure: Figure,
    now: TiVec<FigurePartId, Turned>,
    /// The last key poses that it had when it was read, two of them at most: their seconds, and the parts' turns.
    last: Vec<(f64, TiVec<FigurePartId, Turned>)>,
}

impl<'a> KeptPoses<'a> {
    /// The frames a second of clips.
    pub(crate) const FRAME_RATE: f64 = FPS;

    /// The figures of some parts.
    pub(crate) fn of(drawing: &Drawing, bindings: &'a Bindings, parts: &[PartId]) -> Self {
        let parts_of_nodes = bindings.parts_of_nodes();
        let mut kept = Self {
            bindings,
            figures: Vec::new(),
            last: None,
            step: SEQUENCE_STEP,
        };
        let groups = figures::find(bindings).into_iter();
        for group in groups.filter(|group| group.parts.iter().any(|part| parts.contains(part))) {
            let figure = rigging::figure(drawing, bindings, &parts_of_nodes, &group, |_| 0);
            let mut now = ti_vec![Turned::default(); group.parts.len()];
            // A clip begins as the figure is drawn.
            let mut latest = vec![(0.0, now.clone())];
            let sequences = sequences(&group, &bindings.poses, &mut Vec::new());
            if let Some((_, poses)) = sequences.iter().find(|(name, _)| *name == NAME) {
                for pose in poses {
                    super::advance(&mut now, &group, &figure, pose, |_, _, _| {});
                    if latest.len() == 2 {
                        latest.remove(0);
                    }
                    latest.push((pose.seconds, now.clone()));
                }
                if let [.., last] = poses.as_slice()
                    && kept.last.is_none_or(|latest| last.seconds >= latest)
                {
                    let earlier = poses.iter().rev().nth(1).map_or(0.0, |pose| pose.seconds);
                    kept.last = Some(last.seconds);
                    if last.seconds > earlier {
                        kept.step = last.seconds - earlier;
                    }
                }
            }
            kept.figures.push(KeptFigure {
                group,
                figure,
                now,
                last: latest,
            });
        }
        kept
    }

    /// The root of the figure; `None` if there are several.
    pub(crate) fn root(&self) -> Option<PartId> {
        match self.figures.as_slice() {
            [figure] => Some(figure.group.root),
            _ => None,
        }
    }

    /// The last key pose of a part that was there before, earlier than a second; `None` without one.
    pub(crate) fn key_before(&self, part: PartId, seconds: f64) -> Option<KeyBefore> {
        let mut figures = self.figures.iter();
        let found = figures.find(|figure| figure.group.parts.contains(&part))?;
        let (index, _) = found
            .group
            .parts
            .iter_enumerated()
            .find(|(_, own)| **own == part)?;
        let frames = |earlier: f64| ((seconds - earlier) * Self::FRAME_RATE).round();
        let earlier = found
            .last
            .iter()
            .rfind(|(earlier, _)| frames(*earlier) >= 1.0)?;
        Some(KeyBefore {
            frames: frames(earlier.0) as usize,
            angle: earlier.1[index].angle,
        })
    }

    /// Goes on to a pose in which parts are turned by hand from where they are drawn, each by an angle about its joint, radians,
    /// counter-clockwise. A part that is not among them is as it is drawn.
    pub(crate) fn go_on(&mut self, turns: &[(PartId, f64)]) -> Copies {
        let mut copies = Vec::new();
        for figure in &mut self.figures {
            figure.go_on(self.bindings, turns, &mut copies);
        }
        copies.sort_by_key(|(part, _)| self.bindings.parts[*part].shape);
        copies
    }

    /// Adds a copy of figures that stay as they are: a layer without one is no pose of theirs, and they would be on their way to the next.
    pub(crate) fn with_those_that_wait(&self, mut copies: Copies) -> Copies {
        for KeptFigure {
            group, figure, now, ..
        } in &self.figures
        {
            if copies.iter().any(|(part, _)| group.parts.contains(part)) {
                continue;
            }
            if let Some(&first) = order(group).first() {
                let placed = about(figure.parts[first].joint, now[first]);
                copies.push((group.parts[first], turned_up(placed)));
            }
        }
        copies.sort_by_key(|(part, _)| self.bindings.parts[*part].shape);
        copies
    }
}

impl KeptFigure {
    fn go_on(&mut self, bindings: &Bindings, turns: &[(PartId, f64)], copies: &mut Copies) {
        let Self {
            group, figure, now, ..
        } = self;
        let mut placed: TiVec<FigurePartId, DAffine2> =
            ti_vec![DAffine2::IDENTITY; group.parts.len()];
        for index in order(group) {
            let part = group.parts[index];
            let angle = turns.iter().find(|(turned, _)| *turned == part);
            let angle = angle.map_or(0.0, |(_, angle)| *angle);
            let above = group.parents[index].map_or(DAffine2::IDENTITY, |parent| placed[parent]);
            let joint = figure.parts[index].joint;
            let is_rooted = group.is_rooted(index);
            let wanted = if is_rooted {
                // Its node turns about its own middle, and nothing carries it; only a figure as a whole was moved before.
                let shift = match group.parents[index] {
                    None => now[index].shift,
                    Some(_) => DVec2::ZERO,
                };
                about(y_up(bindings.parts[part].origin), Turned { angle, shift })
            } else {
                let shift = DVec2::ZERO;
                above * about(joint, Turned { angle, shift })
            };
            let without = above * about(joint, now[index]);
            let off = angle_of(without.inverse() * wanted).abs();
            let length = joint
                .distance(figure.parts[index].tip)
                .max(f64::MIN_POSITIVE);
            let apart = wanted
                .transform_point2(joint)
                .distance(without.transform_point2(joint));
            if off > SAME || apart > SAME * length {
                copies.push((part, turned_up(wanted)));
                let relative = above.inverse() * wanted;
                let before = now[index].angle;
                now[index] = Turned {
                    angle: before + (angle_of(relative) - before + PI).rem_euclid(TAU) - PI,
                    shift: match is_rooted {
                        true => relative.transform_point2(joint) - joint,
                        false => DVec2::ZERO,
                    },
                };
            }
            placed[index] = wanted;
        }
    }
}
