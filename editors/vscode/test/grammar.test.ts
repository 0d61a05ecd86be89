// The package's grammars in VS Code's own engine, injected into VS Code's XML grammar.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { createOnigScanner, createOnigString, loadWASM } from "vscode-oniguruma";
import * as textmate from "vscode-textmate";
import manifest from "../package.json";
import { drawings } from "./paths";

const find = createRequire(`${process.cwd()}/package.json`).resolve;
const read = (path: string) => readFileSync(path, "utf8");

/** Registries of the grammars, with the injections into the scopes of the manifest, or without any. */
function registry(injected: boolean): textmate.Registry {
  const contributed = new Map(manifest.contributes.grammars.map((one) => [one.scopeName, one]));
  return new textmate.Registry({
    onigLib,
    loadGrammar: async (scope) => {
      const own = contributed.get(scope);
      if (own) return textmate.parseRawGrammar(read(own.path), own.path);
      const xml = find("tm-grammars/grammars/xml.json");
      if (scope === "text.xml") return textmate.parseRawGrammar(read(xml), xml);
      // SVG extensions have their own scope for XML.
      if (scope === "text.xml.svg") return { ...JSON.parse(read(xml)), scopeName: scope };
      return null;
    },
    getInjections: (scope) =>
      injected
        ? [...contributed.values()].filter((one) => "injectTo" in one && one.injectTo?.includes(scope)).map((one) => one.scopeName)
        : [],
  });
}

const onigLib = loadWASM(readFileSync(find("vscode-oniguruma/release/onig.wasm")).buffer).then(() => ({ createOnigScanner, createOnigString }));

interface Token {
  readonly text: string;
  readonly scopes: string[];
}

async function tokenise(text: string, scope = "text.xml", injected = true): Promise<Token[][]> {
  const grammar = await registry(injected).loadGrammar(scope);
  assert.ok(grammar, scope);
  let state = textmate.INITIAL;
  return text.split("\n").map((line) => {
    const { tokens, ruleStack, stoppedEarly } = grammar.tokenizeLine(line, state);
    assert.ok(!stoppedEarly);
    state = ruleStack;
    return tokens.map(({ startIndex, endIndex, scopes }) => ({ text: line.slice(startIndex, endIndex), scopes }));
  });
}

/** The innermost scope of the first token `text` in one line of a drawing. */
async function scopeOf(line: string, text: string, scope?: string): Promise<string | undefined> {
  const found = (await tokenise(line, scope)).flat().find((token) => token.text.trim() === text);
  assert.ok(found, `${text} is a token of ${line}`);
  return found.scopes.at(-1);
}

const inString = ({ scopes }: Token) => scopes.includes("meta.embedded.okoshi");

for (const scope of ["text.xml", "text.xml.svg"]) {
  test(`strings are coloured in ${scope}`, async () => {
    const line = '<tspan x="1">Rarm@"U body"$Shape -s roundv -90 (w * max(1, 2)) Color #ff8800 Texture "a.png"</tspan>';
    const expected: Record<string, string | RegExp> = {
      Rarm: "entity.name.type.part.okoshi",
      "@": "keyword.operator.parent.okoshi",
      '"U body"': "entity.other.inherited-class.parent.okoshi",
      $: "keyword.operator.sign.okoshi",
      Shape: "keyword.control.okoshi",
      "-s": "storage.modifier.flag.okoshi",
      roundv: /^(support\.constant|constant\.language)\..*okoshi$/,
      "-90": "constant.numeric.okoshi",
      w: "variable.other.okoshi",
      "*": "keyword.operator.arithmetic.okoshi",
      max: "support.function.okoshi",
      Color: "keyword.control.okoshi",
      "#ff8800": /^constant\.other\.color\..*okoshi$/,
      "a.png": "string.quoted.double.okoshi",
    };
    for (const [text, innermost] of Object.entries(expected)) {
      const found = await scopeOf(line, text, scope);
      if (typeof innermost === "string") assert.equal(found, innermost, text);
      else assert.match(found ?? "", innermost, text);
    }
  });
}

test("strings without names are coloured", async () => {
  assert.equal(await scopeOf("<text>$Shape roundv</text>", "$"), "keyword.operator.sign.okoshi");
  assert.equal(await scopeOf("<text>$Shape roundv</text>", "Shape"), "keyword.control.okoshi");
  assert.equal(await scopeOf("<text>%Let w 12</text>", "Let"), "keyword.control.okoshi");
  assert.equal(await scopeOf("<desc>@Body$Shape</desc>", "Body"), "entity.other.inherited-class.parent.okoshi");
});

test("full-width signs are signs", async () => {
  assert.equal(await scopeOf("<text>右腕＠胴＄Shape roundv</text>", "右腕"), "entity.name.type.part.okoshi");
  assert.equal(await scopeOf("<text>右腕＠胴＄Shape roundv</text>", "胴"), "entity.other.inherited-class.parent.okoshi");
});

test("notes and unused parts are grey", async () => {
  assert.match((await scopeOf("<text># a note</text>", "# a note")) ?? "", /^comment\./);
  assert.match((await scopeOf("<text>* spare</text>", "* spare")) ?? "", /^comment\./);
});

test("entities in strings stay entities", async () => {
  const line = "<text>Arm@Body$Texture &quot;a&amp;b.png&quot;</text>";
  const entities = (await tokenise(line)).flat().filter(({ scopes }) => scopes.includes("constant.character.entity.xml"));
  assert.equal(entities.map(({ text }) => text).join(""), "&quot;&amp;&quot;");
  assert.ok(entities.every(inString));
});

test("a string ends at the next tag, whatever is open in it", async () => {
  for (const open of ["(1 +", "Texture \"a", "# note", "* spare"]) {
    const lines = await tokenise(`<text>Arm@Body$Shape ${open}<tspan>2</tspan></text>\n<path d="M 1 2"/>`);
    const tags = lines.flat().filter(({ text }) => ["tspan", "text", "path", "d"].includes(text));
    assert.equal(tags.length, 6);
    for (const { text, scopes } of tags) assert.equal(scopes[1], "meta.tag.xml", text);
  }
});

test("texts without strings, tags and comments keep their colours", async () => {
  const text = [
    "<!-- <text>Arm@Body$Shape roundv</text> -->",
    "<!--",
    ">Arm@Body$Shape roundv<",
    "-->",
    `<path inkscape:label="a>Arm@Body$Shape" d="M 0,0 L 3,4"/>`,
    "<text>just a text</text>",
    "<style><![CDATA[g>$a, b>c@d { fill: red }]]></style>",
    "<title>Drawing 3</title>",
  ].join("\n");
  assert.deepEqual(await tokenise(text), await tokenise(text, "text.xml", false));
});

test("in all examples and cases colours change only inside texts", async () => {
  let strings = 0;
  for (const drawing of [...drawings("examples"), ...drawings("tests/cases")]) {
    // Long lines are path data, on which the engine is slow; tags occur in all others.
    const text = read(drawing).split("\n").map((line) => line.slice(0, 2000)).join("\n");
    const plain = await tokenise(text, "text.xml", false);
    const coloured = await tokenise(text);
    for (const [at, line] of coloured.entries()) {
      const place = `${drawing}:${at + 1}`;
      const outside = line.filter((token) => !inString(token));
      strings += line.length > outside.length ? 1 : 0;
      for (const token of line.filter(inString)) {
        assert.ok(!token.scopes.some((scope) => scope.startsWith("comment.block.xml")), place);
      }
      // Text outside of strings has the same scopes as without the extension.
      const before = plain[at]?.flatMap(({ text, scopes }) => [...text].map((character) => `${character} ${scopes.join(" ")}`)) ?? [];
      let column = 0;
      for (const token of line) {
        const length = [...token.text].length;
        if (!inString(token)) {
          const now = [...token.text].map((character) => `${character} ${token.scopes.join(" ")}`);
          assert.deepEqual(now, before.slice(column, column + length), place);
        }
        column += length;
      }
    }
  }
  assert.ok(strings > 500, `${strings} lines with strings`);
});
