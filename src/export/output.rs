//! Where exporters write.

use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};

/// The size of the write buffer in bytes; larger pieces, as in models, bypass it.
const BUFFER: usize = 16 << 10;
/// How much data waits in memory for its head, in bytes. A head with less data is never padded.
const MAX_IN_MEMORY: usize = 1 << 20;

/// A file that is written from front to back, or data first if its head is known only after the data: a GLB begins with
/// the JSON that describes its data.
pub trait Output: Write + Send {
    /// Leaves space for a head at the start of the file, which is still empty; the data is written next. The estimate of
    /// the head's length in bytes can be wrong, but data behind a head that is longer has to be moved.
    fn reserve_head(&mut self, estimate: u64);

    /// Ends the data; the head is written last. Returns how long it must be: `length`, or more if more was reserved.
    ///
    /// # Errors
    /// Those of the file.
    fn start_head(&mut self, length: u64) -> io::Result<u64>;
}

/// An output to a file. In memory the file is a [`Cursor`](io::Cursor).
#[derive(Debug)]
pub struct SeekableOutput<F: Write> {
    out: BufWriter<F>,
    reserved: u64,
    /// The data, while there is little of it.
    data: Vec<u8>,
    /// Whether `data` takes what is written.
    in_memory: bool,
}

impl<F: Write> SeekableOutput<F> {
    /// Writes to an empty file.
    pub fn new(file: F) -> Self {
        Self {
            out: BufWriter::with_capacity(BUFFER, file),
            reserved: 0,
            data: Vec::new(),
            in_memory: false,
        }
    }

    /// Writes what is still in memory, and returns the file.
    ///
    /// # Errors
    /// Those of the file.
    pub fn finish(mut self) -> io::Result<F> {
        self.out.write_all(&self.data)?;
        Ok(self.out.into_inner()?)
    }
}

impl<F: Write + Seek> Write for SeekableOutput<F> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.in_memory {
            if self.data.len() + bytes.len() <= MAX_IN_MEMORY {
                return self.data.write(bytes);
            }
            self.in_memory = false;
            self.out.seek(SeekFrom::Start(self.reserved))?;
            self.out.write_all(&std::mem::take(&mut self.data))?;
        }
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl<F: Read + Write + Seek + Send> Output for SeekableOutput<F> {
    fn reserve_head(&mut self, estimate: u64) {
        self.reserved = estimate;
        self.in_memory = true;
    }

    fn start_head(&mut self, length: u64) -> io::Result<u64> {
        if std::mem::take(&mut self.in_memory) {
            return Ok(length);
        }
        if length > self.reserved {
            // The last block is moved first, so that none is overwritten before it is read.
            let mut end = self.out.seek(SeekFrom::End(0))?;
            while end > self.reserved {
                let mut block = vec![0; MAX_IN_MEMORY.min((end - self.reserved) as usize)];
                end = self.out.seek(SeekFrom::Start(end - block.len() as u64))?;
                self.out.get_mut().read_exact(&mut block)?;
                self.out
                    .seek(SeekFrom::Start(end + length - self.reserved))?;
                self.out.write_all(&block)?;
            }
        }
        self.out.rewind()?;
        Ok(length.max(self.reserved))
    }
}
