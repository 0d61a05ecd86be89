//! Depths that numbers give to a part: those of `Shape`, and `Offset`, in its own string or in its legend.

use std::ops::Range;

use super::{SetBy, Source};
use crate::bind::bindings::{Bindings, PartId, StringId};
use crate::diagnostic::Edit;
use crate::lang::ast::{Annotation, Attribute};
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::source::Span;

/// The settings that say how deep a part lies; at least one of them is set.
#[derive(Debug, Clone, Copy)]
pub struct GivenDepth<'a> {
    /// The part.
    pub part: PartId,
    /// `Shape` with depths.
    pub shape: Option<Source<'a>>,
    /// `Offset`.
    pub offset: Option<Source<'a>>,
}

impl<'a> GivenDepth<'a> {
    /// Whether a legend gives it, and with it that of all parts with the paint.
    pub fn is_in_legend(&self) -> bool {
        self.sources().any(|source| source.from == SetBy::Legend)
    }

    /// The settings.
    fn sources(&self) -> impl Iterator<Item = Source<'a>> + use<'a> {
        self.shape.into_iter().chain(self.offset)
    }
}

impl Bindings {
    /// What gives a part its depth; `None` if the program is to find it. Depths after `%` are a thickness only.
    pub fn given_depth(&self, part: PartId) -> Option<GivenDepth<'_>> {
        let own = |keyword: Keyword| {
            let source = self.setting(part, keyword);
            source.filter(|source| source.from < SetBy::Default)
        };
        let has_depths = |source: &Source<'_>| matches!(&source.setting.value, Value::Shape(shape) if shape.has_depths);
        let given = GivenDepth {
            part,
            shape: own(Keyword::Shape).filter(has_depths),
            offset: own(Keyword::Offset),
        };
        given.sources().next().is_some().then_some(given)
    }

    /// The place of the settings that give a depth. If they are in two strings, that of the first.
    pub fn span_of_depth(&self, given: &GivenDepth<'_>) -> Span {
        let mut sources = given.sources();
        let first = sources
            .next()
            .map_or(Span::at(0), |source| self.span_of(&source));
        match (given.shape, given.offset) {
            (Some(shape), Some(offset)) if shape.string == offset.string => {
                first.join(self.span_of(&offset))
            }
            _ => first,
        }
    }

    /// The edits that take the depths away. A kind that the part would have anyway goes with its depths, so that the part gets
    /// the thickness that `%Shape` sets; otherwise the kind stays without them.
    ///
    /// `None` if a copy (`-s`, `-d`) would then coincide with its original, or if nothing of a legend would be left.
    pub fn without_depth(&self, given: &GivenDepth<'_>) -> Option<Vec<Edit>> {
        let mut edits = Vec::new();
        let mut strings: Vec<StringId> = given.sources().map(|source| source.string).collect();
        strings.dedup();
        for string in strings {
            let text = &self.strings[string].text;
            let (attributes, sign) = match &self.strings[string].annotation {
                Annotation::Part(part) => (part.attributes.as_slice(), part.signs.last()),
                Annotation::Legend(attributes) => (attributes.as_slice(), None),
                _ => return None,
            };
            let mut cuts: Vec<Range<usize>> = Vec::new();
            let mut whole = vec![false; attributes.len()];
            for source in given.sources().filter(|source| source.string == string) {
                let mut found = attributes.iter();
                let index = found.position(|found| found.range == source.setting.range)?;
                match &source.setting.value {
                    Value::Shape(shape) if shape.mirrored || shape.doubled => return None,
                    Value::Shape(shape)
                        if !(source.from == SetBy::Own
                            && self.is_usual(given.part, shape.kind, &attributes[index])) =>
                    {
                        let arguments = &attributes[index].arguments;
                        let (kind, last) = (arguments.first()?, arguments.last()?);
                        cuts.push(kind.range.end..last.range.end);
                    }
                    _ => whole[index] = true,
                }
            }
            if attributes.iter().any(has_copies) {
                return None;
            }
            cuts.extend(cuts_of(attributes, &whole, sign)?);
            cuts.sort_by_key(|cut| cut.start);
            for cut in cuts {
                edits.extend(Edit::replacing(text, cut, "")?);
            }
        }
        edits.sort_by_key(|edit| edit.span);
        Some(edits)
    }

    /// Whether a part would have this kind of `Shape` without the attribute of its own string that sets it.
    fn is_usual(&self, part: PartId, kind: &str, attribute: &Attribute) -> bool {
        let usual = self.inherited(part, Keyword::Shape);
        let is_usual = match usual.map(|usual| (usual.from, &usual.setting.value)) {
            Some((SetBy::Default, Value::Shape(usual))) => {
                usual.kind == kind && !usual.mirrored && !usual.doubled
            }
            Some(_) => false,
            None => kind == "default",
        };
        attribute.flags.is_empty() && is_usual
    }
}

/// Whether an attribute makes copies of its part.
fn has_copies(attribute: &Attribute) -> bool {
    let is_copy = |flag: &char| matches!(flag.to_ascii_lowercase(), 's' | 'd');
    attribute.keyword == Keyword::Shape && attribute.flags.iter().any(|(flag, _)| is_copy(flag))
}

/// The ranges of whole attributes with the white space beside them. Nothing is left after the sign of a part without attributes.
fn cuts_of(
    attributes: &[Attribute],
    whole: &[bool],
    sign: Option<&Range<usize>>,
) -> Option<Vec<Range<usize>>> {
    let (first, last) = (attributes.first()?, attributes.last()?);
    let mut cuts: Vec<Range<usize>> = Vec::new();
    if whole.iter().all(|whole| *whole) {
        let sign = sign.filter(|sign| sign.end <= first.range.start)?;
        cuts.push(sign.start..last.range.end);
        return Some(cuts);
    }
    let kept = |index: &usize| !whole[*index];
    let cut = |index: usize| {
        let next = (index + 1..whole.len()).find(kept);
        match next {
            Some(next) => attributes[index].range.start..attributes[next].range.start,
            None => {
                let before = (0..index).rfind(kept).unwrap_or_default();
                attributes[before].range.end..last.range.end
            }
        }
    };
    for index in (0..whole.len()).filter(|index| whole[*index]) {
        let cut = cut(index);
        // Neighbours that go together are cut as one.
        if cuts.last().is_none_or(|last| last.end <= cut.start) {
            cuts.push(cut);
        }
    }
    Some(cuts)
}

#[cfg(test)]
mod tests {
    use crate::compile::{Options, compile};
    use crate::diagnostic::applied;
    use crate::resolver::MemoryResolver;

    /// The string of a part, after its depths were taken away.
    fn without(defaults: &str, string: &str) -> Option<String> {
        let head = "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'><rect width='60' height='60'><desc>";
        let source =
            format!("{head}{string}</desc></rect><text x='2' y='90'>{defaults}</text></svg>");
        let compiled = compile(&source, &Options::default(), &MemoryResolver::default());
        let given = compiled.bindings.given_depth(0.into())?;
        let edits = compiled.bindings.without_depth(&given)?;
        let after = applied(&source, &edits);
        let compiled = compile(&after, &Options::default(), &MemoryResolver::default());
        assert!(compiled.bindings.given_depth(0.into()).is_none(), "{after}");
        let end = after.find("</desc>").unwrap();
        Some(after[head.len()..end].to_owned())
    }

    #[test]
    fn depths_are_taken_away_and_nothing_else() {
        for (string, after) in [
            ("A$Shape default -20 20", "A"),
            ("A@Root$ Shape default -20 20", "A@Root"),
            ("A$Shape cone 0 20", "A$Shape cone"),
            (
                "A$Shape -c default 0 20 Color red",
                "A$Shape -c default Color red",
            ),
            ("A$Shape default 0 20 Color red", "A$Color red"),
            ("A$Color red  Shape default 0 20", "A$Color red"),
            ("A$Shape inflate 3 Offset 33", "A$Shape inflate 3"),
            (
                "A$Offset 5 Shape flat 2 Color red",
                "A$Shape flat Color red",
            ),
            ("A$Color red Shape default 1 2 Offset 5", "A$Color red"),
            ("A$Shape default 1 2 Offset 5 Color red", "A$Color red"),
            ("A$Shape default 1 2 Color red Offset 5", "A$Color red"),
            ("A$Shape default (2 * 3) (-4) Smooth 0", "A$Smooth 0"),
        ] {
            assert_eq!(without("", string).as_deref(), Some(after), "{string}");
        }
        let kept = without("%Shape inflate", "A$Shape default -20 20");
        assert_eq!(kept.as_deref(), Some("A$Shape default"));
        let usual = without("%Shape inflate", "A$Shape flat 3 Offset 2");
        assert_eq!(usual.as_deref(), Some("A$Shape flat"));
        let usual = without("%Shape default -9 9", "A$Shape default -20 20 Smooth 0");
        assert_eq!(usual.as_deref(), Some("A$Smooth 0"));
    }

    #[test]
    fn copies_keep_their_depths() {
        assert_eq!(without("", "A$Shape -s default 20 31"), None);
        assert_eq!(without("", "A$Shape -d inflate Offset 9"), None);
    }

    #[test]
    fn a_thickness_for_all_parts_is_no_given_depth() {
        assert_eq!(without("%Shape default -9 9", "A$Color red"), None);
        assert_eq!(without("%Offset 9", "A$Shape inflate 5"), None);
    }
}
