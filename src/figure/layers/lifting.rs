//! What lifts the surface of each shape.
//!
//! Plates and sheets that lie on plates and sheets alone stay exact: their faces are moved outwards. All others that lie over
//! something are laid on a pile.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec, ti_vec};

use super::backs::Back;
use super::feet;
use super::shapes::Shape;
use super::{Arrangement, BackSkin, Behind, Layers, NodeDepth};
use crate::bind::{PartId, VehiclePart};
use crate::figure::PartFrames;
use crate::geometry::Frame;
use crate::math;
use crate::scene::WorldTransform;
use crate::solid::{Body, Girth, Lay, LayForm, Pile, RecentHeights, Solid, Toes};

/// The share of its own heights that a rounded shape adds to those of what it lies on.
const BULGE: f64 = 0.3;
/// The same for a detail with a name of its own: a nose, a button.
const NAMED_BULGE: f64 = 0.6;
/// How far a face of a plate is moved outwards at most, in its own heights.
const MAX_RAISE: f64 = 2.0;
/// A plate lies on another one as a whole if this share of it does, as far as lines across both tell.
const ALL_OF: f64 = 0.999;
/// How far a face of a piece of a vehicle is moved outwards as a whole at most, in steps.
const MAX_STEPS: f64 = 8.0;
/// Layers per half turn of a skin on a back, whose mesh follows that of the volume where it has to.
const SKIN_SEGMENTS: u32 = 8;
/// Layers per half turn of a cord at least, and how far its surface may be from round, in deviations that nobody sees: it is thin.
const CORD_SEGMENTS: u32 = 4;
const CORD_DEVIATION: f64 = 20.0;
/// Planes that are less than this share of a step apart coincide.
const SAME: f64 = 0.01;

/// All that lifting depends on.
pub(super) struct Lifting<'a> {
    pub(super) arrangement: Arrangement<'a>,
    pub(super) frames: &'a TiSlice<PartId, PartFrames>,
    pub(super) world: &'a WorldTransform,
    pub(super) backs: &'a [Back],
    /// Per shape whether it shows on the back as well.
    pub(super) mirrored: &'a [bool],
    /// Per shape those that hide parts of it although all of them are translucent.
    pub(super) hidden: &'a [Vec<usize>],
    /// Per shape whether it lies on a wheel.
    pub(super) on_wheels: &'a [bool],
}

/// The depths of plane faces, back and front, both measured outwards; `None` for a side without one.
type Faces = [Option<f64>; 2];

/// What has become of the shapes so far.
struct Moved {
    /// Per shape whether it is not laid on others.
    is_exact: Vec<bool>,
    /// Per shape its faces, moved outwards, as far as they are plane.
    faces: Vec<Faces>,
}

/// How a shape comes out in front of what it lies on.
enum Form {
    /// Its faces are moved outwards by these distances, back and front.
    Raised([f64; 2]),
    Laid(Box<Lay>),
}

/// A pile while it is made.
struct Heap {
    bodies: Vec<Body>,
    /// Per shape its place in the pile, if it has one.
    place: Vec<Option<usize>>,
    /// Per volume the skins that lie on its back so far.
    skins: FxHashMap<usize, Vec<usize>>,
    backs: Vec<BackSkin>,
}

impl Lifting<'_> {
    /// How the parts lie in depth, with nodes at these depths.
    pub(super) fn arrange(
        &self,
        nodes: TiVec<PartId, Option<NodeDepth>>,
        recent: Arc<RecentHeights>,
    ) -> Layers {
        let context = self.arrangement.context;
        let parts = context.bindings.parts.iter_enumerated();
        let mut offsets: TiVec<PartId, f64> = parts
            .map(|(index, part)| context.stand(part.main, index).0)
            .collect();
        for shape in self.arrangement.shapes {
            offsets[shape.part] = shape.offset;
        }
        let mut raised = ti_vec![[0.0; 2]; offsets.len()];
        let count = self.arrangement.shapes.len();
        let mut moved = Moved {
            is_exact: Vec::with_capacity(count),
            faces: Vec::with_capacity(count),
        };
        // Most shapes of a large drawing are not laid on others.
        let mut lays: Vec<Option<Box<Lay>>> = Vec::with_capacity(count);
        let mut both_sides = ti_vec![false; offsets.len()];
        let mut on_back = Vec::new();
        for (index, shape) in self.arrangement.shapes.iter().enumerate() {
            let (by, lay) = match self.form(index, &moved) {
                Form::Raised(by) => (by, None),
                // The backs of plates are plane, whatever lifts their fronts.
                Form::Laid(lay)
                    if lay.form == LayForm::Volume && !shape.is_soft && !lay.is_symmetric =>
                {
                    ([self.raise(index, &moved)[0], 0.0], Some(lay))
                }
                Form::Laid(lay) => ([0.0; 2], Some(lay)),
            };
            raised[shape.part] = by;
            let [back, front] = self.faces(index);
            let is_exact = lay.is_none();
            let has_back = is_exact || !(shape.is_soft || self.is_symmetric(index));
            both_sides[shape.part] = self.is_on_both_sides(index, lay.as_deref());
            if both_sides[shape.part] && self.arrangement.covers[index].is_detail {
                on_back.push(shape.part);
            }
            moved.is_exact.push(is_exact);
            moved.faces.push([
                back.filter(|_| has_back).map(|back| back + by[0]),
                front.filter(|_| is_exact).map(|front| front + by[1]),
            ]);
            lays.push(lay);
        }
        let (pile, places, backs) = self.pile(lays, &raised, recent);
        let shapes = self.arrangement.shapes.iter();
        let round = shapes.filter(|shape| shape.girth.is_some());
        Layers {
            backs,
            round: round.map(|shape| shape.part).collect(),
            nodes,
            offsets,
            raised,
            both_sides,
            on_back,
            places,
            pile: Arc::new(pile),
        }
    }

    fn form(&self, index: usize, moved: &Moved) -> Form {
        let shape = &self.arrangement.shapes[index];
        let cover = &self.arrangement.covers[index];
        let below = || {
            self.arrangement.overlaps[index]
                .iter()
                .map(|overlap| overlap.below)
        };
        if shape.is_given {
            return Form::Raised(self.raise(index, moved));
        }
        let is_plate =
            |other: usize| moved.is_exact[other] && !self.arrangement.shapes[other].is_soft;
        // A door that went through a vehicle would show on the vehicle's ends.
        let is_on_vehicle = shape.of_vehicle.is_some() && cover.is_detail && !self.on_wheels[index];
        if !shape.is_soft && !is_on_vehicle && below().all(is_plate) {
            let by = self.raise(index, moved);
            // A chimney that touches a boiler stays as narrow as it is, while a wheel stays round.
            let is_body = matches!(shape.of_vehicle, Some(VehiclePart::Body { .. }));
            let most = if is_body && self.is_symmetric(index) {
                MAX_STEPS * self.arrangement.steps[index]
            } else {
                MAX_RAISE * shape.height().max(self.arrangement.steps[index])
            };
            let is_low = by[1] <= most || self.rise(index, by[1], moved) <= most;
            if is_low || shape.profile.is_open() {
                return Form::Raised(by);
            }
        }
        let overflows = || {
            let own = self.frames[shape.part].solid.drawing_about_center();
            let place = |point: &DVec2| own.transform_point2(*point);
            let outline = shape
                .outline
                .map_rings(|ring| ring.iter().map(place).collect());
            shape.profile.overflows(&outline)
        };
        let form = match () {
            () if shape.is_cord => LayForm::Volume,
            () if shape.is_ink => LayForm::Ink,
            () if shape.profile.is_open() => LayForm::Sheet,
            () if !cover.is_detail => LayForm::Volume,
            () if is_on_vehicle && !shape.is_soft => LayForm::Skin,
            () if shape.is_main && !self.arrangement.is_one => LayForm::DeepSkin,
            () => LayForm::Skin,
        };
        // What keeps its volume stays beside others whose depth is given, unless it hangs on them.
        let lifts = |other: usize| {
            form != LayForm::Volume
                || !self.arrangement.shapes[other].is_given
                || self.arrangement.is_kin(index, other)
        };
        let below = below()
            .filter(|other| lifts(*other))
            .collect::<Vec<usize>>();
        let clips = shape.is_soft && !shape.is_ink && overflows();
        let toes = self.toes(index);
        let girth = self.girth(index).filter(|_| form == LayForm::Volume);
        let is_formed = toes.is_some() || girth.is_some();
        let is_alone = below.is_empty() && cover.behind.is_empty() && !is_formed;
        // A line beside all shapes is a band too, and no solid of its host's kind.
        if is_alone && !clips && !shape.is_ink {
            return Form::Raised(self.raise(index, moved));
        }
        let bulge = match form {
            _ if !shape.is_soft => 0.0,
            LayForm::Ink => 0.0,
            LayForm::DeepSkin if shape.is_named => NAMED_BULGE,
            _ => BULGE,
        };
        // A volume has heights of its own too, where it is not lifted.
        let is_low = form != LayForm::Volume && bulge > 0.0;
        let context = self.arrangement.context;
        let flattened = || context.flattened_segments(shape.part, &shape.profile, bulge);
        Form::Laid(Box::new(Lay {
            below,
            wraps: cover.wraps.clone(),
            behind: cover.behind.clone(),
            clips,
            step: self.arrangement.steps[index] * self.world.scale,
            invisible: self.arrangement.context.invisible * self.world.scale,
            bulge,
            segments: if shape.is_cord {
                Some(self.cord_segments(shape))
            } else {
                is_low.then(flattened).flatten()
            },
            form,
            toes,
            girth,
            root: self.root(index),
            is_line: self.arrangement.context.bindings.parts[shape.part].is_stroke,
            is_symmetric: self.is_symmetric(index),
        }))
    }

    /// Whether a shape is one of a vehicle that is no wheel and lies on none, so that it reaches as far to the back as to the front.
    fn is_symmetric(&self, index: usize) -> bool {
        let shape = &self.arrangement.shapes[index];
        let is_volume = !self.arrangement.covers[index].is_detail;
        shape.of_vehicle.is_some()
            && !shape.is_wheel()
            && !self.on_wheels[index]
            && (is_volume || self.mirrored[index])
    }

    /// Whether a shape is there twice, the other one mirrored in the plane of its node: wheels, what lies on these, and skins on the
    /// bodies of vehicles.
    fn is_on_both_sides(&self, index: usize, lay: Option<&Lay>) -> bool {
        let shape = &self.arrangement.shapes[index];
        let is_skin = lay.is_some_and(|lay| lay.form != LayForm::Volume);
        shape.of_vehicle.is_some()
            && self.mirrored[index]
            && (is_skin || shape.is_wheel() || self.on_wheels[index])
    }

    /// The layers per half turn of a cord: more for a wide one.
    fn cord_segments(&self, shape: &Shape) -> u32 {
        let context = self.arrangement.context;
        let part = &context.bindings.parts[shape.part];
        let stroke = context.drawing.shapes[part.shape].stroke.as_ref();
        let radius = stroke.map_or(0.0, |stroke| stroke.width() / 2.0);
        let deviation = CORD_DEVIATION * context.invisible / radius;
        let step = 2.0 * math::acos(1.0 - deviation.clamp(1e-3, 1.0));
        ((PI / step).ceil() as u32).max(CORD_SEGMENTS)
    }

    /// How the toes of a foot come out of it.
    fn toes(&self, index: usize) -> Option<Toes> {
        let shape = &self.arrangement.shapes[index];
        let toes = feet::toes(self.arrangement.context, shape)?;
        let node = &self.frames[shape.main].node;
        let height = shape.height();
        let factor = toes.reach / height;
        (height > 0.0 && factor > 1.0).then(|| Toes {
            down: math::direction(-node.angle).rotate(-DVec2::Y),
            // Frames have y up.
            between: toes
                .down
                .map(|down| (down + node.origin.y) * self.world.scale),
            factor,
            away: toes.away,
        })
    }

    /// How a shape is round about what wears it, and from the frame of its node to the drawing.
    fn girth(&self, index: usize) -> Option<(Arc<Girth>, DAffine2)> {
        let shape = &self.arrangement.shapes[index];
        let girth = shape.girth.as_ref()?;
        let scale = self.world.scale;
        let to_drawing = DAffine2::from_scale(DVec2::new(1.0, -1.0) / scale)
            * to_plane(&self.frames[shape.main].node, scale);
        Some((Arc::clone(girth), to_drawing))
    }

    /// How far around its joint an arm in front of a trunk reaches back to that, model units.
    fn root(&self, index: usize) -> Option<f64> {
        let shape = &self.arrangement.shapes[index];
        let node = self.arrangement.nodes.of_shape[index];
        let has_room = shape.is_main && self.arrangement.room[node] > 0.0;
        let part = &self.arrangement.context.bindings.parts[shape.part];
        has_room.then(|| part.node_measure().half_across * self.world.scale)
    }

    /// The depths of the plane faces of a shape by itself, both measured outwards.
    fn faces(&self, index: usize) -> Faces {
        let [back, front] = self.arrangement.shapes[index].faces;
        let depth = self.arrangement.plane(index);
        [
            back.map(|back| back - depth),
            front.map(|front| front + depth),
        ]
    }

    /// How far the plane faces of a shape are moved outwards, back and front, because of those of others that it lies over.
    fn raise(&self, index: usize, moved: &Moved) -> [f64; 2] {
        let shape = &self.arrangement.shapes[index];
        let step = self.arrangement.steps[index];
        let faces = self.faces(index);
        let raised = [0, 1].map(|side| {
            let Some(own) = faces[side] else { return 0.0 };
            let below = self.arrangement.overlaps[index]
                .iter()
                .filter_map(|overlap| {
                    let moved = moved.faces[overlap.below][side]?;
                    Some((self.faces(overlap.below)[side]?, moved))
                });
            let below: Vec<(f64, f64)> = below.collect();
            let is_free = side == 1 && !shape.is_given && !shape.is_soft;
            let mut level = own;
            for (by_itself, moved) in &below {
                let is_same = (by_itself - own).abs() <= SAME * step;
                let hides = is_free && *moved > own - (1.0 - SAME) * step;
                if side == 0 && is_same && !self.mirrored[index] {
                    // From behind, what is drawn first hides what is drawn on it.
                    level = level.min(moved - step);
                } else if is_same || hides {
                    level = level.max(moved + step);
                }
            }
            let is_hidden = side == 0 && !self.mirrored[index];
            let away = if is_hidden { -step } else { step };
            let near = |level: f64| {
                let mut moved = below.iter().map(|(_, moved)| *moved);
                moved.find(|moved| (moved - level).abs() < 0.5 * step)
            };
            for _ in 0..below.len() {
                let Some(other) = near(level) else { break };
                level = other + away;
            }
            level - own
        });
        if self.is_symmetric(index) {
            [raised[1]; 2]
        } else {
            raised
        }
    }

    /// How far the front of a shape, moved outwards by so much, is in front of the plates that carry all of it: what they hide of it does
    /// not show how thick it is.
    fn rise(&self, index: usize, by: f64, moved: &Moved) -> f64 {
        let whole = ALL_OF * self.arrangement.shapes[index].area;
        let below = self.arrangement.overlaps[index].iter();
        let carriers = below.filter(|overlap| overlap.area >= whole);
        let carried_at = carriers.filter_map(|overlap| moved.faces[overlap.below][1]);
        let own = self.faces(index)[1];
        own.map_or(f64::INFINITY, |own| {
            own + by - carried_at.fold(f64::NEG_INFINITY, f64::max)
        })
    }

    /// The pile of all shapes that are laid on others, and of those that they are laid on. Per part its place in it, if it has
    /// one.
    fn pile(
        &self,
        lays: Vec<Option<Box<Lay>>>,
        raised: &TiSlice<PartId, [f64; 2]>,
        recent: Arc<RecentHeights>,
    ) -> (Pile, TiVec<PartId, Option<usize>>, Vec<BackSkin>) {
        let mut count = 0;
        let place = |takes_part: bool| {
            count += usize::from(takes_part);
            takes_part.then(|| count - 1)
        };
        let place: Vec<Option<usize>> = self.takes_part(&lays).into_iter().map(place).collect();
        let mut heap = Heap {
            bodies: Vec::with_capacity(count),
            place,
            skins: FxHashMap::default(),
            backs: Vec::with_capacity(self.backs.len()),
        };
        // What belongs to a vehicle is there twice as a whole.
        let is_copied = |index: usize| {
            self.mirrored[index] && self.arrangement.shapes[index].of_vehicle.is_none()
        };
        let copied = lays.iter().enumerate();
        let copied = copied.filter(|(index, _)| is_copied(*index));
        let copied: Vec<(usize, Lay)> = copied
            .filter_map(|(index, lay)| Some((index, lay.as_deref()?.clone())))
            .collect();
        let places = self.pile_shapes(&mut heap, lays, raised);
        self.pile_back_skins(&mut heap);
        self.pile_images(&mut heap, copied, raised);
        (Pile::new(heap.bodies, recent), places, heap.backs)
    }

    /// Per shape whether it is in the pile.
    fn takes_part(&self, lays: &[Option<Box<Lay>>]) -> Vec<bool> {
        let mut takes_part = vec![false; self.arrangement.shapes.len()];
        for (index, lay) in lays.iter().enumerate() {
            if let Some(lay) = lay {
                takes_part[index] = true;
                let others = lay.below.iter().chain(&lay.wraps).chain(&lay.behind);
                others.for_each(|other| takes_part[*other] = true);
            }
        }
        for (index, hidden_by) in self.hidden.iter().enumerate() {
            takes_part[index] |= !hidden_by.is_empty();
            hidden_by.iter().for_each(|other| takes_part[*other] = true);
        }
        for back in self.backs {
            let on = std::iter::once(&back.on).chain(&back.plates);
            on.for_each(|shape| takes_part[*shape] = true);
        }
        takes_part
    }

    /// Adds the shapes to a pile. Per part its place in it, if it has one.
    fn pile_shapes(
        &self,
        heap: &mut Heap,
        lays: Vec<Option<Box<Lay>>>,
        raised: &TiSlice<PartId, [f64; 2]>,
    ) -> TiVec<PartId, Option<usize>> {
        let mut places = ti_vec![None; self.arrangement.context.bindings.parts.len()];
        for (index, lay) in lays.into_iter().enumerate() {
            let Some(place) = heap.place[index] else {
                continue;
            };
            let to_place =
                |list: Vec<usize>| list.iter().filter_map(|on| heap.place[*on]).collect();
            let lay = lay.map(|lay| Lay {
                below: to_place(lay.below),
                wraps: to_place(lay.wraps),
                behind: to_place(lay.behind),
                ..*lay
            });
            let part = self.arrangement.shapes[index].part;
            places[part] = Some(place);
            let hidden_by = to_place(self.hidden[index].clone());
            heap.bodies.push(Body {
                hidden_by,
                ..self.body(index, lay, raised[part])
            });
        }
        places
    }

    /// Adds what closes behind volumes.
    fn pile_back_skins(&self, heap: &mut Heap) {
        for back in self.backs {
            // The backs of plates that lie over one another are as close to each other as to a skin.
            let plates = back.plates.iter().copied();
            let volumes: Vec<usize> = std::iter::once(back.on).chain(plates).collect();
            let places = volumes.iter().filter_map(|shape| heap.place[*shape]);
            let mut below: Vec<usize> = places.collect();
            below.sort_unstable();
            let mut before: Vec<usize> = volumes
                .iter()
                .filter_map(|shape| heap.skins.get(shape))
                .flatten()
                .copied()
                .collect();
            before.sort_unstable();
            below.extend(before);
            let body = heap.bodies.len();
            heap.skins.entry(back.on).or_default().push(body);
            heap.backs.push(BackSkin {
                part: self.arrangement.shapes[back.of].part,
                why: Behind::Closes {
                    on: self.arrangement.shapes[back.on].part,
                },
                body,
            });
            heap.bodies.push(self.back_skin(back, below));
        }
    }

    /// Adds the mirror images of these shapes, given how each of them is laid on others.
    fn pile_images(
        &self,
        heap: &mut Heap,
        copied: Vec<(usize, Lay)>,
        raised: &TiSlice<PartId, [f64; 2]>,
    ) {
        // Per shape its mirror image, once it is made.
        let mut images: Vec<Option<usize>> = vec![None; self.arrangement.shapes.len()];
        for (index, lay) in copied {
            let on = |shape: &usize| {
                let is_volume = !self.arrangement.covers[*shape].is_detail;
                let volume = heap.place[*shape].filter(|_| is_volume);
                let skins = heap.skins.get(shape).into_iter().flatten().copied();
                volume.into_iter().chain(skins).chain(images[*shape])
            };
            let mut below: Vec<usize> = lay.below.iter().flat_map(on).collect();
            below.sort_unstable();
            let lay = Lay {
                below,
                wraps: Vec::new(),
                behind: Vec::new(),
                ..lay
            };
            let part = self.arrangement.shapes[index].part;
            let body = self.body(index, Some(lay), raised[part]);
            images[index] = Some(heap.bodies.len());
            heap.backs.push(BackSkin {
                part,
                why: Behind::Mirrored,
                body: heap.bodies.len(),
            });
            heap.bodies.push(Body {
                depth: -body.depth,
                node_depth: -body.node_depth,
                is_behind: true,
                ..body
            });
        }
    }

    /// A skin on the back of a volume, described as seen from behind.
    fn back_skin(&self, back: &Back, below: Vec<usize>) -> Body {
        let arrangement = &self.arrangement;
        let [of, on] = [back.of, back.on].map(|index| &arrangement.shapes[index]);
        let scale = self.world.scale;
        let body = self.body(back.of, None, [0.0; 2]);
        // The volume's own kind makes a mesh that bends as its back does.
        let solid = arrangement.context.natural(
            self.frames,
            self.world,
            [of.main, on.part],
            on.profile.clone(),
        );
        let solid = Solid {
            outline: Arc::clone(&back.outline),
            ..solid
        };
        let lay = Lay {
            below,
            wraps: Vec::new(),
            behind: Vec::new(),
            clips: false,
            step: arrangement.steps[back.of] * scale,
            invisible: arrangement.context.invisible * scale,
            bulge: 0.0,
            segments: Some(SKIN_SEGMENTS),
            form: LayForm::BackSkin,
            toes: None,
            girth: None,
            root: None,
            is_line: false,
            is_symmetric: false,
        };
        Body {
            solid,
            depth: -arrangement.plane(back.on) * scale,
            node_depth: -body.node_depth,
            flattened: 1.0,
            is_given: false,
            is_detail: true,
            is_behind: true,
            lay: Some(lay),
            ..body
        }
    }

    fn body(&self, index: usize, lay: Option<Lay>, raised: [f64; 2]) -> Body {
        let shape = &self.arrangement.shapes[index];
        let scale = self.world.scale;
        let mut profile = shape.profile.clone();
        profile.raise(raised);
        let solid = shape.solid(self.arrangement.context.natural(
            self.frames,
            self.world,
            [shape.main, shape.part],
            profile,
        ));
        Body {
            solid,
            to_plane: to_plane(&self.frames[shape.main].node, scale),
            depth: self.arrangement.plane(index) * scale,
            node_depth: self.arrangement.depths[self.arrangement.nodes.of_shape[index]] * scale,
            flattened: shape.flattened,
            is_given: shape.is_given,
            is_detail: self.arrangement.covers[index].is_detail,
            is_behind: false,
            hidden_by: Vec::new(),
            lay,
        }
    }
}

/// From the frame of a node to the plane of the drawing, y up, model units.
fn to_plane(node: &Frame, scale: f64) -> DAffine2 {
    DAffine2::from_translation(node.origin * scale)
        * DAffine2::from_mat2(math::rotation(node.angle))
}
