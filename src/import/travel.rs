//! What a clip moves from place to place.

use typed_index_collections::{TiVec, ti_vec};

use super::pose::Geometry;
use super::{Clip, NodeId};

/// The visible geometry that a clip moves from place to place.
#[derive(Debug)]
pub(crate) struct Travellers {
    /// The nodes that the clip translates and that no other of them carries: the hips of figures, for example.
    pub(crate) roots: Vec<NodeId>,
    /// For each node whether it has a visible mesh that one of the roots carries.
    pub(crate) meshes: TiVec<NodeId, bool>,
}

impl Geometry {
    /// The visible geometry that a clip moves from place to place.
    pub(crate) fn travellers(&self, clip: &Clip) -> Travellers {
        let nodes = self.nodes.len();
        let mut translated: TiVec<NodeId, bool> = ti_vec![false; nodes];
        clip.translated_nodes().for_each(|id| translated[id] = true);
        // For each node the root that carries it.
        let mut carriers: TiVec<NodeId, Option<NodeId>> = ti_vec![None; nodes];
        for id in &self.order {
            let parent = self.nodes[*id].parent;
            let above = parent.and_then(|parent| carriers[parent]);
            carriers[*id] = above.or_else(|| translated[*id].then_some(*id));
        }
        let mut is_root: TiVec<NodeId, bool> = ti_vec![false; nodes];
        let mut meshes: TiVec<NodeId, bool> = ti_vec![false; nodes];
        for (id, node) in self.nodes.iter_enumerated() {
            let carrier = match node.skin {
                // A skinned mesh follows its joints only, not its node.
                Some(skin) => {
                    let mut joints = self.skins[skin].joints.iter();
                    joints.find_map(|joint| carriers[*joint])
                }
                None => carriers[id],
            };
            if let Some(root) = carrier.filter(|_| self.visible[id] && node.mesh.is_some()) {
                is_root[root] = true;
                meshes[id] = true;
            }
        }
        Travellers {
            roots: self.nodes.keys().filter(|id| is_root[*id]).collect(),
            meshes,
        }
    }
}
