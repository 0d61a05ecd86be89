//! Moves what a part is drawn as, and the strings beside it.

use glam::DVec2;
use roxmltree::Node;

use super::{digits, element_at, is_near_page, step, written};
use crate::bind::PartId;
use crate::diagnostic::Edit;
use crate::ide::changes::{Analysis, Place, Refusal};
use crate::lang::keyword::Keyword;
use crate::source::Span;
use crate::svg;

/// The attributes that place elements of a tag; none for those that only a transform moves.
fn coordinates(tag: &str) -> &'static [&'static str] {
    match tag {
        "rect" | "image" | "use" | "text" => &["x", "y"],
        "circle" | "ellipse" => &["cx", "cy"],
        _ => &[],
    }
}

impl Analysis {
    /// Moves a part by so many user units to the right and down.
    pub(in crate::ide::changes) fn shift(
        &self,
        name: &str,
        [right, down]: [f64; 2],
    ) -> Result<Vec<Edit>, Refusal> {
        let (part, elements) = self.drawn_part(name)?;
        if self.has_leader(part) {
            return Err(Refusal::new(format!(
                "a line leads from the string of `{name}` to it: move both in the program that drew them"
            )));
        }
        let by = DVec2::new(right, down);
        let (low, high) = self.bindings().parts[part].measure.bounds;
        if !is_near_page(self.drawing(), low + by) || !is_near_page(self.drawing(), high + by) {
            return Err(Refusal::new(format!(
                "`{name}` would lie far outside the page: move it less far"
            )));
        }
        let document = self.document()?;
        let moved: Vec<Span> = elements
            .iter()
            .map(|element| {
                element_at(&document, element.span.start).map(|node| node.range().into())
            })
            .collect::<Result<_, _>>()?;
        let mut starts: Vec<usize> = moved.iter().map(|span| span.start).collect();
        let is_inside = |text: Span| {
            let mut around = moved.iter();
            around.any(|span| span.start <= text.start && text.end <= span.end)
        };
        let texts = self.strings_beside(part).map(|(_, label)| label.element);
        starts.extend(
            texts
                .filter(|text| !is_inside(*text))
                .map(|text| text.start),
        );
        starts.sort_unstable();
        starts.dedup();
        let around = svg::transforms_around(&self.source, &starts);
        let mut edits = self.joint_moved(part, by);
        for (start, around) in starts.into_iter().zip(around) {
            let around = around.unwrap_or_default().matrix2;
            let local = around.inverse() * by;
            if !local.is_finite() {
                return Err(Refusal::new(format!(
                    "`{name}` lies in a group that is scaled to nothing: move it in the drawing"
                )));
            }
            let scale = around.determinant().abs().sqrt();
            let digits = digits(step(self.drawing()) / scale);
            let shift = Shift {
                source: &self.source,
                by: local,
                digits,
            };
            edits.extend(shift.of(element_at(&document, start)?));
        }
        Ok(edits)
    }

    /// The edits by which a joint that is given as a point goes with its part.
    fn joint_moved(&self, part: PartId, by: DVec2) -> Vec<Edit> {
        let resolved = self.bindings().resolved(self.drawing(), part).into_iter();
        let own = resolved.filter(|one| one.keyword == Keyword::Origin && one.from.name() == "own");
        let mut point = own.flat_map(|one| {
            let numbers = one.value.split_whitespace().map(str::parse::<f64>);
            numbers.collect::<Result<Vec<f64>, _>>()
        });
        let Some([x, y]) = point
            .next()
            .and_then(|point| <[f64; 2]>::try_from(point).ok())
        else {
            return vec![];
        };
        let digits = digits(step(self.drawing()));
        let place =
            |from: f64, by: f64| written(from + by, digits.max(decimals(&from.to_string())));
        let value = format!("{} {}", place(x, by.x), place(y, by.y));
        let name = &self.bindings().parts[part].name;
        // A joint that is calculated stays where it is.
        self.set(name, Keyword::Origin, &value, Place::Own)
            .unwrap_or_default()
    }
}

/// How elements are moved in the coordinates that they are placed in.
struct Shift<'a> {
    source: &'a str,
    by: DVec2,
    digits: usize,
}

impl Shift<'_> {
    fn of(&self, node: Node<'_, '_>) -> Vec<Edit> {
        self.by_coordinates(node)
            .unwrap_or_else(|| vec![self.by_transform(node)])
    }

    /// Other numbers for the attributes that place an element; `None` if more than these would have to change.
    fn by_coordinates(&self, node: Node<'_, '_>) -> Option<Vec<Edit>> {
        let names = coordinates(node.tag_name().name());
        // What a gradient or a clip refers to has the coordinates of the element, too.
        let refers = |node: Node<'_, '_>| node.attributes().any(|one| one.value().contains("url("));
        if names.is_empty() || node.has_attribute("transform") || refers(node) {
            return None;
        }
        let mut edits = vec![];
        for (name, by) in names.iter().zip(self.by.to_array()) {
            let lines = node.descendants().filter(|inner| {
                inner.is_element() && matches!(inner.tag_name().name(), "text" | "tspan")
            });
            let mut inner: Vec<_> = match node.tag_name().name() {
                "text" => lines.collect(),
                _ => vec![node],
            };
            let is_on_path = node
                .descendants()
                .any(|inner| inner.tag_name().name() == "textPath");
            if is_on_path || inner.iter().any(|inner| refers(*inner)) {
                return None;
            }
            // The coordinates of lines replace those of the text around them.
            if inner.iter().any(|inner| inner.has_attribute(*name)) {
                inner.retain(|inner| inner.has_attribute(*name));
            } else {
                inner.truncate(1);
            }
            for inner in inner {
                edits.extend(self.number(inner, name, by)?);
            }
        }
        Some(edits)
    }

    /// Adds to a number of an element; `None` if it is no plain number.
    fn number(&self, node: Node<'_, '_>, name: &str, by: f64) -> Option<Vec<Edit>> {
        let by_name =
            |one: &roxmltree::Attribute<'_, '_>| one.name() == name && one.namespace().is_none();
        let Some(attribute) = node.attributes().find(by_name) else {
            let text = written(by, self.digits);
            let at = node.range().start + 1 + name_length(self.source, node);
            let edit = Edit {
                span: Span::at(at),
                text: format!(" {name}=\"{text}\""),
            };
            return Some(if text == "0" { vec![] } else { vec![edit] });
        };
        let text = attribute.value();
        let span: Span = attribute.range_value().into();
        if self.source.get(span.start..span.end) != Some(text) || !is_plain(text) {
            return None;
        }
        let number: f64 = text.parse().ok()?;
        let digits = self.digits.max(decimals(text));
        let by: f64 = written(by, self.digits).parse().ok()?;
        let text = written(number + by, digits);
        Some(vec![Edit { span, text }])
    }

    /// The edit of an element's transform.
    fn by_transform(&self, node: Node<'_, '_>) -> Edit {
        let [x, y] = self.by.to_array().map(|by| written(by, self.digits));
        let before = format!("translate({x},{y})");
        let attribute = node
            .attributes()
            .find(|one| one.name() == "transform" && one.namespace().is_none());
        let Some(attribute) = attribute else {
            return Edit {
                span: Span::at(node.range().start + 1 + name_length(self.source, node)),
                text: format!(" transform=\"{before}\""),
            };
        };
        let whole = attribute.range();
        let value = attribute.value();
        let text = self
            .added(value)
            .unwrap_or_else(|| format!("{before} {}", value.trim()));
        let text = crate::source::escape_xml(&text);
        if text.is_empty() {
            let space = self.source[..whole.start].trim_end().len();
            return Edit {
                span: Span::new(space, whole.end),
                text,
            };
        }
        Edit {
            span: attribute.range_value().into(),
            text,
        }
    }

    /// A transform that begins with a translation, or is a matrix, with this one added to it; empty if none is left.
    fn added(&self, value: &str) -> Option<String> {
        let (function, rest) = value.trim().split_once('(')?;
        let (numbers, rest) = rest.split_once(')')?;
        let texts: Vec<&str> = numbers
            .split([',', ' ', '\t', '\n', '\r'])
            .filter(|text| !text.is_empty())
            .collect();
        if !texts.iter().all(|text| is_plain(text)) {
            return None;
        }
        let sum = |text: &str, by: f64| -> Option<String> {
            let by: f64 = written(by, self.digits).parse().ok()?;
            let number: f64 = text.parse().ok()?;
            Some(written(number + by, self.digits.max(decimals(text))))
        };
        let rest = rest.trim();
        match (function.trim(), texts.as_slice()) {
            ("translate", [x] | [x, _]) => {
                let y = texts.get(1).copied().unwrap_or("0");
                let [x, y] = [sum(x, self.by.x)?, sum(y, self.by.y)?];
                let rest = rest.trim_start_matches(',').trim_start();
                Some(match (&*x, &*y, rest) {
                    ("0", "0", rest) => rest.to_owned(),
                    (x, y, "") => format!("translate({x},{y})"),
                    (x, y, rest) => format!("translate({x},{y}) {rest}"),
                })
            }
            ("matrix", [a, b, c, d, e, f]) if rest.is_empty() => {
                let [e, f] = [sum(e, self.by.x)?, sum(f, self.by.y)?];
                Some(format!("matrix({a},{b},{c},{d},{e},{f})"))
            }
            _ => None,
        }
    }
}

/// How long the name of an element is in its start tag.
fn name_length(source: &str, node: Node<'_, '_>) -> usize {
    let name = &source[node.range().start + 1..];
    name.find(|c: char| c.is_whitespace() || matches!(c, '/' | '>'))
        .unwrap_or_default()
}

/// Whether a text is a number in digits, without a unit.
fn is_plain(text: &str) -> bool {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    digits
        .bytes()
        .all(|byte| byte.is_ascii_digit() || byte == b'.')
        && text.parse::<f64>().is_ok()
}

/// How many digits a number has behind the point.
fn decimals(text: &str) -> usize {
    const MOST: usize = 15;
    text.split_once('.')
        .map_or(0, |(_, behind)| behind.len().min(MOST))
}
