// The state of the page, and its listeners.

import type { Link } from "./host/host";
import { Parts } from "./parts";
import type { Build, FromHost, Listed, Offer } from "./protocol";

export interface Steps {
  readonly undo: string | null;
  readonly redo: string | null;
}

const NO_STEPS: Steps = { undo: null, redo: null };

export interface Drawing extends Listed {
  readonly build: Build | null;
  readonly parts: Parts;
  /** Its file is missing at the moment. */
  readonly gone: boolean;
  /** What can be undone and redone, in words. */
  readonly steps: Steps;
  /** The connection that its build came from: addresses of models and pictures hold within one. */
  readonly connection: number;
}

/**
 * drawings: the list changed · build: that of the named drawing changed · current: another drawing, or none, is shown ·
 * starters: others are offered, or one was not begun · selection, hover: of another part · light: the editor's cursor moved to another part · hidden: parts were hidden or shown ·
 * link: the connection changed · editing: the drawing may be changed from now on · steps: others can be undone or redone
 */
export type Topic = "editing" | "steps" | "drawings" | "starters" | "build" | "current" | "selection" | "hover" | "light" | "hidden" | "link";

const NO_PARTS = new Parts([]);

export class State {
  private readonly drawings = new Map<string, Drawing>();
  private readonly listeners = new Map<Topic, ((drawing: string) => void)[]>();
  /** The drawing that is shown; null shows the gallery. */
  current: string | null = null;
  /** Names of parts of the current drawing. They may not exist: they are kept while a name is being typed. */
  selected: string | null = null;
  hovered: string | null = null;
  lit: string | null = null;
  /** The parts that are not shown. What hangs on a part is hidden with it, but may be shown alone. */
  hidden: ReadonlySet<string> = new Set();
  link: Link = "connecting";
  /** Details about the connection from the host; may be empty. */
  linkNote = "";
  /** Counts connections. A host may send messages of the next connection before it reports that as open. */
  connection = 0;
  /** What the host offers while there are no drawings. */
  offer: Offer | null = null;
  /** Why the drawing that was chosen was not begun; empty if nothing is wrong. */
  refusal = "";
  /** The host's key for changes; null if it takes none. */
  key: string | null = null;
  /** Whether changes are made in a copy of the drawing, which is open in another program. */
  isCopy = false;
  /** Gets the next part that is picked, in place of the selection. */
  picker: ((part: string) => void) | null = null;
  /** Whether the host has sent its list of drawings. */
  known = false;

  on(topics: Topic | readonly Topic[], listener: (drawing: string) => void): void {
    for (const topic of typeof topics === "string" ? [topics] : topics) {
      const all = this.listeners.get(topic);
      if (all) all.push(listener);
      else this.listeners.set(topic, [listener]);
    }
  }

  get list(): readonly Drawing[] {
    return [...this.drawings.values()];
  }

  get drawing(): Drawing | undefined {
    return this.current === null ? undefined : this.drawings.get(this.current);
  }

  get steps(): Steps {
    return this.drawing?.steps ?? NO_STEPS;
  }

  get parts(): Parts {
    return this.drawing?.parts ?? NO_PARTS;
  }

  find(id: string): Drawing | undefined {
    return this.drawings.get(id) ?? this.list.find(({ name }) => name === id);
  }

  receive(message: FromHost): void {
    switch (message.type) {
      case "drawings": {
        const old = new Map(this.drawings);
        this.drawings.clear();
        for (const listed of message.drawings) {
          const before = old.get(listed.id);
          this.drawings.set(listed.id, { build: null, parts: NO_PARTS, gone: false, steps: NO_STEPS, connection: 0, ...before, ...listed });
        }
        this.known = true;
        return this.notify("drawings");
      }
      case "build":
        return this.change(message.drawing, { build: message.build, parts: this.partsOf(message.drawing, message.build), gone: false, connection: this.connection });
      case "starters":
        this.offer = message;
        this.refusal = "";
        return this.notify("starters");
      case "unbegun":
        this.refusal = message.why;
        return this.notify("starters");
      case "editing":
        this.key = message.key;
        this.isCopy = message.copy;
        return this.notify("editing");
      case "steps": {
        const drawing = this.drawings.get(message.drawing);
        if (drawing) this.drawings.set(message.drawing, { ...drawing, steps: { undo: message.undo, redo: message.redo } });
        return this.notify("steps", message.drawing);
      }
      case "gone":
        return this.change(message.drawing, { gone: true });
      case "light":
        if (message.drawing !== this.current || message.part === this.lit) return;
        this.lit = message.part;
        return this.notify("light");
    }
  }

  setLink(link: Link, note = ""): void {
    if (link === this.link && note === this.linkNote) return;
    if (this.link === "open" && link !== "open") {
      this.connection++;
      // The next program has a key and steps of its own.
      this.key = null;
      for (const [id, drawing] of this.drawings) this.drawings.set(id, { ...drawing, steps: NO_STEPS });
    }
    this.link = link;
    this.linkNote = note;
    this.notify("link");
  }

  show(id: string | null): void {
    if (id === this.current) return;
    this.current = id;
    this.selected = this.hovered = this.lit = null;
    this.hidden = new Set();
    this.notify("current");
  }

  select(name: string | null): void {
    if (this.picker !== null && name !== null) return this.picker(name);
    if (name === this.selected) return;
    this.selected = name;
    this.notify("selection");
  }

  hover(name: string | null): void {
    if (name === this.hovered) return;
    this.hovered = name;
    this.notify("hover");
  }

  /** Whether a part is hidden; a shape that belongs to a part is hidden with it. */
  isHidden(name: string): boolean {
    return this.hidden.size > 0 && this.hidden.has(this.parts.carrier(name)?.name ?? name);
  }

  /** Hides or shows a part and everything that hangs on it. */
  setHidden(name: string, isHidden: boolean): void {
    const hidden = new Set(this.hidden);
    for (const one of this.parts.family(this.parts.carrier(name)?.name ?? name)) {
      if (isHidden) hidden.add(one);
      else hidden.delete(one);
    }
    this.hide(hidden);
  }

  /** Shows a part and what hangs on it, and nothing else. */
  isolate(name: string): void {
    const shown = this.parts.family(this.parts.carrier(name)?.name ?? name);
    this.hide(new Set(this.parts.all.flatMap(({ name }) => (shown.has(name) ? [] : [name]))));
  }

  showAll(): void {
    this.hide(new Set());
  }

  private hide(hidden: ReadonlySet<string>): void {
    this.hidden = hidden;
    this.notify("hidden");
  }

  /** The parts of a build. Of a drawing that cannot be read at present, those of the last good model stay with it. */
  private partsOf(drawing: string, { parts, stale, model }: Build): Parts {
    const before = this.drawings.get(drawing)?.parts;
    return before && stale && model !== null && parts.length === 0 ? before : new Parts(parts);
  }

  private change(id: string, change: Partial<Drawing>): void {
    const drawing = this.drawings.get(id);
    if (!drawing) return;
    this.drawings.set(id, { ...drawing, ...change });
    this.notify("build", id);
  }

  private notify(topic: Topic, drawing = this.current ?? ""): void {
    for (const listener of this.listeners.get(topic) ?? []) listener(drawing);
  }
}
