// The buttons above the viewport.

import { Circle, CircleQuestionMark, Download, Focus, Fullscreen, Globe, Grid3x3, Hexagon, Layers, PencilLine, PersonStanding, SquareSplitHorizontal, Video } from "lucide";
import { button, fill, h } from "../dom";
import type { Commands } from "../commands";
import type { Exports } from "../exports";
import type { Shading } from "../viewport/model";
import type { Viewer } from "../viewport/viewer";
import { menu } from "./menu";
import { more } from "./more";
import type { PaperPanel } from "./paper";

export class Toolbar {
  readonly element = h("div", { class: "toolbar-place" });
  /** The tools that change the drawing. */
  readonly edits = group("Edit");

  constructor(viewer: Viewer, commands: Commands, exports: Exports, paper: PaperPanel) {
    const shadings: [Shading, HTMLButtonElement][] = (
      [
        ["smooth", Circle, "Smooth"],
        ["flat", Hexagon, "Flat: no smoothing between triangles"],
        ["wire", Globe, "Wireframe"],
        ["edges", Grid3x3, "Smooth, with the triangles' edges"],
      ] as const
    ).map(([shading, icon, label]) => [shading, button({ icon, label, press: () => viewer.setShading(shading) })]);
    const parallel = h("button", { class: "button text", title: "Parallel projection (5)", attributes: { type: "button", "aria-keyshortcuts": "5" }, on: { click: () => commands.toggleParallel() } }, "Parallel");
    const layers = button({ icon: Layers, label: "Layers from the side", key: "L", press: () => viewer.stack.toggle() });
    const pose = button({ icon: PersonStanding, label: "Pose", key: "P", wide: true, press: () => commands.togglePosing() });
    const drawing = button({ icon: SquareSplitHorizontal, label: "Drawing beside the model", key: "2", press: () => paper.toggle() });
    paper.onToggle(() => drawing.setAttribute("aria-pressed", String(paper.isOn)));
    const edit = button({ icon: PencilLine, label: "Edit", key: "W", wide: true, press: () => commands.editing?.toggle() });
    this.edits.append(edit);
    const choices = [
      { label: "3D model (GLB)", note: "for Blender, games and web pages", key: "D", press: () => void exports.model() },
      { label: "Picture (PNG)", note: "as the view shows it", key: "S", press: () => void exports.screenshot(false) },
      { label: "Transparent picture (PNG)", note: "only the model", key: "Shift+S", press: () => void exports.screenshot(true) },
      { label: "Moving picture (GIF)", note: "of the clip, or once around", key: "Shift+D", isPossible: () => exports.films, press: () => void exports.film() },
      { label: "3D model (OBJ)", note: "shapes only, for programs without GLB", isPossible: () => exports.files !== null, press: () => void exports.obj() },
      { label: "Puppet sheet (SVG)", note: "to print and cut out", isPossible: () => exports.files !== null, press: () => void exports.puppet() },
      ...(exports.pages ? [{ label: "Page (HTML)", note: "plays the model in any browser", press: () => void exports.page() }] : []),
      ...(exports.links ? [{ label: "Link", note: "to the drawing as it is now", press: () => exports.share() }] : []),
    ];
    const [exported, opensExported] = menu({ icon: Download, label: "Export" }, choices);
    const views = ([["¾", "threeQuarter", "0", "Three-quarter view"], ["Front", "front", "1", "Front view"], ["Side", "side", "3", "Side view"], ["Top", "top", "7", "Top view"]] as const).map(([text, name, key, label]) =>
      h("button", { class: "button text", title: `${label} (${key})`, attributes: { type: "button", "aria-label": label, "aria-keyshortcuts": key }, on: { click: () => viewer.view.look(name) } }, text),
    );
    const [folded, opener] = more("More tools", [
      group("Projection", layers, parallel),
      group("Shading", ...shadings.map(([, element]) => element)),
      group("Pose", pose, commands.recordPuppet && button({ icon: Video, label: "Record a puppet", key: "R", press: () => commands.recordPuppet?.() })),
      h("span", { class: "spring" }),
      group(
        "Export",
        exported,
        document.fullscreenEnabled && button({ icon: Fullscreen, label: "Full screen", key: "Shift+F", press: () => void commands.toggleFullScreen() }),
        button({ icon: CircleQuestionMark, label: "Help", key: "?", press: () => commands.help() }),
      ),
    ]);
    const bar = h("div", { class: "toolbar", attributes: { role: "toolbar", "aria-label": "View and tools" } }, group("Views", ...views, button({ icon: Focus, label: "Frame the model", key: "Home", press: () => viewer.view.frame() }), drawing), this.edits, folded, opener);
    fill(this.element, bar);
    const follow = (): void => {
      for (const [shading, element] of shadings) element.setAttribute("aria-pressed", String(viewer.shading === shading));
      parallel.setAttribute("aria-pressed", String(viewer.view.isParallel));
      layers.setAttribute("aria-pressed", String(viewer.stack.isOn));
      layers.disabled = viewer.model === null;
      pose.setAttribute("aria-pressed", String(commands.isPosing));
      opensExported.disabled = viewer.model === null;
    };
    viewer.on(["display", "model", "layers"], follow);
    const followEditing = (): void => {
      this.edits.hidden = !commands.editing?.isPossible;
      edit.setAttribute("aria-pressed", String(commands.editing?.isOn === true));
    };
    commands.editing?.listen(["mode"], followEditing);
    followEditing();
    commands.onMode(follow);
    follow();
  }
}

function group(label: string, ...children: (Node | false | null)[]): HTMLElement {
  return h("div", { class: "group", attributes: { role: "group", "aria-label": label } }, ...children);
}
