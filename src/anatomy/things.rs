//! Words for things that are no parts of a body, but that are known by where they are or by their form.

use super::name_words;

/// What a name means that is none of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Thing {
    /// What lies behind and under figures, such as sky and ground.
    Scenery,
    Wheel,
    /// A shadow that something throws.
    Shadow,
}

/// English and Japanese words; katakana words are written in hiragana here.
const WORDS: [(Thing, &str); 3] = [
    (
        Thing::Scenery,
        "sky ground background backdrop bg floor wall grass lawn meadow field land landscape earth soil sea ocean water lake river road \
         street path sand beach desert snow ice horizon hill mountain paper page canvas scene stage space \
         空 そら 地面 じめん 背景 はいけい 床 ゆか 壁 かべ 草原 芝生 野原 海 うみ 水 みず 湖 川 道 みち 道路 砂 砂浜 雪 丘 山 大地 土 宇宙 夜空 舞台",
    ),
    (
        Thing::Wheel,
        "wheel tyre tire 車輪 しゃりん 車 たいや ほいーる",
    ),
    (Thing::Shadow, "shadow 影 かげ"),
];

/// What a name means: what the last of its known words says, so that a `water wheel` is a wheel.
pub(crate) fn thing(name: &str) -> Option<Thing> {
    let means = |word: &str| {
        let singular = word.strip_suffix('s').unwrap_or(word);
        let mut tables = WORDS.iter();
        let found = tables.find(|(_, words)| {
            let mut words = words.split_whitespace();
            words.any(|known| known == word || known == singular)
        });
        found.map(|(thing, _)| *thing)
    };
    let words = name_words::split(name);
    words.iter().rev().find_map(|word| means(word))
}

/// Words for what is thin and limp; katakana words are written in hiragana here.
const SHEETS: &str = "cape cloak wing leaf petal flag banner paper veil curtain sail kite page cloth towel blanket マント まんと 翼 つばさ \
     羽 はね 羽根 旗 はた 葉 葉っぱ 花びら 紙 べーる かーてん 帆 布 ぬの";

/// Whether a name is that of something thin: a cape, a wing, a leaf. It is what the last of its known words says.
pub(crate) fn is_sheet(name: &str) -> bool {
    let words = name_words::split(name);
    let Some(last) = words
        .iter()
        .rev()
        .find(|word| word.chars().any(char::is_alphabetic))
    else {
        return false;
    };
    let singular = last.strip_suffix('s').unwrap_or(last);
    let mut known = SHEETS.split_whitespace();
    known.any(|known| known == last || known == singular) || matches!(last.as_str(), "leaves")
}

#[cfg(test)]
mod tests {
    use super::{Thing, is_sheet, thing};

    #[test]
    fn sheets_are_thin() {
        for name in [
            "Cape",
            "left wing",
            "Wings2",
            "leaves",
            "翼",
            "マント",
            "Red_flag",
        ] {
            assert!(is_sheet(name), "{name}");
        }
        for name in ["Head", "wing tip", "Tentacle", "capelet holder", ""] {
            assert!(!is_sheet(name), "{name}");
        }
    }

    #[test]
    fn things_are_told_from_parts_of_a_body() {
        for name in ["Sky", "blue sky", "Ground2", "空", "背景", "Hills"] {
            assert_eq!(thing(name), Some(Thing::Scenery), "{name}");
        }
        for name in ["Wheel2", "front wheels", "water wheel", "タイヤ"] {
            assert_eq!(thing(name), Some(Thing::Wheel), "{name}");
        }
        for name in ["Shadow", "ground shadow", "影"] {
            assert_eq!(thing(name), Some(Thing::Shadow), "{name}");
        }
        for name in ["Head", "Skirt", "Leg", "頭", "Groundhog", ""] {
            assert_eq!(thing(name), None, "{name}");
        }
    }
}
