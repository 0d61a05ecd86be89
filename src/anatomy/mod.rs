//! What words mean in the names of parts and joints: head, arm, left, upper.
//!
//! One set of tables for all who read names: [`terms`] gives the meanings of a name's words.

mod clothes;
pub(crate) mod name_words;
mod role;
mod things;
mod vocabulary;
mod written;

pub(crate) use clothes::dress;
pub(crate) use role::{Role, sides};
pub(crate) use things::{
    Garment, Thing, end_of_vehicle, garment, is_bike, is_crawler, is_disc, is_fin, is_light,
    is_plant, is_rolling, is_sheet, is_supple, is_tentacle, says_far_or_near, thing,
};
pub(crate) use vocabulary::{Term, is_several_limbs, terms};
pub(crate) use written::{Language, Noun};

/// Whether a name is that of a limb that is attached at one end: an arm or a leg or a piece of one, a wing, a tail, a neck, an ear.
/// Hands, feet and what is worn are none.
pub(crate) fn is_hinged(terms: &[Term]) -> bool {
    let says = |wanted: &[Term]| terms.iter().any(|term| wanted.contains(term));
    if says(&[Term::Ear]) {
        return true;
    }
    let limb = [
        Term::Arm,
        Term::UpperArm,
        Term::LowerArm,
        Term::Leg,
        Term::Thigh,
        Term::Shin,
        Term::Tail,
        Term::Neck,
    ];
    let at_its_end = [Term::Hand, Term::Foot, Term::Toe, Term::Detail];
    says(&limb) && !says(&at_its_end)
}

/// Whether a name is that of something which a figure has several of, each on its own: arms and legs, their pieces and what is worn on
/// them, wheels.
pub(crate) fn comes_in_pairs(name: &str) -> bool {
    let pieces = [
        Term::Arm,
        Term::UpperArm,
        Term::LowerArm,
        Term::Hand,
        Term::Leg,
        Term::LegOrFoot,
        Term::Thigh,
        Term::Shin,
        Term::Foot,
        Term::Sleeve,
        Term::Stocking,
        Term::Worn,
    ];
    terms(name).iter().any(|term| pieces.contains(term)) || is_disc(name)
}

/// Whether a name is that of several legs: `Legs`, `両脚`.
pub(crate) fn are_legs(name: &str) -> bool {
    is_several_limbs(name) && Role::of(&terms(name)) == Some(Role::Thigh)
}

/// Whether a name says that its part hangs downwards from its joint as long as nothing holds it up: arms, legs and ears.
pub(crate) fn hangs(terms: &[Term]) -> bool {
    is_hinged(terms)
        && !terms
            .iter()
            .any(|term| matches!(term, Term::Tail | Term::Neck))
}
