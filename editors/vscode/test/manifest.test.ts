import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { test } from "node:test";
import manifest from "../package.json";
import snippets from "../snippets/okoshi.json";

const sources = ["commands", "program-commands", "server", "status"].map((name) => readFileSync(`src/${name}.ts`, "utf8")).join("\n");
const commands = manifest.contributes.commands.map(({ command }) => command);

test("every command is registered, and every registered one is listed", () => {
  const registered = [...sources.matchAll(/^ {4}"(okoshi\.\w+)": \(\w*\) =>/gm)].map((match) => match[1]);
  assert.deepEqual([...registered].sort(), [...commands].sort());
});

test("both languages colour tokens by meaning alike", () => {
  const [xml, svg, ...more] = manifest.contributes.semanticTokenScopes;
  assert.deepEqual([xml?.language, svg?.language, more], ["xml", "svg", []]);
  assert.deepEqual(xml?.scopes, svg?.scopes);
});

test("the walkthrough's commands, pictures and pages are there", () => {
  for (const { steps } of manifest.contributes.walkthroughs) {
    for (const { description, media, completionEvents } of steps) {
      for (const [, command] of description.matchAll(/\(command:(okoshi\.\w+)\)/g)) assert.ok(commands.includes(command ?? ""), command);
      for (const event of completionEvents) {
        const [, kind, name] = /^(\w+):(.*)$/.exec(event) ?? [];
        if (kind === "onCommand" && name?.startsWith("okoshi.")) assert.ok(commands.includes(name), event);
        if (kind === "onContext") assert.ok(sources.includes(`set("${name?.replace("okoshi.", "")}"`), event);
      }
      const file = "markdown" in media ? media.markdown : media.image;
      assert.ok(file && existsSync(file), file);
    }
  }
});

test("no language is contributed, and only XML and its own panel activate the extension", () => {
  assert.ok(!("languages" in manifest.contributes));
  assert.deepEqual(manifest.activationEvents, ["onLanguage:xml", "onLanguage:svg", "onWebviewPanel:okoshi.preview"]);
});

test("keys are told for macOS too", () => {
  for (const { key, mac } of manifest.contributes.keybindings) assert.equal(mac, key.replaceAll("ctrl", "cmd"));
  const texts = ["README.md", "package.json", "walkthrough/install.md", "walkthrough/string.md", "../../docs/editors/vscode.md"];
  for (const file of texts) {
    for (const line of readFileSync(file, "utf8").split("\n")) {
      if (/\b(Ctrl|Alt)\+/.test(line)) assert.match(line, /[⌘⌃⌥]/, `${file}: ${line}`);
    }
  }
});

/** A snippet as inserted without changes. */
const insert = (body: readonly string[]) =>
  body
    .join("\n")
    .replace(/\$\{\d+\|([^,|]*)[^}]*\|\}/g, "$1")
    .replace(/\$\{\d+:([^}]*)\}/g, "$1")
    .replace(/(?<!\\)\$\d/g, "")
    .replaceAll("\\$", "$");

test("snippets have the prefix, and are few", () => {
  const all = Object.values(snippets);
  assert.ok(all.length <= 5);
  for (const { prefix, body } of all) {
    assert.match(prefix, /^okoshi-[a-z]+$/);
    assert.doesNotMatch(insert(body), /\$\{|\\/);
  }
});

test("snippets compile", { skip: process.env["OKOSHI"] ? false : "OKOSHI names no binary" }, () => {
  const { Part, Description, Legend, Defaults } = snippets;
  const drawing = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99">
    <rect x="30" y="30" width="20" height="40" fill="#d9534f"/><text x="40" y="50">Body</text>
    <rect x="0" y="1" width="20" height="9" fill="#5b7fb5"/>${insert(Part.body)}
    <g><rect x="60" y="60" width="20" height="9" fill="#f2c19c"/>${insert(Description.body).replace("Arm", "Leg")}</g>
    ${insert(Defaults.body)}
    <rect x="80" y="80" width="5" height="5" fill="#3d5a8c"/>
    ${insert(Legend.body).replaceAll('="0"', '="90"')}
  </svg>`;
  const { status, stdout, stderr } = spawnSync(process.env["OKOSHI"] ?? "", ["inspect", "--json", "-"], { input: drawing, encoding: "utf8" });
  assert.equal(status, 0, stdout + stderr);
  const parts = (JSON.parse(stdout) as { parts: { name: string; parent: string | null; kind: string }[] }).parts;
  for (const name of ["Arm", "Leg"]) assert.equal(parts.find((part) => part.name === name)?.parent, "Body", name);
  assert.ok(parts.some(({ kind }) => kind === "legend"), stdout);
});
