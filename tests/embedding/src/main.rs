//! A program that embeds okoshi: it compiles a drawing to a model in memory, and prints the diagnostics.

use okoshi::compile::{Options, compile};
use okoshi::export::{GLB, to_memory};
use okoshi::resolver::MemoryResolver;
use okoshi::LineIndex;

const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
  <rect x="40" y="40" width="20" height="40"/>
  <rect x="60" y="45" width="30" height="8"/>
  <text x="45" y="60">Body</text>
  <text x="65" y="50">Arm@Body$Shape roundv Colour 1 0 0</text>
</svg>
"#;

fn main() -> std::io::Result<()> {
    let compiled = compile(DRAWING, &Options::default(), &MemoryResolver::default());
    let lines = LineIndex::new(DRAWING);
    for diagnostic in &compiled.diagnostics {
        let (line, column) = lines.line_column(diagnostic.span.start);
        let (code, message) = (diagnostic.code.id(), &diagnostic.message);
        println!("{line}:{column}: {code}: {message}");
    }
    // One keyword is misspelt.
    assert_eq!(compiled.diagnostics.len(), 1);
    assert!(compiled.has_errors());
    let model = to_memory(&GLB, &compiled.scene, None)?;
    assert!(model.bytes.starts_with(b"glTF"));
    let nodes = compiled.scene.nodes.len();
    println!(
        "{nodes} nodes, {} triangles, {} bytes",
        model.written.triangles,
        model.bytes.len()
    );
    assert_eq!(nodes, 2);
    Ok(())
}
