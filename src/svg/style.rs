//! The few CSS properties that usvg does not report: those of texts, and paints in their source form.

use roxmltree::Node;
use simplecss::{AttributeOperator, Declaration, PseudoClass, StyleSheet};

/// The drawing's style sheets.
pub(super) struct Styles<'a> {
    sheet: StyleSheet<'a>,
}

/// An XML element as the style sheet's selectors see it.
pub(super) struct Matched<'a, 'input>(pub(super) Node<'a, 'input>);

impl simplecss::Element for Matched<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Matched)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Matched)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, local_name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0
            .attribute(local_name)
            .is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        class == PseudoClass::FirstChild && self.0.prev_sibling_element().is_none()
    }
}

/// A property that a style sheet sets.
pub(super) struct Rule<'a> {
    selector: &'a simplecss::Selector<'a>,
    pub(super) name: &'a str,
    pub(super) value: &'a str,
}

impl Rule<'_> {
    pub(super) fn applies_to(&self, element: Node<'_, '_>) -> bool {
        self.selector.matches(&Matched(element))
    }
}

impl<'a> Styles<'a> {
    /// Reads the `<style>` elements of a document.
    pub(super) fn read(document: &'a roxmltree::Document<'_>) -> Self {
        let mut sheet = StyleSheet::new();
        for node in document
            .descendants()
            .filter(|node| node.is_element() && node.tag_name().name() == "style")
        {
            if matches!(node.attribute("type"), None | Some("" | "text/css")) {
                for text in node.children().filter_map(|child| child.text()) {
                    sheet.parse_more(text);
                }
            }
        }
        Self { sheet }
    }

    /// The value of `property` on `element` itself: from its `style`, a rule, or its attribute.
    pub(super) fn own<'b>(&'b self, element: Node<'b, '_>, property: &str) -> Option<&'b str> {
        let mut found: Option<(&'b str, bool)> = None;
        let mut take = |declaration: Declaration<'b>| {
            if declaration.name == property
                && (declaration.important || !found.is_some_and(|(_, important)| important))
            {
                found = Some((declaration.value, declaration.important));
            }
        };
        for rule in &self.sheet.rules {
            if rule.selector.matches(&Matched(element)) {
                rule.declarations
                    .iter()
                    .for_each(|declaration| take(*declaration));
            }
        }
        if let Some(style) = element.attribute("style") {
            simplecss::DeclarationTokenizer::from(style).for_each(take);
        }
        match found {
            Some((value, _)) => Some(value.trim()),
            None => element.attribute(property).map(str::trim),
        }
    }

    /// The number of rules.
    pub(super) fn rule_count(&self) -> usize {
        self.sheet.rules.len()
    }

    /// Compares an element with all rules, for an element that counts it.
    pub(super) fn compare_all(&self, element: &impl simplecss::Element) {
        for rule in &self.sheet.rules {
            rule.selector.matches(element);
        }
    }

    /// What rules set and is wanted, by name and value.
    pub(super) fn rules_with(&self, wanted: impl Fn(&str, &str) -> bool) -> Vec<Rule<'_>> {
        let rules = self.sheet.rules.iter();
        let declarations = rules.flat_map(|rule| {
            let selector = &rule.selector;
            rule.declarations.iter().map(move |one| Rule {
                selector,
                name: one.name,
                value: one.value,
            })
        });
        declarations
            .filter(|rule| wanted(rule.name, rule.value))
            .collect()
    }

    /// The value of an inherited property: from the element or its nearest ancestor that sets it.
    pub(super) fn inherited<'b>(
        &'b self,
        element: Node<'b, '_>,
        property: &str,
    ) -> Option<&'b str> {
        element
            .ancestors()
            .filter(|node| node.is_element())
            .find_map(|node| self.own(node, property).filter(|value| *value != "inherit"))
    }

    /// Whether the element and all its ancestors are visible.
    pub(super) fn is_shown(&self, element: Node<'_, '_>) -> bool {
        !matches!(
            self.inherited(element, "visibility"),
            Some("hidden" | "collapse")
        ) && element
            .ancestors()
            .filter(|node| node.is_element())
            .all(|node| self.own(node, "display") != Some("none"))
    }

    /// The font size in user units (CSS: medium is 16).
    pub(super) fn font_size(&self, element: Node<'_, '_>) -> f64 {
        let mut factor = 1.0;
        for node in element.ancestors().filter(|node| node.is_element()) {
            let Some(value) = self.own(node, "font-size") else {
                continue;
            };
            match relative_size(value) {
                Some(Size::Absolute(size)) => return size * factor,
                Some(Size::Relative(scale)) => factor *= scale,
                None => {}
            }
        }
        16.0 * factor
    }
}

enum Size {
    Absolute(f64),
    Relative(f64),
}

fn relative_size(value: &str) -> Option<Size> {
    use svgtypes::LengthUnit as Unit;
    if let Ok(length) = value.parse::<svgtypes::Length>() {
        let number = length.number;
        return Some(match length.unit {
            Unit::None | Unit::Px => Size::Absolute(number),
            Unit::Pt => Size::Absolute(number * 96.0 / 72.0),
            Unit::Pc => Size::Absolute(number * 16.0),
            Unit::In => Size::Absolute(number * 96.0),
            Unit::Cm => Size::Absolute(number * 96.0 / 2.54),
            Unit::Mm => Size::Absolute(number * 96.0 / 25.4),
            Unit::Em => Size::Relative(number),
            Unit::Ex => Size::Relative(number * 0.5),
            Unit::Percent => Size::Relative(number / 100.0),
        });
    }
    let steps = match value {
        "xx-small" => -3,
        "x-small" => -2,
        "small" => -1,
        "medium" => 0,
        "large" => 1,
        "x-large" => 2,
        "xx-large" => 3,
        "smaller" => return Some(Size::Relative(1.0 / 1.2)),
        "larger" => return Some(Size::Relative(1.2)),
        _ => return None,
    };
    Some(Size::Absolute(16.0 * 1.2_f64.powi(steps)))
}
