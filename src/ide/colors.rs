//! Colours in strings, and the edits that replace them.

use super::Analysis;
use super::at::attributes;
use crate::diagnostic::Edit;
use crate::lang::ast::{ArgumentKind, Attribute};
use crate::lang::keyword::Keyword;
use crate::lang::keyword::colors::{COLORS, color};
use crate::lang::value::Value;
use crate::source::Span;

/// A colour in a string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swatch {
    /// The span of its arguments.
    pub span: Span,
    /// Red, green, blue and opacity, straight sRGB, each 0 to 1.
    pub rgba: [f64; 4],
}

impl Analysis {
    /// The colours of all `Color` and `Mark` attributes, in the order of the file.
    pub fn swatches(&self) -> Vec<Swatch> {
        let mut out = vec![];
        for string in &self.bindings().strings {
            let all = attributes(&string.annotation).iter();
            for attribute in all.filter(|attribute| is_color(attribute)) {
                let setting = string
                    .settings
                    .iter()
                    .find(|setting| setting.range == attribute.range);
                let rgba = match setting.map(|setting| &setting.value) {
                    Some(Value::Color { rgb, alpha }) => {
                        let [r, g, b] = *rgb;
                        [r, g, b, alpha.unwrap_or(1.0)]
                    }
                    Some(Value::Mark(mark)) => {
                        let [r, g, b] = mark.color.map(|channel| f64::from(channel) / 255.0);
                        [r, g, b, 1.0]
                    }
                    _ => continue,
                };
                if let (Some(first), Some(last)) =
                    (attribute.arguments.first(), attribute.arguments.last())
                {
                    out.push(Swatch {
                        span: string.text.span(first.range.start..last.range.end),
                        rgba,
                    });
                }
            }
        }
        out.sort_by_key(|swatch| swatch.span);
        out.dedup();
        out
    }

    /// The ways to write `rgba` in place of the colour at `span`, the present notation first.
    pub fn color_edits(&self, span: Span, rgba: [f64; 4]) -> Vec<(String, Vec<Edit>)> {
        let Some((index, _)) = self.string_at(span.start) else {
            return vec![];
        };
        let string = &self.bindings().strings[index];
        let mut all = attributes(&string.annotation).iter();
        let Some(attribute) = all.find(|attribute| {
            is_color(attribute)
                && string
                    .text
                    .span(attribute.range.clone())
                    .touches(span.start)
        }) else {
            return vec![];
        };
        let (Some(first), Some(last)) = (attribute.arguments.first(), attribute.arguments.last())
        else {
            return vec![];
        };
        let had_alpha = match &first.kind {
            ArgumentKind::Hex(digits) => matches!(digits.len(), 4 | 8),
            _ => attribute.arguments.len() == 4,
        };
        // A mark is opaque, and is not written in numbers.
        let is_mark = attribute.keyword == Keyword::Mark;
        let rgba = match (is_mark, rgba) {
            (true, [r, g, b, _]) => [r, g, b, 1.0],
            (false, rgba) => rgba,
        };
        let mut forms = if is_mark {
            vec![hex(rgba, false)]
        } else {
            vec![hex(rgba, had_alpha), numbers(rgba, had_alpha)]
        };
        match first.kind {
            ArgumentKind::Hex(_) => {}
            _ => forms.reverse(),
        }
        if let Some(name) = css_name(rgba) {
            match first.kind {
                ArgumentKind::Word(_) => forms.insert(0, name.to_owned()),
                _ => forms.push(name.to_owned()),
            }
        }
        let range = first.range.start..last.range.end;
        let edits = forms.into_iter().filter_map(|form| {
            let edits = Edit::replacing(&string.text, range.clone(), &form)?;
            Some((form, edits))
        });
        edits.collect()
    }
}

/// Whether an attribute's arguments are a colour.
fn is_color(attribute: &Attribute) -> bool {
    matches!(attribute.keyword, Keyword::Color | Keyword::Mark)
}

/// `0.5 0.25 1`, with three decimals, enough for 8-bit channels.
fn numbers([r, g, b, a]: [f64; 4], had_alpha: bool) -> String {
    let number = |value: f64| ((value.clamp(0.0, 1.0) * 1000.0).round() / 1000.0).to_string();
    let mut words = vec![number(r), number(g), number(b)];
    if had_alpha || a < 1.0 {
        words.push(number(a));
    }
    words.join(" ")
}

fn hex(rgba: [f64; 4], had_alpha: bool) -> String {
    let count = if had_alpha || rgba[3] < 1.0 { 4 } else { 3 };
    let bytes = bytes(rgba);
    let digits: Vec<_> = bytes[..count]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    format!("#{}", digits.concat())
}

fn bytes(rgba: [f64; 4]) -> [u8; 4] {
    rgba.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// The CSS name of exactly this colour.
fn css_name(rgba: [f64; 4]) -> Option<&'static str> {
    let wanted = bytes(rgba);
    COLORS
        .iter()
        .copied()
        .find(|name| color(name) == Some(wanted))
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{analysis, figure};

    #[test]
    fn colors_are_found_and_written_as_they_were() {
        for (string, rgba, first) in [
            ("Body$Color 1 0.5 0", [1.0, 0.5, 0.0, 1.0], "0 0.502 1"),
            (
                "Body$Color 1 0.5 0 0.25",
                [1.0, 0.5, 0.0, 0.25],
                "0 0.502 1 1",
            ),
            (
                "Body$Color #ff8000",
                [1.0, 128.0 / 255.0, 0.0, 1.0],
                "#0080ff",
            ),
            (
                "Body$Color #f80f",
                [1.0, 136.0 / 255.0, 0.0, 1.0],
                "#0080ffff",
            ),
            ("Body$Color red", [1.0, 0.0, 0.0, 1.0], "0 0.502 1"),
            ("Body$Mark lime", [0.0, 1.0, 0.0, 1.0], "#0080ff"),
            ("Body$Mark #00FF0080", [0.0, 1.0, 0.0, 1.0], "#0080ff"),
            ("Body$Color w 0 0", [0.5, 0.0, 0.0, 1.0], "0 0.502 1"),
        ] {
            let (analysis, _) = analysis(&figure([string, "", "", "", "%Let w 0.5"]));
            let swatches = analysis.swatches();
            assert_eq!(swatches.len(), 1, "{string}");
            assert_eq!(swatches[0].rgba, rgba, "{string}");
            let edits = analysis.color_edits(swatches[0].span, [0.0, 0.502, 1.0, 1.0]);
            assert_eq!(edits[0].0, first, "{string}");
            assert_eq!(edits[0].1[0].span, swatches[0].span);
        }
    }

    #[test]
    fn a_name_is_offered_where_css_has_one() {
        let (analysis, _) = analysis(&figure(["Body$Color red", "", "", "", ""]));
        let edits = analysis.color_edits(analysis.swatches()[0].span, [0.0, 0.0, 1.0, 1.0]);
        let forms: Vec<_> = edits.iter().map(|(form, _)| form.as_str()).collect();
        assert_eq!(forms, ["blue", "0 0 1", "#0000ff"]);
    }
}
