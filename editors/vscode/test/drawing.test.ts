import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { runInNewContext } from "node:vm";
import { countOutline, hasStrings, isDrawing, selector, type Outline } from "../src/drawing";
import { drawings, repository } from "./paths";

test("drawings are SVG files of either language, and untitled ones", () => {
  assert.ok(isDrawing(["file"], "xml", "file", "/a/b.svg"));
  assert.ok(isDrawing(["file"], "svg", "file", "/a/b.svg"));
  assert.ok(isDrawing(["file"], "xml", "untitled", "Untitled-1"));
  assert.ok(isDrawing(["file", "vscode-vfs"], "xml", "vscode-vfs", "/a/b.svg"));
  assert.ok(!isDrawing(["file"], "xml", "file", "/a/pom.xml"));
  assert.ok(!isDrawing(["file"], "plaintext", "untitled", "Untitled-1"));
  assert.ok(!isDrawing(["file"], "html", "file", "/a/b.svg"));
  assert.ok(!isDrawing(["file"], "xml", "git", "/a/b.svg"));
});

test("the selector says the same", () => {
  const schemes = ["file", "vscode-vfs"];
  const all = selector(schemes);
  assert.deepEqual([...new Set(all.map(({ scheme, language }) => `${scheme} ${language}`))].sort(), ["file svg", "file xml", "untitled svg", "untitled xml", "vscode-vfs svg", "vscode-vfs xml"]);
  for (const { scheme, language, pattern } of all) {
    assert.ok(isDrawing(schemes, language, scheme, scheme === "untitled" ? "x" : "/x.svg"));
    assert.equal(pattern, scheme === "untitled" ? undefined : "**/*.svg");
  }
});

test("every example with texts has strings", () => {
  for (const drawing of drawings("examples")) {
    const text = readFileSync(drawing, "utf8");
    assert.equal(hasStrings(text), /<(text|desc)\b/.test(text), drawing);
  }
});

test("strings are distinguished from plain texts", () => {
  const text = (content: string) => hasStrings(`<svg><text x="0">${content}</text></svg>`);
  for (const string of ["Arm@Body", "Arm$Shape", "%Scale 2", "$Color red", "*", "@Body", '"left arm"@Body', "右腕＠胴", "％Scale"]) {
    assert.ok(text(string), string);
  }
  for (const plain of ["Arm", "Fig. 1", "# note", "a b@c", "ann at home", ""]) assert.ok(!text(plain), plain);
  assert.ok(hasStrings('<path><desc id="d">@Body</desc></path>'));
  assert.ok(hasStrings("<svg:text>Arm@Body</svg:text>"));
  assert.ok(!hasStrings("<style>@media print {}</style>"));
  assert.ok(!hasStrings(readFileSync(`${repository}/editors/vscode/test/plain.svg`, "utf8")));
});

test("the search for strings takes linear time", () => {
  // A search in quadratic time takes hours; the limit only ends it.
  for (const unit of ['<text>"', "<text>a", "<text ", "<text><", "<text>\n", "a".repeat(50), '<text>"a>']) {
    assert.equal(runInNewContext("search()", { search: () => hasStrings(unit.repeat(1_000_000)) }, { timeout: 300_000 }), false, JSON.stringify(unit));
  }
});

test("outlines are counted with all nested entries", () => {
  assert.equal(countOutline([]), 0);
  assert.equal(countOutline([{ children: [{}, { children: [{}] }] }, {}]), 5);
  let deep: Outline = {};
  for (let depth = 1; depth < 100_000; depth += 1) deep = { children: [deep] };
  assert.equal(countOutline([deep]), 100_000);
});
