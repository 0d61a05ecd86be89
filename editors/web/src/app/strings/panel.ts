// The strings of the drawing beside its model. What is typed is a change of the drawing, like those of the forms; what is typed in one go
// is undone at once.

import { fill, h, inCode } from "../../dom";
import type { Editing } from "../../editing/editing";
import type { WorkerHost } from "../../host/worker";
import type { State } from "../../state";
import { readLines, readPlace, readProposals, sentences, type Line, type Place } from "./asking";
import { Editor } from "./editor";
import { described } from "./markdown";

/** A pause in typing after which the model follows, in milliseconds. */
const PAUSE = 250;

export class Strings {
  readonly element = h("section", { class: "strings-panel", attributes: { "aria-label": "Strings" } });
  private readonly notes = h("div", { class: "strings-notes", attributes: { role: "status", tabindex: 0, "aria-label": "About the string" } });
  private readonly words = h("p", { class: "pad muted" });
  private readonly editor: Editor;
  /** The texts as the drawing has them. */
  private lines: readonly Line[] = [];
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** What is asked and changed, one after the other. */
  private last: Promise<unknown> = Promise.resolve();
  /** What is typed with the same number is undone at once. */
  private typing = 0;
  private cursorLine = 0;
  private isShown = false;

  constructor(private readonly state: State, private readonly host: WorkerHost, private readonly editing: Editing) {
    this.editor = new Editor({
      // What was typed a moment ago is part of the drawing first: whoever points at a word does not point again because it took a while.
      place: async (line, at) => {
        await this.flush();
        return this.isClean(line) ? this.place(line, at) : null;
      },
      proposals: async (line, at, text) => {
        const start = this.lines[line]?.start;
        return start === undefined ? null : readProposals(await this.ask({ proposals: { start, at, text } }));
      },
      typed: () => this.typed(),
      moved: () => this.moved(),
      finished: () => this.finish(),
      undo: () => void this.flush().then(() => this.step(() => editing.undo())),
      redo: () => void this.flush().then(() => this.step(() => editing.redo())),
    });
    fill(this.element, h("h2", {}, "Strings"), this.words, this.editor.element, this.notes);
    state.on(["build", "current"], () => void this.refresh());
    state.on("selection", () => this.follow(!this.editor.hasFocus));
  }

  /** Shows or hides it: what is not seen asks nothing. */
  set shown(isShown: boolean) {
    if (this.isShown === isShown) return;
    this.isShown = isShown;
    if (isShown) void this.refresh();
  }

  focus(): void {
    this.editor.focus();
  }

  /** Makes what was typed a change of the drawing. */
  flush(): Promise<void> {
    clearTimeout(this.timer);
    return this.next(async () => {
      const { lines, editor } = this;
      for (let line = 0; line < Math.min(lines.length, editor.count); line++) {
        const text = editor.text(line);
        // A line that is empty for the moment is no string.
        if (this.isClean(line) || text.trim() === "") continue;
        const known = this.lines[line]!;
        const { start, text: was } = known;
        const made = await this.make({ change: "write", start, was, text, typing: this.typing });
        // The drawing is not what it was here: what is typed stays until it is read again.
        if (!made) break;
        // What is typed before the texts are read again differs from this, even if it is what was there before.
        this.lines = this.lines.map((each) => (each === known ? { ...known, text } : each));
        await this.read();
      }
    });
  }

  private next<T>(work: () => Promise<T>): Promise<T> {
    const next = this.last.then(work, work);
    this.last = next;
    return next;
  }

  private async make(change: unknown): Promise<boolean> {
    if (!this.editing.isOn) this.editing.toggle();
    return this.editing.apply(change);
  }

  /** Undoes or redoes something, which ends what is typed in one go. */
  private step(act: () => void): void {
    this.typing++;
    if (!this.editing.isOn) this.editing.toggle();
    act();
  }

  private isClean(line: number): boolean {
    return line < this.editor.count && this.lines[line]?.text === this.editor.text(line);
  }

  private async ask(question: unknown): Promise<unknown> {
    const drawing = this.state.current;
    const answer = drawing === null ? null : await this.host.ask({ drawing, ask: question }).catch(() => null);
    return answer?.ok === true ? answer.body : null;
  }

  private refresh(): Promise<void> {
    return this.isShown ? this.next(() => this.read()) : Promise.resolve();
  }

  /** Reads the texts of the drawing. What is being typed stays. */
  private async read(): Promise<void> {
    const body = await this.ask("texts");
    const isReadable = Array.isArray(body);
    const lines = readLines(body);
    const { editor } = this;
    const kept = lines.length === this.lines.length ? lines.map(({ text, start }, line) => (!this.isClean(line) && editor.count > line && this.lines[line]!.text !== "" && (start === this.lines[line]!.start || line === this.cursorLine) ? editor.text(line) : text)) : lines.map(({ text }) => text);
    this.words.textContent = !isReadable ? "The drawing cannot be read as it is: its problems are listed below the model." : lines.length === 0 ? "There are no strings yet. Turn on Edit, and choose a part to give it one." : "";
    this.words.hidden = this.words.textContent === "";
    editor.element.hidden = lines.length === 0;
    this.lines = lines;
    editor.show(kept);
    editor.mark(lines);
    // A part whose name is typed stays selected.
    const part = lines[editor.cursor.line]?.part ?? null;
    if (editor.hasFocus && part !== null && part !== this.state.selected) this.state.select(part);
    this.follow(!editor.hasFocus);
    await this.explain();
  }

  private typed(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.flush(), PAUSE);
  }

  private moved(): void {
    const { line } = this.editor.cursor;
    if (line !== this.cursorLine) this.finish();
    this.cursorLine = line;
    const part = this.lines[line]?.part ?? null;
    if (this.editor.hasFocus && part !== null && part !== this.state.selected) this.state.select(part);
    else this.follow(false);
    void this.explain();
  }

  /** What is typed from now on is undone by itself. */
  private finish(): void {
    void this.flush().then(() => this.typing++);
  }

  /** Marks the lines of the selected part. */
  private follow(goTo: boolean): void {
    const { selected } = this.state;
    const lines = this.lines.flatMap(({ part }, line) => (part !== null && part === selected && line < this.editor.count ? [line] : []));
    this.editor.select(new Set(lines), goTo);
    if (goTo && lines[0] !== undefined) this.cursorLine = lines[0];
    if (goTo) void this.explain();
  }

  private async place(line: number, at: number): Promise<Place | null> {
    const start = this.lines[line]?.start;
    const body = start === undefined ? null : await this.ask({ place: { start, at } });
    return body === null ? null : readPlace(body);
  }

  private explained = 0;

  /** Says below the editor what is wrong in the line of the cursor, what can be done, and what the word there means: what a mouse finds by hovering. */
  private async explain(): Promise<void> {
    const number = ++this.explained;
    const { line, at } = this.editor.cursor;
    const known = this.lines[line];
    const place = this.isShown && known && this.isClean(line) ? await this.place(line, at) : null;
    if (number !== this.explained) return;
    if (!known || !place || !this.isClean(line)) return fill(this.notes);
    const problems = known.problems.map(({ severity, message, help }) => h("p", { class: "strings-problem", attributes: { "data-severity": severity } }, ...inCode(sentences(message, help))));
    const act = (title: string): void => {
      this.typing++;
      void this.next(() => this.make({ change: "apply", start: known.start, was: known.text, at: place.byte, title }));
    };
    const actions = place.actions.map((title) => h("button", { class: "button choice", attributes: { type: "button" }, on: { click: () => act(title) } }, ...inCode(title)));
    fill(this.notes, ...problems, actions.length > 0 && h("div", { class: "choices" }, ...actions), place.hover && problems.length === 0 && described(place.hover.markdown));
  }
}
