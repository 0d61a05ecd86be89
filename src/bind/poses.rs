//! Key poses: which part each copy in a pose layer is one of, and how it is moved.

use glam::DAffine2;
use rustc_hash::FxHashSet;

use super::attributes::ClipLimits;
use super::bindings::{Bindings, PartId, PartKind};
use super::matching::group_of;
use crate::diagnostic::{Code, Diagnostic, few_or_one, listed};
use crate::geometry::{Similarity, between_points, between_rings, bounds_of};
use crate::lang;
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::source::Span;
use crate::svg::{Drawing, DrawnPath, Element, GroupId, PosedShape, ShapeId};

/// A key pose, as a string and its layer give it.
#[derive(Debug, Clone)]
pub(crate) struct KeyPose {
    /// The layer.
    pub layer: GroupId,
    /// The place of the setting.
    pub span: Span,
    /// When it is reached, seconds from the beginning of the clip.
    pub seconds: f64,
    /// The name of the clip, if the string gives one.
    pub clip: Option<String>,
    /// Whether the clip is a loop.
    pub is_loop: bool,
    /// The `Limited` of the string.
    pub limits: Option<ClipLimits>,
    /// The part that the string names; its figure is posed alone.
    pub actor: Option<PartId>,
    /// The copies, each main part at most once, in the order of the parts.
    pub parts: Vec<PosedPart>,
}

impl KeyPose {
    /// The word by which strings ask for one.
    pub(crate) fn word() -> &'static str {
        Keyword::Pose.name()
    }
}

/// A part in a key pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PosedPart {
    /// The main part.
    pub part: PartId,
    /// From where its outline is drawn to its copy: a turn and a shift, drawing units, y down.
    pub moved: DAffine2,
    /// The element of the copy.
    pub copy: Span,
}

/// A copy may be this much larger or smaller than its part, or off its form, as a share of its size.
const SAME_SIZE: f64 = 0.02;
/// A copy that is off by more than this is another shape.
const SAME_FORM: f64 = 0.15;

/// Reads the key poses of a drawing, in the order of their layers.
pub(super) fn read(
    drawing: &Drawing,
    bindings: &Bindings,
    diagnostics: &mut Vec<Diagnostic>,
) -> Vec<KeyPose> {
    let mut poses = Vec::new();
    for (_, layer) in bindings.pose_layers() {
        let string = &bindings.strings[layer.string];
        let mut settings = string.settings.iter();
        let Some((setting, pose)) = settings.find_map(|setting| match &setting.value {
            Value::Pose(pose) => Some((setting, pose)),
            _ => None,
        }) else {
            continue;
        };
        let span = string.text.span(setting.range.clone());
        let limits = string
            .settings
            .iter()
            .find_map(|setting| match setting.keyword {
                Keyword::Limited => {
                    ClipLimits::of(setting, string.text.span(setting.range.clone()))
                }
                _ => None,
            });
        if group_of(drawing, string.holder) == GroupId::ROOT {
            diagnostics.push(
                Diagnostic::new(
                    Code::IdlePose,
                    span,
                    "this string is in no layer, so it makes no key pose",
                )
                .help("move the string into the layer or group that holds the moved copies"),
            );
            continue;
        }
        let actor =
            match named(&string.annotation) {
                Some(name) => {
                    let actor = actor(bindings, name);
                    if actor.is_none() {
                        let message = format!(
                            "no part is called `{name}`; the copies alone say whose pose this is"
                        );
                        diagnostics.push(Diagnostic::new(Code::IdlePose, span, message).help(
                            "write the name of the figure's root part before `$`, or no name",
                        ));
                    }
                    actor
                }
                None => None,
            };
        poses.push(KeyPose {
            layer: layer.group,
            span,
            seconds: pose.seconds,
            clip: pose.clip.clone(),
            is_loop: pose.is_loop,
            limits,
            actor,
            parts: Vec::new(),
        });
    }
    // Several strings may share a layer; the order is that of the layers, from bottom to top.
    poses.sort_by_key(|pose| drawing.groups[pose.layer].element.span.start);
    for index in 0..poses.len() {
        let (before, rest) = poses.split_at_mut(index);
        let [pose, ..] = rest else { continue };
        // Of several strings in a layer the first one finds what is wrong with it.
        pose.parts = match before.last().filter(|before| before.layer == pose.layer) {
            Some(before) => before.parts.clone(),
            None => Layer {
                drawing,
                bindings,
                group: pose.layer,
            }
            .parts(pose.span, diagnostics),
        };
    }
    poses
}

fn named(annotation: &Annotation) -> Option<&str> {
    match annotation {
        Annotation::Part(part) => part.name.as_ref().map(|name| name.text.as_str()),
        _ => None,
    }
}

fn actor(bindings: &Bindings, name: &str) -> Option<PartId> {
    let mut parts = bindings.parts.iter_enumerated();
    let found = parts.find(|(_, part)| part.kind == PartKind::Main && part.name == name);
    found.map(|(index, _)| index)
}

/// A pose layer.
struct Layer<'a> {
    drawing: &'a Drawing,
    bindings: &'a Bindings,
    group: GroupId,
}

/// What a copy in a layer is one of.
#[derive(Debug, Clone, Copy)]
enum Original {
    /// A part, and the shape that the copy shows.
    Part(PartId, ShapeId),
    /// Nothing that moves.
    None,
}

impl Layer<'_> {
    fn parts(&self, span: Span, diagnostics: &mut Vec<Diagnostic>) -> Vec<PosedPart> {
        let copies = self.drawing.poses.copies.iter();
        let copies: Vec<&PosedShape> = copies.filter(|copy| copy.layer == self.group).collect();
        let mut originals: Vec<Original> = copies.iter().map(|copy| self.original(copy)).collect();
        self.name_by_texts(&copies, &mut originals);
        let mut posed: Vec<(PosedPart, bool)> = Vec::new();
        let mut unknown = Vec::new();
        // Where a clone shows a shape, the rest of it are arrowheads and the like.
        let showing = copies.iter().filter(|copy| copy.shows.is_some());
        let showing: FxHashSet<Span> = showing.map(|copy| copy.element.span).collect();
        for (copy, original) in copies.iter().zip(originals) {
            let Original::Part(part, shape) = original else {
                if !showing.contains(&copy.element.span) {
                    unknown.push(*copy);
                }
                continue;
            };
            let fitting = self.fit(shape, copy);
            let part = fitting
                .as_ref()
                .map_or(part, |found| self.island(part, found));
            let main = self.bindings.parts[part].main;
            let is_main = part == main;
            // A detail that is cloned with its part says nothing more.
            let known = posed.iter().position(|(posed, _)| posed.part == main);
            if known.is_some_and(|known| posed[known].1 || !is_main) {
                continue;
            }
            let Some(found) = fitting else {
                continue;
            };
            if !self.is_usable(copy, main, &found, diagnostics) {
                continue;
            }
            let new = PosedPart {
                part: main,
                moved: found.rigid(),
                copy: copy.element.span,
            };
            match known {
                Some(known) => posed[known] = (new, is_main),
                None => posed.push((new, is_main)),
            }
        }
        self.report_unknown(&unknown, diagnostics);
        if copies.is_empty() {
            diagnostics.push(
                Diagnostic::new(
                    Code::IdlePose,
                    span,
                    "this key pose has no effect: its layer holds no copies of parts",
                )
                .related(
                    self.drawing.groups[self.group].element.span,
                    "the layer",
                )
                .help("clone the parts that move (in Inkscape, Alt+D), move the clones into this layer, and turn them there"),
            );
        }
        let mut parts: Vec<PosedPart> = posed.into_iter().map(|(posed, _)| posed).collect();
        parts.sort_by_key(|posed| posed.part);
        parts
    }

    /// The island that a copy of a whole path turns: of several, the one whose joint, or that of what it is a piece of, stays where it is.
    fn island(&self, part: PartId, found: &Similarity) -> PartId {
        let parts = &self.bindings.parts;
        let moved = found.rigid();
        let off = |part: PartId| {
            let joint = parts[parts[part].main].origin;
            moved.transform_point2(joint).distance(joint)
        };
        let islands = self.bindings.islands(part);
        let islands =
            islands.filter(|one| matches!(parts[*one].kind, PartKind::Main | PartKind::Sub));
        let nearest = islands.min_by(|a, b| off(*a).total_cmp(&off(*b)));
        nearest.unwrap_or(part)
    }

    /// Whether a copy shows its part in another place; reports what is odd about it.
    fn is_usable(
        &self,
        copy: &PosedShape,
        part: PartId,
        found: &Similarity,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> bool {
        let name = self.bindings.describe_as_drawn(self.drawing, part);
        let mut report = |message: String, help: &'static str| {
            let finding = Diagnostic::new(Code::CopyDiffers, copy.element.span, message);
            diagnostics.push(finding.help(help));
        };
        if found.is_mirrored {
            report(
                format!(
                    "this copy of {name} is mirrored, so it is left out: parts turn, but they are not flipped"
                ),
                "flip it back (in Inkscape, H or V), and turn it instead",
            );
            return false;
        }
        if found.residual > SAME_FORM {
            report(
                format!("this copy of {name} has another outline, so it is left out"),
                "delete it and clone the part again (in Inkscape, Alt+D), then turn the clone",
            );
            return false;
        }
        let size = 100.0 * (found.scale - 1.0);
        if size.abs() > 100.0 * SAME_SIZE {
            let than = if size > 0.0 { "larger" } else { "smaller" };
            let size = size.abs().round();
            report(
                format!(
                    "this copy of {name} is {size} % {than} than the part: only its turn counts"
                ),
                "parts do not change their size: turn the copy without scaling it",
            );
        } else if found.residual > SAME_SIZE {
            report(
                format!(
                    "this copy of {name} has a slightly different outline: only its turn counts"
                ),
                "that does no harm if the turn looks right; a clone (in Inkscape, Alt+D) keeps the outline",
            );
        }
        true
    }

    /// What a copy is one of, by what it clones or by its name.
    fn original(&self, copy: &PosedShape) -> Original {
        if let Some(leaf) = copy.shows {
            return self.part_of_leaf(leaf);
        }
        if let Some(name) =
            copy.element.desc.as_deref().and_then(|desc| {
                named(&lang::parse(desc, lang::Container::Desc).0).map(str::to_owned)
            })
            && let Some(part) = self.part_named(&name, copy)
        {
            return part;
        }
        for element in std::iter::once(&copy.element).chain(&copy.around) {
            let names = [element.label.as_deref(), element.id.as_deref()];
            let bases = names.iter().flatten().map(|name| without_number(name));
            let mut names = names.iter().flatten().copied().chain(bases);
            if let Some(found) = names.find_map(|name| self.part_named(name, copy)) {
                return found;
            }
        }
        let cloned = copy.cloned.as_deref();
        let found = cloned.and_then(|id| self.part_named(without_number(id), copy));
        found.unwrap_or(Original::None)
    }

    /// How a shape is moved to its copy.
    fn fit(&self, shape: ShapeId, copy: &PosedShape) -> Option<Similarity> {
        let leaf = self.drawing.shapes[shape].leaf;
        fit(self.drawing.poses.paths.get(&leaf)?, &copy.path)
    }

    fn part_of_leaf(&self, leaf: usize) -> Original {
        let mut parts = self.bindings.parts.iter_enumerated();
        let found = parts.find(|(_, part)| {
            self.drawing.shapes[part.shape].leaf == leaf
                && matches!(part.kind, PartKind::Main | PartKind::Sub)
        });
        found.map_or(Original::None, |(index, part)| {
            Original::Part(index, part.shape)
        })
    }

    /// The part that a name means: its own, or the label or id of its shape or group. Of several shapes, that which the copy is most like.
    fn part_named(&self, name: &str, copy: &PosedShape) -> Option<Original> {
        let is_named = |element: &Element| {
            element.label.as_deref() == Some(name) || element.id.as_deref() == Some(name)
        };
        let parts = self.bindings.parts.iter_enumerated();
        let means = parts.filter(|(_, part)| {
            let main = &self.bindings.parts[part.main];
            let shape = &self.drawing.shapes[part.shape];
            let group = &self.drawing.groups[shape.group].element;
            matches!(part.kind, PartKind::Main | PartKind::Sub)
                && (main.name == name || is_named(&shape.element) || is_named(group))
        });
        let fits = means.map(|(index, part)| {
            let found = self.fit(part.shape, copy);
            let off = found.map_or(f64::INFINITY, |found| {
                found.residual + (found.scale - 1.0).abs()
            });
            (index, part.shape, off)
        });
        let best = fits.min_by(|(_, _, a), (_, _, b)| a.total_cmp(b));
        best.map(|(part, shape, _)| Original::Part(part, shape))
    }

    /// Gives the name in each text of the layer to the copy under it, or the nearest one, that nothing else names.
    fn name_by_texts(&self, copies: &[&PosedShape], originals: &mut [Original]) {
        let texts = self.drawing.poses.texts.iter();
        for text in texts.filter(|text| text.layer == self.group) {
            let (annotation, _) = lang::parse(&text.text, lang::Container::Text);
            let Some(name) = named(&annotation) else {
                continue;
            };
            let unnamed = copies.iter().enumerate();
            let unnamed = unnamed.filter(|(index, _)| matches!(originals[*index], Original::None));
            let apart = |copy: &PosedShape| {
                let (low, high) = bounds_of(copy.path.points.iter().copied())?;
                let outside = text.position.distance(text.position.clamp(low, high));
                Some((outside, text.position.distance(low.midpoint(high))))
            };
            let nearest = unnamed.filter_map(|(index, copy)| Some((index, apart(copy)?)));
            let nearest =
                nearest.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
            if let Some((index, _)) = nearest
                && let Some(part) = self.part_named(name, copies[index])
            {
                originals[index] = part;
            }
        }
    }

    fn report_unknown(&self, unknown: &[&PosedShape], diagnostics: &mut Vec<Diagnostic>) {
        let findings = unknown.iter().map(|copy| {
            let what = copy.element.describe();
            let message = format!("{what} in this key pose is a copy of no part that is built");
            Diagnostic::new(Code::CopyOfNoPart, copy.element.span, message).help(
                "clone the part itself (in Inkscape, Alt+D), or give the copy the part's label (Object Properties → Label)",
            )
        });
        let names = || listed(unknown.iter().map(|copy| copy.element.describe()));
        few_or_one(
            findings.collect(),
            |count| {
                let names = names();
                format!(
                    "{count} shapes in this key pose are copies of no part that is built: {names}"
                )
            },
            diagnostics,
        );
    }
}

/// How a path is moved to another one.
fn fit(from: &DrawnPath, to: &DrawnPath) -> Option<Similarity> {
    let by_points = between_points(&from.points, &to.points);
    let is_close = |found: &Similarity| found.residual < SAME_SIZE || found.is_mirrored;
    by_points
        .filter(is_close)
        .or_else(|| between_rings(&from.rings, &to.rings))
        .or(by_points)
}

/// A name without the number of a copy: `arm` of `arm-3`, as drawing programs number the ids of copies.
fn without_number(name: &str) -> &str {
    let mut base = name;
    while let Some((before, number)) = base.rsplit_once('-') {
        let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        if before.is_empty() || !is_number {
            break;
        }
        base = before;
    }
    base
}
