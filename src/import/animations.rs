//! Clips: glTF's animations, read completely and sampled one pose at a time.

use crate::math;
use std::collections::BTreeMap;
use std::sync::Arc;

use ::gltf::animation::util::ReadOutputs;
use ::gltf::animation::{Channel, Interpolation, Property};
use ::gltf::json::validation::Checked;
use ::gltf::{Accessor, Animation, Document};
use glam::{DMat4, DQuat, DVec3, DVec4};

use super::buffers::{Buffers, F32, I8, I16, SCALAR, U8, U16, VEC3, VEC4};
use super::pose::Pose;
use super::{ImportError, NodeId, id, malformed};

/// The largest number of keys in a file; those of an accessor count once for each channel that uses it.
pub(crate) const MAX_KEYS: usize = 32 << 20;

/// An animation of nodes.
#[derive(Debug)]
pub struct Clip {
    /// Its name, empty if it has none.
    pub name: String,
    /// Its length: up to its last key.
    pub seconds: f64,
    /// In the order of the nodes.
    animated: Vec<AnimatedNode>,
}

/// The tracks of one node. A property without a track keeps its rest value.
#[derive(Debug)]
struct AnimatedNode {
    node: NodeId,
    rest: (DVec3, DQuat, DVec3),
    translation: Option<Curve<3>>,
    rotation: Option<Curve<4>>,
    scale: Option<Curve<3>>,
    /// For each morph target its weight.
    weights: Vec<Curve<1>>,
}

/// Keys of one property.
#[derive(Debug)]
struct Curve<const N: usize> {
    /// Key times in seconds, ascending, never empty.
    times: Arc<[f32]>,
    interpolation: Interpolation,
    /// One row for each key; for cubic splines three: in-tangent, value, out-tangent.
    rows: Vec<[f32; N]>,
}

impl Clip {
    /// The pose at a time, in seconds from the beginning: `rest` with the clip's nodes moved. Before the first key of a
    /// track its first value holds, after the last key its last.
    pub(crate) fn pose_at(&self, rest: &Pose, time: f64) -> Pose {
        let mut pose = rest.clone();
        for animated in &self.animated {
            let (mut translation, mut rotation, mut scale) = animated.rest;
            if let Some(curve) = &animated.translation {
                translation = curve.at(time, lerp).into();
            }
            if let Some(curve) = &animated.rotation {
                let turn = DQuat::from_array(curve.at(time, slerp));
                rotation = unit_quaternion(turn);
            }
            if let Some(curve) = &animated.scale {
                scale = curve.at(time, lerp).into();
            }
            if let Some(local) = pose.locals.get_mut(animated.node) {
                *local = DMat4::from_scale_rotation_translation(scale, rotation, translation);
            }
            if !animated.weights.is_empty()
                && let Some(weights) = pose.weights.get_mut(animated.node)
            {
                let at = |curve: &Curve<1>| curve.at(time, lerp)[0] as f32;
                *weights = animated.weights.iter().map(at).collect();
                pose.is_shaped[animated.node] = true;
            }
        }
        pose
    }

    /// Whether it animates a node.
    pub(crate) fn moves(&self, node: NodeId) -> bool {
        let find = self.animated.binary_search_by_key(&node, |one| one.node);
        find.is_ok()
    }

    /// The nodes that it moves from place to place.
    pub(crate) fn translated_nodes(&self) -> impl Iterator<Item = NodeId> {
        let moved = self.animated.iter().filter(|one| one.translation.is_some());
        moved.map(|one| one.node)
    }
}

/// The rotation of a quaternion of any length; the identity for length zero.
fn unit_quaternion(quaternion: DQuat) -> DQuat {
    if quaternion.length() > 0.0 {
        quaternion.normalize()
    } else {
        DQuat::IDENTITY
    }
}

fn lerp<const N: usize>(a: [f64; N], b: [f64; N], share: f64) -> [f64; N] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share)
}

/// Spherical interpolation along the shorter arc.
fn slerp(a: [f64; 4], b: [f64; 4], share: f64) -> [f64; 4] {
    let [a, b] = [a, b].map(|row| unit_quaternion(DQuat::from_array(row)));
    math::slerp(a, b, share).to_array()
}

impl<const N: usize> Curve<N> {
    /// The value at a time; `between` interpolates two rows.
    fn at(&self, time: f64, between: impl Fn([f64; N], [f64; N], f64) -> [f64; N]) -> [f64; N] {
        let row = |index: usize| self.rows[index].map(f64::from);
        let moment = |key: usize| f64::from(self.times[key]);
        let last = self.times.len() - 1;
        let before = |time: f64| {
            let after = self
                .times
                .partition_point(|moment| f64::from(*moment) <= time);
            after.checked_sub(1)
        };
        match self.interpolation {
            // Key times have single precision: a caller that asks for a key's own time must not get the key before it.
            Interpolation::Step => row(before(time + key_tolerance(time)).unwrap_or(0)),
            Interpolation::Linear => match before(time) {
                None => row(0),
                Some(key) if key == last => row(last),
                Some(key) => {
                    let span = moment(key + 1) - moment(key);
                    between(row(key), row(key + 1), (time - moment(key)) / span)
                }
            },
            Interpolation::CubicSpline => match before(time) {
                None => row(1),
                Some(key) if key == last => row(3 * last + 1),
                Some(key) => {
                    let span = moment(key + 1) - moment(key);
                    let [start, out, into, end] =
                        [3 * key + 1, 3 * key + 2, 3 * key + 3, 3 * key + 4].map(row);
                    let weights = hermite((time - moment(key)) / span, span);
                    std::array::from_fn(|i| {
                        weights.dot(DVec4::new(start[i], out[i], end[i], into[i]))
                    })
                }
            },
        }
    }
}

/// How much earlier than a key a time may be that is meant as the key's own, in seconds.
fn key_tolerance(time: f64) -> f64 {
    1e-5 + time.abs() * 1e-6
}

/// The Hermite weights of the start, the tangent out of it, the end and the tangent into it (glTF 2.0, appendix C.5).
fn hermite(t: f64, span: f64) -> DVec4 {
    let (t2, t3) = (t * t, t * t * t);
    DVec4::new(
        2.0 * t3 - 3.0 * t2 + 1.0,
        span * (t3 - 2.0 * t2 + t),
        3.0 * t2 - 2.0 * t3,
        span * (t3 - t2),
    )
}

/// Reads all clips of a file.
///
/// # Errors
/// Missing nodes, accessors that do not match, times out of order, numbers that are not finite, too many keys.
pub(crate) fn read(document: &Document, buffers: &Buffers) -> Result<Vec<Clip>, ImportError> {
    check_targets(document)?;
    let channels = || document.animations().flat_map(|clip| clip.channels());
    let keys = channels()
        .map(|channel| channel.sampler().output().count())
        .fold(0_usize, usize::saturating_add);
    if keys > MAX_KEYS {
        return Err(ImportError::TooManyKeys(keys));
    }
    let mut reader = Reader {
        buffers,
        key_times: BTreeMap::new(),
    };
    document
        .animations()
        .map(|animation| reader.clip(&animation))
        .collect()
}

/// Checks channel targets, which the `gltf` crate takes for valid.
fn check_targets(document: &Document) -> Result<(), ImportError> {
    let nodes = document.nodes().len();
    for (index, animation) in document.as_json().animations.iter().enumerate() {
        for channel in &animation.channels {
            let node = channel.target.node.value();
            if node >= nodes {
                return Err(malformed(format!(
                    "animation {index} moves node {node}, which is not there"
                )));
            }
            if matches!(channel.target.path, Checked::Invalid) {
                return Err(malformed(format!(
                    "animation {index} changes a property of node {node} that nodes do not have"
                )));
            }
        }
    }
    Ok(())
}

struct Reader<'a> {
    buffers: &'a Buffers,
    /// Key times by accessor: channels share them.
    key_times: BTreeMap<usize, Arc<[f32]>>,
}

impl<'a> Reader<'a> {
    fn clip(&mut self, animation: &Animation<'a>) -> Result<Clip, ImportError> {
        let mut animated: BTreeMap<NodeId, AnimatedNode> = BTreeMap::new();
        let mut seconds = 0.0_f64;
        for channel in animation.channels() {
            let target = channel.target();
            let times = self.key_times(&channel)?;
            seconds = times
                .last()
                .map_or(seconds, |last| seconds.max(f64::from(*last)));
            let node = target.node();
            let animated = animated.entry(id(&node)).or_insert_with(|| {
                let (translation, rotation, scale) = node.transform().decomposed();
                let vector = |v: [f32; 3]| DVec3::from(v.map(f64::from));
                let rotation = DQuat::from_array(rotation.map(f64::from));
                AnimatedNode {
                    node: id(&node),
                    rest: (
                        vector(translation),
                        unit_quaternion(rotation),
                        vector(scale),
                    ),
                    translation: None,
                    rotation: None,
                    scale: None,
                    weights: Vec::new(),
                }
            });
            let twice = match target.property() {
                Property::Translation => {
                    let curve = self.curve(&channel, times)?;
                    animated.translation.replace(curve).is_some()
                }
                Property::Rotation => {
                    let curve = self.rotation_curve(&channel, times)?;
                    animated.rotation.replace(curve).is_some()
                }
                Property::Scale => {
                    let curve = self.curve(&channel, times)?;
                    animated.scale.replace(curve).is_some()
                }
                Property::MorphTargetWeights => {
                    let curves = self.weight_curves(&channel, times)?;
                    !std::mem::replace(&mut animated.weights, curves).is_empty()
                }
            };
            if twice {
                return Err(malformed(format!(
                    "animation {} has two channels for the same property of node {}",
                    animation.index(),
                    node.index()
                )));
            }
        }
        Ok(Clip {
            name: animation.name().unwrap_or_default().to_owned(),
            seconds,
            animated: animated.into_values().collect(),
        })
    }

    fn key_times(&mut self, channel: &Channel<'a>) -> Result<Arc<[f32]>, ImportError> {
        let input = channel.sampler().input();
        if let Some(times) = self.key_times.get(&input.index()) {
            return Ok(times.clone());
        }
        let times: Arc<[f32]> = self.buffers.list(&input, &[(F32, SCALAR)])?.collect();
        // Two keys may have the same time: a jump.
        let ascending = times.windows(2).all(|pair| pair[0] <= pair[1]);
        let numbers = times.iter().all(|time| time.is_finite());
        if times.is_empty() || !ascending || !numbers {
            return Err(malformed(format!(
                "the key times of animation {} are not in ascending order (accessor {})",
                channel.animation().index(),
                input.index()
            )));
        }
        self.key_times.insert(input.index(), times.clone());
        Ok(times)
    }

    /// The keys of a translation or scale.
    fn curve(&self, channel: &Channel<'a>, times: Arc<[f32]>) -> Result<Curve<3>, ImportError> {
        let output = channel.sampler().output();
        let rows: Vec<[f32; 3]> = self.buffers.list(&output, &[(F32, VEC3)])?.collect();
        curve(channel, &output, times, rows)
    }

    /// The keys of the weights of each morph target of the node's mesh.
    fn weight_curves(
        &self,
        channel: &Channel<'a>,
        times: Arc<[f32]>,
    ) -> Result<Vec<Curve<1>>, ImportError> {
        let output = channel.sampler().output();
        let types = [F32, I8, U8, I16, U16].map(|component| (component, SCALAR));
        self.buffers.check(&output, &types)?;
        let reader = channel.reader(|buffer| self.buffers.of(&buffer));
        let all: Vec<f32> = match reader.read_outputs() {
            Some(ReadOutputs::MorphTargetWeights(weights)) => weights.into_f32().collect(),
            _ => Vec::new(),
        };
        let mesh = channel.target().node().mesh();
        let primitives = mesh.and_then(|mesh| mesh.primitives().next());
        let targets = primitives.map_or(0, |primitive| primitive.morph_targets().count());
        let of = |target: usize| {
            let rows = all.iter().skip(target).step_by(targets.max(1));
            let rows = rows.map(|weight| [*weight]).collect();
            curve(channel, &output, times.clone(), rows)
        };
        (0..targets).map(of).collect()
    }

    fn rotation_curve(
        &self,
        channel: &Channel<'a>,
        times: Arc<[f32]>,
    ) -> Result<Curve<4>, ImportError> {
        let output = channel.sampler().output();
        let types = [F32, I8, U8, I16, U16].map(|component| (component, VEC4));
        self.buffers.check(&output, &types)?;
        let reader = channel.reader(|buffer| self.buffers.of(&buffer));
        let rows = match reader.read_outputs() {
            Some(ReadOutputs::Rotations(rotations)) => rotations.into_f32().collect(),
            _ => Vec::new(),
        };
        curve(channel, &output, times, rows)
    }
}

fn curve<const N: usize>(
    channel: &Channel<'_>,
    output: &Accessor<'_>,
    times: Arc<[f32]>,
    rows: Vec<[f32; N]>,
) -> Result<Curve<N>, ImportError> {
    let interpolation = channel.sampler().interpolation();
    let wanted = match interpolation {
        Interpolation::CubicSpline => times.len().saturating_mul(3),
        Interpolation::Linear | Interpolation::Step => times.len(),
    };
    let (clip, list) = (channel.animation().index(), output.index());
    if rows.len() != wanted {
        let found = rows.len();
        return Err(malformed(format!(
            "animation {clip} needs {wanted} keys, but accessor {list} has {found}"
        )));
    }
    if rows.as_flattened().iter().all(|number| number.is_finite()) {
        Ok(Curve {
            times,
            interpolation,
            rows,
        })
    } else {
        Err(malformed(format!(
            "accessor {list} of animation {clip} has a key that is not a number"
        )))
    }
}

#[cfg(test)]
mod tests;
