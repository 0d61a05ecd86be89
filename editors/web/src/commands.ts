// The commands behind buttons and keys.

import type { Editing } from "./editing/editing";
import { partNode } from "./viewport/model";
import type { Pointer } from "./viewport/pointer";
import type { State } from "./state";
import type { Shading } from "./viewport/model";
import type { Viewer } from "./viewport/viewer";

const SHADINGS: readonly Shading[] = ["smooth", "flat", "wire", "edges"];

export class Commands {
  private readonly listeners: (() => void)[] = [];
  pointer: Pointer | null = null;
  /** Changes of the drawing; set by the page. */
  editing: Editing | null = null;
  /** The tools that draw; set by the page. */
  drawing: { giveUp(): boolean; leave(): boolean } | null = null;
  /** Gives up what is being recorded, and returns whether anything is; set by the page. */
  giveUpRecording: () => boolean = () => false;
  /** Opens the help; set by the page. */
  help: () => void = () => {};
  /** Opens the panel that records a puppet, where there are cameras; set by the page. */
  recordPuppet: (() => void) | null = null;

  constructor(private readonly viewer: Viewer, private readonly state: State) {}

  /** Calls the listener when posing mode is switched. */
  onMode(listener: () => void): void {
    this.listeners.push(listener);
  }

  get isPosing(): boolean {
    return this.pointer?.posesLimbs === true;
  }

  togglePosing(): void {
    if (!this.pointer) return;
    this.pointer.posesLimbs = !this.pointer.posesLimbs;
    for (const listener of this.listeners) listener();
  }

  turn(degrees: number, aboutLimb: boolean): void {
    const node = this.viewer.parts.nodesOf(this.state.selected)[0];
    if (node && partNode(node)) this.pointer?.posing.turn(node, degrees, aboutLimb);
  }

  resetPose(): void {
    this.pointer?.cancel();
    this.viewer.pose.reset();
    this.viewer.posed();
  }

  /** Undoes one thing: a drag, a tool, a pose, the mode, the view of the layers, the selection. */
  escape(): void {
    if (this.pointer?.cancel() || this.drawing?.giveUp() || this.giveUpRecording()) return;
    if (this.editing?.isPicking) return this.editing.pick(null);
    if (this.editing?.refusal) return this.editing.clear();
    if (this.drawing?.leave()) return;
    if (!this.viewer.pose.isEmpty) this.resetPose();
    else if (this.isPosing) this.togglePosing();
    else if (this.viewer.stack.isOn) this.viewer.stack.toggle();
    else this.state.select(null);
  }

  /** Hides the selected part and what hangs on it, or shows them again. */
  hide(): void {
    const { selected } = this.state;
    if (selected !== null) this.state.setHidden(selected, !this.state.isHidden(selected));
  }

  /** Shows only the selected part and what hangs on it. */
  isolate(): void {
    if (this.state.selected !== null) this.state.isolate(this.state.selected);
  }

  showAll(): void {
    if (this.state.hidden.size > 0) this.state.showAll();
  }

  toggleParallel(): void {
    this.viewer.setParallel(!this.viewer.view.isParallel);
  }

  nextShading(): void {
    const next = SHADINGS[(SHADINGS.indexOf(this.viewer.shading) + 1) % SHADINGS.length];
    if (next) this.viewer.setShading(next);
  }

  async toggleFullScreen(): Promise<void> {
    if (document.fullscreenElement) await document.exitFullscreen();
    else if (document.fullscreenEnabled) await document.documentElement.requestFullscreen();
  }
}
