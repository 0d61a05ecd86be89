// Editing: what is changed here is written into the drawing. It is off until a person turns it on.

import type { ChangeWords, Host } from "../host/host";
import type { Attempt } from "../viewport/loading";
import type { State } from "../state";
import { readForm, readRefusal, type Change, type KeepPose, type PartForm, type Refusal } from "./messages";

/** mode: turned on or off, or no longer possible · done: something was changed, undone or refused · picking: a part is asked for, or no longer */
export type EditingTopic = "mode" | "done" | "picking";

/** What becomes of changes that are made in a copy of a drawing that is open in Inkscape. */
const IN_COPY: ChangeWords = { doing: "Changing…", done: "Changed in the copy", where: "When you are done, call Take In Changes in Inkscape" };

export class Editing {
  private on = false;
  /** Why the last change was not made. */
  refusal: Refusal | null = null;
  /** What became of the last change, in words. */
  said = "";
  /** Whether a change is on its way. */
  busy = false;
  /** Shows the field for the name of the selected part; set by the page. */
  rename: () => void = () => {};
  /** Shows what a change would make of the drawing, or the drawing as it is, at once or once the change is made; set by the page. */
  tries: (attempt: Attempt | "made" | null) => void = () => {};
  /** Whether a change is tried, and neither made nor given up yet. */
  private trying = false;
  /** How many changes are on their way. */
  private sending = 0;
  /** How many changes were sent so far. */
  sent = 0;
  private readonly listeners = new Map<EditingTopic, (() => void)[]>();
  /** Changes are made one after the other. */
  private last: Promise<unknown> = Promise.resolve();

  constructor(private readonly state: State, private readonly host: Host) {
    state.on(["editing", "current", "link"], () => {
      if (this.on && !this.isPossible) this.set(false);
      this.notify("mode");
    });
    state.on("current", () => this.clear());
    state.on("selection", () => {
      if (this.refusal) this.clear();
    });
  }

  listen(topics: readonly EditingTopic[], listener: () => void): void {
    for (const topic of topics) this.listeners.set(topic, [...(this.listeners.get(topic) ?? []), listener]);
  }

  get isPossible(): boolean {
    return this.host.post !== null && this.state.key !== null && this.state.current !== null;
  }

  /** What becomes of changes, in words. */
  get words(): ChangeWords {
    return this.state.isCopy ? IN_COPY : this.host.changes;
  }

  get isOn(): boolean {
    return this.on;
  }

  toggle(): void {
    if (this.isPossible) this.set(!this.on);
  }

  private set(on: boolean): void {
    this.on = on;
    this.said = "";
    this.refusal = null;
    this.pick(null);
    this.giveUp();
    this.notify("mode");
  }

  /** Forgets a refusal that was read. */
  clear(): void {
    this.refusal = null;
    this.said = "";
    this.pick(null);
    this.notify("done");
  }

  get undoes(): string | null {
    return this.state.steps.undo;
  }

  get redoes(): string | null {
    return this.state.steps.redo;
  }

  /** Makes a change in a part's form; `true` if it was made. If the part `isSelected`, it stays so, and the form is its own, also under another name. */
  async make(form: PartForm, change: Change, isSelected = true): Promise<boolean> {
    // What it looks like is asked for before the drawing is written, read and built: that takes twice as long.
    if (change.change === "set" || change.change === "reset") this.attempt(form, change);
    // By the name that it has once all changes before this one are made.
    return this.send(() => ({ make: { ...change, part: form.part } }), (part) => {
      if (change.change === "name" && part !== null) form.part = part;
      return isSelected;
    });
  }

  /** Shows what a change in a part's form would make of the drawing, which stays as it is. */
  attempt(form: PartForm, change: Change): void {
    const { current, key } = this.state;
    const { attempt } = this.host;
    if (!this.on || current === null || key === null || !attempt) return;
    this.trying = true;
    const { last } = this;
    this.tries(async (shows) => {
      // By the name that the part has once all changes before this one are made.
      await last;
      return attempt(key, { drawing: current, revision: this.state.drawing?.build?.revision ?? 0, change: { ...change, part: form.part }, shows });
    });
  }

  /** Shows the drawing as it is, unless what was tried is being made. */
  giveUp(): void {
    if (!this.trying || this.sending > 0) return;
    this.trying = false;
    this.tries(null);
  }

  /** Makes a change that is in no part's form. */
  async apply(change: unknown): Promise<boolean> {
    return this.send(() => ({ make: change }));
  }

  /** Makes a change that was offered when the last one was refused. */
  async choose(change: unknown): Promise<boolean> {
    return this.send(() => ({ choose: change }));
  }

  /** Makes a pose the next key pose, or a movement the next ones. Editing is turned on, so that it can be undone. */
  async keep(pose: KeepPose): Promise<boolean> {
    if (!this.isOn) this.toggle();
    return this.apply(pose);
  }

  /** Once changes were sent, the host knows what there is to undo before the page does, and says if that is nothing. */
  undo(): void {
    if (this.undoes !== null || this.sent > 0) void this.send(() => "undo");
  }

  redo(): void {
    if (this.redoes !== null || this.sent > 0) void this.send(() => "redo");
  }

  /** What can be changed about a part; null if nothing can. */
  async form(part: string): Promise<PartForm | null> {
    const { current, key } = this.state;
    if (!this.on || current === null || key === null || !this.host.post) return null;
    await this.last;
    const answer = await this.host.post("forms", key, { drawing: current, part }).catch(() => null);
    return answer?.ok === true ? readForm(answer.body) : null;
  }

  /** Asks for a part, which is clicked in the model or in the list; null gives up. */
  pick(then: ((part: string) => void) | null): void {
    if (this.state.picker === null && then === null) return;
    this.state.picker =
      then &&
      ((part) => {
        this.pick(null);
        then(part);
      });
    this.notify("picking");
  }

  get isPicking(): boolean {
    return this.state.picker !== null;
  }

  private send(what: () => unknown, selects: (part: string | null) => boolean = () => true): Promise<boolean> {
    this.sending++;
    this.sent++;
    const sent = this.last
      .then(() => this.sendNow(what(), selects))
      .then((made) => {
        this.sending--;
        // What was made is shown until its build comes.
        if (!made) this.giveUp();
        else if (this.trying) {
          this.trying = false;
          this.tries("made");
        }
        return made;
      });
    this.last = sent;
    return sent;
  }

  private async sendNow(what: unknown, selects: (part: string | null) => boolean): Promise<boolean> {
    const { current, key, drawing } = this.state;
    if (!this.on || current === null || key === null || !this.host.post) return false;
    this.busy = true;
    this.refusal = null;
    this.notify("done");
    const request = { drawing: current, revision: drawing?.build?.revision ?? 0, do: what };
    const answer = await this.host.post("changes", key, request).catch(() => ({ ok: false, body: null }));
    this.busy = false;
    if (answer.ok) {
      const { part, note } = (answer.body ?? {}) as { part?: unknown; note?: unknown };
      const { done: said } = this.words;
      this.said = typeof note === "string" ? `${said}. ${note}` : said;
      const isSelected = selects(typeof part === "string" ? part : null);
      if (isSelected && typeof part === "string" && current === this.state.current) this.state.select(part);
    } else {
      this.said = "";
      this.refusal = readRefusal(answer.body);
    }
    this.notify("done");
    return answer.ok;
  }

  private notify(topic: EditingTopic): void {
    for (const listener of this.listeners.get(topic) ?? []) listener();
  }
}
