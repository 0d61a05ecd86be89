//! Words for what lies behind and under figures, such as sky and ground.

use super::name_words;

/// English and Japanese words; katakana words are written in hiragana here.
const SCENERY: &str = "sky skies ground background backdrop back bg floor wall grass lawn meadow field land landscape earth soil \
     sea ocean water lake river road street path sand beach desert snow ice horizon hill hills mountain mountains clouds paper page \
     card canvas frame room scene stage night space world \
     空 そら 地面 じめん 背景 はいけい 床 ゆか 壁 かべ 草 草原 くさ 芝生 野原 海 うみ 水 みず 湖 川 道 みち 道路 砂 砂浜 雪 丘 山 大地 土 宇宙 夜空 舞台";

/// Whether a name is that of scenery rather than of a figure.
pub(crate) fn is_scenery(name: &str) -> bool {
    let words = name_words::split(name);
    words
        .iter()
        .any(|word| SCENERY.split_whitespace().any(|known| known == word))
}

#[cfg(test)]
mod tests {
    use super::is_scenery;

    #[test]
    fn names_of_scenery_are_told_from_those_of_figures() {
        for name in ["Sky", "blue sky", "Ground2", "空", "背景", "Background"] {
            assert!(is_scenery(name), "{name}");
        }
        for name in ["Head", "Skirt", "Leg", "頭", "Groundhog", ""] {
            assert!(!is_scenery(name), "{name}");
        }
    }
}
