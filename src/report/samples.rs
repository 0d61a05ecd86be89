//! A drawing and findings, for the tests of the reports.

use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

pub(crate) const DRAWING: &str = "<svg>
  <text>Rarm@Ubody$\tShap roundv</text>
  <path/>
  <path/>


  <text>腕腕@頭 $ Color 1 1 2</text>\r
</svg>
";

/// The span of the first `word`.
pub(crate) fn at(text: &str, word: &str) -> Span {
    let start = text.find(word).unwrap();
    Span::new(start, start + word.len())
}

/// A finding with everything except related spans.
pub(crate) fn misspelled(text: &str) -> Diagnostic {
    let span = at(text, "Shap");
    Diagnostic::new(Code::UnknownKeyword, span, "unknown keyword `Shap`")
        .label("not a keyword")
        .help("`okoshi explain` lists the keywords")
        .fix("write `Shape`", span, "Shape")
}
