// A status message over the viewport.

import { button, fill, h } from "../dom";
import type { Editing } from "../editing/editing";
import type { Exports } from "../exports";
import type { State } from "../state";
import type { Viewer } from "../viewport/viewer";

const EMPTY = "Nothing is drawn yet.";

export class Notes {
  readonly element = h("div", { class: "notes", attributes: { role: "status" } });

  private readonly begin: HTMLElement;

  /** `begin` leads to the tools that draw. */
  constructor(private readonly state: State, private readonly viewer: Viewer, private readonly exports: Exports, private readonly editing: Editing, begin: () => void) {
    this.begin = button({ label: "Draw something", wide: true, class: "framed", press: begin });
    state.on(["current", "build", "drawings"], () => this.draw());
    editing.listen(["mode"], () => this.draw());
    viewer.on(["model", "sideBySide"], () => this.draw());
    exports.onWords(() => this.draw());
    this.draw();
  }

  private draw(): void {
    const { drawing } = this.state;
    const words = this.words();
    const { isPossible, isOn } = this.editing;
    fill(this.element, words !== "" && h("div", {}, h("p", {}, words), words === EMPTY && isPossible && !isOn && this.begin));
    this.element.hidden = words === "";
    this.element.classList.toggle("over-model", this.viewer.model !== null && words !== EMPTY);
    this.viewer.canvas.classList.toggle("faded", drawing?.gone === true);
  }

  private words(): string {
    const { drawing } = this.state;
    if (!drawing) return "";
    if (this.viewer.requests.failure !== "") return `The model could not be shown: ${this.viewer.requests.failure}`;
    if (drawing.gone) return this.viewer.model ? "The drawing's file is missing at the moment. This is its last model." : "The drawing's file is missing at the moment.";
    if (this.viewer.playback.comparison.failure !== "") return `The original clips could not be shown: ${this.viewer.playback.comparison.failure}`;
    const { build } = drawing;
    if (build?.paper != null && build.parts.length === 0 && build.findings.every(({ severity }) => severity !== "error")) return EMPTY;
    if (this.viewer.model) return this.exports.words;
    if (!build) return "Building…";
    return build.model === null ? (build.stale || build.findings.some(({ severity }) => severity === "error") ? "There is no model yet: the drawing has problems." : "There is no model: the drawing has no parts.") : "";
  }
}
