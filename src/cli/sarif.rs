//! Diagnostics for code scanners: `--format sarif`, which is SARIF 2.1.0.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde::Serialize;

use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::report::{Findings, pretty};
use crate::source::LineIndex;
use crate::source::Span;

/// The findings as SARIF, with a line feed at the end.
pub(crate) fn sarif(drawings: &[Findings]) -> String {
    let results = drawings.iter().flat_map(|findings| {
        let places = LineIndex::new(findings.text);
        let uri = uri(findings.path);
        let result = |diagnostic| result(diagnostic, &uri, &places);
        findings.diagnostics.iter().map(result).collect::<Vec<_>>()
    });
    pretty(&Log {
        schema: "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
        version: "2.1.0",
        runs: [Run {
            tool: Tool {
                driver: Driver {
                    name: "okoshi",
                    version: env!("CARGO_PKG_VERSION"),
                    rules: Code::ALL.iter().map(|code| rule(*code)).collect(),
                },
            },
            column_kind: "unicodeCodePoints",
            results: results.collect(),
        }],
    })
}

#[derive(Serialize)]
struct Log {
    #[serde(rename = "$schema")]
    schema: &'static str,
    version: &'static str,
    runs: [Run; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Run {
    tool: Tool,
    column_kind: &'static str,
    results: Vec<Finding>,
}

#[derive(Serialize)]
struct Tool {
    driver: Driver,
}

#[derive(Serialize)]
struct Driver {
    name: &'static str,
    version: &'static str,
    rules: Vec<Rule>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Rule {
    id: &'static str,
    short_description: Words,
    help: Words,
    default_configuration: Configuration,
}

#[derive(Serialize)]
struct Configuration {
    level: &'static str,
}

#[derive(Serialize)]
struct Words {
    text: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    markdown: Option<String>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Finding {
    rule_id: &'static str,
    rule_index: usize,
    level: &'static str,
    message: Words,
    locations: [Location; 1],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    related_locations: Vec<Location>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fixes: Vec<FixEntry>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Location {
    physical_location: PhysicalLocation,
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<Words>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PhysicalLocation {
    artifact_location: Artifact,
    region: Region,
}

#[derive(Serialize)]
struct Artifact {
    uri: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Region {
    start_line: usize,
    start_column: usize,
    end_line: usize,
    end_column: usize,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct FixEntry {
    description: Words,
    artifact_changes: [Changes; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Changes {
    artifact_location: Artifact,
    replacements: Vec<Replacement>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Replacement {
    deleted_region: Region,
    inserted_content: Words,
}

fn rule(code: Code) -> Rule {
    let manual = code.manual().trim();
    Rule {
        id: code.id(),
        short_description: words(code.title()),
        help: Words {
            text: manual.to_owned(),
            markdown: Some(manual.to_owned()),
        },
        default_configuration: Configuration {
            level: level(code.severity()),
        },
    }
}

fn result(diagnostic: &Diagnostic, uri: &str, places: &LineIndex<&str>) -> Finding {
    let artifact = || Artifact {
        uri: uri.to_owned(),
    };
    let location = |span, message: Option<&str>| Location {
        physical_location: PhysicalLocation {
            artifact_location: artifact(),
            region: region(span, places),
        },
        message: message.map(words),
    };
    let related = diagnostic.related.iter();
    let related = related.map(|related| location(related.span, Some(&related.message)));
    let fixes = diagnostic.fixes.iter().map(|fix| FixEntry {
        description: words(&fix.title),
        artifact_changes: [Changes {
            artifact_location: artifact(),
            replacements: fix
                .edits
                .iter()
                .map(|edit| Replacement {
                    deleted_region: region(edit.span, places),
                    inserted_content: words(&edit.text),
                })
                .collect(),
        }],
    });
    let help = diagnostic.help.as_ref();
    let help = help.map_or(String::new(), |help| format!("\n{help}"));
    let index = Code::ALL.iter().position(|code| *code == diagnostic.code);
    Finding {
        rule_id: diagnostic.code.id(),
        rule_index: index.unwrap_or_default(),
        level: level(diagnostic.severity()),
        message: words(&format!("{}{help}", diagnostic.message)),
        locations: [location(diagnostic.span, diagnostic.label.as_deref())],
        related_locations: related.collect(),
        fixes: fixes.collect(),
    }
}

fn words(text: &str) -> Words {
    Words {
        text: text.to_owned(),
        markdown: None,
    }
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Hint => "note",
    }
}

fn region(span: Span, places: &LineIndex<&str>) -> Region {
    let (start_line, start_column) = places.line_column(span.start);
    let (end_line, end_column) = places.line_column(span.end);
    Region {
        start_line,
        start_column,
        end_line,
        end_column,
    }
}

/// The bytes of a path that a relative reference holds as `%` and two digits.
const ENCODED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'.')
    .remove(b'_')
    .remove(b'~')
    .remove(b'/')
    .remove(b':')
    .remove(b'@')
    .remove(b'+')
    .remove(b',');

/// A path as a relative reference, with `/` between its parts.
fn uri(path: &str) -> String {
    let path = if cfg!(windows) {
        path.replace('\\', "/")
    } else {
        path.to_owned()
    };
    // A first part with a colon would be read as a scheme.
    let first = path.split('/').next();
    let prefix = if first.is_some_and(|part| part.contains(':')) {
        "./"
    } else {
        ""
    };
    format!("{prefix}{}", utf8_percent_encode(&path, ENCODED))
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::report::samples::{DRAWING, at, misspelled};

    fn log() -> Value {
        let finding = misspelled(DRAWING).related(at(DRAWING, "頭"), "the parent");
        let findings = Findings {
            look: None,
            path: "my figures/腕.svg",
            text: DRAWING,
            diagnostics: &[finding],
        };
        serde_json::from_str(&sarif(&[findings])).unwrap()
    }

    #[test]
    fn a_result_names_its_rule_and_its_places() {
        let log = log();
        let results = &log["runs"][0]["results"];
        insta::assert_snapshot!(serde_json::to_string_pretty(results).unwrap(), @r#"
        [
          {
            "fixes": [
              {
                "artifactChanges": [
                  {
                    "artifactLocation": {
                      "uri": "my%20figures/%E8%85%95.svg"
                    },
                    "replacements": [
                      {
                        "deletedRegion": {
                          "endColumn": 25,
                          "endLine": 2,
                          "startColumn": 21,
                          "startLine": 2
                        },
                        "insertedContent": {
                          "text": "Shape"
                        }
                      }
                    ]
                  }
                ],
                "description": {
                  "text": "write `Shape`"
                }
              }
            ],
            "level": "error",
            "locations": [
              {
                "message": {
                  "text": "not a keyword"
                },
                "physicalLocation": {
                  "artifactLocation": {
                    "uri": "my%20figures/%E8%85%95.svg"
                  },
                  "region": {
                    "endColumn": 25,
                    "endLine": 2,
                    "startColumn": 21,
                    "startLine": 2
                  }
                }
              }
            ],
            "message": {
              "text": "unknown keyword `Shap`\n`okoshi explain` lists the keywords"
            },
            "relatedLocations": [
              {
                "message": {
                  "text": "the parent"
                },
                "physicalLocation": {
                  "artifactLocation": {
                    "uri": "my%20figures/%E8%85%95.svg"
                  },
                  "region": {
                    "endColumn": 13,
                    "endLine": 7,
                    "startColumn": 12,
                    "startLine": 7
                  }
                }
              }
            ],
            "ruleId": "E101",
            "ruleIndex": 8
          }
        ]
    "#);
        let index = results[0]["ruleIndex"].as_u64().unwrap() as usize;
        let rule = &log["runs"][0]["tool"]["driver"]["rules"][index];
        assert_eq!(rule["id"], results[0]["ruleId"]);
    }

    #[test]
    fn every_code_is_a_rule() {
        let log = log();
        let rules = log["runs"][0]["tool"]["driver"]["rules"]
            .as_array()
            .unwrap();
        assert_eq!(rules.len(), Code::ALL.len());
        assert_eq!(rules[0]["defaultConfiguration"]["level"], "error");
    }

    #[test]
    fn paths_are_written_as_addresses() {
        assert_eq!(uri("a b/100%.svg"), "a%20b/100%25.svg");
        assert_eq!(uri("a:b.svg"), "./a:b.svg");
        assert_eq!(uri("/tmp/a.svg"), "/tmp/a.svg");
    }
}
