// What is written over the layers seen from the side: the drawing plane, the depth of each part, and why the marked one lies there.

import { Vector3 } from "three";
import { fill, h, inCode } from "../dom";
import { depthOf, depthReasonOf } from "../parts";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";

export class Layers {
  readonly element = h("div", { class: "layers", hidden: true, attributes: { role: "status" } });
  private readonly ruler = h("div", { class: "layers-ruler", attributes: { "aria-hidden": "true" } });
  private readonly plane = h("div", { class: "layers-plane", attributes: { "aria-hidden": "true" } }, h("span", {}, "drawing plane"));
  private readonly mark = h("div", { class: "layers-mark", attributes: { "aria-hidden": "true" } });
  private readonly note = h("p", { class: "layers-note" });

  constructor(private readonly viewer: Viewer, private readonly state: State) {
    fill(this.element, this.ruler, this.plane, this.mark, h("span", { class: "layers-end front" }, "← front"), h("span", { class: "layers-end" }, "back →"), this.note);
    viewer.on(["layers", "model", "time", "pose"], () => this.draw());
    viewer.view.onChange(() => this.draw());
    state.on(["hover", "selection", "light", "build"], () => this.draw());
  }

  private draw(): void {
    this.element.hidden = !this.viewer.stack.isExact;
    if (this.element.hidden) return;
    this.place(this.plane, 0);
    const { parts, hovered, selected, lit } = this.state;
    const name = hovered ?? selected ?? lit;
    const carrier = name === null ? undefined : parts.carrier(name);
    const depths = new Set(parts.all.flatMap(({ name, depth }) => (depth === null ? [] : this.depthInModel(name))));
    fill(
      this.ruler,
      ...[...depths].map((depth) => {
        const tick = h("i", {});
        this.place(tick, depth);
        return tick;
      }),
    );
    const depth = carrier ? this.depthInModel(carrier.name)[0] : undefined;
    this.mark.hidden = depth === undefined;
    if (depth !== undefined) this.place(this.mark, depth);
    const where = carrier ? depthOf(carrier) : null;
    if (!carrier || where === null) fill(this.note, "Choose a part to see how deep it lies, and why.");
    else fill(this.note, h("b", {}, carrier.name), ` ${where}`, h("span", {}, ...inCode(depthReasonOf(carrier))));
  }

  /** Where the planes of a part and its copies are in the model. */
  private depthInModel(name: string): number[] {
    return this.viewer.parts.nodesOf(name).map((node) => Number(node.getWorldPosition(new Vector3()).z.toFixed(6)));
  }

  /** Puts a line where the picture shows this depth. */
  private place(line: HTMLElement, depth: number): void {
    const at = this.viewer.view.onScreen(this.viewer.view.target.clone().setZ(depth));
    line.style.left = `${(at?.x ?? 0) * 100}%`;
  }
}
