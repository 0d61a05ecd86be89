//! Hover texts about performances: what a track does to the clips that follow it, and what a mark does to its part.

use super::Analysis;
use super::motion::{code, list};
use crate::bind::StringId;
use crate::rig::{FigureClip, Performance, PerformedMark};
use crate::source::Span;

/// How many marks are listed individually.
const MAX_MARKS: usize = 8;

impl Analysis {
    /// What the `Perform` at a span does to each clip.
    pub(super) fn performance_card(&self, span: Span) -> Option<String> {
        let lines = self.compiled.clips.iter().filter_map(|clip| {
            let performed = clip.performed.as_ref()?;
            let performance = clip.performance(self.bindings())?;
            (performed.requested_at == span).then(|| self.performed_line(clip, &performance))
        });
        list(lines.collect())
    }

    fn performed_line(&self, clip: &FigureClip, performance: &Performance<'_>) -> String {
        let marks = performance.marks.iter().take(MAX_MARKS);
        let mut said = vec![performance.timing()];
        said.extend(marks.map(mark_line));
        match performance.marks.len().saturating_sub(MAX_MARKS) {
            0 => {}
            1 => said.push("1 more mark".to_owned()),
            more => said.push(format!("{more} more marks")),
        }
        said.push(performance.filmed());
        format!(
            "clip {} of {}: {}",
            code(&clip.name),
            self.figure_of(clip),
            said.join("; ")
        )
    }

    /// What the mark of a string's part does to it in each clip.
    pub(super) fn mark_card(&self, string: StringId) -> Option<String> {
        let part = self.bindings().parts[self.part_of_string(string)?].main;
        let lines = self.compiled.clips.iter().filter_map(|clip| {
            let performed = clip.performed.as_ref()?;
            let mut channels = performed.channels.iter();
            let channel = channels.position(|channel| channel.parts.contains(&part))?;
            let mark = performed.mark(self.bindings(), channel);
            Some(format!(
                "clip {}: of {}, {}",
                code(&clip.name),
                code(&performed.file),
                mark_line(&mark)
            ))
        });
        list(lines.collect())
    }
}

/// What a mark does, in words.
fn mark_line(mark: &PerformedMark<'_>) -> String {
    let parts: Vec<String> = mark.performs.iter().map(|part| code(part)).collect();
    format!(
        "{} performs {} ({})",
        code(mark.name),
        parts.join(", "),
        mark.effect()
    )
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{figure, performed};

    /// The hover text at the place that is marked in the right arm's string or in the string for the whole drawing.
    fn hover(right: &str, defaults: &str) -> String {
        let strings = ["Body", right, "Larm@Body$Mark green", "", defaults];
        let (analysis, at) = performed(&figure(strings));
        let hover = analysis.hover(at);
        hover.map_or(String::new(), |hover| hover.markdown)
    }

    #[test]
    fn performances_show_what_they_do() {
        for defaults in [
            "%Per¦form \"hands.json\" Motion \"kick.bvh\"",
            "%Perform \"hands¦.json\" Motion \"kick.bvh\"",
            "%Motion \"kick.bvh\" Perform ¦\"hands.json\"",
        ] {
            let card = hover("Rarm@Body$Mark red", defaults);
            let expected = " of the motion stands in frame 8 of 25; \
                `red` performs `Rarm` (R = 1.00, emphasised); `green` performs `Larm` (R = 0.25, damped); \
                filmed by a camera that is nearest in frame ";
            assert!(card.contains("- clip `kick` of `Body`: frame "), "{card}");
            assert!(card.contains(expected), "{card}");
        }
        let card = hover(
            "Rarm@Body$Mark red",
            "%Per¦form -tec \"hands.json\" Motion \"kick.bvh\"",
        );
        assert!(card.contains("the motion keeps its timing; "), "{card}");
        assert!(
            card.contains("`Larm` (R = 0.25, not damped); not filmed"),
            "{card}"
        );
    }

    #[test]
    fn marks_show_what_they_do() {
        for right in ["Rarm@Body$Ma¦rk red", "Rarm@Body$Mark re¦d"] {
            let card = hover(right, "%Perform \"hands.json\" Motion \"kick.bvh\"");
            let expected =
                "- clip `kick`: of `hands.json`, `red` performs `Rarm` (R = 1.00, emphasised)";
            assert!(card.contains(expected), "{card}");
        }
    }
}
