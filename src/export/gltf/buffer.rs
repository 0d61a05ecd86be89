//! The layout of the buffer: what is written gets its views and accessors here.

use std::io;

use ::gltf::json::accessor::{Accessor as JsonAccessor, ComponentType, GenericComponentType, Type};
use ::gltf::json::buffer::{Stride, Target, View as JsonView};
use ::gltf::json::validation::{Checked, USize64};
use ::gltf::json::{Index, Value};

/// A kind of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Positions,
    Normals,
    /// How far the vertices of a morph target are from the positions.
    Displacements,
    TexCoords,
    JointsU16,
    JointsU8,
    Weights,
    IndicesU32,
    IndicesU16,
    IndicesU8,
    InverseBindMatrices,
    Times,
    Rotations,
    Translations,
    /// The weights of morph targets at the keys of a clip.
    TargetWeights,
}

impl Kind {
    /// The kinds that primitives have. The order, widest components first, keeps every accessor aligned without padding.
    pub(super) const OF_PRIMITIVES: [Self; 10] = [
        Self::Positions,
        Self::Normals,
        Self::Displacements,
        Self::TexCoords,
        Self::JointsU16,
        Self::JointsU8,
        Self::Weights,
        Self::IndicesU32,
        Self::IndicesU16,
        Self::IndicesU8,
    ];

    /// The format of an element, and the target of a view of such elements.
    fn format(self) -> (ComponentType, Type, Option<Target>) {
        use ComponentType::{F32, U8, U16, U32};
        const VERTICES: Option<Target> = Some(Target::ArrayBuffer);
        const INDICES: Option<Target> = Some(Target::ElementArrayBuffer);
        match self {
            Self::Positions | Self::Normals | Self::Displacements => (F32, Type::Vec3, VERTICES),
            Self::TexCoords => (F32, Type::Vec2, VERTICES),
            Self::JointsU16 => (U16, Type::Vec4, VERTICES),
            Self::JointsU8 | Self::Weights => (U8, Type::Vec4, VERTICES),
            Self::IndicesU32 => (U32, Type::Scalar, INDICES),
            Self::IndicesU16 => (U16, Type::Scalar, INDICES),
            Self::IndicesU8 => (U8, Type::Scalar, INDICES),
            Self::InverseBindMatrices => (F32, Type::Mat4, None),
            Self::Times | Self::TargetWeights => (F32, Type::Scalar, None),
            Self::Rotations => (F32, Type::Vec4, None),
            Self::Translations => (F32, Type::Vec3, None),
        }
    }
}

/// A range of the buffer.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// The kind of its elements; `None` for an image.
    kind: Option<Kind>,
    offset: u64,
    length: u64,
}

/// Elements of one kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accessor {
    pub(super) kind: Kind,
    /// Index of the view.
    pub(super) view: usize,
    /// The offset in the view.
    pub(super) offset: u64,
    pub(super) count: usize,
    /// The least and greatest value of each component; of a scalar in the first place only.
    pub(super) bounds: Option<[[f32; 3]; 2]>,
}

/// The views and accessors of the buffer. The compact form matters: a large model has hundreds of thousands of them.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub(super) views: Vec<View>,
    pub(super) accessors: Vec<Accessor>,
    /// The length of the buffer.
    pub(super) length: u64,
}

/// Writes the buffer from front to back, and keeps its layout.
pub(super) struct BufferWriter<'a> {
    pub(super) layout: Layout,
    out: &'a mut Sink<'a>,
}

/// Takes the bytes of the buffer.
pub(super) type Sink<'a> = dyn FnMut(&[u8]) -> io::Result<()> + Send + 'a;

impl<'a> BufferWriter<'a> {
    pub(super) fn new(out: &'a mut Sink<'a>) -> Self {
        Self {
            layout: Layout::default(),
            out,
        }
    }

    /// Starts a view, and returns its index.
    pub(super) fn view(&mut self, kind: Option<Kind>) -> usize {
        self.layout.views.push(View {
            kind,
            offset: self.layout.length,
            length: 0,
        });
        self.layout.views.len() - 1
    }

    /// Adds an accessor for the elements that are written next, and returns its index. It shares the last view if that
    /// has elements of its kind.
    pub(super) fn accessor(
        &mut self,
        kind: Kind,
        count: usize,
        bounds: Option<[[f32; 3]; 2]>,
    ) -> usize {
        let last = self.layout.views.len().checked_sub(1);
        let last = last.filter(|last| self.layout.views[*last].kind == Some(kind));
        let view = last.unwrap_or_else(|| self.view(Some(kind)));
        self.layout.accessors.push(Accessor {
            kind,
            view,
            offset: self.layout.views[view].length,
            count,
            bounds,
        });
        self.layout.accessors.len() - 1
    }

    /// Appends to the last view.
    pub(super) fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.layout.length += bytes.len() as u64;
        if let Some(view) = self.layout.views.last_mut() {
            view.length += bytes.len() as u64;
        }
        (self.out)(bytes)
    }

    /// Appends rows of numbers.
    pub(super) fn write_floats<const N: usize>(&mut self, rows: &[[f32; N]]) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(size_of_val(rows));
        floats(&mut bytes, rows);
        self.write(&bytes)
    }

    /// Pads the buffer to a multiple of four.
    pub(super) fn pad(&mut self) -> io::Result<()> {
        let padding = self.layout.length.next_multiple_of(4) - self.layout.length;
        self.layout.length += padding;
        (self.out)(&[0; 3][..padding as usize])
    }
}

impl From<&View> for JsonView {
    fn from(view: &View) -> Self {
        let format = view.kind.map(Kind::format);
        let target = format.and_then(|(_, _, target)| target);
        // Accessors that share a view of vertices need its stride stated.
        let stride = format.filter(|_| target == Some(Target::ArrayBuffer));
        Self {
            buffer: Index::new(0),
            byte_length: USize64(view.length),
            byte_offset: (view.offset > 0).then_some(USize64(view.offset)),
            byte_stride: stride
                .map(|(component, element, _)| Stride(component.size() * element.multiplicity())),
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        }
    }
}

impl From<&Accessor> for JsonAccessor {
    fn from(accessor: &Accessor) -> Self {
        let (component, element, _) = accessor.kind.format();
        let bound = |which: usize| {
            let bounds = accessor.bounds?;
            Some(Value::from(&bounds[which][..element.multiplicity()]))
        };
        Self {
            buffer_view: Some(Index::new(accessor.view as u32)),
            byte_offset: (accessor.offset > 0).then_some(USize64(accessor.offset)),
            count: accessor.count.into(),
            component_type: Checked::Valid(GenericComponentType(component)),
            extensions: None,
            extras: None,
            type_: Checked::Valid(element),
            min: bound(0),
            max: bound(1),
            name: None,
            normalized: accessor.kind == Kind::Weights,
            sparse: None,
        }
    }
}

/// Appends numbers as little-endian bytes.
pub(super) fn floats<const N: usize>(out: &mut Vec<u8>, rows: &[[f32; N]]) {
    if cfg!(target_endian = "little") {
        out.extend_from_slice(bytemuck::cast_slice(rows.as_flattened()));
    } else {
        let numbers = rows.as_flattened().iter();
        out.extend(numbers.flat_map(|number| number.to_le_bytes()));
    }
}
