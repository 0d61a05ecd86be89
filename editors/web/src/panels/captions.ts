// What stands where, while a clip and its original are side by side.

import { Vector3 } from "three";
import { fill, h } from "../dom";
import type { Viewer } from "../stage/viewer";

export class Captions {
  readonly element = h("div", { class: "captions", hidden: true });
  private readonly labels = [h("span", { class: "caption" }), h("span", { class: "caption" })] as const;

  constructor(private readonly viewer: Viewer) {
    fill(this.element, ...this.labels);
    viewer.on(["beside", "model", "time"], () => this.draw());
    viewer.view.onChange(() => this.place());
  }

  private draw(): void {
    const { boxes } = this.viewer.beside;
    this.element.hidden = boxes === null;
    if (!boxes) return;
    const own = this.viewer.exposure?.facts.limited === false ? "full" : "limited";
    for (const [at, words] of [own, "full"].entries()) if (this.labels[at]!.textContent !== words) this.labels[at]!.textContent = words;
    this.place();
  }

  /** Over the middle of what each fills while the clip plays. */
  private place(): void {
    const { beside, view } = this.viewer;
    beside.boxes?.forEach((box, at) => {
      const label = this.labels[at]!;
      const middle = box.getCenter(new Vector3());
      const place = view.onScreen(middle.setY(box.max.y));
      label.hidden = place === null;
      if (place) label.style.transform = `translate(${place.x * this.element.clientWidth}px, max(4px, ${place.y * this.element.clientHeight}px - 100% - 10px)) translateX(-50%)`;
    });
  }
}
