//! What a drawing consists of: what each thing is called, what it hangs on, who sets its attributes, and where its text is.
//!
//! Hovers, definitions, the preview's page and `inspect` speak of the same things, so all of them ask here.

use super::Item;
use super::at::tokens;
use crate::billboard::{TrackId, ViewId};
use crate::bind::{
    Bindings, BoundBy, DrawingString, NamedBy, Part, PartId, PartKind, Resolved, SetBy, StringId,
};
use crate::compile::Compiled;
use crate::source::Span;
use crate::svg::{Element, GroupId, ShapeId};
use crate::terrain::{LandscapeId, Layer};

#[cfg(test)]
thread_local! {
    /// How many subjects [`Subject::all`] has gone through in this thread.
    pub(crate) static VISITED: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// Something that a drawing consists of.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    compiled: &'a Compiled,
    /// Which one it is.
    pub which: Which,
}

/// The kinds of subjects, with the indices of each in the compiled drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Which {
    /// A part of a figure; also legends and unused parts.
    Part(PartId),
    /// A landscape.
    Landscape(LandscapeId),
    /// A character that turns.
    Character(usize),
    /// A region of a character, the same one in all views.
    Region(usize, TrackId),
}

impl<'a> Subject<'a> {
    /// Everything in a drawing, in the order of `inspect`: the parts in paint order, the landscapes, the characters, each with its
    /// regions behind it.
    pub fn all(compiled: &'a Compiled) -> impl Iterator<Item = Self> {
        let parts = compiled.bindings.parts.iter_enumerated();
        let parts = parts.filter(|(_, part)| !is_content(part));
        let parts = parts.map(|(part, _)| Which::Part(part));
        let landscapes = compiled.layers.keys().map(Which::Landscape);
        let characters = compiled.characters.iter().enumerate();
        let characters = characters.flat_map(|(index, character)| {
            let regions = character.regions.keys();
            let regions = regions.map(move |region| Which::Region(index, region));
            std::iter::once(Which::Character(index)).chain(regions)
        });
        let all = parts.chain(landscapes).chain(characters);
        #[cfg(test)]
        let all = all.inspect(|_| VISITED.set(VISITED.get() + 1));
        all.map(move |which| Self { compiled, which })
    }

    /// The first subject with a name: the one that the name means on the preview's page.
    pub fn named(compiled: &'a Compiled, name: &str) -> Option<Self> {
        Self::all(compiled).find(|subject| subject.name() == name)
    }

    /// A part. What is drawn in a landscape or a view belongs to that, and is none of its own there.
    pub(super) fn of_part(compiled: &'a Compiled, part: PartId) -> Option<Self> {
        match &compiled.bindings.parts[part] {
            content if is_content(content) => Self::of_content(compiled, content.shape),
            _ => Some(Self {
                compiled,
                which: Which::Part(part),
            }),
        }
    }

    /// What a shape belongs to.
    pub(super) fn of_shape(compiled: &'a Compiled, shape: ShapeId) -> Option<Self> {
        match part_of_shape(compiled, shape) {
            Some(part) => Self::of_part(compiled, part),
            None => Self::of_content(compiled, shape),
        }
    }

    /// The landscape, region or character that a shape in a layer shows; a picture of several regions shows their character.
    fn of_content(compiled: &'a Compiled, shape: ShapeId) -> Option<Self> {
        let shows = |layer: &Layer| layer.sources.iter().any(|tiles| tiles.shape == shape);
        let which = match compiled.layers.position(shows) {
            Some(landscape) => Which::Landscape(landscape),
            None => {
                let mut characters = compiled.characters.iter().enumerate();
                characters.find_map(|(index, character)| {
                    let regions = character.regions.iter_enumerated();
                    let mut shown = regions.filter(|(_, one)| one.shapes.contains(&Some(shape)));
                    let (region, _) = shown.next()?;
                    Some(match shown.next() {
                        None => Which::Region(index, region),
                        Some(_) => Which::Character(index),
                    })
                })?
            }
        };
        Some(Self { compiled, which })
    }

    /// What a string describes.
    pub(super) fn of_string(compiled: &'a Compiled, string: StringId) -> Option<Self> {
        if let Some(part) = part_of_string(compiled, string) {
            return Self::of_part(compiled, part);
        }
        let all = Self::all(compiled);
        let mut layers = all.filter(|subject| !matches!(subject.which, Which::Part(_)));
        layers.find(|subject| match subject.which {
            Which::Character(index) => {
                let mut views = compiled.characters[index].layers.iter();
                views.any(|view| compiled.bindings.layers[*view].string == string)
            }
            Which::Region(character, region) => {
                let region = &compiled.characters[character].regions[region];
                region.strings.contains(&Some(string))
            }
            _ => subject.string_id() == Some(string),
        })
    }

    fn part(self) -> Option<&'a Part> {
        match self.which {
            Which::Part(part) => Some(&self.compiled.bindings.parts[part]),
            _ => None,
        }
    }

    fn part_kind(self) -> Option<PartKind> {
        self.part().map(|part| part.kind)
    }

    /// Its name; that of its element for sub-parts, legends and unused parts without one.
    pub fn name(self) -> &'a str {
        let Compiled {
            bindings,
            layers,
            characters,
            ..
        } = self.compiled;
        match self.which {
            Which::Part(part) if bindings.parts[part].name.is_empty() => {
                self.element().map_or("", Element::own_name)
            }
            Which::Part(part) => &bindings.parts[part].name,
            Which::Landscape(layer) => &layers[layer].name,
            Which::Character(character) => &characters[character].name,
            Which::Region(character, region) => &characters[character].regions[region].name,
        }
    }

    /// The name that means it on the preview's page. A shape that has none, or shares it with one before, goes by the part whose
    /// node shows it.
    pub(super) fn shown_name(self) -> Option<&'a str> {
        let is_meant = |subject: &Self| {
            let name = subject.name();
            let meant = || Self::named(self.compiled, name);
            !name.is_empty() && meant().is_some_and(|meant| meant.which == subject.which)
        };
        let shown = [self, self.carrier()].into_iter().find(is_meant)?;
        Some(shown.name())
    }

    /// The word for its kind: `main`, `sub`, `legend`, `unused`, `terrain`, `character` or `region`.
    pub fn kind(self) -> &'static str {
        match self.which {
            Which::Part(part) => self.compiled.bindings.parts[part].kind.name(),
            Which::Landscape(_) => "terrain",
            Which::Character(_) => "character",
            Which::Region(..) => "region",
        }
    }

    /// Whether it is a node of the hierarchy.
    pub fn is_main(self) -> bool {
        self.part_kind() == Some(PartKind::Main)
    }

    /// Whether it is a solid in the node of another part.
    pub fn is_sub(self) -> bool {
        self.part_kind() == Some(PartKind::Sub)
    }

    /// Whether it is the sample of a legend, or left out, and is no shape of such a part.
    pub fn is_left_out(self) -> bool {
        let is_aside = matches!(self.part_kind(), Some(PartKind::Legend | PartKind::Unused));
        is_aside && self.part().is_some_and(Part::is_candidate)
    }

    /// What it hangs on, or belongs to; `None` for what hangs on the root.
    pub fn parent(self) -> Option<Self> {
        let which = match self.which {
            Which::Part(index) => {
                let part = &self.compiled.bindings.parts[index];
                let above = match part.kind {
                    PartKind::Main => part.parent,
                    PartKind::Prop if part.main == index => {
                        let prop = self.compiled.bindings.prop_of(index)?;
                        let which = Which::Landscape(self.compiled.props.get(prop)?.landscape);
                        return Some(Self { which, ..self });
                    }
                    _ => Some(part.main).filter(|main| *main != index),
                };
                Which::Part(above?)
            }
            Which::Landscape(layer) => Which::Part(self.compiled.layers[layer].parent?),
            Which::Character(_) => return None,
            Which::Region(character, _) => Which::Character(character),
        };
        Some(Self { which, ..self })
    }

    /// The one whose node shows it: for a sub-part its main part, else itself.
    fn carrier(self) -> Self {
        self.parent().filter(|_| self.is_sub()).unwrap_or(self)
    }

    /// For ink, the part on which it lies.
    pub fn host(self) -> Option<Self> {
        let which = Which::Part(self.part()?.host?);
        Some(Self { which, ..self })
    }

    /// The element that it is made from: a shape, or a layer.
    pub fn element(self) -> Option<&'a Element> {
        let drawing = &self.compiled.drawing;
        let group = match self.which {
            Which::Landscape(layer) => self.compiled.layers[layer].group,
            Which::Character(character) => self.first_view(character).1,
            Which::Part(part) => {
                let shape = self.compiled.bindings.parts[part].shape;
                return Some(&drawing.shapes[shape].element);
            }
            Which::Region(character, region) => {
                let shape = self.compiled.characters[character].regions[region].shape?;
                return Some(&drawing.shapes[shape].element);
            }
        };
        Some(&drawing.groups[group].element)
    }

    /// The string that describes it; of a character, that of its first view.
    pub fn string(self) -> Option<&'a DrawingString> {
        Some(&self.compiled.bindings.strings[self.string_id()?])
    }

    pub(super) fn string_id(self) -> Option<StringId> {
        match self.which {
            Which::Part(_) => self.part()?.string,
            Which::Region(..) => None,
            Which::Landscape(layer) => Some(self.compiled.layers[layer].string),
            Which::Character(character) => Some(self.first_view(character).0),
        }
    }

    /// The rule by which it has its string.
    pub fn bound_by(self) -> Option<BoundBy> {
        match self.which {
            Which::Part(part) => bound_by(self.compiled, part),
            _ => Some(self.string()?.binding?.by),
        }
    }

    /// Where its name is from; `None` for what is no node of the hierarchy.
    pub fn named_by(self) -> Option<NamedBy> {
        let main = self.part().filter(|_| self.is_main())?;
        Some(main.named_by)
    }

    /// The attributes that are set, and those that every solid has, each with who sets it.
    pub fn attributes(self) -> Vec<Resolved> {
        let bindings = &self.compiled.bindings;
        match self.which {
            Which::Part(part) => bindings.resolved(&self.compiled.drawing, part),
            Which::Landscape(layer) => {
                let string = self.compiled.layers[layer].string;
                let settings = bindings.strings[string].settings.iter();
                let own = settings.map(|setting| Resolved {
                    keyword: setting.keyword,
                    value: setting.text.clone(),
                    from: SetBy::Own,
                    string: Some(string),
                });
                own.collect()
            }
            Which::Character(_) | Which::Region(..) => Vec::new(),
        }
    }

    /// The span that names it: in its string, or the tag of its shape or group.
    pub fn span(self) -> Span {
        let compiled = self.compiled;
        match self.which {
            Which::Part(part) => span_of_part(compiled, part),
            Which::Landscape(layer) => span_of_string(compiled, compiled.layers[layer].string),
            Which::Character(character) => span_of_string(compiled, self.first_view(character).0),
            Which::Region(character, region) => {
                let shape = compiled.characters[character].regions[region].shape;
                let which = Which::Character(character);
                shape.map_or_else(
                    || Self { which, ..self }.span(),
                    |shape| span_of_shape(compiled, shape),
                )
            }
        }
    }

    /// String and group of a character's first view.
    fn first_view(self, character: usize) -> (StringId, GroupId) {
        let views = &self.compiled.characters[character].layers;
        let layer = &self.compiled.bindings.layers[views[ViewId::FIRST]];
        (layer.string, layer.group)
    }
}

/// Whether a part is drawn in a landscape or a view.
fn is_content(part: &Part) -> bool {
    matches!(part.kind, PartKind::Tile | PartKind::Region)
}

/// The part of a shape; the fill if fill and border are two.
pub(super) fn part_of_shape(compiled: &Compiled, shape: ShapeId) -> Option<PartId> {
    let parts = &compiled.bindings.parts;
    parts.position(|part| part.shape == shape)
}

/// The part that a string describes; `None` if another string describes it too, and came first.
pub(super) fn part_of_string(compiled: &Compiled, string: StringId) -> Option<PartId> {
    let part = compiled.bindings.strings[string].binding?.part;
    (compiled.bindings.parts[part].string == Some(string)).then_some(part)
}

/// The rule by which a part has its string.
pub(super) fn bound_by(compiled: &Compiled, part: PartId) -> Option<BoundBy> {
    let Bindings { parts, strings, .. } = &compiled.bindings;
    Some(strings[parts[part].string?].binding?.by)
}

/// The span that names a part: in its string, or the tag of its shape or group.
pub(super) fn span_of_part(compiled: &Compiled, part: PartId) -> Span {
    let Compiled {
        bindings, drawing, ..
    } = compiled;
    let naming = bindings.naming_element(drawing, part);
    let part = &bindings.parts[part];
    match part.string {
        Some(string) => span_of_string(compiled, string),
        None => naming.unwrap_or(&drawing.shapes[part.shape].element).span,
    }
}

/// The span that names a shape's part, or its tag.
pub(super) fn span_of_shape(compiled: &Compiled, shape: ShapeId) -> Span {
    match part_of_shape(compiled, shape) {
        Some(part) => span_of_part(compiled, part),
        None => compiled.drawing.shapes[shape].element.span,
    }
}

/// The span that names what a string describes: the name, or the whole string.
pub(super) fn span_of_string(compiled: &Compiled, string: StringId) -> Span {
    let string = &compiled.bindings.strings[string];
    let mut tokens = tokens(string).into_iter();
    match tokens.find(|token| token.item == Item::Name) {
        Some(name) => string.text.span(name.range),
        None => string.text.whole(),
    }
}
