// The help: keys and pointer.

import { X } from "lucide";
import { button, fill, h } from "../dom";
import type { Host } from "../host/host";
import type { Keys } from "../shortcuts";

type Has = Pick<Host, "film" | "jumps" | "openCamera">;
type Group = readonly [title: string, rows: readonly (readonly [keys: string, does: string])[]];

/** What there is with this host. */
const groups = ({ film, jumps, openCamera }: Has): readonly Group[] => [
  ["Look", [["drag", "turn the view"], ["right drag", "move it (or with two fingers)"], ["wheel, + −", "nearer, farther (or pinch)"], ["← → ↑ ↓", "turn the view by 10°"], ["0 1 3 7", "three-quarter, front, side, top (Shift: from the other side)"], ["2", "the drawing beside the model: a click there selects, too"], ["5", "perspective or parallel"], ["L", "the layers from the side, and back"], ["4, B", "terrain: the drawn view; drawn look or true 3D"], ["F, Home", "frame the selected part; the whole model"], ["Z", "next shading"]]],
  ["Parts", [["click", jumps ? "select a part, and jump to its string in the editor" : "select a part"], ["T, /", "go to the list of parts; search it"], ["letters", "in the list: go to the part whose name begins so"], ["right click", "what can be done with a part (or a long press, or the menu key)"], ["H", "hide or show the selected part and what hangs on it (Shift: show only these)"], ["A", "show all parts"], ["E", "open or close the list of problems"], ["Esc", "select nothing"]]],
  ["Pose", [["P", "turn posing on or off"], ["drag", "turn a limb about its joint"], ["Shift + drag", "turn it about its own axis"], [", .", "turn the selected part by 5°"], ["Esc", "reset all limbs"]]],
  ["Edit", [["W", "turn editing on or off"], ["F2, double-click", "name the selected part"], ["drag a handle", "thickness, depth and joint (Alt: one side, Shift: fine, Esc: give up)"], ["drag a drawing", "above the timeline: how long it stands (← →, Esc: give up)"], ["Delete, Insert", "there: leave a drawing out, bring one back"], ["Ctrl + Z", "undo (Ctrl + Shift + Z: redo)"]]],
  ["Draw", [["Q X U Y", "while editing, beside the model: select and move, draw a shape, ellipse, rectangle"], ["Enter", "place an ellipse or a rectangle"], ["Shift", "circle, square, straight move"], ["← → ↑ ↓", "move the selected part (Shift: fine)"], ["Delete", "delete it"], ["Esc", "leave the tool"]]],
  ["Clips", [["Space", "play, pause"], ["J K", "previous or next drawing or key"], ["C", "movement chart"], ["I", "performance: marks, joints and timing"], ["O", "a performed or limited clip and its original side by side"], ["N", "onion skin: the drawings before and after, while the clip is paused"], ["V", "follow a figure that travels"], ["M", "look through the camera of the clip"]]],
  ...(openCamera ? [["Puppets", [["R", "record a puppet with the camera"]]] as const] : []),
  ["Export", [["D", film ? "3D model (Shift: moving picture)" : "3D model"], ["S", "picture (Shift: transparent)"], ["Shift + F", "full screen"], ["G", "all drawings"]]],
];

export class Help {
  readonly element = h("dialog", { class: "help-dialog", attributes: { "aria-label": "Help" } });

  constructor(keys: Keys, host: Has) {
    const letters = h("input", { attributes: { type: "checkbox" }, on: { change: () => (keys.letters = letters.checked) } });
    letters.checked = keys.letters;
    fill(
      this.element,
      h("header", { class: "dialog-head" }, h("h2", {}, "Keys and pointer"), button({ icon: X, label: "Close", press: () => this.element.close() })),
      h(
        "div",
        { class: "help-groups" },
        ...groups(host).map(([title, keys]) => h("section", {}, h("h3", {}, title), h("dl", {}, ...keys.flatMap(([key, does]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, does)])))),
      ),
      h("label", { class: "help-switch" }, letters, "Letters, digits and signs are shortcuts. Without them, the arrow keys, Space, Home and Escape still work."),
      h("p", { class: "muted" }, "Posing only changes this view; Keep pose and Record write poses into the drawing."),
    );
    // A click on the backdrop is one on the dialog element itself.
    this.element.addEventListener("click", ({ target }) => {
      if (target === this.element) this.element.close();
    });
  }

  toggle(): void {
    if (this.element.open) this.element.close();
    else this.element.showModal();
  }
}
