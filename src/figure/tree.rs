//! The hierarchy with its copies: every node's place in its parent's frame.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::FigureContext;
use crate::bind::PartKind;
use crate::diagnostic::{Code, Diagnostic};
use crate::geometry::Frame;

/// Most nodes that `-d` may add: nested copies double each time.
const MOST_COPIES: usize = 1 << 16;

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
}

impl Tree {
    /// Grows the hierarchy, `-d` copies included.
    pub(super) fn grow(
        context: &FigureContext<'_>,
        frames: &[Frame],
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Self {
        let parts = &context.bindings.parts;
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
        let copied = (0..parts.len()).any(|part| {
            parts[part].kind == PartKind::Main && context.bindings.attributes(part).shape().doubled
        });
        let known = if copied { parts.as_slice() } else { &[] };
        let mut names: FxHashMap<String, usize> =
            known.iter().map(|part| (part.name.clone(), 1)).collect();
        let mut branches: Vec<Branch> = Vec::with_capacity(parts.len());
        let mut buds: Vec<Bud> = Vec::new();
        let sprout = |buds: &mut Vec<Bud>, part: usize, parent, mirrored: bool, copies| {
            let bud = |mirrored, copies| Bud {
                part,
                parent,
                mirrored,
                copies,
            };
            // The last one in is grown first: the copy stands behind its original.
            if context.bindings.attributes(part).shape().doubled {
                buds.push(bud(!mirrored, copies + 1));
            }
            buds.push(bud(mirrored, copies));
        };
        for root in roots.iter().rev() {
            sprout(&mut buds, *root, None, false, 0);
        }
        while let Some(bud) = buds.pop() {
            if branches.len() >= parts.len() + MOST_COPIES {
                let element = &context.drawing.shapes[parts[bud.part].shape].element;
                diagnostics.push(
                    Diagnostic::new(
                        Code::LimitPassed,
                        element.span,
                        format!("the copies of `-d` add more than {MOST_COPIES} nodes"),
                    )
                    .help("each `-d` doubles everything attached to the part, so nested ones multiply: remove some of them"),
                );
                break;
            }
            let index = branches.len();
            let mut branch = place(context, frames, &bud);
            if bud.copies > 0 {
                branch.name = free_name(branch.name, &mut names);
            }
            branches.push(branch);
            for child in children[bud.part].iter().rev() {
                sprout(&mut buds, *child, Some(index), bud.mirrored, bud.copies);
            }
        }
        Self { branches }
    }
}

/// The name of a copy, with a number behind it where a copy of a copy meets a name that is taken.
fn free_name(name: String, names: &mut FxHashMap<String, usize>) -> String {
    let mut count = names.get(&name).copied().unwrap_or(0);
    if count == 0 {
        names.insert(name.clone(), 1);
        return name;
    }
    loop {
        count += 1;
        let numbered = format!("{name}-{count}");
        if !names.contains_key(&numbered) {
            names.insert(name, count);
            names.insert(numbered.clone(), 1);
            return numbered;
        }
    }
}

fn place(context: &FigureContext<'_>, frames: &[Frame], bud: &Bud) -> Branch {
    let part = &context.bindings.parts[bud.part];
    let own = &frames[bud.part];
    // With `-s` the two solids are moved, not the node.
    let offset = if context.bindings.attributes(bud.part).shape().mirrored {
        0.0
    } else {
        context.offset(bud.part)
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
