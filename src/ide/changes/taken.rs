//! What the names of a drawing say already, so that nothing else gets a name for the same.

use rustc_hash::FxHashSet;

use super::unnamed::Found;
use crate::anatomy::{Noun, Role, Term, dress, is_several_limbs, sides, terms};
use crate::labels::Side;

/// The names of a drawing, and the roles that they take.
pub(super) struct Taken {
    pub(super) names: FxHashSet<String>,
    roles: Vec<Taking>,
    /// What names say of a head: its eyes, its ears, what it wears.
    of_head: Vec<(Term, Option<Side>)>,
}

/// A role that a name takes.
struct Taking {
    role: Role,
    /// `None` where it does not say one.
    side: Option<Side>,
    /// Whether it is a fore limb or a hind one, if it says so.
    fore: Option<bool>,
    /// Whether it is the far one or the near one, if it says so.
    far: Option<bool>,
    /// Whether it stands for both sides.
    several: bool,
}

impl Taken {
    pub(super) fn of(names: &[&str]) -> Self {
        let mut all: Vec<Vec<Term>> = names.iter().map(|name| terms(name)).collect();
        let features = [Term::Eye, Term::Ear, Term::HeadWear];
        let of_head = all.iter().flat_map(|name| {
            let said = features.iter().filter(|term| name.contains(term));
            said.map(|term| (*term, side(name)))
        });
        let of_head = of_head.collect();
        // A hat does not say that no other part is the head.
        let is_hat = |name: &&mut Vec<Term>| name.contains(&Term::HeadWear);
        all.iter_mut().filter(is_hat).for_each(Vec::clear);
        dress(&mut all);
        let roles = names.iter().zip(&all);
        let roles = roles.flat_map(|(name, terms)| Taking::of(name, terms));
        Self {
            names: names.iter().map(|name| (*name).to_owned()).collect(),
            roles: roles.collect(),
            of_head,
        }
    }

    /// Whether a name says already what was found.
    pub(super) fn takes(&self, found: &Found) -> bool {
        let says = |term: Term| {
            self.of_head.iter().any(|(own, side)| {
                *own == term && (side.is_none() || found.side.is_none() || *side == found.side)
            })
        };
        let role = match found.noun {
            Noun::Eye | Noun::Eyes => return says(Term::Eye),
            Noun::Ear | Noun::Ears => return says(Term::Ear),
            Noun::Hat => return says(Term::HeadWear),
            Noun::Horns => return says(Term::Horn),
            noun => noun.role(),
        };
        role.is_some_and(|role| self.roles.iter().any(|taking| taking.is(role, found)))
    }
}

impl Taking {
    /// The roles of a name: 足 is a leg, or a foot.
    fn of(name: &str, terms: &[Term]) -> Vec<Self> {
        let roles = if terms.contains(&Term::LegOrFoot) {
            vec![Role::Thigh, Role::Foot]
        } else {
            Role::of(terms).into_iter().collect()
        };
        let name_has = |words: [&str; 2]| {
            let name = name.to_lowercase();
            words.iter().any(|word| name.contains(word))
        };
        let taking = |role| Self {
            role,
            side: side(terms),
            fore: either([terms.contains(&Term::Fore), terms.contains(&Term::Hind)]),
            far: either([name_has(["far", "奥"]), name_has(["near", "手前"])]),
            several: is_several_limbs(name) || sides(terms) == [true; 2],
        };
        roles.into_iter().map(taking).collect()
    }

    fn is(&self, role: Role, found: &Found) -> bool {
        let trunk = |role: Role| match role {
            Role::Chest | Role::Belly => Role::Body,
            other => other,
        };
        if trunk(self.role) != role {
            return false;
        }
        if !role.is_piece_of_limb() {
            return true;
        }
        let far = match found.noun {
            Noun::FarLegs => Some(true),
            Noun::NearLegs => Some(false),
            _ => None,
        };
        let may_be = |own: Option<bool>, other: Option<bool>| {
            own.is_none() || other.is_none() || own == other
        };
        // A name that says no side is that of one limb, and labels say of which.
        let is_side = match found.side {
            Some(side) => self.several || self.side == Some(side),
            None => true,
        };
        is_side && may_be(self.fore, found.fore) && may_be(self.far, far)
    }
}

/// Which of two is said; `None` if both or none are.
fn either([yes, no]: [bool; 2]) -> Option<bool> {
    (yes != no).then_some(yes)
}

fn side(terms: &[Term]) -> Option<Side> {
    let is_left = either(sides(terms))?;
    Some(if is_left { Side::Left } else { Side::Right })
}

#[cfg(test)]
mod tests {
    use super::*;
    fn takes(names: &[&str], noun: Noun, side: Option<Side>) -> bool {
        Taken::of(names).takes(&Found::new(0, noun, side))
    }

    #[test]
    fn other_words_for_a_part_take_its_role() {
        for body in ["Torso", "Chest", "胴体", "Jacket"] {
            assert!(takes(&[body], Noun::Body, None), "{body}");
            assert!(!takes(&[body], Noun::Head, None), "{body}");
        }
        assert!(takes(&["skull"], Noun::Head, None));
        assert!(!takes(&["Cap"], Noun::Head, None));
        assert!(takes(&["Cap"], Noun::Hat, None));
        assert!(takes(&["Left eye"], Noun::Eyes, None));
        assert!(!takes(&["Left eye"], Noun::Eye, Some(Side::Right)));
    }

    #[test]
    fn a_limb_takes_only_its_own_side() {
        let [left, right] = Side::BOTH.map(Some);
        assert!(takes(&["Left wing"], Noun::Arm, left));
        assert!(!takes(&["Left wing"], Noun::Arm, right));
        assert!(takes(&["Arms"], Noun::UpperArm, right));
        assert!(takes(&["左足"], Noun::Foot, left));
        assert!(!takes(&["左足"], Noun::Foot, right));
        assert!(takes(&["Near legs"], Noun::NearLegs, None));
        assert!(!takes(&["Near legs"], Noun::FarLegs, None));
    }
}
