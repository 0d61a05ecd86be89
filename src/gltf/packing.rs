//! The binary data: the scene's arrays, packed little-endian in the order of the layout.

use std::io::{self, Write};

use super::layout::{IndexType, Kind, kinds, written};
use crate::scene::Scene;

/// How much is packed before it is written.
const BATCH: usize = 64 * 1024;

/// Writes the whole buffer.
pub(super) fn pack(scene: &Scene, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut packer = Packer {
        batch: Vec::with_capacity(BATCH),
        out,
    };
    for kind in Kind::ALL {
        for primitive in written(scene) {
            let surface = &primitive.surface;
            if !kinds(surface).contains(&Some(kind)) {
                continue;
            }
            match kind {
                Kind::Positions => packer.put(&surface.positions, f32::to_le_bytes)?,
                Kind::Normals => packer.put(&surface.normals, f32::to_le_bytes)?,
                Kind::Uvs => packer.put(&surface.uvs, f32::to_le_bytes)?,
                // The layout chose the type so that every corner fits.
                Kind::Indices(IndexType::U8) => packer.put(&surface.triangles, |i| [i as u8])?,
                Kind::Indices(IndexType::U16) => {
                    packer.put(&surface.triangles, |i| (i as u16).to_le_bytes())?;
                }
                Kind::Indices(IndexType::U32) => {
                    packer.put(&surface.triangles, u32::to_le_bytes)?;
                }
            }
        }
    }
    packer.flush()
}

struct Packer<'a, W: ?Sized> {
    batch: Vec<u8>,
    out: &'a mut W,
}

impl<W: Write + ?Sized> Packer<'_, W> {
    fn put<T: Copy, const N: usize, const B: usize>(
        &mut self,
        rows: &[[T; N]],
        bytes: impl Fn(T) -> [u8; B],
    ) -> io::Result<()> {
        for rows in rows.chunks(BATCH / (N * B)) {
            if self.batch.len() + rows.len() * N * B > BATCH {
                self.flush()?;
            }
            for value in rows.as_flattened() {
                self.batch.extend_from_slice(&bytes(*value));
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.write_all(&self.batch)?;
        self.batch.clear();
        Ok(())
    }
}
