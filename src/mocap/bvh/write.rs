//! Writes files in the layout that all readers accept: one keyword per line, braces on lines of their own, one line per frame.

use std::io;
use std::io::Write;

use glam::DVec3;
use rayon::prelude::*;
use typed_index_collections::{TiVec, ti_vec};

use crate::mocap::{Clip, Joint, JointId, Skeleton};

use super::MAX_NAME_BYTES;
use super::fields::CHANNELS;
use super::hierarchy::made_name;

/// How many levels are indented; deeper ones are not indented further, so that the size of a long chain of joints stays linear.
const INDENTED: usize = 40;

/// How many numbers a thread formats at once, and how many such portions are in memory at a time.
const PORTION: usize = 1 << 14;
const PORTIONS: usize = 32;

/// How many decimals are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Decimals {
    /// As many as needed to read the same double back, and no more.
    #[default]
    All,
    /// At most six, like capture systems: a millionth of a degree, or of the file's unit.
    Six,
}

/// Writes a clip as BVH.
///
/// With [`Decimals::All`], reading the result gives an equal clip if its joints are in depth-first order as in a file
/// (otherwise they and their channels are put into that order), if a file can hold its names (braces and control characters
/// become `_`, spaces at the ends and everything after [`MAX_NAME_BYTES`] bytes are removed, a joint without a name gets one),
/// and if reading accepts its numbers.
///
/// # Errors
/// Those of the output, and `InvalidData` for a number that is not finite.
pub fn write(
    clip: &Clip,
    decimals: Decimals,
    out: &mut (impl Write + Send + ?Sized),
) -> io::Result<()> {
    let frames: Vec<u32> = (0..clip.frames as u32).collect();
    write_frames(clip, &frames, decimals, out)
}

/// Writes a selection of a clip's frames, in this order, as [`write()`] writes all of them. Consecutive repetitions are
/// formatted once.
///
/// # Errors
/// Those of [`write()`].
pub(crate) fn write_frames(
    clip: &Clip,
    frames: &[u32],
    decimals: Decimals,
    out: &mut (impl Write + Send + ?Sized),
) -> io::Result<()> {
    let order = Order::of(&clip.skeleton);
    let mut head = Vec::new();
    hierarchy(&clip.skeleton, &order, decimals, &mut head)?;
    head.extend_from_slice(format!("MOTION\nFrames: {}\nFrame Time: ", frames.len()).as_bytes());
    number(clip.frame_time, Decimals::All, &mut head)?;
    head.push(b'\n');

    let width = clip.skeleton.channel_count().max(1);
    let rows = (PORTION / width).max(1);
    let columns = order.columns(&clip.skeleton);
    let portion = |frames: &[u32]| {
        let mut text = Vec::with_capacity(frames.len() * width * 11);
        for same in frames.chunk_by(|a, b| a == b) {
            let start = text.len();
            frame(
                clip.row(same[0] as usize),
                columns.as_deref(),
                decimals,
                &mut text,
            )?;
            let end = text.len();
            for _ in 1..same.len() {
                text.extend_from_within(start..end);
            }
        }
        Ok(text)
    };
    let mut done = vec![Ok(head)];
    let mut batches = frames.chunks(rows * PORTIONS);
    loop {
        let batch = batches.next();
        let next = || batch.map(|batch| batch.par_chunks(rows).map(portion).collect());
        // One batch is written while the next is formatted.
        let (written, next) = rayon::join(|| put(done, out), next);
        written?;
        match next {
            Some(next) => done = next,
            None => return Ok(()),
        }
    }
}

fn put(texts: Vec<io::Result<Vec<u8>>>, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    texts.into_iter().try_for_each(|text| out.write_all(&text?))
}

fn frame(
    row: &[f64],
    columns: Option<&[usize]>,
    decimals: Decimals,
    text: &mut Vec<u8>,
) -> io::Result<()> {
    for place in 0..row.len() {
        let column = columns
            .and_then(|columns| columns.get(place).copied())
            .unwrap_or(place);
        if place > 0 {
            text.push(b' ');
        }
        number(row.get(column).copied().unwrap_or(0.0), decimals, text)?;
    }
    text.push(b'\n');
    Ok(())
}

/// The joints in depth-first order, as they are nested in the text, each with its depth.
struct Order {
    joints: Vec<(JointId, usize)>,
}

impl Order {
    fn of(skeleton: &Skeleton) -> Self {
        let count = skeleton.joints.len();
        let mut children: TiVec<JointId, _> = ti_vec![Vec::new(); count];
        let mut left = Vec::new();
        for (id, joint) in skeleton.joints.iter_enumerated() {
            match joint.parent.filter(|parent| *parent < id) {
                Some(parent) => children[parent].push(id),
                None => left.push((id, 0)),
            }
        }
        left.reverse();
        let mut joints = Vec::with_capacity(count);
        while let Some((id, depth)) = left.pop() {
            joints.push((id, depth));
            let below = children[id].iter().rev();
            left.extend(below.map(|child| (*child, depth + 1)));
        }
        Self { joints }
    }

    /// Per number of a written frame the index of the clip's channel; `None` if the order is the same.
    fn columns(&self, skeleton: &Skeleton) -> Option<Vec<usize>> {
        let in_order = self.joints.iter().map(|(id, _)| *id);
        if in_order.eq(skeleton.joints.keys()) {
            return None;
        }
        let mut starts: TiVec<JointId, usize> = TiVec::with_capacity(skeleton.joints.len());
        let mut first = 0;
        for joint in &skeleton.joints {
            starts.push(first);
            first += joint.channels.len();
        }
        let numbers = |(id, _): &(JointId, usize)| {
            starts[*id]..starts[*id] + skeleton.joints[*id].channels.len()
        };
        Some(self.joints.iter().flat_map(numbers).collect())
    }
}

fn hierarchy(
    skeleton: &Skeleton,
    order: &Order,
    decimals: Decimals,
    text: &mut Vec<u8>,
) -> io::Result<()> {
    text.extend_from_slice(b"HIERARCHY\n");
    let mut open = 0;
    for (id, depth) in &order.joints {
        while open > *depth {
            open -= 1;
            line(text, open, "}");
        }
        let joint = &skeleton.joints[*id];
        let keyword = if *depth == 0 { "ROOT" } else { "JOINT" };
        line(text, *depth, &format!("{keyword} {}", name(joint, *id)));
        line(text, *depth, "{");
        offset(text, depth + 1, joint.offset, decimals)?;
        let mut channels = format!("CHANNELS {}", joint.channels.len());
        for channel in &joint.channels {
            let known = CHANNELS.iter().find(|(_, known)| known == channel);
            channels.push(' ');
            channels.push_str(known.map_or("", |(name, _)| name));
        }
        line(text, depth + 1, &channels);
        for end in &joint.ends {
            line(text, depth + 1, "End Site");
            line(text, depth + 1, "{");
            offset(text, depth + 2, *end, decimals)?;
            line(text, depth + 1, "}");
        }
        open = depth + 1;
    }
    while open > 0 {
        open -= 1;
        line(text, open, "}");
    }
    Ok(())
}

fn indent(text: &mut Vec<u8>, depth: usize) {
    text.extend(std::iter::repeat_n(b'\t', depth.min(INDENTED)));
}

fn line(text: &mut Vec<u8>, depth: usize, words: &str) {
    indent(text, depth);
    text.extend_from_slice(words.as_bytes());
    text.push(b'\n');
}

fn offset(text: &mut Vec<u8>, depth: usize, offset: DVec3, decimals: Decimals) -> io::Result<()> {
    indent(text, depth);
    text.extend_from_slice(b"OFFSET");
    for value in offset.to_array() {
        text.push(b' ');
        number(value, decimals, text)?;
    }
    text.push(b'\n');
    Ok(())
}

/// A joint's name in a form that the file can hold.
fn name(joint: &Joint, id: JointId) -> String {
    let clean = |c: char| {
        if c.is_control() || matches!(c, '{' | '}') {
            '_'
        } else {
            c
        }
    };
    let mut name: String = joint.name.chars().map(clean).collect();
    let mut long = name.len().min(MAX_NAME_BYTES);
    while !name.is_char_boundary(long) {
        long -= 1;
    }
    name.truncate(long);
    let name = name.trim_ascii();
    if name.is_empty() {
        made_name(id)
    } else {
        name.to_owned()
    }
}

/// Writes a number in its shortest form that reads back as the same double.
///
/// Written by hand because shortest-form libraries (`ryu`, `zmij`) have another notation and no limit of six decimals. A
/// decimal of up to 15 digits is the only one of its length that reads as its double, so a whole number of millionths that
/// reads back as the value is already the shortest form. That covers most of what capture systems write; the rest is left to
/// the standard library.
fn number(value: f64, decimals: Decimals, text: &mut Vec<u8>) -> io::Result<()> {
    const MILLION: f64 = 1e6;
    /// Below this, 15 digits hold all millionths.
    const EXACT: f64 = 1e15;

    if !value.is_finite() {
        let message = format!("a clip with the number {value} cannot be written");
        return Err(io::Error::new(io::ErrorKind::InvalidData, message));
    }
    let millionths = (value * MILLION).round();
    if millionths.abs() < EXACT && (decimals == Decimals::Six || millionths / MILLION == value) {
        let negative =
            millionths.is_sign_negative() && (millionths != 0.0 || decimals == Decimals::All);
        digits(millionths.abs() as u64, negative, text);
        return Ok(());
    }
    match value.abs() {
        1e-5..1e16 => write!(text, "{value}"),
        _ => write!(text, "{value:e}"),
    }
}

/// Writes millionths without trailing zeros.
fn digits(millionths: u64, negative: bool, text: &mut Vec<u8>) {
    let mut buffer = [0u8; 24];
    let mut at = buffer.len();
    let (mut left, mut decimals) = (millionths, 6);
    while decimals > 0 && left % 10 == 0 {
        left /= 10;
        decimals -= 1;
    }
    let mut put = |byte: u8| {
        at -= 1;
        buffer[at] = byte;
    };
    if decimals > 0 {
        for _ in 0..decimals {
            put(b'0' + (left % 10) as u8);
            left /= 10;
        }
        put(b'.');
    }
    loop {
        put(b'0' + (left % 10) as u8);
        left /= 10;
        if left == 0 {
            break;
        }
    }
    if negative {
        put(b'-');
    }
    text.extend_from_slice(&buffer[at..]);
}
