// The bar that is shown in posing mode.

import { RotateCcw, RotateCw, Undo2, X } from "lucide";
import { button, fill, h, setHidden } from "../dom";
import type { Commands } from "../commands";
import type { Viewer } from "../viewport/viewer";

export class PoseBar {
  readonly element = h("section", { class: "posebar", hidden: true, attributes: { "aria-label": "Posing" } });
  private readonly readout = h("output", { class: "pose-readout" });
  private readonly reset: HTMLButtonElement;

  constructor(viewer: Viewer, commands: Commands) {
    this.reset = button({ icon: Undo2, label: "Reset pose", key: "Esc", wide: true, press: () => commands.resetPose() });
    fill(
      this.element,
      this.readout,
      button({ icon: RotateCcw, label: "Turn the selected part left by 5°", key: ",", press: ({ shiftKey }) => commands.turn(5, shiftKey) }),
      button({ icon: RotateCw, label: "Turn the selected part right by 5°", key: ".", press: ({ shiftKey }) => commands.turn(-5, shiftKey) }),
      this.reset,
      button({ icon: X, label: "Leave posing", key: "P", press: () => commands.togglePosing() }),
    );
    commands.onMode(() => this.follow(viewer, commands));
    viewer.on(["pose"], () => this.follow(viewer, commands));
    this.follow(viewer, commands);
  }

  show(part: string, degrees: number): void {
    const rounded = Math.round(degrees);
    fill(this.readout, h("strong", {}, part), ` ${rounded > 0 ? "+" : rounded < 0 ? "−" : ""}${Math.abs(rounded)}°`);
  }

  private follow(viewer: Viewer, commands: Commands): void {
    setHidden(this.element, !commands.isPosing && viewer.pose.isEmpty, viewer.canvas);
    this.reset.disabled = viewer.pose.isEmpty;
    if (viewer.pose.isEmpty) this.readout.textContent = matchMedia("(max-width: 760px)").matches ? "Drag a limb" : "Drag a limb. Shift: about its own axis.";
  }
}
