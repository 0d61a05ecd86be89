use super::{Numbers, tree};
use crate::cli::loading::Loaded;
use crate::compile::{Options, compile};
use crate::ide::VISITED;
use crate::report::inspection_json;
use crate::resolver::MemoryResolver;

/// A drawing of so many parts in a row, each with a sub-part.
fn row(parts: usize, is_annotated: bool) -> Loaded {
    let part = |at: usize| {
        let (x, name) = (20 * at, format!("Stone{at}"));
        let (id, desc) = if is_annotated {
            (String::new(), format!("<desc>{name}</desc>"))
        } else {
            (format!(" id='{name}'"), String::new())
        };
        format!(
            "<g{id}>{desc}<rect x='{x}' width='9' height='9'/><circle cx='{x}' cy='5' r='2' fill='red'/></g>"
        )
    };
    let parts: String = (0..parts).map(part).collect();
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg'>{parts}</svg>");
    Loaded {
        path: "row.svg".to_owned(),
        compiled: compile(&text, &Options::default(), &MemoryResolver::default()),
        text,
        look: None,
    }
}

#[test]
fn all_subjects_are_gone_through_a_few_times_however_many_there_are() {
    for is_annotated in [false, true] {
        let prints: [fn(&Loaded) -> String; 2] = [
            |loaded| tree(loaded, Numbers::None),
            |loaded| inspection_json(&loaded.path, &loaded.compiled, &loaded.text, None),
        ];
        for print in prints {
            let visited = |parts: usize| {
                let loaded = row(parts, is_annotated);
                let before = VISITED.get();
                let printed = print(&loaded);
                assert!(
                    printed.contains(&format!("Stone{}", parts - 1)),
                    "{printed}"
                );
                VISITED.get() - before
            };
            let (few, many) = (visited(20), visited(80));
            assert!(few >= 20, "{few}");
            assert!(many < 5 * few, "{few} for 20 parts, {many} for 80");
        }
    }
}
