// The buttons in the header that open, save and close drawings, and their keys.

import { FolderOpen, GraduationCap, Save, X } from "lucide";
import { button, fill, h, icon, isSave, leaveField } from "../dom";
import type { State } from "../state";
import { choose } from "./access";
import { reason, type Files } from "./files";
import type { Notices } from "./notices";

/** `settle` makes what is being typed elsewhere a change; `lessons` is the address of the page of lessons, if there is one. */
export class FileBar {
  readonly element = h("div", { class: "file-bar", attributes: { role: "group", "aria-label": "Files" } });
  private readonly save = button({ icon: Save, label: "Save", wide: true, press: () => void this.write() });
  private readonly close = button({ icon: X, label: "Close", wide: true, press: () => this.current !== null && void this.files.close(this.current) });

  constructor(private readonly files: Files, private readonly state: State, private readonly notices: Notices, private readonly settle: () => Promise<void>, lessons: string | null) {
    const open = button({ icon: FolderOpen, label: "Open…", wide: true, press: () => void this.open() });
    open.title = "Open drawings, and what they link to (Ctrl+O)";
    open.setAttribute("aria-keyshortcuts", "Control+O");
    this.save.setAttribute("aria-keyshortcuts", "Control+S");
    const learn = lessons !== null && h("a", { class: "button wide", title: "Lessons, in pictures", attributes: { href: lessons } }, icon(GraduationCap), h("span", {}, "Lessons"));
    fill(this.element, open, this.save, this.close, learn);
    state.on(["current", "drawings"], () => this.draw());
    files.onChange(() => this.draw());
    addEventListener("keydown", (event) => this.press(event));
    this.draw();
  }

  private get current(): string | null {
    return this.state.current;
  }

  private draw(): void {
    const { current } = this;
    const kept = this.files.get(current);
    this.save.hidden = this.close.hidden = kept === undefined;
    this.save.dataset["changed"] = String(kept?.changed === true);
    const words = kept?.changed ? `Save ${current}, which has changes that are in no file` : `Save ${current ?? ""}`;
    this.save.title = `${words} (Ctrl+S)`;
    this.save.setAttribute("aria-description", kept?.changed ? "has changes that are in no file" : "");
    this.close.title = `Close ${current ?? ""}`;
  }

  private press(event: KeyboardEvent): void {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.shiftKey || document.querySelector("dialog[open]")) return;
    if (isSave(event)) void this.write();
    else if (event.key.toLowerCase() === "o") void this.open();
    else return;
    // The browser would save or open a page.
    event.preventDefault();
  }

  private async open(): Promise<void> {
    try {
      this.files.open(await choose());
    } catch (error) {
      this.notices.say("opened", `The file could not be opened: ${reason(error)}.`);
    }
  }

  private async write(): Promise<void> {
    const { current } = this;
    if (current === null || !this.files.get(current)) return;
    await leaveField();
    await this.settle();
    await this.files.save(current);
  }
}
