//! Forward kinematics: where a rig's parts are, given their rotations.

use glam::{DQuat, DVec3};
use typed_index_collections::{TiVec, ti_vec};

use super::Rig;
use super::rotations::Rotations;
use crate::labels::FigurePartId;
use crate::mocap::Transform;

/// The parts' nodes in one pose, with the root part's node at the origin.
pub(super) struct ForwardKinematics {
    pub(super) transforms: TiVec<FigurePartId, Transform>,
    /// Per part the position of its joint, in its parent's frame and in its own.
    joints: TiVec<FigurePartId, [DVec3; 2]>,
}

impl ForwardKinematics {
    pub(super) fn new(rig: &Rig) -> Self {
        let joints = rig.parts.iter().map(|part| {
            let above = part
                .parent
                .map(|parent| rig.parts[parent].node.to_local(part.joint));
            [above.unwrap_or_default(), part.node.to_local(part.joint)]
        });
        let identity = Transform {
            rotation: DQuat::IDENTITY,
            position: DVec3::ZERO,
        };
        Self {
            transforms: ti_vec![identity; rig.parts.len()],
            joints: joints.collect(),
        }
    }

    pub(super) fn pose(
        &mut self,
        rig: &Rig,
        rotations: &Rotations,
        order: &[FigurePartId],
        frame: usize,
    ) {
        for part in order.iter().copied() {
            let rotation = rotations.at(part, frame);
            let parent = rig.parts[part].parent;
            let parent = parent.map(|parent| self.transforms[parent]);
            self.transforms[part] = self.placed(part, rotation, parent);
        }
    }

    /// A part with this rotation, on its parent.
    pub(super) fn placed(
        &self,
        part: FigurePartId,
        rotation: DQuat,
        parent: Option<Transform>,
    ) -> Transform {
        let [above, own] = self.joints[part];
        let position = match parent {
            Some(parent) => parent.rotation * above + parent.position - rotation * own,
            None => DVec3::ZERO,
        };
        Transform { rotation, position }
    }

    /// The height of the lowest point of a part's surface.
    pub(super) fn lowest(&self, rig: &Rig, part: FigurePartId) -> f64 {
        let heights = self.surface(rig, part).map(|point| point.y);
        heights.fold(f64::INFINITY, f64::min)
    }

    /// The points of a part's surface.
    pub(super) fn surface<'a>(
        &self,
        rig: &'a Rig,
        part: FigurePartId,
    ) -> impl Iterator<Item = DVec3> + use<'a> {
        let own = &rig.parts[part];
        let placed = self.transforms[part];
        let surface = own.surface.iter();
        surface.map(move |point| placed.apply(own.node.to_local(*point)))
    }
}
