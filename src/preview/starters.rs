//! Drawings to start from, which a page offers while its folder has none.

use std::hash::{BuildHasher, RandomState};
use std::sync::OnceLock;

use super::message::{ListedStarter, ToPage};
use super::models::{Bytes, thumbnail};
use crate::compile::{Options, compile};
use crate::export::{self, GLB};
use crate::resolver::MemoryResolver;

/// A drawing to start from.
#[derive(Debug, Clone)]
pub(crate) struct Starter {
    /// What it is called.
    pub name: String,
    /// What it shows.
    pub about: String,
    /// The drawing, which links to nothing.
    pub drawing: &'static str,
    /// Whether it has shapes of which there is a picture.
    pub has_model: bool,
}

/// Called with the drawing that was chosen; says why it was not begun.
type Begin = dyn Fn(&Starter) -> Result<(), String> + Send + Sync;

/// What a page offers, and what happens when somebody chooses.
pub(crate) struct Starters {
    /// Only who has read the messages of this server knows it.
    key: String,
    offered: Vec<Offered>,
    begin: Box<Begin>,
}

struct Offered {
    starter: Starter,
    picture: OnceLock<Option<Bytes>>,
}

impl Starters {
    /// These drawings; `begin` writes the one that is chosen.
    pub(crate) fn new(
        starters: Vec<Starter>,
        begin: impl Fn(&Starter) -> Result<(), String> + Send + Sync + 'static,
    ) -> Self {
        let offer = |starter| Offered {
            starter,
            picture: OnceLock::new(),
        };
        Self {
            key: random_key(),
            offered: starters.into_iter().map(offer).collect(),
            begin: Box::new(begin),
        }
    }

    /// The message that offers them.
    pub(super) fn message(&self) -> ToPage<'_> {
        let listed = |Offered { starter, .. }: &Offered| ListedStarter {
            picture: starter
                .has_model
                .then(|| format!("starters/{}.png", starter.name)),
            name: starter.name.clone(),
            about: starter.about.clone(),
        };
        ToPage::Starters {
            key: &self.key,
            starters: self.offered.iter().map(listed).collect(),
        }
    }

    fn named(&self, name: &str) -> Option<&Offered> {
        self.offered
            .iter()
            .find(|offered| offered.starter.name == name)
    }

    /// A picture of the model as PNG; `None` if there is no such drawing. It is drawn on the first call.
    pub(super) fn picture(&self, name: &str) -> Option<Bytes> {
        let Offered { starter, picture } = self.named(name)?;
        let drawn = || {
            let resolver = MemoryResolver::default();
            let compiled = compile(starter.drawing, &Options::default(), &resolver);
            let model = export::to_memory(&GLB, &compiled.scene, None).ok()?;
            thumbnail(&model.bytes)
        };
        picture.get_or_init(drawn).clone()
    }

    /// Begins a drawing; an error says why not.
    pub(super) fn begin(&self, key: &str, name: &str) -> Result<(), String> {
        if key != self.key {
            return Err("the program was started anew; reload the page".to_owned());
        }
        let offered = self.named(name);
        let offered = offered.ok_or_else(|| format!("there is no starter `{name}`"))?;
        (self.begin)(&offered.starter)
    }
}

/// A key that nobody can guess.
pub(super) fn random_key() -> String {
    [(); 2].map(|()| random()).concat()
}

/// Sixteen digits that nobody can guess: the standard library seeds its maps with them against collisions that are made on purpose.
fn random() -> String {
    format!("{:016x}", RandomState::new().hash_one(()))
}
