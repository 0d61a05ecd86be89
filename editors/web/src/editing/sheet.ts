// The drawings of a limited clip, above its timeline, while it is edited: the end of one is dragged to let it stand for longer or less,
// keys leave one out and bring one back.

import { Plus, Trash2 } from "lucide";
import { button, fill, h, svg } from "../dom";
import type { Clips } from "../panels/clips";
import type { State } from "../state";
import type { ExposureSheet } from "../viewport/exposure-sheet";
import type { Viewer } from "../viewport/viewer";
import { clipChange } from "./clips";
import { broughtBack, heldWords, most, nearestEnd, standing, type Drawn, type Sheet } from "./drawings";
import { clipDraft, within } from "./draft";
import type { Editing } from "./editing";
import type { ClipForm, PartForm } from "./messages";
import { PAUSE } from "./values";

/** How near a pointer must be to the end of a drawing, in pixels. */
const NEAR = { fine: 9, coarse: 24 };

export class SheetEditor {
  private readonly edge = h("div", { class: "sheet-edge", attributes: { role: "slider", tabindex: 0, "aria-orientation": "horizontal", "aria-valuemin": 1 } });
  private readonly picture = svg("svg", { class: "sheet-picture", viewBox: "0 0 1000 10", preserveAspectRatio: "none", "aria-hidden": "true" });
  private readonly label = h("div", { class: "sheet-label", hidden: true });
  private readonly strip = h("div", { class: "sheet", hidden: true, attributes: { role: "group", "aria-label": "Drawings of the clip" } }, this.picture, this.edge, this.label);
  private readonly omit = button({ icon: Trash2, label: "Leave this drawing out", key: "Delete", press: () => this.leaveOut() });
  private readonly back = button({ icon: Plus, label: "Bring a drawing back behind this one", key: "Insert", press: () => this.bringBack() });
  /** The form of the selected part. */
  private selected: PartForm | null = null;
  /** The form of the clip's figure. */
  private form: PartForm | null = null;
  /** The root of the figure that it was asked for. */
  private figure: string | undefined;
  private asked = 0;
  /** The exposure sheet that is changed. */
  private shown: ExposureSheet | null = null;
  private sheet: Sheet = { drawings: [], held: new Map() };
  /** The list of a change that was sent, until a build has it. */
  private sent: string | null | undefined;
  /** Whether what is shown changed while something was being decided. */
  private late = false;
  /** How the sheet would be after a change that is not sent yet. */
  private wanted: Sheet | null = null;
  private press: { readonly id: number; readonly at: number } | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly viewer: Viewer, private readonly editing: Editing, private readonly clips: Clips, state: State) {
    clips.addTools(this.strip, [this.omit, this.back]);
    editing.listen(["mode"], () => {
      if (!editing.isOn) {
        this.press = null;
        this.sent = undefined;
        this.drop();
      }
      this.load();
    });
    editing.listen(["done"], () => {
      if (editing.refusal) this.load();
    });
    state.on(["current", "build", "selection"], () => this.load());
    viewer.on(["model", "time"], () => this.draw());
    this.strip.addEventListener("pointerdown", (event) => this.down(event));
    addEventListener("pointermove", (event) => this.move(event));
    addEventListener("pointerup", (event) => {
      if (event.pointerId === this.press?.id) this.send();
    });
    addEventListener("pointercancel", () => this.giveUp());
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.wanted) return;
      event.preventDefault();
      event.stopPropagation();
      this.giveUp();
    }, { capture: true });
    this.edge.addEventListener("keydown", (event) => this.key(event));
    this.edge.addEventListener("blur", () => {
      if (!this.press) this.send();
    });
  }

  /** The form of the selected part, or none: what is changed there and here is about the same clips. */
  show(form: PartForm | null): void {
    this.selected = form;
    this.load();
  }

  /** Asks for the form of the figure whose drawings are shown. */
  private load(): void {
    // Whoever is still deciding goes on with what was shown.
    this.late = this.press !== null || this.wanted !== null;
    if (this.late) return;
    const asked = ++this.asked;
    const exposure = this.viewer.playback.exposures.current;
    const figure = exposure?.facts.figure;
    this.figure = figure;
    if (!this.editing.isOn || figure === undefined) return this.take(null);
    if (this.selected?.motion?.clips.some(({ plays }) => plays?.root === figure)) return this.take(this.selected);
    const { sent } = this.editing;
    void this.editing.form(figure).then((form) => {
      if (asked !== this.asked) return;
      if (sent !== this.editing.sent) return this.load();
      this.take(form);
    });
  }

  private take(form: PartForm | null): void {
    this.form = form;
    // What was refused, or changed by others, is no longer waited for.
    const now = this.clip;
    if (now && now.clip.held.value !== this.sent) this.sent = undefined;
    this.shown = null;
    this.draw();
  }

  /** The clip that is shown, as it was said last. */
  private get clip(): { readonly clip: ClipForm; readonly at: number } | null {
    const name = this.viewer.playback.exposures.current?.facts.name;
    const at = this.form?.motion?.clips.findIndex(({ plays }) => plays !== null && plays.name === name) ?? -1;
    const clip = this.form?.motion?.clips[at];
    return clip ? { clip, at } : null;
  }

  private draw(): void {
    const exposure = this.viewer.playback.exposures.current;
    const figure = exposure?.facts.figure;
    if (this.editing.isOn && figure !== this.figure) return this.load();
    const now = this.clip;
    const isPossible = this.editing.isOn && exposure !== null && exposure.runs.length > 0 && now !== null;
    this.strip.hidden = this.omit.hidden = this.back.hidden = !isPossible;
    this.clips.element.dataset["edits"] = String(isPossible);
    if (!isPossible) return;
    if (this.shown !== exposure) {
      this.shown = exposure;
      const held = new Map(exposure.facts.chosen);
      // A build of an earlier change does not say what was said since.
      if (this.sent === heldWords(held)) this.sent = undefined;
      if (this.wanted === null && this.sent === undefined) this.sheet = { drawings: exposure.runs, held };
    }
    const sheet = this.wanted ?? this.sheet;
    const at = this.current(sheet);
    const drawing = sheet.drawings[at]!;
    const { seconds } = this.clips.axis;
    const across = (frame: number): number => (seconds > 0 ? (frame / exposure.fps / seconds) * 1000 : 0);
    const isChanged = sheet.drawings !== exposure.runs;
    this.clips.element.dataset["changed"] = String(isChanged);
    const box = ({ start, frames }: Drawn): string => `M${across(start)} 0H${Math.max(across(start + frames) - 2, across(start) + 0.5)}V10H${across(start)}Z`;
    if (isChanged) fill(this.picture, svg("path", { class: "held", d: sheet.drawings.map(box).join("") }), svg("path", { class: "now", d: box(drawing) }));
    else fill(this.picture);
    this.edge.style.left = `${across(drawing.start + drawing.frames) / 10}%`;
    const isLast = at + 1 === sheet.drawings.length;
    const stands = `${drawing.frames} ${drawing.frames === 1 ? "frame" : "frames"}`;
    const attributes: Readonly<Record<string, string>> = {
      "aria-label": `Drawing ${at + 1}: how long it stands`,
      "aria-valuenow": String(drawing.frames),
      "aria-valuemax": String(most(sheet, at)),
      "aria-valuetext": isLast ? `${stands}, until the end` : stands,
      "aria-disabled": String(isLast),
    };
    for (const [name, value] of Object.entries(attributes)) if (this.edge.getAttribute(name) !== value) this.edge.setAttribute(name, value);
    this.omit.disabled = at === 0;
    this.back.disabled = broughtBack(sheet, at, exposure.sources) === null;
  }

  /** The drawing at the time of the clip. */
  private current({ drawings }: Sheet): number {
    if (this.press) return Math.min(this.press.at, drawings.length - 1);
    const frame = this.shown?.frameAt(this.viewer.playback.player.time) ?? 0;
    return Math.max(drawings.findLastIndex(({ start }) => start <= frame), 0);
  }

  /** The frame of the clip at a point, with its fraction. */
  private frameAt(x: number): number {
    const { left, width } = this.strip.getBoundingClientRect();
    return ((x - left) / Math.max(width, 1)) * this.clips.axis.seconds * (this.shown?.fps ?? 24);
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || this.press || !this.shown) return;
    this.send();
    const frame = this.frameAt(event.clientX);
    const found = nearestEnd(this.sheet, frame);
    const perFrame = this.strip.clientWidth / Math.max(this.clips.axis.seconds * this.shown.fps, 1e-6);
    event.preventDefault();
    const near = event.pointerType === "mouse" ? NEAR.fine : NEAR.coarse;
    if (!found || found.away * perFrame > near) return this.go(frame);
    this.press = { id: event.pointerId, at: found.at };
    this.go(this.sheet.drawings[found.at]!.start);
    this.edge.focus({ preventScroll: true });
  }

  private move(event: PointerEvent): void {
    const { press } = this;
    if (!press || event.pointerId !== press.id) return;
    const drawing = this.sheet.drawings[press.at]!;
    const frames = Math.max(Math.round(this.frameAt(event.clientX)) - drawing.start, 0);
    this.try(standing(this.sheet, press.at, frames), frames === 0 ? "left out" : `${frames} ${frames === 1 ? "frame" : "frames"}`, event.clientX);
  }

  /** Shows the clip at a frame, and lets it rest there. */
  private go(frame: number): void {
    const { playback } = this.viewer;
    playback.moved(() => {
      playback.player.play(false);
      playback.player.seek(this.shown?.timeOfFrame(Math.max(Math.floor(frame), 0)) ?? 0);
    });
  }

  /** Shows what a change would make of the clip; with null it is as it was. */
  private try(next: Sheet | null, words = "", x = 0): void {
    const before = this.wanted && heldWords(this.wanted.held);
    this.wanted = next;
    this.label.hidden = words === "";
    this.label.textContent = words;
    if (words !== "") {
      const { left, width } = this.strip.getBoundingClientRect();
      const half = this.label.offsetWidth / 2;
      this.label.style.left = `${Math.min(Math.max(x - left, half), Math.max(width - half, half))}px`;
    }
    this.draw();
    const change = next && this.change(next);
    if (!change || !this.form) return this.editing.giveUp();
    if (heldWords(next.held) !== before) this.editing.attempt(this.form, change);
  }

  /** What says a sheet in the drawing. */
  private change(next: Sheet): ReturnType<typeof clipChange> | null {
    const { clip: now, form } = this;
    return now && form ? clipChange(form.part, now.at, this.said(now.clip, next)) : null;
  }

  private said(clip: ClipForm, { held }: Sheet): ClipForm {
    const value = heldWords(held);
    return { ...clip, held: { ...clip.held, from: value === null ? "builtin" : "own", value } };
  }

  /** Sends what is wanted. */
  private send(): void {
    const { wanted, clip: now, form } = this;
    const change = wanted && this.change(wanted);
    this.press = null;
    this.drop();
    if (!wanted || !change || !now || !form?.motion) return this.loadLate();
    this.sheet = wanted;
    this.sent = heldWords(wanted.held);
    within(clipDraft(form.motion, now.at), "held").say(this.said(now.clip, wanted).held);
    // Whatever is selected stays so.
    void this.editing.make(form, change, false);
    this.draw();
    this.loadLate();
  }

  private loadLate(): void {
    if (this.late) this.load();
  }

  private giveUp(): void {
    if (!this.press && !this.wanted) return;
    this.press = null;
    this.drop();
    this.editing.giveUp();
    this.draw();
    this.loadLate();
  }

  /** Forgets what is wanted. */
  private drop(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.wanted = null;
    this.label.hidden = true;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const steps: Readonly<Record<string, number>> = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
    const step = steps[event.key];
    if (step !== undefined) this.lengthen(step);
    else if (event.key === "Delete" || event.key === "Backspace") this.leaveOut();
    else if (event.key === "Insert") this.bringBack();
    else return;
    event.preventDefault();
  }

  /** One more or one less; several presses are one change. */
  private lengthen(step: number): void {
    const sheet = this.wanted ?? this.sheet;
    const at = this.current(sheet);
    const frames = (sheet.drawings[at]?.frames ?? 0) + step;
    const next = frames < 1 ? null : standing(sheet, at, frames);
    if (!next) return;
    this.go(sheet.drawings[at]!.start);
    this.try(next);
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.send(), PAUSE);
  }

  private leaveOut(): void {
    this.alter((sheet, at) => standing(sheet, at, 0), -1);
  }

  private bringBack(): void {
    this.alter((sheet, at) => broughtBack(sheet, at, this.shown?.sources ?? 0), 1);
  }

  /** Changes the drawing that is shown, and shows the one beside it. */
  private alter(make: (sheet: Sheet, at: number) => Sheet | null, toBeside: number): void {
    this.send();
    const at = this.current(this.sheet);
    const next = make(this.sheet, at);
    if (!next) return;
    this.wanted = next;
    this.go(next.drawings[at + toBeside]?.start ?? 0);
    this.send();
  }
}
