//! How deep the bodies of piles are, and how they lie on one another.

use std::sync::Arc;

use glam::DVec2;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::super::heights::Heights;
use super::super::laws::config;
use super::super::tests::{outline, profile};
use super::super::{Body, LaidSolid, Lay, LayForm, Pile, Sides};
use super::{Drawn, body, drawn, lay, moved, solid, stack};
use crate::geometry::{Outline, Ring, bounds};
use crate::scene::{Surface, SurfaceSource};

/// A pile with the front and the back of each body, depths.
struct Made {
    pile: Arc<Pile>,
    fronts: Vec<Heights>,
    /// Of the surfaces mirrored in the drawing plane.
    backs: Vec<Heights>,
}

impl Made {
    fn new(bodies: Vec<Body>) -> Self {
        let pile = Arc::new(Pile::new(bodies, Arc::default()));
        let laid = |body| LaidSolid {
            pile: Arc::clone(&pile),
            body,
            sides: Sides::Front,
            texture: None,
        };
        let surfaces: Vec<Surface> = (0..pile.bodies.len())
            .map(|body| laid(body).surface())
            .collect();
        Self {
            fronts: surfaces.iter().map(Heights::of).collect(),
            backs: surfaces
                .iter()
                .map(|surface| Heights::of(&surface.mirrored()))
                .collect(),
            pile,
        }
    }

    /// The front of what lies below a body at a point, of volumes alone if `volumes` says so.
    fn below(&self, body: usize, at: DVec2, volumes: bool) -> Option<f64> {
        let below = (0..body).filter(|other| !volumes || !self.pile.bodies[*other].is_detail);
        let fronts = below.filter_map(|other| self.fronts[other].at(at));
        fronts.reduce(f64::max)
    }
}

/// Points evenly spread over the box around an outline.
fn over(outline: &Outline) -> Vec<DVec2> {
    let Some((low, high)) = bounds(outline) else {
        return Vec::new();
    };
    let at =
        |i: usize, j: usize| low + (high - low) * (DVec2::new(i as f64, j as f64) + 0.5) / 40.0;
    (0..40)
        .flat_map(|i| (0..40).map(move |j| at(i, j)))
        .collect()
}

/// Layers as people draw them: ellipses.
fn ellipses() -> impl Strategy<Value = Vec<Drawn>> {
    let layer = (
        (0.15..1.0f64, 0.15..1.0f64, 0.0..3.2f64),
        0.3..0.9f64,
        (-0.5..0.5f64, -0.5..0.5f64),
        any::<prop::sample::Index>(),
        any::<prop::sample::Index>(),
    );
    let layer = layer.prop_map(|((rx, ry, turn), scale, at, kind, form)| {
        (
            vec![ellipse(DVec2::new(rx, ry), turn)],
            scale,
            at,
            kind,
            form,
        )
    });
    prop::collection::vec(layer, 2..7)
}

fn ellipse(radii: DVec2, turn: f64) -> Ring {
    let angle = |i: usize| i as f64 / 48.0 * std::f64::consts::TAU;
    let turn = DVec2::from_angle(turn);
    let point = |i: usize| turn.rotate(radii * DVec2::from_angle(angle(i)));
    (0..48).map(point).collect()
}

/// How bodies lie on those below, over points of the drawing.
#[derive(Debug, Default, Clone, Copy)]
struct Lie {
    points: usize,
    /// Where the front is higher by more than three steps than what it lies on requires.
    high: usize,
    /// Where it is no higher than what it lies on.
    under: usize,
    /// Points of details, and where they leave a gap over what they lie on.
    of_details: usize,
    gaps: usize,
    /// The height of the highest front as a share of all heights and steps together.
    excess: f64,
}

impl Made {
    fn lie(&self) -> Lie {
        let mut lie = Lie::default();
        let bodies = &self.pile.bodies;
        for (body, own) in bodies.iter().enumerate() {
            let Some(lay) = own.lay.as_ref().filter(|lay| lay.form != LayForm::Ink) else {
                continue;
            };
            let natural = Heights::of(&own.solid.surface());
            for at in over(&own.solid.outline) {
                let (Some(front), Some(below)) =
                    (self.fronts[body].at(at), self.below(body, at, false))
                else {
                    continue;
                };
                let reach = natural.at(at).unwrap_or(0.0);
                let on_volumes = self
                    .below(body, at, true)
                    .map(|volumes| volumes + lay.bulge * reach);
                let free = if lay.form == LayForm::Volume {
                    own.depth + reach
                } else {
                    f64::NEG_INFINITY
                };
                let expected = on_volumes
                    .unwrap_or(f64::NEG_INFINITY)
                    .max(below + lay.step)
                    .max(free);
                lie.points += 1;
                lie.high += usize::from(front > expected + 3.0 * lay.step);
                lie.under += usize::from(front <= below);
                if own.is_detail {
                    lie.of_details += 1;
                    let gap = self.backs[body].at(at).map(|back| -back - below);
                    lie.gaps += usize::from(gap.is_some_and(|gap| gap > 0.0));
                }
            }
        }
        let heights = bodies.iter().map(|own| {
            Heights::of(&own.solid.surface()).highest()
                + own.lay.as_ref().map_or(0.0, |lay| lay.step)
        });
        let all: f64 = heights.sum();
        let highest = self.fronts.iter().map(Heights::highest).fold(0.0, f64::max);
        lie.excess = highest / all;
        lie
    }
}

/// How the bodies of generated stacks lie on one another, all together, and the greatest excess.
fn lie_of(layers: impl Strategy<Value = Vec<Drawn>>, stacks: usize) -> Lie {
    let mut runner = TestRunner::deterministic();
    let mut all = Lie::default();
    let mut left = stacks;
    while left > 0 {
        let layers = layers.new_tree(&mut runner).expect("it has values");
        let Some(bodies) = stack(&layers.current(), 1.0, false) else {
            continue;
        };
        left -= 1;
        let lie = Made::new(bodies).lie();
        all.points += lie.points;
        all.high += lie.high;
        all.under += lie.under;
        all.of_details += lie.of_details;
        all.gaps += lie.gaps;
        all.excess = all.excess.max(lie.excess);
    }
    all
}

#[test]
fn stacks_are_as_deep_as_they_should_be() {
    let lie = lie_of(ellipses(), 12);
    assert!(lie.points > 20_000 && lie.of_details > 10_000, "{lie:?}");
    assert!(lie.under * 1000 < lie.points, "{lie:?}");
    assert!(lie.high * 25 < lie.points, "{lie:?}");
    assert!(lie.gaps * 50 < lie.of_details, "{lie:?}");
    assert!(lie.excess <= 1.0, "{lie:?}");
}

#[test]
fn wild_stacks_have_no_spikes() {
    let lie = lie_of(drawn(), 8);
    assert!(lie.points > 4_000 && lie.of_details > 1_000, "{lie:?}");
    assert!(lie.under * 200 < lie.points, "{lie:?}");
    assert!(lie.high * 6 < lie.points, "{lie:?}");
    assert!(lie.excess <= 1.0, "{lie:?}");
}

/// A layer on the axis, or a pair of layers beside it.
fn symmetric() -> impl Strategy<Value = Vec<Vec<(DVec2, DVec2, f64)>>> {
    let on_axis = (0.1..0.7f64, 0.1..0.7f64, -0.4..0.4f64)
        .prop_map(|(rx, ry, y)| vec![(DVec2::new(rx, ry), DVec2::new(0.0, y), 0.0)]);
    let pair = (
        0.05..0.2f64,
        0.05..0.2f64,
        0.25..0.6f64,
        -0.4..0.4f64,
        0.0..3.2f64,
    )
        .prop_map(|(rx, ry, x, y, turn)| {
            let side = |sign: f64| (DVec2::new(rx, ry), DVec2::new(sign * x, y), sign * turn);
            vec![side(1.0), side(-1.0)]
        });
    prop::collection::vec(prop_oneof![on_axis, pair], 2..5)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: config().cases / 8, ..config() })]

    #[test]
    fn symmetric_stacks_stay_symmetric(layers in symmetric()) {
        let step = 0.004;
        let head = (DVec2::new(0.8, 1.0), DVec2::ZERO, 0.0);
        let all = std::iter::once(head).chain(layers.into_iter().flatten());
        let bodies = all.enumerate().map(|(index, (radii, at, turn))| Body {
            is_detail: index > 0,
            lay: (index > 0).then(|| Lay {
                clips: true,
                step,
                bulge: 0.3,
                ..lay(LayForm::Skin, index)
            }),
            ..body(solid(moved(outline(vec![ellipse(radii, turn)]), at), profile("inflate", &[])))
        });
        let made = Made::new(bodies.collect());
        let front = |at: DVec2| made.fronts.iter().filter_map(|front| front.at(at)).reduce(f64::max);
        let [mut points, mut apart] = [0, 0];
        for at in over(&made.pile.bodies[0].solid.outline) {
            if let (Some(here), Some(there)) = (front(at), front(at * DVec2::new(-1.0, 1.0))) {
                points += 1;
                apart += usize::from((here - there).abs() > 3.0 * step);
            }
        }
        prop_assert!(points > 800 && apart * 20 < points, "{apart} of {points} points");
    }
}
