//! The numbers of a chunk's tiles, one after another, without ever holding all of them: a short text may stand for very many.

use std::io::{BufReader, ErrorKind, Read};

use base64::engine::general_purpose::STANDARD;
use base64::read::DecoderReader;
use flate2::read::{GzDecoder, ZlibDecoder};
use ruzstd::decoding::StreamingDecoder;

use super::TiledError;
use super::document::{Chunk, Compression, Data, Encoding, short};

/// The largest window of zstd, bytes: that of its highest usual level is a quarter of it.
const MAX_WINDOW: u64 = 32 << 20;

impl Chunk {
    /// Whether it has no tiles, as every layer of an infinite map at first.
    pub(super) fn is_blank(&self) -> bool {
        match &self.data {
            Data::Numbers(numbers) => numbers.is_empty(),
            Data::Text(_, text) => text.trim().is_empty(),
        }
    }

    /// Calls `each` with the numbers of its `count` tiles, row by row.
    ///
    /// # Errors
    /// What is wrong with them; those of `each`.
    pub(super) fn each(
        &self,
        count: usize,
        mut each: impl FnMut(usize, u32) -> Result<(), TiledError>,
    ) -> Result<(), TiledError> {
        match &self.data {
            Data::Numbers(numbers) => {
                check_count(numbers.len(), count)?;
                let mut numbers = numbers.iter().enumerate();
                numbers.try_for_each(|(at, number)| each(at, *number))
            }
            Data::Text(Encoding::Csv, text) => {
                let mut found = 0;
                for written in text.trim().trim_end_matches(',').split(',') {
                    let written = written.trim();
                    let number = written
                        .parse()
                        .map_err(|_| TiledError::number("data", written))?;
                    if found < count {
                        each(found, number)?;
                    }
                    found += 1;
                }
                check_count(found, count)
            }
            Data::Text(Encoding::Base64(compression), text) => {
                let packed: Vec<u8> = text
                    .bytes()
                    .filter(|byte| !byte.is_ascii_whitespace())
                    .collect();
                let bytes = DecoderReader::new(packed.as_slice(), &STANDARD);
                match compression {
                    Compression::None => four_by_four(bytes, count, each),
                    Compression::Zlib => four_by_four(ZlibDecoder::new(bytes), count, each),
                    Compression::Gzip => four_by_four(GzDecoder::new(bytes), count, each),
                    Compression::Zstd => {
                        let decoder = StreamingDecoder::new_with_max_window_size(bytes, MAX_WINDOW)
                            .map_err(|error| TiledError::Broken(error.to_string()))?;
                        four_by_four(decoder, count, each)
                    }
                }
            }
        }
    }
}

fn check_count(found: usize, count: usize) -> Result<(), TiledError> {
    if found == count {
        return Ok(());
    }
    let message = format!("a layer has {found} numbers of tiles where its size is {count}");
    Err(TiledError::Broken(message))
}

/// Reads numbers of four bytes.
fn four_by_four(
    bytes: impl Read,
    count: usize,
    mut each: impl FnMut(usize, u32) -> Result<(), TiledError>,
) -> Result<(), TiledError> {
    let mut bytes = BufReader::new(bytes);
    let mut number = [0; 4];
    for at in 0..count {
        match bytes.read_exact(&mut number) {
            Ok(()) => each(at, u32::from_le_bytes(number))?,
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                return check_count(at, count);
            }
            Err(error) => return Err(unreadable(&error)),
        }
    }
    match bytes.read(&mut number) {
        Ok(0) => Ok(()),
        Ok(_) => {
            let message = format!("a layer has more numbers of tiles than its size, {count}");
            Err(TiledError::Broken(message))
        }
        Err(error) => Err(unreadable(&error)),
    }
}

fn unreadable(error: &std::io::Error) -> TiledError {
    let reason = short(&error.to_string());
    TiledError::Broken(format!("the tiles of a layer cannot be decoded: {reason}"))
}
