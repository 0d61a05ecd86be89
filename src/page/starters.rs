//! Drawings to start from, which a page offers while its folder has none.

use std::hash::{BuildHasher, RandomState};
use std::sync::OnceLock;

use super::message::{ListedStarter, ToPage};
use super::models::{Bytes, thumbnail};
use crate::compile::{Options, compile};
use crate::export::{self, GLB};
use crate::resolver::MemoryResolver;
use crate::starters::Template;

/// Called with the drawing that was chosen; says why it was not begun.
type Begin = dyn Fn(Template) -> Result<(), String> + Send + Sync;

/// What a page offers, and what happens when somebody chooses.
pub(crate) struct Starters {
    /// Only who has read the messages of this server knows it.
    key: String,
    /// Pictures of the models of all templates.
    pictures: [OnceLock<Option<Bytes>>; Template::ALL.len()],
    begin: Box<Begin>,
}

impl Starters {
    /// All templates, for pages that name the key; `begin` writes the one that is chosen.
    pub(crate) fn new(
        key: String,
        begin: impl Fn(Template) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        Self {
            key,
            pictures: Default::default(),
            begin: Box::new(begin),
        }
    }

    /// The message that offers them.
    pub(crate) fn message(&self) -> ToPage<'_> {
        let listed = |template: Template| ListedStarter {
            name: template.name(),
            about: template.about(),
            picture: template
                .has_model()
                .then(|| format!("starters/{}.png", template.name())),
        };
        ToPage::Starters {
            key: &self.key,
            starters: Template::ALL.into_iter().map(listed).collect(),
        }
    }

    /// A picture of the model as PNG; `None` if there is no such drawing. It is drawn on the first call.
    pub(crate) fn picture(&self, name: &str) -> Option<Bytes> {
        let mut all = Template::ALL.into_iter().zip(&self.pictures);
        let (template, picture) = all.find(|(template, _)| template.name() == name)?;
        let drawn = || {
            let resolver = MemoryResolver::default();
            let compiled = compile(template.drawing(), &Options::default(), &resolver);
            let model = export::to_memory(&GLB, &compiled.scene, None).ok()?;
            thumbnail(&model.bytes)
        };
        picture.get_or_init(drawn).clone()
    }

    /// Begins a drawing; an error says why not.
    pub(crate) fn begin(&self, key: &str, name: &str) -> Result<(), String> {
        if key != self.key {
            return Err("the program was started anew; reload the page".to_owned());
        }
        let mut all = Template::ALL.into_iter();
        let template = all.find(|template| template.name() == name);
        let template = template.ok_or_else(|| format!("there is no starter `{name}`"))?;
        (self.begin)(template)
    }
}

/// A key that nobody can guess.
pub(crate) fn random_key() -> String {
    [(); 2].map(|()| random()).concat()
}

/// Sixteen digits that nobody can guess: the standard library seeds its maps with them against collisions that are made on purpose.
fn random() -> String {
    format!("{:016x}", RandomState::new().hash_one(()))
}
