// The bar that is shown in posing mode.

import { BookmarkPlus, Circle, RotateCcw, RotateCw, Square, Undo2, X } from "lucide";
import { button, fill, h, icon, prefersReducedMotion, setHidden } from "../dom";
import type { Commands } from "../commands";
import type { Editing } from "../editing/editing";
import type { KeepPose } from "../editing/messages";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";
import { Movement } from "./movement";

/** The name of the clip of key poses. */
const POSES = "poses";
/** The longest recording, in milliseconds. */
const LONGEST = 30_000;

export class PoseBar {
  readonly element = h("section", { class: "posebar", hidden: true, attributes: { "aria-label": "Posing" } });
  private readonly readout = h("output", { class: "pose-readout" });
  private readonly reset: HTMLButtonElement;
  private readonly keep: HTMLButtonElement;
  private readonly record: HTMLButtonElement;
  /** What is being recorded. */
  private movement: Movement | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** What was kept and is to be shown: the revision of the model before it, and whether it is a movement, which is played. */
  private kept: { readonly revision: string; readonly moves: boolean } | null = null;

  constructor(private readonly viewer: Viewer, private readonly commands: Commands, private readonly editing: Editing, private readonly state: State) {
    this.reset = button({ icon: Undo2, label: "Reset pose", key: "Esc", wide: true, press: () => commands.resetPose() });
    this.keep = button({ icon: BookmarkPlus, label: "Keep pose", wide: true, press: () => void this.keepPose() });
    this.record = button({ icon: Circle, label: "Record", wide: true, press: () => this.toggleRecording() });
    fill(
      this.element,
      this.readout,
      button({ icon: RotateCcw, label: "Turn the selected part left by 5°", key: ",", press: ({ shiftKey }) => commands.turn(5, shiftKey) }),
      button({ icon: RotateCw, label: "Turn the selected part right by 5°", key: ".", press: ({ shiftKey }) => commands.turn(-5, shiftKey) }),
      this.keep,
      this.record,
      this.reset,
      button({ icon: X, label: "Leave posing", key: "P", press: () => commands.togglePosing() }),
    );
    commands.onMode(() => this.follow());
    viewer.on(["pose"], () => this.follow());
    viewer.on(["pose", "time"], () => this.note());
    viewer.on(["model"], () => this.showKept());
    editing.listen(["mode", "done"], () => this.follow());
    this.follow();
  }

  show(part: string, degrees: number): void {
    const rounded = Math.round(degrees);
    fill(this.readout, h("strong", {}, part), ` ${rounded > 0 ? "+" : rounded < 0 ? "−" : ""}${Math.abs(rounded)}°`);
  }

  /** How all parts are turned, in degrees. */
  private allTurns(): Map<string, number> {
    const { viewer, state } = this;
    const main = state.parts.all.filter(({ kind }) => kind === "main");
    return new Map(
      main.flatMap(({ name }) => {
        const node = viewer.parts.nodesOf(name)[0];
        return node ? [[name, Math.round(viewer.pose.drawnTurn(node) * 1e3) / 1e3] as const] : [];
      }),
    );
  }

  /** The parts that are turned by hand. */
  private byHand(): string[] {
    const { viewer } = this;
    return viewer.pose.names.map((name) => viewer.model?.node(name)).flatMap((node) => (node ? [viewer.parts.nameOf(node)] : []));
  }

  /** The part that carries all of a figure. */
  private readonly figure = (part: string): string => this.state.parts.above(part).at(-1) ?? part;

  /** Notes the pose as it is now. */
  private noted(movement: Movement): Movement {
    movement.note(this.allTurns(), this.byHand());
    return movement;
  }

  /** Begins to record what is dragged, and what a clip does meanwhile; or makes key poses of what was recorded. */
  private toggleRecording(): void {
    if (this.movement) return void this.finishRecording();
    this.movement = new Movement();
    this.timer = setTimeout(() => void this.finishRecording(), LONGEST);
    this.note();
    this.follow();
  }

  private note(): void {
    if (this.movement) this.noted(this.movement);
  }

  private async finishRecording(): Promise<void> {
    this.note();
    const { movement } = this;
    this.giveUpRecording();
    if (!movement) return;
    if (movement.isEmpty) this.readout.textContent = "Nothing was dragged.";
    else await this.keepAs({ change: "keep-movement", moments: movement.of(this.figure) });
  }

  /** Records no more, and forgets what was recorded. Returns whether anything was. */
  giveUpRecording(): boolean {
    const recorded = this.movement !== null;
    clearTimeout(this.timer);
    this.movement = null;
    this.follow();
    return recorded;
  }

  private get revision(): string {
    return this.viewer.canvas.dataset["revision"] ?? "";
  }

  private keepPose(): Promise<void> {
    const [now] = this.noted(new Movement()).of(this.figure);
    return this.keepAs({ change: "keep-pose", turns: now?.turns ?? [] });
  }

  private async keepAs(pose: KeepPose): Promise<void> {
    this.kept = { revision: this.revision, moves: pose.change === "keep-movement" };
    if (!(await this.editing.keep(pose))) this.kept = null;
    // Its model may have come before the answer.
    this.showKept();
  }

  /** Shows the kept pose, from which the next one is made: the end of the clip, without what was turned by hand. A movement is played first. */
  private showKept(): void {
    const { kept } = this;
    const { playback, pose } = this.viewer;
    const { player } = playback;
    const clip = player.clips.find(({ name }) => name === POSES);
    if (!clip || this.editing.busy || kept === null || kept.revision === this.revision) return;
    this.kept = null;
    pose.reset();
    playback.moved(() => {
      player.choose(clip);
      const plays = kept.moves && !prefersReducedMotion();
      player.play(plays);
      player.seek(plays ? 0 : player.end);
    });
    this.viewer.posed();
  }

  private follow(): void {
    const { viewer, commands, editing } = this;
    setHidden(this.element, !commands.isPosing && viewer.pose.isEmpty, viewer.canvas);
    const records = this.movement !== null;
    for (const button of [this.keep, this.record]) setHidden(button, !editing.isPossible, viewer.canvas);
    this.keep.disabled = viewer.pose.isEmpty || editing.busy || records;
    this.reset.disabled = viewer.pose.isEmpty;
    this.record.disabled = editing.busy;
    if (this.record.getAttribute("aria-pressed") !== String(records)) {
      this.record.setAttribute("aria-pressed", String(records));
      this.record.title = records ? "Stop, and make key poses of what was recorded" : "Record what you drag, also while a clip plays, as key poses";
      fill(this.record, icon(records ? Square : Circle), h("span", {}, records ? "Stop" : "Record"));
    }
    if (!viewer.pose.isEmpty) return;
    const isNarrow = matchMedia("(max-width: 760px)").matches;
    if (records) this.readout.textContent = isNarrow ? "Recording" : "Recording: drag a limb, also while a clip plays.";
    else this.readout.textContent = isNarrow ? "Drag a limb" : "Drag a limb. Shift: about its own axis.";
  }
}
