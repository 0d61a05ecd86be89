//! Binds strings to parts, and resolves attributes and the hierarchy of parts.
//!
//! This is the only module that knows both the drawing and the language. [`bind`] applies the rules in four steps,
//! each of which is a module and knows only the results of those before it: `matching`, `attributes`, `hierarchy`, `reports`. The
//! result, a [`Bindings`], has everything that models are built from and that editors ask about.

mod attributes;
mod bindings;
mod bodies;
mod describe;
mod discs;
mod extents;
mod fineness;
mod forms;
mod hierarchy;
mod matching;
mod names;
mod poses;
mod props;
mod reports;
mod sheets;
#[cfg(test)]
mod tests;
mod vehicles;
mod words;

pub(crate) use crate::anatomy::Garment;
pub(crate) use attributes::plate_depth;
pub(crate) use attributes::{
    Attribute, Camerawork, Carry, ClipLimits, ClipRequest, FollowedName, HeldRequest,
    MaterialFactors, MotionSource, MotionTurn, PartMark, PerformanceRequest, Resolved, SetBy, Side,
    SignedAxis, TurnRequest,
};
pub(crate) use bindings::{
    Bindings, BoundBy, DrawingString, NamedBy, Part, Seen, StringHolder, StringId,
};
pub use bindings::{PartId, PartKind};
pub(crate) use extents::FigureExtent;
pub(crate) use forms::FormByName;
pub(crate) use matching::has_same_pose_layers;
pub(crate) use matching::{BindRule, DistanceMode, LayerId, LayerKind};
pub use matching::{in_layers_of_pixels, makes_pose_layer};
pub(crate) use names::{Numbers, written_by_a_person};
pub(crate) use poses::KeyPose;
pub(crate) use props::Prop;
pub(crate) use reports::locate;
pub(crate) use vehicles::VehiclePart;

use typed_index_collections::TiVec;

use crate::diagnostic::{Diagnostic, Severity};
use crate::memo::Memo;
use crate::svg::Drawing;
use attributes::PartAttributes;
use hierarchy::Tree;
use matching::{Matched, Texts, is_doubtful};

/// Binds the strings of a drawing to its parts.
///
/// Strings that may be lettering, and do not make sense together, are lettering: art is built whatever is written on it.
pub fn bind(drawing: &Drawing, memo: &Memo, diagnostics: &mut Vec<Diagnostic>) -> Bindings {
    let mut found = Vec::new();
    let bindings = bind_as(drawing, Texts::Strings, memo, &mut found);
    let error = found
        .iter()
        .find(|finding| finding.severity() == Severity::Error);
    let Some(error) = error.filter(|_| is_doubtful(drawing, &bindings.strings)) else {
        diagnostics.append(&mut found);
        return bindings;
    };
    diagnostics.push(reports::lettering(&bindings.strings, error));
    bind_as(drawing, Texts::Lettering, memo, diagnostics)
}

/// Binds the strings of a drawing, if its texts are some.
fn bind_as(
    drawing: &Drawing,
    texts: Texts,
    memo: &Memo,
    diagnostics: &mut Vec<Diagnostic>,
) -> Bindings {
    let mut matched = matching::find(drawing, texts, memo, diagnostics);
    let attributes = attributes::resolve(drawing, &matched, diagnostics);
    let tree = hierarchy::build(drawing, &matched, &attributes, memo, diagnostics);
    bodies::soften(drawing, &mut matched, &tree);
    discs::find(&mut matched, &tree);
    diagnostics.extend(reports::all(drawing, texts, &matched, &attributes, &tree));
    let groups = matched.parts.iter().map(|part| part.node_group).collect();
    let groups: TiVec<PartId, _> = groups;
    let mut bindings = assembled(matched, attributes, tree);
    props::find(drawing, &mut bindings, |part| groups[part]);
    fineness::limit(drawing, &mut bindings, diagnostics);
    reports::first_look(drawing, &bindings, diagnostics);
    bindings.poses = poses::read(drawing, &bindings, diagnostics);
    bindings
}

/// Puts the results of all steps together.
fn assembled(matched: Matched, attributes: PartAttributes, tree: Tree) -> Bindings {
    let parts = matched.parts.into_iter_enumerated().zip(tree.names);
    let parts = parts.map(|((index, part), name)| Part {
        name: name.name,
        named_by: name.by,
        kind: tree.nodes.kind[index],
        shape: part.shape,
        is_stroke: part.is_stroke,
        host: part.host,
        outline: part.outline,
        is_balloon: part.is_balloon,
        plate: part.plate,
        stands_in: part.stands_in,
        sheet: None,
        is_too_fine: false,
        measure: tree.axes.turned(index).unwrap_or(part.measure),
        of_group: tree.axes.of_group(index).map(Box::new),
        string: part.string.or(part.described_by),
        legend: attributes.legend_of_part[index],
        parent: tree.parents[index],
        main: tree.nodes.main[index],
        origin: tree.origins[index],
        index,
    });
    let mut parts: TiVec<PartId, Part> = parts.collect();
    let sheets = sheets::reaches(&parts);
    for (part, sheet) in parts.iter_mut().zip(sheets) {
        part.sheet = sheet;
    }
    Bindings {
        annotated: matched.annotated,
        is_first_look: matched.is_first_look,
        strings: matched.strings,
        parts,
        defaults: matched.defaults,
        legends: attributes.legends,
        variables: matched.variables,
        settings: matched.settings,
        layers: matched.layers,
        props: vec![],
        poses: vec![],
        hierarchy_by_contact: tree.by_contact,
        parent_of_layer: tree.parent_of_layer,
        leaders: matched.leaders,
    }
}
