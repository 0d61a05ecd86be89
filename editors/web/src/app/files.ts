// The files that a person has: opened, begun, changed, kept by the browser, and written.

import { download } from "../host/download";
import type { Fault, WorkerHost } from "../host/worker";
import type { ProjectFile } from "../host/worker/calls";
import type { State } from "../state";
import { chooseTarget, canSaveAs, mayRead, mayWrite, read, write, type Opened } from "./access";
import { isPicture, kindOf } from "./kinds";
import { ask, listed, type Notices } from "./notices";
import type { Kept, Store } from "./store";

/** How often files are looked at, in milliseconds. */
const PAUSE = 1000;
/** Of so many files that are no drawings is said what they are. */
const MOST_WORDS = 3;

export class Files {
  private readonly all = new Map<string, Kept>();
  private readonly listeners: (() => void)[] = [];
  private store: Store | null = null;
  /** The drawing to show as soon as it is listed. */
  private wanted: string | null = null;
  /** The times of modification of files with other contents than what is here, of which a person was told. */
  private readonly disputed = new Map<string, number>();
  private order = 0;
  /** Whether the browser had no space for a file. */
  private unkept = false;

  constructor(private readonly host: WorkerHost, private readonly state: State, private readonly notices: Notices, private readonly place: HTMLElement) {
    state.on("drawings", () => this.goTo());
    addEventListener("beforeunload", (event) => {
      if (this.isLosing) event.preventDefault();
    });
  }

  /** Whether changes are lost when the page is left: they are in no file, and the browser does not keep them. */
  private get isLosing(): boolean {
    return (this.unkept || this.store?.trouble !== "") && [...this.all.values()].some(({ changed }) => changed);
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  get(path: string | null): Kept | undefined {
    return path === null ? undefined : this.all.get(path);
  }

  /** Brings back what the browser has kept, and begins; `isAwaited`: another drawing is on its way. */
  restore(store: Store, isAwaited: boolean): void {
    this.store = store;
    if (store.trouble !== "") this.notices.say("store", store.trouble);
    // What was opened meanwhile is newer.
    const early = [...this.all.values()];
    this.all.clear();
    for (const one of store.kept) this.bringBack(one);
    for (const one of early) {
      const path = kindOf(one.path) === "drawing" ? this.free(one) : one.path;
      if (this.wanted === one.path) this.wanted = path;
      this.take({ ...one, path, order: this.order++ });
    }
    this.host.begin(isAwaited);
    setInterval(() => void this.look(), PAUSE);
    this.notify();
    void store.later?.then((store) => this.join(store));
  }

  /** Goes on with what the browser keeps, now that no other page has it. What is open here keeps its names. */
  private join(store: Store): void {
    this.store = store;
    if (store.trouble !== "") this.notices.say("store", store.trouble);
    else this.notices.take("store");
    const mine = [...this.all.values()];
    for (const one of store.kept) {
      const other = this.all.get(one.path);
      if (!other) this.bringBack(one);
      else if (one.changed && kindOf(one.path) === "drawing" && !same(other.bytes, one.bytes)) this.take({ ...one, path: numbered(one.path, (path) => this.all.has(path)), order: this.order++ });
    }
    for (const one of mine) this.keep(one);
    this.notify();
  }

  private bringBack(kept: Kept): void {
    this.all.set(kept.path, kept);
    this.host.put(kept.path, kept.bytes);
    this.order = Math.max(this.order, kept.order + 1);
  }

  open(opened: readonly Opened[]): void {
    const drawings: string[] = [];
    const linked: string[] = [];
    const words: string[] = [];
    const packed: { readonly from: string; readonly to: string }[] = [];
    // Compressed drawings last: a plain one of the same name keeps it.
    for (const { path: name, bytes, handle, seen, packedAs, trouble } of [...opened].sort((a, b) => Number(a.packedAs !== undefined) - Number(b.packedAs !== undefined))) {
      const kind = kindOf(name);
      const why = typeof kind === "object" ? kind.why : trouble;
      if (why !== undefined) {
        words.push(why);
        continue;
      }
      // What was compressed is not the plain file of the same name that is open.
      const isOther = (path: string): boolean => packedAs !== undefined && this.all.get(path)?.handle != null;
      const path = kind === "drawing" ? numbered(name, (path) => drawings.includes(path) || isOther(path) || this.isLost(path, bytes)) : name;
      (kind === "drawing" ? drawings : linked).push(path);
      if (packedAs !== undefined) packed.push({ from: packedAs, to: path });
      this.take({ path, bytes, handle, seen, order: this.all.get(path)?.order ?? this.order++, changed: false });
    }
    const [first] = packed;
    if (first && packed.length === 1) words.unshift(`${first.from} was compressed, and is open as plain SVG: Save writes ${first.to}.`);
    else if (first) words.unshift(`${listed(packed.map(({ from }) => from))} were compressed, and are open as plain SVG.`);
    const picture = drawings.length === 0 && linked.length === 1 ? linked.find(isPicture) : undefined;
    if (picture !== undefined) {
      words.push(`${picture}: kept for drawings that link to it. Is it a drawing itself, or a photograph of one?`);
    } else if (drawings.length === 0 && linked.length > 0 && !this.hasDrawings) {
      words.push(`${linked.join(", ")}: kept for drawings that link to it. Open the drawing, too, a file that ends in .svg.`);
    }
    const more = words.length - MOST_WORDS;
    if (words.length > 0) this.notices.say("opened", [...words.slice(0, MOST_WORDS), ...(more > 0 ? [`So are ${more} more.`] : [])].join(" "), picture === undefined ? [] : [{ label: "Make a drawing of it", press: () => void this.trace(picture) }]);
    else this.notices.take("opened");
    this.wanted = drawings[0] ?? this.wanted;
    this.goTo();
  }

  /** Makes a drawing of a picture, and opens it. */
  private async trace(path: string): Promise<void> {
    const picture = this.all.get(path);
    if (!picture) return;
    this.notices.say("opened", `Looking for shapes in ${path}…`);
    try {
      const { ok, body } = await this.host.trace(picture.bytes);
      if (!ok) return this.notices.say("opened", `${path} ${String(body)}.`);
      this.notices.take("opened");
      this.shared({ name: path.replace(/\.[^.]*$/, ".svg"), bytes: new TextEncoder().encode(String(body)) });
    } catch (error) {
      this.notices.say("opened", `${path}: no drawing could be made of it: ${reason(error)}.`);
    }
  }

  /** Opens the drawing of a link, beside all others. */
  shared({ name, bytes }: { readonly name: string; readonly bytes: Uint8Array<ArrayBuffer> }): void {
    const isOther = (path: string): boolean => this.all.has(path) && !same(this.all.get(path)!.bytes, bytes);
    const path = numbered(name, isOther);
    if (!this.all.has(path)) this.take({ path, bytes, order: this.order++, changed: false, handle: null, seen: 0 });
    this.wanted = path;
    this.goTo();
  }

  /** Takes the text that changes on the page made, or with which a drawing was begun. */
  text(path: string, text: string): void {
    const before = this.all.get(path);
    const bytes = new TextEncoder().encode(text);
    if (before) this.keep({ ...before, bytes, changed: true });
    else this.keep({ path, bytes, order: this.order++, changed: false, handle: null, seen: 0 });
  }

  /** Writes a drawing with all changes: into the file that it was opened from, into one that a person chooses, or as a download. */
  async save(path: string): Promise<boolean> {
    const name = path.replace(/^.*\//, "");
    try {
      let handle = this.all.get(path)?.handle ?? null;
      const isKnown = handle !== null;
      // First what a browser only lets a page do right after a click.
      if (handle && !(await mayWrite(handle))) return false;
      if (!handle && canSaveAs) {
        handle = await chooseTarget(name);
        if (!handle) return false;
      }
      await this.host.settled(path);
      const kept = this.all.get(path);
      if (!kept) return false;
      if (!handle) {
        await download(name, new Blob([kept.bytes], { type: "image/svg+xml" }));
        this.keep({ ...kept, changed: false });
        return true;
      }
      const file = isKnown ? await handle.getFile().catch(() => null) : null;
      if (file && file.lastModified !== kept.seen && !same((await read(file, path, handle)).bytes, kept.bytes)) {
        this.dispute(path, file.lastModified);
        return false;
      }
      const seen = await write(handle, kept.bytes);
      // What was changed while it was written is not in the file.
      const now = this.all.get(path);
      if (now) this.keep({ ...now, handle, seen, changed: now.bytes !== kept.bytes });
      this.notices.take(`file ${path}`);
      return true;
    } catch (error) {
      this.notices.say(`file ${path}`, `${name} could not be written: ${reason(error)}.`, [{ label: "Save a copy", press: () => this.copy(path) }]);
      return false;
    }
  }

  async close(path: string): Promise<void> {
    if (this.all.get(path)?.changed) {
      const answer = await ask(this.place, `${path} has changes that are in no file.`, [
        ["save", "Save and close"],
        ["close", "Close without saving"],
        ["keep", "Keep it open"],
      ]);
      if (answer === "save" ? !(await this.save(path)) : answer !== "close") return;
    }
    this.forget(path);
    // What only drawings need goes with the last of them.
    if (!this.hasDrawings) for (const one of [...this.all.keys()]) this.forget(one);
    this.notify();
  }

  /** Says that the module stopped, and what can be done about a file that it cannot read. */
  fault({ words, path, again }: Fault): void {
    const kept = this.get(path);
    const actions = again ? [{ label: "Start it again", press: again }] : [];
    if (kept) {
      // What is shown from now on is not what is in the file, which is not read again before it changes.
      this.disputed.set(kept.path, kept.seen);
      this.all.set(kept.path, { ...kept, seen: 0, changed: true });
      actions.push({ label: "Save a copy of the file", press: () => this.copy(kept.path, kept.bytes) }, { label: "Close the file", press: () => this.forget(kept.path) });
    }
    this.notices.say("fault", words, actions);
  }

  private get hasDrawings(): boolean {
    return [...this.all.keys()].some((path) => kindOf(path) === "drawing");
  }

  /** The path of a drawing that is opened: another one if that of an open drawing would be lost. */
  private free({ path, bytes }: ProjectFile): string {
    return numbered(path, (path) => this.isLost(path, bytes));
  }

  /** Whether changes would be lost if a file took the place of an open one. */
  private isLost(path: string, bytes: Uint8Array): boolean {
    const open = this.all.get(path);
    return open?.changed === true && !same(open.bytes, bytes);
  }

  /** Shows the drawing that was opened. */
  private goTo(): void {
    const drawing = this.wanted === null ? undefined : this.state.find(this.wanted);
    if (!drawing) return;
    this.wanted = null;
    location.hash = encodeURIComponent(drawing.id);
    this.state.show(drawing.id);
  }

  private take(kept: Kept): void {
    this.disputed.delete(kept.path);
    this.host.put(kept.path, kept.bytes);
    this.keep(kept);
  }

  private keep(kept: Kept): void {
    this.all.set(kept.path, kept);
    this.notify();
    this.store?.keep(kept).then(
      () => {
        if (this.unkept) this.notices.take("store");
        this.unkept = false;
      },
      (error: unknown) => {
        this.unkept = true;
        this.notices.say("store", `The browser could not keep ${kept.path}: ${reason(error)}. Save it before you leave.`);
      },
    );
  }

  private forget(path: string): void {
    this.all.delete(path);
    this.disputed.delete(path);
    this.notices.take(`file ${path}`);
    this.host.remove(path);
    void this.store?.forget(path).catch(() => {});
    this.notify();
  }

  /** Saves a copy of a file as it is here, as a download. */
  copy(path: string, bytes = this.all.get(path)?.bytes): void {
    if (bytes) void download(path.replace(/^.*\//, ""), new Blob([bytes], { type: "application/octet-stream" }));
  }

  private looks = false;

  /** Looks whether another program has written a file. */
  private async look(): Promise<void> {
    if (this.looks) return;
    this.looks = true;
    // A file that is gone or being written is looked at again later.
    for (const { path, handle } of [...this.all.values()]) if (handle) await this.lookAt(path, handle).catch(() => {});
    this.looks = false;
  }

  private async lookAt(path: string, handle: FileSystemFileHandle): Promise<void> {
    if (!(await mayRead(handle))) return;
    const file = await handle.getFile();
    // Programs empty a file before they write it.
    if (file.size === 0 || file.lastModified === this.all.get(path)?.seen || file.lastModified === this.disputed.get(path)) return;
    const opened = await read(file, path, handle);
    const kept = this.all.get(path);
    if (!kept || kept.handle !== handle || kept.seen === opened.seen) return;
    if (same(kept.bytes, opened.bytes)) this.keep({ ...kept, seen: opened.seen, changed: false });
    else if (kept.changed) this.dispute(path, opened.seen);
    else this.take({ ...kept, ...opened });
  }

  /** Asks what is to be shown: the file as another program wrote it, or the drawing with the changes that were made here. */
  private dispute(path: string, seen: number): void {
    this.disputed.set(path, seen);
    const handle = this.all.get(path)?.handle;
    const reread = async (): Promise<void> => {
      const kept = this.all.get(path);
      if (kept && handle) this.take({ ...kept, ...(await read(await handle.getFile(), path, handle)), changed: false });
    };
    const mine = (): void => {
      const kept = this.all.get(path);
      if (kept) this.keep({ ...kept, seen });
    };
    this.notices.say(`file ${path}`, `Another program has written ${path}, which has changes here that are in no file.`, [
      { label: "Show the file", press: () => void reread().catch((error: unknown) => this.notices.say(`file ${path}`, `${path} could not be read: ${reason(error)}.`)) },
      { label: "Keep the changes made here", press: mine },
    ]);
  }

  private notify(): void {
    for (const listener of this.listeners) listener();
  }
}

/** The path of a drawing, with the first number behind its name that makes another one of it where it is taken. */
function numbered(path: string, isTaken: (path: string) => boolean): string {
  let free = path;
  for (let number = 2; isTaken(free); number++) free = path.replace(/\.svg$/i, `-${number}$&`);
  return free;
}

/** The message of an error, as a sentence without its full stop. */
export const reason = (error: unknown): string => (error instanceof Error ? error.message : String(error)).replace(/\.$/, "");

function same(a: Uint8Array, b: Uint8Array): boolean {
  return a.length === b.length && a.every((byte, at) => byte === b[at]);
}
