// Drives the editor in the browser like a user: with keys, and by what is visible.

/** The limit of every wait, in milliseconds, for machines that do other work too. */
const PATIENCE = 60_000;

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
      await this.page.waitForTimeout(100);
    }
  }

  press(keys) {
    return this.page.keyboard.press(keys);
  }

  type(text) {
    return this.page.keyboard.type(text, { delay: 15 });
  }

  /** Runs a command of the palette by its title. */
  async command(title) {
    await this.press("F1");
    const input = await this.see(".quick-input-widget input");
    await input.fill(`>${title}`);
    // The list is filtered a moment after typing.
    await this.page.waitForTimeout(1000);
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
    await this.page.waitForTimeout(150);
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
