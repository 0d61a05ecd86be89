//! Layers: how far in front of the drawing plane each part lies, and what lifts its surface, so that seen from the
//! front the model is the drawing.

mod backs;
mod buried;
mod cords;
mod feet;
mod girth;
mod lifting;
mod node_depths;
mod nodes;
mod overlaps;
mod room;
mod shapes;
mod transparency;
mod vehicles;
mod wraps;

use std::sync::Arc;

use rayon::prelude::*;
use typed_index_collections::{TiSlice, TiVec};

use super::FigureContext;
use crate::bind::{Part, PartId, Seen};
use crate::figure::PartFrames;
use crate::geometry::Bands;
use crate::memo::Memo;
use crate::scene::WorldTransform;
use crate::solid::{Pile, RecentHeights, Solid, SolidHeights};

use buried::Search;
use node_depths::{Figure, NodeDepths, backdrops};
use nodes::{Nodes, RootedShapes};
use overlaps::{Overlap, Scratch, overlaps, ranks};
use shapes::{Shape, shapes};

pub(super) use buried::{Buried, report};

/// The share of its area from which on a shape that lies on its own part, or on those that it hangs on, is a detail.
const DETAIL: f64 = 0.95;
/// Of how many shapes under one it is found out whether it reaches around them, the topmost first.
const MOST_REACHED: usize = 64;
/// The step by which what is drawn later comes out, as a share of the figure's larger extent.
const STEP: f64 = 0.002;
/// The same for the longest chain of shapes that lie over one another.
const ALL_STEPS: f64 = 0.03;

/// Why a node lies where it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// It lies in the plane of what it hangs on.
    Plane,
    /// Numbers say so.
    Given,
    /// It is drawn over a part.
    DrawnOver {
        /// The part.
        part: PartId,
    },
    /// It is drawn before a part that lies over it.
    DrawnUnder {
        /// The part.
        part: PartId,
    },
    /// It lies on a part, or around it, and goes with it.
    With {
        /// The part.
        part: PartId,
    },
    /// It is the far one of two limbs.
    Twin {
        /// The near one.
        of: PartId,
    },
    /// It lies behind a part that covers it.
    Backdrop {
        /// The part.
        of: PartId,
    },
    /// It is part of a vehicle that is the same on both sides.
    Vehicle,
    /// It is a wheel, which is on both sides of a vehicle.
    Wheel,
    /// It is one of two wheels in a line.
    MiddleWheel,
}

/// The depth of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodeDepth {
    /// In front of the drawing plane, drawing units.
    pub depth: f64,
    /// Why it is that.
    pub reason: Reason,
}

/// How a shape lies on others and around them.
#[derive(Debug, Default)]
pub(super) struct Cover {
    /// Whether it lies on its own part, or on those that it hangs on.
    is_detail: bool,
    /// The earlier shapes that it reaches around.
    wraps: Vec<usize>,
    /// The later shapes that it is a backdrop of.
    behind: Vec<usize>,
}

/// Shapes, how they lie over one another, and where their nodes are: what lifting them depends on.
#[derive(Clone, Copy)]
struct Arrangement<'a> {
    context: &'a FigureContext<'a>,
    shapes: &'a [Shape],
    nodes: &'a Nodes,
    overlaps: &'a [Vec<Overlap>],
    covers: &'a [Cover],
    /// Per node its depth.
    depths: &'a [f64],
    /// Per node how far it lies in front of what it hangs on to have room to turn.
    room: &'a [f64],
    /// Per shape its step.
    steps: &'a [f64],
    is_one: bool,
}

impl Arrangement<'_> {
    /// The depth of a shape's plane, drawing units.
    fn plane(&self, shape: usize) -> f64 {
        self.depths[self.nodes.of_shape[shape]] + self.shapes[shape].offset
    }

    /// Whether a shape is in the node of another one or hangs on it.
    fn is_kin(&self, shape: usize, other: usize) -> bool {
        let [node, other] = [shape, other].map(|shape| self.nodes.of_shape[shape]);
        self.is_one || self.nodes.hangs_on(node, other)
    }
}

/// What a part shows from behind beside its own back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Behind {
    /// It closes behind a part.
    Closes {
        /// The part.
        on: PartId,
    },
    /// It is on the back as well, mirrored.
    Mirrored,
    /// It is round about what wears it.
    Round,
}

/// What the figure that a part belongs to does to its form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FormInFigure {
    /// It is a foot whose toes come out of it.
    Toes {
        /// Whether they point away from the viewer.
        away: bool,
    },
    /// It is the outline of a soft volume: a cord around it.
    Cord {
        /// The volume.
        around: PartId,
    },
    /// It is no deeper than its figure may be.
    Flattened,
    /// It bends about joints inside it without a string that says so.
    Bends {
        /// How many bones it has.
        bones: usize,
    },
    /// It is a garment that bends with its parent.
    BendsWith {
        /// The parent.
        wearer: PartId,
    },
}

/// What a part has on the back of a volume.
#[derive(Debug, Clone, Copy)]
struct BackSkin {
    part: PartId,
    why: Behind,
    /// Its place in the pile.
    body: usize,
}

/// How the parts of a drawing lie in depth.
pub(super) struct Layers {
    /// Per part that has a node, its depth.
    nodes: TiVec<PartId, Option<NodeDepth>>,
    /// Per part how far the plane of its solid lies in front of that of its node, drawing units.
    offsets: TiVec<PartId, f64>,
    /// Per part how far the faces of its solid are moved outwards, back and front.
    raised: TiVec<PartId, [f64; 2]>,
    /// Per part whether its solid is there twice, the other one mirrored in the plane of its node.
    both_sides: TiVec<PartId, bool>,
    /// The details among these.
    on_back: Vec<PartId>,
    /// Per part its place in the pile, if it has one.
    places: TiVec<PartId, Option<usize>>,
    /// The skins on backs.
    backs: Vec<BackSkin>,
    /// The parts that are round about what wears them.
    round: Vec<PartId>,
    pile: Arc<Pile>,
}

impl Layers {
    /// How the parts lie, what figures do to their forms, and which of them given depths hide or let float.
    pub(super) fn arrange(
        context: &FigureContext<'_>,
        frames: &TiSlice<PartId, PartFrames>,
        world: &WorldTransform,
        memo: &Memo,
    ) -> (Self, Vec<(PartId, FormInFigure)>, Vec<Buried>) {
        let recent = memo.get((), |_: &()| Arc::new(RecentHeights::default()));
        let mut shapes = shapes(context);
        let mut nodes = Nodes::new(context, &shapes);
        let overlaps = overlaps(&shapes, context.drawing.budget);
        let solid = |shape: &Shape| {
            shape.solid(context.natural(
                frames,
                world,
                [shape.main, shape.part],
                shape.profile.clone(),
            ))
        };
        let is_one = !context.bindings.annotated;
        let mut details = details(context, &shapes, &nodes, &overlaps, is_one);
        vehicles::place_wheels(&mut shapes, &overlaps, &mut details);
        let is_flat = is_one && is_flat(context, &nodes);
        if is_one && !is_flat {
            nodes.hang_on_trunks(&shapes, &overlaps, &details);
        }
        cords::lay(context, &mut shapes, &details);
        let figures = nodes.figures(&shapes);
        let worn = girth::find(context, &shapes, &nodes, &figures, &details);
        let is_foot = |shape: &Shape| feet::toes(context, shape).is_some();
        describe(&mut shapes, &overlaps, is_foot, solid, &recent);
        let mut covers = covers(&shapes, &nodes, &overlaps, details, is_one);
        girth::lay(&mut shapes, &worn, &nodes, &figures, &overlaps, &mut covers);
        let spread: Vec<f64> = nodes
            .main
            .iter()
            .map(|part| context.bindings.attributes(*part).stack())
            .collect();
        let room = room::room(context, &shapes, &nodes, &figures, &covers);
        let node_depths = if is_flat {
            NodeDepths::in_one_plane(&nodes, &room)
        } else {
            // On all cores, before they are asked for one by one: what hangs on something may be moved by its height.
            let hangs = |shape: usize| nodes.parent[nodes.of_shape[shape]].is_some();
            let volumes = shapes.par_iter().zip(&covers).enumerate();
            let volumes = volumes.filter(|(index, (_, cover))| !cover.is_detail && hangs(*index));
            volumes.for_each(|(_, (shape, _))| {
                shape.height();
            });
            let behind = backdrops(&mut shapes, &nodes, &overlaps, &covers);
            for (cover, behind) in covers.iter_mut().zip(behind) {
                cover.behind = behind;
            }
            Figure {
                parts: &context.bindings.parts,
                shapes: &shapes,
                nodes: &nodes,
                overlaps: &overlaps,
                covers: &covers,
                spread: &spread,
                room: &room,
                is_in_plane: &is_in_plane(context, &nodes),
            }
            .place()
        };
        let steps = steps(context, &shapes, &nodes, &figures, &overlaps, is_one);
        let arrangement = Arrangement {
            context,
            shapes: &shapes,
            nodes: &nodes,
            overlaps: &overlaps,
            covers: &covers,
            depths: &node_depths.depths,
            room: &room,
            steps: &steps,
            is_one,
        };
        let backs = backs::backs(context, &shapes, &nodes, &overlaps, &covers, is_one);
        let hidden = transparency::hidden(context, &shapes, &nodes, &overlaps, &covers);
        let lifting = lifting::Lifting {
            arrangement,
            hidden: &hidden,
            frames,
            world,
            backs: &backs,
            mirrored: &backs::mirrored(context, &shapes, &covers, &overlaps),
            on_wheels: &vehicles::on_wheels(&shapes, &covers, &overlaps),
        };
        let node = |part: PartId| {
            let node = nodes.of_part[part]?;
            Some(NodeDepth {
                depth: node_depths.depths[node],
                reason: node_depths.reasons[node],
            })
        };
        let layers = lifting.arrange(context.bindings.parts.keys().map(node).collect(), recent);
        let buried = Search {
            arrangement,
            layers: &layers,
        }
        .find();
        let forms = layers.forms(context, &shapes);
        (layers, forms, buried)
    }

    /// What figures do to the forms of these shapes.
    fn forms(&self, context: &FigureContext<'_>, shapes: &[Shape]) -> Vec<(PartId, FormInFigure)> {
        let form = |shape: &Shape| {
            if shape.is_cord {
                let around = context.bindings.parts[shape.part].host?;
                return Some(FormInFigure::Cord { around });
            }
            let body = self.places[shape.part].map(|place| &self.pile.bodies[place]);
            let lay = body.and_then(|body| body.lay.as_ref());
            match lay.and_then(|lay| lay.toes.as_ref()) {
                Some(toes) => Some(FormInFigure::Toes { away: toes.away }),
                None => context
                    .is_flattened(shape.part)
                    .then_some(FormInFigure::Flattened),
            }
        };
        let forms = shapes.iter();
        let forms = forms.filter_map(|shape| Some((shape.part, form(shape)?)));
        forms.collect()
    }

    /// Per part that has a node, its depth.
    pub(super) fn into_nodes(self) -> TiVec<PartId, Option<NodeDepth>> {
        self.nodes
    }

    /// What each part shows from behind beside its own back.
    pub(super) fn behind(&self) -> impl Iterator<Item = (PartId, Behind)> {
        let backs = self.backs.iter().map(|back| (back.part, back.why));
        backs
            .chain(self.on_back.iter().map(|part| (*part, Behind::Mirrored)))
            .chain(self.round.iter().map(|part| (*part, Behind::Round)))
    }

    /// How far the node of a main part is in front of the node that it hangs on, drawing units.
    pub(super) fn node_step(&self, part: PartId, parent: Option<PartId>) -> f64 {
        let depth = |part: PartId| self.nodes[part].map_or(0.0, |node| node.depth);
        depth(part) - parent.map_or(0.0, depth)
    }

    /// How far the plane of a part's solid lies in front of that of its node, drawing units.
    pub(super) fn offset(&self, part: PartId) -> f64 {
        self.offsets[part]
    }

    /// How far the back and the front face of a part's solid are moved outwards, drawing units.
    pub(super) fn raised(&self, part: PartId) -> [f64; 2] {
        self.raised[part]
    }

    /// Whether a part's solid is there twice, the other one mirrored in the plane of its node.
    pub(super) fn is_on_both_sides(&self, part: PartId) -> bool {
        self.both_sides[part]
    }

    /// Whether a part is lifted by others.
    pub(super) fn is_lifted(&self, part: PartId) -> bool {
        self.places[part].is_some_and(|body| self.pile.bodies[body].lay.is_some())
    }

    /// What parts have on the backs of volumes, with its places in the pile.
    pub(super) fn backs(&self) -> impl Iterator<Item = (PartId, &Arc<Pile>, usize)> {
        let backs = self.backs.iter();
        backs.map(|back| (back.part, &self.pile, back.body))
    }

    /// A part's place in the pile, if that makes its surface.
    pub(super) fn in_pile(&self, part: PartId) -> Option<(&Arc<Pile>, usize)> {
        let body = self.places[part].filter(|body| self.pile.makes(*body))?;
        Some((&self.pile, body))
    }
}

/// Whether all nodes of a drawing without strings lie in one plane: those of figures with names that are drawn from the front, whose
/// ears and arms are beside what they hang on. Animals in profile have near and far limbs, and of figures without names the order
/// of drawing is all that is known.
fn is_flat(context: &FigureContext<'_>, nodes: &Nodes) -> bool {
    let has_names = nodes.parent.iter().any(Option::is_some);
    let mut seen = context.seen.iter();
    has_names && !seen.any(|seen| seen.is_in_profile())
}

/// Per node whether it stays in the plane of what it hangs on: trunk, neck, head and tail of a figure in profile, which is symmetric
/// about that plane.
fn is_in_plane(context: &FigureContext<'_>, nodes: &Nodes) -> Vec<bool> {
    let bindings = context.bindings;
    let roots = nodes.roots();
    let mut in_profile = vec![false; nodes.len()];
    for (node, part) in nodes.main.iter().enumerate() {
        in_profile[roots[node]] |= context.seen[*part] == Seen::InProfile;
    }
    let is_in_plane = |(node, part): (usize, &PartId)| {
        bindings.is_first_look
            && in_profile[roots[node]]
            && bindings.parts[*part].is_in_the_middle()
            && !bindings.is_stack_set(*part)
    };
    nodes.main.iter().enumerate().map(is_in_plane).collect()
}

/// Gives the soft shapes that lie over others or under them their heights, and feet.
fn describe(
    shapes: &mut [Shape],
    overlaps: &[Vec<Overlap>],
    is_foot: impl Fn(&Shape) -> bool + Sync,
    solid: impl Fn(&Shape) -> Solid + Sync,
    recent: &Arc<RecentHeights>,
) {
    let mut takes_part = vec![false; shapes.len()];
    for (above, below) in overlaps.iter().enumerate() {
        for overlap in below {
            takes_part[above] = true;
            takes_part[overlap.below] = true;
        }
    }
    let soft = shapes.par_iter_mut().zip(takes_part);
    let soft = soft.filter(|(shape, takes_part)| {
        shape.is_soft && !shape.is_ink && (*takes_part || is_foot(shape))
    });
    soft.for_each(|(shape, _)| {
        let heights = SolidHeights::new(solid(shape), Arc::clone(recent));
        shape.natural = Some(Box::new(heights));
    });
}

/// Per shape whether it is a detail: whether it lies on its own part, or on those that it hangs on. Arms are none, because they swing.
fn details(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    nodes: &Nodes,
    overlaps: &[Vec<Overlap>],
    is_one: bool,
) -> Vec<bool> {
    let part = |node: usize| &context.bindings.parts[nodes.main[node]];
    let swings = |shape: usize| {
        let node = nodes.of_shape[shape];
        let is_of_arm = || {
            let carrier = nodes.parent[node].map(part);
            part(node).is_arm() || part(node).is_hand() && carrier.is_some_and(Part::is_arm)
        };
        context.bindings.is_first_look
            && shapes[shape].is_main
            && shapes[shape].outline.polygons.len() == 1
            && is_of_arm()
    };
    let is_kin = |above: usize, below: usize| {
        is_one || nodes.hangs_on(nodes.of_shape[above], nodes.of_shape[below])
    };
    let details = overlaps.par_iter().enumerate();
    details
        .map_init(Scratch::default, |scratch, (above, below)| {
            if shapes[above].is_ink {
                return true;
            }
            if swings(above) {
                return false;
            }
            let kin = below
                .iter()
                .rev()
                .filter(|overlap| is_kin(above, overlap.below));
            let area: f64 = kin.clone().map(|overlap| overlap.area).sum();
            if area < 0.9 * DETAIL * shapes[above].area {
                return false;
            }
            let below = kin.map(|overlap| &shapes[overlap.below]);
            scratch.covered(&shapes[above], below) >= DETAIL
        })
        .collect()
}

/// How shapes lie on others and around them, backdrops left out.
fn covers(
    shapes: &[Shape],
    nodes: &Nodes,
    overlaps: &[Vec<Overlap>],
    details: Vec<bool>,
    is_one: bool,
) -> Vec<Cover> {
    let has_chords: Vec<bool> = {
        let mut wanted = vec![false; shapes.len()];
        for (above, below) in overlaps.iter().enumerate() {
            if may_wrap(&shapes[above], details[above]) {
                below
                    .iter()
                    .for_each(|overlap| wanted[overlap.below] = true);
            }
        }
        wanted
    };
    let chords: Vec<Vec<wraps::Chord>> = shapes
        .par_iter()
        .zip(has_chords)
        .map(|(shape, wanted)| {
            if wanted && may_be_wrapped(shape) {
                wraps::chords(shape)
            } else {
                Vec::new()
            }
        })
        .collect();
    let reached: Vec<Vec<usize>> = overlaps
        .par_iter()
        .enumerate()
        .map(|(above, below)| {
            let own = &shapes[above];
            if below.is_empty() || !may_wrap(own, details[above]) {
                return Vec::new();
            }
            let bands = Bands::of(&own.outline);
            let is_parent = |below: usize| {
                let [node, other] = [above, below].map(|shape| nodes.of_shape[shape]);
                !is_one && node != other && nodes.hangs_on(other, node)
            };
            let topmost = below.iter().rev().map(|overlap| overlap.below);
            let topmost = topmost.filter(|below| !is_parent(*below) && !details[*below]);
            let reached = topmost
                .take(MOST_REACHED)
                .filter(|below| wraps::wraps(own, &bands, &chords[*below]));
            let mut reached: Vec<usize> = reached.collect();
            reached.reverse();
            reached
        })
        .collect();
    details
        .into_iter()
        .zip(reached)
        .map(|(is_detail, wraps)| Cover {
            is_detail,
            wraps,
            behind: Vec::new(),
        })
        .collect()
}

fn may_wrap(shape: &Shape, is_detail: bool) -> bool {
    shape.is_soft && !is_detail && !shape.is_given && !shape.is_ink
}

fn may_be_wrapped(shape: &Shape) -> bool {
    shape.is_soft && !shape.is_given && shape.area > 0.0
}

/// Per shape the step by which it comes out in front of what it lies on, drawing units.
fn steps(
    context: &FigureContext<'_>,
    shapes: &[Shape],
    nodes: &Nodes,
    rooted: &RootedShapes,
    overlaps: &[Vec<Overlap>],
    is_one: bool,
) -> Vec<f64> {
    let figure = |shape: usize| {
        if is_one {
            0
        } else {
            rooted.root(nodes.of_shape[shape])
        }
    };
    let mut figures: Vec<Option<(glam::DVec2, glam::DVec2)>> = vec![None; nodes.len().max(1)];
    let mut highest = vec![1; figures.len()];
    let ranks = ranks(overlaps);
    for (index, shape) in shapes.iter().enumerate() {
        let (low, high) = shape.bounds;
        let bounds = &mut figures[figure(index)];
        let (all_low, all_high) = bounds.unwrap_or((low, high));
        *bounds = Some((low.min(all_low), high.max(all_high)));
        let most = &mut highest[figure(index)];
        *most = ranks[index].max(*most);
    }
    (0..shapes.len())
        .map(|shape| {
            let extent =
                figures[figure(shape)].map_or(0.0, |(low, high)| (high - low).max_element());
            let step = extent * STEP.min(ALL_STEPS / highest[figure(shape)] as f64);
            context.step(shapes[shape].part, step)
        })
        .collect()
}
