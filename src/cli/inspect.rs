//! `okoshi inspect`: the hierarchy, who is bound to what, and why.

mod clips;
mod matches;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use rustc_hash::FxHashMap;
use serde::Serialize;

use super::args::{Common, Inspect};
use super::loading::{Loaded, folder_of_links, load};
use super::progress::spinning;
use super::{Failure, Outcome, counted, fail, print_out};
use crate::billboard::{Character, RegionModel, Track};
use crate::bind::{NamedBy, PartId, SetBy};
use crate::compile::Compiled;
use crate::disk::{self, is_standard_stream};
use crate::export;
use crate::ide::changes::PartForm;
use crate::ide::{Analysis, Subject, Which};
use crate::lang::keyword::Keyword;
use crate::report::{Fit, MatchedBy, Reasons, Undo, describe_character, figures, inspection_json};
use crate::terrain::{LandscapeId, Layer, Place};

/// Prints the hierarchy, and draws the matching if that is asked for; findings go to stderr.
pub(super) fn run(arguments: &Inspect, common: Common) -> Result<Outcome, Failure> {
    let picture = arguments.matches.as_deref();
    let picture = picture.map(|path| checked(path, arguments)).transpose()?;
    let loaded = spinning("inspecting", || {
        load(&arguments.drawing, &arguments.reading)
    })?;
    if !arguments.forms.is_empty() {
        return forms(loaded, arguments, common);
    }
    eprint!("{}", loaded.findings_aside(common));
    let drawn = match picture {
        Some(path) => matches::draw(&loaded, path, arguments, common),
        None => Outcome::Done,
    };
    if picture.is_some_and(is_standard_stream) || drawn == Outcome::Failed {
        return Ok(loaded.outcome().max(drawn));
    }
    let size = export::size(&loaded.compiled.scene)?;
    let text = if arguments.json {
        inspection_json(&loaded.path, &loaded.compiled, &loaded.text, size)
    } else {
        let numbers = match picture {
            Some(_) => Numbers::AsInPicture,
            None => Numbers::None,
        };
        let size = size.map(|size| format!("model {size}\n"));
        tree(&loaded, numbers) + &size.unwrap_or_default()
    };
    Ok(loaded.outcome().max(drawn).max(print_out(&text)))
}

/// What can be changed about some parts.
#[derive(Debug, Serialize)]
struct Forms<'a> {
    drawing: &'a str,
    forms: Vec<PartForm>,
}

/// Prints what can be changed about parts, as JSON. A part is called by its name, or by the `id` of an element behind `#`.
fn forms(loaded: Loaded, arguments: &Inspect, common: Common) -> Result<Outcome, Failure> {
    let is_readable = !loaded.compiled.drawing.groups.is_empty();
    if !is_readable {
        eprint!("{}", loaded.findings_aside(common));
        return Ok(loaded.outcome());
    }
    let Loaded {
        path,
        text,
        compiled,
        ..
    } = loaded;
    let analysis = Analysis::new(text, compiled);
    let motions = disk::motions(&folder_of_links(&arguments.drawing, &arguments.reading));
    let mut forms = vec![];
    let mut outcome = Outcome::Done;
    for part in &arguments.forms {
        let name = match part.strip_prefix('#') {
            Some(id) => analysis.part_of_element(id),
            None => Ok(part.clone()),
        };
        match name.and_then(|name| analysis.form(&name)) {
            Ok(form) => forms.push(form.with_motion_files(motions.clone())),
            Err(refusal) => outcome = fail(format!("{path}: {refusal}")),
        }
    }
    if forms.is_empty() {
        eprintln!("`okoshi inspect {path}` lists the parts");
        return Ok(outcome);
    }
    let forms = Forms {
        drawing: &path,
        forms,
    };
    let forms = serde_json::to_string_pretty(&forms)? + "\n";
    Ok(outcome.max(print_out(&forms)))
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
    let mut children: BTreeMap<Option<Which>, Vec<Subject<'_>>> = BTreeMap::new();
    let all = Subject::all(&loaded.compiled);
    for subject in all.filter(|subject| subject.is_main() || is_layer(*subject)) {
        let parent = subject.parent().map(|parent| parent.which);
        children.entry(parent).or_default().push(subject);
    }
    let mut nodes = Nodes::new(&loaded.compiled);
    let mut rows: Vec<[String; 2]> = vec![["Root".to_owned(), String::new()]];
    let mut stack: Vec<(Subject<'_>, String, bool)> = Vec::new();
    let push = |stack: &mut Vec<_>, parent, indent: &str| {
        let children = children.get(&parent).map_or(&[][..], Vec::as_slice);
        for (place, child) in children.iter().enumerate().rev() {
            stack.push((*child, indent.to_owned(), place + 1 == children.len()));
        }
    };
    push(&mut stack, None, "");
    while let Some((subject, indent, last)) = stack.pop() {
        let (branch, below) = if last {
            ("└─ ", "   ")
        } else {
            ("├─ ", "│  ")
        };
        let (what, listed) = match subject.which {
            Which::Part(part) => (nodes.describe(subject, part), Vec::new()),
            Which::Landscape(layer) => {
                let own = &loaded.compiled.layers[layer];
                (describe_layer(own), contents(&loaded.compiled, layer))
            }
            Which::Character(character) | Which::Region(character, _) => {
                let character = &loaded.compiled.characters[character];
                let regions = regions(loaded, character, numbers);
                (describe_character(character), regions)
            }
        };
        rows.push([format!("{indent}{branch}{}", subject.name()), what]);
        let listed = listed.into_iter();
        rows.extend(listed.map(|[name, what]| [format!("{indent}{below}  {name}"), what]));
        push(&mut stack, Some(subject.which), &format!("{indent}{below}"));
    }
    let mut out = columns(&rows);
    let left_out = Subject::all(&loaded.compiled).filter(|subject| subject.is_left_out());
    let left_out: Vec<[String; 2]> = left_out
        .map(|subject| {
            [
                format!("   {}", subject.name()),
                format!("{}, {}", subject.kind(), string(subject)),
            ]
        })
        .collect();
    if !left_out.is_empty() {
        out.push_str("left out\n");
        out.push_str(&columns(&left_out));
    }
    out.push_str(&undoing(&nodes.undo));
    out.push_str(&faced(&loaded.compiled));
    out.push_str(&clips::clips(&loaded.compiled));
    out
}

/// What undoes what was said of nodes, in the strings of their parts.
fn undoing(all: &BTreeSet<Undo>) -> String {
    let mut listed: Vec<(&str, Vec<&str>)> = Vec::new();
    for undo in all {
        match listed
            .last_mut()
            .filter(|(string, _)| *string == undo.string())
        {
            Some((_, of)) => of.push(undo.of()),
            None => listed.push((undo.string(), vec![undo.of()])),
        }
    }
    let listed = listed.into_iter();
    let listed: Vec<String> = listed
        .map(|(string, of)| format!("{string} ({})", of.join(", ")))
        .collect();
    match listed.as_slice() {
        [] => String::new(),
        _ => format!("to undo, in a part's string: {}\n", listed.join(", ")),
    }
}

/// Where each figure looks, and why.
fn faced(compiled: &Compiled) -> String {
    let figures = figures(compiled).into_iter();
    let lines = figures.map(|figure| {
        let way = match figure.facing {
            "front" => "the viewer".to_owned(),
            "back" => "away from the viewer".to_owned(),
            "up" => "up".to_owned(),
            side => format!("the drawing's {side}"),
        };
        let against = match figure.doubts {
            [] => String::new(),
            doubts => format!("; against it: {}", doubts.join(", ")),
        };
        let why = figure.reasons.join(", ");
        format!("figure {} faces {way}: {why}{against}\n", figure.figure)
    });
    lines.collect()
}

/// Whether it is a landscape or a character: its parts are listed under it.
fn is_layer(subject: Subject<'_>) -> bool {
    matches!(subject.which, Which::Landscape(_) | Which::Character(_))
}

/// The regions of a character, with what each is in the views.
fn regions(loaded: &Loaded, character: &Character, numbers: Numbers) -> Vec<[String; 2]> {
    let drawing = &loaded.compiled.drawing;
    let tracks = character.regions.iter().zip(&character.matching.tracks);
    let row = |(index, (region, track)): (usize, (&RegionModel, &Track))| {
        let members = region.shapes.iter().zip(&track.regions);
        let members: Vec<String> = members
            .zip(&character.views)
            .map(|((shape, id), view)| match (shape, id) {
                (Some(shape), Some(id)) => match drawing.shapes[*shape].picture {
                    Some(_) => view.looks(*id).to_string(),
                    None => drawing.shapes[*shape].element.describe(),
                },
                _ => "not drawn".to_owned(),
            })
            .collect();
        let name = match numbers {
            Numbers::None => region.name.clone(),
            Numbers::AsInPicture => format!("{} {}", index + 1, region.name),
        };
        let mut what = members.join(" – ");
        if let Some(Fit {
            similarity,
            cost,
            by: MatchedBy::ColorAndPlace,
        }) = Fit::of(character, track)
        {
            let scores = format!("similarity {similarity:.2}, cost {cost:.2}");
            what = format!("{what}; matched by colour and place, {scores}");
        }
        if let Some(paints) = region.paints_in_views() {
            let paints: Vec<String> = paints.raw.into_iter().flatten().collect();
            what = format!("{what}; painted {}", paints.join(" – "));
        }
        [name, what]
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

/// The groups of a landscape with their heights, its ponds, its houses, and what stands on it.
fn contents(compiled: &Compiled, index: LandscapeId) -> Vec<[String; 2]> {
    let layer = &compiled.layers[index];
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
    let props = compiled.bindings.props.iter().zip(&compiled.props);
    let props = props.filter(|(_, stands)| stands.landscape == index);
    let standing = |name: &str, what: &str, Place { cell, point, .. }: Place| {
        let height = (point.y * 100.0).round() / 100.0;
        let place = match cell {
            Some([column, row]) => format!("column {}, row {}", column + 1, row + 1),
            None => "beside the map".to_owned(),
        };
        [format!("{name} at {height}"), format!("{what}, {place}")]
    };
    let props = props.map(|(prop, stands)| {
        let name = &compiled.bindings.parts[prop.main].name;
        standing(name, "a prop", stands.place)
    });
    let objects = layer.objects.iter();
    let objects =
        objects.map(|object| standing(&object.name, "an object", layer.place(object.foot)));
    let all = groups.chain(houses).chain(props).chain(objects);
    let mut listed: Vec<[String; 2]> = all.collect();
    shorten(&mut listed);
    listed
}

/// The nodes of a drawing, and how many solids each has beside that of its main part.
struct Nodes<'a> {
    reasons: Reasons<'a>,
    /// Per main part its sub-parts without ink, and its ink.
    solids: FxHashMap<PartId, [usize; 2]>,
    /// What undoes all that was said.
    undo: BTreeSet<Undo>,
}

impl<'a> Nodes<'a> {
    fn new(compiled: &'a Compiled) -> Self {
        let mut solids: FxHashMap<PartId, [usize; 2]> = FxHashMap::default();
        for sub in Subject::all(compiled).filter(|subject| subject.is_sub()) {
            let main = sub.parent().map(|main| main.which);
            if let Some(Which::Part(main)) = main {
                solids.entry(main).or_default()[usize::from(sub.host().is_some())] += 1;
            }
        }
        Self {
            reasons: Reasons::new(compiled),
            solids,
            undo: BTreeSet::new(),
        }
    }

    fn describe(&mut self, subject: Subject<'_>, index: PartId) -> String {
        let attributes = subject.attributes().into_iter();
        let mut shape = attributes.filter(|attribute| attribute.keyword == Keyword::Shape);
        let solid = shape
            .next()
            .map_or("default".to_owned(), |shape| match shape.from {
                SetBy::Own | SetBy::Builtin => shape.value,
                from => format!("{} ({})", shape.value, from.name()),
            });
        let [subs, ink] = self.solids.get(&index).copied().unwrap_or_default();
        let listed = |count: usize, word: &str| match count {
            0 => String::new(),
            count => format!(", {}", counted(count, word)),
        };
        let (subs, ink) = (listed(subs, "sub-part"), listed(ink, "stroke"));
        let element = subject
            .element()
            .map_or(String::new(), |element| element.describe());
        let depth = self.reasons.depth(index);
        let said = depth.into_iter().chain(self.reasons.node_back(index));
        let said = said.chain(self.reasons.node_forms(index));
        let reasons = said.map(|said| {
            self.undo.extend(said.undo);
            format!("; {}", said.text)
        });
        let reasons: String = reasons.collect();
        format!(
            "{solid}{subs}{ink}; {element}, {}{reasons}",
            string(subject)
        )
    }
}

/// By what rule a part has its string.
fn string(subject: Subject<'_>) -> String {
    match (subject.bound_by(), subject.named_by()) {
        (Some(by), _) => format!("bound by {}", by.name()),
        (None, Some(NamedBy::Label { .. })) => "named by its label".to_owned(),
        (None, Some(NamedBy::Id { .. })) => "named by its id".to_owned(),
        (None, _) => "no string".to_owned(),
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
