//! What the shapes of a drawing are in which nobody has given names: heads by their eyes, wheels by their form and place, and what
//! belongs to those.
//!
//! This is only the beginning: with these names the drawing is a figure, whose limbs `label_drawn` finds as it does for motion.

mod animals;
mod bodies;
mod faces;
mod limbs;
mod mask;
mod people;
mod shapes;
mod vehicles;

pub(crate) use animals::Profile;
pub(crate) use mask::{Mask, SIDE};
pub(crate) use people::BUST;
pub(crate) use shapes::Drawn;

use crate::anatomy::Noun;
use crate::labels::Side;
use faces::Face;
use shapes::Shapes;

/// How sure it is that a shape is what it is said to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Certainty {
    /// A person should look.
    Uncertain,
    /// Several signs agree.
    Likely,
    /// Nothing else looks like this.
    Certain,
}

impl Certainty {
    /// The word for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uncertain => "uncertain",
            Self::Likely => "likely",
            Self::Certain => "certain",
        }
    }
}

/// What a shape is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Guess {
    /// The index of the shape.
    pub(crate) shape: usize,
    /// What it is.
    pub(crate) noun: Noun,
    /// Its side, if it is one of a pair; from the figure's point of view.
    pub(crate) side: Option<Side>,
    pub(crate) certainty: Certainty,
    /// Why, as a clause: `two dark spots of one size lie on it`.
    pub(crate) why: &'static str,
}

/// What shapes are, at most one guess for each.
#[derive(Debug, Default)]
pub(crate) struct Guesses {
    pub(crate) all: Vec<Guess>,
    /// Whether a head is known, or the body has one that is no shape of its own.
    pub(crate) has_head: bool,
    /// The animal in profile, if the drawing is one.
    pub(crate) profile: Option<Profile>,
}

impl Guesses {
    fn has(&self, shape: usize) -> bool {
        self.all.iter().any(|guess| guess.shape == shape)
    }

    /// What a noun was found for, or given to by a name.
    fn find(&self, noun: Noun) -> Option<usize> {
        let guess = self.all.iter().find(|guess| guess.noun == noun)?;
        Some(guess.shape)
    }

    fn add(&mut self, shape: usize, noun: Noun, certainty: Certainty, why: &'static str) {
        self.add_sided(shape, noun, None, certainty, why);
    }

    fn add_sided(
        &mut self,
        shape: usize,
        noun: Noun,
        side: Option<Side>,
        certainty: Certainty,
        why: &'static str,
    ) {
        self.has_head |= noun == Noun::Head;
        if !self.has(shape) {
            self.all.push(Guess {
                shape,
                noun,
                side,
                certainty,
                why,
            });
        }
    }
}

/// Says what units are: shapes, or groups that are one part, in the order in which they are drawn. Those that have names keep them, and
/// others are found around them. Eyes are looked for among all shapes, also those in groups.
pub(crate) fn guess(units: &[Drawn], all: &[Drawn]) -> Guesses {
    let (Some(shapes), Some(details)) = (Shapes::measure(units), Shapes::measure(all)) else {
        return Guesses::default();
    };
    let unit = |shape: usize| all[shape].unit;
    let mut guesses = Guesses::default();
    for (index, one) in units.iter().enumerate() {
        if let Some(noun) = one.known {
            guesses.add(index, noun, Certainty::Certain, "its name says so");
        }
    }
    let head = guesses.find(Noun::Head);
    if let Some(face) = faces::find(&details) {
        let face = Face {
            head: head.unwrap_or(unit(face.head)),
            eyes: face.eyes.into_iter().map(unit).collect(),
            why: face.why,
        };
        people::around(&shapes, &face, &mut guesses);
    } else if head.is_some() || !vehicles::find(&shapes, &mut guesses) {
        match animals::eye(&details) {
            Some((eye, host)) => {
                let host = head.unwrap_or(unit(host));
                animals::around(&shapes, [unit(eye), host], &mut guesses);
            }
            None => bodies::find(&shapes, head, &mut guesses),
        }
    }
    guesses
        .all
        .retain(|guess| units[guess.shape].name.is_empty());
    guesses.all.sort_by_key(|guess| guess.shape);
    guesses
}
