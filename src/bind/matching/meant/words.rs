//! What the words in a text's name say about the shape that it means: a head is at the top, a leg reaches down.
//!
//! The words count little beside the place of the text: they decide between what lies about equally near.

use glam::DVec2;

use crate::anatomy::{self, Role, Term, Thing};

/// What a unit of which words and shape agree costs less, font sizes.
const FITS: f64 = 0.5;
/// What a unit costs less that the drawing calls as the text does, font sizes.
const CALLED: f64 = 0.75;
/// What a unit costs more that contradicts the words, font sizes.
const CONTRADICTS: f64 = 1.0;
/// The ground, for a text that may mean it, font sizes.
const GROUND: f64 = 5.0;
/// The ground, for a text that names something else, font sizes: it is taken only if nothing else is left.
pub(super) const NEVER: f64 = 100.0;

/// What a name is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::bind::matching) enum Topic {
    Body,
    /// Clothes of the trunk.
    Torso,
    /// A piece of the trunk.
    Piece,
    Hips,
    Neck,
    Head,
    /// Hair, a hat.
    OnHead,
    /// A piece of a face, an ear.
    Feature,
    Arm,
    Hand,
    Leg,
    Foot,
    Tail,
    Wing,
    Cape,
    Wheel,
    /// What lies behind figures.
    Scenery,
}

/// What a name says, as far as it tells what is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(in crate::bind::matching) struct Sense {
    pub(in crate::bind::matching) topic: Option<Topic>,
    /// The name as such, by its number among those of the drawing; 0 for none.
    pub(in crate::bind::matching) name: u32,
    /// -1 for what the drawing's texts call left or right if that is on the left of the drawing, 1 if it is on the right, 0 otherwise.
    pub(in crate::bind::matching) side: i8,
}

impl Sense {
    /// What a name says; its number and its side are still to be found.
    pub(in crate::bind::matching) fn of(name: &str) -> Self {
        Self {
            topic: topic(name),
            ..Self::default()
        }
    }
}

/// Whether a name says left (-1) or right (1); 0 for neither or both.
pub(in crate::bind::matching) fn said_side(name: &str) -> i8 {
    match anatomy::sides(&anatomy::terms(name)) {
        [true, false] => -1,
        [false, true] => 1,
        _ => 0,
    }
}

fn topic(name: &str) -> Option<Topic> {
    let terms = anatomy::terms(name);
    let says = |wanted: &[Term]| terms.iter().any(|term| wanted.contains(term));
    if terms.is_empty() {
        return match anatomy::thing(name)? {
            Thing::Scenery | Thing::Shadow => Some(Topic::Scenery),
            Thing::Wheel => Some(Topic::Wheel),
            Thing::Hub => None,
        };
    }
    let by_words = [
        (Term::Cape, Topic::Cape),
        (Term::Hair, Topic::OnHead),
        (Term::HeadWear, Topic::OnHead),
    ];
    if let Some((_, topic)) = by_words.iter().find(|(term, _)| terms.contains(term)) {
        return Some(*topic);
    }
    if says(&[Term::Detail]) {
        return says(&[Term::OfHead]).then_some(Topic::Feature);
    }
    if says(&[Term::Wing]) {
        return Some(Topic::Wing);
    }
    Some(match Role::of(&terms) {
        Some(Role::Body) => Topic::Body,
        Some(Role::Chest | Role::Belly | Role::Shoulder) => Topic::Piece,
        Some(Role::Hips) => Topic::Hips,
        Some(Role::Neck) => Topic::Neck,
        Some(Role::Head) => Topic::Head,
        Some(Role::OfHead) => Topic::Feature,
        Some(Role::UpperArm | Role::LowerArm) => Topic::Arm,
        Some(Role::Hand) => Topic::Hand,
        Some(Role::Thigh | Role::Shin) => Topic::Leg,
        Some(Role::Foot | Role::Toe) => Topic::Foot,
        Some(Role::Tail) => Topic::Tail,
        None if says(&[Term::BodyWear]) => Topic::Torso,
        None if says(&[Term::HipWear]) => Topic::Hips,
        None => return None,
    })
}

/// Where a unit is in its figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// The corners of its box, as shares of the figure's.
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// The longer side of its box, measured by the shorter.
    pub(super) slender: f64,
    /// Its area beside that of the figure's largest unit.
    pub(super) size: f64,
    /// How much of its box it fills.
    pub(super) fills: f64,
    /// Whether it lies on another unit.
    pub(super) is_detail: bool,
    /// The share of the figure's units that are drawn before it.
    pub(super) drawn: f64,
}

/// What a unit costs more because of the words of a text; nothing if the drawing calls it as the text does, so that no cost is negative.
/// `own` is what its own name says, from its label or id.
pub(super) fn cost(text: Sense, own: Sense, place: Option<&Place>) -> f64 {
    if text.name != 0 && text.name == own.name {
        return 0.0;
    }
    let Some(topic) = text.topic else {
        return CALLED;
    };
    if own.topic == Some(topic) {
        return 0.0;
    }
    if own.topic.is_some_and(|own| !go_together(topic, own)) {
        return CALLED + CONTRADICTS;
    }
    match place.and_then(|place| suits(topic, text.side, place)) {
        Some(true) => CALLED - FITS,
        Some(false) => CALLED + CONTRADICTS,
        None => CALLED,
    }
}

/// What ground costs more because of the words of a text. What is drawn down to the lower corners of the page may be a bust.
pub(super) fn cost_of_ground(text: Sense, own: Sense, is_background: bool) -> f64 {
    use Topic as T;
    if text.name != 0 && text.name == own.name {
        return 0.0;
    }
    match text.topic {
        Some(T::Scenery) => CALLED - FITS,
        Some(T::Body | T::Torso | T::Piece | T::Hips | T::OnHead | T::Cape) if !is_background => {
            CALLED + GROUND
        }
        Some(_) => NEVER,
        None => CALLED + GROUND,
    }
}

/// Whether one part may have names about both: a mermaid's body is her tail, and trousers are legs.
fn go_together(one: Topic, other: Topic) -> bool {
    use Topic as T;
    let with = |topic| -> &[Topic] {
        match topic {
            T::Body => &[T::Torso, T::Piece, T::Hips, T::Tail, T::Neck],
            T::Torso => &[T::Piece, T::Hips, T::Neck, T::Cape],
            T::Piece => &[T::Neck, T::Arm],
            T::Hips => &[T::Leg, T::Tail, T::Piece],
            T::Leg => &[T::Foot],
            T::Arm => &[T::Hand, T::Wing],
            T::Wing => &[T::Cape, T::Hand],
            T::Head => &[T::Neck],
            _ => &[],
        }
    };
    one == other || with(one).contains(&other) || with(other).contains(&one)
}

/// Whether a unit suits a topic by its place and shape; `None` if it may.
fn suits(topic: Topic, side: i8, place: &Place) -> Option<bool> {
    use Topic as T;
    let Place {
        low,
        high,
        slender,
        size,
        fills,
        is_detail,
        drawn,
    } = *place;
    let middle = low.midpoint(high);
    let extent = high - low;
    let is_long = slender > 1.5;
    // Spots, outlines and pairs of things are no trunk and no head.
    let is_scattered = fills < 0.3;
    let (fits, contradicts) = match topic {
        T::Body => (
            size >= 0.6,
            size < 0.1 || is_scattered || is_detail && size < 0.4,
        ),
        T::Torso => (
            size >= 0.2 && middle.y > 0.25 && middle.y < 0.75,
            size < 0.05 || high.y < 0.25 || low.y > 0.8 || is_scattered,
        ),
        T::Piece => (false, high.y < 0.1 || low.y > 0.9),
        T::Hips => (
            middle.y > 0.45 && middle.y < 0.85 && size > 0.1,
            high.y < 0.4 || size < 0.03 || is_scattered,
        ),
        T::Neck => (
            low.y > 0.05 && high.y < 0.5 && size < 0.3 && (middle.x - 0.5).abs() < 0.2,
            low.y > 0.6 || high.y > 0.95,
        ),
        T::Head => (
            low.y < 0.15 && high.y < 0.75 && size >= 0.15 && fills > 0.5,
            low.y > 0.6 || size < 0.08 || is_scattered,
        ),
        T::OnHead => (low.y < 0.01 && high.y < 0.75, low.y > 0.6),
        T::Feature => (size < 0.15 && middle.y < 0.45, low.y > 0.7 || size > 0.5),
        T::Arm => (
            is_long && size < 0.6 && middle.y > 0.15 && middle.y < 0.75,
            size >= 1.0 || high.y < 0.15 || low.y > 0.85 || size < 0.02,
        ),
        T::Hand => (false, size > 0.5 || high.y < 0.15),
        T::Leg => (
            low.y > 0.4 && high.y > 0.75 && size < 0.9,
            high.y < 0.55 || size < 0.02,
        ),
        T::Foot => (low.y > 0.75 && size < 0.5, high.y < 0.6 || extent.y > 0.5),
        T::Tail => {
            let out = low.x.min(1.0 - high.x);
            (
                out < 0.03 && size < 0.95 && !is_detail,
                out > 0.2 && is_detail,
            )
        }
        T::Wing => (false, size < 0.03),
        T::Cape => (drawn < 0.5 && extent.x > 0.3 && size > 0.2, size < 0.1),
        T::Wheel => (
            slender < 1.2 && (0.7..0.85).contains(&fills) && high.y > 0.6,
            high.y < 0.3,
        ),
        T::Scenery => (false, size < 0.1),
    };
    let beside = f64::from(side) * (middle.x - 0.5);
    if contradicts || beside < -0.15 {
        Some(false)
    } else if fits && beside >= 0.0 {
        Some(true)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(low: [f64; 2], high: [f64; 2]) -> Place {
        Place {
            low: low.into(),
            high: high.into(),
            slender: 3.0,
            size: 0.3,
            fills: 0.8,
            is_detail: false,
            drawn: 0.5,
        }
    }

    #[test]
    fn sides_decide_between_limbs_and_place_between_topics() {
        let left = place([0.0, 0.3], [0.2, 0.6]);
        let right = place([0.8, 0.3], [1.0, 0.6]);
        assert_eq!(suits(Topic::Arm, -1, &left), Some(true));
        assert_eq!(suits(Topic::Arm, -1, &right), Some(false));
        assert_eq!(suits(Topic::Arm, 1, &left), Some(false));
        assert_eq!(suits(Topic::Arm, 0, &right), Some(true));
        let low = place([0.3, 0.65], [0.45, 1.0]);
        assert_eq!(suits(Topic::Leg, 0, &low), Some(true));
        assert_eq!(suits(Topic::Head, 0, &low), Some(false));
        assert_eq!(suits(Topic::Leg, 0, &left), None);
    }

    #[test]
    fn no_cost_is_negative() {
        let names = ["Head", "Arm", "Sky", "Wheel", "Zork", "Cape", "髪"];
        let places = [None, Some(place([0.0, 0.0], [0.5, 0.2]))];
        for text in names {
            for own in names {
                let [text, own] = [text, own].map(Sense::of);
                for place in &places {
                    assert!(cost(text, own, place.as_ref()) >= 0.0);
                }
                assert!(cost_of_ground(text, own, true) >= 0.0);
                assert!(cost_of_ground(text, own, false) >= 0.0);
            }
        }
    }
}
