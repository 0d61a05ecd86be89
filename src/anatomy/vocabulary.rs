//! Tables of what words mean in the names of joints and parts.

use std::sync::LazyLock;

use rustc_hash::FxHashMap;

use super::name_words;

/// What a word means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Term {
    Left,
    Right,
    Upper,
    Lower,
    /// In front: a foreleg, a forearm, a forefoot.
    Fore,
    Middle,
    Hind,
    /// The back, or at the back.
    Back,
    Collar,
    Shoulder,
    Arm,
    UpperArm,
    LowerArm,
    Hand,
    /// A hip, or the hips.
    Hip,
    Leg,
    Thigh,
    Shin,
    Foot,
    Toe,
    /// Hips that have no side.
    Hips,
    Waist,
    Body,
    /// The lower end of the body.
    Belly,
    /// The upper end of the body.
    Chest,
    Neck,
    Head,
    Tail,
    /// Of arms: a wing, a tentacle, which a figure spreads.
    Wing,
    /// Clothes of the body, such as armour and shirts.
    BodyWear,
    /// Clothes of the head, such as helmets.
    HeadWear,
    /// Clothes of the hips, such as skirts and trousers.
    HipWear,
    /// Clothes of an arm, which are details.
    Sleeve,
    /// Clothes of a leg, which are details.
    Stocking,
    /// Of hands and feet: clothes of them, such as gloves and shoes.
    Worn,
    /// A face: a feature of a head, or a head.
    Face,
    /// A leg, or a foot if it is attached to a leg: 足.
    LegOrFoot,
    /// Worn, held, or part of a face: it follows its parent.
    Detail,
    /// Of the details: what belongs to a head.
    OfHead,
    /// An ear.
    Ear,
    /// An eye.
    Eye,
    /// A nose, a beak, a muzzle.
    Nose,
    /// A horn, a tusk.
    Horn,
    /// Hair, which is a detail of a head.
    Hair,
    /// A cape, which is a detail.
    Cape,
    /// Only in skeletons: twist, share and end joints, controls.
    Helper,
}

use Term::{
    Arm, Back, Belly, Body, BodyWear, Cape, Chest, Collar, Detail, Ear, Eye, Face, Foot, Fore,
    Hair, Hand, Head, HeadWear, Helper, Hind, Hip, HipWear, Hips, Horn, Left, Leg, LegOrFoot,
    Lower, LowerArm, Middle, Neck, Nose, OfHead, Right, Shin, Shoulder, Sleeve, Stocking, Tail,
    Thigh, Toe, Upper, UpperArm, Waist, Wing, Worn,
};

/// Words, and what they mean.
type Table = &'static [(&'static [Term], &'static str)];

/// English, and abbreviations that are common in skeletons.
const ENGLISH: Table = &[
    (&[Left], "l left lt lft"),
    (&[Right], "r right rt rgt"),
    (&[Left, Upper], "lu"),
    (&[Right, Upper], "ru"),
    (&[Left, Fore], "lf"),
    (&[Right, Fore], "rf"),
    (&[Left, Hind], "lh"),
    (&[Right, Hind], "rh"),
    (&[Upper], "up upper uppr"),
    (&[Lower], "lo low lower lowr"),
    (&[Fore], "fore front"),
    (&[Middle], "mid middle"),
    (&[Hind], "hind rear"),
    (&[Back], "back"),
    (&[Collar], "collar clavicle clav clavicula"),
    (&[Shoulder], "shoulder shldr shoulders"),
    (&[Arm], "arm flipper pincer"),
    (&[Arm, Wing], "wing fin tentacle"),
    (&[UpperArm], "uparm humerus"),
    (&[LowerArm], "forearm loarm elbow radius ulna"),
    (&[Hand], "hand wrist fist claw"),
    (&[Hand, Worn], "glove gauntlet mitten"),
    (&[Hip], "hip buttock"),
    (&[Leg], "leg"),
    (&[Thigh], "thigh upleg femur"),
    (&[Shin], "shin calf knee tibia loleg"),
    (&[Foot], "foot feet ankle paw hoof hooves"),
    (&[Foot, Worn], "boot shoe sandal slipper sneaker"),
    (&[Toe], "toe toes ball"),
    (&[Hips], "hips pelvis lbody"),
    (&[Waist], "waist"),
    (&[Body], "body ubody rbody torso trunk spine"),
    (&[Belly], "belly abdomen stomach tummy ab"),
    (&[Chest], "chest thorax breastbone ribcage ribs"),
    (&[Neck], "neck"),
    (&[Head], "head skull"),
    (&[Tail], "tail"),
    (
        &[BodyWear],
        "armor armour breastplate cuirass tunic shirt jacket coat vest waistcoat blouse sweater cardigan hoodie dress gown robe kimono \
         uniform suit jumpsuit spacesuit leotard",
    ),
    (&[HeadWear], "helmet hat cap hood"),
    (
        &[HipWear],
        "skirt kilt trousers trouser pants pant shorts jeans",
    ),
    (&[Face], "face"),
    (&[Detail, OfHead, Ear], "ear"),
    (&[Detail, OfHead, Eye], "eye pupil"),
    (
        &[Detail, OfHead, Nose],
        "nose beak bill snout muzzle proboscis",
    ),
    (&[Detail, OfHead, Horn], "horn antler tusk"),
    (
        &[Detail, OfHead, Hair],
        "hair bangs fringe ponytail braid bun",
    ),
    (
        &[Detail, OfHead],
        "earring crown brow eyebrow eyelid lid eyelash mouth lip \
         lips teeth tooth fang tongue jaw chin cheek forehead beard moustache mustache glasses antenna antennae feeler mask",
    ),
    (&[Detail, Cape], "cape cloak"),
    (&[Detail, Sleeve], "sleeve cuff"),
    (&[Detail, Stocking], "sock stocking legging"),
    (
        &[Detail],
        "breast bust boob bag backpack rucksack satchel pack pouch tank sword shield stick staff spear axe gun bow weapon prop ribbon \
         scarf tie belt sash button pocket buckle strap band apron pauldron plume visor panel screen dial hose \
         patch shadow logo badge medal necklace watch ring mane saddle bridle rein harness finger thumb index pinky little \
         metacarpal carpal palm knuckle heel",
    ),
    (
        &[Helper],
        "twist roll share end nub tip site ik pole target ctrl control effector helper dummy socket",
    ),
];

/// Japanese; katakana words are written in hiragana here.
const JAPANESE: Table = &[
    (&[Left], "左 ひだり"),
    (&[Right], "右 みぎ"),
    (&[Upper], "上 うえ"),
    (&[Lower], "下 した"),
    (&[Fore], "前 まえ"),
    (&[Middle], "中"),
    (&[Hind], "後 後ろ うしろ"),
    // The near side: neither a hand nor in front.
    (&[], "手前 てまえ"),
    (
        &[Body],
        "体 身体 からだ 胴 胴体 どう どうたい ぼでぃ ぼでぃー 上半身 背骨 上体",
    ),
    (&[Chest], "胸 むね 胸部"),
    (&[Belly], "腹 おなか お腹 はら 腹部"),
    (&[Back], "背中 せなか 背"),
    (&[Hips], "腰 こし 下半身 骨盤 尻 おしり お尻"),
    (&[Neck], "首 くび"),
    (&[Head], "頭 あたま 頭部 へっど"),
    (&[Tail], "尾 しっぽ 尻尾"),
    (&[Shoulder], "肩 かた"),
    (&[Arm], "腕 うで あーむ ひれ"),
    (&[Arm, Wing], "翼 つばさ 羽 羽根 はね 触手"),
    (&[UpperArm], "上腕 二の腕"),
    (&[LowerArm], "前腕 下腕 ひじ 肘"),
    (&[Hand], "手 て 手首 てくび はんど 手先"),
    (&[Hand, Worn], "手袋 てぶくろ ぐろーぶ 籠手 こて"),
    (&[Leg], "脚 れっぐ"),
    (&[Leg, LegOrFoot], "足 あし"),
    (&[Face], "顔 かお"),
    (&[Fore, Leg], "前足 前脚 まえあし"),
    (&[Hind, Leg], "後足 後脚 後ろ足 後ろ脚 うしろあし"),
    (&[Thigh], "腿 太腿 もも 太もも ふともも 大腿"),
    (&[Shin], "膝 ひざ 脛 すね"),
    (&[Foot], "足首 あしくび 足先 蹄 ひづめ"),
    (&[Foot, Worn], "靴 くつ ぶーつ 長靴 ながぐつ 草履 さんだる"),
    (&[Toe], "つま先 つまさき 爪先"),
    (
        &[BodyWear],
        "鎧 よろい 服 ふく 洋服 制服 上着 うわぎ しゃつ じゃけっと こーと べすと せーたー ぱーかー どれす わんぴーす 着物 きもの れおたーど",
    ),
    (&[HeadWear], "兜 かぶと へるめっと 帽子 ぼうし ふーど"),
    (
        &[HipWear],
        "すかーと ずぼん ぱんつ じーんず 短ぱん 袴 はかま",
    ),
    (&[Detail, OfHead, Ear], "耳 みみ"),
    (&[Detail, OfHead, Eye], "目 眼 め"),
    (&[Detail, OfHead, Nose], "鼻 はな 嘴 くちばし"),
    (&[Detail, OfHead, Horn], "角 つの 牙 きば"),
    (&[Detail, OfHead, Hair], "髪 かみ 前髪 後髪 後ろ髪"),
    (
        &[Detail, OfHead],
        "口 くち 顎 あご 舌 触角 触覚 眉 眼鏡 めがね 髭 ひげ",
    ),
    (&[Detail, Cape], "まんと"),
    (&[Detail, Sleeve], "袖 そで"),
    (&[Detail, Stocking], "靴下 くつした"),
    (
        &[Detail],
        "首輪 剣 盾 槍 斧 杖 武器 鞄 かばん りゅっく りゅっくさっく らんどせる 影 ねくたい まふらー りぼん べると ぼたん ぽけっと \
         首飾り 鞍 くら 手綱 たてがみ 親指 人指 人差指 中指 薬指 小指 指 ゆび",
    ),
    (
        &[Helper],
        "捩 捩れ だみー 全ての親 せんたー ぐるーぶ きゃんせる 補助 先",
    ),
];

/// Words too short to be searched for inside others: `legend` is not the end of a leg.
const ALONE: [&str; 22] = [
    "l", "r", "lt", "rt", "lu", "ru", "lf", "rf", "lh", "rh", "lo", "ab", "end", "ik", "tip",
    "ear", "fin", "bow", "tie", "lid", "lip", "gun",
];
/// Letters of the longest word in the tables.
const MAX_WORD_LETTERS: usize = 12;

static TERMS: LazyLock<FxHashMap<&'static str, &'static [Term]>> = LazyLock::new(|| {
    let tables = ENGLISH.iter().chain(JAPANESE);
    tables
        .flat_map(|(terms, words)| words.split_whitespace().map(|word| (word, *terms)))
        .collect()
});

/// The meanings of a name's words, in order. Words that are in no table are skipped.
pub(crate) fn terms(name: &str) -> Vec<Term> {
    let mut found = Vec::new();
    for word in name_words::split(name) {
        if !name_words::is_number(&word) {
            word_terms(&word, &mut found);
        }
    }
    found
}

/// Whether a name is that of several limbs: `Legs`, `far arms`, `両腕`. That of a glove or a shoe may be of what is worn on one.
pub(crate) fn is_several_limbs(name: &str) -> bool {
    let is_limb = |term: &Term| matches!(term, Arm | UpperArm | LowerArm | Leg | Thigh | Shin);
    name_words::split(name).iter().any(|word| {
        let singular = word.strip_suffix('s').and_then(|word| TERMS.get(word));
        let is_plural = |terms: &&[Term]| terms.iter().all(is_limb);
        let both = word.split_once('両').and_then(|(_, word)| TERMS.get(word));
        !TERMS.contains_key(word.as_str()) && singular.or(both).is_some_and(is_plural)
    })
}

/// The meaning of a word: as it is, without its plural, as words written together (`lefthand`), with a letter for its side
/// (`Rarm`), and in Japanese also with unknown letters in between.
fn word_terms(word: &str, found: &mut Vec<Term>) {
    if let Some(terms) = lookup(word) {
        found.extend(terms);
        return;
    }
    let letters: Vec<char> = word.chars().collect();
    if let Some(terms) = together(&letters) {
        found.extend(terms);
    } else if let Some(terms) = sided(&letters) {
        found.extend(terms);
    } else if letters.iter().any(|letter| !letter.is_ascii()) {
        scan(&letters, found);
    }
}

fn lookup(word: &str) -> Option<&'static [Term]> {
    let singular = || word.strip_suffix('s').filter(|rest| rest.len() > 2);
    TERMS.get(word).or_else(|| TERMS.get(singular()?)).copied()
}

/// The meanings of words written together, using the fewest words; `None` unless words fill the whole text.
fn together(letters: &[char]) -> Option<Vec<Term>> {
    // Per position: the number of words before it, and where the last of them begins.
    let mut best: Vec<Option<(usize, usize)>> = vec![None; letters.len() + 1];
    best[0] = Some((0, 0));
    for end in 1..=letters.len() {
        for start in end.saturating_sub(MAX_WORD_LETTERS)..end {
            let Some((words, _)) = best[start] else {
                continue;
            };
            let word: String = letters[start..end].iter().collect();
            if best[end].is_none_or(|(fewest, _)| words + 1 < fewest)
                && !ALONE.contains(&word.as_str())
                && lookup(&word).is_some()
            {
                best[end] = Some((words + 1, start));
            }
        }
    }
    let mut parts = Vec::new();
    let mut end = letters.len();
    while end > 0 {
        let (_, start) = best[end]?;
        let word: String = letters[start..end].iter().collect();
        parts.push(lookup(&word)?);
        end = start;
    }
    Some(parts.into_iter().rev().flatten().copied().collect())
}

/// The meanings of limb words with the letter of a side before or after them.
fn sided(letters: &[char]) -> Option<Vec<Term>> {
    let side = |letter: char| match letter {
        'l' => Some(Left),
        'r' => Some(Right),
        _ => None,
    };
    let limb =
        |rest: &[char]| together(rest).filter(|terms| terms.iter().any(|term| is_limb(*term)));
    let ((first, behind), (last, before)) = (letters.split_first()?, letters.split_last()?);
    let side_before = side(*first).zip(limb(behind));
    let (side, mut terms) = side_before.or_else(|| side(*last).zip(limb(before)))?;
    terms.insert(0, side);
    Some(terms)
}

fn is_limb(term: Term) -> bool {
    matches!(
        term,
        Collar
            | Shoulder
            | Arm
            | UpperArm
            | LowerArm
            | Hand
            | Hip
            | Leg
            | Thigh
            | Shin
            | Foot
            | Toe
    )
}

/// Finds the longest words, from left to right. Words in kana alone are skipped, because they occur inside others.
fn scan(letters: &[char], found: &mut Vec<Term>) {
    let mut start = 0;
    while start < letters.len() {
        let longest = (start + 1..=letters.len().min(start + MAX_WORD_LETTERS)).rev();
        let hit = longest
            .filter(|end| letters[start..*end].iter().any(is_kanji))
            .find_map(|end| {
                let word: String = letters[start..end].iter().collect();
                TERMS.get(word.as_str()).map(|terms| (end, *terms))
            });
        match hit {
            Some((end, terms)) => {
                found.extend(terms);
                start = end;
            }
            None => start += 1,
        }
    }
}

fn is_kanji(letter: &char) -> bool {
    matches!(letter, '\u{3400}'..='\u{9fff}' | '々')
}
