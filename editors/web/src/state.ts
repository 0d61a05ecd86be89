// What the page knows, and who wants to hear of what.

import type { Link } from "./host/host";
import { Parts } from "./parts";
import type { Build, FromHost, Listed } from "./protocol";

export interface Drawing extends Listed {
  readonly build: Build | null;
  readonly parts: Parts;
  /** Its file is not there at present. */
  readonly gone: boolean;
  /** The connection that its build came through: addresses of models and pictures hold within one. */
  readonly connection: number;
}

/**
 * drawings: the list changed · build: something of the named drawing did · current: another drawing, or none, is shown ·
 * selection, hover: another part is · light: the editor's cursor moved to another part · link: the connection is another
 */
export type Topic = "drawings" | "build" | "current" | "selection" | "hover" | "light" | "link";

const NO_PARTS = new Parts([]);

export class State {
  private readonly drawings = new Map<string, Drawing>();
  private readonly listeners = new Map<Topic, ((drawing: string) => void)[]>();
  /** The drawing that is shown; null shows the gallery. */
  current: string | null = null;
  /** Names of parts of the current drawing. They need not be there: they stay while someone is typing a name. */
  selected: string | null = null;
  hovered: string | null = null;
  lit: string | null = null;
  link: Link = "connecting";
  /** Why the connection is as it is, in the host's words; empty if it has none. */
  linkNote = "";
  /** Counts connections. A host may send what the next one has to say before it calls that open. */
  connection = 0;
  /** Whether the host has said which drawings there are. */
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
          this.drawings.set(listed.id, { build: null, parts: NO_PARTS, gone: false, connection: 0, ...before, ...listed });
        }
        this.known = true;
        return this.tell("drawings");
      }
      case "build":
        return this.change(message.drawing, { build: message.build, parts: new Parts(message.build.parts), gone: false, connection: this.connection });
      case "gone":
        return this.change(message.drawing, { gone: true });
      case "light":
        if (message.drawing !== this.current || message.part === this.lit) return;
        this.lit = message.part;
        return this.tell("light");
    }
  }

  setLink(link: Link, note = ""): void {
    if (link === this.link && note === this.linkNote) return;
    if (this.link === "open" && link !== "open") this.connection++;
    this.link = link;
    this.linkNote = note;
    this.tell("link");
  }

  show(id: string | null): void {
    if (id === this.current) return;
    this.current = id;
    this.selected = this.hovered = this.lit = null;
    this.tell("current");
  }

  select(name: string | null): void {
    if (name === this.selected) return;
    this.selected = name;
    this.tell("selection");
  }

  hover(name: string | null): void {
    if (name === this.hovered) return;
    this.hovered = name;
    this.tell("hover");
  }

  private change(id: string, change: Partial<Drawing>): void {
    const drawing = this.drawings.get(id);
    if (!drawing) return;
    this.drawings.set(id, { ...drawing, ...change });
    this.tell("build", id);
  }

  private tell(topic: Topic, drawing = this.current ?? ""): void {
    for (const listener of this.listeners.get(topic) ?? []) listener(drawing);
  }
}
