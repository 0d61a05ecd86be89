// The bar that is shown in posing mode.

import { BookmarkPlus, RotateCcw, RotateCw, Undo2, X } from "lucide";
import { button, fill, h, setHidden } from "../dom";
import type { Commands } from "../commands";
import type { Editing } from "../editing/editing";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";

/** The name of the clip of key poses. */
const POSES = "poses";
/** A smaller turn is none, in degrees. */
const STILL = 0.05;

export class PoseBar {
  readonly element = h("section", { class: "posebar", hidden: true, attributes: { "aria-label": "Posing" } });
  private readonly readout = h("output", { class: "pose-readout" });
  private readonly reset: HTMLButtonElement;
  private readonly keep: HTMLButtonElement;
  /** The revision of the model in which a pose was kept that is to be shown; `null` if none is. */
  private keptIn: string | null = null;

  constructor(private readonly viewer: Viewer, private readonly commands: Commands, private readonly editing: Editing, private readonly state: State) {
    this.reset = button({ icon: Undo2, label: "Reset pose", key: "Esc", wide: true, press: () => commands.resetPose() });
    this.keep = button({ icon: BookmarkPlus, label: "Keep pose", wide: true, press: () => void this.keepPose() });
    fill(
      this.element,
      this.readout,
      button({ icon: RotateCcw, label: "Turn the selected part left by 5°", key: ",", press: ({ shiftKey }) => commands.turn(5, shiftKey) }),
      button({ icon: RotateCw, label: "Turn the selected part right by 5°", key: ".", press: ({ shiftKey }) => commands.turn(-5, shiftKey) }),
      this.keep,
      this.reset,
      button({ icon: X, label: "Leave posing", key: "P", press: () => commands.togglePosing() }),
    );
    commands.onMode(() => this.follow());
    viewer.on(["pose"], () => this.follow());
    viewer.on(["model"], () => this.showKept());
    editing.listen(["mode", "done"], () => this.follow());
    this.follow();
  }

  show(part: string, degrees: number): void {
    const rounded = Math.round(degrees);
    fill(this.readout, h("strong", {}, part), ` ${rounded > 0 ? "+" : rounded < 0 ? "−" : ""}${Math.abs(rounded)}°`);
  }

  /** The parts of the figures that are posed, and how they are turned. */
  private turns(): { readonly part: string; readonly degrees: number }[] {
    const { viewer, state } = this;
    const top = (part: string): string => state.parts.above(part).at(-1) ?? part;
    const posed = viewer.pose.names.map((name) => viewer.model?.node(name)).filter((node) => node !== undefined);
    const figures = new Set(posed.map((node) => top(viewer.parts.nameOf(node))));
    const parts = state.parts.all.filter(({ kind, name }) => kind === "main" && figures.has(top(name)));
    const turned = parts.flatMap(({ name }) => {
      const node = viewer.parts.nodesOf(name)[0];
      return node ? [{ part: name, degrees: Math.round(viewer.pose.drawnTurn(node) * 1e3) / 1e3 }] : [];
    });
    return turned.filter(({ degrees }) => Math.abs(degrees) > STILL);
  }

  private get revision(): string {
    return this.viewer.canvas.dataset["revision"] ?? "";
  }

  private async keepPose(): Promise<void> {
    this.keptIn = this.revision;
    if (!(await this.editing.keep({ change: "keep-pose", turns: this.turns() }))) this.keptIn = null;
    // Its model may have come before the answer.
    this.showKept();
  }

  /** Shows the kept pose, from which the next one is made: the end of the clip, without what was turned by hand. */
  private showKept(): void {
    const { playback, pose } = this.viewer;
    const { player } = playback;
    const clip = player.clips.find(({ name }) => name === POSES);
    if (!clip || this.editing.busy || this.keptIn === null || this.keptIn === this.revision) return;
    this.keptIn = null;
    pose.reset();
    playback.moved(() => {
      player.choose(clip);
      player.play(false);
      player.seek(player.end);
    });
    this.viewer.posed();
  }

  private follow(): void {
    const { viewer, commands, editing } = this;
    setHidden(this.element, !commands.isPosing && viewer.pose.isEmpty, viewer.canvas);
    setHidden(this.keep, !editing.isPossible, viewer.canvas);
    this.keep.disabled = this.reset.disabled = viewer.pose.isEmpty;
    if (editing.busy) this.keep.disabled = true;
    if (viewer.pose.isEmpty) this.readout.textContent = matchMedia("(max-width: 760px)").matches ? "Drag a limb" : "Drag a limb. Shift: about its own axis.";
  }
}
