//! What pages and sources say about each other is true.
//!
//! The recipes of docs/development.md name every place that has to change: for each, something that was added by it is looked for in the
//! sources, and each file that names it must be in the recipe. Sources cite only pages that are there.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};

/// Recipes, what stands for `NAME` in them, and the words by which that is known in the sources.
const RECIPES: &[(&str, &str, &[&str])] = &[
    ("A new keyword", "metallic", &["Metallic", "METALLIC"]),
    ("A new keyword", "strokes", &["STROKES"]),
    ("A new kind of shape", "coneh", &["coneh", "Coneh"]),
    ("A new built-in clip", "sneak", &["sneak", "Sneak"]),
    ("A new exporter", "obj", &["obj", "OBJ", "Obj"]),
    (
        "A new editor feature",
        "folding",
        &["folding", "folding_range", "on_folding_range"],
    ),
    ("A new system", "terrain", &["terrain"]),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The text below a heading of the page, up to the next one.
fn recipe(page: &str, heading: &str) -> String {
    let begin = page.find(&format!("\n## {heading}\n")).expect(heading);
    let rest = &page[begin + 4..];
    rest[..rest.find("\n## ").unwrap_or(rest.len())].to_owned()
}

/// All files below a folder of the sources that are no tests.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if name == "tests" || name.ends_with("_tests") || name == "fixtures" || name == "samples" {
            continue;
        }
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The identifiers of a file, and its texts that are one word. Items of tests are left out, and attributes, which include documentation.
fn words(text: &str) -> BTreeSet<String> {
    let tokens: TokenStream = text.parse().expect("Rust");
    let mut words = BTreeSet::new();
    gather(tokens, &mut words);
    words
}

fn gather(tokens: TokenStream, words: &mut BTreeSet<String>) {
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Punct(sign) if sign.as_char() == '#' => {
                let attribute = tokens.next().map(|tokens| tokens.to_string());
                if attribute.is_some_and(|attribute| attribute.replace(' ', "") == "[cfg(test)]") {
                    // The item goes up to its braces, or to a semicolon.
                    let ends = |token: &TokenTree| match token {
                        TokenTree::Group(group) => {
                            group.delimiter() == proc_macro2::Delimiter::Brace
                        }
                        TokenTree::Punct(sign) => sign.as_char() == ';',
                        _ => false,
                    };
                    for token in tokens.by_ref() {
                        if ends(&token) {
                            break;
                        }
                    }
                }
            }
            TokenTree::Group(group) => gather(group.stream(), words),
            TokenTree::Ident(ident) => words.extend([ident.to_string()]),
            TokenTree::Literal(literal) => {
                words.extend([literal.to_string().trim_matches('"').to_owned()]);
            }
            TokenTree::Punct(_) => {}
        }
    }
}

/// The paths in a recipe: what is in backticks and looks like a file or a folder of `src`.
fn paths(recipe: &str, name: &str) -> Vec<String> {
    let quoted = recipe.split('`').skip(1).step_by(2);
    let below = |path: &str| path.strip_prefix("src/").unwrap_or(path).to_owned();
    quoted
        .filter(|quoted| quoted.contains(['/', '.']) && !quoted.contains(' '))
        .map(|path| below(path).replace("NAME", name))
        .collect()
}

/// The files of `src` that are no tests, by their paths below it, each with its words.
fn sources() -> Vec<(String, BTreeSet<String>)> {
    let mut sources = Vec::new();
    files(&root().join("src"), &mut sources);
    let read = |path: &PathBuf| {
        let place = path.strip_prefix(root().join("src")).expect("below src");
        let text = fs::read_to_string(path).expect("a source file");
        (place.to_string_lossy().replace('\\', "/"), words(&text))
    };
    sources.iter().map(read).collect()
}

/// The files with one of the words that a recipe's paths do not name.
fn omitted(
    sources: &[(String, BTreeSet<String>)],
    paths: &[String],
    known_by: &[&str],
) -> Vec<String> {
    let has = |words: &BTreeSet<String>| known_by.iter().any(|word| words.contains(*word));
    let found = sources.iter().filter(|(_, words)| has(words));
    let found: Vec<&String> = found.map(|(place, _)| place).collect();
    assert!(found.len() > 1, "only {found:?} have {known_by:?}");
    let is_named = |place: &str| {
        let mut paths = paths.iter();
        paths.any(|path| place == path || (path.ends_with('/') && place.starts_with(path)))
    };
    let omitted = found.into_iter().filter(|place| !is_named(place));
    omitted.cloned().collect()
}

#[test]
fn recipes_name_every_place() {
    let page = fs::read_to_string(root().join("docs/development.md")).expect("the page");
    let sources = sources();
    let mut all = Vec::new();
    for (heading, name, known_by) in RECIPES {
        let paths = paths(&recipe(&page, heading), name);
        let omitted = omitted(&sources, &paths, known_by);
        all.extend(omitted.into_iter().map(|place| (*heading, *name, place)));
    }
    assert!(
        all.is_empty(),
        "recipes leave out places of what was added by them: {all:#?}"
    );
}

/// A code is in the table and where its problem is found; any other place is in the recipe.
#[test]
fn the_recipe_of_diagnostics_names_every_list_of_codes() {
    let page = fs::read_to_string(root().join("docs/development.md")).expect("the page");
    let paths = paths(&recipe(&page, "A new diagnostic"), "");
    let mut lists = 0;
    for (place, words) in sources() {
        let mut makers = ["new", "diagnostics", "diagnostic"].iter();
        if words.contains("Code") && !makers.any(|word| words.contains(*word)) {
            lists += 1;
            assert!(
                paths.contains(&place),
                "the recipe of diagnostics leaves out {place}"
            );
        }
    }
    assert!(lists > 0, "no list of codes was found");
}

#[test]
fn sources_cite_pages_that_are_there() {
    let mut cited = 0;
    let mut sources = Vec::new();
    files(&root().join("src"), &mut sources);
    for path in sources {
        let text = fs::read_to_string(&path).expect("a source file");
        let comments = text
            .lines()
            .filter(|line| line.trim_start().starts_with("//"));
        let names = comments
            .flat_map(|line| line.split(|c: char| !(c.is_alphanumeric() || "-_./".contains(c))));
        for name in names.filter(|name| name.ends_with(".md") && !name.starts_with('.')) {
            cited += 1;
            assert!(
                root().join(name).is_file(),
                "{} cites `{name}`, which is not there",
                path.display()
            );
        }
    }
    assert!(cited > 5, "only {cited} pages are cited");
}

#[test]
fn words_are_read_from_all_but_tests_and_documentation() {
    let words = words(
        "/// documented
         #[derive(Derived)] fn f() { g(\"text\") }
         table! { Row => \"row\" }
         #[cfg(test)] mod tests { fn tested() {} }
         fn after() {}",
    );
    for word in ["f", "g", "text", "Row", "row", "after"] {
        assert!(words.contains(word), "{word}");
    }
    for word in ["documented", "Derived", "tested", "tests"] {
        assert!(!words.contains(word), "{word}");
    }
}

#[test]
fn every_manifest_has_the_version_of_the_program() {
    let version = env!("CARGO_PKG_VERSION");
    for (path, line) in [
        (
            "editors/vscode/package.json",
            format!("\"version\": \"{version}\","),
        ),
        (
            "editors/web/package.json",
            format!("\"version\": \"{version}\","),
        ),
        ("editors/emacs/okoshi.el", format!(";; Version: {version}")),
        (
            "docs/motion/kick.svg",
            format!("written by okoshi {version} "),
        ),
        ("CHANGELOG.md", format!("## {version}")),
    ] {
        let text = std::fs::read_to_string(path).expect("a file");
        assert!(text.contains(&line), "{path} has no `{line}`");
    }
}
