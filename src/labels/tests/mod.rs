//! Labels of skeletons and figures.

mod above;
mod conventions;
mod drawings;
mod facing;
pub(crate) mod figures;
mod files;
mod held;
mod programs;
mod random;

use glam::DVec3;
use typed_index_collections::TiVec;

use super::{Anatomy, Class, Side};
use crate::mocap::{Joint, JointId, Skeleton};

/// A skeleton from names, indented by a space a level. Every bone is one up.
pub(super) fn skeleton(names: &str) -> Skeleton {
    let mut joints: TiVec<JointId, Joint> = TiVec::new();
    let mut above: Vec<JointId> = Vec::new();
    for line in names.lines().filter(|line| !line.trim().is_empty()) {
        let name = line.trim_start_matches(' ');
        above.truncate(line.len() - name.len());
        let joint = joints.push_and_get_key(Joint {
            name: name.to_owned(),
            parent: above.last().copied(),
            offset: DVec3::Y,
            ..Joint::default()
        });
        above.push(joint);
    }
    Skeleton { joints }
}

/// The names of upper, lower and end joint of a limb.
pub(super) fn limb<'a>(
    skeleton: &'a Skeleton,
    anatomy: &Anatomy,
    class: Class,
    side: Side,
) -> Vec<&'a str> {
    let Some(limb) = anatomy.limb(class, side) else {
        return Vec::new();
    };
    [Some(limb.upper), limb.lower, limb.end]
        .into_iter()
        .flatten()
        .map(|joint| skeleton.joints[joint].name.as_str())
        .collect()
}

/// The four limbs, arms first, left first: names of upper, lower and end joint.
pub(super) fn limbs<'a>(skeleton: &'a Skeleton, anatomy: &Anatomy) -> Vec<Vec<&'a str>> {
    [Class::Arm, Class::Leg]
        .into_iter()
        .flat_map(|class| Side::BOTH.map(|side| limb(skeleton, anatomy, class, side)))
        .collect()
}
