//! The law of fading: from 15° on, or half of the way to the other view, a region that only one view shows has no area.
//!
//! Where the corners of a model are is found from positions, morph targets and weights alone, as any program shows them.

use glam::{DVec2, DVec3, Vec3Swizzles as _};

use super::paints::drawing;
use crate::compile::{Options, compile};
use crate::resolver::MemoryResolver;
use crate::scene::{NodeId, Scene, Turn, Values, ViewDependent, ViewId};

/// Degrees from its view within which a region without a partner fades.
const FADE: f64 = 15.0;
/// What is smaller shows no pixels, metres: a character is several metres high.
const NOTHING: f64 = 1e-6;

/// How wide and high what a region shows is, metres. `weights` are those of the morph targets.
fn extent(scene: &Scene, node: NodeId, weights: &[f64]) -> DVec2 {
    let mesh = scene.nodes[node].mesh.map(|mesh| &scene.meshes[mesh]);
    let primitives = mesh.into_iter().flat_map(|mesh| &mesh.primitives);
    let mut found = DVec2::ZERO;
    for primitive in primitives {
        let surface = primitive.surface();
        assert_eq!(surface.targets.len(), weights.len());
        let corner = |index: usize| {
            let base = DVec3::from(surface.positions[index].map(f64::from));
            let moved = weights.iter().zip(&surface.targets);
            let moved =
                moved.map(|(weight, target)| DVec3::from(target[index].map(f64::from)) * *weight);
            (base + moved.sum::<DVec3>()).xy()
        };
        let corners = (0..surface.positions.len()).map(corner);
        let boxed = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        found = found.max(boxed.1 - boxed.0);
    }
    found
}

fn turn_of(scene: &Scene) -> &Turn {
    match &scene.nodes[scene.roots[0]].view_dependent {
        Some(ViewDependent::Turn(turn)) => turn,
        other => panic!("no character: {other:?}"),
    }
}

/// Looks at the regions of a character that only one view shows; returns how many there are.
fn check(seed: u64) -> usize {
    let (text, _) = drawing(seed);
    let compiled = compile(&text, &Options::default(), &MemoryResolver::default());
    let [character] = &compiled.characters[..] else {
        panic!("seed {seed}: {:?}", compiled.diagnostics);
    };
    let scene = &compiled.scene;
    let turn = turn_of(scene);
    let children = &scene.nodes[scene.roots[0]].children;
    let [from, to] = [ViewId::FIRST, ViewId::SECOND].map(|view| DVec2::from(turn.views[view]));
    let whole = (to - from).length();
    let fade = FADE.min(whole / 2.0) / whole;
    let mut alone = 0;
    for (region, node) in character.regions.iter().zip(children) {
        let shown = region.shapes.iter().map(Option::is_some);
        let [in_first, in_second] = shown.collect::<Vec<_>>()[..] else {
            panic!("two views");
        };
        if in_first && in_second {
            continue;
        }
        alone += 1;
        // How large it is so far from its view, as a share of the way to the other one.
        let size = |share: f64| {
            let [own, other] = if in_first { [from, to] } else { [to, from] };
            let weights = turn.weights(own.lerp(other, share).to_array());
            extent(scene, *node, &weights.raw[1..]).max_element()
        };
        let drawn = size(0.0);
        assert!(
            drawn > 100.0 * NOTHING,
            "seed {seed}, {}: {drawn}",
            region.name
        );
        let half = size(fade / 2.0);
        assert!(
            (half - drawn / 2.0).abs() < 0.01 * drawn,
            "seed {seed}, {}: {half} of {drawn}",
            region.name
        );
        for step in 0..=20 {
            let share = fade + (1.0 - fade) * f64::from(step) / 20.0;
            let left = size(share);
            assert!(
                left < NOTHING,
                "seed {seed}, {}: {left} at {share}",
                region.name
            );
        }
        // Nor does the clip show more between its keys.
        let clip = &scene.animations[0];
        let track = clip.tracks.iter().find_map(|track| match &track.values {
            Values::Weights(weights) if track.node == *node => Some((track, weights)),
            _ => None,
        });
        let (track, weights) = track.expect("a track");
        let end = f64::from(track.timing.times.last().copied().expect("times"));
        for (time, weights) in track.timing.times.iter().zip(weights) {
            let share = f64::from(*time) / end;
            let share = if in_first { share } else { 1.0 - share };
            let weights: Vec<f64> = weights.iter().copied().map(f64::from).collect();
            let left = extent(scene, *node, &weights).max_element();
            let is_far = share > fade - 1e-6;
            assert!(
                !is_far || left < NOTHING,
                "seed {seed}, {}: {left} at {time} s",
                region.name
            );
        }
        let is_key = |time: &f32| {
            let share = if in_first { fade } else { 1.0 - fade };
            (f64::from(*time) / end - share).abs() < 1e-6
        };
        assert!(track.timing.times.iter().any(is_key), "{:?}", track.timing);
    }
    // Without such regions nothing but the views is needed.
    assert!(alone > 0 || turn.views.len() == 2, "seed {seed}");
    alone
}

#[test]
fn what_one_view_shows_alone_is_gone_after_fifteen_degrees() {
    let alone: usize = (0..100).map(check).sum();
    assert!(alone > 60, "{alone}");
}
