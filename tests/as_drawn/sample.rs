//! A drawing whose parts are of one kind of `Shape`, and how its model looks.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use okoshi::FolderResolver;
use okoshi::compile::Compiled;
use okoshi::internals::bind::PartKind;
use okoshi::internals::look::{Look, compare};
use okoshi::internals::svg::ShapeId;
use okoshi::resolver::{MemoryResolver, Resolver};

use crate::common;
use crate::truth::{Agreement, agreement};

/// The larger side of the pictures, pixels.
const SIDE: u32 = 400;
/// Parts with fewer pixels in the drawing are not looked for.
const LEAST_PIXELS: usize = 40;
/// A part of which a smaller share is right is lost.
const LOST: f64 = 0.5;

/// A drawing whose parts are of one kind unless their own strings say otherwise, and how it looks.
pub(crate) struct Sample {
    compiled: Compiled,
    /// How the model agrees with resvg's picture.
    pub(crate) truth: Agreement,
    /// What `check --look` finds.
    look: Look,
}

impl Sample {
    /// Compares a drawing with its model, and both with resvg's picture under a style sheet; the reason if that is not possible.
    pub(crate) fn new(path: &Path, sheet: &str, kind: &str) -> Result<Self, String> {
        Self::read(path, |_| sheet.to_owned(), kind)
    }

    /// The same for a drawing that nobody has looked at, without the outlines that are not built, which `check` reports.
    pub(crate) fn without_outlines(path: &Path, kind: &str) -> Result<Self, String> {
        Self::read(path, without_outlines, kind)
    }

    fn read(path: &Path, sheet: impl Fn(&Compiled) -> String, kind: &str) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let resolver = FolderResolver::new(folder);
        Self::seen(&text, sheet, Some(folder), &resolver, kind, SIDE)
    }

    /// Compares a drawing without links with its model, in pictures whose larger side has so many pixels.
    pub(crate) fn of(text: &str, kind: &str, side: u32) -> Result<Self, String> {
        let sheet = |_: &Compiled| String::new();
        Self::seen(text, sheet, None, &MemoryResolver::default(), kind, side)
    }

    fn seen(
        text: &str,
        sheet: impl Fn(&Compiled) -> String,
        folder: Option<&Path>,
        resolver: &dyn Resolver,
        kind: &str,
        side: u32,
    ) -> Result<Self, String> {
        let end = text.rfind("</svg").ok_or("it has no end")?;
        let (before, after) = text.split_at(end);
        let string = format!(r#"<text x="-900" y="-900" font-size="5">%Shape {kind}</text>"#);
        let with_kind = format!("{before}{string}{after}");
        let compiled = common::compiled(&with_kind, resolver);
        if compiled.has_errors() {
            return Err(format!("{:?}", compiled.diagnostics));
        }
        let look = compare(&compiled, &with_kind, resolver, side);
        Ok(Self {
            look: look.map_err(|error| error.to_string())?,
            truth: agreement(&compiled, text, &sheet(&compiled), folder, resolver, side)?,
            compiled,
        })
    }

    /// The names of the parts that are lost.
    fn lost(&self) -> Vec<String> {
        let parts = self.look.parts.iter();
        let lost = parts.filter(|part| part.pixels > LEAST_PIXELS && part.share() < LOST);
        let Compiled {
            bindings, drawing, ..
        } = &self.compiled;
        lost.map(|part| bindings.describe(drawing, part.part))
            .collect()
    }

    /// Whether at least this share of the model looks like its drawing, and `check --look` says so too and misses no part.
    pub(crate) fn is_right(&self, least: f64) -> bool {
        self.truth.share() >= least
            && self.look.right_without_lines >= least
            && self.lost().is_empty()
    }

    /// A row of the table.
    pub(crate) fn row(&self, name: &str, kind: &str) -> String {
        let (truth, look, lost) = (self.truth, &self.look, self.lost());
        let mut row = format!(
            "{name:36} {kind:8} {:7.2} % of {:6} pixels; by itself {:7.2} % of {:6}, {:3} lost of {:3}",
            truth.share() * 100.0,
            truth.pixels,
            look.right_without_lines * 100.0,
            look.pixels,
            lost.len(),
            look.parts.len()
        );
        if !lost.is_empty() {
            let _ = write!(row, ": {}", lost[..lost.len().min(3)].join(", "));
        }
        row
    }
}

/// The style sheet that hides the strokes that are not built.
fn without_outlines(compiled: &Compiled) -> String {
    let parts = compiled.bindings.parts.iter();
    let built: HashSet<ShapeId> = parts
        .filter(|part| part.is_stroke && matches!(part.kind, PartKind::Main | PartKind::Sub))
        .map(|part| part.shape)
        .collect();
    let shapes = compiled.drawing.shapes.iter_enumerated();
    let hidden = shapes.filter(|(id, shape)| shape.stroke.is_some() && !built.contains(id));
    let ids = hidden.filter_map(|(_, shape)| shape.element.id.as_deref());
    ids.map(|id| format!("#{id} {{ stroke: none !important }}\n"))
        .collect()
}
