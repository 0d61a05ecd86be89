//! The joints that `Bone` can name.

use typed_index_collections::ti_vec;

use super::{Cursor, Proposal, ProposalKind, own_name_of, simple};
use crate::lang::ast::{ArgumentKind, Attribute};
use crate::lang::quoting::{NamePlace, quoted_if_needed};
use crate::rig::{FigureClip, JointId};

impl Cursor<'_> {
    /// The joints of the drawing's motions, those of the part's figure first; as the second argument only descendants of the first
    /// one, since a chain leads downwards. Limbs, head and trunk come before fingers, faces and helpers.
    pub(super) fn joints(&self, attribute: &Attribute) -> Vec<Proposal> {
        let first = match attribute.arguments.as_slice() {
            [] => None,
            [first] => match &first.kind {
                ArgumentKind::Word(name) | ArgumentKind::Quoted(name) => Some(name),
                _ => return vec![],
            },
            _ => return vec![],
        };
        let analysis = self.context.analysis;
        let typed = || analysis.part_named(&own_name_of(self.text, self.in_desc)?);
        let own = self
            .string
            .and_then(|string| analysis.part_of_string(string));
        let mut proposals = vec![];
        let mut skeletons = vec![];
        for clip in analysis.clips_for(own.or_else(typed)) {
            if skeletons.contains(&clip.skeleton()) {
                continue;
            }
            skeletons.push(clip.skeleton());
            let below = match first {
                None => ti_vec![true; clip.skeleton().joints.len()],
                Some(name) => match clip.joint_named(name) {
                    Some(joint) => clip.skeleton().descendants(joint),
                    None => continue,
                },
            };
            let joints = below.keys().filter(|joint| below[*joint]);
            let (known, others): (Vec<JointId>, Vec<JointId>) =
                joints.partition(|joint| clip.label(*joint).is_some());
            proposals.extend(
                known
                    .into_iter()
                    .chain(others)
                    .filter_map(|joint| self.joint(clip, joint)),
            );
        }
        proposals
    }

    fn joint(&self, clip: &FigureClip, joint: JointId) -> Option<Proposal> {
        let name = clip.joint_name(joint);
        // A name in a string cannot contain quotes or line breaks.
        if name.is_empty() || name.contains(['"', '＂']) || name.contains(char::is_control) {
            return None;
        }
        let detail = match (clip.label(joint), clip.skeleton().joints[joint].parent) {
            (Some(label), _) => label.describe(),
            (None, Some(parent)) => format!("on {}", clip.joint_name(parent)),
            (None, None) => "a root".to_owned(),
        };
        Some(Proposal {
            text: self.escape(&quoted_if_needed(name, NamePlace::Argument)),
            ..simple(name, ProposalKind::Joint, &detail)
        })
    }
}
