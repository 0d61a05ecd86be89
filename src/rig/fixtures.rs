//! Figures for tests.

use crate::compile::{Compiled, Options, compile};
use crate::resolver::MemoryResolver;

/// A person without elbows and knees of its own.
pub(super) const PERSON: &str = r##"<rect x="175" y="90" width="50" height="90" inkscape:label="body"/>
<circle cx="200" cy="60" r="28" inkscape:label="head"/>
<rect x="155" y="95" width="18" height="80" inkscape:label="right arm"/>
<rect x="227" y="95" width="18" height="80" inkscape:label="left arm"/>
<rect x="178" y="175" width="20" height="100" inkscape:label="right leg"/>
<rect x="202" y="175" width="20" height="100" inkscape:label="left leg"/>"##;
pub(super) const CAR: &str = r##"<rect x="60" y="120" width="280" height="60" inkscape:label="car body"/>
<rect x="140" y="80" width="120" height="45" inkscape:label="cabin"/>
<circle cx="110" cy="190" r="40" inkscape:label="rear wheel"/>
<circle cx="110" cy="190" r="20" inkscape:label="rear rim"/>
<circle cx="290" cy="200" r="30" inkscape:label="front wheel"/>
<circle cx="335" cy="130" r="8" inkscape:label="headlight"/>"##;
pub(super) const BIRD: &str = r##"<ellipse cx="200" cy="150" rx="35" ry="50" inkscape:label="body"/>
<circle cx="200" cy="90" r="28" inkscape:label="head"/>
<circle cx="190" cy="88" r="4" inkscape:label="left eye"/><circle cx="210" cy="88" r="4" inkscape:label="right eye"/>
<path d="M170,125 L30,140 L172,160 Z" inkscape:label="wing 1"/>
<path d="M230,125 L370,140 L228,160 Z" inkscape:label="wing 2"/>"##;
pub(super) const FISH: &str = r##"<ellipse cx="180" cy="150" rx="100" ry="45" inkscape:label="body"/>
<path d="M270,150 L340,100 L340,200 Z" inkscape:label="tail fin"/>
<path d="M160,165 L200,205 L170,205 Z" inkscape:label="side fin"/>
<circle cx="110" cy="140" r="8" inkscape:label="eye"/>"##;
pub(super) const FLOWER: &str = r##"<rect x="196" y="100" width="8" height="180" inkscape:label="stem"/>
<path d="M200,190 L130,140 L195,160 Z" inkscape:label="leaf"/>
<circle cx="200" cy="90" r="30" inkscape:label="flower"/>"##;
pub(super) const SLIME: &str = r##"<ellipse cx="200" cy="180" rx="90" ry="60" inkscape:label="body"/>
<circle cx="170" cy="170" r="8" inkscape:label="eye 1"/><circle cx="230" cy="170" r="8" inkscape:label="eye 2"/>"##;
pub(super) const SQUID: &str = r##"<ellipse cx="200" cy="100" rx="70" ry="60" inkscape:label="head"/>
<path d="M150,140 L140,260 L160,260 Z" inkscape:label="tentacle 1"/>
<path d="M200,150 L190,260 L210,260 Z" inkscape:label="tentacle 2"/>
<path d="M250,140 L240,260 L260,260 Z" inkscape:label="tentacle 3"/>"##;
pub(super) const DOG: &str = r##"<rect x="100" y="120" width="180" height="60" inkscape:label="body"/>
<circle cx="80" cy="110" r="35" inkscape:label="head"/>
<rect x="110" y="170" width="20" height="90" inkscape:label="near front leg"/>
<rect x="140" y="170" width="20" height="90" inkscape:label="far front leg"/>
<rect x="220" y="170" width="20" height="90" inkscape:label="near hind leg"/>
<rect x="250" y="170" width="20" height="90" inkscape:label="far hind leg"/>"##;
pub(super) const EEL: &str = r##"<ellipse cx="110" cy="150" rx="60" ry="30" inkscape:label="body"/>
<rect x="160" y="140" width="220" height="20" rx="10" inkscape:label="tail"/>
<circle cx="80" cy="142" r="5" inkscape:label="eye"/>"##;
pub(super) const WEED: &str = r##"<rect x="170" y="250" width="60" height="40" inkscape:label="pot"/>
<rect x="192" y="60" width="16" height="200" inkscape:label="stem"/>"##;
pub(super) const BOX: &str = r##"<rect x="100" y="120" width="180" height="60"/>"##;

pub(super) const ALL: [(&str, &str); 10] = [
    (CAR, "drive"),
    (BIRD, "fly"),
    (FISH, "swim"),
    (FLOWER, "sway"),
    (SLIME, "hop"),
    (SQUID, "float"),
    (DOG, "walk"),
    (BOX, "sway"),
    (EEL, "swim"),
    (WEED, "sway"),
];

/// A drawing in which all figures play a motion: the text of a `%` string. `kick.bvh` and `walk.bvh` are beside it.
pub(super) fn playing(figure: &str, motion: &str) -> Compiled {
    let files = MemoryResolver::default()
        .with(
            "kick.bvh",
            include_str!("../../examples/motion/kick.bvh").as_bytes(),
        )
        .with(
            "walk.bvh",
            include_str!("../../examples/motion/walk.bvh").as_bytes(),
        );
    compile(&drawing(figure, motion), &Options::default(), &files)
}

/// Its text.
pub(super) fn drawing(figure: &str, motion: &str) -> String {
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="400" height="300"><text x="5" y="295" font-size="6">%{motion}</text>{figure}</svg>"##
    )
}
