//! A bounding volume hierarchy: finds the triangles that a ray meets.
//!
//! `obvhs` builds a binary tree; two levels of it become one here, so that a ray tests four boxes at once, and four triangles
//! (Dammertz, Hanika and Keller 2008). What a ray meets does not depend on the shape of the tree.

use glam::Vec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use smallvec::SmallVec;

use super::lanes::{Child, Hit, Node, Pack, Ray, WIDTH, bounds, corners};
use super::stack::Stack;
use super::surface::Surface;

/// How long a ray takes for a box, relative to a triangle.
const TRAVERSAL_COST: f32 = 3.0;

/// How many rays will be traced: a better tree pays off only for many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rays {
    /// One for each pixel of a small picture.
    Few,
    /// As many as a lit picture needs.
    Many,
    /// As many as a series of lit pictures needs.
    Film,
}

/// Triangles in a tree of boxes.
#[derive(Clone)]
pub(super) struct Hierarchy {
    /// The root comes first, and children after their parents.
    nodes: Vec<Node>,
    packs: Vec<Pack>,
}

/// The nodes of a binary tree that become the children of one node: those that a ray hits most probably are replaced by their
/// own children.
fn opened<'t>(nodes: &'t [Bvh2Node], parent: &'t Bvh2Node) -> SmallVec<[&'t Bvh2Node; WIDTH]> {
    let mut opened: SmallVec<[&Bvh2Node; WIDTH]> = SmallVec::from_slice(&[parent]);
    while opened.len() < WIDTH {
        let inner = (0..opened.len()).filter(|index| !opened[*index].is_leaf());
        let area = |index: &usize| opened[*index].aabb().half_area();
        let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else {
            break;
        };
        let first = opened.swap_remove(largest).first_index as usize;
        opened.extend(&nodes[first..first + 2]);
    }
    opened
}

impl Hierarchy {
    pub(super) fn new(surface: &Surface, rays: Rays) -> Self {
        let boxes: Vec<Aabb> = (0..surface.triangles.len() as u32)
            .map(|triangle| bounds(&corners(surface, triangle)))
            .collect();
        // How many neighbours are compared, and up to which depth.
        let (neighbors, depth) = match rays {
            Rays::Few => (PlocSearchDistance::Minimum, 0),
            Rays::Many => (PlocSearchDistance::Medium, 3),
            Rays::Film => (PlocSearchDistance::VeryHigh, 0),
        };
        // Not the helper function of `obvhs`, which reads a clock. Its reinsertion would improve the tree a little.
        let mut tree = PlocBuilder::with_capacity(boxes.len()).build(
            neighbors,
            &boxes,
            (0..boxes.len() as u32).collect(),
            SortPrecision::U64,
            depth,
        );
        collapse(&mut tree, WIDTH as u32, TRAVERSAL_COST);
        let mut hierarchy = Self {
            nodes: Vec::with_capacity(tree.nodes.len() / 3 + 1),
            packs: Vec::with_capacity(tree.nodes.len() / 2 + 1),
        };
        let Some(root) = tree.nodes.first() else {
            return hierarchy;
        };
        hierarchy.nodes.push(Node::EMPTY);
        // Nodes whose children are still missing, with the boxes of the binary tree that become these.
        let mut missing: Vec<(usize, SmallVec<[&Bvh2Node; WIDTH]>)> =
            vec![(0, opened(&tree.nodes, root))];
        while let Some((index, boxes)) = missing.pop() {
            hierarchy.nodes[index].count = boxes.len() as u32;
            for (lane, one) in boxes.into_iter().enumerate() {
                hierarchy.nodes[index].set_box(lane, one.aabb());
                hierarchy.nodes[index].children[lane] = if one.is_leaf() {
                    let of = &tree.primitive_indices[one.first_index as usize..];
                    hierarchy.add_packs(surface, &of[..one.prim_count as usize])
                } else {
                    let first = hierarchy.nodes.len();
                    hierarchy.nodes.push(Node::EMPTY);
                    missing.push((first, opened(&tree.nodes, one)));
                    Child {
                        first: first as u32,
                        packs: 0,
                    }
                };
            }
        }
        hierarchy
    }

    fn add_packs(&mut self, surface: &Surface, triangles: &[u32]) -> Child {
        let first = self.packs.len();
        let packs = triangles.chunks(WIDTH);
        self.packs
            .extend(packs.map(|pack| Pack::new(surface, pack)));
        Child {
            first: first as u32,
            packs: (self.packs.len() - first) as u32,
        }
    }

    /// The first triangle beyond `nearest` that `accept` does not refuse; of several at the same distance the first one in
    /// the file.
    pub(super) fn closest(
        &self,
        origin: Vec3,
        direction: Vec3,
        nearest: f32,
        accept: impl Fn(&Hit) -> bool,
    ) -> Option<Hit> {
        let ray = Ray::new(origin, direction, nearest);
        let mut found: Option<Hit> = None;
        let mut furthest = f32::INFINITY;
        let mut stack: Stack<(f32, Child)> = Stack::new();
        let mut next = Some(Child::default());
        while let Some(child) = next {
            next = None;
            if child.packs > 0 {
                for pack in &self.packs[child.first as usize..][..child.packs as usize] {
                    pack.meet(&ray, furthest, |hit| {
                        let before = found.is_none_or(|found| {
                            hit.distance < found.distance
                                || hit.distance == found.distance && hit.triangle < found.triangle
                        });
                        if before && accept(&hit) {
                            furthest = hit.distance;
                            found = Some(hit);
                        }
                    });
                }
            } else if let Some(node) = self.nodes.get(child.first as usize) {
                let (enter, mut met) = node.meet(&ray, furthest);
                if met.is_power_of_two() {
                    next = Some(node.children[met.trailing_zeros() as usize % WIDTH]);
                    continue;
                }
                let enter = enter.to_array();
                // The nearest one is next, and the others are in the stack by their distance.
                let mut order = [(0.0, Child::default()); WIDTH];
                let mut count = 0;
                while met != 0 {
                    let lane = met.trailing_zeros() as usize % WIDTH;
                    met &= met - 1;
                    let mut place = count;
                    while place > 0 && order[place - 1].0 < enter[lane] {
                        order[place] = order[place - 1];
                        place -= 1;
                    }
                    order[place] = (enter[lane], node.children[lane]);
                    count += 1;
                }
                for entry in &order[..count] {
                    stack.push(*entry);
                }
            }
            while let Some((enter, child)) = stack.pop() {
                if enter <= furthest {
                    next = Some(child);
                    break;
                }
            }
        }
        found
    }

    /// Whether the ray meets a triangle that `blocks`, which is called for triangles in any order.
    pub(super) fn is_blocked(
        &self,
        origin: Vec3,
        direction: Vec3,
        mut blocks: impl FnMut(&Hit) -> bool,
    ) -> bool {
        let ray = Ray::new(origin, direction, 0.0);
        let mut stack: Stack<Child> = Stack::new();
        let mut next = Some(Child::default());
        while let Some(child) = next {
            next = None;
            if child.packs > 0 {
                let mut blocked = false;
                for pack in &self.packs[child.first as usize..][..child.packs as usize] {
                    pack.meet(&ray, f32::INFINITY, |hit| blocked = blocked || blocks(&hit));
                }
                if blocked {
                    return true;
                }
            } else if let Some(node) = self.nodes.get(child.first as usize) {
                let (_, mut met) = node.meet(&ray, f32::INFINITY);
                while met != 0 {
                    let lane = met.trailing_zeros() as usize % WIDTH;
                    met &= met - 1;
                    if let Some(later) = next.replace(node.children[lane]) {
                        stack.push(later);
                    }
                }
            }
            next = next.or_else(|| stack.pop());
        }
        false
    }

    /// Fits the boxes to other positions of the same triangles (Lauterbach and others 2006), which takes a fraction of the time of
    /// building a tree.
    pub(super) fn fit(&mut self, surface: &Surface) {
        for index in (0..self.nodes.len()).rev() {
            for lane in 0..self.nodes[index].count as usize {
                let child = self.nodes[index].children[lane];
                let of = match child.packs {
                    0 => self.nodes[child.first as usize].bounds(),
                    packs => {
                        let packs = &mut self.packs[child.first as usize..][..packs as usize];
                        packs
                            .iter_mut()
                            .map(|pack| pack.fit(surface))
                            .fold(Aabb::empty(), |all, one| all.union(&one))
                    }
                };
                self.nodes[index].set_box(lane, &of);
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use glam::{DVec3, Vec2};

    use super::*;
    use crate::import::TriangleSoup;

    /// Small triangles at random places of a ring, around an empty middle.
    pub(crate) fn ring(seed: u64) -> Surface {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut soup = TriangleSoup::default();
        for _ in 0..200 {
            let (sin, cos) = (random.f64() * std::f64::consts::TAU).sin_cos();
            let first = soup.positions.len() as u32;
            for _ in 0..3 {
                let apart = DVec3::from_array([(); 3].map(|()| random.f64() - 0.5)) * 0.2;
                soup.positions.push(DVec3::new(sin, cos, 0.0) + apart);
                soup.normals.push(Vec3::ZERO);
                soup.uvs.push(Vec2::ZERO);
            }
            soup.triangles.push([first, first + 1, first + 2]);
            soup.materials.push(None);
        }
        Surface::new(soup, 0, None)
    }

    /// Rays from all around, each with an origin and a direction.
    fn rays() -> Vec<(Vec3, Vec3)> {
        let mut random = fastrand::Rng::with_seed(5);
        let mut point = || Vec3::from_array([(); 3].map(|()| random.f32() - 0.5));
        // Towards the ring.
        let mut rays: Vec<(Vec3, Vec3)> = (0..3000)
            .map(|_| {
                let origin = point() * 3.0;
                let aim = point().with_z(0.0).normalize_or(Vec3::X) * 0.45;
                (origin, (aim - origin).normalize_or(Vec3::X))
            })
            .collect();
        // Along axes too, where boxes are met at infinity.
        rays.extend((0..300).map(|_| (point().with_z(2.0), Vec3::NEG_Z)));
        rays
    }

    /// All triangles that a ray meets, without a tree.
    fn met(surface: &Surface, origin: Vec3, direction: Vec3) -> Vec<Hit> {
        let mut met = Vec::new();
        let ray = Ray::new(origin, direction, 0.0);
        for triangle in 0..surface.triangles.len() as u32 {
            Pack::new(surface, &[triangle]).meet(&ray, f32::INFINITY, |hit| met.push(hit));
        }
        met
    }

    fn check(hierarchy: &Hierarchy, surface: &Surface) {
        let mut hits = 0;
        for (origin, direction) in rays() {
            let met = met(surface, origin, direction);
            let first = met.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
            let found = hierarchy.closest(origin, direction, 0.0, |_| true);
            assert_eq!(found.map(|hit| hit.triangle), first.map(|hit| hit.triangle));
            let blocked = hierarchy.is_blocked(origin, direction, |_| true);
            assert_eq!(blocked, first.is_some());
            let mut count = 0;
            hierarchy.is_blocked(origin, direction, |_| {
                count += 1;
                false
            });
            assert_eq!(count, met.len());
            hits += count;
            // What is refused is not there, and what is before the start is not either.
            if let Some(first) = first {
                let behind = met.iter().filter(|hit| hit.distance > first.distance);
                let second = behind.min_by(|a, b| a.distance.total_cmp(&b.distance));
                let second = second.map(|hit| hit.triangle);
                let other = |hit: &Hit| hit.triangle != first.triangle;
                let found = hierarchy.closest(origin, direction, 0.0, other);
                assert_eq!(found.map(|hit| hit.triangle), second);
                let nearest = first.distance.next_up();
                let found = hierarchy.closest(origin, direction, nearest, |_| true);
                assert_eq!(found.map(|hit| hit.triangle), second);
            }
        }
        assert!(hits > 1000, "{hits}");
    }

    #[test]
    fn rays_meet_what_they_meet_without_a_tree() {
        for (seed, rays) in [(1, Rays::Many), (2, Rays::Few), (3, Rays::Film)] {
            let surface = ring(seed);
            check(&Hierarchy::new(&surface, rays), &surface);
        }
    }

    #[test]
    fn a_tree_is_fitted_to_other_positions() {
        let (before, after) = (ring(3), ring(4));
        assert_eq!(before.triangles, after.triangles);
        let mut hierarchy = Hierarchy::new(&before, Rays::Film);
        hierarchy.fit(&after);
        check(&hierarchy, &after);
    }

    #[test]
    fn of_coincident_triangles_the_first_one_is_met() {
        let mut surface = ring(6);
        let twice = surface.triangles.clone();
        surface.triangles.extend(twice);
        let hierarchy = Hierarchy::new(&surface, Rays::Many);
        for (origin, direction) in rays() {
            let found = hierarchy.closest(origin, direction, 0.0, |_| true);
            assert!(found.is_none_or(|hit| hit.triangle < 200));
        }
    }

    #[test]
    fn without_triangles_nothing_is_met() {
        let mut hierarchy = Hierarchy::new(&Surface::default(), Rays::Many);
        let found = hierarchy.closest(Vec3::ZERO, Vec3::X, 0.0, |_| true);
        assert!(found.is_none() && !hierarchy.is_blocked(Vec3::ZERO, Vec3::X, |_| true));
        hierarchy.fit(&Surface::default());
        assert!(!hierarchy.is_blocked(Vec3::ZERO, Vec3::X, |_| true));
    }
}
