//! Materials, shared by everything that looks alike.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::bind::{Look, Part, PartKind, SetBy, Sheet};
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::keyword::Keyword;
use crate::lang::value::ShapeKind;
use crate::scene::{AlphaMode, Material};
use crate::svg::{Drawing, PaintKey};

/// The materials of a drawing, and which part has which.
pub(super) struct Materials {
    list: Vec<Material>,
    of_part: Vec<Option<usize>>,
}

impl Materials {
    pub(super) fn collect(
        drawing: &Drawing,
        sheet: &Sheet,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut list = Vec::new();
        let mut known: FxHashMap<Vec<u64>, usize> = FxHashMap::default();
        let mut warned = FxHashSet::default();
        let mut of_part = Vec::with_capacity(sheet.parts.len());
        for (index, part) in sheet.parts.iter().enumerate() {
            let kind = sheet.shape(index).kind;
            if !matches!(part.kind, PartKind::Main | PartKind::Sub) || kind == ShapeKind::None {
                of_part.push(None);
                continue;
            }
            let paint = &part.paint(drawing).key;
            let own_paint = sheet
                .setting(index, Keyword::Color)
                .map_or(SetBy::Builtin, |source| source.from)
                == SetBy::Builtin;
            if (own_paint || matches!(paint, PaintKey::Picture(_))) && warned.insert(paint.clone())
            {
                diagnostics.extend(mean_color(drawing, part));
            }
            let look = sheet.look(drawing, index);
            let double_sided = matches!(kind, ShapeKind::Flat(_));
            let slot = known.entry(key(&look, double_sided)).or_insert_with(|| {
                list.push(material(&look, double_sided));
                list.len() - 1
            });
            of_part.push(Some(*slot));
        }
        Self { list, of_part }
    }

    /// The material of a part, if it has a solid.
    pub(super) fn of(&self, part: usize) -> Option<usize> {
        self.of_part[part]
    }

    pub(super) fn into_list(self) -> Vec<Material> {
        self.list
    }
}

/// Says that gradients, patterns and pictures appear in one colour.
fn mean_color(drawing: &Drawing, part: &Part) -> Option<Diagnostic> {
    let what = match &part.paint(drawing).key {
        PaintKey::Solid(_) => return None,
        PaintKey::Server(id) => format!("the gradient or pattern `#{id}`"),
        PaintKey::Picture(_) => "the picture".to_owned(),
    };
    Some(
        Diagnostic::new(
            Code::NotBuiltYet,
            drawing.shapes[part.shape].element.span,
            format!("{what} appears in the model as its mean colour"),
        )
        .help("`Color` sets another one"),
    )
}

fn key(look: &Look, double_sided: bool) -> Vec<u64> {
    let numbers = look
        .color
        .iter()
        .chain([&look.metallic, &look.roughness])
        .chain(&look.emissive);
    numbers
        .map(|number| number.to_bits())
        .chain([u64::from(double_sided)])
        .collect()
}

fn material(look: &Look, double_sided: bool) -> Material {
    let [r, g, b, alpha] = look.color;
    let byte = |channel: f64| (channel.clamp(0.0, 1.0) * 255.0).round() as u8;
    Material {
        name: format!("#{:02x}{:02x}{:02x}", byte(r), byte(g), byte(b)),
        base_color: [
            linear(r),
            linear(g),
            linear(b),
            alpha.clamp(0.0, 1.0) as f32,
        ],
        metallic: look.metallic as f32,
        roughness: look.roughness as f32,
        emissive: look.emissive.map(linear),
        alpha_mode: match alpha < 1.0 {
            true => AlphaMode::Blend,
            false => AlphaMode::Opaque,
        },
        double_sided,
        ..Material::default()
    }
}

/// A channel of sRGB in linear light (IEC 61966-2-1).
fn linear(channel: f64) -> f32 {
    let channel = channel.clamp(0.0, 1.0);
    let linear = if channel <= 0.040_45 {
        channel / 12.92
    } else {
        ((channel + 0.055) / 1.055).powf(2.4)
    };
    linear as f32
}
