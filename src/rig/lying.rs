//! Figures that are drawn from above: as drawn they are upright like a picture on a wall, and as soon as they move, they lie on the ground.

use crate::math;
use std::sync::Arc;

use glam::{DQuat, DVec3};

use crate::labels::FigurePartId;
use crate::mocap::Transform;
use crate::retarget::Rig;

/// The most by which a leg is lowered to the ground, degrees.
const MOST: f64 = 40.0;
/// By how much lower the feet are than the belly, as a share of the hips' height above it.
const CLEARANCE: f64 = 0.15;
/// Angles are tried in this many steps.
const STEPS: usize = 160;

/// The same rig, laid down on the ground under it if its figure is seen from above: what faces the viewer faces up, and what is drawn
/// above is farther away. Legs that are drawn beside the middle of the body are lowered, so that they stand.
pub(super) fn laid_down(drawn: &Arc<Rig>) -> Arc<Rig> {
    if !drawn.facing.is_from_above() {
        return Arc::clone(drawn);
    }
    let mut rig = Rig::clone(drawn);
    let parts = rig.parts.iter();
    let points = parts.flat_map(|part| part.surface.iter().copied().chain([part.joint, part.tip]));
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let [low, high] = points.fold(none, |[low, high], point| [low.min(point), high.max(point)]);
    if !(low.is_finite() && high.is_finite()) {
        return Arc::clone(drawn);
    }
    let all: Vec<FigurePartId> = rig.parts.keys().collect();
    let middle = DVec3::Y * f64::midpoint(low.y, high.y);
    let lay = math::rotation_x(-std::f64::consts::FRAC_PI_2);
    turn(&mut rig, &all, lay, middle);
    lower_legs(&mut rig);
    let down = lowest(&rig, &all) - low.y;
    if down.is_finite() {
        shift(&mut rig, DVec3::NEG_Y * down);
    }
    Arc::new(rig)
}

/// Lowers legs that end above the belly to the ground below it.
fn lower_legs(rig: &mut Rig) {
    let is_leg = |rig: &Rig, part: FigurePartId| rig.parts[part].is_leg;
    let trunk: Vec<FigurePartId> = rig
        .parts
        .keys()
        .filter(|part| !is_leg(rig, *part))
        .collect();
    let belly = lowest(rig, &trunk);
    let tops: Vec<FigurePartId> = {
        let is_top = |part: &FigurePartId| {
            let above = rig.parts[*part].parent;
            is_leg(rig, *part) && above.is_none_or(|above| !is_leg(rig, above))
        };
        rig.parts.keys().filter(is_top).collect()
    };
    for top in tops {
        let leg: Vec<FigurePartId> = {
            let all = rig.parts.keys();
            all.filter(|part| rig.is_below(*part, top)).collect()
        };
        let hip = rig.parts[top].joint;
        let points = leg.iter().flat_map(|part| {
            let part = &rig.parts[*part];
            part.surface.iter().copied().chain([part.tip])
        });
        let points: Vec<DVec3> = points.map(|point| point - hip).collect();
        let far = |point: &&DVec3| point.length_squared();
        let end = points.iter().max_by(|a, b| far(a).total_cmp(&far(b)));
        let way = end.and_then(|end| end.with_y(0.0).try_normalize());
        let ground = (1.0 + CLEARANCE) * (belly - hip.y);
        let Some(way) = way.filter(|_| ground < 0.0 && ground.is_finite()) else {
            continue;
        };
        let lowered = |step: usize| {
            let angle = MOST.to_radians() * step as f64 / STEPS as f64;
            math::rotation_around(DVec3::Y.cross(way), angle)
        };
        let reaches = |step: &usize| {
            let turn = lowered(*step);
            points.iter().any(|point| (turn * *point).y <= ground)
        };
        let step = (0..=STEPS).find(reaches).unwrap_or(STEPS);
        turn(rig, &leg, lowered(step), hip);
    }
}

/// The height of the lowest point of some parts.
fn lowest(rig: &Rig, parts: &[FigurePartId]) -> f64 {
    let points = parts.iter().flat_map(|part| &rig.parts[*part].surface);
    points.map(|point| point.y).fold(f64::INFINITY, f64::min)
}

/// Turns some parts of a rig about a point.
fn turn(rig: &mut Rig, parts: &[FigurePartId], rotation: DQuat, about: DVec3) {
    let turned = Transform {
        rotation,
        position: about - rotation * about,
    };
    for part in parts {
        let part = &mut rig.parts[*part];
        part.node = Transform {
            rotation: (rotation * part.node.rotation).normalize(),
            position: turned.apply(part.node.position),
        };
        let points = part.surface.iter_mut().chain(&mut part.outline);
        for point in points.chain([&mut part.joint, &mut part.tip]) {
            *point = turned.apply(*point);
        }
    }
}

/// Moves a rig.
fn shift(rig: &mut Rig, way: DVec3) {
    for part in &mut rig.parts {
        part.node.position += way;
        let points = part.surface.iter_mut().chain(&mut part.outline);
        for point in points.chain([&mut part.joint, &mut part.tip]) {
            *point += way;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::Facing;
    use crate::retarget::RigPart;

    /// A body with a leg to the right.
    fn rig(facing: Facing) -> Arc<Rig> {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let part = RigPart {
            parent: None,
            is_rooted: false,
            node: Transform {
                rotation: DQuat::IDENTITY,
                position: at(5.0, 20.0, 3.0),
            },
            joint: at(5.0, 20.0, 3.0),
            tip: at(5.0, 40.0, 3.0),
            surface: vec![
                at(5.0, 10.0, 3.0),
                at(5.0, 50.0, 3.0),
                at(5.0, 30.0, 1.0),
                at(5.0, 30.0, 7.0),
            ],
            outline: Vec::new(),
            is_arm: false,
            stands: false,
            drive: None,
            is_leg: false,
            swing: None,
            inside: None,
            shared: None,
        };
        let hip = at(9.0, 30.0, 4.0);
        let leg = RigPart {
            parent: Some(0.into()),
            node: Transform {
                rotation: DQuat::from_rotation_z(-1.5),
                position: hip,
            },
            joint: hip,
            tip: at(19.0, 31.0, 4.0),
            surface: vec![
                at(19.0, 30.0, 4.0),
                at(19.0, 32.0, 4.0),
                at(19.0, 31.0, 3.5),
            ],
            is_leg: true,
            ..part.clone()
        };
        Arc::new(Rig {
            parts: vec![part, leg].into(),
            facing,
        })
    }

    #[test]
    fn what_is_seen_from_above_lies_with_its_back_up() {
        let drawn = rig(Facing::Up);
        let lying = laid_down(&drawn);
        let part = &lying.parts.raw[0];
        let heights = |part: &RigPart| {
            let heights = part.surface.iter().map(|point| point.y);
            heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
                [low.min(y), high.max(y)]
            })
        };
        let [low, high] = heights(part);
        // It is as high as it was deep, and its feet stand on the drawing's ground, a little below the belly.
        let foot = heights(&lying.parts.raw[1])[0];
        assert!((high - low - 6.0).abs() < 1e-9 && (foot - 10.0).abs() < 1e-9);
        assert!((0.3..0.7).contains(&(low - foot)), "{low} {foot}");
        // Its upper end is farther away than its lower one, as far as it was above.
        assert!((part.tip - part.joint).distance(DVec3::NEG_Z * 20.0) < 1e-9);
        // All is where it was in the nodes.
        for (part, before) in lying.parts.iter().zip(&drawn.parts) {
            for (point, drawn) in part.surface.iter().zip(&before.surface) {
                let [own, drawn] = [part.node.to_local(*point), before.node.to_local(*drawn)];
                assert!(own.distance(drawn) < 1e-9, "{own} {drawn}");
            }
        }
        assert_eq!(laid_down(&rig(Facing::Viewer)), rig(Facing::Viewer));
    }
}
