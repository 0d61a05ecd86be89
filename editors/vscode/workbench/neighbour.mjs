// Tests that another extension for SVG files works as if it were alone where drawings have no strings, and beside this one where they do.

import assert from "node:assert/strict";
import { place } from "./steps.mjs";

export async function neighbours({ editor, page, step, again, at, saved, read, open, configure }) {
  const hover = () => editor.hover("The neighbour explains.");
  await step("another extension formats and explains drawings without strings", async () => {
    await open("plain.svg");
    configure({ "neighbour.on": true });
    await editor.caret(place(read("plain.svg"), "<rect", 2));
    assert.equal((await (await hover()).textContent()).trim(), "The neighbour explains.");
    await editor.press("Escape");
    await editor.until("the drawing to be formatted", async () => {
      // The editor learns of a formatter a moment after its extension has offered it.
      await editor.command("Format Document");
      const changed = page.locator(".tab.active.dirty").waitFor({ timeout: 3000 });
      if (await changed.then(() => true, () => false)) await editor.save();
      return read("plain.svg").endsWith("<!-- neat -->\n");
    });
    // Nobody asked which formatter is meant.
    assert.equal(await page.locator(".monaco-dialog-box, .quick-input-list .monaco-list-row:visible").count(), 0);
    assert.deepEqual(await editor.messages(), []);
  });
  await step("in an annotated drawing both formatters are offered, and both explain", async () => {
    await again();
    configure({ "neighbour.on": true });
    await at("Arm@Body", 1);
    const both = await hover();
    await editor.until("the part in the hover", async () => /Root › Body › Arm/.test(await page.locator(".monaco-hover-content").first().textContent()));
    assert.match(await both.textContent(), /The neighbour explains/);
    await editor.press("Escape");
    await editor.command("Format Document With...");
    await editor.see(".quick-input-list .monaco-list-row", "Neighbour");
    await (await editor.see(".quick-input-list .monaco-list-row", "Okoshi")).click();
    await saved("the blanks to go", (text) => text.includes("Leg@Body$Shape roundv -7 7") && !text.includes("neat"));
    configure({});
  });
}
