//! Drawings for the tests of this room.

use super::*;
use crate::compile::{Options, compile};
use crate::resolver::MemoryResolver;

/// A drawing's analysis, with the place of `¦` in it, which is taken out.
pub(super) fn analysis(source: &str) -> (Analysis, usize) {
    let at = source.find('¦').unwrap_or(0);
    let source = source.replacen('¦', "", 1);
    let compiled = compile(&source, &Options::default(), &MemoryResolver::default());
    (Analysis::new(source, compiled), at)
}

/// A drawing of a body, two arms and a swatch, with these strings beside them: body, right arm, left arm, swatch, and
/// one for the whole drawing.
pub(super) fn figure(strings: [&str; 5]) -> String {
    let [body, right, left, swatch, defaults] = strings;
    let text = |x: i32, y: i32, string: &str| match string {
        "" => String::new(),
        string => format!("<text x=\"{x}\" y=\"{y}\" font-size=\"5\">{string}</text>\n"),
    };
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 200 100\">\n\
         <rect id=\"body\" x=\"80\" y=\"20\" width=\"40\" height=\"60\" fill=\"#336699\"/>\n\
         <rect id=\"right\" x=\"20\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>\n\
         <rect id=\"left\" x=\"120\" y=\"40\" width=\"60\" height=\"10\" fill=\"#ffcc99\"/>\n\
         <rect id=\"swatch\" x=\"2\" y=\"2\" width=\"5\" height=\"5\" fill=\"#ffcc99\"/>\n\
         {}{}{}{}{}</svg>\n",
        text(100, 54, body),
        text(50, 49, right),
        text(150, 49, left),
        text(5, 8, swatch),
        text(150, 95, defaults),
    )
}
