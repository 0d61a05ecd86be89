//! The pose in which a person put a figure, as copies of its parts in a pose layer.

use glam::{DAffine2, DVec2};
use typed_index_collections::{TiVec, ti_vec};

use super::{NAME, SAME, SEQUENCE_STEP, Turned, about, angle_of, order, sequences, turned_up};
use crate::bind::{Bindings, PartId};
use crate::geometry::y_up;
use crate::labels::FigurePartId;
use crate::rig::figures;
use crate::rig::rigging;
use crate::svg::Drawing;

/// A key pose that continues those of some figures.
#[derive(Debug, Clone)]
pub(crate) struct KeptPose {
    /// The root of the figure; `None` if there are several.
    pub root: Option<PartId>,
    /// When it is reached: after the last pose.
    pub seconds: f64,
    /// The parts whose pose is another one than before, in the order of the drawing, and from where each is drawn to where it is then:
    /// a turn and a shift, drawing units, y down.
    pub copies: Vec<(PartId, DAffine2)>,
}

/// The key pose of figures whose parts are turned by hand from where they are drawn, each by an angle about its joint, radians,
/// counter-clockwise. A part that is not among them is as it is drawn. Figures of which no part is turned keep their pose.
pub(crate) fn kept(drawing: &Drawing, bindings: &Bindings, turns: &[(PartId, f64)]) -> KeptPose {
    let parts_of_nodes = bindings.parts_of_nodes();
    let mut kept = KeptPose {
        root: None,
        seconds: 0.0,
        copies: Vec::new(),
    };
    let mut step = SEQUENCE_STEP;
    let mut roots = Vec::new();
    let groups = figures::find(bindings);
    let is_posed = |part: &PartId| turns.iter().any(|(turned, _)| turned == part);
    for group in groups
        .iter()
        .filter(|group| group.parts.iter().any(is_posed))
    {
        let figure = rigging::figure(drawing, bindings, &parts_of_nodes, group, |_| 0);
        let mut before: TiVec<FigurePartId, Turned> = ti_vec![Turned::default(); group.parts.len()];
        let sequences = sequences(group, &bindings.poses, &mut Vec::new());
        if let Some((_, poses)) = sequences.iter().find(|(name, _)| *name == NAME) {
            for pose in poses {
                super::advance(&mut before, group, &figure, pose, |_, _, _| {});
            }
            if let [.., last] = poses.as_slice()
                && last.seconds >= kept.seconds
            {
                let earlier = poses.iter().rev().nth(1).map_or(0.0, |pose| pose.seconds);
                kept.seconds = last.seconds;
                if last.seconds > earlier {
                    step = last.seconds - earlier;
                }
            }
        }
        let mut placed: TiVec<FigurePartId, DAffine2> =
            ti_vec![DAffine2::IDENTITY; group.parts.len()];
        for index in order(group) {
            let part = group.parts[index];
            let angle = turns.iter().find(|(turned, _)| *turned == part);
            let angle = angle.map_or(0.0, |(_, angle)| *angle);
            let above = group.parents[index].map_or(DAffine2::IDENTITY, |parent| placed[parent]);
            let joint = figure.parts[index].joint;
            let wanted = if group.is_rooted(index) {
                // Its node turns about its own middle, and nothing carries it; only a figure as a whole was moved before.
                let shift = match group.parents[index] {
                    None => before[index].shift,
                    Some(_) => DVec2::ZERO,
                };
                about(y_up(bindings.parts[part].origin), Turned { angle, shift })
            } else {
                let shift = DVec2::ZERO;
                above * about(joint, Turned { angle, shift })
            };
            let without = above * about(joint, before[index]);
            let off = angle_of(without.inverse() * wanted).abs();
            let length = joint
                .distance(figure.parts[index].tip)
                .max(f64::MIN_POSITIVE);
            let apart = wanted
                .transform_point2(joint)
                .distance(without.transform_point2(joint));
            if off > SAME || apart > SAME * length {
                kept.copies.push((part, turned_up(wanted)));
            }
            placed[index] = wanted;
        }
        roots.push(group.root);
    }
    kept.seconds = ((kept.seconds + step) * 1000.0).round() / 1000.0;
    kept.copies
        .sort_by_key(|(part, _)| bindings.parts[*part].shape);
    if let [root] = roots.as_slice() {
        kept.root = Some(*root);
    }
    kept
}
