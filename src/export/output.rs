//! Where exporters write.

use std::io::{self, Write};

/// A file that is written from front to back. Data that is known before what precedes it is set aside until then: a GLB
/// begins with the description of its data, whose offsets and bounds are known only when all of it has been made.
pub trait Output: Write + Send {
    /// Appends to the data that is set aside.
    ///
    /// # Errors
    /// Those of a temporary file.
    fn set_aside(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Writes all data that was set aside.
    ///
    /// # Errors
    /// Those of writing, and of a temporary file.
    fn append_set_aside(&mut self) -> io::Result<()>;
}

/// An output in memory.
#[derive(Debug, Clone, Default)]
pub struct InMemory {
    /// What has been written.
    pub bytes: Vec<u8>,
    aside: Vec<u8>,
}

impl Write for InMemory {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Output for InMemory {
    fn set_aside(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.aside.write_all(bytes)
    }

    fn append_set_aside(&mut self) -> io::Result<()> {
        let mut aside = std::mem::take(&mut self.aside);
        // The longer part stays in place, so that a large model is in memory once.
        if aside.len() > self.bytes.len() {
            aside.splice(0..0, self.bytes.drain(..));
            self.bytes = aside;
        } else {
            self.bytes.append(&mut aside);
        }
        Ok(())
    }
}
