//! Buffers and accessors. The `gltf` crate reads accessors without checking that they fit; they are checked here first.

use std::sync::Arc;

use ::gltf::accessor::{DataType, Dimensions, Item, Iter};
use ::gltf::image::{Image, Source};
use ::gltf::{Accessor, Buffer, Document, buffer};
use base64::Engine as _;

use super::{ImportError, malformed};
use crate::resolver::Resolver;

pub(super) const F32: DataType = DataType::F32;
pub(super) const I8: DataType = DataType::I8;
pub(super) const U8: DataType = DataType::U8;
pub(super) const I16: DataType = DataType::I16;
pub(super) const U16: DataType = DataType::U16;
pub(super) const U32: DataType = DataType::U32;
pub(super) const SCALAR: Dimensions = Dimensions::Scalar;
pub(super) const VEC2: Dimensions = Dimensions::Vec2;
pub(super) const VEC3: Dimensions = Dimensions::Vec3;
pub(super) const VEC4: Dimensions = Dimensions::Vec4;
pub(super) const MAT4: Dimensions = Dimensions::Mat4;

pub(crate) struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    pub(super) fn read(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        resolver: &dyn Resolver,
    ) -> Result<Self, ImportError> {
        let read = |buffer: Buffer<'_>| match buffer.source() {
            buffer::Source::Bin => blob
                .take()
                .ok_or_else(|| malformed("the binary chunk is missing")),
            buffer::Source::Uri(uri) => Ok(fetch(uri, resolver)?.to_vec()),
        };
        document
            .buffers()
            .map(read)
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// The length of all buffers, bytes.
    pub(super) fn length(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    /// The bytes of a buffer.
    pub(super) fn of(&self, buffer: &Buffer<'_>) -> Option<&[u8]> {
        self.0.get(buffer.index()).map(Vec::as_slice)
    }

    fn view(&self, view: &buffer::View<'_>) -> Result<&[u8], ImportError> {
        let end = view.offset().checked_add(view.length());
        let bytes = end.and_then(|end| self.of(&view.buffer())?.get(view.offset()..end));
        bytes.ok_or_else(|| {
            malformed(format!(
                "buffer view {} is longer than its buffer",
                view.index()
            ))
        })
    }

    /// The encoded bytes of an image.
    ///
    /// # Errors
    /// An image without a source, or one whose source cannot be read.
    pub(crate) fn image(
        &self,
        document: &Document,
        image: &Image<'_>,
        resolver: &dyn Resolver,
    ) -> Result<Arc<[u8]>, ImportError> {
        let index = image.index();
        let source = &document.as_json().images[index];
        // The `gltf` crate panics if there is neither.
        let in_view = source.buffer_view.is_some() && source.mime_type.is_some();
        if !in_view && (source.buffer_view.is_some() || source.uri.is_none()) {
            let message =
                format!("image {index} has neither data with a media type nor an address");
            return Err(malformed(message));
        }
        match image.source() {
            Source::View { view, .. } => Ok(self.view(&view)?.into()),
            Source::Uri { uri, .. } => fetch(uri, resolver),
        }
    }

    /// Checks that an accessor has one of these types and lies in its buffer.
    pub(super) fn check(
        &self,
        accessor: &Accessor<'_>,
        types: &[(DataType, Dimensions)],
    ) -> Result<(), ImportError> {
        let name = accessor.index();
        let of_type = (accessor.data_type(), accessor.dimensions());
        if !types.contains(&of_type) {
            return Err(malformed(format!(
                "accessor {name} has a type that is not allowed where it is used"
            )));
        }
        let short = || malformed(format!("accessor {name} is longer than its buffer view"));
        let fits = |view: buffer::View<'_>, offset: usize, count: usize, size: usize| {
            let stride = view.stride().unwrap_or(size);
            let length = self.view(&view)?.len();
            let last = count
                .checked_sub(1)
                .and_then(|last| stride.checked_mul(last));
            let end = last.and_then(|last| last.checked_add(size)?.checked_add(offset));
            if stride >= size && end.is_some_and(|end| end <= length) {
                Ok(())
            } else {
                Err(short())
            }
        };
        match accessor.view() {
            Some(view) => fits(view, accessor.offset(), accessor.count(), accessor.size())?,
            // Without a view it is all zeros, of any count it claims.
            None if accessor.count() > super::MAX_TRIANGLES * 3 => return Err(short()),
            None => {}
        }
        if let Some(sparse) = accessor.sparse() {
            let indices = sparse.indices();
            fits(
                indices.view(),
                indices.offset(),
                sparse.count(),
                indices.index_type().size(),
            )?;
            let values = sparse.values();
            fits(
                values.view(),
                values.offset(),
                sparse.count(),
                accessor.size(),
            )?;
        }
        Ok(())
    }

    /// The items of an accessor that has one of these types.
    pub(super) fn list<'a, T: Item>(
        &'a self,
        accessor: &Accessor<'a>,
        types: &[(DataType, Dimensions)],
    ) -> Result<Iter<'a, T>, ImportError> {
        self.check(accessor, types)?;
        Iter::new(accessor.clone(), |buffer| self.of(&buffer))
            .ok_or_else(|| malformed(format!("accessor {} has no data", accessor.index())))
    }
}

/// The bytes at an address: a data URI, or a file beside this one.
fn fetch(uri: &str, resolver: &dyn Resolver) -> Result<Arc<[u8]>, ImportError> {
    let Some(data) = uri.strip_prefix("data:") else {
        return resolver.read(uri).map_err(|error| ImportError::Link {
            link: uri.to_owned(),
            error,
        });
    };
    let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
    let bytes =
        encoded.and_then(|text| base64::engine::general_purpose::STANDARD.decode(text).ok());
    bytes
        .map(Arc::from)
        .ok_or_else(|| malformed("data within an address is not base64"))
}
