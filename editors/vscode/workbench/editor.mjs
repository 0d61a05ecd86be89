// Drives the editor in the browser like a user: with keys, and by what is visible.

import assert from "node:assert/strict";

/** The limit of every wait, in milliseconds. It only ends a step that hangs: how fast something is, no step judges. */
export const PATIENCE = 180_000;

/** For how long something that must not happen is watched for, in milliseconds. */
const QUIET = 2500;

/** The pause between two looks, in milliseconds. */
const PAUSE = 100;

export class Editor {
  constructor(page) {
    this.page = page;
  }

  /** Waits for a selector, with the given text if any. Returns the locator. */
  async see(selector, text) {
    const found = this.page.locator(selector, text === undefined ? {} : { hasText: text }).first();
    await found.waitFor({ state: "visible", timeout: PATIENCE });
    return found;
  }

  /** Waits until something holds; otherwise fails with its last value. */
  async until(what, probe, patience = PATIENCE) {
    const end = Date.now() + patience;
    for (;;) {
      const value = await probe();
      if (value) return value;
      if (Date.now() > end) throw new Error(`waited in vain: ${what}`);
      await this.page.waitForTimeout(PAUSE);
    }
  }

  /** Waits until some looks in a row give the same text, for what has no visible end. Returns it. */
  async steady(what, probe, looks = 4) {
    let [last, equal] = [undefined, 0];
    await this.until(`${what} to be as it stays`, async () => {
      const value = await probe();
      equal = value === last ? equal + 1 : 1;
      last = value;
      return equal >= looks;
    });
    return last;
  }

  /** Whether something holds for a while: nothing tells that it will never change. */
  async holds(probe) {
    const end = Date.now() + QUIET;
    do {
      if (!(await probe())) return false;
      await this.page.waitForTimeout(PAUSE);
    } while (Date.now() < end);
    return true;
  }

  /** Fails if something does not hold for a while. */
  async stays(what, probe) {
    if (!(await this.holds(probe))) throw new Error(`it does not stay: ${what}`);
  }

  /** Waits until nothing visible has a selector. */
  gone(selector) {
    return this.page.locator(selector).first().waitFor({ state: "detached", timeout: PATIENCE });
  }

  /** Fails if messages other than so many are shown, also after a while. */
  said(count) {
    return this.stays(`${count} messages`, async () => (await this.messages()).length === count);
  }

  press(keys) {
    return this.page.keyboard.press(keys);
  }

  type(text) {
    return this.page.keyboard.type(text, { delay: 15 });
  }

  /** Gives the keyboard to the text: the panel may take it back a moment after its undo. */
  focusText() {
    return this.until("the text to have the keyboard", async () => {
      await this.press("Control+1");
      return this.page.evaluate(() => document.activeElement?.closest(".editor-instance .monaco-editor") !== null);
    });
  }

  /** All of the text, saved or not. */
  async text() {
    await this.focusText();
    await this.press("Control+a");
    await this.press("Control+c");
    return this.page.evaluate(() => navigator.clipboard.readText());
  }

  /** Waits until the text is as expected, and shows the difference if it never is. */
  async has(expected, what) {
    let seen;
    await this.until(what, async () => (seen = await this.text()) === expected, 30_000).catch(() => assert.equal(seen, expected, what));
  }

  /** Saves the text. */
  save() {
    return this.until("the text to be saved", async () => {
      if ((await this.page.locator(".tab.dirty").count()) === 0) return true;
      await this.press("Control+1");
      await this.press("Control+s");
      return false;
    });
  }

  /** Runs a command of the palette by its title. */
  async command(title) {
    await this.press("F1");
    const input = await this.see(".quick-input-widget input");
    await input.fill(`>${title}`);
    // The list is filtered a moment after typing.
    await this.see(".quick-input-list .monaco-list-row", title);
    await this.steady("the list of commands", async () => (await this.page.locator(".quick-input-list .monaco-list-row").allTextContents()).join("\n"));
    await this.see(".quick-input-list .monaco-list-row.focused", title);
    await this.press("Enter");
    await this.page.locator(".quick-input-widget").waitFor({ state: "hidden", timeout: PATIENCE }).catch(() => {});
  }

  /** Moves the cursor to a line and column, both from 1. */
  async caret({ line, column }) {
    await this.press("Control+g");
    const input = await this.see(".quick-input-widget input");
    await input.fill(`:${line}:${column}`);
    await this.press("Enter");
    await this.page.locator(".quick-input-widget").waitFor({ state: "hidden", timeout: PATIENCE });
    await this.see(".statusbar-item", new RegExp(`Ln ${line}, Col ${column}\\b`));
  }

  /** Opens the hover at the cursor, until it has a text. Returns its locator. */
  async hover(text) {
    const found = this.page.locator(".monaco-hover-content", { hasText: text }).first();
    await this.until(`a hover with ${text}`, async () => {
      await this.press("Escape");
      await this.press("Control+k");
      await this.press("Control+i");
      return found.waitFor({ state: "visible", timeout: 3000 }).then(() => true, () => false);
    });
    return found;
  }

  /** Waits for a proposal while something is typed; asks for it where the list was not opened or is closed. Returns its row. */
  async proposal(text) {
    const row = this.page.locator(".suggest-widget .monaco-list-row", { hasText: text }).first();
    await this.until(`a proposal ${text}`, async () => {
      if (await row.waitFor({ state: "visible", timeout: 3000 }).then(() => true, () => false)) return true;
      await this.press("Control+Space");
      return false;
    });
    return row;
  }

  /** The visible lines as text, including inlay hints without their padding. */
  async lines() {
    const lines = await this.page.locator(".editor-instance .view-lines .view-line").evaluateAll((all) =>
      all
        .map((line) => ({ top: line.getBoundingClientRect().top, text: line.textContent }))
        .sort((a, b) => a.top - b.top)
        .map(({ text }) => text.replaceAll("\u00a0", " ").replaceAll(/[\u200a-\u200d]/g, "")),
    );
    return lines;
  }

  /** The CSS colour of a word's first character, on the first visible line that contains `within`. */
  colour(word, within) {
    return this.page.evaluate(
      ([word, within]) => {
        for (const line of document.querySelectorAll(".editor-instance .view-lines .view-line")) {
          const text = line.textContent.replaceAll("\u00a0", " ");
          let at = text.indexOf(word);
          if (at < 0 || !text.includes(within)) continue;
          for (const span of line.querySelectorAll(":scope > span > span")) {
            if (at < span.textContent.length) return getComputedStyle(span).color;
            at -= span.textContent.length;
          }
        }
        return null;
      },
      [word, within],
    );
  }

  async save() {
    await this.press("Control+s");
    await this.page.locator(".tab.active.dirty").waitFor({ state: "detached", timeout: PATIENCE });
  }

  /** The notifications at the bottom right. */
  messages() {
    return this.page.locator(".notifications-toasts .notification-list-item-message").allTextContents();
  }
}
