//! A GLB's binary chunk comes behind its JSON, but the JSON says where everything in it lies.
//!
//! A small chunk waits in memory until the JSON is known. A large one is written at once, behind a gap that the
//! JSON fits into for certain; the rest of the gap becomes the white space that the format allows there.

use std::io::{self, Seek, SeekFrom, Write};

use super::invalid;

/// How much waits in memory, bytes.
const PATIENCE: usize = 1 << 20;
/// How much of the JSON is gathered before it is written, bytes: it comes in small pieces.
const GATHERED: usize = 64 << 10;
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

    /// Puts the JSON in front, as `describe` writes it.
    pub(super) fn finish(
        self,
        describe: impl FnOnce(&mut Counted) -> io::Result<()>,
    ) -> io::Result<()> {
        match self.begun {
            None => self.finish_small(describe),
            Some(start) => self.finish_large(start, describe),
        }
    }

    fn finish_small(self, describe: impl FnOnce(&mut Counted) -> io::Result<()>) -> io::Result<()> {
        let mut json = Vec::new();
        let mut counted = Counted::new(&mut json);
        describe(&mut counted)?;
        counted.empty()?;
        json.resize(json.len().next_multiple_of(4), b' ');
        let total = total(json.len() as u64, self.length)?;
        head(self.out, total, json.len() as u64)?;
        self.out.write_all(&json)?;
        if self.length > 0 {
            chunk_head(self.out, self.length)?;
            self.out.write_all(&self.waiting)?;
        }
        Ok(())
    }

    fn finish_large(
        self,
        start: u64,
        describe: impl FnOnce(&mut Counted) -> io::Result<()>,
    ) -> io::Result<()> {
        let total = total(self.room, self.length)?;
        self.out.seek(SeekFrom::Start(start))?;
        head(self.out, total, self.room)?;
        let mut out = &mut *self.out;
        let mut json = Counted::new(&mut out);
        describe(&mut json)?;
        json.empty()?;
        let written = json.count;
        let Some(mut rest) = self.room.checked_sub(written) else {
            return Err(invalid(
                "the model's description is longer than was reckoned with",
            ));
        };
        const BLANKS: [u8; 4096] = [b' '; 4096];
        while rest > 0 {
            let some = rest.min(BLANKS.len() as u64);
            self.out.write_all(&BLANKS[..some as usize])?;
            rest -= some;
        }
        chunk_head(self.out, self.length)?;
        self.out.seek(SeekFrom::Start(start + u64::from(total)))?;
        Ok(())
    }
}

/// Gathers what is written, and counts it.
pub(super) struct Counted<'a> {
    out: &'a mut dyn Write,
    gathered: Vec<u8>,
    count: u64,
}

impl<'a> Counted<'a> {
    fn new(out: &'a mut dyn Write) -> Self {
        Self {
            out,
            gathered: Vec::with_capacity(GATHERED),
            count: 0,
        }
    }

    fn empty(&mut self) -> io::Result<()> {
        self.count += self.gathered.len() as u64;
        self.out.write_all(&self.gathered)?;
        self.gathered.clear();
        Ok(())
    }
}

impl Write for Counted<'_> {
    #[inline]
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes)?;
        Ok(bytes.len())
    }

    #[inline]
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.gathered.len() + bytes.len() > GATHERED {
            self.empty()?;
        }
        if bytes.len() > GATHERED {
            self.count += bytes.len() as u64;
            return self.out.write_all(bytes);
        }
        self.gathered.extend_from_slice(bytes);
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.empty()
    }
}

/// The length of the whole file.
fn total(json: u64, data: u64) -> io::Result<u32> {
    let total = HEADERS + json + if data == 0 { 0 } else { CHUNK_HEADER + data };
    u32::try_from(total).map_err(|_| {
        invalid(format!(
            "the model takes {total} bytes, but a .glb file ends at 4 GiB; write .gltf instead"
        ))
    })
}

fn head(out: &mut (impl Write + ?Sized), total: u32, json: u64) -> io::Result<()> {
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&total.to_le_bytes())?;
    out.write_all(&(json as u32).to_le_bytes())?;
    out.write_all(b"JSON")
}

fn chunk_head(out: &mut (impl Write + ?Sized), length: u64) -> io::Result<()> {
    out.write_all(&(length as u32).to_le_bytes())?;
    out.write_all(b"BIN\0")
}
