// Light on landscapes in three.js with shadows: no lit top is black or striped.

import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { build as bundle } from "esbuild";
import type { Browser } from "playwright-core";
import { launch, open } from "./browser";
import { closeAll, closing, TEST_LIMIT } from "./closing";
import type { Tops } from "./light-page";
import { build, example, skip } from "./setup";

/** How far the mean brightness of tops may be from a box's, relatively. */
const NEAR = 0.1;
/** Tops that have less than this of the box's brightness are dark. At most this share may be, and one at the border of a shadow. */
const DARK = 0.5;
const MOST_DARK = 0.005;
/** Materials that are seen in fewer pixels are not judged. */
const FEWEST = 15;

const landscapes = ["island", ...readdirSync(example("terrain").replace(/\.svg$/, "")).filter((name) => name.endsWith(".svg")).map((name) => join("terrain", name.slice(0, -4)))];

let browser: Promise<Browser> | undefined;
after(() => closeAll([async () => (await browser)?.close()]));

test("lit tops of landscapes are as bright as a box of their material", { skip, timeout: TEST_LIMIT }, async (t) => {
  const { outputFiles } = await bundle({ entryPoints: [join("test", "light-page.ts")], bundle: true, write: false, format: "iife", target: "es2022", logLevel: "warning" });
  browser ??= launch();
  const { page, wrong } = await open(await browser, "about:blank", closing(t));
  await page.addScriptTag({ content: outputFiles[0]!.text });
  const mean = (values: readonly number[]): number => values.reduce((sum, value) => sum + value, 0) / values.length;
  let judged = 0;
  for (const name of landscapes) {
    const model = build(example(name)).model;
    assert.ok(model, name);
    const found: Tops[] = await page.evaluate((glb) => window.tops(glb), model.toString("base64"));
    for (const { name: material, tops, box } of found) {
      if (tops.length < FEWEST || box.length === 0) continue;
      const expected = mean(box);
      const ratio = mean(tops) / expected;
      const dark = tops.filter((value) => value < DARK * expected).length;
      t.diagnostic(`${name}: ${material}: ${tops.length} pixels, ${ratio.toFixed(3)} of a box, ${dark} dark`);
      assert.ok(expected > 0.01, `${name}: the box of ${material} is black`);
      assert.ok(Math.abs(ratio - 1) < NEAR && dark <= 1 + MOST_DARK * tops.length, `${name}: lit tops of ${material} have ${ratio.toFixed(2)} of a box's brightness, and ${dark} of ${tops.length} pixels are dark`);
      judged++;
    }
  }
  // Most landscapes have two materials or more without a texture.
  assert.ok(judged > landscapes.length, `only ${judged} materials were judged`);
  assert.deepEqual(wrong, []);
});
