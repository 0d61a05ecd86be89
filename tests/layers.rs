//! The top-level modules of `src` use only the modules that docs/architecture.md lets them use.
//!
//! The graph is read from the syntax: `use` trees and paths, macros and nested modules included, `#[cfg(test)]` left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, UseTree};

/// Each module, with exactly the modules that it uses.
const USES: &[(&str, &[&str])] = &[
    ("anatomy", &[]),
    (
        "assemble",
        &[
            "bend",
            "billboard",
            "bind",
            "diagnostic",
            "figure",
            "memo",
            "resolver",
            "rig",
            "scene",
            "solid",
            "source",
            "svg",
            "terrain",
            "texture",
            "threads",
        ],
    ),
    ("assignment", &[]),
    ("bend", &["geometry", "math", "scene"]),
    (
        "billboard",
        &[
            "assignment",
            "bind",
            "diagnostic",
            "geometry",
            "index",
            "lang",
            "math",
            "memo",
            "raster",
            "scene",
            "source",
            "svg",
            "texture",
        ],
    ),
    (
        "bind",
        &[
            "anatomy",
            "assignment",
            "budget",
            "diagnostic",
            "geometry",
            "index",
            "lang",
            "math",
            "memo",
            "solid",
            "source",
            "svg",
            "texture",
            "threads",
        ],
    ),
    ("budget", &[]),
    (
        "cli",
        &[
            "billboard",
            "bind",
            "clips",
            "compile",
            "crash",
            "diagnostic",
            "disk",
            "export",
            "ide",
            "labels",
            "lang",
            "limited",
            "look",
            "lsp",
            "mark_tracks",
            "math",
            "mocap",
            "motion",
            "page",
            "performance",
            "prepare",
            "preview",
            "puppet",
            "render",
            "report",
            "resolver",
            "retarget",
            "rig",
            "source",
            "starters",
            "terrain",
            "trace",
            "tracking",
            "watch",
        ],
    ),
    ("clips", &["labels", "math", "mocap", "smoothing"]),
    (
        "compile",
        &[
            "assemble",
            "billboard",
            "bind",
            "crash",
            "diagnostic",
            "figure",
            "memo",
            "resolver",
            "rig",
            "scene",
            "source",
            "svg",
            "terrain",
            "threads",
        ],
    ),
    ("crash", &[]),
    ("diagnostic", &["source"]),
    ("disk", &["diagnostic", "export", "resolver"]),
    ("export", &["crash", "memo", "scene", "threads"]),
    (
        "figure",
        &[
            "bend",
            "bind",
            "budget",
            "diagnostic",
            "geometry",
            "import",
            "index",
            "math",
            "memo",
            "resolver",
            "scene",
            "solid",
            "source",
            "svg",
            "threads",
        ],
    ),
    ("geometry", &["budget", "math", "regions"]),
    (
        "ide",
        &[
            "anatomy",
            "billboard",
            "bind",
            "compile",
            "diagnostic",
            "geometry",
            "labels",
            "lang",
            "limited",
            "math",
            "resolver",
            "rig",
            "source",
            "svg",
            "terrain",
        ],
    ),
    ("import", &["index", "math", "resolver", "scene"]),
    ("index", &[]),
    ("labels", &["anatomy", "index", "math", "mocap"]),
    ("lang", &["diagnostic", "math", "source"]),
    ("lib", &[]),
    ("limited", &["math", "scene"]),
    (
        "look",
        &[
            "assemble",
            "billboard",
            "bind",
            "compile",
            "crash",
            "diagnostic",
            "export",
            "geometry",
            "lang",
            "math",
            "render",
            "resolver",
            "scene",
            "svg",
            "terrain",
            "threads",
        ],
    ),
    (
        "lsp",
        &[
            "compile",
            "crash",
            "diagnostic",
            "disk",
            "ide",
            "lang",
            "memo",
            "page",
            "preview",
            "protocol",
            "resolver",
            "source",
            "threads",
        ],
    ),
    ("main", &["cli"]),
    ("mark_tracks", &["index"]),
    ("math", &[]),
    ("memo", &["resolver", "threads"]),
    ("mocap", &["index", "math", "smoothing"]),
    (
        "motion",
        &[
            "labels",
            "limited",
            "mark_tracks",
            "math",
            "mocap",
            "performance",
            "prepare",
            "retarget",
            "scene",
        ],
    ),
    (
        "page",
        &[
            "bind",
            "compile",
            "diagnostic",
            "export",
            "geometry",
            "ide",
            "math",
            "memo",
            "puppet",
            "render",
            "report",
            "resolver",
            "scene",
            "source",
            "starters",
            "svg",
            "trace",
        ],
    ),
    (
        "performance",
        &[
            "labels",
            "limited",
            "mark_tracks",
            "math",
            "mocap",
            "scene",
            "smoothing",
        ],
    ),
    (
        "prepare",
        &[
            "clips",
            "labels",
            "limited",
            "math",
            "mocap",
            "retarget",
            "smoothing",
        ],
    ),
    (
        "preview",
        &[
            "ide",
            "mark_tracks",
            "page",
            "resolver",
            "tracking",
            "watch",
        ],
    ),
    (
        "protocol",
        &[
            "compile",
            "diagnostic",
            "export",
            "ide",
            "lang",
            "memo",
            "page",
            "resolver",
            "source",
        ],
    ),
    (
        "puppet",
        &[
            "anatomy", "bind", "compile", "crash", "geometry", "lang", "math", "resolver", "rig",
            "source", "svg", "threads",
        ],
    ),
    ("raster", &["geometry", "math", "regions"]),
    ("regions", &[]),
    (
        "render",
        &[
            "crash",
            "import",
            "math",
            "resolver",
            "smoothing",
            "threads",
        ],
    ),
    (
        "report",
        &[
            "billboard",
            "compile",
            "diagnostic",
            "figure",
            "geometry",
            "ide",
            "math",
            "rig",
            "scene",
            "source",
            "terrain",
        ],
    ),
    ("resolver", &[]),
    ("retarget", &["labels", "math", "mocap", "smoothing"]),
    (
        "rig",
        &[
            "anatomy",
            "bend",
            "bind",
            "budget",
            "clips",
            "diagnostic",
            "geometry",
            "index",
            "labels",
            "limited",
            "mark_tracks",
            "math",
            "memo",
            "mocap",
            "performance",
            "prepare",
            "resolver",
            "retarget",
            "scene",
            "smoothing",
            "solid",
            "source",
            "svg",
        ],
    ),
    ("scene", &["index", "math"]),
    ("smoothing", &["math"]),
    ("solid", &["budget", "geometry", "math", "scene"]),
    ("source", &[]),
    ("starters", &[]),
    (
        "svg",
        &[
            "budget",
            "diagnostic",
            "geometry",
            "index",
            "math",
            "resolver",
            "scene",
            "source",
            "texture",
            "threads",
        ],
    ),
    (
        "terrain",
        &[
            "bind",
            "diagnostic",
            "geometry",
            "index",
            "lang",
            "math",
            "memo",
            "regions",
            "resolver",
            "scene",
            "source",
            "svg",
            "texture",
        ],
    ),
    ("texture", &["math", "scene"]),
    ("threads", &["crash"]),
    ("trace", &["geometry", "raster", "regions", "texture"]),
    ("tracking", &["mark_tracks", "math", "regions"]),
    (
        "watch",
        &["compile", "disk", "export", "ide", "memo", "resolver"],
    ),
];

/// Steps inside of modules, in their order: each may use those before it.
const STEPS: &[(&str, &[&str])] = &[("bind", &["matching", "attributes", "hierarchy", "reports"])];

/// The rim: modules that are there only with a feature. All others are the core, which builds without features and uses none of them.
const RIM: &[(&str, &str)] = &[
    ("cli", "cli"),
    ("disk", "disk"),
    ("look", "render"),
    ("lsp", "lsp"),
    ("page", "page"),
    ("preview", "preview"),
    ("protocol", "protocol"),
    ("render", "render"),
    ("starters", "page"),
    ("tracking", "tracking"),
    ("watch", "watch"),
];

/// What only some modules of the rim, or the program, may use: a path or a macro, those modules, and why.
const ONLY_IN: &[(&str, &[&str], &str)] = &[
    ("std::fs", &["disk"], "only `disk` touches files"),
    ("tokio::fs", &["disk"], "only `disk` touches files"),
    (
        "std::env",
        &["cli", "main"],
        "compiling reads no environment",
    ),
    (
        "std::process",
        &["cli", "disk", "lsp", "main"],
        "compiling starts no process, and only what handles signals ends one",
    ),
    (
        "tower_lsp",
        &["lsp"],
        "only `lsp` has the protocol's connection",
    ),
    (
        "ls_types",
        &["protocol"],
        "only `protocol`, and `lsp` by its framework, name the protocol's types",
    ),
    (
        "std::time::Instant",
        &["cli", "disk", "preview", "watch"],
        "compiling reads no clock",
    ),
    (
        "std::time::SystemTime",
        &["cli", "disk", "lsp", "page", "preview", "protocol", "watch"],
        "compiling reads no clock",
    ),
    ("chrono", &["cli"], "compiling reads no clock"),
    (
        "std::thread",
        &["cli", "disk", "lsp", "preview", "render", "watch"],
        "the core has no threads but those of `rayon`",
    ),
    (
        "std::net",
        &["lsp", "preview"],
        "compiling knows no network",
    ),
    (
        "tokio",
        &["cli", "lsp", "page", "preview"],
        "only servers, and what they are told by, wait for many things at once",
    ),
    ("print!", &["cli"], "only `cli` prints"),
    ("println!", &["cli"], "only `cli` prints"),
    ("eprint!", &["cli"], "only `cli` prints"),
    ("eprintln!", &["cli"], "only `cli` prints"),
];

/// The module that only lists what tests may use, as `lib.rs` lists what everybody may.
const DOOR: &str = "internals";

/// A path as a list of names; a path into this crate begins with `crate`.
type Names = Vec<String>;

/// A source file without its tests.
struct SourceFile {
    module: String,
    path: PathBuf,
    /// The paths that it names, and its macros as `name!`.
    paths: BTreeSet<Names>,
}

impl SourceFile {
    /// The modules that it names.
    fn modules(&self) -> impl Iterator<Item = &str> {
        self.paths.iter().filter_map(|path| match path.as_slice() {
            [root, module, ..] if root == "crate" => Some(module.as_str()),
            _ => None,
        })
    }
}

/// The files of the library and of the program, found by following `mod` items. They are read once for all tests.
fn sources() -> &'static [SourceFile] {
    static SOURCES: OnceLock<Vec<SourceFile>> = OnceLock::new();
    SOURCES.get_or_init(read_sources)
}

fn read_sources() -> Vec<SourceFile> {
    let mut sources = Vec::new();
    read_module("lib.rs".into(), Vec::new(), &mut sources);
    read_module("main.rs".into(), Vec::new(), &mut sources);
    sources.retain(|source| source.module != DOOR);
    assert!(
        sources.len() > 50,
        "only {} files were found",
        sources.len()
    );
    sources
}

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Reads a file of `src` that is the module `module`, and the files of its modules.
fn read_module(path: PathBuf, module: Names, sources: &mut Vec<SourceFile>) {
    let text = fs::read_to_string(src().join(&path)).expect("a source file");
    let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = Reader {
        module: module.clone(),
        ..Reader::default()
    };
    reader.visit_file(&file);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let parent = path.parent().unwrap_or(Path::new(""));
    let folder = match &*stem {
        "lib" | "main" | "mod" => parent.to_owned(),
        stem => parent.join(stem),
    };
    sources.push(SourceFile {
        module: module.first().cloned().unwrap_or(stem.into_owned()),
        path,
        paths: reader.resolved(),
    });
    for child in reader.files {
        let inside: PathBuf = folder.join(child[module.len()..].iter().collect::<PathBuf>());
        let plain = inside.with_extension("rs");
        let path = if src().join(&plain).exists() {
            plain
        } else {
            inside.join("mod.rs")
        };
        read_module(path, child, sources);
    }
}

/// Collects the paths that a file names.
#[derive(Default)]
struct Reader {
    /// The module that is read.
    module: Names,
    /// Modules that have a file of their own.
    files: Vec<Names>,
    paths: Vec<Names>,
    /// The names that `use` items give to other paths.
    imports: BTreeMap<String, Names>,
}

impl Reader {
    /// All paths, with imported names and `self` and `super` replaced by what they refer to.
    fn resolved(&self) -> BTreeSet<Names> {
        let resolve = |path: &Names| match self.imports.get(&path[0]) {
            Some(import) => [import, &path[1..]].concat(),
            None => path.clone(),
        };
        let uses = self.imports.values().cloned();
        self.paths.iter().map(resolve).chain(uses).collect()
    }

    /// A path as it is from the crate's root, if it leads into this crate.
    fn absolute(&self, path: &[String]) -> Names {
        let root = ["crate".to_owned()];
        let mut module = self.module.as_slice();
        let mut rest = path;
        match path[0].as_str() {
            "okoshi" => {
                let door = usize::from(path.get(1).is_some_and(|name| name == DOOR));
                return [&root, &path[1 + door..]].concat();
            }
            "self" | "super" => {}
            _ => return path.to_vec(),
        }
        while let [first, others @ ..] = rest {
            match first.as_str() {
                "self" => {}
                "super" => module = &module[..module.len() - 1],
                _ => break,
            }
            rest = others;
        }
        [&root, module, rest].concat()
    }

    /// Adds the paths of a `use` tree, nested groups included.
    fn import(&mut self, prefix: &[String], tree: &UseTree) {
        let with = |name: &syn::Ident| [prefix, &[name.to_string()]].concat();
        let (path, name) = match tree {
            UseTree::Path(path) => return self.import(&with(&path.ident), &path.tree),
            UseTree::Group(group) => {
                for item in &group.items {
                    self.import(prefix, item);
                }
                return;
            }
            UseTree::Glob(_) => {
                let path = self.absolute(prefix);
                // Names from everywhere would hide where they come from.
                assert!(
                    path != ["crate"] && path != ["std"] && path != ["std", "time"],
                    "a glob of {path:?}"
                );
                return self.paths.push(path);
            }
            UseTree::Name(name) if name.ident == "self" => {
                (prefix.to_vec(), prefix.last().cloned().unwrap_or_default())
            }
            UseTree::Name(name) => (with(&name.ident), name.ident.to_string()),
            UseTree::Rename(name) => (with(&name.ident), name.rename.to_string()),
        };
        let path = self.absolute(&path);
        self.imports.insert(name, path.clone());
        self.paths.push(path);
    }

    /// Adds the paths among the tokens of a macro.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: Names = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match &token {
                TokenTree::Ident(name) if colons == 2 => path.push(name.to_string()),
                TokenTree::Ident(name) => {
                    self.name(&std::mem::take(&mut path));
                    path = vec![name.to_string()];
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => {
                    colons += 1;
                    continue;
                }
                TokenTree::Punct(punct) if punct.as_char() == '!' && path.len() == 1 => {
                    path[0].push('!');
                }
                _ => self.name(&std::mem::take(&mut path)),
            }
            colons = 0;
            if let TokenTree::Group(group) = token {
                self.tokens(group.stream());
            }
        }
        self.name(&path);
    }

    fn name(&mut self, path: &[String]) {
        if !path.is_empty() {
            self.paths.push(self.absolute(path));
        }
    }
}

/// Whether an item is compiled for tests only.
fn only_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let cfg = attribute.path().is_ident("cfg");
        let test = |name: syn::Path| name.is_ident("test");
        cfg && attribute.parse_args::<syn::Path>().is_ok_and(test)
    })
}

impl<'ast> Visit<'ast> for Reader {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Const(item) => &item.attrs,
            Item::Enum(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            Item::Macro(item) => &item.attrs,
            Item::Mod(item) => &item.attrs,
            Item::Static(item) => &item.attrs,
            Item::Struct(item) => &item.attrs,
            Item::Trait(item) => &item.attrs,
            Item::Type(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            _ => &Vec::new(),
        };
        if !only_for_tests(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        self.module.push(item.ident.to_string());
        if item.content.is_none() {
            let moved = item.attrs.iter().any(|one| one.path().is_ident("path"));
            assert!(!moved, "`{}` has a path of its own", item.ident);
            self.files.push(self.module.clone());
        }
        visit::visit_item_mod(self, item);
        self.module.pop();
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.import(&[], &item.tree);
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        let attributes = match item {
            ImplItem::Const(item) => &item.attrs,
            ImplItem::Fn(item) => &item.attrs,
            _ => &Vec::new(),
        };
        if !only_for_tests(attributes) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_field(&mut self, field: &'ast syn::Field) {
        if !only_for_tests(&field.attrs) {
            visit::visit_field(self, field);
        }
    }

    fn visit_local(&mut self, local: &'ast syn::Local) {
        if !only_for_tests(&local.attrs) {
            visit::visit_local(self, local);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Names = path
            .segments
            .iter()
            .map(|one| one.ident.to_string())
            .collect();
        self.name(&names);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        if let Some(name) = item.path.segments.last() {
            self.paths.push(vec![format!("{}!", name.ident)]);
        }
        self.tokens(item.tokens.clone());
        visit::visit_macro(self, item);
    }
}

type Graph = BTreeMap<String, BTreeSet<String>>;

/// Each module with the other modules that it uses, and for every such pair a file that shows it.
fn graph(sources: &[SourceFile]) -> (Graph, BTreeMap<(String, String), String>) {
    let modules: BTreeSet<&str> = sources
        .iter()
        .map(|source| source.module.as_str())
        .collect();
    let mut graph = Graph::new();
    let mut shown = BTreeMap::new();
    for source in sources {
        let uses = graph.entry(source.module.clone()).or_default();
        for module in source.modules() {
            if modules.contains(module) && module != source.module {
                uses.insert(module.to_owned());
                let edge = (source.module.clone(), module.to_owned());
                shown.insert(edge, source.path.display().to_string());
            }
        }
    }
    (graph, shown)
}

#[test]
fn modules_use_exactly_what_the_list_says() {
    let (graph, shown) = graph(sources());
    let listed: Graph = USES
        .iter()
        .map(|(module, uses)| {
            (
                (*module).to_owned(),
                uses.iter().map(|module| (*module).to_owned()).collect(),
            )
        })
        .collect();
    let mut differences = Vec::new();
    for (module, uses) in &graph {
        let Some(allowed) = listed.get(module) else {
            differences.push(format!(
                "`{module}` is new: it needs a row here and in docs/architecture.md"
            ));
            continue;
        };
        for other in uses.difference(allowed) {
            let path = &shown[&(module.clone(), other.clone())];
            differences.push(format!(
                "{path} uses `{other}`, which `{module}` must not use"
            ));
        }
        for other in allowed.difference(uses) {
            differences.push(format!(
                "`{module}` no longer uses `{other}`: remove it from the list"
            ));
        }
    }
    for module in listed.keys().filter(|module| !graph.contains_key(*module)) {
        differences.push(format!("`{module}` is gone: remove its row"));
    }
    assert!(
        differences.is_empty(),
        "{}\n{graph:#?}",
        differences.join("\n")
    );
}

/// The modules of a dependency cycle; none if there is no cycle.
fn cycle(mut graph: Graph) -> Vec<String> {
    // Remove the modules that use none of the rest until every module uses another.
    loop {
        let rest: BTreeSet<String> = graph.keys().cloned().collect();
        graph.retain(|_, uses| {
            uses.retain(|module| rest.contains(module));
            !uses.is_empty()
        });
        if graph.len() == rest.len() {
            break;
        }
    }
    let mut walk: Vec<String> = graph.keys().take(1).cloned().collect();
    while let Some(last) = walk.last() {
        let next = graph[last].first().expect("every module uses another");
        if let Some(start) = walk.iter().position(|module| module == next) {
            return walk.split_off(start);
        }
        walk.push(next.clone());
    }
    walk
}

#[test]
fn no_modules_use_each_other_in_a_cycle() {
    let (graph, _) = graph(sources());
    assert_eq!(cycle(graph), [] as [String; 0]);
}

#[test]
fn cycles_are_found() {
    let graph = |edges: &[(&str, &str)]| {
        let mut graph = Graph::new();
        for (from, to) in edges {
            graph.entry((*to).to_owned()).or_default();
            graph
                .entry((*from).to_owned())
                .or_default()
                .insert((*to).to_owned());
        }
        graph
    };
    let mut edges = vec![("a", "b"), ("b", "c"), ("c", "d"), ("a", "d"), ("e", "b")];
    assert!(cycle(graph(&edges)).is_empty());
    edges.push(("d", "b"));
    assert_eq!(cycle(graph(&edges)), ["b", "c", "d"]);
}

#[test]
fn only_the_rim_touches_the_world() {
    for source in sources() {
        for (only, modules, why) in ONLY_IN {
            let only: Vec<&str> = only.split("::").collect();
            let begins = |path: &Names| {
                path.len() >= only.len() && path.iter().zip(&only).all(|(a, b)| a == b)
            };
            let touches = source.paths.iter().any(begins);
            let allowed = modules.contains(&source.module.as_str());
            let path = source.path.display();
            assert!(
                allowed || !touches,
                "{path} uses `{}`: {why}",
                only.join("::")
            );
        }
    }
}

fn is_rim(module: &str) -> bool {
    RIM.iter().any(|(rim, _)| *rim == module)
}

#[test]
fn the_core_never_uses_the_rim() {
    let (graph, shown) = graph(sources());
    for (module, uses) in graph.iter().filter(|(module, _)| !is_rim(module)) {
        for other in uses.iter().filter(|other| is_rim(other)) {
            let path = &shown[&(module.clone(), other.clone())];
            assert!(
                module == "main",
                "{path} is of the core, and uses `{other}`"
            );
        }
    }
    for (only, modules, _) in ONLY_IN {
        for module in modules.iter().filter(|module| **module != "main") {
            assert!(
                is_rim(module),
                "`{module}` is of the core, and may use `{only}`"
            );
        }
    }
}

/// What is part of a build is said in one place: each module of the rim belongs to its feature as a whole.
#[test]
fn features_are_named_at_modules_of_the_rim_alone() {
    let text = fs::read_to_string(src().join("lib.rs")).expect("src/lib.rs");
    let library = syn::parse_file(&text).expect("Rust");
    let mut found = BTreeMap::new();
    for item in &library.items {
        let Item::Mod(item) = item else { continue };
        if only_for_tests(&item.attrs) {
            continue;
        }
        for cfg in item.attrs.iter().filter(|one| one.path().is_ident("cfg")) {
            let condition: syn::MetaNameValue = cfg.parse_args().expect("one feature");
            assert!(condition.path.is_ident("feature"), "{}", item.ident);
            let syn::Expr::Lit(syn::ExprLit {
                lit: syn::Lit::Str(feature),
                ..
            }) = condition.value
            else {
                panic!("the feature of `{}` has no name", item.ident);
            };
            found.insert(item.ident.to_string(), feature.value());
        }
    }
    let listed = RIM
        .iter()
        .map(|(module, feature)| (module.to_string(), feature.to_string()));
    assert_eq!(found, listed.collect::<BTreeMap<_, _>>());
    for source in sources().iter().filter(|source| source.module != "lib") {
        let text = fs::read_to_string(src().join(&source.path)).expect("a source file");
        let path = source.path.display();
        assert!(
            !text.contains("cfg(feature") && !text.contains("(feature ="),
            "{path} names a feature"
        );
    }
}

#[test]
fn steps_use_only_those_before_them() {
    let sources = sources();
    for (module, steps) in STEPS {
        for (place, step) in steps.iter().enumerate() {
            let folder = Path::new(module).join(step);
            let own = sources
                .iter()
                .filter(|source| source.path.starts_with(&folder));
            assert!(own.clone().next().is_some(), "`{module}` lacks `{step}`");
            for source in own {
                let later = source.paths.iter().find(|path| {
                    let [root, first, second, ..] = path.as_slice() else {
                        return false;
                    };
                    root == "crate"
                        && first == module
                        && steps[place + 1..].contains(&second.as_str())
                });
                let path = source.path.display();
                assert!(
                    later.is_none(),
                    "{path} uses `{}`, a later step",
                    later.map(|path| path.join("::")).unwrap_or_default()
                );
            }
        }
    }
}

#[test]
fn the_map_names_every_module() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/architecture.md");
    let map = fs::read_to_string(path).expect("docs/architecture.md");
    for (module, _) in USES {
        let on_map = map.contains(&format!("| `{module}` |"));
        assert!(
            on_map || matches!(*module, "lib" | "main"),
            "docs/architecture.md lacks `{module}`"
        );
    }
}

/// The reader sees what text would hide.
#[test]
fn paths_are_read_from_all_places() {
    let file = syn::parse_file(
        "use crate::{a, b::{self, c as d}};
         use std::{io, time};
         // crate::comment
         fn f(x: super::e::E) -> time::Instant { println!(\"crate::string {}\", crate::g::h!(super::i::j)); }
         #[cfg(test)] mod tests { use crate::k; }
         mod inner { pub(super) use super::super::l; }
         impl T { #[cfg(test)] fn t() { crate::m::n() } }",
    )
    .expect("Rust");
    let mut reader = Reader {
        module: vec!["here".to_owned()],
        ..Reader::default()
    };
    reader.visit_file(&file);
    let source = SourceFile {
        module: "here".to_owned(),
        path: PathBuf::new(),
        paths: reader.resolved(),
    };
    let modules: BTreeSet<&str> = source.modules().collect();
    assert_eq!(modules, ["a", "b", "e", "g", "i", "l"].into());
    let text: Vec<String> = source.paths.iter().map(|path| path.join("::")).collect();
    for path in ["crate::b::c", "std::time::Instant", "println!"] {
        assert!(text.contains(&path.to_owned()), "{text:?} lacks {path}");
    }
}
