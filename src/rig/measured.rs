//! Where the speed of a figure that plays a clip is measured.

use typed_index_collections::TiVec;

use crate::labels::FigurePartId;
use crate::limited::Measured;
use crate::mocap::Transform;
use crate::retarget::{RetargetedClip, Rig};

impl Measured {
    /// A figure that plays a clip: the joints and the far ends of its driven parts, in the drawing's axes and unit.
    pub(super) fn of_figure(rig: &Rig, clip: &RetargetedClip) -> Self {
        let frames = clip.grounded.len();
        let driven = rig.parts.iter_enumerated();
        let driven: Vec<FigurePartId> = driven
            .filter(|(_, part)| part.drive.is_some())
            .map(|(index, _)| index)
            .collect();
        let mut points = Vec::with_capacity(frames * driven.len() * 2);
        let order = rig.order();
        let mut placed: TiVec<_, Transform> = rig.parts.iter().map(|part| part.node).collect();
        for frame in 0..frames {
            for index in &order {
                placed[*index] = clip.node(rig, *index, frame, &placed);
            }
            for index in &driven {
                let part = &rig.parts[*index];
                for point in [part.joint, part.tip] {
                    points.push(placed[*index].apply(part.node.to_local(point)));
                }
            }
        }
        let same = |frame: usize| {
            let turns = clip.rotations.iter().flatten();
            let moves = clip.translations.iter().flatten();
            frame > 0
                && turns.clone().all(|turns| turns[frame] == turns[frame - 1])
                && moves.clone().all(|moves| moves[frame] == moves[frame - 1])
        };
        Self {
            points,
            per_frame: driven.len() * 2,
            repeats: (0..frames).map(same).collect(),
        }
    }
}
