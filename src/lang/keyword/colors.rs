//! CSS colour names.

/// All CSS colour names.
#[rustfmt::skip]
pub(crate) static COLORS: [&str; 148] = [
    "aliceblue", "antiquewhite", "aqua", "aquamarine", "azure", "beige", "bisque", "black",
    "blanchedalmond", "blue", "blueviolet", "brown", "burlywood", "cadetblue", "chartreuse",
    "chocolate", "coral", "cornflowerblue", "cornsilk", "crimson", "cyan", "darkblue",
    "darkcyan", "darkgoldenrod", "darkgray", "darkgreen", "darkgrey", "darkkhaki",
    "darkmagenta", "darkolivegreen", "darkorange", "darkorchid", "darkred", "darksalmon",
    "darkseagreen", "darkslateblue", "darkslategray", "darkslategrey", "darkturquoise",
    "darkviolet", "deeppink", "deepskyblue", "dimgray", "dimgrey", "dodgerblue", "firebrick",
    "floralwhite", "forestgreen", "fuchsia", "gainsboro", "ghostwhite", "gold", "goldenrod",
    "gray", "green", "greenyellow", "grey", "honeydew", "hotpink", "indianred", "indigo",
    "ivory", "khaki", "lavender", "lavenderblush", "lawngreen", "lemonchiffon", "lightblue",
    "lightcoral", "lightcyan", "lightgoldenrodyellow", "lightgray", "lightgreen", "lightgrey",
    "lightpink", "lightsalmon", "lightseagreen", "lightskyblue", "lightslategray",
    "lightslategrey", "lightsteelblue", "lightyellow", "lime", "limegreen", "linen",
    "magenta", "maroon", "mediumaquamarine", "mediumblue", "mediumorchid", "mediumpurple",
    "mediumseagreen", "mediumslateblue", "mediumspringgreen", "mediumturquoise",
    "mediumvioletred", "midnightblue", "mintcream", "mistyrose", "moccasin", "navajowhite",
    "navy", "oldlace", "olive", "olivedrab", "orange", "orangered", "orchid", "palegoldenrod",
    "palegreen", "paleturquoise", "palevioletred", "papayawhip", "peachpuff", "peru", "pink",
    "plum", "powderblue", "purple", "rebeccapurple", "red", "rosybrown", "royalblue",
    "saddlebrown", "salmon", "sandybrown", "seagreen", "seashell", "sienna", "silver",
    "skyblue", "slateblue", "slategray", "slategrey", "snow", "springgreen", "steelblue",
    "tan", "teal", "thistle", "tomato", "turquoise", "violet", "wheat", "white", "whitesmoke",
    "yellow", "yellowgreen",
];

/// Whether `word` is a CSS colour name.
pub(crate) fn is_color(word: &str) -> bool {
    color(word).is_some()
}

/// The CSS colour called `name`: red, green, blue and alpha, each 0 to 255.
pub(crate) fn color(name: &str) -> Option<[u8; 4]> {
    use std::str::FromStr as _;
    // CSS colour names consist of letters. Functions such as `rgb()` and `currentColor` are not names.
    if !name.bytes().all(|byte| byte.is_ascii_alphabetic()) || name.len() > 24 {
        return None;
    }
    let lower = name.to_ascii_lowercase();
    match lower.as_str() {
        "currentcolor" => return None,
        // `svgtypes` does not know this newer name.
        "rebeccapurple" => return Some([102, 51, 153, 255]),
        _ => {}
    }
    let color = svgtypes::Color::from_str(&lower).ok()?;
    Some([color.red, color.green, color.blue, color.alpha])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_the_css_colors() {
        assert_eq!(color("Orange"), Some([255, 165, 0, 255]));
        assert_eq!(color("currentColor"), None);
        assert_eq!(color("rgb"), None);
        assert_eq!(color("orang"), None);
        for name in COLORS {
            assert!(is_color(name), "{name}");
        }
    }
}
