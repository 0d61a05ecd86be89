// The panel "Record a puppet": the camera, its marks, a recording, and what becomes of it.

import { FlipHorizontal2, Pause, Volume2, X } from "lucide";
import { button, count, fill, h } from "../dom";
import type { Host } from "../host/host";
import type { State } from "../state";
import { Camera, whyNot } from "./camera";
import { CountIn } from "./count-in";
import { Link } from "./link";
import { MarkList } from "./mark-list";
import type { FromTracker, Mark, Sighting } from "./messages";
import { Overlay, type Place } from "./overlay";
import { Pictures } from "./pictures";
import { Replay } from "./replay";
import { markNames } from "./strings";

/** The longest recording, in milliseconds. */
const LONGEST = 30_000;
/** After how long a mark that is not seen is reported as lost, in milliseconds. */
const LOST_AFTER = 800;
/** The radius of the ring around a place that was chosen, in pixels of the picture. */
const CHOSEN_RADIUS = 8;
/** How far an arrow key moves the cross, in pixels of the picture; with Shift. */
const STEP = 2;
const LARGE_STEP = 16;

/**
 * closed · asking: before the camera is used · connecting: to the program · live: marks are chosen and followed · counting: in ·
 * recording · tracking: the recording is tracked once more · replay · failed: the message says why
 */
type Stage = "closed" | "asking" | "connecting" | "live" | "counting" | "recording" | "tracking" | "replay" | "failed";

export class CameraPanel {
  private readonly element = h("dialog", { class: "camera-dialog", attributes: { "aria-labelledby": "camera-title" } });
  private readonly canvas = h("canvas", { class: "camera-picture", attributes: { tabindex: 0, role: "application", "aria-label": "Picture of the camera. The arrow keys move a cross, Enter chooses the mark under it, Space holds the picture still." } });
  private readonly overlay = new Overlay();
  private readonly frame = h("div", { class: "camera-frame" }, this.canvas, this.overlay.element);
  private readonly number = h("p", { class: "camera-count", hidden: true, attributes: { "aria-hidden": "true" } });
  private readonly status = h("p", { class: "camera-status", attributes: { role: "status", "aria-live": "polite" } });
  private readonly start = button({ label: "Use the camera", wide: true, class: "primary", press: () => void this.use() });
  private readonly still = button({ icon: Pause, label: "Hold the picture still", press: () => this.hold(!this.isHeld) });
  private readonly mirror = button({ icon: FlipHorizontal2, label: "Mirror the picture", press: () => this.flip() });
  private readonly sound = button({ icon: Volume2, label: "Clicks before the recording", press: () => this.sound.setAttribute("aria-pressed", String(!isPressed(this.sound))) });
  private readonly record = button({ label: "Record", wide: true, class: "primary", press: () => this.count() });
  private readonly stop = button({ label: "Stop", wide: true, class: "primary", press: () => this.finish() });
  private readonly tools = h("div", { class: "camera-row", attributes: { role: "group", "aria-label": "Camera" } }, this.still, this.mirror, this.sound, h("span", { class: "spring" }), this.record, this.stop);
  private readonly list: MarkList;
  private readonly replay: Replay;
  private readonly camera = new Camera(this.canvas, () => this.taken(), () => this.fail("The camera was disconnected."));
  private readonly countIn = new CountIn();
  private readonly pictures = new Pictures();
  private link: Link | null = null;
  private stage: Stage = "closed";
  private isHeld = false;
  private marks: readonly Mark[] = [];
  /** When each mark was seen last. */
  private lastSeen: number[] = [];
  private trails: Place[][] = [];
  /** Where a mark was just chosen: shown until the program has found it. */
  private chosen: { x: number; y: number } | null = null;
  /** Why the program refused something, if nothing was tracked since. */
  private refusal = "";
  /** Where the cross is, in pixels of the picture. */
  private cross: { x: number; y: number } | null = null;
  /** When the recording began: the time of its first picture, in milliseconds. */
  private began = 0;
  private recorded = 0;

  /** A panel that is in the page only while it is open. */
  constructor(private readonly host: Host, private readonly state: State, private readonly page: HTMLElement) {
    this.list = new MarkList((mark, name) => this.link?.ask({ type: "name", mark, name }), (mark) => this.link?.ask({ type: "remove", mark }));
    this.replay = new Replay(this.canvas, this.overlay, this.pictures, (name, text) => this.save(name, text), () => this.again());
    this.mirror.setAttribute("aria-pressed", "true");
    this.sound.setAttribute("aria-pressed", "true");
    this.frame.append(this.number);
    fill(
      this.element,
      h("header", { class: "dialog-head" }, h("h2", { attributes: { id: "camera-title" } }, "Record a puppet"), button({ icon: X, label: "Close", press: () => this.element.close() })),
      h("div", { class: "camera-body" }, h("div", { class: "camera-main" }, this.frame, this.tools), h("div", { class: "camera-side" }, this.status, this.start, this.list.element, this.replay.element)),
    );
    this.element.addEventListener("close", () => {
      this.release();
      this.element.remove();
    });
    this.canvas.addEventListener("click", (event) => this.pick(this.placeOf(event)));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    this.canvas.addEventListener("blur", () => this.overlay.showCross(null));
    this.flip(true);
  }

  /** Whether this page can reach a camera at all. */
  get isPossible(): boolean {
    return this.host.openCamera !== null;
  }

  toggle(): void {
    if (this.element.open) return this.element.close();
    if (!this.isPossible) return;
    this.page.append(this.element);
    this.element.showModal();
    this.show("asking", "Move a paper puppet with coloured marks before the camera, and its movement becomes a file for the drawing. The pictures go to okoshi on this machine, which finds the marks. They are not stored and go nowhere else.");
    this.start.focus();
  }

  private async use(): Promise<void> {
    const { openCamera } = this.host;
    if (!openCamera) return;
    this.start.disabled = true;
    try {
      await this.camera.start();
    } catch (error) {
      this.start.disabled = false;
      return this.fail(whyNot(error));
    }
    this.start.disabled = false;
    // The panel may have been closed while the browser asked.
    if (!this.element.open) return this.camera.stop();
    this.link?.close();
    this.link = new Link(openCamera(), () => this.opened(), (message) => this.received(message), () => this.lost());
    this.forget();
    this.show("connecting", "Connecting to okoshi…");
  }

  /** The program listens: what is chosen from now on reaches it. */
  private opened(): void {
    this.live();
    this.canvas.focus();
  }

  private live(): void {
    this.show("live", "Click on each mark in the picture, or use the arrow keys and Enter.");
  }

  /** A new picture of the camera. */
  private taken(): void {
    this.overlay.resize(this.canvas.width, this.canvas.height);
    if (this.stage === "recording" && this.began > 0 && this.camera.time - this.began > LONGEST) return this.finish();
    if (this.link?.isReady) this.sendPicture();
  }

  private sendPicture(): void {
    const pixels = this.camera.pixels();
    if (!pixels || !this.link?.frame(pixels, this.camera.time) || this.stage !== "recording") return;
    if (this.began === 0) this.began = this.camera.time;
    this.pictures.add(this.canvas, this.camera.time);
  }

  private received(message: FromTracker): void {
    switch (message.type) {
      case "seen":
        return this.seen(message.marks, message.recorded);
      case "marks":
        if (this.stage !== "replay") this.showChosen(message.marks);
        this.marks = message.marks;
        this.lastSeen = this.marks.map(() => performance.now());
        this.list.show(this.marks, markNames(this.state.parts));
        this.refresh();
        if (this.stage === "live") this.say(this.marks.length > 0 ? `${count(this.marks.length, "mark")}: ${this.marks.map(({ name }) => name).join(", ")}.` : "No marks are chosen.");
        return;
      case "track": {
        const isNew = this.stage === "tracking";
        const track = this.replay.show(message.file);
        this.list.tell(this.replay.states());
        if (isNew) this.show("replay", `Recorded ${count(track.times.length, "frame")}, ${(track.times.at(-1) ?? 0).toFixed(1)} seconds.`);
        return;
      }
      case "error":
        return this.refused(message.message, message.isFrame);
    }
  }

  /** Shows the place of a new mark: while the picture is held, the program looks for it in no other. */
  private showChosen(marks: readonly Mark[]): void {
    const mark = marks[marks.length - 1];
    const isNew = mark && marks.length > this.marks.length && this.chosen;
    this.overlay.showRings(isNew ? [{ mark, at: { ...isNew, radius: CHOSEN_RADIUS } }] : []);
    this.chosen = null;
  }

  private refused(message: string, isFrame: boolean): void {
    // A recording ends with a frame that does not fit; at other times the next frame is tracked.
    if (isFrame) return this.finish();
    this.list.restore();
    if (this.stage === "tracking") this.again();
    this.refusal = `${message[0]?.toUpperCase() ?? ""}${message.slice(1)}.`;
    this.say(this.refusal);
  }

  private seen(sightings: readonly (Sighting | null)[], recorded: number): void {
    if (this.stage === "replay" || this.stage === "tracking") return;
    this.refusal = "";
    const now = performance.now();
    this.overlay.showRings(this.marks.flatMap((mark, index) => (sightings[index] ? [{ mark, at: sightings[index] }] : [])));
    sightings.forEach((sighting, mark) => {
      if (sighting) this.lastSeen[mark] = now;
    });
    this.list.tell(this.marks.map((_, mark) => (sightings[mark] ? "seen" : now - (this.lastSeen[mark] ?? now) > LOST_AFTER ? "lost: bring it into the picture" : "")));
    if (recorded <= this.recorded) return;
    this.recorded = recorded;
    this.trails = this.marks.map((_, mark) => [...(this.trails[mark] ?? []), sightings[mark] ? [sightings[mark].x, sightings[mark].y] : null]);
    this.overlay.showTrails(this.marks.map((mark, index) => ({ mark, places: this.trails[index] ?? [] })));
    const seconds = Math.floor((this.camera.time - this.began) / 1000);
    this.number.textContent = `● ${seconds} s`;
  }

  private hold(isHeld: boolean): void {
    if (this.stage !== "live") return;
    this.isHeld = isHeld;
    this.camera.hold(isHeld);
    // What is clicked must be in the picture that the program has.
    if (isHeld) this.sendPicture();
    this.refresh();
  }

  private flip(isMirrored = !isPressed(this.mirror)): void {
    this.mirror.setAttribute("aria-pressed", String(isMirrored));
    this.frame.classList.toggle("mirrored", isMirrored);
  }

  /** The place in the picture that a pointer is at, in its pixels. */
  private placeOf({ clientX, clientY }: MouseEvent): { x: number; y: number } {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const across = (clientX - left) / width;
    return {
      x: (isPressed(this.mirror) ? 1 - across : across) * this.canvas.width - 0.5,
      y: ((clientY - top) / height) * this.canvas.height - 0.5,
    };
  }

  private pick(at: { x: number; y: number }): void {
    if (this.stage !== "live" || !this.link) return;
    // The program looks at the newest picture that it has: that must be the one that is seen.
    this.sendPicture();
    this.chosen = at;
    this.link.ask({ type: "pick", ...at });
  }

  private key(event: KeyboardEvent): void {
    if (this.stage !== "live" || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? LARGE_STEP : STEP;
    const right = isPressed(this.mirror) ? -step : step;
    const moves: Record<string, readonly [number, number]> = { ArrowLeft: [-right, 0], ArrowRight: [right, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    const move = moves[event.key];
    const { width, height } = this.canvas;
    const from = this.cross ?? { x: Math.round(width / 2), y: Math.round(height / 2) };
    if (move) {
      this.cross = { x: Math.min(Math.max(from.x + move[0], 0), width - 1), y: Math.min(Math.max(from.y + move[1], 0), height - 1) };
      this.overlay.showCross(this.cross);
    } else if (event.key === "Enter") this.pick(from);
    else if (event.key === " ") this.hold(!this.isHeld);
    else return;
    event.preventDefault();
  }

  private count(): void {
    if (this.stage !== "live" || this.marks.length === 0) return;
    this.hold(false);
    this.show("counting", "The recording begins after three clicks.");
    this.countIn.start(isPressed(this.sound), (left) => {
      this.number.textContent = String(left);
      if (left > 0) return this.say(String(left));
      this.forget();
      this.link?.ask({ type: "record" });
      this.show("recording", "Recording. Move the puppet.");
    });
  }

  private finish(): void {
    if (this.stage !== "recording") return;
    this.camera.pause(true);
    this.show("tracking", "Tracking the recording…");
    this.link?.ask({ type: "stop" });
  }

  private again(): void {
    this.replay.close();
    this.forget();
    this.camera.pause(false);
    this.live();
    if (!this.link) this.lost();
  }

  /** Forgets the last recording. */
  private forget(): void {
    this.trails = [];
    this.chosen = null;
    this.refusal = "";
    this.recorded = this.began = 0;
    this.isHeld = false;
    this.pictures.clear();
    this.overlay.showTrails([]);
    this.overlay.showRings([]);
  }

  private save(name: string, text: string): void {
    void this.host.save(name, new Blob([text], { type: "application/json" }));
    this.say(`Saved ${name} with the browser's downloads.`);
  }

  /** The connection was lost. A track that is there can still be saved. */
  private lost(): void {
    this.link = null;
    if (this.stage === "failed" || this.stage === "closed") return;
    if (this.stage === "replay") return this.say("The connection to okoshi was lost. The track can still be saved.");
    this.fail(this.refusal || "The connection to okoshi was lost. Start it again, then use the camera again.");
  }

  private fail(why: string): void {
    this.letGo();
    this.show("failed", why);
  }

  private release(): void {
    this.stage = "closed";
    this.replay.close();
    this.letGo();
  }

  /** Gives the camera and the connection back, and forgets what they brought. */
  private letGo(): void {
    this.countIn.cancel();
    this.camera.stop();
    this.link?.close();
    this.link = null;
    this.marks = [];
    this.list.show([], []);
    this.forget();
  }

  private show(stage: Stage, message: string): void {
    this.stage = stage;
    this.say(message);
    this.refresh();
  }

  private say(message: string): void {
    this.status.textContent = message;
  }

  private refresh(): void {
    const { stage } = this;
    const isOff = stage === "asking" || stage === "failed";
    this.element.dataset["stage"] = stage;
    this.frame.hidden = this.tools.hidden = isOff;
    this.start.hidden = !isOff;
    this.start.querySelector("span")!.textContent = stage === "failed" ? "Try again" : "Use the camera";
    this.still.disabled = stage !== "live";
    this.still.setAttribute("aria-pressed", String(this.isHeld));
    this.record.hidden = stage !== "live";
    this.record.disabled = this.marks.length === 0;
    this.stop.hidden = stage !== "recording";
    this.sound.hidden = this.still.hidden = stage === "replay";
    this.number.hidden = stage !== "counting" && stage !== "recording";
    if (!this.number.hidden && stage === "recording") this.number.textContent = "● 0 s";
    this.list.allowRemoving(stage === "live");
    if (stage === "recording") this.stop.focus();
  }
}

const isPressed = (element: HTMLElement): boolean => element.getAttribute("aria-pressed") === "true";
