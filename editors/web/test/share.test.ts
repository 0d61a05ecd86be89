// Links that hold a drawing, and the page that plays a model, without a browser.

import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { isShared, linkTo, LONGEST, sharedIn } from "../src/app/share";
import { playerWith } from "../src/player/page";
import { source } from "./setup";

const PAGE = "https://example.org/lessons/okoshi/";
const bytes = (text: string): Uint8Array<ArrayBuffer> => new TextEncoder().encode(text);
const hashOf = (link: string): string => new URL(link).hash;
const packed = (text: string): string => deflateSync(text).toString("base64url");

test("every example fits into a link, and comes out of it as it was", async () => {
  const folder = join("..", "..", "examples");
  const names = readdirSync(folder).filter((name) => name.endsWith(".svg"));
  assert.ok(names.length > 10);
  for (const name of names) {
    const text = source(join(folder, name));
    const link = await linkTo(`${PAGE}#other.svg`, { name, bytes: bytes(text) });
    assert.ok(link.startsWith(`${PAGE}#name=`) && link.length < LONGEST, `${name}: ${link.length}`);
    assert.match(link, /^[\w:/.#&=%-]+$/, "nothing in it is cut off by programs that look for links");
    assert.ok(isShared(hashOf(link)));
    const shared = await sharedIn(hashOf(link));
    assert.deepEqual([shared.name, new TextDecoder().decode(shared.bytes)], [name, text]);
  }
});

test("a link that was cut off or changed on its way holds no drawing", async () => {
  const hash = hashOf(await linkTo(PAGE, { name: "a.svg", bytes: bytes("<svg>A drawing of a cat & a dog, 起こし</svg>") }));
  const start = hash.indexOf("&drawing=") + "&drawing=".length;
  for (let end = start; end < hash.length; end++) await assert.rejects(sharedIn(hash.slice(0, end)), `cut off at ${end}`);
  let changed = 0;
  for (let at = start; at < hash.length; at++) {
    const letter = hash[at] === "A" ? "B" : "A";
    // The last letters hold bits that are of no byte.
    const same = await sharedIn(hash.slice(0, at) + letter + hash.slice(at + 1)).then((shared) => new TextDecoder().decode(shared.bytes), () => null);
    if (same === null) changed++;
    else assert.equal(same, "<svg>A drawing of a cat & a dog, 起こし</svg>");
  }
  assert.ok(changed >= hash.length - start - 1);
});

test("what is no text, nothing, or much too large is refused before it is opened", async () => {
  for (const data of ["", "%%%", packed(""), packed(" \n"), deflateSync(Buffer.from([0xff, 0xfe])).toString("base64url"), packed("a".repeat(9 << 20))]) {
    await assert.rejects(sharedIn(`#name=a.svg&drawing=${data}`), data.slice(0, 20));
  }
  assert.ok(packed("a".repeat(9 << 20)).length < LONGEST, "a short link can hold much");
});

test("a name in a link is a name of a drawing, and of nothing else", async () => {
  for (const [written, name] of [["cat.svg", "cat.svg"], ["../../etc/cat.svg", "cat.svg"], ["a\\b.SVG", "b.svg"], ["", "drawing.svg"], [".svg", "drawing.svg"], ["ネコ", "ネコ.svg"], ["a\u202egvs.exe", "agvs.exe.svg"], ["x".repeat(300), `${"x".repeat(80)}.svg`]] as const) {
    assert.equal((await sharedIn(`#name=${encodeURIComponent(written)}&drawing=${packed("<svg/>")}`)).name, name);
  }
  for (const hash of ["", "#", "#name=a.svg", "#cat.svg", `#${encodeURIComponent("name=a&drawing=b")}`]) assert.ok(!isShared(hash), hash);
});

test("a name does not get out of where it stands in the page that plays a model", async () => {
  const name = "</script><script>alert(1)</script> $& & <b>";
  const page = await playerWith("<title>OKOSHI_TITLE</title><script>OKOSHI_SHOWN</script>", Uint8Array.of(103, 108, 84, 70), { name, clip: null, view: [30, 15] }).text();
  const [, title, json] = /^<title>(.*)<\/title><script>(.*)<\/script>$/.exec(page)!;
  assert.ok(!title!.includes("<") && !json!.includes("<"), page);
  assert.deepEqual(JSON.parse(json!), { name, clip: null, view: [30, 15], model: "Z2xURg==" });
});
