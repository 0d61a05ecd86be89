//! What a vehicle shows about where its front end is.

use super::{Bounds, For, Observed, middle, side_of, weight, width};
use crate::anatomy::{self, Term};
use crate::labels::vehicle::boxes;

/// What is at most this share of the vehicle's width off its middle says nothing about its ends.
const OFF: f64 = 0.1;
/// Two lights mirror each other about the vehicle's middle up to this share of its width, and differ in size by at most this share.
const MIRRORED: f64 = 0.1;
const ALIKE: f64 = 0.3;
/// The most lights that are looked at.
const MAX_LIGHTS: usize = 16;

impl Observed<'_> {
    pub(super) fn wheels(&self, vote: &mut impl FnMut(For, f64, String)) {
        if self.wheels.is_empty() {
            return;
        }
        let why = "its wheels stand in a row".to_owned();
        vote(For::Profile, weight::WHEELS, why);
        let whole = self.tree.around(self.tree.parts.keys());
        self.lights(whole, vote);
        self.ends(whole, vote);
        self.front_wheels(whole, vote);
    }

    /// Lights on both sides are seen from the front, or from behind.
    fn lights(&self, whole: Bounds, vote: &mut impl FnMut(For, f64, String)) {
        let parts = self.tree.parts.iter_enumerated();
        let lights = parts.filter(|(_, part)| anatomy::is_light(&part.name));
        let lights = lights.flat_map(|(index, _)| boxes(self.tree, index));
        let lights: Vec<Bounds> = lights.take(MAX_LIGHTS).collect();
        let axis = middle(whole).x;
        let size = whole[1] - whole[0];
        let is_pair = |one: &Bounds, other: &Bounds| {
            let [a, b] = [one, other].map(|light| middle(*light).x - axis);
            let [of_one, of_other] = [one, other].map(|light| light[1] - light[0]);
            let level = middle(*one).y - middle(*other).y;
            a * b < 0.0
                && (a + b).abs() <= MIRRORED * size.x
                && level.abs() <= MIRRORED * size.y
                && (of_one - of_other)
                    .abs()
                    .cmple(ALIKE * of_one.max(of_other))
                    .all()
        };
        let mut each = lights.iter().enumerate();
        if each.any(|(place, one)| lights[place + 1..].iter().any(|other| is_pair(one, other))) {
            let why = "it shows a light on either side".to_owned();
            vote(For::Front, weight::SYMMETRY, why);
        }
    }

    /// Names of what vehicles have at their ends: headlights, a hood, a driver.
    fn ends(&self, whole: Bounds, vote: &mut impl FnMut(For, f64, String)) {
        let axis = middle(whole).x;
        let parts = self.tree.parts.iter_enumerated().map(|(index, part)| {
            let drawn = boxes(self.tree, index).into_iter();
            let drawn = drawn.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            (part.name.as_str(), drawn.unwrap_or(part.bounds))
        });
        let details = self.tree.parts.iter().flat_map(|part| &part.details);
        let details = details.map(|detail| (detail.name.as_str(), detail.bounds));
        let said = parts.chain(details).filter_map(|(name, bounds)| {
            let end = anatomy::end_of_vehicle(name)?;
            let off = (middle(bounds).x - axis) / width(whole).max(f64::MIN_POSITIVE);
            (off.abs() > OFF).then_some((name, end * off))
        });
        let said: Vec<(&str, f64)> = said.collect();
        let toward = said.iter().map(|(_, off)| off).sum::<f64>();
        let agrees = |(_, off): &&(&str, f64)| off * toward > 0.0;
        let (Some((name, _)), true) = (said.iter().find(agrees), toward != 0.0) else {
            return;
        };
        let why = format!(
            "its `{name}` says that its front end is on the {}",
            side_of(toward)
        );
        vote(For::Side(toward.signum()), weight::WORDS, why);
    }

    /// Names that say front and rear.
    fn front_wheels(&self, whole: Bounds, vote: &mut impl FnMut(For, f64, String)) {
        let mean = |terms: &[Term]| {
            let parts = self.tree.parts.keys();
            let said = parts.filter(|part| {
                let draft = &self.drafts[*part];
                draft.class.is_none() && draft.says(terms)
            });
            let at: Vec<f64> = said.map(|part| self.tree.middle(part).x).collect();
            (!at.is_empty()).then(|| at.iter().sum::<f64>() / at.len() as f64)
        };
        let axis = middle(whole).x;
        let off = match [mean(&[Term::Fore]), mean(&[Term::Hind, Term::Back])] {
            [Some(fore), Some(hind)] => fore - hind,
            [Some(fore), None] => fore - axis,
            [None, Some(hind)] => axis - hind,
            [None, None] => return,
        };
        if off.abs() > OFF * width(whole) {
            let why = format!("names say that its front end is on the {}", side_of(off));
            vote(For::Side(off.signum()), weight::WORDS, why);
        }
    }
}
