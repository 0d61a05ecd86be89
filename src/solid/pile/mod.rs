//! Solids that lie over one another: each comes out in front of what is drawn before it.
//!
//! A solid that is lifted by what lies below it becomes two height fields over one mesh of its outline, joined by walls where
//! they differ at the border. The heights below are looked up in the surfaces that are written, so that what is drawn later lies
//! in front of the triangles, not only of what these stand for.
//!
//! All heights are depths in the drawing, towards the viewer, model units; points are in the frame of a solid's node as seen from
//! the front.

use std::any::Any;
use std::hash::Hasher;
use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHasher};

use super::heights::{BothHeights, Heights};
use super::source::{long_hash, on_sides};
use super::{Sides, Solid};
use crate::geometry::Outline;
use crate::scene::{Surface, SurfaceSource};
use field::Field;
use ground::{BodyInFrame, Ground, Own, Target};
use growth::Growth;
use rim::Rim;

pub(crate) use girth::{Girth, Section};
pub(crate) use recent::{RecentHeights, SolidHeights};

mod cover;
mod field;
mod girth;
mod ground;
mod growth;
mod hidden;
mod recent;
mod region;
mod rim;

/// How far a mesh may deviate from the surfaces below it before it is refined, as a share of the step.
const TOLERANCE: f64 = 0.5;
/// The same where nobody sees the deviation. What lies on top is lifted by it, so it has a limit.
const MAX_TOLERANCE: f64 = 2.0;

/// The solids of a drawing that lie over one another or that others lie on, back-most first.
#[derive(Debug)]
pub(crate) struct Pile {
    pub(crate) bodies: Vec<Body>,
    /// Per body a hash of its solid by itself.
    solids: Vec<u128>,
    /// Per body a hash of all that its surface is made from.
    keys: Vec<u128>,
    /// Per body whether others lie on it.
    carries: Vec<bool>,
    growth: Growth,
    recent: Arc<RecentHeights>,
}

/// A solid in a pile.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    /// The solid as it is by itself, in the frame of its node, its own plane at depth 0.
    pub solid: Solid,
    /// From the frame of its node to the plane of the drawing, model units.
    pub to_plane: DAffine2,
    /// The depth of its plane.
    pub depth: f64,
    /// The depth of its node.
    pub node_depth: f64,
    /// What its heights are multiplied by.
    pub flattened: f64,
    /// Whether its depth is given by numbers: what is behind it may come out in front of it.
    pub is_given: bool,
    /// Whether it lies on others without a volume of its own.
    pub is_detail: bool,
    /// Whether it lies on the backs of others: all of it is described as seen from behind, mirrored in the plane of the drawing,
    /// its depths included.
    pub is_behind: bool,
    /// The bodies that hide what lies in them or is drawn under them, although all of them are translucent: that is cut away.
    pub hidden_by: Vec<usize>,
    /// How it is lifted; `None` leaves it as it is.
    pub lay: Option<Lay>,
}

/// How a solid is lifted by those below it.
#[derive(Debug, Clone)]
pub(crate) struct Lay {
    /// The earlier bodies that it overlaps, back-most first.
    pub below: Vec<usize>,
    /// The bodies of `below` that it closes behind.
    pub wraps: Vec<usize>,
    /// The later bodies that it stays behind.
    pub behind: Vec<usize>,
    /// Whether the solid by itself covers more than its outline, as seen from the front, and is cut off there.
    pub clips: bool,
    /// How far it comes out in front of what it lies on, at least.
    pub step: f64,
    /// A deviation that nobody sees.
    pub invisible: f64,
    /// The share of its own heights that it adds to those of the volumes below it.
    pub bulge: f64,
    /// Layers per half turn that are enough for that share; `None` for as many as the solid has by itself.
    pub segments: Option<u32>,
    /// Its form.
    pub form: LayForm,
    /// Where it reaches out more than its heights say.
    pub toes: Option<Toes>,
    /// How it is round about what wears it, and from the frame of its node to the drawing.
    pub girth: Option<(Arc<Girth>, DAffine2)>,
    /// How far around the origin of its node it reaches back to what it lies on, however far in front of that it is.
    pub root: Option<f64>,
    /// Whether it is the stroke of a line.
    pub is_line: bool,
    /// Whether a volume that is lifted reaches as far to the back as to the front.
    pub is_symmetric: bool,
}

/// Toes: towards one end of it, a solid reaches out to one side by a multiple of its heights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Toes {
    /// The direction to that end, a unit vector in the frame of its node.
    pub down: DVec2,
    /// The distances along it where they begin and from which on they are whole.
    pub between: [f64; 2],
    /// The factor where they are whole.
    pub factor: f64,
    /// Whether they reach away from the viewer.
    pub away: bool,
}

impl Toes {
    /// How far a solid reaches to the front and to the back over a point where its own heights are these.
    fn reach(&self, point: DVec2, mut own: [f64; 2]) -> [f64; 2] {
        let [from, to] = self.between;
        let share = ((point.dot(self.down) - from) / (to - from)).clamp(0.0, 1.0);
        let smooth = share * share * (3.0 - 2.0 * share);
        own[usize::from(self.away)] *= 1.0 + (self.factor - 1.0) * smooth;
        own
    }
}

/// What becomes of a solid that is lifted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LayForm {
    /// It keeps its volume, and covers what is below.
    Volume,
    /// A skin on what is below, which ends a step under it.
    Skin,
    /// A skin whose back is as deep as its own.
    DeepSkin,
    /// A skin without heights of its own, with the mesh of the solid whose back it covers.
    BackSkin,
    /// A line drawn on what is below. Beside that it is as deep as the nearest border.
    Ink,
    /// A surface without thickness.
    Sheet,
}

/// The heights of a body, and where its plane is.
#[derive(Debug, Clone)]
pub(super) struct BodyHeights {
    heights: BothHeights,
    /// Added to the heights, which are multiplied by the factor before.
    depth: f64,
    factor: f64,
    /// Whether it is seen from behind, mirrored in the plane of the drawing.
    from_behind: bool,
}

impl BodyHeights {
    /// Heights of a body that is lifted, which are depths already.
    fn lifted(heights: BothHeights) -> Self {
        Self {
            heights,
            depth: 0.0,
            factor: 1.0,
            from_behind: false,
        }
    }

    /// The same as seen from the other side.
    fn mirrored(self) -> Self {
        Self {
            depth: -self.depth,
            from_behind: !self.from_behind,
            ..self
        }
    }

    /// The heights of the side that is in front, and of the other one.
    fn sides(&self) -> [&Heights; 2] {
        let sides = [&*self.heights.front, self.heights.back()];
        let [front, back] = sides;
        if self.from_behind {
            [back, front]
        } else {
            sides
        }
    }

    /// The front over a point, where the body is, and the number of the triangle there.
    fn front(&self, point: DVec2) -> Option<(f64, u32)> {
        let [front, _] = self.sides();
        let (height, triangle) = front.find(point)?;
        Some((self.depth + self.factor * height, triangle))
    }

    /// The back over a point, where the body is.
    fn back(&self, point: DVec2) -> Option<f64> {
        let [_, back] = self.sides();
        let height = back.at(point)?;
        Some(self.depth - self.factor * height)
    }

    /// The front at the nearest point of the body's border.
    fn nearest_front(&self, point: DVec2) -> Option<f64> {
        let [front, _] = self.sides();
        let height = front.nearest(point)?;
        Some(self.depth + self.factor * height)
    }

    /// How far front and back are from the plane, over a point of its outline.
    fn reach(&self, point: DVec2) -> [f64; 2] {
        let reach = |side: &Heights| {
            let height = side.at(point).or_else(|| side.nearest(point));
            self.factor * height.unwrap_or(0.0)
        };
        let [front, back] = self.sides();
        let in_front = reach(front);
        if self.heights.is_symmetric() {
            return [in_front; 2];
        }
        [in_front, reach(back)]
    }
}

impl Lay {
    /// What it is laid on or around.
    fn on(&self) -> impl Iterator<Item = usize> + '_ {
        self.below.iter().chain(&self.wraps).copied()
    }

    /// How far its mesh may deviate from the surfaces below it.
    fn tolerance(&self) -> f64 {
        let unseen = self.invisible.min(MAX_TOLERANCE * self.step);
        unseen.max(TOLERANCE * self.step)
    }
}

impl Pile {
    /// A pile of bodies, back-most first. `recent` are the heights that were looked up last, in this pile or in others.
    pub(crate) fn new(bodies: Vec<Body>, recent: Arc<RecentHeights>) -> Self {
        let mut carries = vec![false; bodies.len()];
        let lays = bodies.iter().filter_map(|body| body.lay.as_ref());
        lays.flat_map(Lay::on).for_each(|on| carries[on] = true);
        let hiders = bodies.iter().flat_map(|body| &body.hidden_by);
        hiders.for_each(|hider| carries[*hider] = true);
        let lifted = bodies.iter().filter(|body| body.lay.is_some()).count();
        let mut pile = Self {
            growth: Growth::of(lifted),
            solids: Vec::new(),
            bodies,
            keys: Vec::new(),
            carries,
            recent,
        };
        let solids = pile.bodies.par_iter();
        pile.solids = solids.map(|body| body.solid.long_key()).collect();
        for body in 0..pile.bodies.len() {
            let key = pile.key_of(body);
            pile.keys.push(key);
        }
        pile
    }

    /// A hash of all that the surface of a body is made from; those of earlier bodies, and of the solids by themselves, are known.
    fn key_of(&self, body: usize) -> u128 {
        let hash_position = |hasher: &mut dyn Hasher, index: usize| {
            let Body {
                solid: _,
                to_plane,
                depth,
                node_depth,
                flattened,
                is_given,
                is_detail,
                is_behind,
                hidden_by: _,
                lay: _,
            } = &self.bodies[index];
            hasher.write_u128(self.solids[index]);
            let numbers = to_plane.to_cols_array().into_iter();
            let numbers = numbers.chain([*depth, *node_depth, *flattened]);
            numbers.for_each(|number| hasher.write_u64(number.to_bits()));
            hasher.write_u8((*is_given).into());
            hasher.write_u8((*is_detail).into());
            hasher.write_u8((*is_behind).into());
        };
        long_hash(|hasher| {
            hash_position(hasher, body);
            let Some(lay) = &self.bodies[body].lay else {
                return;
            };
            // Of how little of it is seen, only the tolerance matters that follows from it.
            let Lay {
                below,
                wraps,
                behind,
                clips,
                step,
                invisible: _,
                bulge,
                segments,
                form,
                toes,
                girth,
                root,
                is_line,
                is_symmetric,
            } = lay;
            hasher.write_u64(step.to_bits());
            hasher.write_u64(lay.tolerance().to_bits());
            hasher.write_u64(bulge.to_bits());
            hasher.write_u8(segments.is_some().into());
            hasher.write_u32(segments.unwrap_or_default());
            let Growth { each, per } = self.growth;
            hasher.write_usize(each);
            hasher.write_usize(per);
            hasher.write_u8(*form as u8);
            hasher.write_u8((*clips).into());
            hasher.write_u8((*is_line).into());
            hasher.write_u8((*is_symmetric).into());
            hasher.write_u8(toes.is_some().into());
            if let Some(Toes {
                down,
                between: [from, to],
                factor,
                away,
            }) = toes
            {
                let numbers = [down.x, down.y, *from, *to, *factor];
                let numbers = numbers.iter();
                numbers.for_each(|number| hasher.write_u64(number.to_bits()));
                hasher.write_u8((*away).into());
            }
            hasher.write_u8(girth.is_some().into());
            if let Some((girth, to_drawing)) = girth {
                let numbers = girth.numbers().chain(to_drawing.to_cols_array());
                numbers.for_each(|number| hasher.write_u64(number.to_bits()));
            }
            hasher.write_u64(root.unwrap_or(f64::NAN).to_bits());
            for list in [below, wraps] {
                hasher.write_usize(list.len());
                for other in list {
                    hasher.write_u128(self.keys[*other]);
                }
            }
            for later in behind {
                hash_position(hasher, *later);
            }
        })
    }

    /// A body as it is by itself, its plane at its depth.
    fn unlifted(&self, index: usize) -> BodyHeights {
        let body = &self.bodies[index];
        BodyHeights {
            heights: self.recent.of_solid(self.solids[index], &body.solid),
            depth: body.depth,
            factor: body.flattened,
            from_behind: false,
        }
    }

    /// Makes a body that others lie on, and all that it lies on, and adds where they are.
    fn place(&self, body: usize, known: &mut FxHashMap<usize, BodyHeights>) {
        // Not by recursion, as piles can be higher than a stack is deep.
        let mut open = vec![body];
        while let Some(&top) = open.last() {
            if known.contains_key(&top) {
                open.pop();
                continue;
            }
            let Some(lay) = &self.bodies[top].lay else {
                known.insert(top, self.unlifted(top));
                continue;
            };
            let key = self.keys[top];
            let field = self.recent.find_field(key).or_else(|| {
                let before = open.len();
                open.extend(lay.on().filter(|other| !known.contains_key(other)));
                (open.len() == before).then(|| self.recent.field(key, || self.field(top, known)))
            });
            if let Some(field) = field {
                let lifted =
                    field.map(|field| BodyHeights::lifted(self.recent.of_field(key, &field)));
                known.insert(top, lifted.unwrap_or_else(|| self.unlifted(top)));
            }
        }
    }

    /// The height fields of a body that is lifted by others, whose heights are known; `None` if nothing lifts it after all.
    fn field(&self, index: usize, known: &FxHashMap<usize, BodyHeights>) -> Option<Field> {
        let body = &self.bodies[index];
        let lay = body.lay.as_ref()?;
        let lies_on = |other: &usize| self.in_frame(*other, known[other].clone(), body);
        let behind = lay.behind.iter();
        let outline = self.outline(body);
        let ground = Ground::new(
            lay.below.iter().rev().map(lies_on).collect(),
            lay.wraps.iter().map(lies_on).collect(),
            behind
                .map(|other| self.in_frame(*other, self.unlifted(*other), body))
                .collect(),
            &outline,
        );
        let target = Target {
            own: match lay.form {
                LayForm::Ink | LayForm::BackSkin => Own::Line,
                // Whether a volume is lifted at all is known before its mesh.
                LayForm::Volume => Own::Body(self.unlifted(index)),
                _ if lay.bulge > 0.0 && body.solid.profile.height_field().is_some() => {
                    Own::Field(&body.solid, body.flattened)
                }
                _ => Own::Body(self.unlifted(index)),
            },
            depth: body.depth,
            lay,
            ground: &ground,
            rim: (lay.is_line && lay.form == LayForm::Ink)
                .then(|| Rim::new(&outline, &ground, lay.step))
                .flatten(),
            growth: self.growth,
        };
        Field::new(&outline, &body.solid, &target)
    }

    /// A body with these heights as seen from another one.
    fn in_frame(&self, other: usize, heights: BodyHeights, body: &Body) -> BodyInFrame {
        let other = &self.bodies[other];
        let is_seen_from_behind = other.is_behind != body.is_behind;
        BodyInFrame {
            body: if is_seen_from_behind {
                heights.mirrored()
            } else {
                heights
            },
            to: other.to_plane.inverse() * body.to_plane,
            // From behind, what is drawn later need not come out in front.
            is_given: other.is_given || is_seen_from_behind,
            is_detail: other.is_detail,
        }
    }

    /// The outline of a body in the frame of its node.
    fn outline(&self, body: &Body) -> Outline {
        let to_node = body.solid.to_final();
        let place = |point: &DVec2| to_node.transform_point2(*point);
        let outline = &body.solid.outline;
        outline.map_rings(|ring| ring.iter().map(place).collect())
    }

    fn surface(&self, index: usize) -> Surface {
        let body = &self.bodies[index];
        let make = || {
            let mut known = FxHashMap::default();
            let ons = body.lay.iter().flat_map(Lay::on);
            ons.for_each(|on| self.place(on, &mut known));
            self.field(index, &known)
        };
        let field = if self.carries[index] {
            self.recent.field(self.keys[index], make)
        } else {
            make().map(Arc::new)
        };
        let surface = match field {
            Some(field) => field.surface(body.node_depth, body.solid.options.crease),
            None => self.unlifted_surface(index),
        };
        let surface = if body.hidden_by.is_empty() {
            surface
        } else {
            hidden::cut(&surface, body.node_depth, &self.hiders(index))
        };
        if body.is_behind {
            surface.mirrored()
        } else {
            surface
        }
    }

    fn unlifted_surface(&self, index: usize) -> Surface {
        let body = &self.bodies[index];
        let mut solid = body.solid.clone();
        let placement = &mut solid.options.placement;
        placement.translation.z = (body.depth - body.node_depth) / placement.scale;
        solid.texture = None;
        let field = if self.carries[index] {
            self.recent.solid_field(self.solids[index], &body.solid)
        } else {
            None
        };
        let surface = field.and_then(|field| solid.surface_of(&field));
        surface.unwrap_or_else(|| solid.surface())
    }

    /// Whether the surface of a body is made from more than its solid, or from what those on top need too.
    pub(crate) fn makes(&self, body: usize) -> bool {
        let is_field = || self.bodies[body].solid.profile.height_field().is_some();
        let Body { lay, hidden_by, .. } = &self.bodies[body];
        lay.is_some() || !hidden_by.is_empty() || (self.carries[body] && is_field())
    }

    /// A hash of all that the surface of a body is made from, in the frame of its node.
    fn surface_key(&self, body: usize) -> u128 {
        let Body {
            lay,
            depth,
            node_depth,
            hidden_by,
            ..
        } = &self.bodies[body];
        if !hidden_by.is_empty() {
            return long_hash(|hasher| {
                hasher.write_u128(self.keys[body]);
                for hider in hidden_by {
                    hasher.write_u128(self.keys[*hider]);
                    hasher.write_u8((*hider > body).into());
                }
            });
        }
        match lay {
            Some(_) => self.keys[body],
            // Equal solids at different places of the drawing have the same surface.
            None => long_hash(|hasher| {
                hasher.write_u128(self.solids[body]);
                hasher.write_u64((depth - node_depth).to_bits());
            }),
        }
    }
}

/// A body of a pile as a source of a surface.
#[derive(Debug, Clone)]
pub(crate) struct LaidSolid {
    /// The pile.
    pub pile: Arc<Pile>,
    /// The index of the body.
    pub body: usize,
    /// The sides of the drawing plane that it is on.
    pub sides: Sides,
    /// From the drawing to texture coordinates, if it is textured.
    pub texture: Option<DAffine2>,
}

impl LaidSolid {
    fn content(&self) -> (u128, Sides, Option<[u64; 6]>) {
        let texture = self
            .texture
            .map(|map| map.to_cols_array().map(f64::to_bits));
        (self.pile.surface_key(self.body), self.sides, texture)
    }
}

impl SurfaceSource for LaidSolid {
    fn surface(&self) -> Surface {
        let mut surface = self.pile.surface(self.body);
        if let Some(texture) = self.texture {
            let map = texture * self.pile.bodies[self.body].solid.to_final().inverse();
            let uv = |[x, y, _]: &[f32; 3]| {
                let point = map.transform_point2(DVec2::new(f64::from(*x), f64::from(*y)));
                point.as_vec2().to_array()
            };
            surface.uvs = surface.positions.iter().map(uv).collect();
        }
        on_sides(surface, self.sides)
    }

    fn mirrored(&self) -> Arc<dyn SurfaceSource> {
        Arc::new(Self {
            sides: self.sides.mirrored(),
            ..self.clone()
        })
    }

    fn key(&self) -> u64 {
        let (key, _, texture) = self.content();
        let mut hasher = FxHasher::default();
        hasher.write_u64(key as u64);
        let numbers = texture.into_iter().flatten();
        numbers.for_each(|number| hasher.write_u64(number));
        hasher.finish()
    }

    fn is_equal(&self, other: &dyn SurfaceSource) -> bool {
        let other = (other as &dyn Any).downcast_ref::<Self>();
        other.is_some_and(|other| self.content() == other.content())
    }
}
