//! The recipes of docs/development.md name every place that has to change.
//!
//! For each recipe, something that was added by it is looked for in the sources: each file that names it must be in the recipe.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};

/// Recipes, what stands for `NAME` in them, and the words by which that is known in the sources.
const RECIPES: &[(&str, &str, &[&str])] = &[
    ("A new keyword", "metallic", &["Metallic", "METALLIC"]),
    ("A new keyword", "strokes", &["STROKES"]),
    ("A new kind of shape", "coneh", &["coneh", "Coneh"]),
    ("A new clip that comes along", "sneak", &["sneak", "Sneak"]),
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

/// The files of `src` with one of the words that a recipe's paths do not name.
fn omitted(recipe: &str, name: &str, known_by: &[&str]) -> Vec<String> {
    let mut sources = Vec::new();
    files(&root().join("src"), &mut sources);
    let paths = paths(recipe, name);
    let mut found = 0;
    let mut omitted = Vec::new();
    for path in &sources {
        let words = words(&fs::read_to_string(path).expect("a source file"));
        if !known_by.iter().any(|word| words.contains(*word)) {
            continue;
        }
        found += 1;
        let place = path.strip_prefix(root().join("src")).expect("below src");
        let place = place.to_string_lossy().replace('\\', "/");
        let is_named =
            |path: &String| place == *path || (path.ends_with('/') && place.starts_with(path));
        if !paths.iter().any(is_named) {
            omitted.push(place);
        }
    }
    assert!(found > 1, "only {found} files have {known_by:?}");
    omitted
}

#[test]
fn recipes_name_every_place() {
    let page = fs::read_to_string(root().join("docs/development.md")).expect("the page");
    let mut all = Vec::new();
    for (heading, name, known_by) in RECIPES {
        let omitted = omitted(&recipe(&page, heading), name, known_by);
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
    let mut sources = Vec::new();
    files(&root().join("src"), &mut sources);
    let mut lists = 0;
    for path in sources {
        let text = fs::read_to_string(&path).expect("a source file");
        let place = path.strip_prefix(root().join("src")).expect("below src");
        let place = place.to_string_lossy().replace('\\', "/");
        let words = words(&text);
        let makes = ["new", "diagnostics", "diagnostic"]
            .iter()
            .any(|word| words.contains(*word));
        if words.contains("Code") && !makes {
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
