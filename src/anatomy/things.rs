//! Words for things that are no parts of a body, but that are known by where they are or by their form.

use std::sync::LazyLock;

use rustc_hash::FxHashMap;

use super::name_words::{self, has_word};
use super::{Role, terms};

/// What a name means that is none of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Thing {
    /// What lies behind and under figures, such as sky and ground.
    Scenery,
    Wheel,
    /// A shadow that something throws.
    Shadow,
    /// A piece of a wheel.
    Hub,
}

/// English and Japanese words; katakana words are written in hiragana here.
const WORDS: [(Thing, &str); 4] = [
    (
        Thing::Scenery,
        "sky ground background backdrop bg floor wall grass lawn meadow field land landscape earth soil sea ocean water lake river road \
         street path sand beach desert snow ice horizon hill mountain paper page canvas scene stage space \
         空 そら 地面 じめん 背景 はいけい 床 ゆか 壁 かべ 草原 芝生 野原 海 うみ 水 みず 湖 川 道 みち 道路 砂 砂浜 雪 丘 山 大地 土 宇宙 夜空 舞台",
    ),
    (
        Thing::Wheel,
        "wheel tyre tire 車輪 しゃりん 車 たいや ほいーる 前輪 後輪",
    ),
    (Thing::Shadow, "shadow 影 かげ"),
    (Thing::Hub, "hub hubcap rim はぶ りむ"),
];

static THINGS: Table<Thing> = LazyLock::new(|| table(&WORDS));

/// Words with what they mean.
type Table<T> = LazyLock<FxHashMap<&'static str, T>>;

fn table<T: Copy>(words: &[(T, &'static str)]) -> FxHashMap<&'static str, T> {
    let tables = words.iter();
    tables
        .flat_map(|(meaning, words)| words.split_whitespace().map(|word| (word, *meaning)))
        .collect()
}

/// What the last word of a name means that is in a table, as it is or without its plural.
fn last_known<T: Copy>(name: &str, table: &Table<T>) -> Option<T> {
    let means = |word: &String| {
        let singular = word.strip_suffix('s').and_then(|word| table.get(word));
        table.get(word.as_str()).or(singular).copied()
    };
    name_words::split(name).iter().rev().find_map(means)
}

/// Whether a name is that of a round disc, such as a wheel or its hub.
pub(crate) fn is_disc(name: &str) -> bool {
    matches!(thing(name), Some(Thing::Wheel | Thing::Hub))
}

/// What a name means: what the last of its known words says, so that a `water wheel` is a wheel.
pub(crate) fn thing(name: &str) -> Option<Thing> {
    last_known(name, &THINGS)
}

/// Words for the far and the near side of what is seen from the side.
const FAR_AND_NEAR: &str = "far near 奥 手前 てまえ";
/// Words for what vehicles have at their front end.
const FRONT_END: &str = "headlight headlamp hood bonnet grille windshield windscreen steering handlebar driver cab cockpit mirror \
     へっどらいと 前照灯 ぼんねっと ふろんとがらす はんどる 運転席 運転手 運転士";
/// Words for what they have at their rear end.
const REAR_END: &str = "taillight taillamp tailpipe exhaust trailer spoiler tailgate tailboard てーるらいと とれーらー すぽいらー 荷台";
/// Words for lights, of which vehicles that are seen from the front show one on either side.
const LIGHTS: &str =
    "light lamp headlight headlamp taillight taillamp らいと へっどらいと てーるらいと 前照灯";

/// Whether a name says that its part is on the far or on the near side.
pub(crate) fn says_far_or_near(name: &str) -> bool {
    has_word(name, FAR_AND_NEAR)
}

/// Whether the names of a vehicle's parts say that they are at its front end (1), or at its rear end (−1).
pub(crate) fn end_of_vehicle(name: &str) -> Option<f64> {
    match [FRONT_END, REAR_END].map(|words| has_word(name, words)) {
        [true, false] => Some(1.0),
        [false, true] => Some(-1.0),
        _ => None,
    }
}

/// Words for vehicles with two wheels in a line, and for what only these have.
const BIKES: &str = "bike motorbike minibike bicycle motorcycle cycle scooter moped handlebar handlebars pedal pedals 自転車 じてんしゃ ばいく \
     おーとばい すくーたー";

/// Whether a name is that of a vehicle with two wheels in a line, or of a part of one.
pub(crate) fn is_bike(name: &str) -> bool {
    has_word(name, BIKES)
}

/// Whether a name is that of lights.
pub(crate) fn is_light(name: &str) -> bool {
    has_word(name, LIGHTS)
}

/// Words for what bends all along its length, like a rope; katakana words are written in hiragana here.
const SUPPLE: &str = "tail tentacle snake serpent worm antenna antennae feeler braid ponytail rope hose 尾 尻尾 しっぽ 触手 触角 蛇 へび \
     三つ編み みつあみ";

/// Whether a name is that of something that bends all along its length, like a rope.
pub(crate) fn is_supple(name: &str) -> bool {
    has_word(name, SUPPLE)
}

/// Words for fins; katakana words are written in hiragana here.
const FINS: &str = "fin flipper fluke ひれ 鰭 胸びれ 背びれ 尾びれ";
/// Words for the arms of squids, jellyfish and octopuses.
const TENTACLES: &str = "tentacle 触手 しょくしゅ";
/// Words for wheels that do not roll.
const UNROLLED: &str = "steering spare water ferris はんどる 予備 水車 観覧車";
/// Words for what grows, and stands in the wind.
const PLANTS: &str = "plant flower stem stalk leaf petal tree trunk branch twig bush grass flag pole sunflower tulip rose 花 はな 茎 くき 葉 木 き 草 枝 \
     旗 はた";

/// Whether a name is that of a fin.
pub(crate) fn is_fin(name: &str) -> bool {
    has_word(name, FINS)
}

/// Whether a name is that of a tentacle.
pub(crate) fn is_tentacle(name: &str) -> bool {
    has_word(name, TENTACLES)
}

/// Whether a name is that of a wheel on which something may roll.
pub(crate) fn is_rolling(name: &str) -> bool {
    is_disc(name) && !has_word(name, UNROLLED)
}

/// Whether a name is that of something which sways in the wind.
pub(crate) fn is_plant(name: &str) -> bool {
    has_word(name, PLANTS)
}

/// Words for small animals that are often drawn from above; katakana words are written in hiragana here.
const CRAWLERS: &str = "bug beetle ladybird ladybug spider tarantula crab insect tick mite scorpion cockroach roach weevil 虫 むし 甲虫 こうちゅう      かぶと虫 かぶとむし てんとう虫 てんとうむし 蜘蛛 くも 蟹 かに 蠍 さそり";

/// Whether a name is that of a small animal that is often drawn from above.
pub(crate) fn is_crawler(name: &str) -> bool {
    has_word(name, CRAWLERS)
}

/// Words for what is thin and limp; katakana words are written in hiragana here.
static SHEETS: Table<()> = LazyLock::new(|| {
    table(&[(
        (),
        "cape cloak wing leaf petal flag banner paper veil curtain sail kite page cloth towel blanket マント まんと 翼 つばさ \
     羽 はね 羽根 旗 はた 葉 葉っぱ 花びら 紙 べーる かーてん 帆 布 ぬの leaves",
    )])
});

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
    [last.as_str(), singular]
        .iter()
        .any(|word| SHEETS.contains_key(word))
}

/// What is round about the body that wears it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Garment {
    /// Also a crown.
    Hat,
    Skirt,
    /// Clothes of the whole body that end in a skirt.
    Dress,
    Trousers,
}

/// English and Japanese words; katakana words are written in hiragana here.
const GARMENTS: [(Garment, &str); 4] = [
    (
        Garment::Hat,
        "hat cap helmet helm bonnet beanie turban bowler sombrero beret fez toque crown tiara diadem coronet 帽子 ぼうし 兜 かぶと へるめっと 王冠 おうかん 冠 \
         かんむり てぃあら",
    ),
    (Garment::Skirt, "skirt kilt tutu すかーと"),
    (Garment::Dress, "dress gown robe kimono どれす 着物 きもの"),
    (
        Garment::Trousers,
        "trousers pants shorts jeans ずぼん じーんず ぱんつ",
    ),
];

static WORN: Table<Garment> = LazyLock::new(|| table(&GARMENTS));

/// The garment that a name means, by the last of its known words; `None` if it also says a limb, such as `left leg of trousers`.
pub(crate) fn garment(name: &str) -> Option<Garment> {
    if Role::of(&terms(name)).is_some_and(Role::is_piece_of_limb) {
        return None;
    }
    last_known(name, &WORN)
}

#[cfg(test)]
mod tests {
    use super::{Garment, Thing, garment, is_disc, is_sheet, thing};

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
    fn garments_are_known_by_their_names() {
        for (name, known) in [
            ("Witch's hat", Garment::Hat),
            ("cap2", Garment::Hat),
            ("王冠", Garment::Hat),
            ("スカート", Garment::Skirt),
            ("Red_dress", Garment::Dress),
            ("trousers", Garment::Trousers),
        ] {
            assert_eq!(garment(name), Some(known), "{name}");
        }
        for name in ["left pant leg", "Capsule", "hatch", "Head"] {
            assert_eq!(garment(name), None, "{name}");
        }
    }

    #[test]
    fn wheels_and_hubs_are_discs() {
        for name in [
            "Wheel",
            "Left wheel",
            "Tyre2",
            "Hubs",
            "rim",
            "前輪",
            "ハブ",
            "後輪",
        ] {
            assert!(is_disc(name), "{name}");
        }
        for name in ["Wheelbarrow", "Trim", "Hubble", "Head", ""] {
            assert!(!is_disc(name), "{name}");
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
