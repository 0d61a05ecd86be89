//! Limits of style sheets and of `style` attributes, which take more time than their length to read and to apply.

use std::cell::Cell;

use roxmltree::{Document, Node};
use simplecss::{AttributeOperator, PseudoClass};

use super::elements::start_tag;
use super::prepare::Prepared;
use super::style::{Matched, Styles};
use crate::diagnostic::{Code, Diagnostic};

/// Declarations, each times the length of what it is in, in bytes: the parser counts lines up to each.
const MOST_STEPS: usize = 1 << 30;
/// The same for each byte of the drawing.
const STEPS_A_BYTE: usize = 1 << 10;
/// How often an element may be compared with a piece of a selector.
const MOST_COMPARISONS: usize = 1 << 24;
/// The same for each byte of the drawing.
const COMPARISONS_A_BYTE: usize = 16;

/// What to do about too many or too long styles.
const HELP: &str = "save the drawing with presentation attributes (in Illustrator, Save As SVG → More Options), or split it into several files";

/// Rejects a drawing whose styles would take very long to read.
pub(super) fn check_lengths(
    document: &Document<'_>,
    prepared: &Prepared,
) -> Result<(), Box<Diagnostic>> {
    let most = MOST_STEPS.max(STEPS_A_BYTE.saturating_mul(prepared.text.len()));
    let cost = |text: &str| {
        let declarations = memchr::memchr_iter(b':', text.as_bytes()).count();
        declarations.saturating_mul(text.len())
    };
    let mut sum: usize = 0;
    for node in document.descendants().filter(Node::is_element) {
        let is_sheet = node.tag_name().name() == "style";
        let texts = node.children().filter(|_| is_sheet);
        let texts = texts.filter_map(|child| child.text());
        for text in texts.chain(node.attribute("style")) {
            sum = sum.saturating_add(cost(text));
        }
        if sum > most {
            let message = format!(
                "the style sheets and `style` attributes are too long: the number of declarations times their length passes {most}"
            );
            return Err(refusal(node, prepared, message));
        }
    }
    Ok(())
}

/// Rejects a drawing with so many rules and elements that finding out which applies to which would take very long.
pub(super) fn check_comparisons(
    document: &Document<'_>,
    prepared: &Prepared,
    styles: &Styles<'_>,
) -> Result<(), Box<Diagnostic>> {
    let rules = styles.rule_count();
    if rules == 0 {
        return Ok(());
    }
    let most = MOST_COMPARISONS.max(COMPARISONS_A_BYTE.saturating_mul(prepared.text.len()));
    let elements = || document.descendants().filter(Node::is_element);
    let count = elements().count();
    let left = Cell::new(most);
    for element in elements() {
        styles.compare_all(&Counted {
            element: Matched(element),
            left: &left,
        });
        if left.get() == 0 {
            let sheet = elements().find(|node| node.tag_name().name() == "style");
            let message = format!(
                "the style sheets have too many rules for a drawing of this size: to find out which of {rules} rules apply to which of {count} elements takes more than {most} comparisons"
            );
            return Err(refusal(sheet.unwrap_or(element), prepared, message));
        }
    }
    Ok(())
}

fn refusal(node: Node<'_, '_>, prepared: &Prepared, message: String) -> Box<Diagnostic> {
    Box::new(Diagnostic::new(Code::LimitPassed, start_tag(node, prepared), message).help(HELP))
}

/// An element that counts how often it is compared, and matches nothing once that is too often.
struct Counted<'a, 'input> {
    element: Matched<'a, 'input>,
    left: &'a Cell<usize>,
}

impl Counted<'_, '_> {
    /// Counts a comparison. Returns whether it may be made.
    fn count(&self) -> bool {
        let left = self.left.get();
        self.left.set(left.saturating_sub(1));
        left > 0
    }
}

impl simplecss::Element for Counted<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        let element = self.element.parent_element().filter(|_| self.count())?;
        Some(Self { element, ..*self })
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        let element = self.element.prev_sibling_element();
        let element = element.filter(|_| self.count())?;
        Some(Self { element, ..*self })
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.count() && self.element.has_local_name(name)
    }

    fn attribute_matches(&self, local_name: &str, operator: AttributeOperator<'_>) -> bool {
        self.count() && self.element.attribute_matches(local_name, operator)
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        self.count() && self.element.pseudo_class_matches(class)
    }
}

#[cfg(test)]
mod tests {
    use crate::svg::growth::tests::refused as refused_body;

    /// The limit that a drawing passes, if it does.
    fn refused(style: &str, body: &str) -> Option<String> {
        refused_body(&format!("<style>{style}</style>{body}"))
    }

    fn rects(count: usize) -> String {
        "<rect class='r' width='1' height='1'/>".repeat(count)
    }

    #[test]
    fn many_rules_for_many_elements_are_refused() {
        let rules = |count| ".c .d .r{fill:red}".repeat(count);
        assert_eq!(refused(&rules(300), &rects(1000)), None);
        let message = refused(&rules(4000), &rects(4000)).expect("too many");
        assert!(message.contains("4000 rules"), "{message}");
        // Selectors of several steps are compared with all that is around an element, in all ways.
        let deep =
            |body: &str| format!("{}{body}{}", "<g class='a'>".repeat(90), "</g>".repeat(90));
        let chain = ".b .a .a .a .a .r{fill:red}";
        assert_eq!(refused(chain, &rects(9)), None);
        assert!(refused(chain, &deep(&rects(9))).is_some());
    }

    #[test]
    fn long_styles_are_refused() {
        let style = |count| "fill:red;".repeat(count);
        let rect = |count| format!("<rect style='{}' width='1' height='1'/>", style(count));
        assert_eq!(refused("", &rect(1000)), None);
        assert!(refused("", &rect(100_000)).is_some());
        assert!(refused(&format!(".r{{{}}}", style(100_000)), &rects(1)).is_some());
    }
}
