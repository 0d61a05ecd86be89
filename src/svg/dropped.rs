//! What a drawing has that is seen in a browser or in Inkscape, and that nothing here reads: pages of other languages, animations,
//! paints of other files, values of later versions of CSS. usvg leaves it out without a word.
//!
//! Every element is looked at once, while usvg reads the drawing on another core.

use roxmltree::{Document, Node, NodeId};

use super::elements::{Ids, NOT_DRAWN, element, start_tag};
use super::prepare::{Prepared, own_id};
use super::style::{Rule, Styles};
use super::unsolid::Feature;
use crate::diagnostic::{Code, Diagnostic};
use crate::source::Span;

/// Elements that are no shapes, and what each of them does.
const PAGES: [(&str, &str); 7] = [
    (
        "foreignObject",
        "holds no shapes but a page of another language",
    ),
    ("iframe", "shows a page of the web"),
    ("object", "shows another file"),
    ("embed", "shows another file"),
    ("video", "shows a film"),
    ("canvas", "shows what a script draws"),
    ("img", "shows a picture as in HTML, not as in SVG"),
];

/// Elements that change others in time.
const ANIMATIONS: [&str; 5] = [
    "animate",
    "animateColor",
    "animateMotion",
    "animateTransform",
    "set",
];

/// Paint servers that usvg reads.
const PAINTS: [&str; 3] = ["linearGradient", "radialGradient", "pattern"];

/// Functions of CSS whose values are not read.
const FUNCTIONS: [&str; 14] = [
    "var(",
    "env(",
    "calc(",
    "min(",
    "max(",
    "clamp(",
    "oklab(",
    "oklch(",
    "lab(",
    "lch(",
    "hwb(",
    "color(",
    "color-mix(",
    "light-dark(",
];

/// Selectors and rules of style sheets that are not read.
const RULES: [&str; 7] = [
    "@supports",
    "@layer",
    ":not(",
    ":is(",
    ":where(",
    ":has(",
    ":nth-",
];

/// The elements that use what is not read, by feature.
pub(super) type Users = Vec<(Feature, Vec<NodeId>)>;

/// Finds what is not read.
pub(super) fn read(
    document: &Document<'_>,
    styles: &Styles<'_>,
    prepared: &Prepared,
    ids: &Ids<'_>,
) -> Users {
    let mut walk = Walk {
        document,
        styles,
        ids,
        users: Vec::new(),
        in_sheets: styles.rules_with(is_unusual),
        is_drawn_again: prepared.has_clones,
    };
    for node in document.descendants().filter(Node::is_element) {
        walk.element(node);
    }
    walk.users
}

struct Walk<'a, 'input> {
    document: &'a Document<'input>,
    styles: &'a Styles<'a>,
    ids: &'a Ids<'a>,
    users: Users,
    /// What style sheets set and is looked at.
    in_sheets: Vec<Rule<'a>>,
    /// Whether what is in definitions may be drawn.
    is_drawn_again: bool,
}

impl Walk<'_, '_> {
    fn element(&mut self, node: Node<'_, '_>) {
        let tag = node.tag_name().name();
        match tag {
            "style" if self.has_unread_rules(node) => self.note(Feature::Rules, node),
            "script" => self.note(Feature::Script, node),
            "use" | "pattern" | "linearGradient" | "radialGradient" if is_elsewhere(node) => {
                self.note(Feature::OtherFile, node);
            }
            "text" if node.ancestors().any(|one| is_named(one, "pattern")) => {
                self.note(Feature::PatternText, node);
            }
            _ if ANIMATIONS.contains(&tag) => {
                if let Some(animated) = node.parent_element() {
                    self.note(Feature::Animation, animated);
                }
            }
            _ => {}
        }
        for attribute in node.attributes() {
            match attribute.name() {
                "style" => {
                    for one in simplecss::DeclarationTokenizer::from(attribute.value()) {
                        self.property(node, one.name, one.value, Place::Style);
                    }
                }
                name if attribute.namespace().is_none() => {
                    self.property(node, name, attribute.value(), Place::Attribute);
                }
                _ => {}
            }
        }
        if self.in_sheets.is_empty() || !is_graphic(tag) {
            return;
        }
        let rules = self.in_sheets.iter().filter(|rule| rule.applies_to(node));
        let set: Vec<(&str, &str)> = rules.map(|rule| (rule.name, rule.value)).collect();
        for (name, value) in set {
            self.property(node, name, value, Place::Style);
        }
    }

    /// Looks at a property or an attribute of an element.
    fn property(&mut self, node: Node<'_, '_>, name: &str, value: &str, place: Place) {
        let value = value.trim();
        let tag = node.tag_name().name();
        let is_css = place == Place::Style;
        let feature = match name {
            "fill" | "stroke" if value.starts_with("url") => self.paint(value),
            "fill" | "stroke" | "stop-color" | "color" | "stroke-width" | "opacity"
                if is_unread(value) =>
            {
                Some(Feature::Value)
            }
            "filter" if self.is_missing(value) => Some(Feature::NoFilter),
            "clip-path" if self.has_text(value) => Some(Feature::ClipText),
            "clip-path" | "mask" | "mask-image" if is_of_css(value) => Some(Feature::CssClip),
            "animation" | "animation-name" if is_css && value != "none" => Some(Feature::Animation),
            "transform" if is_css && value != "none" && !is_transform(value) => {
                Some(Feature::CssTransform)
            }
            "rotate" | "scale" | "translate" | "offset-path" if is_css && value != "none" => {
                Some(Feature::CssTransform)
            }
            "vector-effect" if value == "non-scaling-stroke" => Some(Feature::FixedWidth),
            "systemLanguage" if is_for_others(node, value) => Some(Feature::Language),
            _ if is_geometry(tag, name) => match place {
                Place::Style if node.attribute(name) != Some(value.trim_end_matches("px")) => {
                    Some(Feature::CssPlace)
                }
                Place::Attribute if !is_length(name, value) => Some(Feature::Value),
                _ => None,
            },
            _ => None,
        };
        if let Some(feature) = feature {
            self.note(feature, node);
        }
    }

    /// Notes a user of a feature, unless it is not drawn.
    fn note(&mut self, feature: Feature, node: Node<'_, '_>) {
        let is_definition = |node: Node<'_, '_>| NOT_DRAWN.contains(&node.tag_name().name());
        let may_be_drawn = match feature {
            // They act wherever they are, and an animation may show what is hidden.
            Feature::Rules | Feature::Script | Feature::Animation => true,
            // A paint is where it is defined.
            Feature::OtherFile | Feature::PatternText | Feature::Value => {
                self.styles.is_shown(node)
            }
            _ => {
                (self.is_drawn_again || !node.ancestors().any(is_definition))
                    && self.styles.is_shown(node)
            }
        };
        if !may_be_drawn {
            return;
        }
        match self.users.iter_mut().find(|(other, _)| *other == feature) {
            Some((_, users)) if users.last() == Some(&node.id()) => {}
            Some((_, users)) => users.push(node.id()),
            None => self.users.push((feature, vec![node.id()])),
        }
    }

    /// What is wrong with a paint that refers to an element.
    fn paint(&self, value: &str) -> Option<Feature> {
        let (link, fallback) = linked(value)?;
        let server = link.strip_prefix('#').and_then(|id| self.ids.get(id));
        match server.and_then(|server| self.document.get_node(server)) {
            Some(server) if PAINTS.contains(&server.tag_name().name()) => None,
            Some(_) => Some(Feature::OtherPaint),
            None => matches!(fallback, "" | "none").then_some(Feature::NoPaint),
        }
    }

    /// Whether a property refers to an element that is not there.
    fn is_missing(&self, value: &str) -> bool {
        linked(value).is_some_and(|(link, _)| {
            let id = link.strip_prefix('#');
            id.and_then(|id| self.ids.get(id)).is_none()
        })
    }

    /// Whether a property refers to an element with texts.
    fn has_text(&self, value: &str) -> bool {
        let id = linked(value).and_then(|(link, _)| link.strip_prefix('#'));
        let target = id.and_then(|id| self.document.get_node(self.ids.get(id)?));
        target.is_some_and(|target| target.descendants().any(|one| is_named(one, "text")))
    }

    /// Whether a style sheet has rules that are not read.
    fn has_unread_rules(&self, sheet: Node<'_, '_>) -> bool {
        let texts = sheet.children().filter_map(|child| child.text());
        texts.into_iter().any(|text| {
            let queries = text.split("@media").skip(1);
            let mut queries = queries.filter_map(|rest| rest.split('{').next());
            // What is for other readers than the usual one is not missed.
            let is_for_others = |query: &str| {
                ["print", "prefers-", "hover", "pointer"]
                    .iter()
                    .any(|word| query.contains(word))
            };
            // Fonts are of no use: texts are not built.
            let mut imports = text.split("@import").skip(1);
            let is_import =
                imports.any(|rest| !rest.split(';').take(1).any(|link| link.contains("font")));
            is_import
                || RULES.iter().any(|rule| text.contains(rule))
                || is_unread(text)
                || queries.any(|query| !is_for_others(query))
        })
    }
}

/// Where a property is set.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Attribute,
    /// In a `style`, or in a style sheet.
    Style,
}

/// `url(#a) red` as its link and what follows.
fn linked(value: &str) -> Option<(&str, &str)> {
    let (link, rest) = value.strip_prefix("url(")?.split_once(')')?;
    let quotes = |c: char| c.is_whitespace() || matches!(c, '"' | '\'');
    Some((link.trim_matches(quotes), rest.trim()))
}

/// Whether an element takes what it draws from another file.
fn is_elsewhere(node: Node<'_, '_>) -> bool {
    let mut links = node.attributes().filter(|one| one.name() == "href");
    links.any(|link| !link.value().trim().is_empty() && !link.value().trim().starts_with('#'))
}

/// Whether a clip or a mask is a shape or a picture of CSS.
fn is_of_css(value: &str) -> bool {
    value.contains('(')
        && !value.starts_with("url(#")
        && linked(value).is_none_or(|(link, _)| !link.starts_with('#'))
}

/// Whether a value has a function that is not read.
fn is_unread(value: &str) -> bool {
    value.contains('(')
        && FUNCTIONS.iter().any(|function| {
            let mut places = value.match_indices(function);
            // `calc(` in `x-calc(` is part of another name.
            places.any(|(at, _)| !value[..at].ends_with(|c: char| c.is_alphanumeric() || c == '-'))
        })
}

/// Whether a transform is one of SVG, whose numbers have no units.
fn is_transform(value: &str) -> bool {
    value.parse::<svgtypes::Transform>().is_ok()
}

/// Whether an element is for readers of another language than English, and nothing takes its place.
fn is_for_others(node: Node<'_, '_>, languages: &str) -> bool {
    let parent = node.parent_element();
    let is_alternative = parent.is_some_and(|parent| is_named(parent, "switch"));
    let mut languages = languages.split(',');
    !is_alternative && languages.all(|language| !language.trim().starts_with("en"))
}

/// Whether an attribute says where an element is, or how large it is.
fn is_geometry(tag: &str, name: &str) -> bool {
    match tag {
        "rect" => matches!(name, "x" | "y" | "width" | "height" | "rx" | "ry"),
        "circle" => matches!(name, "cx" | "cy" | "r"),
        "ellipse" => matches!(name, "cx" | "cy" | "rx" | "ry"),
        "line" => matches!(name, "x1" | "y1" | "x2" | "y2"),
        "path" => name == "d",
        "image" => matches!(name, "x" | "y" | "width" | "height"),
        _ => false,
    }
}

/// Whether the value of a geometric attribute is read.
fn is_length(name: &str, value: &str) -> bool {
    name == "d" || value == "auto" || value.parse::<svgtypes::Length>().is_ok()
}

/// Whether an element draws something.
fn is_graphic(tag: &str) -> bool {
    matches!(
        tag,
        "path"
            | "rect"
            | "g"
            | "circle"
            | "ellipse"
            | "polygon"
            | "use"
            | "image"
            | "line"
            | "polyline"
            | "a"
            | "svg"
    )
}

fn is_named(node: Node<'_, '_>, name: &str) -> bool {
    node.tag_name().name() == name
}

/// Whether a property of a style sheet is one that [`Walk::property`] may have something to say about.
fn is_unusual(name: &str, value: &str) -> bool {
    match name {
        "fill" | "stroke" => value.starts_with("url"),
        "filter" | "clip-path" | "mask" | "mask-image" => value.contains('('),
        "transform" => !is_transform(value),
        "animation" | "animation-name" | "rotate" | "scale" | "translate" | "offset-path"
        | "vector-effect" => true,
        _ => matches!(
            name,
            "x" | "y" | "width" | "height" | "r" | "cx" | "cy" | "rx" | "ry" | "d"
        ),
    }
}

/// Reports style sheets of other files, which browsers read and okoshi does not.
pub(super) fn report_linked_sheets(
    document: &Document<'_>,
    prepared: &Prepared,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let sheet = document.root().children().find(|node| {
        let instruction = node.pi().map(|instruction| instruction.target);
        instruction == Some("xml-stylesheet")
    });
    if let Some(sheet) = sheet {
        let start = prepared.original(sheet.range().start);
        let span = Span::new(start, start + "<?xml-stylesheet".len());
        let message = "a style sheet of another file is not read";
        diagnostics.push(
            Diagnostic::new(Code::NoSolidMeaning, span, message)
                .help("put its rules into a `<style>` of the drawing"),
        );
    }
}

/// Reports elements that hold no shapes, such as the HTML of exported diagrams. Where the drawing offers something in their
/// place (`switch`), or they are for one program alone, nothing is lost.
pub(super) fn report_pages(
    document: &Document<'_>,
    prepared: &Prepared,
    styles: &Styles<'_>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    for (tag, what) in PAGES {
        if !prepared.text.contains(tag) {
            continue;
        }
        let is_lost = |node: &Node<'_, '_>| {
            let is_around = |outer: Node<'_, '_>| {
                let outer = outer.tag_name().name();
                NOT_DRAWN.contains(&outer) || PAGES.iter().any(|(page, _)| *page == outer)
            };
            let parent = node.parent();
            let is_alternative = parent.is_some_and(|parent| is_named(parent, "switch"));
            is_named(*node, tag)
                && !node.has_attribute("requiredExtensions")
                && !is_alternative
                && !node.ancestors().skip(1).any(is_around)
                && styles.is_shown(*node)
        };
        let mut found = document.descendants().filter(is_lost);
        let Some(first) = found.next() else { continue };
        let message = match 1 + found.count() {
            1 => format!("{}, which {what}, is not built", with_article(tag)),
            count => format!("{count} `<{tag}>`s, each of which {what}, are not built"),
        };
        let span = element(first, prepared).span;
        diagnostics.push(Diagnostic::new(Code::NoSolidMeaning, span, message).help(
            "export texts and diagrams as shapes or as SVG text, or draw what they show; strings in them are not read",
        ));
    }
}

/// `an `<img>``
fn with_article(tag: &str) -> String {
    let article = if tag.starts_with(['a', 'e', 'i', 'o']) {
        "an"
    } else {
        "a"
    };
    format!("{article} `<{tag}>`")
}

/// An element that is no shape, for people.
pub(super) fn described(node: Node<'_, '_>, prepared: &Prepared) -> (String, Span) {
    let id = node
        .attribute("id")
        .filter(|id| !id.starts_with(&prepared.id_prefix));
    let name = match id {
        Some(id) => format!("`#{}`", own_id(id)),
        None => with_article(node.tag_name().name()),
    };
    (name, start_tag(node, prepared))
}
