//! Names for parts that nobody has named, as a person would write them.

use super::{Role, Term, is_several_limbs, terms};

/// What a part is, for its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Noun {
    Head,
    Eye,
    Eyes,
    Ear,
    Ears,
    Hair,
    Hat,
    Horns,
    Mouth,
    Neck,
    Body,
    Hips,
    Arm,
    Arms,
    UpperArm,
    Forearm,
    Hand,
    Hands,
    Leg,
    Legs,
    FarLegs,
    NearLegs,
    Thigh,
    Shin,
    Foot,
    Feet,
    Shoes,
    Tail,
    Cape,
    Wheel,
    Wheels,
    Hubs,
}

/// The language of names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Language {
    #[default]
    English,
    Japanese,
}

impl Language {
    /// The language of most names that mean something.
    pub(crate) fn of<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        let known = names.filter(|name| !terms(name).is_empty());
        let (latin, other): (Vec<&str>, Vec<&str>) = known.partition(|name| name.is_ascii());
        if other.len() > latin.len() {
            Self::Japanese
        } else {
            Self::English
        }
    }
}

impl Noun {
    /// The word in English and in Japanese.
    pub(crate) fn words(self) -> [&'static str; 2] {
        match self {
            Self::Head => ["Head", "頭"],
            Self::Eye => ["Eye", "目"],
            Self::Eyes => ["Eyes", "両目"],
            Self::Ear => ["Ear", "耳"],
            Self::Ears => ["Ears", "両耳"],
            Self::Hair => ["Hair", "髪"],
            Self::Hat => ["Hat", "帽子"],
            Self::Horns => ["Horns", "角"],
            Self::Mouth => ["Mouth", "口"],
            Self::Neck => ["Neck", "首"],
            Self::Body => ["Body", "体"],
            Self::Hips => ["Hips", "腰"],
            Self::Arm => ["Arm", "腕"],
            Self::Arms => ["Arms", "両腕"],
            Self::UpperArm => ["Upperarm", "上腕"],
            Self::Forearm => ["Forearm", "前腕"],
            Self::Hand => ["Hand", "手"],
            Self::Hands => ["Hands", "両手"],
            Self::Leg => ["Leg", "脚"],
            Self::Legs => ["Legs", "両脚"],
            Self::FarLegs => ["Far legs", "奥の両脚"],
            Self::NearLegs => ["Near legs", "手前の両脚"],
            Self::Thigh => ["Thigh", "太もも"],
            Self::Shin => ["Shin", "すね"],
            Self::Foot => ["Foot", "足首"],
            Self::Feet => ["Feet", "両足首"],
            Self::Shoes => ["Shoes", "靴"],
            Self::Tail => ["Tail", "尾"],
            Self::Cape => ["Cape", "マント"],
            Self::Wheel => ["Wheel", "車輪"],
            Self::Wheels => ["Wheels", "車輪"],
            Self::Hubs => ["Hubs", "ハブ"],
        }
    }

    /// What a part with a name is, as far as others are found around it.
    pub(crate) fn of(name: &str, terms: &[Term]) -> Option<Self> {
        let several = is_several_limbs(name);
        Some(match Role::of(terms)? {
            Role::Body | Role::Chest | Role::Belly => Self::Body,
            Role::Hips => Self::Hips,
            Role::Neck => Self::Neck,
            Role::Head => Self::Head,
            Role::UpperArm if several => Self::Arms,
            Role::UpperArm => Self::Arm,
            Role::LowerArm => Self::Forearm,
            Role::Hand => Self::Hand,
            Role::Thigh if several => Self::Legs,
            Role::Thigh => Self::Leg,
            Role::Shin => Self::Shin,
            Role::Foot => Self::Foot,
            Role::Tail => Self::Tail,
            Role::Shoulder | Role::Toe | Role::OfHead => return None,
        })
    }

    /// The role that its name gives; `None` for what has none, and for what belongs to a head.
    pub(crate) fn role(self) -> Option<Role> {
        Some(match self {
            Self::Head => Role::Head,
            Self::Neck => Role::Neck,
            Self::Body => Role::Body,
            Self::Hips => Role::Hips,
            Self::Arm | Self::Arms | Self::UpperArm => Role::UpperArm,
            Self::Forearm => Role::LowerArm,
            Self::Hand | Self::Hands => Role::Hand,
            Self::Leg | Self::Legs | Self::FarLegs | Self::NearLegs | Self::Thigh => Role::Thigh,
            Self::Shin => Role::Shin,
            Self::Foot | Self::Feet | Self::Shoes => Role::Foot,
            Self::Tail => Role::Tail,
            Self::Eye | Self::Eyes | Self::Ear | Self::Ears => return None,
            Self::Hair | Self::Hat | Self::Horns | Self::Mouth | Self::Cape => return None,
            Self::Wheel | Self::Wheels | Self::Hubs => return None,
        })
    }

    /// The name of a part: `Larm`, `Rforeleg`, `右腕`. `left` says which side it is on, `fore` whether it is a fore or a hind one.
    pub(crate) fn written(
        self,
        left: Option<bool>,
        fore: Option<bool>,
        language: Language,
    ) -> String {
        let [english, japanese] = self.words();
        match language {
            Language::Japanese => {
                let side = match left {
                    Some(true) => "左",
                    Some(false) => "右",
                    None => "",
                };
                let pair = match fore {
                    Some(true) => "前",
                    Some(false) => "後",
                    None => "",
                };
                format!("{side}{pair}{japanese}")
            }
            Language::English => {
                let pair = match fore {
                    Some(true) => "fore",
                    Some(false) => "hind",
                    None => "",
                };
                // `Rear` would be a word of its own.
                let is_feature = matches!(self, Self::Ear | Self::Eye);
                match left {
                    Some(left) if is_feature => {
                        let side = if left { "Left" } else { "Right" };
                        format!("{side} {}", english.to_lowercase())
                    }
                    Some(left) => {
                        let side = if left { 'L' } else { 'R' };
                        format!("{side}{pair}{}", english.to_lowercase())
                    }
                    None if !pair.is_empty() => format!("{}{pair}{}", "", english.to_lowercase()),
                    None => english.to_owned(),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::anatomy::sides;

    #[test]
    fn names_are_read_as_what_they_were_written_for() {
        let limbs = [
            (Noun::Arm, Role::UpperArm),
            (Noun::UpperArm, Role::UpperArm),
            (Noun::Forearm, Role::LowerArm),
            (Noun::Hand, Role::Hand),
            (Noun::Leg, Role::Thigh),
            (Noun::Thigh, Role::Thigh),
            (Noun::Shin, Role::Shin),
            (Noun::Foot, Role::Foot),
            (Noun::Head, Role::Head),
            (Noun::Body, Role::Body),
            (Noun::Hips, Role::Hips),
            (Noun::Neck, Role::Neck),
            (Noun::Tail, Role::Tail),
        ];
        for language in [Language::English, Language::Japanese] {
            for (noun, role) in limbs {
                let name = noun.written(None, None, language);
                assert_eq!(Role::of(&terms(&name)), Some(role), "{name}");
                assert_eq!(noun.role(), Some(role), "{name}");
                let read = Noun::of(&name, &terms(&name));
                assert_eq!(read.and_then(Noun::role), Some(role), "{name}");
            }
            for (noun, role) in &limbs[..8] {
                for left in [true, false] {
                    let name = noun.written(Some(left), None, language);
                    assert_eq!(Role::of(&terms(&name)), Some(*role), "{name}");
                    assert_eq!(sides(&terms(&name)), [left, !left], "{name}");
                }
            }
            let name = Noun::Leg.written(Some(true), Some(true), language);
            assert!(terms(&name).contains(&Term::Fore), "{name}");
            assert!(terms(&name).contains(&Term::Leg), "{name}");
        }
    }
}
