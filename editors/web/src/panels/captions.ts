// Captions over the two models of a comparison.

import { Vector3 } from "three";
import { fill, h } from "../dom";
import type { Viewer } from "../viewport/viewer";

export class Captions {
  readonly element = h("div", { class: "captions", hidden: true });
  private readonly labels = [h("span", { class: "caption" }), h("span", { class: "caption" })] as const;

  constructor(private readonly viewer: Viewer) {
    fill(this.element, ...this.labels);
    viewer.on(["sideBySide", "model", "time"], () => this.draw());
    viewer.view.onChange(() => this.place());
  }

  private draw(): void {
    const { boxes } = this.viewer.sideBySide;
    this.element.hidden = boxes === null;
    if (!boxes) return;
    const limited = this.viewer.playback.exposures.current?.facts.limited === false ? ["full", "full"] : ["limited", "full"];
    for (const [at, words] of (this.viewer.playback.exposures.performed ? ["performed", "original"] : limited).entries()) if (this.labels[at]!.textContent !== words) this.labels[at]!.textContent = words;
    this.place();
  }

  /** Above the middle of each one's bounds during the clip. */
  private place(): void {
    const { sideBySide, view } = this.viewer;
    sideBySide.boxes?.forEach((box, at) => {
      const label = this.labels[at]!;
      const middle = box.getCenter(new Vector3());
      const place = view.onScreen(middle.setY(box.max.y));
      label.hidden = place === null;
      if (place) label.style.transform = `translate(${place.x * this.element.clientWidth}px, max(4px, ${place.y * this.element.clientHeight}px - 100% - 10px)) translateX(-50%)`;
    });
  }
}
