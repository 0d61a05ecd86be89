//! What a clip moves from place to place.

use super::Clip;
use super::pose::Geometry;

/// The visible geometry that a clip moves from place to place.
#[derive(Debug)]
pub(crate) struct Travellers {
    /// The nodes that the clip translates and that no other of them carries: the hips of figures, for example.
    pub(crate) roots: Vec<usize>,
    /// For each node whether it has a visible mesh that one of the roots carries.
    pub(crate) meshes: Vec<bool>,
}

impl Geometry {
    /// The visible geometry that a clip moves from place to place.
    pub(crate) fn travellers(&self, clip: &Clip) -> Travellers {
        let mut translated = vec![false; self.nodes.len()];
        clip.translated_nodes()
            .for_each(|index| translated[index] = true);
        // For each node the root that carries it.
        let mut carriers: Vec<Option<usize>> = vec![None; self.nodes.len()];
        for index in &self.order {
            let above = self.nodes[*index]
                .parent
                .and_then(|parent| carriers[parent]);
            carriers[*index] = above.or_else(|| translated[*index].then_some(*index));
        }
        let mut is_root = vec![false; self.nodes.len()];
        let mut meshes = vec![false; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            let carrier = match node.skin {
                // A skinned mesh follows its joints only, not its node.
                Some(skin) => {
                    let mut joints = self.skins[skin].joints.iter();
                    joints.find_map(|joint| carriers[*joint])
                }
                None => carriers[index],
            };
            if let Some(root) = carrier.filter(|_| self.visible[index] && node.mesh.is_some()) {
                is_root[root] = true;
                meshes[index] = true;
            }
        }
        Travellers {
            roots: (0..self.nodes.len())
                .filter(|index| is_root[*index])
                .collect(),
            meshes,
        }
    }
}
