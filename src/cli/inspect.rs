//! `okoshi inspect`: the hierarchy, who is bound to what, and why.

mod clips;
mod matches;

use std::collections::BTreeMap;
use std::path::Path;

use super::args::{Common, Inspect};
use super::loading::{Loaded, load};
use super::progress::spinning;
use super::{Outcome, fail, print_out};
use crate::billboard::{Character, RegionModel, Track};
use crate::bind::{self, NamedBy, PartKind, SetBy};
use crate::disk::is_standard_stream;
use crate::lang::keyword::Keyword;
use crate::report::{depth_reason, describe_character, inspection_json, own_name};
use crate::terrain::Layer;

/// Prints the hierarchy, and draws the matching if that is asked for; findings go to stderr.
pub(super) fn run(arguments: &Inspect, common: Common) -> Outcome {
    let picture = match arguments
        .matches
        .as_deref()
        .map(|path| checked(path, arguments))
    {
        Some(Err(message)) => return fail(&message),
        Some(Ok(path)) => Some(path),
        None => None,
    };
    let loaded = match spinning("inspecting", || {
        load(&arguments.drawing, &arguments.reading)
    }) {
        Ok(loaded) => loaded,
        Err(outcome) => return outcome,
    };
    eprint!("{}", loaded.findings_aside(common));
    let drawn = match picture {
        Some(path) => matches::draw(&loaded, path, arguments, common),
        None => Outcome::Done,
    };
    if picture.is_some_and(is_standard_stream) || drawn == Outcome::Failed {
        return loaded.outcome().max(drawn);
    }
    let text = if arguments.json {
        inspection_json(&loaded.path, &loaded.compiled, &loaded.text)
    } else {
        let numbers = match picture {
            Some(_) => Numbers::AsInPicture,
            None => Numbers::None,
        };
        tree(&loaded, numbers)
    };
    loaded.outcome().max(drawn).max(print_out(&text))
}

/// The path of the picture, unless the command cannot write it whatever is in the drawing.
fn checked<'a>(path: &'a Path, arguments: &Inspect) -> Result<&'a Path, String> {
    if is_standard_stream(path) {
        return if arguments.json {
            Err(
                "--json and --matches would both be written to stdout: name a file, for example --matches pairs.png"
                    .to_owned(),
            )
        } else {
            Ok(path)
        };
    }
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("png") => Ok(path),
        _ => Err(format!(
            "the picture `{}` of --matches must end in .png",
            path.display()
        )),
    }
}

/// Whether the list of a character's regions shows their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Numbers {
    None,
    AsInPicture,
}

fn tree(loaded: &Loaded, numbers: Numbers) -> String {
    let bindings = &loaded.compiled.bindings;
    let mut children: BTreeMap<Option<usize>, Vec<Item>> = BTreeMap::new();
    for (index, part) in bindings
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| part.kind == PartKind::Main)
    {
        let below = children.entry(part.parent).or_default();
        below.push(Item::Part(index));
    }
    for (index, layer) in loaded.compiled.layers.iter().enumerate() {
        let below = children.entry(layer.parent).or_default();
        below.push(Item::Layer(index));
    }
    for index in 0..loaded.compiled.characters.len() {
        let below = children.entry(None).or_default();
        below.push(Item::Character(index));
    }
    let mut rows: Vec<[String; 2]> = vec![["Root".to_owned(), String::new()]];
    let mut stack: Vec<(Item, String, bool)> = Vec::new();
    let push = |stack: &mut Vec<(Item, String, bool)>, parent: Option<usize>, indent: &str| {
        let children = children.get(&parent).map_or(&[][..], Vec::as_slice);
        for (place, child) in children.iter().enumerate().rev() {
            stack.push((*child, indent.to_owned(), place + 1 == children.len()));
        }
    };
    push(&mut stack, None, "");
    while let Some((item, indent, last)) = stack.pop() {
        let (branch, below) = if last {
            ("└─ ", "   ")
        } else {
            ("├─ ", "│  ")
        };
        let [name, what] = match item {
            Item::Part(part) => [&bindings.parts[part].name, &describe_part(loaded, part)],
            Item::Layer(layer) => {
                let layer = &loaded.compiled.layers[layer];
                [&layer.name, &describe_layer(layer)]
            }
            Item::Character(index) => {
                let character = &loaded.compiled.characters[index];
                [&character.name, &describe_character(character)]
            }
        };
        rows.push([format!("{indent}{branch}{name}"), what.clone()]);
        if let Item::Layer(layer) = item {
            let listed = contents(&loaded.compiled.layers[layer]);
            let indented = listed.into_iter();
            rows.extend(indented.map(|[name, what]| [format!("{indent}{below}  {name}"), what]));
        }
        if let Item::Character(index) = item {
            let character = &loaded.compiled.characters[index];
            let listed = regions(loaded, character, numbers).into_iter();
            rows.extend(listed.map(|[name, what]| [format!("{indent}{below}  {name}"), what]));
        }
        if let Item::Part(part) = item {
            push(&mut stack, Some(part), &format!("{indent}{below}"));
        }
    }
    let mut out = columns(&rows);
    let left_out: Vec<[String; 2]> = bindings
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| {
            matches!(part.kind, PartKind::Legend | PartKind::Unused) && part.is_candidate()
        })
        .map(|(index, part)| {
            [
                format!("   {}", own_name(&loaded.compiled, part)),
                format!("{}, {}", part.kind.name(), string(loaded, index)),
            ]
        })
        .collect();
    if !left_out.is_empty() {
        out.push_str("left out\n");
        out.push_str(&columns(&left_out));
    }
    out.push_str(&clips::clips(&loaded.compiled));
    out
}

/// Something that hangs on the root or on a part.
#[derive(Clone, Copy)]
enum Item {
    /// Index of a main part.
    Part(usize),
    /// Index of a tile map.
    Layer(usize),
    /// Index of a character that turns.
    Character(usize),
}

/// The regions of a character, with what each is in the views.
fn regions(loaded: &Loaded, character: &Character, numbers: Numbers) -> Vec<[String; 2]> {
    let drawing = &loaded.compiled.drawing;
    let tracks = character.regions.iter().zip(&character.matching.tracks);
    let row = |(index, (region, track)): (usize, (&RegionModel, &Track))| {
        let members = region.shapes.iter().zip(&track.regions);
        let members: Vec<String> = members
            .map(|(shape, number)| match (shape, number) {
                (Some(shape), Some(number)) => match drawing.shapes[*shape].picture {
                    Some(_) => format!("region {}", usize::from(*number) + 1),
                    None => drawing.shapes[*shape].element.describe(),
                },
                _ => "not drawn".to_owned(),
            })
            .collect();
        let name = match numbers {
            Numbers::None => region.name.clone(),
            Numbers::AsInPicture => format!("{} {}", index + 1, region.name),
        };
        [name, members.join(" – ")]
    };
    let mut listed: Vec<[String; 2]> = tracks.enumerate().map(row).collect();
    shorten(&mut listed);
    listed
}

/// Cuts a long list short, and says so.
fn shorten(listed: &mut Vec<[String; 2]>) {
    let more = listed.len().checked_sub(MAX_LISTED);
    if let Some(more) = more.filter(|more| *more > 0) {
        listed.truncate(MAX_LISTED);
        listed.push([
            format!("… and {more} more"),
            "all of them with --json".to_owned(),
        ]);
    }
}

fn describe_layer(layer: &Layer) -> String {
    let map = &layer.map;
    let drawn = map.cells.iter().filter(|look| **look != 0).count();
    format!(
        "terrain of {} × {}, {drawn} tiles of {}",
        map.columns, map.rows, layer.size
    )
}

/// Most groups and houses of a landscape, or regions of a character, that are listed one by one.
const MAX_LISTED: usize = 40;

/// The groups of a landscape with their heights, its ponds and houses.
fn contents(layer: &Layer) -> Vec<[String; 2]> {
    let cells = |count: usize| match count {
        1 => "1 tile".to_owned(),
        count => format!("{count} tiles"),
    };
    let groups = layer.landscape.groups().map(|group| {
        let kind = if group.water { "water" } else { "ground" };
        let [column, row] = group.first.map(|at| at + 1);
        let what = format!("{} from column {column}, row {row} on", cells(group.cells));
        [format!("{kind} at {}", group.height), what]
    });
    let houses = layer.landscape.houses().map(|house| {
        let ridge = house.ridge(layer.roof);
        let what = format!(
            "{} wide, {} deep, walls {} high, ridge at {ridge:.2}",
            house.width, house.depth, house.height
        );
        [format!("house at {}", house.base), what]
    });
    let all = groups.chain(houses);
    let mut listed: Vec<[String; 2]> = all.collect();
    shorten(&mut listed);
    listed
}

fn describe_part(loaded: &Loaded, index: usize) -> String {
    let bindings = &loaded.compiled.bindings;
    let part = &bindings.parts[index];
    let shape = bindings.setting(index, Keyword::Shape);
    let solid = shape.map_or("default".to_owned(), |source| match source.from {
        SetBy::Own => source.setting.text.clone(),
        from => format!("{} ({})", source.setting.text, from.name()),
    });
    let others = bindings.parts.iter();
    let others = others.filter(|other| other.main == index && other.kind == PartKind::Sub);
    let (ink, subs): (Vec<&bind::Part>, Vec<&bind::Part>) =
        others.partition(|other| other.host.is_some());
    let subs = match subs.len() {
        0 => String::new(),
        1 => ", 1 sub-part".to_owned(),
        count => format!(", {count} sub-parts"),
    };
    let ink = match ink.len() {
        0 => String::new(),
        1 => ", 1 stroke".to_owned(),
        count => format!(", {count} strokes"),
    };
    let element = loaded.compiled.drawing.shapes[part.shape]
        .element
        .describe();
    let depth = depth_reason(&loaded.compiled, index);
    let depth = depth.map_or(String::new(), |reason| format!("; {reason}"));
    format!(
        "{solid}{subs}{ink}; {element}, {}{depth}",
        string(loaded, index)
    )
}

/// By what rule a part has its string.
fn string(loaded: &Loaded, part: usize) -> String {
    let bindings = &loaded.compiled.bindings;
    let binding = bindings.parts[part]
        .string
        .and_then(|string| bindings.strings[string].binding);
    match binding {
        None if bindings.parts[part].kind != PartKind::Main => "no string".to_owned(),
        None => match bindings.parts[part].named_by {
            NamedBy::Label { .. } => "named by its label".to_owned(),
            NamedBy::Id { .. } => "named by its id".to_owned(),
            NamedBy::String | NamedBy::Automatic => "no string".to_owned(),
        },
        Some(binding) => format!("bound by {}", binding.by.name()),
    }
}

/// Columns, all but the last as wide as their widest cell.
fn columns<const COUNT: usize>(rows: &[[String; COUNT]]) -> String {
    use unicode_width::UnicodeWidthStr;
    let width = |column: usize| rows.iter().map(|row| row[column].width()).max();
    let widths: [usize; COUNT] = std::array::from_fn(|column| width(column).unwrap_or(0));
    rows.iter().fold(String::new(), |mut out, row| {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(widths) {
            line.push_str(cell);
            line.push_str(&" ".repeat(width - cell.width() + 2));
        }
        out.push_str(line.trim_end());
        out.push('\n');
        out
    })
}
