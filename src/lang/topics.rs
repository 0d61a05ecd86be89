//! What people ask for who do not know the keywords yet: `okoshi explain thickness`.

use super::keyword::Keyword;

/// A page on a question, with the words under which it is found.
pub(crate) struct Topic {
    /// Its title, and the first word under which it is found.
    pub(crate) name: &'static str,
    /// Other words under which it is found.
    words: &'static [&'static str],
    /// The answer, in Markdown.
    text: &'static str,
    /// The keywords that say more.
    pub(crate) keywords: &'static [Keyword],
}

/// All topics, in the order of the overview.
pub(crate) const TOPICS: [Topic; 15] = [
    Topic {
        name: "names",
        words: &["name", "label", "labels", "string", "strings", "id"],
        text: "A part has the name that a text says which lies on its shape, or begins beside it; else that of its label in the drawing program, \
               else that of its layer or group. Where labels or texts name the parts of a body, such as `Head`, `Left arm` and `Tail`, \
               hierarchy, joints and motion follow from them.\n\n\
               `okoshi inspect DRAWING` shows which name belongs to which shape, and why. docs/strings.md is the tutorial.",
        keywords: &[Keyword::Bind],
    },
    Topic {
        name: "parent",
        words: &["parents", "hierarchy", "attach", "hang", "hangs"],
        text: "`Hand@Arm` hangs the hand on the arm: it moves with it. Without `@`, a part hangs on what it touches, and what is drawn on \
               a part stays on it: buttons go with the shirt. A part that comes off in motion does not touch what it should hang on: \
               let the shapes overlap, or write its parent.",
        keywords: &[],
    },
    Topic {
        name: "joint",
        words: &[
            "joints", "pivot", "hinge", "shoulder", "elbow", "knee", "bones", "rig",
        ],
        text: "A part turns where its shape meets the part that it hangs on: draw the arm so that it overlaps the body at the shoulder. \
               An arm or a leg that is one long shape bends at an elbow or a knee in its middle. `Origin` sets the point about which a \
               part turns, `Axis` its direction, and `Bend` how many joints it has inside.",
        keywords: &[Keyword::Origin, Keyword::Axis, Keyword::Bend],
    },
    Topic {
        name: "thickness",
        words: &["thick", "thin", "solid", "rounded", "3d"],
        text: "As long as no string says `Shape`, shapes with curves are inflated and the others are plates. `Shape` chooses for one part, \
               and behind `%` for all: `Shape default -5 5` is a plate from 5 behind the page to 5 in front of it, `Shape inflate` is \
               a cushion, `Shape roundv` a cylinder, `Shape round` a ball. `Offset` moves a part towards the viewer.",
        keywords: &[Keyword::Shape, Keyword::Offset, Keyword::Stack],
    },
    Topic {
        name: "order",
        words: &[
            "layers", "layer", "front", "behind", "over", "under", "z-order",
        ],
        text: "What is drawn later lies in front. Parts are spread in depth in that order, just so far that each lies on what is below it. \
               `Stack` spreads them more or less, and `Offset` moves one. docs/layers.md explains the rule.",
        keywords: &[Keyword::Stack, Keyword::Offset],
    },
    Topic {
        name: "eyes",
        words: &[
            "eye", "face", "mouth", "nose", "pupil", "details", "freckles",
        ],
        text: "Draw them on the head. What lies on a shape follows its surface and turns with it, and is not on the back. `Side both` puts a \
               shape on the far side too, `Side near` on the near side only. A line without a fill, such as a mouth, is drawn onto the surface.",
        keywords: &[Keyword::Side],
    },
    Topic {
        name: "hair",
        words: &["hat", "hats", "back", "ponytail", "braid", "beard", "cap"],
        text: "Draw the hair behind the head first, then the head, then the fringe on it, and name them: `Hair` or `Back hair`. What is \
               drawn before the head closes over the back of it. `Swing` lets hair, ears, tails and capes swing while the figure moves.",
        keywords: &[Keyword::Swing, Keyword::Side],
    },
    Topic {
        name: "clothes",
        words: &[
            "skirt", "dress", "cape", "coat", "sleeve", "trousers", "shirt", "shoes", "boots",
        ],
        text: "Name them, and they hang on what wears them: a sleeve on its arm, a boot on its foot, a skirt on the hips. A sleeve that \
               reaches over the elbow bends with the arm. `Swing` lets a skirt or a cape swing.",
        keywords: &[Keyword::Swing, Keyword::Bend],
    },
    Topic {
        name: "size",
        words: &["large", "small", "tall", "metre", "meter", "centimetre"],
        text: "One unit of the drawing is one centimetre. `%Scale 2` makes it two: the model is twice as large. A person is about 1.7 m \
               tall; if a figure is far from that, a hint names the `Scale` that fits.",
        keywords: &[Keyword::Scale],
    },
    Topic {
        name: "direction",
        words: &["looks", "profile", "sideways", "front-facing", "turned"],
        text: "Where a figure looks is found from its face, its feet and its tail. If it walks sideways, say so: `Facing left` in the \
               string of its body, or `%Facing front` for the whole drawing.",
        keywords: &[Keyword::Facing],
    },
    Topic {
        name: "moving",
        words: &[
            "move",
            "moves",
            "walk",
            "walks",
            "run",
            "animation",
            "clip",
            "dance",
            "bvh",
            "mocap",
            "poses",
            "keyframe",
            "keyframes",
        ],
        text: "Write `%Motion walk` somewhere on the page: a figure with legs walks, on two, four or six of them. `Motion` alone plays \
               what fits: wheels drive, wings fly, fins swim. `Motion \"kick.bvh\"` plays a file of motion capture. docs/motion.md begins with a \
               figure that moves in a minute. Key poses that you draw yourself are layers with `Pose`.",
        keywords: &[
            Keyword::Motion,
            Keyword::Pose,
            Keyword::Limited,
            Keyword::Held,
        ],
    },
    Topic {
        name: "paint",
        words: &[
            "colour",
            "colours",
            "colors",
            "fill",
            "gradient",
            "shiny",
            "metal",
            "transparent",
        ],
        text: "Parts have the fills of the drawing: colours, gradients, patterns and pictures. `Color`, `Alpha`, `Metallic`, `Roughness` and \
               `Texture` change them, for one part or, in a legend beside a sample of the paint, for all parts that are painted like it.",
        keywords: &[
            Keyword::Color,
            Keyword::Alpha,
            Keyword::Metallic,
            Keyword::Roughness,
            Keyword::Texture,
        ],
    },
    Topic {
        name: "lines",
        words: &["line", "stroke", "outline", "outlines", "ink", "contour"],
        text: "A line on a shape is ink on its surface, and a line that leaves a shape is a tube. Outlines of filled shapes are built as long \
               as no string says `Shape`. `%Strokes all` always builds them, `%Strokes lines` the lines beside shapes, `%Strokes none` none.",
        keywords: &[Keyword::Strokes],
    },
    Topic {
        name: "map",
        words: &["terrain", "landscape", "island", "trees", "fence", "props"],
        text: "A layer with a text that says `Tiles 10` is a map of tiles, 10 units each, and becomes a landscape. A text that says `Stand` in \
               another layer makes props of what is drawn there: trees, fences and signs stand on the map, each on the middle of its lowest edge. \
               docs/terrain.md is the page on both.",
        keywords: &[Keyword::Tiles, Keyword::Stand, Keyword::Height],
    },
    Topic {
        name: "leave out",
        words: &[
            "ignore", "hide", "remove", "skip", "guide", "note", "comment",
        ],
        text: "A text `*` beside a shape leaves it out, and a text that begins with `#` is a note of yours. Hidden objects and layers are \
               not built.",
        keywords: &[],
    },
];

impl Topic {
    /// The topic that is found under a word, ignoring case.
    pub(crate) fn about(word: &str) -> Option<&'static Self> {
        TOPICS
            .iter()
            .find(|topic| topic.all_words().any(|own| own.eq_ignore_ascii_case(word)))
    }

    /// The words under which it is found.
    pub(crate) fn all_words(&self) -> impl Iterator<Item = &'static str> + use<> {
        std::iter::once(self.name).chain(self.words.iter().copied())
    }

    /// Its page, in Markdown.
    pub(crate) fn page(&self) -> String {
        let mut out = format!(
            "# {}\n\n{}\n",
            super::explain::sentence(self.name),
            self.text
        );
        if !self.keywords.is_empty() {
            let keywords = self.keywords.iter();
            let keywords = keywords.map(|keyword| format!("`okoshi explain {}`", keyword.name()));
            let keywords: Vec<String> = keywords.collect();
            out += &format!("\nMore: {}\n", keywords.join(", "));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lang::keyword::{Status, kinds};

    #[test]
    fn words_lead_to_one_page() {
        let mut words: Vec<&str> = TOPICS.iter().flat_map(Topic::all_words).collect();
        let count = words.len();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), count);
        for word in words {
            let keyword =
                Keyword::from_name(word).filter(|keyword| keyword.row().status == Status::Built);
            let is_taken = keyword.is_some() || kinds::from_name(word).is_some();
            assert!(!is_taken, "`{word}` leads to another page");
        }
    }

    #[test]
    fn topics_name_keywords_that_have_an_effect() {
        for topic in &TOPICS {
            assert!(
                topic
                    .keywords
                    .iter()
                    .all(|keyword| keyword.row().status == Status::Built)
            );
            let page = topic.page();
            // What stands in a string of the page is a keyword or a kind.
            for sample in page.split('`').skip(1).step_by(2) {
                let word = sample.trim_start_matches('%').split(' ').next();
                let is_sample = word.is_some_and(|word| {
                    Keyword::from_name(word)
                        .is_some_and(|keyword| keyword.row().status == Status::Built)
                        || kinds::from_name(word).is_some()
                });
                let is_name = sample.starts_with("okoshi ")
                    || ["@", "%", "*", "#"].contains(&sample)
                    || sample.contains('@');
                let names = ["Head", "Left arm", "Tail", "Hair", "Back hair"];
                assert!(is_sample || is_name || names.contains(&sample), "{sample}");
            }
        }
    }
}
