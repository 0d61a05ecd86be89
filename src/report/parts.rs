//! The parts of a drawing.

use std::collections::BTreeMap;

use serde::Serialize;

use super::joints::{Driver, drivers};
use super::reasons::Reasons;
use crate::compile::Compiled;
use crate::ide::{Subject, Which};
use crate::source::LineIndex;

/// A part. Coordinates are drawing units, y down.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Part<'a> {
    /// Its name.
    pub name: &'a str,
    /// Where its name is from: `string`, `label`, `id`, `automatic`; `None` for parts that are not in the hierarchy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub named_by: Option<&'static str>,
    /// The name of its parent; `None` for the root.
    pub parent: Option<&'a str>,
    /// `main`, `sub`, `legend`, `unused` or `prop`; in [`everything`] also `terrain`, `character` and `region`.
    pub kind: &'static str,
    /// For ink, the name of the part on which it lies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ink_on: Option<&'a str>,
    /// The `id` of its element.
    pub element: Option<&'a str>,
    /// Its string.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub string: Option<StringReport<'a>>,
    /// Where it is; `None` in [`everything`].
    #[serde(flatten)]
    pub place: Option<Place>,
    /// For a main part, how far its plane lies in front of the drawing's, drawing units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<f64>,
    /// Why it lies there; `None` for a part in the plane of what it hangs on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_why: Option<String>,
    /// What it shows from behind beside its own back; `None` for nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub back: Option<String>,
    /// What is done to its form without a string that says so; `None` for nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form: Option<String>,
    /// What undoes `depth_why`, `back` and `form` in a string, by these names.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub undo: BTreeMap<&'static str, &'static str>,
    /// All attributes that are set, and those that every solid has.
    pub attributes: BTreeMap<&'static str, AttributeReport>,
    /// The joint that drives it in the first clip that does.
    pub joint: Option<&'a str>,
    /// Why that joint, or why none; `None` for parts of figures without clips.
    pub joint_why: Option<&'a str>,
}

/// Where a part is. Coordinates are drawing units, y down.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Place {
    /// The centroid of its area.
    pub center: [f64; 2],
    /// The end points of its axis.
    pub ends: [[f64; 2]; 2],
    /// Its joint.
    pub origin: [f64; 2],
    /// The direction of its axis.
    pub axis: [f64; 2],
}

/// A string. Lines and columns count from 1, columns in characters.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct StringReport<'a> {
    /// Its line.
    pub line: usize,
    /// Its column.
    pub column: usize,
    /// Its characters.
    pub text: &'a str,
    /// The rule by which it is bound to its part.
    pub bound_by: &'static str,
    /// For an uncertain binding, the other shape that it may mean.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub may_mean: Option<String>,
}

/// An attribute.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct AttributeReport {
    /// Its value, variables resolved.
    pub value: String,
    /// `own`, `legend`, `default` or `builtin`.
    pub from: &'static str,
}

/// The parts of a drawing, in paint order.
pub(crate) fn parts<'a>(compiled: &'a Compiled, text: &'a str) -> Vec<Part<'a>> {
    let parts = Subject::all(compiled).filter_map(|subject| match subject.which {
        Which::Part(part) => Some((subject, &compiled.bindings.parts[part])),
        _ => None,
    });
    let (subjects, parts): (Vec<_>, Vec<_>) = parts.unzip();
    let mut reports = reports(compiled, text, subjects.into_iter());
    for (report, part) in reports.iter_mut().zip(parts) {
        let measure = part.node_measure();
        report.place = Some(Place {
            center: measure.center.to_array(),
            ends: measure.ends.map(|end| end.to_array()),
            origin: part.origin.to_array(),
            axis: measure.axis.to_array(),
        });
    }
    reports
}

/// The parts of a drawing, its landscapes, and its characters with their regions: everything in the model. Without their places, which
/// pages do not show: a part that only moved is the same.
pub(crate) fn everything<'a>(compiled: &'a Compiled, text: &'a str) -> Vec<Part<'a>> {
    reports(compiled, text, Subject::all(compiled))
}

fn reports<'a>(
    compiled: &'a Compiled,
    text: &str,
    subjects: impl Iterator<Item = Subject<'a>>,
) -> Vec<Part<'a>> {
    let (lines, drivers) = (LineIndex::new(text), drivers(compiled));
    let reasons = Reasons::new(compiled);
    let report = |subject: Subject<'a>| {
        let driver = match subject.which {
            Which::Part(part) => drivers[part],
            _ => None,
        };
        let string = string_report(compiled, subject, &lines);
        report(&reasons, compiled, subject, string, driver)
    };
    subjects.map(report).collect()
}

fn report<'a>(
    reasons: &Reasons<'a>,
    compiled: &'a Compiled,
    subject: Subject<'a>,
    string: Option<StringReport<'a>>,
    driver: Option<Driver<'a>>,
) -> Part<'a> {
    let (depth, said) = match subject.which {
        Which::Part(part) => (
            compiled.depths[part].map(|node| node.depth),
            [reasons.depth(part), reasons.back(part), reasons.form(part)],
        ),
        _ => (None, [None, None, None]),
    };
    let undo = ["depth_why", "back", "form"].into_iter().zip(&said);
    let undo = undo.filter_map(|(name, said)| Some((name, said.as_ref()?.undo?.string())));
    let undo = undo.collect();
    let [depth_why, back, form] = said.map(|said| said.map(|said| said.text));
    let attributes = subject.attributes().into_iter().map(|attribute| {
        let report = AttributeReport {
            value: attribute.value,
            from: attribute.from.name(),
        };
        (attribute.keyword.name(), report)
    });
    Part {
        name: subject.name(),
        named_by: subject.named_by().map(|by| by.name()),
        parent: subject.parent().map(Subject::name),
        kind: subject.kind(),
        ink_on: subject.host().map(Subject::name),
        element: subject.element().and_then(|element| element.id.as_deref()),
        string,
        place: None,
        depth,
        depth_why,
        back,
        form,
        undo,
        attributes: attributes.collect(),
        joint: driver.and_then(|driver| driver.joint),
        joint_why: driver.map(|driver| driver.why),
    }
}

/// The number of parts in the model of a drawing, as every command and page counts them: main parts, landscapes and the regions of
/// characters. Sub-parts, which are solids of a main part, and copies do not count.
pub(crate) fn part_count(compiled: &Compiled) -> usize {
    let counts = |subject: &Subject<'_>| match subject.which {
        Which::Part(_) => subject.is_main(),
        Which::Landscape(_) | Which::Region(..) => true,
        Which::Character(_) => false,
    };
    Subject::all(compiled).filter(counts).count()
}

/// The string of a part or a landscape.
fn string_report<'a>(
    compiled: &Compiled,
    subject: Subject<'a>,
    lines: &LineIndex<&str>,
) -> Option<StringReport<'a>> {
    if matches!(subject.which, Which::Character(_)) {
        // It has one in each view.
        return None;
    }
    let string = subject.string()?;
    let (line, column) = lines.line_column(string.text.whole().start);
    Some(StringReport {
        line,
        column,
        text: string.text.as_str(),
        bound_by: subject.bound_by().map_or("none", |by| by.name()),
        may_mean: string.runner_up.map(|part| {
            let shape = compiled.bindings.parts[part].shape;
            compiled.drawing.describe(shape)
        }),
    })
}
