//! The articulated figure: from the bindings to nodes, joints and solids.
//!
//! Invariant: a node's mesh is described in the part's own frame, +Y along its axis away from the joint,
//! +Z towards the viewer; turning the node turns the limb about its joint.

mod copies;
mod depth_limits;
#[cfg(test)]
mod depth_tests;
mod layers;
mod models;
mod nodes;
#[cfg(test)]
mod tests;
mod tree;

use std::sync::Arc;

use glam::{DAffine2, DVec2};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

use crate::bend::{Bend, BentSurface, Bones};
use crate::bind::{Bindings, PartId, PartKind, Seen, SetBy, VehiclePart};
use crate::budget::Work;
use crate::diagnostic::Diagnostic;
use crate::geometry::{Frame, Thickness, y_up};
use crate::index::par_keys;
use crate::memo::Memo;
use crate::resolver::Resolver;
use crate::scene::{
    MaterialId, Mesh, NodeId, PartMaterial, Primitive, Scene, SurfacePatch, WorldTransform,
};
use crate::solid::{self, LEAST_SEGMENTS, LaidSolid, Placement, Profile, Sides, Solid};
use crate::svg::Drawing;
use crate::threads::GRAIN;

use layers::Layers;
use models::Models;
use tree::FigureNode;

pub(crate) use layers::{Behind, FormInFigure, NodeDepth, Reason};
pub(crate) use nodes::PartNode;

/// The linked models of a drawing's figures, read before anything else: parts that are models need no material.
pub(crate) struct LinkedModels(Models);

impl LinkedModels {
    /// Reads the models that `Shape model` links to.
    pub(crate) fn read(
        bindings: &Bindings,
        resolver: &dyn Resolver,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        Self(Models::collect(bindings, resolver, memo, diagnostics))
    }

    /// Whether a part is a model, with materials of its own.
    pub(crate) fn has(&self, part: PartId) -> bool {
        self.0.has(part)
    }

    /// Adds the models' materials to a scene.
    pub(crate) fn add_materials(&mut self, scene: &mut Scene) {
        self.0.add_materials(scene);
    }
}

/// The frames of a part.
#[derive(Debug, Clone, Copy)]
struct PartFrames {
    /// That of its node, if it is a main part.
    node: Frame,
    /// That of its shape, which its solid is made in.
    solid: Frame,
}

/// The figures of a drawing, laid out: frames, hierarchy and depths.
pub(crate) struct Figures<'a> {
    context: FigureContext<'a>,
    layers: Layers,
    forms: Vec<(PartId, FormInFigure)>,
    frames: TiVec<PartId, PartFrames>,
    parts_of_node: TiVec<PartId, Vec<PartId>>,
    tree: TiVec<NodeId, FigureNode>,
}

/// A deviation that nobody sees, as a share of the larger extent of all parts: a twentieth of a pixel in a picture a thousand
/// pixels wide.
const INVISIBLE: f64 = 5e-5;
/// Deviations of roundings in drawings with very many triangles, in deviations that nobody sees: each has half as many layers as the one
/// before.
const COARSER: [f64; 7] = [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0];
/// How far ink comes out at most, as a share of its stroke's width.
const MAX_INK_STEP: f64 = 0.5;

/// The nodes of a drawing's figures, in the order in which they are in the scene.
pub(crate) struct FigureNodes {
    /// Per part its rest frame.
    pub frames: TiVec<PartId, Frame>,
    /// Per main part the parts whose solids are in its node.
    pub parts_of_node: TiVec<PartId, Vec<PartId>>,
    /// Per node the part that it shows.
    pub nodes: TiVec<NodeId, PartNode>,
    /// Per part the first node that shows it.
    pub node_of_part: TiVec<PartId, Option<NodeId>>,
    /// Per part that has a node, how far in front of the drawing plane it lies.
    pub depths: TiVec<PartId, Option<NodeDepth>>,
    /// What parts show from behind beside their own backs.
    pub behind: Vec<(PartId, Behind)>,
    /// What figures do to the forms of parts.
    pub forms: Vec<(PartId, FormInFigure)>,
    /// Per prop its solids, if it has any, in a frame that stands upright on its foot: it has no node yet.
    pub props: Vec<Option<Mesh>>,
    /// Per part the thickness of its solid, `None` without one; empty if the drawing has no motion.
    pub thicknesses: TiVec<PartId, Option<Thickness>>,
}

impl<'a> Figures<'a> {
    /// Lays out the figures of a drawing. Per main part, `seen` says from where it is drawn, and `bends` how it bends, if it does.
    pub(crate) fn lay_out(
        drawing: &'a Drawing,
        bindings: &'a Bindings,
        seen: TiVec<PartId, Seen>,
        bends: TiVec<PartId, Option<Arc<Bend>>>,
        world: &WorldTransform,
        memo: &Memo,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let context = FigureContext::new(drawing, bindings, seen, bends);
        let parts = bindings.parts.raw.par_iter().with_min_len(GRAIN);
        let frames = parts.map(|part| {
            let solid = Frame::new(&part.measure, part.origin);
            let of_group = part.of_group.as_deref();
            let node = match part.kind {
                PartKind::Prop => Frame::upright(part.origin),
                _ => of_group.map_or(solid, |measure| Frame::new(measure, part.origin)),
            };
            PartFrames { node, solid }
        });
        let frames: TiVec<PartId, PartFrames> = frames.collect::<Vec<_>>().into();
        let (layers, mut forms, buried) = Layers::arrange(&context, &frames, world, memo);
        forms.extend(context.bending());
        let tree = tree::nodes(&context, &frames, &layers, diagnostics);
        copies::check(&context, diagnostics);
        layers::report(&context, buried, diagnostics);
        Self {
            parts_of_node: bindings.parts_of_nodes(),
            context,
            layers,
            forms,
            frames,
            tree,
        }
    }

    /// Adds the figures' nodes and meshes to a scene that has nothing but materials.
    pub(crate) fn build(
        self,
        models: &LinkedModels,
        materials: &TiSlice<PartId, PartMaterial>,
        world: &WorldTransform,
        scene: &mut Scene,
    ) -> FigureNodes {
        let mut backs: FxHashMap<PartId, Vec<LaidSolid>> = FxHashMap::default();
        for (part, pile, body) in self.layers.backs() {
            let texture = materials[part].and_then(|(_, texture)| texture);
            backs.entry(part).or_default().push(LaidSolid {
                pile: Arc::clone(pile),
                body,
                sides: Sides::Front,
                texture,
            });
        }
        let mut meshes: Vec<Option<Mesh>> = par_keys(&self.parts_of_node)
            .with_min_len(GRAIN)
            .map(|main| self.mesh(main, &models.0, materials, &backs, world))
            .collect();
        let bindings = self.context.bindings;
        let props = bindings.props.iter();
        let props = props
            .map(|prop| meshes[usize::from(prop.main)].take())
            .collect();
        let (nodes, node_of_part) =
            nodes::add(&self.context, self.tree, meshes.into(), world, scene);
        let thicknesses = if bindings.clip_requests().is_empty() {
            Vec::new()
        } else {
            par_keys(&bindings.parts)
                .with_min_len(GRAIN)
                .map(|part| self.context.thickness(part, self.layers.offset(part)))
                .collect()
        };
        FigureNodes {
            props,
            thicknesses: thicknesses.into(),
            frames: self.frames.into_iter().map(|frames| frames.node).collect(),
            parts_of_node: self.parts_of_node,
            nodes,
            node_of_part,
            behind: self.layers.behind().collect(),
            forms: self.forms,
            depths: self.layers.into_nodes(),
        }
    }

    /// The solids of a main part and its sub-parts, in the main part's frame.
    fn mesh(
        &self,
        main: PartId,
        models: &Models,
        materials: &TiSlice<PartId, PartMaterial>,
        backs: &FxHashMap<PartId, Vec<LaidSolid>>,
        world: &WorldTransform,
    ) -> Option<Mesh> {
        let bones = self.bones(main, world);
        let mut primitives: Vec<Primitive> = Vec::new();
        let mut add = |material: MaterialId, patch: SurfacePatch| {
            let mut same = primitives.iter_mut().filter(|p| p.material == material);
            match same.next() {
                Some(primitive) => primitive.patches.push(patch),
                None => primitives.push(Primitive {
                    patches: vec![patch],
                    material,
                }),
            }
        };
        for &part in &self.parts_of_node[main] {
            if models.has(part) {
                let frames = [&self.frames[part].solid, &self.frames[main].node];
                let (_, both) = self.context.stand(main, part);
                let depth = self.layers.offset(part);
                let outline = &self.context.bindings.parts[part].outline;
                for (material, surface) in
                    models.surfaces(part, outline, frames, depth, both, world.scale)
                {
                    add(material, surface.into());
                }
            } else if let Some((material, texture)) = materials[part]
                && let Some(patch) = self.patch(main, part, texture, world)
            {
                let bend = |patch| self.bent(main, part, bones.as_ref(), patch);
                add(material, bend(patch));
                for skin in backs.get(&part).into_iter().flatten() {
                    let skin = SurfacePatch::Deferred(Arc::new(skin.clone()));
                    add(material, bend(skin));
                }
            }
        }
        (!primitives.is_empty()).then_some(Mesh { primitives })
    }

    /// The bones of a main part, in its node's frame; `None` if it does not bend.
    fn bones(&self, main: PartId, world: &WorldTransform) -> Option<Arc<Bones>> {
        let bend = self.context.bends[main].as_deref()?;
        let frame = self.frames[main].node;
        let to_frame = DAffine2::from_scale(DVec2::splat(world.scale)) * frame.plane_to_local();
        Some(Arc::new(Bones::new(bend, to_frame)))
    }

    /// A surface of a part in the frame of its node, bound to the node's bones. What is smaller than half the width of what bends, such
    /// as a button, follows one of them.
    fn bent(
        &self,
        main: PartId,
        part: PartId,
        bones: Option<&Arc<Bones>>,
        patch: SurfacePatch,
    ) -> SurfacePatch {
        let (Some(bones), SurfacePatch::Deferred(solid)) = (bones, &patch) else {
            return patch;
        };
        let Some(bend) = self.context.bends[main].as_deref() else {
            return patch;
        };
        let measure = &self.context.bindings.parts[part].measure;
        let is_small = part != main && bend.is_rigid(measure.bounds.1 - measure.bounds.0);
        let rigid = is_small.then(|| bend.node_at(y_up(measure.center)) as u16);
        SurfacePatch::Deferred(Arc::new(BentSurface {
            solid: Arc::clone(solid),
            bones: Arc::clone(bones),
            rigid,
        }))
    }

    /// The solid of a part in the frame of its node.
    fn patch(
        &self,
        main: PartId,
        part: PartId,
        texture: Option<DAffine2>,
        world: &WorldTransform,
    ) -> Option<SurfacePatch> {
        let (_, both) = self.context.stand(main, part);
        let both = both || self.layers.is_on_both_sides(part);
        let sides = if both { Sides::Both } else { Sides::Front };
        if let Some((pile, body)) = self.layers.in_pile(part) {
            return Some(SurfacePatch::Deferred(Arc::new(LaidSolid {
                pile: Arc::clone(pile),
                body,
                sides,
                texture,
            })));
        }
        let mut profile = self.context.profile(part)?;
        profile.raise(self.layers.raised(part));
        let mut solid = self
            .context
            .natural(&self.frames, world, [main, part], profile);
        solid.options.placement.translation.z = self.layers.offset(part);
        Some(SurfacePatch::Deferred(Arc::new(Solid {
            sides,
            texture,
            ..solid
        })))
    }
}

/// The drawing with its bindings, and what figures derive from them.
struct FigureContext<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    /// Per main part from where it is drawn.
    seen: TiVec<PartId, Seen>,
    /// Per main part how it bends; `None` for one that is rigid.
    bends: TiVec<PartId, Option<Arc<Bend>>>,
    /// Per part how far it reaches to either side of its plane at most where no string says its `Shape`, drawing units.
    reaches: TiVec<PartId, Option<f64>>,
    /// Per part what it is of a vehicle.
    of_vehicle: TiVec<PartId, Option<VehiclePart>>,
    /// How far the roundings may deviate, in deviations that nobody sees, if all together would have too many triangles.
    coarser: Option<f64>,
    /// How far the surface of a solid may be from a rounding without anybody seeing it, drawing units.
    invisible: f64,
}

impl<'a> FigureContext<'a> {
    fn new(
        drawing: &'a Drawing,
        bindings: &'a Bindings,
        seen: TiVec<PartId, Seen>,
        bends: TiVec<PartId, Option<Arc<Bend>>>,
    ) -> Self {
        let bounds = bindings.parts.iter().map(|part| part.measure.bounds);
        let bounds = bounds.reduce(|(low, high), (a, b)| (low.min(a), high.max(b)));
        let extent = bounds.map_or(0.0, |(low, high)| (high - low).max_element());
        let mut context = Self {
            drawing,
            bindings,
            reaches: depth_limits::reaches(bindings, &seen),
            of_vehicle: bindings.vehicle_parts(&seen),
            seen,
            bends,
            invisible: INVISIBLE * extent,
            coarser: None,
        };
        context.coarser = context.affordable();
        context
    }

    /// How far the roundings may deviate so that all solids together keep within the drawing's budget of triangles, as far as that can
    /// be; `None` if each may have as many layers as it wants. What is small has fewer layers then than what is large.
    fn affordable(&self) -> Option<f64> {
        let triangles = |coarser: Option<f64>| -> u64 {
            let parts = par_keys(&self.bindings.parts).with_min_len(GRAIN);
            let parts = parts.map(|part| {
                let Some(profile) = self.profile(part) else {
                    return 0;
                };
                let options = self.options_within(part, &profile, coarser);
                let outline = &self.bindings.parts[part].outline;
                profile.triangles(outline, self.half(part), &options)
            });
            parts.sum()
        };
        let most = self.drawing.budget.most(Work::Triangles);
        if triangles(None) <= most {
            return None;
        }
        let [inner @ .., coarsest] = COARSER;
        let affordable = inner
            .into_iter()
            .find(|times| triangles(Some(*times)) <= most);
        Some(affordable.unwrap_or(coarsest))
    }

    /// The parts that bend although no string says so.
    fn bending(&self) -> impl Iterator<Item = (PartId, FormInFigure)> + '_ {
        let bends = self.bends.iter_enumerated();
        let bends = bends.filter_map(|(part, bend)| Some((part, bend.as_deref()?)));
        let unasked = bends.filter(|(part, _)| self.bindings.attributes(*part).bend().is_none());
        unasked.map(|(part, bend)| {
            let wearer = self.bindings.parts[part].parent.filter(|_| bend.is_worn);
            let form = match wearer {
                Some(wearer) => FormInFigure::BendsWith { wearer },
                None => FormInFigure::Bends {
                    bones: bend.bones(),
                },
            };
            (part, form)
        })
    }

    /// How far a part's solid, or its node, is moved along the viewer axis, drawing units.
    fn offset(&self, part: PartId) -> f64 {
        let is_main = self.bindings.parts[part].main == part;
        match self.bindings.attributes(part).offset() {
            // A default has moved the sub-part's node already.
            Some(offset) if !is_main && offset.source.from == SetBy::Default => 0.0,
            offset => offset.map_or(0.0, |offset| offset.value),
        }
    }

    /// How far the node of a main part is moved along the viewer axis, drawing units. With `-s` its two solids are moved
    /// instead.
    fn node_offset(&self, part: PartId) -> f64 {
        if self.bindings.attributes(part).shape().mirrored {
            0.0
        } else {
            self.offset(part)
        }
    }

    /// How a part's outline gets its thickness.
    fn profile(&self, part: PartId) -> Option<Profile> {
        let profile = self.bindings.profile(self.drawing, part)?;
        let form = self.bindings.form(part);
        if let Some(of_vehicle) = self.of_vehicle[form] {
            return Some(of_vehicle.profile(profile));
        }
        Some(match self.reach(part) {
            Some(reach) => profile.at_most(reach),
            None => profile,
        })
    }

    /// How far a part reaches to either side of its plane at most, drawing units; `None` if nothing but its form says so.
    fn reach(&self, part: PartId) -> Option<f64> {
        let form = self.bindings.form(part);
        let is_free = self.of_vehicle[form].is_none() && !self.bindings.is_shape_set(form);
        self.reaches[form].filter(|_| is_free)
    }

    /// Whether a part would be deeper if its figure were larger.
    fn is_flattened(&self, part: PartId) -> bool {
        let depths = || {
            let profile = self.bindings.profile(self.drawing, part)?;
            let is_inflated = matches!(profile, Profile::Inflate(_));
            let depths = profile.depths(self.half(part), &self.options(part, &profile));
            depths.filter(|_| is_inflated)
        };
        let reach = self.reach(part);
        reach.is_some_and(|reach| depths().is_some_and(|[_, front]| front > reach))
    }

    /// The half extents of a part's outline across its axis and along it, drawing units.
    fn half(&self, part: PartId) -> DVec2 {
        let measure = &self.bindings.parts[part].measure;
        DVec2::new(measure.half_across, measure.half_along)
    }

    /// The thickness of a part's solid that is moved by an offset; `None` without one.
    fn thickness(&self, part: PartId, offset: f64) -> Option<Thickness> {
        let profile = self.profile(part)?;
        let depths = profile.depths(self.half(part), &self.options(part, &profile))?;
        Some(Thickness {
            depths: depths.map(|depth| depth + offset),
            is_soft: profile.is_soft(),
        })
    }

    fn options(&self, part: PartId, profile: &Profile) -> solid::Options {
        self.options_within(part, profile, self.coarser)
    }

    /// The options of a part whose rounding may deviate so much, in deviations that nobody sees.
    fn options_within(
        &self,
        part: PartId,
        profile: &Profile,
        coarser: Option<f64>,
    ) -> solid::Options {
        solid::Options {
            segments: self.segments(part, profile, coarser),
            crease: self.bindings.attributes(self.bindings.form(part)).crease(),
            placement: Placement::default(),
        }
    }

    /// Its layers per half turn.
    fn segments(&self, part: PartId, profile: &Profile, coarser: Option<f64>) -> u32 {
        let attributes = self.bindings.attributes(self.bindings.form(part));
        let wanted = attributes.segments().unwrap_or_else(|| {
            profile.segments(self.half(part), attributes.crease(), self.invisible)
        });
        let Some(times) = coarser else {
            return wanted;
        };
        let half_width = self.bindings.half_width(self.drawing, part);
        let enough = solid::segments_within(times * self.invisible, half_width) as u32;
        wanted.min(enough.next_power_of_two().max(LEAST_SEGMENTS))
    }

    /// The layers per half turn of a part that comes out by a share of its own heights only, unless the drawing says how many.
    fn flattened_segments(&self, part: PartId, profile: &Profile, share: f64) -> Option<u32> {
        let attributes = self.bindings.attributes(self.bindings.form(part));
        // A rounding by n layers is off by its height over n², so a lower one is as close with fewer.
        let enough = |of_whole: u32| (f64::from(of_whole) * share.sqrt()).ceil() as u32;
        let is_free = attributes.segments().is_none();
        is_free.then(|| enough(self.options(part, profile).segments))
    }

    /// The solid of a part by itself in the frame of its node, `[main, part]`, its plane at depth 0.
    fn natural(
        &self,
        frames: &TiSlice<PartId, PartFrames>,
        world: &WorldTransform,
        [main, part]: [PartId; 2],
        profile: Profile,
    ) -> Solid {
        let (own, node) = (&frames[part].solid, &frames[main].node);
        let mut options = self.options(part, &profile);
        options.placement = Placement {
            rotation: own.angle - node.angle,
            translation: node.to_local(own.center).extend(0.0),
            scale: world.scale,
        };
        Solid {
            outline: Arc::clone(&self.bindings.parts[part].outline),
            to_frame: own.drawing_about_center(),
            profile,
            options,
            sides: Sides::Front,
            texture: None,
        }
    }

    /// Whether nothing can be seen through a part.
    fn is_opaque(&self, part: PartId) -> bool {
        let [.., alpha] = self.bindings.material_factors(self.drawing, part).color;
        alpha >= 1.0
    }

    /// The step by which a part comes out in front of what it lies on, at most this: ink no farther than half its width, drawing
    /// units.
    fn step(&self, part: PartId, step: f64) -> f64 {
        let own = &self.bindings.parts[part];
        let stroke = self.drawing.shapes[own.shape].stroke.as_ref();
        match stroke {
            Some(stroke) if own.host.is_some() => step.min(MAX_INK_STEP * stroke.width()),
            _ => step,
        }
    }

    /// How far a part's solid stands from the plane of its node, drawing units, and whether it stands on both sides.
    fn stand(&self, main: PartId, part: PartId) -> (f64, bool) {
        // Ink stands where the part does on which it lies.
        let part = self.bindings.form(part);
        let shape = self.bindings.attributes(part).shape();
        // The node of a main part is moved already, but with `-s` its two solids are.
        let moved = part != main || shape.mirrored;
        let depth = if moved { self.offset(part) } else { 0.0 };
        // A sub-part has no node of its own that could be doubled.
        (depth, shape.mirrored || (shape.doubled && part != main))
    }
}
