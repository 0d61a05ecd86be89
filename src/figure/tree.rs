//! The hierarchy with its copies: every node's place in its parent's frame.

use glam::DVec3;
use rustc_hash::FxHashSet;

use super::Model;
use super::frame::Frame;
use crate::bind::PartKind;
use crate::diagnostic::{Code, Diagnostic};

/// Most nodes that `-d` may make.
const MOST_NODES: usize = 1 << 20;
/// How deep `-d` may stand on `-d`: each doubles what hangs on it, so that a part becomes 256.
const MOST_NESTED: usize = 8;

/// A node to be.
#[derive(Debug, Clone)]
pub(super) struct Branch {
    pub(super) name: String,
    /// The part that it shows.
    pub(super) part: usize,
    /// Index of the branch it hangs on, which stands before it.
    pub(super) parent: Option<usize>,
    /// Where it stands in its parent's frame, drawing units, y up.
    pub(super) place: DVec3,
    /// By how much it is turned there, about +Z, radians.
    pub(super) angle: f64,
    /// Whether it is mirrored in the drawing plane.
    pub(super) mirrored: bool,
}

/// All branches, parents before children.
pub(super) struct Tree {
    pub(super) branches: Vec<Branch>,
}

/// What is still to be grown.
struct Bud {
    part: usize,
    parent: Option<usize>,
    mirrored: bool,
    copies: usize,
    /// How many parts with `-d` it hangs on, itself counted.
    nested: usize,
}

impl Tree {
    /// Grows the hierarchy, `-d` copies included; `mirrored` turns all of it inside out in depth.
    pub(super) fn grow(
        model: &Model<'_>,
        frames: &[Frame],
        mirrored: bool,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let parts = &model.sheet.parts;
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); parts.len()];
        let mut roots = Vec::new();
        for (index, part) in parts
            .iter()
            .enumerate()
            .filter(|(_, part)| part.kind == PartKind::Main)
        {
            match part.parent {
                Some(parent) => children[parent].push(index),
                None => roots.push(index),
            }
        }
        let copied = (0..parts.len())
            .any(|part| parts[part].kind == PartKind::Main && model.sheet.shape(part).doubled);
        let known = if copied { parts.as_slice() } else { &[] };
        let mut names: FxHashSet<String> = known.iter().map(|part| part.name.clone()).collect();
        let mut branches: Vec<Branch> = Vec::with_capacity(parts.len());
        let mut buds: Vec<Bud> = Vec::new();
        let mut too_deep = None;
        let mut sprout =
            |buds: &mut Vec<Bud>, part: usize, parent, mirrored: bool, copies, nested: usize| {
                let doubled = model.sheet.shape(part).doubled;
                let nested = nested + usize::from(doubled);
                let bud = |mirrored, copies| Bud {
                    part,
                    parent,
                    mirrored,
                    copies,
                    nested,
                };
                // The last one in is grown first: the copy stands behind its original.
                if doubled && nested <= MOST_NESTED {
                    buds.push(bud(!mirrored, copies + 1));
                } else if doubled {
                    too_deep.get_or_insert(part);
                }
                buds.push(bud(mirrored, copies));
            };
        for root in roots.iter().rev() {
            sprout(&mut buds, *root, None, mirrored, 0, 0);
        }
        // Per part how many `.back` its next copy has at least.
        let mut backs = vec![0_usize; known.len()];
        while let Some(bud) = buds.pop() {
            if branches.len() >= MOST_NODES {
                let element = &model.drawing.shapes[parts[bud.part].shape].element;
                diagnostics.push(
                    Diagnostic::new(
                        Code::LimitPassed,
                        element.span,
                        format!("the copies of `-d` make more than {MOST_NODES} nodes"),
                    )
                    .help("a part with `-d` on a part with `-d` is copied four times, and so on: take some away"),
                );
                break;
            }
            let index = branches.len();
            let mut branch = place(model, frames, &bud);
            if bud.copies > 0 {
                // A copy of a copy may meet a name that is taken.
                for _ in bud.copies..backs[bud.part] {
                    branch.name.push_str(".back");
                }
                backs[bud.part] = backs[bud.part].max(bud.copies) + 1;
                while !names.insert(branch.name.clone()) {
                    branch.name.push_str(".back");
                    backs[bud.part] += 1;
                }
            }
            branches.push(branch);
            for child in children[bud.part].iter().rev() {
                sprout(
                    &mut buds,
                    *child,
                    Some(index),
                    bud.mirrored,
                    bud.copies,
                    bud.nested,
                );
            }
        }
        if let Some(part) = too_deep {
            let element = &model.drawing.shapes[parts[part].shape].element;
            diagnostics.push(
                Diagnostic::new(
                    Code::LimitPassed,
                    element.span,
                    format!(
                        "`{}` with `-d` hangs on more than {} other parts with `-d`",
                        parts[part].name,
                        MOST_NESTED - 1
                    ),
                )
                .help(
                    "each of them doubles all that hangs on it: take `-d` away from some of them",
                ),
            );
        }
        Self { branches }
    }
}

fn place(model: &Model<'_>, frames: &[Frame], bud: &Bud) -> Branch {
    let part = &model.sheet.parts[bud.part];
    let own = &frames[bud.part];
    // With `-s` the two solids are moved, not the node.
    let offset = if model.sheet.shape(bud.part).mirrored {
        0.0
    } else {
        model.offset(bud.part)
    };
    let depth = if bud.mirrored { -offset } else { offset };
    let (place, angle) = match part.parent {
        Some(parent) if bud.parent.is_some() => (
            frames[parent].to_local(own.origin),
            own.angle - frames[parent].angle,
        ),
        _ => (own.origin, own.angle),
    };
    Branch {
        name: format!("{}{}", part.name, ".back".repeat(bud.copies)),
        part: bud.part,
        parent: bud.parent,
        place: place.extend(depth),
        angle,
        mirrored: bud.mirrored,
    }
}
