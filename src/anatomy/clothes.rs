//! Clothes that name what wears them: armour in a figure without a body by name is its body.

use super::Term;

/// Clothes, the names of what wears them, and what they are where nothing has such a name.
const GARMENTS: [(Term, &[Term], Term); 3] = [
    (
        Term::BodyWear,
        &[Term::Body, Term::Chest, Term::Belly],
        Term::Body,
    ),
    (Term::HeadWear, &[Term::Head, Term::Face], Term::Head),
    (
        Term::HipWear,
        &[Term::Hips, Term::Hip, Term::Waist],
        Term::Hips,
    ),
];

/// Completes the words in the names of one figure's parts, given in drawing order. If no part is called a body, the first
/// garment of a body is one; all other garments are details. Likewise with head and hips. Names that also say a limb, such as
/// `left trouser leg`, stay as they are.
pub(crate) fn dress(names: &mut [Vec<Term>]) {
    for (garment, wearers, wearer) in GARMENTS {
        let is_free = |name: &[Term]| !name.iter().any(|term| is_limb_or_detail(*term));
        let is_garment = |name: &[Term]| name.contains(&garment) && is_free(name);
        let mut is_worn = names.iter().any(|name| {
            let says_wearer = name.iter().any(|term| wearers.contains(term));
            says_wearer && is_free(name) && !name.contains(&garment)
        });
        for name in names.iter_mut().filter(|name| is_garment(name)) {
            name.push(if is_worn { Term::Detail } else { wearer });
            is_worn = true;
        }
    }
}

fn is_limb_or_detail(term: Term) -> bool {
    use Term as T;
    matches!(
        term,
        T::Detail
            | T::Shoulder
            | T::Arm
            | T::UpperArm
            | T::LowerArm
            | T::Hand
            | T::Leg
            | T::Thigh
            | T::Shin
            | T::Foot
            | T::Toe
            | T::Tail
            | T::Neck
    )
}

#[cfg(test)]
mod tests {
    use super::dress;
    use crate::anatomy::{Role, terms};

    /// What parts with these names are.
    fn roles(names: &[&str]) -> Vec<Option<Role>> {
        let mut all: Vec<_> = names.iter().map(|name| terms(name)).collect();
        dress(&mut all);
        all.iter().map(|terms| Role::of(terms)).collect()
    }

    #[test]
    fn clothes_name_what_wears_them() {
        let dressed = [Some(Role::Head), Some(Role::Body), Some(Role::Hips)];
        assert_eq!(roles(&["Helmet", "Armour", "Skirt"]), dressed);
        assert_eq!(roles(&["兜", "よろい", "ズボン"]), dressed);
        assert_eq!(roles(&["hat", "T-shirt", "Pants"]), dressed);
    }

    #[test]
    fn clothes_are_worn_where_something_wears_them() {
        let of_head = Some(Role::OfHead);
        assert_eq!(
            roles(&["Head", "Helmet", "Torso", "Jacket", "Hips", "Skirt"]),
            [
                Some(Role::Head),
                of_head,
                Some(Role::Body),
                None,
                Some(Role::Hips),
                None
            ]
        );
        assert_eq!(roles(&["シャツ", "上着"]), [Some(Role::Body), None]);
        assert_eq!(
            roles(&["left pant leg", "pants"]),
            [Some(Role::Thigh), Some(Role::Hips)]
        );
    }
}
