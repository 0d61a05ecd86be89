//! Measures models in their rest pose.

use glam::{DVec3, Mat3, Vec3};
use rayon::prelude::*;
use typed_index_collections::{TiVec, ti_vec};

use super::check;
use crate::scene::{MeshId, Primitive, RigidTransform, Scene, Size};

/// The box along the axes of the world that holds surfaces, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extent {
    low: DVec3,
    high: DVec3,
}

impl Default for Extent {
    /// Of nothing.
    fn default() -> Self {
        Self {
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
        }
    }
}

impl Extent {
    /// Both together.
    pub(super) fn join(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Adds points of a node's frame, whose bounding box is known.
    pub(super) fn add(
        &mut self,
        points: &[[f32; 3]],
        bounds: [[f32; 3]; 2],
        pose: &RigidTransform,
    ) {
        let turn = Mat3::from_quat(pose.rotation.as_quat());
        let placed = |[low, high]: [Vec3; 2]| Self {
            low: low.as_dvec3() + pose.translation,
            high: high.as_dvec3() + pose.translation,
        };
        let bounds = bounds.map(Vec3::from);
        // The box of the turned box may be too large. Where that changes nothing, no point has to be turned.
        let half = (bounds[1] - bounds[0]) / 2.0;
        let middle = turn * (bounds[0] + half);
        let reach =
            turn.x_axis.abs() * half.x + turn.y_axis.abs() * half.y + turn.z_axis.abs() * half.z;
        let roughly = placed([middle - reach, middle + reach]);
        if turn == Mat3::IDENTITY {
            *self = self.join(placed(bounds));
        } else if self.join(roughly) != *self {
            let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            let turned = points.iter().fold(none, |[low, high], point| {
                let point = turn * Vec3::from(*point);
                [low.min(point), high.max(point)]
            });
            *self = self.join(placed(turned));
        }
    }

    /// `None` of nothing.
    pub(super) fn size(&self) -> Option<Size> {
        let is_something = self.low.cmple(self.high).all();
        is_something.then(|| Size::of(self.high - self.low))
    }
}

/// All primitives in the order of the meshes, each with the places at which its mesh is in the rest pose.
pub(super) struct Placed<'a> {
    pub(super) primitives: Vec<(&'a Primitive, MeshId)>,
    poses: TiVec<MeshId, Vec<RigidTransform>>,
    /// Per mesh how many joints can move its corners.
    joints: TiVec<MeshId, usize>,
}

impl<'a> Placed<'a> {
    pub(super) fn of(scene: &'a Scene) -> Self {
        let mut poses: TiVec<MeshId, Vec<RigidTransform>> = ti_vec![vec![]; scene.meshes.len()];
        let mut joints: TiVec<MeshId, usize> = ti_vec![0; scene.meshes.len()];
        for (node, pose) in scene.nodes.iter().zip(scene.rest()) {
            if let Some(mesh) = node.mesh {
                poses[mesh].push(pose);
                joints[mesh] = 1 + node.bones.len();
            }
        }
        if let Some(skin) = &scene.skin {
            poses[skin.mesh].push(RigidTransform::IDENTITY);
            joints[skin.mesh] = skin.joints.len();
        }
        let meshes = scene.meshes.iter_enumerated();
        let primitives = meshes
            .flat_map(|(id, mesh)| mesh.primitives.iter().map(move |primitive| (primitive, id)));
        Self {
            primitives: primitives.collect(),
            poses,
            joints,
        }
    }

    /// How many joints can move the corners of a mesh.
    pub(super) fn joints(&self, mesh: MeshId) -> usize {
        self.joints[mesh]
    }

    /// Where a mesh is.
    pub(super) fn poses(&self, mesh: MeshId) -> &[RigidTransform] {
        &self.poses[mesh]
    }
}

/// The size of a scene; its surfaces are made, and not kept.
pub(super) fn measured(scene: &Scene) -> std::io::Result<Option<Size>> {
    let placed = Placed::of(scene);
    let of_primitive = |(primitive, mesh): &(&Primitive, MeshId)| -> std::io::Result<Extent> {
        let surface = primitive.surface();
        let mut extent = Extent::default();
        if !surface.triangles.is_empty() {
            let bounds = check::surface(&surface, placed.joints(*mesh))?;
            for pose in placed.poses(*mesh) {
                extent.add(&surface.positions, bounds, pose);
            }
        }
        Ok(extent)
    };
    let extents = placed.primitives.par_iter().map(of_primitive);
    let whole = extents.try_reduce(Extent::default, |a, b| Ok(a.join(b)))?;
    Ok(whole.size())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn turned_points_are_measured_exactly() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..50 {
            let mut whole = Extent::default();
            let mut points = vec![];
            for _ in 0..8 {
                let local: Vec<[f32; 3]> = (0..5)
                    .map(|_| [(); 3].map(|()| random.f32() - 0.5))
                    .collect();
                let pose = RigidTransform {
                    rotation: DQuat::from_rotation_z(random.f64() * 6.0),
                    translation: DVec3::new(random.f64(), random.f64(), random.f64()),
                };
                let bounds = check::bounds(&local).unwrap();
                whole.add(&local, bounds, &pose);
                let place = |point: &[f32; 3]| {
                    pose.rotation * Vec3::from(*point).as_dvec3() + pose.translation
                };
                points.extend(local.iter().map(place));
            }
            let low = points.iter().copied().reduce(DVec3::min).unwrap();
            let high = points.iter().copied().reduce(DVec3::max).unwrap();
            assert!((whole.low - low).length() + (whole.high - high).length() < 1e-5);
        }
    }

    #[test]
    fn nothing_has_no_size() {
        assert_eq!(Extent::default().size(), None);
    }
}
