//! Names in pictures: the strings on or beside the regions that a picture shows.

use glam::DVec2;

use super::diagnostics;
use super::drawn::{Drawn, MOST_REGIONS, say};
use super::region::Region;
use crate::assignment::most_gainful;
use crate::bind::{Bindings, LayerId, StringHolder, StringId};
use crate::diagnostic::Diagnostic;
use crate::geometry::{area, border_distance_squared, contains};
use crate::lang::ast::Annotation;
use crate::svg::{Drawing, ShapeId};

/// How much farther away a region seems that a text only begins or ends on, or beside, font sizes.
const BESIDE: f64 = 0.1;
/// The greatest distance from a text to a region that is told apart from a greater one, font sizes.
const FAR: f64 = 1e6;
/// What a string gains by a region at no distance: more than it could save others.
const GAIN: f64 = 1e10;

/// Gives the strings that are about the pictures of a view to the regions of these, one to one: a description to the largest one of its
/// picture, a text to the one under its middle or at the end of its leader, or else the nearest, so that the sum of distances is least.
pub(super) fn assign(
    drawing: &Drawing,
    bindings: &Bindings,
    layer: LayerId,
    regions: &mut [(Region, Drawn)],
    diagnostics: &mut Vec<Diagnostic>,
) {
    let strings = bindings.strings.iter_enumerated();
    let is_own = |string: StringId| bindings.view_of_string(drawing, string) == Some(layer);
    let strings = strings.filter(|(index, string)| string.is_of_picture && is_own(*index));
    let (texts, described): (Vec<_>, Vec<_>) =
        strings.partition(|(_, string)| matches!(string.holder, StringHolder::Label(_)));
    let is_in_picture =
        |(_, drawn): &(Region, Drawn)| drawing.shapes[drawn.shape].picture.is_some();
    for (index, string) in described {
        if let StringHolder::Shape(shape) = string.holder
            && let Some(largest) = largest_of(regions, shape)
        {
            name(bindings, index, &mut regions[largest], diagnostics);
        }
    }
    let free = regions.iter().enumerate();
    let free = free.filter(|(_, region)| is_in_picture(region) && region.1.string.is_none());
    let free: Vec<usize> = free.map(|(index, _)| index).collect();
    let texts: Vec<StringId> = texts.into_iter().map(|(index, _)| index).collect();
    let (compared, others) = texts.split_at(texts.len().min(MOST_REGIONS));
    let found = match regions.len() {
        0..=MOST_REGIONS => assigned(drawing, bindings, compared, regions, &free),
        // Such a view is left out, which is reported.
        _ => return,
    };
    let mut left_over = others.to_vec();
    for (index, region) in compared.iter().zip(found) {
        match region {
            Some(region) => name(bindings, *index, &mut regions[region], diagnostics),
            None => left_over.push(*index),
        }
    }
    diagnostics::without_region(bindings, &left_over, diagnostics);
}

/// The largest region of a picture.
fn largest_of(regions: &[(Region, Drawn)], picture: ShapeId) -> Option<usize> {
    let own = regions.iter().enumerate();
    let own = own.filter(|(_, (_, drawn))| drawn.shape == picture);
    let areas = own.map(|(index, (region, _))| (index, area(&region.outline)));
    let largest = areas.reduce(|best, next| if next.1 > best.1 { next } else { best });
    largest.map(|(index, _)| index)
}

/// The region of each text.
fn assigned(
    drawing: &Drawing,
    bindings: &Bindings,
    texts: &[StringId],
    regions: &[(Region, Drawn)],
    free: &[usize],
) -> Vec<Option<usize>> {
    let topmost = |point: DVec2| {
        let mut all = regions.iter();
        all.rposition(|(region, _)| contains(&region.outline, point))
    };
    let mut gains = Vec::with_capacity(texts.len() * free.len());
    for text in texts {
        let points = bindings
            .points_of_string(drawing, *text)
            .unwrap_or_default();
        let em = match bindings.strings[*text].holder {
            StringHolder::Label(label) => drawing.labels[label].0.font_size,
            StringHolder::Shape(_) | StringHolder::Group(_) => 0.0,
        };
        let em = if em > 0.0 { em } else { 1.0 };
        let under = points.map(topmost);
        gains.extend(free.iter().map(|region| {
            if under[1] == Some(*region) {
                return GAIN;
            }
            let distances = points.iter().zip(under).map(|(point, under)| {
                if under == Some(*region) {
                    return 0.0;
                }
                border_distance_squared(&regions[*region].0.outline, *point).sqrt() / em
            });
            GAIN - (distances.fold(FAR, f64::min) + BESIDE)
        }));
    }
    let gain = |text: usize, region: usize| gains.get(text * free.len() + region).copied();
    let found = most_gainful(texts.len(), free.len(), gain);
    found
        .into_iter()
        .map(|region| Some(free[region?]))
        .collect()
}

/// Gives a region its string.
fn name(
    bindings: &Bindings,
    string: StringId,
    (region, drawn): &mut (Region, Drawn),
    diagnostics: &mut Vec<Diagnostic>,
) {
    let said = &bindings.strings[string];
    if let Annotation::Part(part) = &said.annotation {
        region.name = part.name.as_ref().map(|name| name.text.clone());
    }
    drawn.string = Some(string);
    say(&said.settings, drawn);
    diagnostics.extend(diagnostics::without_effect_in_picture(said));
}
