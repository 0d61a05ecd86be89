//! Animations: their keys in the buffer, and their JSON.
//!
//! All times lie together, and so do rotations, translations and weights, a buffer view each; tracks with equal times share one
//! accessor of them. Keys become bytes a chunk at a time, so that long motions are not in memory a second time.

use std::io;
use std::sync::Arc;

use ::gltf::json::animation::{
    Animation, Channel, Interpolation as JsonInterpolation, Property, Sampler, Target,
};
use ::gltf::json::validation::Checked::Valid;
use glam::{DQuat, DVec3};
use rustc_hash::FxHashMap;

use super::buffer::{BufferWriter, Kind};
use super::document::{index, name};
use crate::scene::{self, Interpolation, Scene, Timing, Values};

/// Keys that become bytes at a time.
const CHUNK: usize = 4096;

/// Writes the keys of all animations. Returns, per track in the order of the animations, the accessors of its times and
/// of its values.
pub(super) fn write_keys(scene: &Scene, out: &mut BufferWriter<'_>) -> io::Result<Vec<[usize; 2]>> {
    let tracks: Vec<&scene::Track> = scene.animations.iter().flat_map(|a| &a.tracks).collect();
    let (timings, numbers) = timings(&tracks);
    let mut times = Vec::with_capacity(timings.len());
    for timing in timings {
        let keys = &timing.times;
        let ends = keys.first().zip(keys.last());
        let bounds = ends.map(|(first, last)| [*first, *last].map(|time| [time, 0.0, 0.0]));
        times.push(out.accessor(Kind::Times, keys.len(), bounds));
        write_rows(keys, |time| [*time], out)?;
    }
    let mut accessors: Vec<[usize; 2]> = numbers.into_iter().map(|n| [times[n]; 2]).collect();
    for (track, [_, values]) in tracks.iter().zip(&mut accessors) {
        if let Values::Rotations(rotations) = &track.values {
            *values = out.accessor(Kind::Rotations, rotations.len(), None);
            write_rows(rotations, rotation, out)?;
        }
    }
    for (track, [_, values]) in tracks.iter().zip(&mut accessors) {
        if let Values::Translations(translations) = &track.values {
            *values = out.accessor(Kind::Translations, translations.len(), None);
            write_rows(translations, translation, out)?;
        }
    }
    for (track, [_, values]) in tracks.iter().zip(&mut accessors) {
        if let Values::Weights(weights) = &track.values {
            let weights: Vec<[f32; 1]> = weights.iter().flatten().map(|weight| [*weight]).collect();
            *values = out.accessor(Kind::TargetWeights, weights.len(), None);
            out.write_floats(&weights)?;
        }
    }
    Ok(accessors)
}

/// Writes a row of numbers for each of the items.
fn write_rows<T, const N: usize>(
    items: &[T],
    row: impl Fn(&T) -> [f32; N],
    out: &mut BufferWriter<'_>,
) -> io::Result<()> {
    let mut rows = Vec::with_capacity(items.len().min(CHUNK));
    for chunk in items.chunks(CHUNK) {
        rows.clear();
        rows.extend(chunk.iter().map(&row));
        out.write_floats(&rows)?;
    }
    Ok(())
}

fn rotation(rotation: &DQuat) -> [f32; 4] {
    rotation.normalize().as_quat().normalize().to_array()
}

fn translation(translation: &DVec3) -> [f32; 3] {
    translation.as_vec3().to_array()
}

/// The timings that differ in their times, and per track the index of its own among them.
///
/// Tracks that share a timing are found by its address. Others may have equal times, and the file must not depend on
/// which tracks share one.
fn timings<'a>(tracks: &[&'a scene::Track]) -> (Vec<&'a Timing>, Vec<usize>) {
    let mut different: Vec<&Timing> = Vec::new();
    let mut by_address: FxHashMap<*const Timing, usize> = FxHashMap::default();
    let mut by_times: FxHashMap<&[u32], usize> = FxHashMap::default();
    let numbers = tracks.iter().map(|track| {
        *by_address
            .entry(Arc::as_ptr(&track.timing))
            .or_insert_with(|| {
                let times = bytemuck::cast_slice(&track.timing.times);
                *by_times.entry(times).or_insert_with(|| {
                    different.push(&track.timing);
                    different.len() - 1
                })
            })
    });
    let numbers = numbers.collect();
    (different, numbers)
}

/// An animation, with the accessors of its tracks.
pub(super) fn animation(animation: &scene::Animation, accessors: &[[usize; 2]]) -> Animation {
    let channel = |(sampler, track): (usize, &scene::Track)| Channel {
        sampler: index(sampler),
        target: Target {
            node: index(track.node),
            path: Valid(match track.values {
                Values::Rotations(_) => Property::Rotation,
                Values::Translations(_) => Property::Translation,
                Values::Weights(_) => Property::MorphTargetWeights,
            }),
            extensions: None,
            extras: None,
        },
        extensions: None,
        extras: None,
    };
    let sampler = |(track, [times, values]): (&scene::Track, &[usize; 2])| Sampler {
        input: index(*times),
        interpolation: Valid(match track.timing.interpolation {
            Interpolation::Linear => JsonInterpolation::Linear,
            Interpolation::Step => JsonInterpolation::Step,
        }),
        output: index(*values),
        extensions: None,
        extras: None,
    };
    let tracks = &animation.tracks;
    Animation {
        name: name(&animation.name),
        channels: tracks.iter().enumerate().map(channel).collect(),
        samplers: tracks.iter().zip(accessors).map(sampler).collect(),
        extensions: None,
        extras: None,
    }
}
