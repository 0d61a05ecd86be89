//! What the names in texts say, and the names that the shapes and groups have that texts may mean.

use rayon::prelude::*;
use rustc_hash::FxHashMap;
use typed_index_collections::TiSlice;

use super::meant::{Sense, UnitName, said_side};
use super::parts::MatchedPart;
use super::strings::ReadString;
use crate::anatomy::name_words;
use crate::bind::bindings::StringId;
use crate::bind::names::{OwnName, of_element};
use crate::index::par_keys;
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, GroupId, ShapeId};
use crate::threads::GRAIN;

/// What names say.
#[derive(Debug, Default)]
pub(super) struct Said {
    /// Per text that names a part.
    texts: FxHashMap<StringId, Sense>,
    /// Per group that has a name from a person.
    groups: FxHashMap<GroupId, Sense>,
    /// Per shape likewise.
    shapes: FxHashMap<ShapeId, Sense>,
}

impl Said {
    /// Reads the names in texts, each given with the x of its middle, and those of the shapes and groups.
    pub(super) fn read(
        drawing: &Drawing,
        strings: &TiSlice<StringId, ReadString>,
        texts: impl Iterator<Item = (StringId, f64)>,
    ) -> Self {
        let named = texts.filter_map(|(string, middle)| {
            let Annotation::Part(part) = &strings[string].annotation else {
                return None;
            };
            Some((string, middle, part.name.as_ref()?.text.as_str()))
        });
        let named: Vec<(StringId, f64, &str)> = named.collect();
        if named.is_empty() {
            return Self::default();
        }
        // Only names in texts have numbers, so that a number says which text it is from and depends on nothing else.
        let mut numbers: FxHashMap<String, u32> = FxHashMap::default();
        for (number, (_, _, name)) in (1..).zip(&named) {
            numbers.entry(comparable(name)).or_insert(number);
        }
        let sense = |name: &str| Sense {
            name: numbers.get(&comparable(name)).copied().unwrap_or(0),
            ..Sense::of(name)
        };
        let read = named.par_iter().with_min_len(GRAIN);
        let read = read.map(|(string, _, name)| (*string, sense(name)));
        let mut texts: FxHashMap<StringId, Sense> = read.collect();
        find_sides(&named, &mut texts);
        let of_person = |own: OwnName| sense(&own.name);
        let groups = par_keys(&drawing.groups).with_min_len(GRAIN);
        let groups = groups.filter_map(|group| {
            let own = of_element(&drawing.groups[group].element, None)?;
            Some((group, of_person(own)))
        });
        let shapes = par_keys(&drawing.shapes).with_min_len(GRAIN);
        let shapes = shapes.filter_map(|shape| {
            let own = of_element(&drawing.shapes[shape].element, None)?;
            Some((shape, of_person(own)))
        });
        Self {
            texts,
            groups: groups.collect(),
            shapes: shapes.collect(),
        }
    }

    /// What the name in a text says; nothing for texts that name no part.
    pub(super) fn by(&self, string: StringId) -> Sense {
        self.texts.get(&string).copied().unwrap_or_default()
    }

    /// What is known of the unit of a main part.
    pub(super) fn of_unit(
        &self,
        part: &MatchedPart,
        backgrounds: &TiSlice<ShapeId, bool>,
    ) -> UnitName {
        let group = part.node_group.and_then(|group| self.groups.get(&group));
        let own = group.or_else(|| self.shapes.get(&part.shape));
        UnitName {
            own: own.copied().unwrap_or_default(),
            is_background: backgrounds[part.shape],
        }
    }
}

/// A name as it is compared with others: its words, without the signs between them.
fn comparable(name: &str) -> String {
    name_words::split(name).concat()
}

/// Finds on which side of the drawing is what texts call left and right. People mean a figure's own left or that of the page; the
/// texts of a pair, such as those of both arms, stand in the order of what they mean.
fn find_sides(named: &[(StringId, f64, &str)], texts: &mut FxHashMap<StringId, Sense>) {
    let sided = named
        .iter()
        .map(|(string, middle, name)| (*string, *middle, said_side(name)));
    let sided: Vec<(StringId, f64, i8)> = sided.filter(|(_, _, side)| *side != 0).collect();
    // Per topic the sum of the places, and the number, of what is called left and right.
    let mut pairs: FxHashMap<Sense, [(f64, u32); 2]> = FxHashMap::default();
    for (string, middle, side) in &sided {
        let Some(sense) = texts.get(string) else {
            continue;
        };
        let topic = Sense { name: 0, ..*sense };
        let (sum, count) = &mut pairs.entry(topic).or_default()[usize::from(*side > 0)];
        *sum += middle;
        *count += 1;
    }
    let order = pairs.values().map(|[left, right]| {
        let [left, right] = [left, right].map(|(sum, count)| sum / f64::from(*count));
        // Without one of both, its place is no number.
        i32::from(left < right) - i32::from(left > right)
    });
    let order = order.sum::<i32>().signum();
    for (string, _, side) in sided {
        if let Some(sense) = texts.get_mut(&string) {
            sense.side = match order {
                0 => 0,
                1 => side,
                _ => -side,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sides of names, each given with its place.
    fn sides(named: &[(f64, &str)]) -> Vec<i8> {
        let named: Vec<(StringId, f64, &str)> = named
            .iter()
            .enumerate()
            .map(|(index, (middle, name))| (index.into(), *middle, *name))
            .collect();
        let mut texts = named
            .iter()
            .map(|(string, _, name)| (*string, Sense::of(name)))
            .collect();
        find_sides(&named, &mut texts);
        named
            .iter()
            .map(|(string, ..)| texts[string].side)
            .collect()
    }

    #[test]
    fn pairs_tell_whose_left_is_meant() {
        assert_eq!(sides(&[(10.0, "Left arm"), (90.0, "Right arm")]), [-1, 1]);
        assert_eq!(sides(&[(10.0, "Rarm"), (90.0, "Larm")]), [-1, 1]);
        // One pair tells it for what has no partner, and a lone one tells nothing.
        let with_ear = [(10.0, "右腕"), (90.0, "左腕"), (90.0, "左耳")];
        assert_eq!(sides(&with_ear), [-1, 1, 1]);
        assert_eq!(sides(&[(10.0, "Left arm"), (90.0, "Right leg")]), [0, 0]);
        assert_eq!(sides(&[(10.0, "Arm"), (90.0, "Leg")]), [0, 0]);
    }
}
