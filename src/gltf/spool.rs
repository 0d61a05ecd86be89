//! A GLB's binary chunk comes behind its JSON, but the JSON says where everything in it lies.
//!
//! A small chunk waits in memory until the JSON is known. A large one is written at once, behind a gap that the
//! JSON fits into for certain; the rest of the gap becomes the white space that the format allows there.

use std::io::{self, Seek, SeekFrom, Write};

use super::invalid;

/// How much waits in memory, bytes.
const PATIENCE: usize = 64 << 20;
/// The file's header and that of the first chunk.
const HEADERS: u64 = 20;
/// The header of the second chunk.
const CHUNK_HEADER: u64 = 8;

/// A GLB that is being written.
pub(super) struct Spool<'a, W: ?Sized> {
    out: &'a mut W,
    waiting: Vec<u8>,
    length: u64,
    /// The length of the gap.
    room: u64,
    /// Where the file begins, once data has been written behind the gap.
    begun: Option<u64>,
}

impl<'a, W: Write + Seek + ?Sized> Spool<'a, W> {
    /// A file whose JSON takes at most `room` bytes.
    pub(super) fn new(out: &'a mut W, room: u64) -> Self {
        Self {
            out,
            waiting: Vec::new(),
            length: 0,
            room: room.next_multiple_of(4),
            begun: None,
        }
    }

    /// Appends to the binary chunk.
    pub(super) fn push(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.length += bytes.len() as u64;
        if self.begun.is_some() {
            return self.out.write_all(bytes);
        }
        if self.waiting.len() + bytes.len() <= PATIENCE {
            self.waiting.extend_from_slice(bytes);
            return Ok(());
        }
        let start = self.out.stream_position()?;
        self.begun = Some(start);
        self.out
            .seek(SeekFrom::Start(start + HEADERS + self.room + CHUNK_HEADER))?;
        self.out.write_all(&std::mem::take(&mut self.waiting))?;
        self.out.write_all(bytes)
    }

    /// Puts the JSON in front.
    pub(super) fn finish(self, mut json: Vec<u8>) -> io::Result<()> {
        let padded = match self.begun {
            Some(_) => self.room,
            None => json.len().next_multiple_of(4) as u64,
        };
        if json.len() as u64 > padded {
            return Err(invalid(
                "the model's description is longer than was reckoned with",
            ));
        }
        json.resize(padded as usize, b' ');
        let data_chunk = if self.length == 0 {
            0
        } else {
            CHUNK_HEADER + self.length
        };
        let total = HEADERS + padded + data_chunk;
        let total = u32::try_from(total).map_err(|_| {
            invalid(format!(
                "the model takes {total} bytes, but a .glb file ends at 4 GiB; write .gltf instead"
            ))
        })?;
        if let Some(start) = self.begun {
            self.out.seek(SeekFrom::Start(start))?;
        }
        self.out.write_all(b"glTF")?;
        self.out.write_all(&2_u32.to_le_bytes())?;
        self.out.write_all(&total.to_le_bytes())?;
        self.out.write_all(&(padded as u32).to_le_bytes())?;
        self.out.write_all(b"JSON")?;
        self.out.write_all(&json)?;
        if self.length > 0 {
            self.out.write_all(&(self.length as u32).to_le_bytes())?;
            self.out.write_all(b"BIN\0")?;
            self.out.write_all(&self.waiting)?;
        }
        if let Some(start) = self.begun {
            self.out.seek(SeekFrom::Start(start + u64::from(total)))?;
        }
        Ok(())
    }
}
