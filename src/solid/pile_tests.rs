mod depths;

use std::sync::Arc;

use glam::{DAffine2, DVec2, DVec3, Vec3};
use proptest::prelude::*;

use super::heights::Heights;
use super::laws::{config, lawful, rings};
use super::tests::{circle, kinds_with, options, outline, profile, rectangle};
use super::{Body, LaidSolid, Lay, LayForm, Pile, Profile, Sides, Solid};
use crate::geometry::{Outline, Ring, area};
use crate::law;
use crate::scene::{Surface, SurfaceSource};

pub(super) fn solid(outline: Outline, profile: Profile) -> Solid {
    Solid {
        outline: Arc::new(outline),
        to_frame: DAffine2::IDENTITY,
        profile,
        options: options(16),
        sides: Sides::Front,
        texture: None,
    }
}

/// A line on these solids, which comes out by this step.
fn ink(outline: Outline, below: Vec<Solid>, step: f64) -> LaidSolid {
    let count = below.len();
    laid(
        outline,
        Profile::new("inflate", &[], 1.0).unwrap(),
        below,
        |_| Lay {
            step,
            is_line: true,
            ..lay(LayForm::Ink, count)
        },
    )
}

/// How a body lies on the first so many of a pile.
pub(super) fn lay(form: LayForm, below: usize) -> Lay {
    Lay {
        below: (0..below).collect(),
        wraps: Vec::new(),
        behind: Vec::new(),
        clips: false,
        step: 0.0,
        invisible: 0.0,
        bulge: 0.0,
        segments: None,
        form,
        toes: None,
        girth: None,
        root: None,
        is_line: false,
        is_symmetric: false,
    }
}

/// A solid in the plane of the drawing, by itself.
pub(super) fn body(solid: Solid) -> Body {
    Body {
        solid,
        to_plane: DAffine2::IDENTITY,
        depth: 0.0,
        node_depth: 0.0,
        flattened: 1.0,
        is_given: false,
        is_detail: false,
        is_behind: false,
        hidden_by: Vec::new(),
        lay: None,
    }
}

/// A solid laid on others.
fn laid(
    outline: Outline,
    profile: Profile,
    below: Vec<Solid>,
    lay: impl Fn(usize) -> Lay,
) -> LaidSolid {
    let count = below.len();
    let below = below.into_iter().map(body);
    let own = Body {
        lay: Some(lay(count)),
        ..body(solid(outline, profile))
    };
    let bodies = below.chain([own]).collect();
    LaidSolid {
        pile: Arc::new(Pile::new(bodies, Arc::default())),
        body: count,
        sides: Sides::Front,
        texture: None,
    }
}

pub(super) fn moved(mut outline: Outline, by: DVec2) -> Outline {
    let rings = outline
        .polygons
        .iter_mut()
        .flat_map(|polygon| &mut polygon.rings);
    rings.flatten().for_each(|point| *point += by);
    outline
}

/// The middles of the triangles that face the viewer, and a number of points between them and the corners.
fn front_points(surface: &Surface) -> Vec<DVec2> {
    let at = |i: u32| Vec3::from(surface.positions[i as usize]).as_dvec3();
    let mut points = Vec::new();
    for triangle in &surface.triangles {
        let corners = triangle.map(at);
        let [a, b, c] = corners;
        if (b - a).cross(c - a).z > 0.0 {
            let middle = (a + b + c) / 3.0;
            points.extend(corners.map(|corner| middle.lerp(corner, 0.6).truncate()));
            points.push(middle.truncate());
        }
    }
    points
}

/// How much of a skin's front is under the solid that it lies on, as a share of the points looked at.
fn swallowed(skin: &Surface, host: &Surface) -> f64 {
    let (front, ground) = (Heights::of(skin), Heights::of(host));
    let points = front_points(skin);
    let under = points.iter().filter(|point| {
        let heights = front.at(**point).zip(ground.at(**point));
        heights.is_some_and(|(front, ground)| front <= ground)
    });
    under.count() as f64 / points.len() as f64
}

#[test]
fn skins_are_lawful() {
    let inputs = (
        rings(),
        rings(),
        -3.0..4.0f64,
        0.02..1.5f64,
        (-1.0..1.0f64, -1.0..1.0f64),
        any::<prop::sample::Index>(),
    );
    // Hardly any outline is empty.
    law::check(
        config(),
        90,
        inputs,
        |(host, drawn, size, scale, at, kind)| {
            let size = 10f64.powf(size);
            let scaled = |rings: Vec<Ring>, by: f64| -> Outline {
                outline(
                    rings
                        .iter()
                        .map(|ring| ring.iter().map(|p| *p * by).collect())
                        .collect(),
                )
            };
            let host = scaled(host, size);
            let drawn = moved(scaled(drawn, size * scale), size * DVec2::from(at));
            if area(&host) <= 0.0 || area(&drawn) <= 0.0 {
                return Ok(false);
            }
            let kind = kind.get(&kinds_with(&[-0.1 * size, 0.2 * size])).clone();
            let name = format!("{kind:?}");
            let surface = ink(drawn, vec![solid(host, kind)], 0.004 * size).surface();
            if let Err(error) = lawful(&surface) {
                return Err(TestCaseError::fail(format!("{name}: {error}")));
            }
            Ok(true)
        },
    );
}

/// A layer of a generated stack: its outline, how large it is beside the stack and where, its kind and its form.
pub(super) type Drawn = (
    Vec<Ring>,
    f64,
    (f64, f64),
    prop::sample::Index,
    prop::sample::Index,
);

pub(super) fn drawn() -> impl Strategy<Value = Vec<Drawn>> {
    let layer = (
        rings(),
        0.1..1.2f64,
        (-0.7..0.7f64, -0.7..0.7f64),
        any::<prop::sample::Index>(),
        any::<prop::sample::Index>(),
    );
    prop::collection::vec(layer, 2..6)
}

/// The solids of a stack, each laid on all before it, and closed around the one below if `wraps` says so.
pub(super) fn stack(layers: &[Drawn], size: f64, wraps: bool) -> Option<Vec<Body>> {
    let kinds = ["inflate", "round", "roundv", "roundh", "default"];
    let forms = [
        LayForm::Volume,
        LayForm::Volume,
        LayForm::Skin,
        LayForm::DeepSkin,
        LayForm::Ink,
    ];
    let mut bodies = Vec::new();
    for (index, (rings, scale, at, kind, form)) in layers.iter().enumerate() {
        let scale = if index == 0 { size } else { size * scale };
        let place = |point: &DVec2| *point * scale + size * DVec2::from(*at);
        let outline = outline(
            rings
                .iter()
                .map(|ring| ring.iter().map(place).collect())
                .collect(),
        );
        if area(&outline) <= 0.0 {
            return None;
        }
        let kind = *kind.get(&kinds);
        let numbers: &[f64] = match kind {
            "inflate" => &[],
            "default" => &[-0.05 * size, 0.05 * size],
            _ => &[-90.0, 90.0],
        };
        let form = if index == 0 {
            LayForm::Volume
        } else {
            *form.get(&forms)
        };
        let is_soft = kind != "default" && form != LayForm::Ink;
        let lay = (index > 0).then(|| Lay {
            wraps: (wraps && form == LayForm::Volume)
                .then_some(index - 1)
                .into_iter()
                .collect(),
            clips: is_soft,
            step: 0.004 * size,
            bulge: if is_soft { 0.3 } else { 0.0 },
            is_line: form == LayForm::Ink,
            ..lay(form, index)
        });
        bodies.push(Body {
            is_detail: form != LayForm::Volume,
            lay,
            ..body(solid(outline, profile(kind, numbers)))
        });
    }
    Some(bodies)
}

#[test]
fn stacks_are_lawful() {
    let inputs = (drawn(), -3.0..4.0f64, any::<bool>());
    // Hardly any outline is empty.
    law::check(config(), 80, inputs, |(layers, size, wraps)| {
        let size = 10f64.powf(size);
        let Some(bodies) = stack(&layers, size, wraps) else {
            return Ok(false);
        };
        let pile = Arc::new(Pile::new(bodies, Arc::default()));
        for body in 1..pile.bodies.len() {
            let laid = LaidSolid {
                pile: Arc::clone(&pile),
                body,
                sides: Sides::Front,
                texture: None,
            };
            let surface = laid.surface();
            if let Err(error) = lawful(&surface) {
                return Err(TestCaseError::fail(format!("{body}: {error}")));
            }
            prop_assert!(
                surface.triangles.len() < 40_000,
                "{body}: {} triangles",
                surface.triangles.len()
            );
        }
        Ok(true)
    });
}

#[test]
fn high_piles_grow_linearly() {
    let triangles = |count: usize| {
        let layer = |index: usize| {
            let at = DVec2::new((index % 7) as f64, (index % 5) as f64);
            let outline = moved(circle(30.0 - (index % 11) as f64, 64), at);
            Body {
                lay: (index > 0).then(|| Lay {
                    step: 0.01,
                    bulge: 0.3,
                    ..lay(LayForm::Skin, index)
                }),
                is_detail: index > 0,
                ..body(solid(outline, profile("inflate", &[])))
            }
        };
        let bodies = (0..count).map(layer).collect();
        let pile = Arc::new(Pile::new(bodies, Arc::default()));
        let surfaces = (0..count).map(|body| {
            let pile = Arc::clone(&pile);
            LaidSolid {
                pile,
                body,
                sides: Sides::Front,
                texture: None,
            }
            .surface()
        });
        surfaces
            .map(|surface| surface.triangles.len())
            .sum::<usize>()
    };
    let (low, high) = (triangles(6), triangles(24));
    assert!(high < 6 * low, "{low} triangles of 6, {high} of 24");
}

#[test]
fn skins_lie_on_rounded_solids() {
    for (name, numbers) in [
        ("round", &[-90., 90.][..]),
        ("roundv", &[-90., 90.]),
        ("roundh", &[-90., 90.]),
        ("inflate", &[]),
        ("lathe", &[360.]),
        ("cone", &[0., 20., 0.]),
    ] {
        let below = || solid(circle(20.0, 64), profile(name, numbers));
        let bar = moved(rectangle(24.0, 1.0), DVec2::new(3.0, 2.0));
        for (what, drawn) in [("bar", bar), ("outline", ring(20.0, 1.0))] {
            let skin = ink(drawn.clone(), vec![below()], 0.08);
            let surface = skin.surface();
            lawful(&surface).unwrap_or_else(|error| panic!("{name}, {what}: {error}"));
            let share = swallowed(&surface, &below().surface());
            assert!(share < 0.002, "{name}, {what}: {share} is swallowed");
            assert!(
                surface.triangles.len() < 10_000,
                "{name}, {what}: {}",
                surface.triangles.len()
            );
        }
    }
}

/// The stroke of a circle.
fn ring(radius: f64, width: f64) -> Outline {
    let angle = |i: usize| i as f64 / 64.0 * std::f64::consts::TAU;
    let circle = |r: f64| (0..64).map(|i| r * DVec2::from_angle(angle(i))).collect();
    outline(vec![
        circle(radius + width / 2.0),
        circle(radius - width / 2.0),
    ])
}

#[test]
fn beside_the_solid_a_skin_lies_at_its_border() {
    let below = solid(circle(20.0, 64), profile("inflate", &[]));
    let skin = ink(
        moved(rectangle(2.0, 2.0), DVec2::new(30.0, 0.0)),
        vec![below],
        0.08,
    );
    let depths = skin.surface().positions.into_iter().map(|[_, _, z]| z);
    let (low, high) = depths.fold((f32::MAX, f32::MIN), |(low, high), z| {
        (low.min(z), high.max(z))
    });
    assert!(
        (low + 0.08).abs() < 1e-3 && (high - 0.08).abs() < 1e-3,
        "{low} {high}"
    );
}

/// A skin with a part of the outline of an inflated solid, in front of it or behind it.
fn skin_of(
    outline: &Outline,
    by: DVec2,
    depth: f64,
    is_behind: bool,
) -> Option<(Surface, Surface)> {
    let inflate = || Profile::new("inflate", &[], 1.0).unwrap();
    let region = crate::geometry::intersect(outline, &moved(outline.clone(), by));
    if region.polygons.is_empty() {
        return None;
    }
    let volume = Body {
        depth,
        ..body(solid(outline.clone(), inflate()))
    };
    let lay = Lay {
        step: 0.05,
        segments: Some(8),
        ..lay(LayForm::BackSkin, 1)
    };
    let skin = Body {
        depth: if is_behind { -depth } else { depth },
        is_detail: true,
        is_behind,
        lay: Some(lay),
        ..body(solid(region, inflate()))
    };
    let pile = Arc::new(Pile::new(vec![volume, skin], Arc::default()));
    let surface = |body: usize| {
        let laid = LaidSolid {
            pile: Arc::clone(&pile),
            body,
            sides: Sides::Front,
            texture: None,
        };
        laid.surface()
    };
    Some((surface(0), surface(1)))
}

/// The share of a skin's triangles whose middles are elsewhere than on a skin that is its mirror image in the plane at `depth`. Their
/// points may differ in number: how finely a skin follows a solid is decided by heights, which are rounded differently at other depths.
fn unlike(front: &Surface, behind: &Surface, depth: f64) -> f64 {
    let heights = Heights::of(front);
    let behind = behind.mirrored();
    let corner = |corner: u32| Vec3::from(behind.positions[corner as usize]).as_dvec3();
    let middles = behind.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(corner);
        let is_front = (b - a).cross(c - a).z > 0.0;
        is_front.then(|| (a + b + c) / 3.0)
    });
    let middles: Vec<DVec3> = middles.flatten().collect();
    let is_on = |middle: &&DVec3| {
        let height = heights.at(middle.truncate());
        height.is_some_and(|height| (height - middle.z - 2.0 * depth).abs() < 1e-3)
    };
    let alike = middles.iter().filter(is_on).count();
    1.0 - alike as f64 / middles.len().max(1) as f64
}

/// A skin behind a solid is the mirror image of one in front of it, and hides what it covers from behind.
#[test]
fn skins_behind_mirror_those_in_front() {
    let inputs = (rings(), (-1.0..1.0f64, -1.0..1.0f64), -2.0..2.0f64);
    law::check(config(), 60, inputs, |(rings, by, depth)| {
        let outline = outline(rings);
        let by = DVec2::from(by) * 0.7;
        let skins = [true, false].map(|is_behind| skin_of(&outline, by, depth, is_behind));
        let [Some((volume, behind)), Some((_, front))] = skins else {
            return Ok(false);
        };
        lawful(&behind).map_err(TestCaseError::fail)?;
        let share = swallowed(&behind.mirrored(), &volume.mirrored());
        prop_assert!(share < 0.01, "{share} of the skin is inside");
        let share = unlike(&front, &behind, depth);
        prop_assert!(share < 0.01, "{share} of the skin differs");
        Ok(true)
    });
}

#[test]
fn skins_lie_on_the_highest_of_several_solids() {
    let head = solid(circle(20.0, 64), profile("inflate", &[]));
    let cheek = solid(
        moved(circle(4.0, 32), DVec2::new(6.0, 0.0)),
        profile("default", &[0.0, 22.0]),
    );
    let skin = ink(rectangle(16.0, 1.0), vec![head, cheek], 0.08);
    let heights = Heights::of(&skin.surface());
    let on_cheek = heights.at(DVec2::new(6.0, 0.0)).unwrap();
    let on_head = heights.at(DVec2::new(-6.0, 0.0)).unwrap();
    assert!((on_cheek - 22.08).abs() < 0.05, "{on_cheek}");
    assert!((18.8..19.4).contains(&on_head), "{on_head}");
}

#[test]
fn equal_skins_have_equal_keys() {
    let make = |reach: f64| {
        let below = solid(circle(20.0, 64), profile("inflate", &[]));
        ink(rectangle(16.0, 1.0), vec![below], reach)
    };
    let (one, other) = (make(0.1), make(0.1));
    assert!(one.key() == other.key() && one.is_equal(&other));
    assert!(!one.is_equal(&make(0.2)) && one.key() != make(0.2).key());
    assert!(!one.is_equal(&*one.mirrored()));
}
