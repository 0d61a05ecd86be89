//! The motions that strings ask for with `Motion`.

use super::bindings::Bindings;
use crate::diagnostic::{Code, Diagnostic};
use crate::lang::ast::Annotation;
use crate::lang::keyword::Keyword;
use crate::lang::value::Value;
use crate::source::Span;

/// A clip that a string asks for with `Motion`.
#[derive(Debug, Clone, Copy)]
pub struct ClipRequest<'a> {
    /// Index of the main part of the string; `None` for a string that applies to all figures.
    pub part: Option<usize>,
    /// The link to the motion file.
    pub file: &'a str,
    /// The name of the clip, if the string gives one.
    pub name: Option<&'a str>,
    /// The place of the setting.
    pub span: Span,
}

impl Bindings {
    /// The clips that strings ask for, in the order of the strings.
    pub fn clip_requests(&self) -> Vec<ClipRequest<'_>> {
        let requests = self.strings.iter().flat_map(|string| {
            let part = match string.annotation {
                Annotation::Defaults(_) => Some(None),
                _ => string
                    .binding
                    .map(|binding| Some(self.parts[binding.part].main)),
            };
            let settings = string.settings.iter();
            settings.filter_map(move |setting| match &setting.value {
                Value::Motion { file, clip } => Some(ClipRequest {
                    part: part?,
                    file,
                    name: clip.as_deref(),
                    span: string.text.span(setting.range.clone()),
                }),
                _ => None,
            })
        });
        requests.collect()
    }
}

/// Reports `Limited`, `Bone` and `Swing`, each once, in a drawing without a motion.
pub(super) fn without_motion(bindings: &Bindings, diagnostics: &mut Vec<Diagnostic>) {
    if !bindings.clip_requests().is_empty() {
        return;
    }
    for keyword in [Keyword::Limited, Keyword::Bone, Keyword::Swing] {
        let found = bindings.strings.iter().find_map(|string| {
            let counts = !matches!(string.annotation, Annotation::Legend(_));
            let mut settings = string.settings.iter().filter(|_| counts);
            let setting = settings.find(|setting| setting.keyword == keyword)?;
            Some(string.text.span(setting.range.clone()))
        });
        if let Some(span) = found {
            let name = keyword.name();
            let message = format!("`{name}` has no effect: the drawing has no motion");
            let help = "write `Motion \"file.bvh\"` in a `%` string, or in the string of a figure's root part";
            diagnostics.push(Diagnostic::new(Code::IdleMotion, span, message).help(help));
        }
    }
}
