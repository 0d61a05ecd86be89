//! What is automatic about parts, why, and how to undo it, for people: their depths, what they show from behind, and what is done
//! to their forms.

use rustc_hash::FxHashMap;

use crate::compile::Compiled;
use crate::figure::{Behind, FormInFigure, Reason};
use crate::ide::{FormByName, PartId};

/// Differences that are smaller are none, drawing units.
const NONE: f64 = 5e-3;

/// Something automatic that is said of a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Said {
    /// What, and why.
    pub text: String,
    /// What undoes it in the string of a part; `None` for what a string says already.
    pub undo: Option<Undo>,
}

/// What undoes something automatic, in the order of how it is listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Undo {
    Depth,
    Cord,
    Back,
    Toes,
    Thin,
    Disc,
    Round,
    Flattened,
    Rounded,
    Bends,
}

impl Undo {
    /// What to write in the string of the part; for a cord, in that of the part around which it is.
    pub(crate) fn string(self) -> &'static str {
        match self {
            Self::Depth | Self::Cord => "Offset 0",
            Self::Back => "Side near",
            Self::Toes | Self::Thin | Self::Disc | Self::Round | Self::Flattened => "Shape inflate",
            Self::Rounded => "Shape default",
            Self::Bends => "Bend 0",
        }
    }

    /// What it undoes.
    pub(crate) fn of(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Cord => "cord",
            Self::Back => "back",
            Self::Toes => "foot",
            Self::Thin => "cloth",
            Self::Disc => "wheel",
            Self::Round => "round",
            Self::Flattened => "flattened",
            Self::Rounded => "body",
            Self::Bends => "bends",
        }
    }
}

/// Why the parts of a drawing are as they are.
pub(crate) struct Reasons<'a> {
    compiled: &'a Compiled,
    /// Per main part what the parts of its node show from behind.
    behind: FxHashMap<PartId, Vec<(PartId, Behind)>>,
    /// Per main part what its figure does to the forms of the parts of its node.
    forms: FxHashMap<PartId, Vec<(PartId, FormInFigure)>>,
}

impl<'a> Reasons<'a> {
    pub(crate) fn new(compiled: &'a Compiled) -> Self {
        Self {
            compiled,
            behind: by_node(compiled, &compiled.behind),
            forms: by_node(compiled, &compiled.forms),
        }
    }

    /// Why a main part lies at its depth; `None` for one that lies in the plane of what it hangs on, and for parts without a node.
    pub(crate) fn depth(&self, part: PartId) -> Option<Said> {
        let own = self.compiled.depths[part]?;
        let text = match own.reason {
            Reason::Plane => return None,
            Reason::Given => {
                return Some(Said {
                    text: "depth given".to_owned(),
                    undo: None,
                });
            }
            Reason::DrawnOver { part: other } if self.by(part, other) >= NONE => {
                format!("{}: drawn over it", self.place(part, other))
            }
            Reason::DrawnUnder { part: other } if self.by(part, other) <= -NONE => {
                format!("{}: drawn before it", self.place(part, other))
            }
            // Of parts of different thickness, the surface of one may lie in front and the middle of the other.
            Reason::DrawnOver { part } => {
                format!("moved forward: drawn over {}", self.node_name(part))
            }
            Reason::DrawnUnder { part } => {
                format!("moved back: drawn before {}", self.node_name(part))
            }
            Reason::With { part } => format!("lies on {}", self.node_name(part)),
            Reason::Backdrop { of } => format!("{}: covered by it", self.place(part, of)),
            Reason::Vehicle => "the same on both sides of a vehicle".to_owned(),
            Reason::Wheel => {
                return Some(Said {
                    text: "on both sides of a vehicle".to_owned(),
                    undo: Some(Undo::Back),
                });
            }
            Reason::MiddleWheel => "in the middle, one of two wheels".to_owned(),
            Reason::Twin { of } => {
                let parent = self.compiled.bindings.parts[part].parent;
                let parent = parent.map(|parent| format!("{}: ", self.place(part, parent)));
                let parent = parent.unwrap_or_default();
                format!("{parent}twin of {}", self.node_name(of))
            }
        };
        Some(Said {
            text,
            undo: Some(Undo::Depth),
        })
    }

    /// How far the node of a part lies in front of that of another one, drawing units.
    fn by(&self, part: PartId, other: PartId) -> f64 {
        let depth = |part: PartId| self.compiled.depths[part].map(|node| node.depth);
        match [part, other].map(depth) {
            [Some(own), Some(other)] => own - other,
            _ => 0.0,
        }
    }

    /// Where a part lies as seen from another one.
    fn place(&self, part: PartId, other: PartId) -> String {
        let name = self.node_name(other);
        match self.by(part, other) {
            by if by.abs() < NONE => format!("as deep as {name}"),
            by if by > 0.0 => format!("in front of {name} by {}", short(by)),
            by => format!("behind {name} by {}", short(-by)),
        }
    }

    /// What a part shows from behind beside its own back; `None` for nothing.
    pub(crate) fn back(&self, part: PartId) -> Option<Said> {
        let main = self.compiled.bindings.parts[part].main;
        self.described(main, |of, _| of == part)
    }

    /// What the parts of a node show from behind other nodes; `None` for nothing.
    pub(crate) fn node_back(&self, main: PartId) -> Option<Said> {
        self.described(main, |of, why| match why {
            Behind::Closes { on } => self.compiled.bindings.parts[on].main != main,
            Behind::Mirrored | Behind::Round => of == main,
        })
    }

    /// What those parts of a node show from behind that are meant.
    fn described(&self, main: PartId, is_meant: impl Fn(PartId, Behind) -> bool) -> Option<Said> {
        let parts = &self.compiled.bindings.parts;
        let mut on: Vec<&str> = Vec::new();
        let (mut is_mirrored, mut is_round) = (false, false);
        let all = self.behind.get(&main)?.iter();
        for (_, why) in all.filter(|(of, why)| is_meant(*of, *why)) {
            match why {
                Behind::Mirrored => is_mirrored = true,
                Behind::Round => is_round = true,
                Behind::Closes { on: other } => {
                    let name = Some(parts[*other].name.as_str());
                    let name = name.filter(|name| !name.is_empty());
                    let name = name.unwrap_or_else(|| self.node_name(*other));
                    if !on.contains(&name) {
                        on.push(name);
                    }
                }
            }
        }
        let closes = (!on.is_empty()).then(|| format!("closes behind {}", on.join(", ")));
        let mirrored = is_mirrored.then(|| "on the back as well".to_owned());
        let round = is_round.then(|| "round about what wears it".to_owned());
        let reasons = closes.into_iter().chain(mirrored).chain(round);
        let reasons: Vec<String> = reasons.collect();
        (!reasons.is_empty()).then(|| Said {
            text: reasons.join("; "),
            undo: Some(if is_round { Undo::Round } else { Undo::Back }),
        })
    }

    /// What is done to the form of a part; `None` for nothing.
    pub(crate) fn form(&self, part: PartId) -> Option<Said> {
        let main = self.compiled.bindings.parts[part].main;
        let in_figure = self.forms.get(&main).into_iter().flatten();
        let own = in_figure.filter(|(of, _)| *of == part);
        let (bends, own): (Vec<_>, Vec<_>) = own
            .map(|(_, form)| self.in_figure(*form, main))
            .partition(|said| said.undo == Some(Undo::Bends));
        let form = own.into_iter().next().or_else(|| self.of_part(part));
        match (form, bends.into_iter().next()) {
            (Some(form), Some(bends)) => Some(Said {
                text: format!("{}; {}", form.text, bends.text),
                undo: form.undo,
            }),
            (form, bends) => form.or(bends),
        }
    }

    /// What is done to the forms of the parts of a node.
    pub(crate) fn node_forms(&self, main: PartId) -> Vec<Said> {
        let in_figure = self.forms.get(&main).into_iter().flatten();
        let in_figure = in_figure.map(|(_, form)| self.in_figure(*form, main));
        let mut said: Vec<Said> = self.of_part(main).into_iter().chain(in_figure).collect();
        said.sort_by_key(|said| said.undo);
        said.dedup();
        said
    }

    fn in_figure(&self, form: FormInFigure, main: PartId) -> Said {
        let (text, undo) = match form {
            FormInFigure::Toes { away: false } => ("points forward: a foot".to_owned(), Undo::Toes),
            FormInFigure::Toes { away: true } => ("points away: a foot".to_owned(), Undo::Toes),
            FormInFigure::Flattened => {
                ("flattened: deep for its figure".to_owned(), Undo::Flattened)
            }
            FormInFigure::Bends { bones } => {
                let name = &self.compiled.bindings.parts[main].name;
                let others = (2..=bones).map(|bone| format!(", {name}.{bone}"));
                let others: String = others.collect();
                (format!("bends: its bones are {name}{others}"), Undo::Bends)
            }
            FormInFigure::BendsWith { wearer } => {
                let name = &self.compiled.bindings.parts[wearer].name;
                (format!("bends with {name}, which it lies on"), Undo::Bends)
            }
            FormInFigure::Cord { around } if around == main => {
                ("outline is a cord".to_owned(), Undo::Cord)
            }
            FormInFigure::Cord { around } => {
                let name = &self.compiled.bindings.parts[around].name;
                let of = Some(name).filter(|name| !name.is_empty());
                let of = of.map_or("a shape in it", |name| name);
                (format!("outline of {of} is a cord"), Undo::Cord)
            }
        };
        Said {
            text,
            undo: Some(undo),
        }
    }

    /// What its corners or its name do to the form of a part.
    fn of_part(&self, part: PartId) -> Option<Said> {
        let Compiled {
            bindings, drawing, ..
        } = self.compiled;
        if bindings.parts[part].is_too_fine {
            return Some(Said {
                text: "a plate: too fine to be round".to_owned(),
                undo: None,
            });
        }
        let (text, undo) = match bindings.form_by_name(drawing, part)? {
            FormByName::Rounded => ("rounded: part of a body", Undo::Rounded),
            FormByName::Disc => ("a disc: wheel", Undo::Disc),
            FormByName::Thin => ("thin: cloth", Undo::Thin),
        };
        Some(Said {
            text: text.to_owned(),
            undo: Some(undo),
        })
    }

    /// The name of the node of a part.
    fn node_name(&self, part: PartId) -> &'a str {
        let parts = &self.compiled.bindings.parts;
        &parts[parts[part].main].name
    }
}

/// What is said of parts, by the main part of their node.
fn by_node<T: Copy>(
    compiled: &Compiled,
    all: &[(PartId, T)],
) -> FxHashMap<PartId, Vec<(PartId, T)>> {
    let mut of_nodes: FxHashMap<PartId, Vec<(PartId, T)>> = FxHashMap::default();
    for (part, said) in all {
        let main = compiled.bindings.parts[*part].main;
        of_nodes.entry(main).or_default().push((*part, *said));
    }
    of_nodes
}

/// A length with two digits after the point, without zeros at its end.
fn short(length: f64) -> String {
    let text = format!("{length:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
#[path = "reasons_tests.rs"]
mod tests;
