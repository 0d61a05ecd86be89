// Parts that are hovered, lit, selected or hidden, in the model and in the copy beside it.

import type { Mesh } from "three";
import type { State } from "../state";
import { Highlight, type Mark } from "./highlight";
import { nodeName, type Model, type Shading } from "./model";
import type { PartNodes } from "./part-nodes";
import type { RenderLoop } from "./render-loop";
import type { SideBySide } from "./side-by-side";
import { applyHidden, isAlone, isHidden } from "./visibility";

const MARKS: readonly Mark[] = ["hovered", "lit", "selected"];

/** What is marked. */
interface Shown {
  readonly model: Model | null;
  readonly sideBySide: SideBySide;
  readonly parts: PartNodes;
  readonly shading: Shading;
}

export class Marks {
  private readonly highlight = new Highlight();

  constructor(private readonly state: State, private readonly shown: Shown, private readonly renderLoop: RenderLoop) {
    state.on("selection", () => this.mark("selected"));
    state.on("hover", () => this.mark("hovered"));
    state.on("light", () => this.mark("lit"));
  }

  setColors(accent: string, ink: string): void {
    this.highlight.color(accent, ink);
  }

  /** Called before each frame: the width of outlines is in pixels of the picture. */
  measure(): void {
    this.highlight.measure(this.renderLoop.size);
  }

  /** Shows or hides all marks. */
  show(on: boolean): void {
    this.highlight.show(on);
  }

  /** Removes all marks: their meshes are about to go. */
  clear(): void {
    for (const mark of MARKS) this.highlight.clear(mark);
    this.highlight.edges([]);
  }

  /** Hides the hidden parts, and marks what is shown. */
  update(): void {
    const { hidden } = this.state;
    for (const model of this.models) {
      const nodes = [...hidden].flatMap((name) => this.shown.parts.nodesOf(name, model));
      applyHidden(model, new Set(nodes.flatMap((node) => model.meshesOf(node))));
    }
    this.renderLoop.canvas.dataset["hidden"] = [...hidden].join(" ");
    this.drawEdges();
    for (const mark of MARKS) this.mark(mark);
  }

  drawEdges(): void {
    const on = this.shown.shading === "edges";
    this.highlight.edges(on ? this.models.flatMap(({ meshes }) => meshes.filter(isAlone)) : []);
    for (const { batches } of this.models) batches.drawEdges(on ? this.highlight.lines : null);
  }

  private get models(): readonly Model[] {
    return [this.shown.model, this.shown.sideBySide.copy].filter((model) => model !== null);
  }

  private mark(mark: Mark): void {
    const { parts } = this.shown;
    const name = { hovered: this.state.hovered, lit: this.state.lit, selected: this.state.selected }[mark];
    const meshes: Mesh[] = this.models.flatMap((model) => parts.nodesOf(name, model).flatMap((node) => model.meshesOf(node)));
    // Pointing at a hidden part in the list shows where it is.
    this.highlight.set(mark, mark === "hovered" ? meshes : meshes.filter((mesh) => !isHidden(mesh)));
    this.renderLoop.canvas.dataset[mark] = parts.nodesOf(name).map(nodeName).join(" ");
    this.renderLoop.invalidate();
  }
}
