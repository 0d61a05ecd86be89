//! The text of the JSON. Long lists become text on all cores, so that a tree of them never exists.

use std::io::{self, Write};

use ::gltf::json::Root;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::{CompactFormatter, Formatter};

/// Elements that one thread turns into text at a time.
const CHUNK: usize = 1024;

/// The members of an object, in pieces: in one piece the text of a large model would be copied again and again as it grows.
pub(super) struct Json(Vec<Vec<u8>>);

impl Json {
    /// Starts with the members of `root`; the object is not closed.
    pub(super) fn new(root: &Root) -> io::Result<Self> {
        let mut text = Vec::new();
        write_value(&mut text, root)?;
        text.pop();
        Ok(Self(vec![text]))
    }

    /// Appends a list of those of `count` elements that exist, unless there are none: glTF has no empty arrays.
    pub(super) fn list<Id: From<usize>, T: Serialize>(
        &mut self,
        name: &str,
        count: usize,
        element: impl Fn(Id) -> Option<T> + Sync,
    ) -> io::Result<()> {
        let chunk = |start: usize| {
            let mut text = Vec::new();
            for element in (start..count.min(start + CHUNK)).filter_map(|id| element(id.into())) {
                text.push(b',');
                write_value(&mut text, &element)?;
            }
            text.shrink_to_fit();
            Ok(text)
        };
        let starts = (0..count).into_par_iter().step_by(CHUNK);
        let mut chunks = starts.map(chunk).collect::<io::Result<Vec<Vec<u8>>>>()?;
        chunks.retain(|text| !text.is_empty());
        if let Some(first) = chunks.first_mut() {
            first.splice(..1, format!(r#","{name}":["#).into_bytes());
            self.0.append(&mut chunks);
            self.push("]");
        }
        Ok(())
    }

    /// Appends text.
    pub(super) fn push(&mut self, text: impl Into<Vec<u8>>) {
        self.0.push(text.into());
    }

    /// Its length in bytes.
    pub(super) fn len(&self) -> u64 {
        self.0.iter().map(|text| text.len() as u64).sum()
    }

    pub(super) fn write_to(&self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        self.0.iter().try_for_each(|text| out.write_all(text))
    }
}

fn write_value(out: &mut Vec<u8>, value: &impl Serialize) -> io::Result<()> {
    let mut serializer = Serializer::with_formatter(out, ShortNumbers);
    Ok(value.serialize(&mut serializer)?)
}

/// Writes numbers in their shortest form that reads back as the same `f32`, without a fraction when whole.
struct ShortNumbers;

impl Formatter for ShortNumbers {
    fn write_f32<W: Write + ?Sized>(&mut self, out: &mut W, number: f32) -> io::Result<()> {
        if number.fract() == 0.0 && number.abs() < 1e6 {
            self.write_i32(out, number as i32)
        } else {
            CompactFormatter.write_f32(out, number)
        }
    }

    /// Numbers in a [`serde_json::Value`] are `f64`, but most of them were `f32`.
    fn write_f64<W: Write + ?Sized>(&mut self, out: &mut W, number: f64) -> io::Result<()> {
        match number as f32 {
            single if f64::from(single) == number => self.write_f32(out, single),
            _ => CompactFormatter.write_f64(out, number),
        }
    }
}
