//! Animations: their keys in the buffer, and what the JSON says of them.
//!
//! Moments lie together, so do turns and places, a buffer view each; tracks with equal moments share one list of them.
//! Keys become bytes a stretch at a time, so that long motions are not in memory a second time.

use std::io::{self, Write};
use std::sync::Arc;

use glam::{DQuat, DVec3};
use rustc_hash::FxHashMap;
use serde::Serialize;

use super::document::{Accessor, Bounds, FLOAT, Number};
use super::lists::list;
use super::packing::{Packed, View, floats};
use crate::scene::{self, Interpolation, Scene, Timing, Values};

/// Keys that become bytes at a time.
const STRETCH: usize = 4096;
/// Buffer views that animations take at most.
pub(super) const VIEWS: usize = 3;

/// Keys that were packed.
#[derive(Debug, Default)]
pub(super) struct Keys {
    /// The lists, in the order of their accessors.
    lists: Vec<List>,
    /// Per track, in the order of the animations, the numbers of the lists of its moments and of what is there then.
    tracks: Vec<[usize; 2]>,
}

/// A list of moments, turns or places.
#[derive(Debug, Clone, Copy)]
struct List {
    element: &'static str,
    /// Number of the view.
    view: usize,
    /// Where the list begins in its view.
    offset: u64,
    count: usize,
    /// The first moment and the last.
    bounds: Option<[f32; 2]>,
}

impl Keys {
    /// How many accessors there are.
    pub(super) fn accessors(&self) -> usize {
        self.lists.len()
    }

    /// One of the accessors.
    pub(super) fn accessor(&self, index: usize) -> Accessor {
        let List {
            element,
            view,
            offset,
            count,
            bounds,
        } = self.lists[index];
        let bound = |which: usize| bounds.map(|bounds| Bounds::Moment([Number(bounds[which])]));
        Accessor {
            buffer_view: view,
            byte_offset: offset,
            component_type: FLOAT,
            count,
            element,
            min: bound(0),
            max: bound(1),
            ..Accessor::default()
        }
    }
}

/// Writes the keys of all animations.
pub(super) fn store(
    scene: &Scene,
    packed: &mut Packed,
    write: &mut impl FnMut(&[u8]) -> io::Result<()>,
) -> io::Result<()> {
    let tracks: Vec<&scene::Track> = scene.animations.iter().flat_map(|a| &a.tracks).collect();
    let mut keys = Keys::default();

    let (timings, numbers) = timings(&tracks);
    let view = View::plain(packed);
    for timing in timings {
        let times = &timing.times;
        keys.lists.push(List {
            bounds: times.first().zip(times.last()).map(|(a, b)| [*a, *b]),
            ..packed.list(view, "SCALAR", times.len())
        });
        packed.store_rows(times, |time| [*time], write)?;
    }
    packed.close(view);

    keys.tracks = numbers.into_iter().map(|number| [number; 2]).collect();
    let view = View::plain(packed);
    for (track, of_track) in tracks.iter().zip(&mut keys.tracks) {
        if let Values::Rotations(turns) = &track.values {
            of_track[1] = keys.lists.len();
            keys.lists.push(packed.list(view, "VEC4", turns.len()));
            packed.store_rows(turns, turn, write)?;
        }
    }
    packed.close(view);

    let view = View::plain(packed);
    for (track, of_track) in tracks.iter().zip(&mut keys.tracks) {
        if let Values::Translations(places) = &track.values {
            of_track[1] = keys.lists.len();
            keys.lists.push(packed.list(view, "VEC3", places.len()));
            packed.store_rows(places, place, write)?;
        }
    }
    packed.close(view);
    packed.keys = keys;
    Ok(())
}

fn turn(turn: &DQuat) -> [f32; 4] {
    turn.normalize().as_quat().normalize().to_array()
}

fn place(place: &DVec3) -> [f32; 3] {
    place.as_vec3().to_array()
}

/// The timings that differ in their moments, and per track the number of its own among them.
///
/// Tracks that share a timing are told by its address; others may hold the same moments all the same, and the file must
/// not depend on who shares what.
fn timings<'a>(tracks: &[&'a scene::Track]) -> (Vec<&'a Timing>, Vec<usize>) {
    let mut different: Vec<&Timing> = Vec::new();
    let mut by_address: FxHashMap<*const Timing, usize> = FxHashMap::default();
    let mut by_moments: FxHashMap<&[u32], usize> = FxHashMap::default();
    let numbers = tracks.iter().map(|track| {
        *by_address
            .entry(Arc::as_ptr(&track.timing))
            .or_insert_with(|| {
                let moments = bytemuck::cast_slice(&track.timing.times);
                *by_moments.entry(moments).or_insert_with(|| {
                    different.push(&track.timing);
                    different.len() - 1
                })
            })
    });
    let numbers = numbers.collect();
    (different, numbers)
}

impl View {
    /// Begins a view of data that is no vertex's, and answers its number.
    fn plain(packed: &mut Packed) -> usize {
        packed.views.push(Self {
            kind: None,
            offset: packed.length,
            length: 0,
        });
        packed.views.len() - 1
    }
}

impl Packed {
    /// A list that begins where the buffer ends.
    fn list(&self, view: usize, element: &'static str, count: usize) -> List {
        List {
            element,
            view,
            offset: self.length - self.views[view].offset,
            count,
            bounds: None,
        }
    }

    /// Appends a row of numbers for each of the items.
    fn store_rows<T, const N: usize>(
        &mut self,
        items: &[T],
        row: impl Fn(&T) -> [f32; N],
        write: &mut impl FnMut(&[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut rows = Vec::with_capacity(items.len().min(STRETCH));
        let mut bytes = Vec::with_capacity(rows.capacity() * N * size_of::<f32>());
        for stretch in items.chunks(STRETCH) {
            rows.clear();
            bytes.clear();
            rows.extend(stretch.iter().map(&row));
            floats(&mut bytes, &rows);
            self.length += bytes.len() as u64;
            write(&bytes)?;
        }
        Ok(())
    }

    /// Ends the last view; one without data is none.
    fn close(&mut self, view: usize) {
        let length = self.length - self.views[view].offset;
        match length {
            0 => self.views.truncate(view),
            _ => self.views[view].length = length,
        }
    }
}

/// Writes the list of animations; `first` is the number of the first accessor of keys.
pub(super) fn write(
    scene: &Scene,
    packed: &Packed,
    first: usize,
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    if packed.keys.tracks.is_empty() {
        return Ok(());
    }
    let mut next = 0;
    let before: Vec<usize> = scene
        .animations
        .iter()
        .map(|animation| {
            let before = next;
            next += animation.tracks.len();
            before
        })
        .collect();
    list(
        out,
        "animations",
        scene.animations.len(),
        |range, elements| {
            for index in range {
                let animation = &scene.animations[index];
                // glTF has no empty arrays.
                if animation.tracks.is_empty() {
                    continue;
                }
                let numbers = &packed.keys.tracks[before[index]..];
                elements.push(&Animation::new(animation, numbers, first))?;
            }
            Ok(())
        },
    )
}

#[derive(Serialize)]
struct Animation<'a> {
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    channels: Vec<Channel>,
    samplers: Vec<Sampler>,
    extras: Extras,
}

#[derive(Serialize)]
struct Channel {
    sampler: usize,
    target: Target,
}

#[derive(Serialize)]
struct Target {
    node: usize,
    path: &'static str,
}

#[derive(Serialize)]
struct Sampler {
    input: usize,
    interpolation: &'static str,
    output: usize,
}

#[derive(Serialize)]
struct Extras {
    okoshi: Length,
}

#[derive(Serialize)]
struct Length {
    seconds: f64,
}

impl<'a> Animation<'a> {
    fn new(animation: &'a scene::Animation, numbers: &[[usize; 2]], first: usize) -> Self {
        let channel = |(sampler, track): (usize, &scene::Track)| Channel {
            sampler,
            target: Target {
                node: track.node,
                path: match track.values {
                    Values::Rotations(_) => "rotation",
                    Values::Translations(_) => "translation",
                },
            },
        };
        let sampler = |(track, [input, output]): (&scene::Track, &[usize; 2])| Sampler {
            input: first + input,
            interpolation: match track.timing.interpolation {
                Interpolation::Linear => "LINEAR",
                Interpolation::Step => "STEP",
            },
            output: first + output,
        };
        let tracks = &animation.tracks;
        Self {
            name: &animation.name,
            channels: tracks.iter().enumerate().map(channel).collect(),
            samplers: tracks.iter().zip(numbers).map(sampler).collect(),
            extras: Extras {
                okoshi: Length {
                    seconds: animation.seconds,
                },
            },
        }
    }
}

/// More bytes than the JSON of the animations takes; their accessors are not counted.
pub(super) fn room(scene: &Scene) -> io::Result<usize> {
    /// No length that is written takes more characters.
    const LONGEST: f64 = -1.234_567_890_123_456_7e-300;

    let longest = Animation {
        name: "",
        channels: vec![Channel {
            sampler: u32::MAX as usize,
            target: Target {
                node: u32::MAX as usize,
                path: "translation",
            },
        }],
        samplers: vec![Sampler {
            input: u32::MAX as usize,
            interpolation: "LINEAR",
            output: u32::MAX as usize,
        }],
        extras: Extras {
            okoshi: Length { seconds: LONGEST },
        },
    };
    // A name, and a comma behind each element.
    let longest = serde_json::to_vec(&longest)?.len() + r#""name":"",,,,"#.len();
    let of = |animation: &scene::Animation| {
        super::room::text(&animation.name) + longest * animation.tracks.len().max(1)
    };
    Ok(r#","animations":[]"#.len() + scene.animations.iter().map(of).sum::<usize>())
}
