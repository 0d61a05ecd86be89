//! The shapes of a drawing: usvg's tree joined to the XML by id.

use std::sync::{Arc, Mutex};

use glam::{DAffine2, DVec2};
use rayon::prelude::*;
use roxmltree::{Node, NodeId};
use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

use super::dashes::Dashes;
use super::elements::{Ids, element, labels, start_tag};
use super::fit::ImageViewports;
use super::links::{Noted, options, report_links, unusable};
use super::paint::is_opaque;
use super::paths::{StrokeSource, affine, bez_path, curved, open_line};
use super::poses::{IsPose, PoseNodes, PoseReader, Poses};
use super::prepare::Prepared;
use super::style::Styles;
use super::tangles::Tangles;
use super::unsolid::Who;
use super::walk::{Inherited, Leaf, Task, Walk, group_kind};
use super::{
    Drawing, Element, GroupId, Paint, PaintKey, PictureSource, Shape, ShapeId, dropped, growth,
    sheets, unseen,
};
use crate::budget::{Budget, Work};
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::geometry::{FillRule, Outline, flatten, resolve_overlaps};
use crate::resolver::Resolver;
use crate::source::Span;

/// Joins usvg's tree and the XML.
pub(super) fn read(
    document: &roxmltree::Document<'_>,
    prepared: &Prepared,
    tolerance: f64,
    resolver: &dyn Resolver,
    is_pose: IsPose<'_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Drawing, Box<Diagnostic>> {
    let noted = Mutex::default();
    let viewports = ImageViewports::of(document);
    sheets::check_lengths(document, prepared)?;
    let styles = Styles::read(document);
    sheets::check_comparisons(document, prepared, &styles)?;
    let early_ids = if prepared.draws_again || prepared.has_clones {
        let ids = Ids::read(document, prepared);
        growth::check(document, prepared, &styles, &ids)?;
        Some(ids)
    } else {
        None
    };
    let pose_nodes = PoseNodes::find(document, prepared, is_pose);
    // usvg uses one core; the texts, which it does not read, need only the XML.
    let (tree, (labels, by_id, unseen, dropped)) = rayon::join(
        || usvg::Tree::from_xmltree(document, &options(resolver, &viewports, &noted)),
        || {
            let ids = early_ids.unwrap_or_else(|| Ids::read(document, prepared));
            let dropped = dropped::read(document, &styles, prepared, &ids);
            (
                labels(document, &styles, prepared, &pose_nodes),
                ids,
                unseen::read(document, &styles, prepared),
                dropped,
            )
        },
    );
    let tree = tree.map_err(|error| Box::new(unusable(&error, document, prepared)))?;
    let Noted { unshown, linked } = noted.into_inner().unwrap_or_default();
    report_links(document, prepared, unshown, diagnostics);
    dropped::report_pages(document, prepared, &styles, diagnostics);
    dropped::report_linked_sheets(document, prepared, diagnostics);
    let offset = page_corner(document);
    let mut walk = Walk {
        prepared,
        poses: &pose_nodes,
        root: document.root_element(),
        by_id,
        group_of: vec![None; document.descendants().count() + 1],
        groups: TiVec::new(),
        frames: FxHashMap::default(),
        tasks: Vec::new(),
        leaves: 0,
        tolerance,
        page: DAffine2::from_translation(offset),
        unsolid: Vec::new(),
        has_markers: false,
        transparency_groups: TiVec::new(),
    };
    walk.group(document.root_element());
    let root = document.root_element().id();
    walk.children(tree.root(), Inherited::by_root(root));
    walk.note_markers(&styles);
    walk.note_dropped(dropped);
    let labels = labels
        .into_iter()
        .map(|(node, label)| (label, walk.group(node)))
        .collect();
    let pose_groups = pose_nodes.layers.iter();
    let pose_groups = pose_groups.filter_map(|node| document.get_node(*node));
    let pose_groups = pose_groups.map(|node| (node.id(), walk.group(node)));
    let pose_groups: FxHashMap<NodeId, GroupId> = pose_groups.collect();
    let Walk {
        groups,
        tasks,
        page,
        by_id,
        group_of,
        unsolid,
        transparency_groups,
        ..
    } = walk;
    let size = DVec2::new(
        f64::from(tree.size().width()),
        f64::from(tree.size().height()),
    );
    let budget = Budget::of(tasks.iter().map(Task::point_count).sum());
    let context = Context {
        document,
        styles: &styles,
        prepared,
        by_id,
        page,
        page_box: (offset, size),
        tolerance,
        tangles: Tangles::new(prepared, &tasks),
        dashes: Dashes::of(&tasks, budget),
    };
    context.check_clips(&tasks, budget)?;
    diagnostics.extend(context.dashes.warning(&tasks, document, prepared));
    let found = Mutex::new(Vec::new());
    let made: Vec<Option<Shape>> = tasks
        .par_iter()
        .enumerate()
        .map(|(index, task)| {
            let (shape, finding) = context.shape(index, task);
            if let (Some(finding), Ok(mut found)) = (finding, found.lock()) {
                found.push((index, finding));
            }
            shape
        })
        .collect();
    context.tangles.check(&context, &tasks)?;
    let mut shape_of_node: FxHashMap<NodeId, ShapeId> = FxHashMap::default();
    if !unsolid.is_empty() {
        let drawn = tasks.iter().zip(&made).filter(|(_, shape)| shape.is_some());
        let drawn = drawn
            .enumerate()
            .map(|(index, (task, _))| (task.xml, index.into()));
        shape_of_node.extend(drawn);
    }
    let poses = if pose_groups.is_empty() {
        Poses::default()
    } else {
        let drawn = tasks.iter().zip(&made).filter(|(_, shape)| shape.is_some());
        let drawn: Vec<&Task<'_>> = drawn.map(|(task, _)| task).collect();
        let reader = PoseReader {
            document,
            prepared,
            styles: &styles,
            ids: &context.by_id,
            page,
            tolerance,
            nodes: &pose_nodes,
        };
        reader.read(&pose_groups, &drawn, resolver)
    };
    drop(tasks);
    // Dropping a large tree takes a tenth of the time of building it: nobody needs to wait for that.
    crate::threads::run_aside(move || drop(tree));
    let mut found = found.into_inner().unwrap_or_default();
    found.sort_by_key(|(index, _)| *index);
    report_losses(found.into_iter().map(|(_, loss)| loss), diagnostics);
    let mut shapes = TiVec::with_capacity(made.len());
    made.into_iter().for_each(|shape| shapes.extend(shape));
    let drawing = Drawing {
        page: (offset, size),
        groups,
        shapes,
        transparency_groups,
        labels,
        unseen,
        poses,
        pixel_groups: None,
        pictures: linked,
        budget,
    };
    // A shape that is left out is neither, and has its own report.
    let who = |node: NodeId| match shape_of_node.get(&node) {
        Some(shape) => Some(Who::Shape(*shape)),
        None => {
            let is_group = document.get_node(node).and_then(group_kind).is_some();
            let group = group_of[node.get_usize()].filter(|_| is_group);
            group.map(Who::Group)
        }
    };
    let element = |node: NodeId| {
        let (name, span) = dropped::described(document.get_node(node)?, prepared);
        Some(Who::Element(name, span))
    };
    for (feature, nodes) in unsolid {
        let or_element = |node| element(node).filter(|_| feature.is_of_elements());
        let users = nodes.into_iter();
        let users: Vec<Who> = users
            .filter_map(|node| who(node).or_else(|| or_element(node)))
            .collect();
        if !users.is_empty() {
            diagnostics.push(feature.report(&drawing, &users));
        }
    }
    Ok(drawing)
}

/// The largest coordinate that is built, in user units: the surfaces of larger shapes do not fit into the `f32` that models
/// are written in.
const MAX_COORDINATE: f32 = 1e12;

/// What is not built of the drawing.
enum Loss {
    /// A shape that is left out.
    LeftOut(Box<Diagnostic>),
    /// A shape that its clip removes, by its description for people.
    ClippedAway(String, Span),
}

/// Reports what is not built. Maps and flags are clipped at the page, so that there may be hundreds of shapes outside.
fn report_losses(losses: impl Iterator<Item = Loss>, diagnostics: &mut Vec<Diagnostic>) {
    let mut clipped = Vec::new();
    for loss in losses {
        match loss {
            Loss::LeftOut(finding) => diagnostics.push(*finding),
            Loss::ClippedAway(name, span) => clipped.push((name, span)),
        }
    }
    let findings = clipped.iter().map(|(name, span)| {
        let message = format!("its clip leaves nothing of {name}");
        Diagnostic::new(Code::Vanishes, *span, message)
            .help("release the clip, or delete the shape")
    });
    let names = || listed(clipped.iter().map(|(name, _)| name.clone()));
    few_or_one(
        findings.collect(),
        |count| format!("clips leave nothing of {count} shapes: {}", names()),
        diagnostics,
    );
}

/// Whether a path has coordinates that cannot be built.
fn is_beyond_use(path: &usvg::Path) -> bool {
    let bounds = path.abs_bounding_box();
    let sides = [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()];
    // Not a number is beyond use, too.
    !sides.iter().all(|side| side.abs() <= MAX_COORDINATE)
}

fn page_corner(document: &roxmltree::Document<'_>) -> DVec2 {
    let view_box = document
        .root_element()
        .attribute("viewBox")
        .and_then(|value| value.parse().ok());
    view_box.map_or(DVec2::ZERO, |view_box: svgtypes::ViewBox| {
        DVec2::new(view_box.x, view_box.y)
    })
}

/// The context in which shapes are made.
pub(super) struct Context<'a, 'input> {
    pub(super) document: &'a roxmltree::Document<'input>,
    pub(super) styles: &'a Styles<'a>,
    pub(super) prepared: &'a Prepared,
    pub(super) by_id: Ids<'a>,
    pub(super) page: DAffine2,
    /// The minimum corner and the size of the page.
    pub(super) page_box: (DVec2, DVec2),
    pub(super) tolerance: f64,
    pub(super) tangles: Tangles,
    pub(super) dashes: Dashes,
}

impl Context<'_, '_> {
    /// Refuses a drawing whose clips have too many points for the shapes that they cut.
    fn check_clips(&self, tasks: &[Task<'_>], budget: Budget) -> Result<(), Box<Diagnostic>> {
        let of_task = |task: &Task<'_>| -> u64 {
            let clips = task.clips.iter().flat_map(|clips| clips.iter());
            clips.map(|clip| clip.points() as u64).sum()
        };
        let (sum, most) = (
            tasks.iter().map(of_task).sum::<u64>(),
            budget.most(Work::ClipPoints),
        );
        if sum <= most {
            return Ok(());
        }
        // The first of those that are cut by the most points.
        let worst = tasks.iter().rev().max_by_key(|task| of_task(task));
        let node = worst.and_then(|task| self.document.get_node(task.xml));
        let span = start_tag(node.unwrap_or(self.document.root_element()), self.prepared);
        let own = worst.map_or(0, of_task);
        let message = format!(
            "the clips of this drawing have {sum} points, once for each of the shapes that they cut, more than {most}; {own} of them cut this shape"
        );
        let help =
            "clip fewer shapes, or simplify the path that they are clipped to (Path > Simplify)";
        Err(Box::new(
            Diagnostic::new(Code::LimitPassed, span, message).help(help),
        ))
    }

    fn shape(&self, index: usize, task: &Task<'_>) -> (Option<Shape>, Option<Loss>) {
        let Some(node) = self.document.get_node(task.xml) else {
            return (None, None);
        };
        match task.node {
            Leaf::Path(path) if is_beyond_use(path) => {
                let finding = self.beyond_use(node);
                (None, Some(Loss::LeftOut(Box::new(finding))))
            }
            Leaf::Path(path) => {
                let shape = self.path(path, node, task);
                let loss = shape.as_ref();
                let loss = loss.and_then(|shape| self.clipped_away(shape, path, task));
                (shape, loss)
            }
            Leaf::Image(image) => (Some(self.image(index, image, node, task)), None),
        }
    }

    /// Reports that a shape is left out because of its coordinates.
    fn beyond_use(&self, node: Node<'_, '_>) -> Diagnostic {
        let element = self.element(node);
        let name = element.describe();
        let message = format!(
            "{name} is left out: it has coordinates beyond {MAX_COORDINATE}, which cannot be built"
        );
        Diagnostic::new(Code::Vanishes, element.span, message)
            .help("make it smaller, move it onto the page, or delete it")
    }

    /// A fill that a clip removes completely.
    fn clipped_away(&self, shape: &Shape, path: &usvg::Path, task: &Task<'_>) -> Option<Loss> {
        let filled = path.fill().is_some_and(|fill| fill.opacity().get() > 0.0);
        if task.clips.is_none() || !filled || !shape.outline.polygons.is_empty() {
            return None;
        }
        let whole = bez_path(path.data(), self.page * affine(path.abs_transform()));
        let whole = resolve_overlaps(flatten(&whole, self.tolerance), FillRule::NonZero);
        (!whole.polygons.is_empty()).then(|| {
            let name = shape.describe_as(&whole, self.page_box);
            Loss::ClippedAway(name, shape.element.span)
        })
    }

    fn element(&self, node: Node<'_, '_>) -> Element {
        let mut element = element(node, self.prepared);
        if element.tag == "use" {
            // The clone is a group too, and the description is the group's.
            element.desc = None;
        }
        element
    }

    fn path(&self, path: &usvg::Path, node: Node<'_, '_>, task: &Task<'_>) -> Option<Shape> {
        let transform = self.page * affine(path.abs_transform());
        let fill = path.fill().filter(|fill| fill.opacity().get() > 0.0);
        let stroke = path.stroke().filter(|stroke| stroke.opacity().get() > 0.0);
        if self.tangles.are_too_many() {
            return None;
        }
        let bez = bez_path(path.data(), transform);
        let mut outline = Outline::default();
        let mut line = None;
        if let Some(fill) = fill {
            let rule = match fill.rule() {
                usvg::FillRule::NonZero => FillRule::NonZero,
                usvg::FillRule::EvenOdd => FillRule::EvenOdd,
            };
            let rings = flatten(&bez, self.tolerance);
            outline = self.tangles.resolve(rings, rule, stroke.is_some());
            outline = task.clip(outline);
        } else if stroke.is_some() {
            self.tangles.add_line(&flatten(&bez, self.tolerance));
            line = open_line(&bez, node);
        }
        // Painted first, the stroke is seen beside the fill only.
        let is_below = path.paint_order() == usvg::PaintOrder::StrokeAndFill;
        let outline = Arc::new(outline);
        let stroke = stroke.map(|stroke| {
            Arc::new(StrokeSource {
                path: path.data().clone(),
                stroke: self.dashes.stroke(stroke, path.data()),
                transform,
                tolerance: self.tolerance,
                covered_by: is_below.then(|| Arc::clone(&outline)),
                paint: self.paint(stroke.paint(), node, "stroke", transform),
                is_opaque: is_opaque(stroke.paint(), stroke.opacity()),
            })
        });
        let (paint, opacity, is_opaque_in_group) = match (fill, &stroke) {
            (Some(fill), _) => (
                self.paint(fill.paint(), node, "fill", transform),
                f64::from(fill.opacity().get()),
                is_opaque(fill.paint(), fill.opacity()),
            ),
            (None, Some(stroke)) => (
                stroke.paint.clone(),
                path.stroke()
                    .map_or(1.0, |stroke| f64::from(stroke.opacity().get())),
                stroke.is_opaque,
            ),
            (None, None) => return None,
        };
        let element = self.element(node);
        let opacity = opacity * task.opacity;
        Some(Shape {
            leaf: task.leaf,
            group: task.group,
            element,
            outline,
            curved: if fill.is_some() { curved(&bez) } else { 0.0 },
            paint,
            opacity,
            transparency_group: task.transparency_group,
            is_opaque_in_group,
            stroke,
            line,
            picture: None,
        })
    }

    fn image(
        &self,
        index: usize,
        picture: &usvg::Image,
        node: Node<'_, '_>,
        task: &Task<'_>,
    ) -> Shape {
        let element = self.element(node);
        let transform = self.page * affine(picture.abs_transform());
        let source = PictureSource::of(picture, transform, task.clips.clone());
        Shape {
            leaf: task.leaf,
            group: task.group,
            element,
            outline: Arc::new(source.rectangle()),
            curved: 0.0,
            paint: Paint {
                key: PaintKey::Picture(index),
                color: [0; 3],
                server: None,
            },
            opacity: task.opacity,
            transparency_group: task.transparency_group,
            is_opaque_in_group: false,
            stroke: None,
            line: None,
            picture: Some(Arc::new(source)),
        }
    }
}
