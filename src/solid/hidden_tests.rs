use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3, Vec3};
use proptest::prelude::*;

use super::pile_tests::{body, drawn, lay, moved, solid, stack};
use super::tests::{circle, profile, rectangle};
use super::{Body, LaidSolid, Lay, LayForm, Pile, Sides};
use crate::geometry::{Outline, border_distance_squared, bounds};
use crate::law;
use crate::scene::{Surface, SurfaceSource};

/// The surfaces of bodies; if `hide`, they hide each other, although all of them are translucent.
fn surfaces(mut bodies: Vec<Body>, hide: bool) -> Vec<Surface> {
    let count = bodies.len();
    for (index, body) in bodies.iter_mut().enumerate() {
        body.hidden_by = (0..count).filter(|other| hide && *other != index).collect();
    }
    let pile = Arc::new(Pile::new(bodies, Arc::default()));
    let laid = (0..count).map(|body| LaidSolid {
        pile: Arc::clone(&pile),
        body,
        sides: Sides::Front,
        texture: None,
    });
    laid.map(|laid| laid.surface()).collect()
}

/// How many triangles lie over a point, of those that face a viewer who looks along -z and of those that face away, after the model is
/// turned.
fn passed(surfaces: &[Surface], turn: DMat3, point: DVec2) -> [usize; 2] {
    let mut passed = [0; 2];
    for surface in surfaces {
        for triangle in &surface.triangles {
            let at = |i: u32| turn * Vec3::from(surface.positions[i as usize]).as_dvec3();
            let [a, b, c] = triangle.map(at).map(DVec3::truncate);
            let sides = [(a, b), (b, c), (c, a)];
            let sides = sides.map(|(from, to)| (to - from).perp_dot(point - from));
            passed[0] += usize::from(sides.iter().all(|side| *side > 0.0));
            passed[1] += usize::from(sides.iter().all(|side| *side < 0.0));
        }
    }
    passed
}

/// Points of a grid over the middle of the plane, so many to each side.
fn grid(reach: f64, side: i32) -> impl Iterator<Item = DVec2> {
    let places = (-side..=side).flat_map(move |x| (-side..=side).map(move |y| (x, y)));
    // Not on edges that are drawn at even numbers.
    places.map(move |(x, y)| {
        DVec2::new(f64::from(x) + 0.137, f64::from(y) + 0.211) * reach / f64::from(side)
    })
}

#[test]
fn from_the_front_one_layer_is_seen() {
    // Each of these looks at every triangle for every point.
    // Hardly any outline is empty.
    law::check(law::config(16), 80, drawn(), |layers| {
        let Some(bodies) = stack(&layers, 1.0, false) else {
            return Ok(false);
        };
        let outlines: Vec<_> = bodies
            .iter()
            .map(|body| body.solid.outline.clone())
            .collect();
        let ends = outlines.iter().filter_map(|outline| bounds(outline));
        let reach = ends.fold(0.0, |most: f64, (low, high)| {
            most.max(low.abs().max(high.abs()).max_element())
        });
        let whole = surfaces(bodies.clone(), false);
        let surfaces = surfaces(bodies, true);
        for point in grid(reach, 4) {
            let is_near = |distance: f64| distance < 1e-6 * reach * reach;
            let distance = |outline: &Arc<Outline>| border_distance_squared(outline, point);
            if outlines.iter().map(distance).any(is_near) {
                continue;
            }
            let fronts = |surfaces: &[Surface]| passed(surfaces, DMat3::IDENTITY, point)[0];
            let alone: Vec<usize> = whole
                .iter()
                .map(|one| fronts(std::slice::from_ref(one)))
                .collect();
            // Some kinds lie over themselves beside outlines that are not round.
            if alone.iter().all(|count| *count <= 1) {
                let is_over = alone.contains(&1);
                prop_assert_eq!(fronts(&surfaces), usize::from(is_over), "at {}", point);
            }
        }
        Ok(true)
    });
}

/// A detail on a solid, or a volume that reaches beyond it.
fn laid_on_one(form: LayForm, kind: &str, numbers: &[f64], at: DVec2) -> Vec<Body> {
    let is_soft = kind != "default";
    let on = |outline| body(solid(outline, profile(kind, numbers)));
    let lay = Lay {
        step: 0.04,
        bulge: if is_soft { 0.3 } else { 0.0 },
        ..lay(form, 1)
    };
    let outline = if is_soft {
        circle(6.0, 48)
    } else {
        rectangle(9.0, 9.0)
    };
    let later = Body {
        is_detail: form != LayForm::Volume,
        lay: Some(lay),
        ..on(moved(outline, at))
    };
    vec![on(circle(10.0, 64)), later]
}

/// Whoever looks through what is left from any side passes into it as often as out of it, and not through anything inside.
#[test]
fn what_is_left_is_closed_and_empty() {
    let plate = [-2.0, 2.0];
    for (form, kind, numbers, at) in [
        (LayForm::Skin, "inflate", &[][..], DVec2::new(1.0, 2.0)),
        (LayForm::Skin, "default", &plate, DVec2::new(1.0, 2.0)),
        (LayForm::Volume, "inflate", &[], DVec2::new(8.0, 2.0)),
        (LayForm::Volume, "default", &plate, DVec2::new(8.0, 2.0)),
    ] {
        let surfaces = surfaces(laid_on_one(form, kind, numbers, at), true);
        for angle in [0.0, 45.0, 90.0, 130.0, 180.0, 300.0_f64] {
            let turn = DMat3::from_rotation_x(0.2) * DMat3::from_rotation_y(angle.to_radians());
            let (mut open, mut inner, mut count) = (0, 0, 0);
            for point in grid(14.0, 12) {
                let [front, back] = passed(&surfaces, turn, point);
                count += usize::from(front + back > 0);
                open += usize::from(front != back);
                inner += usize::from(front > 2);
            }
            assert!(
                count > 40 && 50 * open <= count && 50 * inner <= count,
                "{form:?} of {kind} from {angle}°: {open} of {count} are open, {inner} have more layers"
            );
        }
    }
}

/// Many small solids on a plate, some of which overlap: its front is cut by all of them at once.
#[test]
fn a_front_under_many_is_seen_beside_them() {
    let mut bodies = vec![body(solid(
        rectangle(24.0, 24.0),
        profile("default", &[-1.0, 1.0]),
    ))];
    for index in 0..64 {
        let [column, row] = [index % 8, index / 8].map(f64::from);
        let at = DVec2::new(column, row) * 2.8 - 9.8;
        let lay = Lay {
            step: 0.04,
            ..lay(LayForm::Skin, bodies.len())
        };
        // Every fourth reaches over its neighbour.
        let radius = if index % 4 == 0 { 1.9 } else { 1.1 };
        let outline = moved(circle(radius, 5 + index as usize % 20), at);
        bodies.push(Body {
            is_detail: true,
            lay: Some(lay),
            ..body(solid(outline, profile("default", &[-1.0, 1.0])))
        });
    }
    let surfaces = surfaces(bodies, true);
    let mut beside = 0;
    for point in grid(11.0, 20) {
        let [front, _] = passed(&surfaces, DMat3::IDENTITY, point);
        assert_eq!(front, 1, "at {point}");
        let [of_plate, _] = passed(&surfaces[..1], DMat3::IDENTITY, point);
        beside += of_plate;
    }
    assert!(beside > 300, "{beside} points are on the plate");
}
