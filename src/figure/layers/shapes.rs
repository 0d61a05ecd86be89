//! The shapes of figures as far as their depths depend on them.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::super::FigureContext;
use crate::bind::{PartId, Side, VehiclePart};
use crate::geometry::{EdgeRanges, Outline, area};
use crate::index::par_keys;
use crate::solid::{Girth, Profile, Solid, SolidHeights};
use crate::threads::GRAIN;

/// Lines that are narrower are too thin to be seen as outlines, in deviations that nobody sees.
const HAIRLINE: f64 = 80.0;

/// A part with a solid, in the order of drawing.
#[derive(Debug)]
pub(super) struct Shape {
    pub(super) part: PartId,
    /// The main part of its node.
    pub(super) main: PartId,
    pub(super) outline: Arc<Outline>,
    /// The outline of its solid, which ends where a cord around it begins.
    pub(super) solid_outline: Arc<Outline>,
    pub(super) bounds: (DVec2, DVec2),
    pub(super) ranges: EdgeRanges,
    pub(super) area: f64,
    pub(super) profile: Profile,
    pub(super) is_main: bool,
    pub(super) is_named: bool,
    pub(super) is_ink: bool,
    /// Whether it is ink that is a cord around a soft volume.
    pub(super) is_cord: bool,
    /// Whether it is filled and drawn with an outline that is no hairline.
    pub(super) is_outlined: bool,
    /// Whether it is cloth by its name.
    pub(super) is_sheet: bool,
    /// Whether it is rounded or pointed.
    pub(super) is_soft: bool,
    /// Whether its depth is given by numbers.
    pub(super) is_given: bool,
    /// What it is of a vehicle.
    pub(super) of_vehicle: Option<VehiclePart>,
    /// Whether `Side near` keeps it where it is drawn.
    pub(super) is_near: bool,
    /// How far its plane lies in front of that of its node, drawing units.
    pub(super) offset: f64,
    /// How far a shape that is not soft reaches to the back and to the front of its plane, drawing units.
    pub(super) plate: [f64; 2],
    /// How far its plane faces are from its plane, back and front, drawing units; `None` for a side without one.
    pub(super) faces: [Option<f64>; 2],
    /// The heights of a soft shape that lies over others or under them.
    pub(super) natural: Option<Box<SolidHeights>>,
    /// How it is round about what wears it.
    pub(super) girth: Option<Arc<Girth>>,
    /// What its heights are multiplied by; see [`Shape::flatten`].
    pub(super) flattened: f64,
}

impl Shape {
    /// Its solid, made from that of its part.
    pub(super) fn solid(&self, of_part: Solid) -> Solid {
        Solid {
            outline: Arc::clone(&self.solid_outline),
            ..of_part
        }
    }

    /// How far it reaches to the front over a point, drawing units.
    pub(super) fn front(&self, point: DVec2) -> f64 {
        let own = match &self.natural {
            Some(natural) => self.flattened * natural.front(point),
            None => self.plate[1],
        };
        let girth = self.girth.as_ref();
        girth.map_or(own, |girth| girth.reach(point, [own; 2])[0])
    }

    /// How far it reaches from its plane at most, drawing units. That of a soft shape takes long when it is first asked for.
    pub(super) fn height(&self) -> f64 {
        match (&self.girth, &self.natural) {
            (Some(girth), _) => girth.highest(),
            (_, Some(natural)) => self.flattened * natural.highest(),
            _ => self.plate[0].midpoint(self.plate[1]).max(0.0),
        }
    }

    /// Whether it is a wheel that stands on both sides of a vehicle.
    pub(super) fn is_wheel(&self) -> bool {
        matches!(self.of_vehicle, Some(VehiclePart::Wheel { .. }))
    }

    /// Makes it no higher than this.
    pub(super) fn flatten(&mut self, height: f64) {
        let own = self.height();
        if height < own {
            self.flattened *= height / own;
        }
    }
}

/// The shapes of a drawing, back-most first.
pub(super) fn shapes(context: &FigureContext<'_>) -> Vec<Shape> {
    par_keys(&context.bindings.parts)
        .with_min_len(GRAIN)
        .filter_map(|part| shape(context, part))
        .collect()
}

fn shape(context: &FigureContext<'_>, index: PartId) -> Option<Shape> {
    let bindings = context.bindings;
    let part = &bindings.parts[index];
    if !part.kind.is_solid() {
        return None;
    }
    let profile = context.profile(index)?;
    if matches!(profile, Profile::Model(_)) {
        return None;
    }
    let attributes = bindings.attributes(bindings.form(index));
    let has_depth = bindings.given_depth(bindings.form(index)).is_some();
    let is_mirrored = attributes.shape().mirrored;
    let is_ink = part.host.is_some();
    let stroke = context.drawing.shapes[part.shape].stroke.as_ref();
    let least = HAIRLINE * context.invisible;
    let is_soft = profile.is_soft();
    let faces = profile.faces();
    let plate = match &faces {
        Some(faces) if !is_soft => {
            let [back, front] = faces.depths.map(|depth| depth.unwrap_or(0.0));
            // A sheet has no back of its own.
            let back = if profile.is_open() { front } else { back };
            [-back, front]
        }
        _ => [0.0; 2],
    };
    let faces = faces.map_or([None; 2], |faces| {
        let [back, front] = faces.depths;
        [back.map(|back| -back), front]
    });
    Some(Shape {
        part: index,
        main: part.main,
        outline: Arc::clone(&part.outline),
        solid_outline: Arc::clone(&part.outline),
        bounds: part.measure.bounds,
        ranges: EdgeRanges::new(&part.outline),
        area: area(&part.outline),
        is_main: part.main == index,
        is_named: !part.is_automatic() && !part.name.is_empty(),
        is_ink,
        is_cord: false,
        is_outlined: !part.is_stroke && stroke.is_some_and(|line| line.width() >= least),
        is_sheet: part.is_sheet(),
        is_soft,
        is_given: !is_ink && (has_depth || is_mirrored),
        of_vehicle: context.of_vehicle[bindings.form(index)],
        is_near: bindings.side(index) == Some(Side::Near),
        offset: context.stand(part.main, index).0,
        plate,
        faces,
        natural: None,
        girth: None,
        flattened: 1.0,
        profile,
    })
}
